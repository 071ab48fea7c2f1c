//! Results as reports: text for readers, JSON, tables and figures, written in any of their formats.
//!
//! Numbers are written in SI units and in the shortest form that reads back as the same number.

#![allow(missing_docs)]

mod boundary;
mod check;
pub mod cost;
pub mod ensemble;
pub mod fit;
pub mod loop_chart;
mod map;
pub mod measured_face;
pub mod parameters;
pub mod preloads;
pub mod provenance;
pub mod report;
pub mod reversals;
pub mod run;
pub mod scene_figure;
pub mod scene_spectra;
pub mod scenes;
pub(crate) mod section;
pub mod sensitivity;
pub(crate) mod sheet;
pub mod spectrum_figure;
pub mod study_figure;
pub mod summary;
pub mod surface;
pub mod work_precision;
