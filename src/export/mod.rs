//! Computed scenes, studies, costs and checks as text: JSON and CSV for programs, summaries and pictures for readers.
//!
//! Numbers are written in SI units and in the shortest form that reads back as the same number.

mod check;
mod comparison;
mod cost;
mod ensemble;
mod json;
mod map;
mod measured_hash;
mod preloads;
mod provenance;
mod reversals;
mod scene_figure;
mod scene_tables;
pub mod section;
pub(crate) mod sheet;
mod spectrum_figure;
mod study_figure;
mod summary;
mod surface;
mod table;
mod verdict;
mod work_precision;

pub use check::{check_markdown, check_text, write_check_json};
pub use comparison::{Pair, adhesion_forces, comparison_figure, comparison_text};
pub use cost::{cost_text, write_cost_csv, write_cost_json};
pub use ensemble::{ensemble_text, write_ensemble_json, write_ensemble_table};
pub use json::write_json;
pub use map::write_map;
pub use measured_hash::{MeasuredHash, MeasuredHashError, named_from};
pub use preloads::{PreloadReport, preload_axes, preload_layers};
pub use provenance::Provenance;
pub use reversals::{
    ReversalReport, reversals_figure, reversals_text, write_reversal_map_table, write_reversals_json,
    write_reversals_table,
};
pub(crate) use scene_figure::mark_name;
pub use scene_figure::{ContactSets, force_figure, sign};
pub use scene_tables::{write_curve, write_line};
pub use spectrum_figure::{Spectra, SpectrumPoint};
pub use study_figure::study_figure;
pub use summary::{brief_summary, summary};
pub use surface::{
    MeasuredFace, SurfaceAdhesion, SurfaceContact, SurfaceFile, SurfaceReport, measured_adhesion_text,
    write_surface_table,
};
pub use table::TableFormat;
pub use work_precision::work_precision;
