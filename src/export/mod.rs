//! A computed scene as files: JSON and CSV for other programs, a summary for people, and the one way
//! a file is written.
//!
//! Numbers are written in SI units and in the shortest form that reads back as the same number.

pub mod atomic;
mod csv;
mod json;
mod json_text;
pub(crate) mod sheet;
mod summary;
mod verdict;

pub use atomic::{WriteError, check_writable, write_new};
pub use csv::{write_curve, write_line};
pub use json::write_json;
pub use json_text::write_json_value;
pub use summary::summary;
