//! Measured surfaces: files of instruments and programs, read into heights in m.
//!
//! [`read`](crate::read) recognises the format by the content, not by the name. Units are never guessed: if a file states
//! none, [`ReadOptions`](crate::ReadOptions) has to. Every error names the place in the file and what is allowed there. A
//! file of n bytes after decompression takes at most 1 MiB + 64 n bytes of memory. Decompression ends at 1 MiB + 32 bytes
//! for each byte of the file, or at the number of heights that a header states, at most 1 GiB.

pub(crate) mod bytes;
pub(crate) mod container;
pub(crate) mod foreign;
pub(crate) mod grid;
pub(crate) mod gwy;
pub(crate) mod levels;
pub(crate) mod missing;
pub(crate) mod nanoscope;
pub(crate) mod netcdf;
pub(crate) mod npy;
pub(crate) mod open;
pub(crate) mod reading;
pub(crate) mod sdf;
pub(crate) mod sur;
pub(crate) mod surface;
pub(crate) mod text;
pub(crate) mod x3p;

use asperity_data::OutOfMemory;
use asperity_data::ReadError;
use asperity_data::printable;
use std::fmt;
use std::str::FromStr;
use thiserror::Error;

/// Number of characters from which on a text of a file is shortened in messages.
const MOST_SHOWN: usize = 40;

/// Place of a fault in a file. Lines and points count from 1; bytes count from 0, after decompression.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Place {
    /// The file as a whole.
    File,
    /// A line of a text.
    Line(usize),
    /// A point of a surface or of a curve.
    Point(usize),
    /// A byte, by its offset.
    Byte(usize),
    /// Named part of a container: a file of an archive, an element, a channel.
    Part(String),
    /// A place in the file of the measurement with this name.
    Measurement(String, Box<Place>),
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Place::File => Ok(()),
            Place::Line(number) => write!(f, "line {number}: "),
            Place::Point(number) => write!(f, "point {number}: "),
            Place::Byte(offset) => write!(f, "byte {offset}: "),
            Place::Part(name) => write!(f, "{}: ", shown(name)),
            Place::Measurement(name, place) => write!(f, "{}: {place}", shown(name)),
        }
    }
}

/// Reason why a file cannot be read as a surface. The caller prepends the name of the file.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum TopographyError {
    /// The system cannot read the file; the reason of the system.
    #[error("{0}")]
    Unreadable(String),
    /// The content is invalid.
    #[error("{place}{found}; allowed: {allowed}")]
    Refused {
        /// Place within the file.
        place: Place,
        /// What is wrong there.
        found: String,
        /// What is allowed there.
        allowed: String,
    },
    /// Insufficient memory.
    #[error(transparent)]
    OutOfMemory(#[from] OutOfMemory),
}

impl TopographyError {
    /// The error, with the name of the measurement in which it occurs.
    pub(super) fn within(self, name: &str) -> Self {
        match self {
            TopographyError::Refused { place, found, allowed } => {
                let place = Place::Measurement(name.to_owned(), Box::new(place));
                TopographyError::Refused { place, found, allowed }
            }
            TopographyError::Unreadable(reason) => {
                TopographyError::Unreadable(format!("{}: {reason}", shown(name)))
            }
            TopographyError::OutOfMemory(_) => self,
        }
    }
}

impl From<ReadError> for TopographyError {
    fn from(error: ReadError) -> Self {
        TopographyError::Unreadable(error.to_string())
    }
}

/// Creates the error of a place in a file: what was found there and what is allowed.
pub fn refused(place: Place, found: impl ToString, allowed: impl ToString) -> TopographyError {
    TopographyError::Refused { place, found: found.to_string(), allowed: allowed.to_string() }
}

/// Text of a file, for a message: on one line and shortened.
pub fn shown(text: &str) -> String {
    let short = match text.char_indices().nth(MOST_SHOWN) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text.to_owned(),
    };
    printable(&short).into_owned()
}

/// Name, other spellings, and number per metre of each unit: exact powers of ten, so that a division rounds once.
const UNITS: [(&str, &str, f64); 7] = [
    ("m", "meter metre meters metres", 1.0),
    ("cm", "centimeter centimetre", 1e2),
    ("mm", "millimeter millimetre millimeters millimetres", 1e3),
    ("µm", "μm um mum micron microns micrometer micrometre micrometers micrometres", 1e6),
    ("nm", "nanometer nanometre nanometers nanometres", 1e9),
    ("Å", "\u{212b} Ang angstrom ångström angstroms", 1e10),
    ("pm", "picometer picometre", 1e12),
];

/// Unit of length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    name: &'static str,
    per_metre: f64,
}

/// A text that is not a unit of length.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{}; allowed: {}", self.found(), UnitError::ALLOWED)]
pub struct UnitError(String);

impl UnitError {
    /// Names of the units that are read.
    pub const ALLOWED: &str = "m, cm, mm, µm (or um), nm, Å, pm";

    fn found(&self) -> String {
        format!("{:?} is not a unit of length", shown(&self.0))
    }
}

impl Unit {
    /// Metre.
    pub const METRE: Unit = Unit { name: "m", per_metre: 1.0 };

    /// Returns true for the name of a unit of length.
    pub(crate) fn is_name(text: &str) -> bool {
        text.parse::<Unit>().is_ok()
    }

    /// Usual name of the unit.
    pub fn name(self) -> &'static str {
        self.name
    }

    /// Returns the unit that a file states at this place; `None` for an empty text.
    pub(super) fn stated(text: &str, place: Place) -> Result<Option<Unit>, TopographyError> {
        let unit = Some(text).filter(|text| !text.is_empty()).map(str::parse).transpose();
        unit.map_err(|error: UnitError| refused(place, error.found(), UnitError::ALLOWED))
    }

    /// Converts a value in this unit to m.
    pub fn to_metres(self, value: f64) -> f64 {
        value / self.per_metre
    }
}

impl FromStr for Unit {
    type Err = UnitError;

    /// Parses the name of a unit. Symbols are case-sensitive, since `Mm` is not `mm`; words are not.
    fn from_str(text: &str) -> Result<Unit, UnitError> {
        let text = text.trim();
        let is_name =
            |name: &str| name == text || (name.chars().count() > 3 && name.eq_ignore_ascii_case(text));
        let found =
            UNITS.into_iter().find(|(name, others, _)| *name == text || others.split(' ').any(is_name));
        let unit = found.map(|(name, _, per_metre)| Unit { name, per_metre });
        unit.ok_or_else(|| UnitError(text.to_owned()))
    }
}

impl fmt::Display for Unit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_have_names_and_values() {
        for (text, metres) in [
            ("m", 1.0),
            ("mm", 1e-3),
            ("um", 1e-6),
            ("\u{b5}m", 1e-6),
            ("\u{3bc}m", 1e-6),
            (" Micron ", 1e-6),
            ("nm", 1e-9),
            ("Å", 1e-10),
        ] {
            assert_eq!(text.parse::<Unit>().unwrap().to_metres(1.0), metres, "{text}");
        }
        for text in ["", "Mm", "V", "MM", "px", "a.u.", "m²"] {
            assert!(text.parse::<Unit>().unwrap_err().to_string().contains("allowed: m, cm"), "{text}");
        }
    }
}
