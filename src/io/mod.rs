//! Files: reading within limits, writing whole or not at all, JSON text and arrays of NumPy.

mod hash;
mod json;
pub(crate) mod npy;
mod read;
mod unfinished;
mod write;

/// First characters of CSV that begins with the scene behind it.
pub(crate) const PROVENANCE: &str = "# asperity ";

pub(crate) use hash::{hexadecimal, sha256_of};
pub use json::write_json_value;
pub(crate) use read::*;
#[cfg(feature = "tui")]
pub(crate) use unfinished::{is_gone, machine};
#[cfg(feature = "tui")]
pub(crate) use write::check_file_name;
pub use write::{WriteError, check_writable, write_new, write_new_file, write_new_on};
