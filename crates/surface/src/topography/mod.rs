//! Measured surfaces: files of instruments and programs, read into heights in m.
//!
//! [`read`](crate::read) recognises the format by the content, not by the name. Units are never
//! guessed: if a file states none, [`ReadOptions`](crate::ReadOptions) has to state one. Every
//! error names the place in the file and what is allowed there. A file of n bytes after
//! decompression takes at most 1 MiB + 64 n bytes of memory. Decompression ends at 1 MiB + 32 bytes
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

use crate::error::{Place, SurfaceError, refused};
use asperity_data::shown;
use std::fmt;
use std::str::FromStr;

/// Name, other spellings, and number per metre of each unit. The numbers are exact powers of ten,
/// so that a division rounds once.
const UNITS: [(&str, &str, f64); 7] = [
    ("m", "meter metre meters metres", 1.0),
    ("cm", "centimeter centimetre", 1e2),
    ("mm", "millimeter millimetre millimeters millimetres", 1e3),
    (
        "µm",
        "μm um mum micron microns micrometer micrometre micrometers micrometres",
        1e6,
    ),
    ("nm", "nanometer nanometre nanometers nanometres", 1e9),
    ("Å", "\u{212b} Ang angstrom ångström angstroms", 1e10),
    ("pm", "picometer picometre", 1e12),
];

/// A unit of length that a file or an option may state, such as µm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    name: &'static str,
    per_metre: f64,
}

impl Unit {
    /// Names of all units of length that can be read, for messages of errors.
    pub const ALLOWED: &str = "m, cm, mm, µm (or um), nm, Å, pm";

    /// The unit metre.
    pub const METRE: Unit = Unit {
        name: "m",
        per_metre: 1.0,
    };

    /// Returns true for the name of a unit of length.
    pub(crate) fn is_name(text: &str) -> bool {
        text.parse::<Unit>().is_ok()
    }

    /// Returns the usual symbol of the unit, such as `µm`.
    pub fn name(self) -> &'static str {
        self.name
    }

    /// Returns the unit that a file states at this place; `None` for an empty text.
    pub(super) fn stated(text: &str, place: Place) -> Result<Option<Unit>, SurfaceError> {
        let unit = Some(text)
            .filter(|text| !text.is_empty())
            .map(|text| Unit::named(text, place));
        unit.transpose()
    }

    fn named(text: &str, place: Place) -> Result<Unit, SurfaceError> {
        let text = text.trim();
        let is_name = |name: &str| {
            name == text || (name.chars().count() > 3 && name.eq_ignore_ascii_case(text))
        };
        let found = UNITS
            .into_iter()
            .find(|(name, others, _)| *name == text || others.split(' ').any(is_name));
        let unit = found.map(|(name, _, per_metre)| Unit { name, per_metre });
        let refused = || {
            refused(
                place,
                format!("{:?} is not a unit of length", shown(text)),
                Unit::ALLOWED,
            )
        };
        unit.ok_or_else(refused)
    }

    /// Converts a length in this unit to m.
    ///
    /// ```
    /// let micrometres: asperity_surface::Unit = "um".parse()?;
    /// assert_eq!((micrometres.name(), micrometres.to_metres(5.0)), ("µm", 5e-6));
    /// assert!("px".parse::<asperity_surface::Unit>().is_err());
    /// # Ok::<(), asperity_surface::SurfaceError>(())
    /// ```
    pub fn to_metres(self, value: f64) -> f64 {
        value / self.per_metre
    }
}

impl FromStr for Unit {
    type Err = SurfaceError;

    /// Reads the name of a unit. Symbols are case-sensitive, because `Mm` is not `mm`; words are
    /// not.
    fn from_str(text: &str) -> Result<Unit, SurfaceError> {
        Unit::named(text, Place::File)
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
            assert_eq!(
                text.parse::<Unit>().unwrap().to_metres(1.0),
                metres,
                "{text}"
            );
        }
        for text in ["", "Mm", "V", "MM", "px", "a.u.", "m²"] {
            assert!(
                text.parse::<Unit>()
                    .unwrap_err()
                    .to_string()
                    .contains("allowed: m, cm"),
                "{text}"
            );
        }
    }
}
