//! Files: reading within limits, atomic writing, JSON text, tables and arrays of NumPy.

mod hash;
mod json;
pub(crate) mod npy;
mod object;
mod read;
mod table;
mod write;

/// First characters of CSV that begins with its scene.
pub(crate) const PROVENANCE: &str = "# asperity ";

pub(crate) use hash::{hexadecimal, sha256_of};
pub use json::write_json;
pub(crate) use object::{Entry, Object, Optional, object};
pub(crate) use read::*;
pub use table::{Kind, Table, TableOf};
pub(crate) use write::sync_folder;
pub use write::{WriteError, check_writable, write_new, write_new_file};
