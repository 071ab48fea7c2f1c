//! Results as reports: text for readers, JSON, tables and figures, written in any of their formats.
//!
//! Numbers are written in SI units and in the shortest form that reads back as the same number.

mod boundary;
mod check;
mod cost;
mod ensemble;
mod fit;
mod loop_chart;
mod map;
mod measured_face;
mod parameters;
mod preloads;
mod provenance;
mod report;
mod reversals;
mod run;
mod scene_figure;
mod scene_spectra;
mod scenes;
pub(crate) mod section;
mod sensitivity;
pub(crate) mod sheet;
mod spectrum_figure;
mod study_figure;
mod summary;
mod surface;
mod work_precision;

pub use provenance::scene_provenance;
pub use report::{Format, Report, write};
pub use run::{PathReport, RunReport};
pub use scene_spectra::SceneSpectra;

pub(crate) use cost::CostReport;
pub(crate) use ensemble::LinesReport;
pub(crate) use fit::FitReport;
pub(crate) use loop_chart::{ForceLoop, LoopQuantities, LoopUnits, loop_chart, sign};
pub(crate) use measured_face::{MeasuredFace, SurfaceFile};
pub(crate) use parameters::parameter_lines;
pub(crate) use preloads::{PreloadReport, distribution, preload_chart, preload_figure, warning};
pub(crate) use provenance::{check_measured_files, files_provenance, named_from, scenes_provenance};
pub(crate) use report::check_extension;
pub(crate) use reversals::ReversalReport;
pub(crate) use scene_figure::ContactSets;
pub(crate) use scenes::ScenesReport;
pub(crate) use sensitivity::{NOT_ALLOWED, SensitivityReport, sensitivity_chart, sensitivity_table};
pub(crate) use spectrum_figure::Spectra;
pub(crate) use study_figure::{study_curves, study_figure, study_map};
pub(crate) use summary::brief_summary;
pub(crate) use surface::{SurfaceReport, measured_adhesion_text};
pub(crate) use work_precision::work_precision;
