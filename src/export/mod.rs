//! Computed scenes, studies, costs and checks as text: JSON and CSV for programs, summaries and pictures for people.
//!
//! Numbers are written in SI units and in the shortest form that reads back as the same number.

mod check;
mod comparison;
mod cost;
mod csv;
mod ensemble;
mod json;
mod map;
mod scene_figure;
pub(crate) mod sheet;
#[cfg(test)]
mod study_example;
mod study_figure;
mod summary;
mod surface;
mod verdict;
mod work_precision;

pub use check::{check_markdown, check_text, write_check_json};
pub use comparison::{Pair, adhesion_forces, comparison_figure, comparison_text};
pub use cost::{cost_text, write_cost_csv, write_cost_json};
pub use csv::{write_curve, write_line};
pub use ensemble::{ensemble_text, write_ensemble_csv, write_ensemble_json};
pub use json::write_json;
pub use map::write_map;
pub use scene_figure::{ContactSets, force_figure, sign};
pub use study_figure::study_figure;
pub use summary::{brief_summary, summary};
pub use surface::{SurfaceFile, surface_text, write_surface_csv, write_surface_json};
pub use work_precision::work_precision;
