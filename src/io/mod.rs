//! Files: reading within limits, writing whole or not at all, and JSON text.

mod json;
mod read;
mod unfinished;
mod write;

pub use json::write_json_value;
pub(crate) use read::*;
#[cfg(feature = "tui")]
pub(crate) use unfinished::{is_gone, machine};
pub use write::{WriteError, check_writable, write_new, write_new_file, write_new_on};
