//! Measured surfaces: files of instruments and programs, read into heights in m.
//!
//! [`read`] finds the format by the content, not by the name. Units are never guessed: if a file states none,
//! [`ReadOptions`] has to. Every error names the place within the file and the allowed content. A file of n bytes
//! takes at most 1 MiB + 64 n bytes of memory, n counted after decompression, and decompression ends at 1 MiB + 32
//! bytes for each byte of the file.

mod bytes;
mod container;
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
pub(crate) use npy::columns as npy_columns;
pub(crate) use open::unpacked;
pub use open::{content, parse, parse_all, read};
pub use reading::ReadOptions;
pub use surface::{Cut, Detrend, Topography};
pub(crate) use surface::{UNEVEN, first_uneven, interpolated};
pub use unit::{Unit, UnitError};

use crate::io::ReadError;
use crate::memory::OutOfMemory;
use crate::text::printable;
use std::fmt;
use thiserror::Error;

/// Longest text of a file in messages, characters.
const MOST_SHOWN: usize = 40;

/// Place of a fault within a file. Lines and points count from 1, bytes, after decompression, from 0.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Place {
    File,
    Line(usize),
    Point(usize),
    Byte(usize),
    /// Named part of a container: a file of an archive, an element, a channel.
    Part(String),
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Place::File => Ok(()),
            Place::Line(number) => write!(f, "line {number}: "),
            Place::Point(number) => write!(f, "point {number}: "),
            Place::Byte(offset) => write!(f, "byte {offset}: "),
            Place::Part(name) => write!(f, "{}: ", shown(name)),
        }
    }
}

/// Reason why a file is no surface. The caller puts the name of the file before the message.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum TopographyError {
    /// The content cannot be read, or is invalid: place within the file, fault, and allowed content.
    #[error("{0}")]
    Refused(String),
    /// Insufficient memory.
    #[error(transparent)]
    OutOfMemory(#[from] OutOfMemory),
}

impl TopographyError {
    /// The error with the name of the measurement that has it.
    pub(super) fn within(self, name: &str) -> Self {
        match self {
            TopographyError::Refused(reason) => {
                TopographyError::Refused(format!("{}: {reason}", shown(name)))
            }
            other => other,
        }
    }
}

impl From<ReadError> for TopographyError {
    fn from(error: ReadError) -> Self {
        TopographyError::Refused(error.to_string())
    }
}

pub(crate) fn refused(place: Place, fault: impl fmt::Display, allowed: impl fmt::Display) -> TopographyError {
    TopographyError::Refused(format!("{place}{fault}; allowed: {allowed}"))
}

/// Text of a file for a message: one line of limited length.
pub(crate) fn shown(text: &str) -> String {
    let short = match text.char_indices().nth(MOST_SHOWN) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text.to_owned(),
    };
    printable(&short).into_owned()
}
