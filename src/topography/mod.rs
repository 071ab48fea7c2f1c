//! Measured surfaces: files of instruments and programs, read into heights in m.
//!
//! [`read`] finds the format by the content, not by the name. Units are never guessed: if a file states none,
//! [`ReadOptions`] has to. Every error names the place within the file and the allowed content. A file of n bytes
//! takes at most 1 MiB + 64 n bytes of memory, n counted after decompression, and decompression ends at 1 MiB + 32
//! bytes for each byte of the file.

mod bytes;
mod container;
mod error;
mod gwy;
mod missing;
mod netcdf;
mod npy;
mod open;
mod reading;
mod sdf;
mod sur;
mod surface;
pub(crate) mod text;
mod unit;
mod x3p;

pub use error::TopographyError;
pub(crate) use error::{Place, refused, shown};
pub(crate) use npy::columns as npy_columns;
pub(crate) use open::unpacked;
pub use open::{content, parse, parse_all, read};
pub use reading::ReadOptions;
pub use surface::{Cut, Detrend, Topography};
pub(crate) use surface::{UNEVEN, first_uneven, interpolated};
pub use unit::{Unit, UnitError};
