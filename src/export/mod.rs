//! Results as reports: text for readers, JSON, tables and figures, written in any of their formats.
//!
//! Numbers are written in SI units and in the shortest form that reads back as the same number.

mod boundary;
mod check;
mod comparison;
mod cost;
mod ensemble;
mod loop_chart;
mod map;
mod preloads;
mod provenance;
mod report;
mod reversals;
mod run;
mod scene_figure;
pub mod section;
pub(crate) mod sheet;
mod spectrum_figure;
mod study_figure;
mod summary;
mod surface;
mod work_precision;

pub use comparison::{Comparison, adhesion_forces};
pub use cost::CostReport;
pub use ensemble::LinesReport;
pub use loop_chart::{ForceLoop, LoopQuantities, LoopUnits, force_figure, loop_chart, sign};
pub use preloads::{PreloadReport, preload_axes, preload_layers};
pub use provenance::{
    MeasuredFileError, check_measured_files, files_provenance, named_from, scene_provenance,
};
#[cfg(feature = "tui")]
pub use report::write;
pub use report::{Format, FormatError, Json, Report, check_extension};
pub use reversals::ReversalReport;
pub use run::RunReport;
pub use scene_figure::ContactSets;
pub use spectrum_figure::{Spectra, SpectrumPoint};
pub use study_figure::{study_curves, study_figure, study_map};
pub use summary::brief_summary;
pub use surface::{MeasuredFace, SurfaceFile, SurfaceReport, measured_adhesion_text};
pub use work_precision::work_precision;
