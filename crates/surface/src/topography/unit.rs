//! Units of length.

use crate::error::{Place, SurfaceError, refused};
use asperity_data::shown;
use std::fmt;
use std::str::FromStr;

/// A unit of length with the names that files use for it.
struct KnownUnit {
    unit: Unit,
    other_names: &'static str,
}

const fn known(name: &'static str, per_metre: f64, other_names: &'static str) -> KnownUnit {
    KnownUnit {
        unit: Unit { name, per_metre },
        other_names,
    }
}

/// All units of length that can be read.
const UNITS: [KnownUnit; 7] = [
    known("m", 1.0, "meter metre meters metres"),
    known("cm", 1e2, "centimeter centimetre"),
    known("mm", 1e3, "millimeter millimetre millimeters millimetres"),
    known(
        "µm",
        1e6,
        "μm um mum micron microns micrometer micrometre micrometers micrometres",
    ),
    known("nm", 1e9, "nanometer nanometre nanometers nanometres"),
    known("Å", 1e10, "\u{212b} Ang angstrom ångström angstroms"),
    known("pm", 1e12, "picometer picometre"),
];

/// Largest number of letters of the symbol of a unit. In a symbol, upper and lower case differ.
const LONGEST_SYMBOL: usize = 3;

/// A unit of length that a file or an option may state, such as µm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    name: &'static str,
    /// Number of units in a metre: an exact power of ten, so that the conversion to m, a division,
    /// rounds only once.
    per_metre: f64,
}

impl Unit {
    /// Text for error messages: the names of all units of length that can be read.
    pub const ALLOWED: &str = "m, cm, mm, µm (or um), nm, Å, pm";

    /// The unit metre.
    pub const METRE: Unit = Unit {
        name: "m",
        per_metre: 1.0,
    };

    /// Returns true if `text` is the name of a unit of length, such as `um`.
    pub(crate) fn is_name(text: &str) -> bool {
        text.parse::<Unit>().is_ok()
    }

    /// Returns the usual symbol of the unit, such as `µm`.
    pub fn name(self) -> &'static str {
        self.name
    }

    /// Returns the unit that a text in a file states; `None` for an empty text. `place` is the
    /// place of the text in the file, for the error message.
    pub(super) fn stated(text: &str, place: Place) -> Result<Option<Unit>, SurfaceError> {
        if text.is_empty() {
            return Ok(None);
        }
        Unit::named(text, place).map(Some)
    }

    fn named(text: &str, place: Place) -> Result<Unit, SurfaceError> {
        let text = text.trim();
        let known = UNITS.iter().find(|known| known.has_name(text));
        match known {
            Some(known) => Ok(known.unit),
            None => {
                let found = format!("{:?} is not a unit of length", shown(text));
                Err(refused(place, found, Unit::ALLOWED))
            }
        }
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

impl KnownUnit {
    fn has_name(&self, text: &str) -> bool {
        let is_name = |name: &str| {
            let is_symbol = name.chars().count() <= LONGEST_SYMBOL;
            name == text || (!is_symbol && name.eq_ignore_ascii_case(text))
        };
        self.unit.name == text || self.other_names.split(' ').any(is_name)
    }
}

impl FromStr for Unit {
    type Err = SurfaceError;

    /// Parses the name of a unit. The case of a symbol matters, because `Mm` is not `mm`. The case
    /// of a word, such as `Metre`, does not matter.
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
