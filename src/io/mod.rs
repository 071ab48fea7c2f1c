//! Files: reading within limits, atomic writing on a disk, JSON text and arrays of NumPy.

mod disk;
mod hash;
mod json;
pub(crate) mod npy;
mod object;
mod read;
mod unfinished;
mod write;

/// First characters of CSV that begins with its scene.
pub(crate) const PROVENANCE: &str = "# asperity ";

pub use disk::{Disk, DiskFile, SystemDisk};
pub(crate) use disk::{folder_of, make_folders};
pub(crate) use hash::{hexadecimal, sha256_of};
pub use json::write_json_value;
pub(crate) use object::{Entry, Object, Optional, object};
pub(crate) use read::*;
#[cfg(feature = "tui")]
pub(crate) use unfinished::{is_gone, machine};
#[cfg(feature = "tui")]
pub(crate) use write::check_file_name;
pub use write::{WriteError, check_writable, write_new, write_new_file, write_new_on};
