//! Properties of the instrument. Many files state them in the lines above the points of a curve.

use crate::read::names::{letters, unit};
use asperity_data::parse_quantity;
use asperity_data::text_table::{Decimal, Separator, TextCell};

/// Names of the stiffness of the instrument in files, reduced by [`letters`].
const STIFFNESS: [&str; 6] = [
    "springconstant",
    "forceconstant",
    "cantileverstiffness",
    "cantileverspringconstant",
    "springk",
    "k",
];
/// Names of the sensitivity (the deflection for 1 V) in files, reduced by [`letters`].
const SENSITIVITY: [&str; 5] = [
    "sensitivity",
    "deflectionsensitivity",
    "sensdeflsens",
    "sensdeflection",
    "lightlevergain",
];
/// Names of the travel of the piezo in files, reduced by [`letters`].
const RAMP: [&str; 3] = ["rampsize", "ramplength", "zscansize"];

/// Properties of the instrument that a file states: stiffness, sensitivity, and travel of the
/// piezo.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Metadata {
    /// Stiffness of the instrument: the name of the stiffness in the file, and its value in N/m.
    pub stiffness: Option<(String, f64)>,
    /// Sensitivity: deflection of the instrument for 1 V, in m/V.
    pub sensitivity: Option<f64>,
    /// Travel of the piezo in m.
    pub ramp: Option<f64>,
}

impl Metadata {
    /// Reads a line of the header. Its form is `key: value`, `key = value`, or key and value
    /// separated by a tab. The unit is written after the key or after the value; a value without a
    /// unit is in SI units.
    pub fn take(&mut self, line: &str) {
        let Some(entry) = Entry::of(line) else {
            return;
        };
        let names = letters(entry.name);
        let names = &*names;
        if STIFFNESS.contains(&names) {
            if let Some(unit) = ratio(entry.unit, "N", "m") {
                self.stiffness = Some((entry.name.to_owned(), entry.number * unit));
            }
        } else if SENSITIVITY.contains(&names) {
            if let Some(sensitivity) = entry.sensitivity() {
                self.sensitivity = Some(sensitivity);
            }
        } else if RAMP.contains(&names)
            && let Ok(ramp) = parse_quantity(&format!("{:e} {}", entry.number, entry.unit), "m")
        {
            self.ramp = Some(ramp);
        }
    }
}

/// Positive number in the header of a file, with its name and its unit.
struct Entry<'a> {
    name: &'a str,
    number: f64,
    /// Unit of the number; empty if the header states none.
    unit: &'a str,
}

impl<'a> Entry<'a> {
    /// Parses a line of the header; `None` for a line without a positive number.
    fn of(line: &'a str) -> Option<Self> {
        let (key, value) = line
            .rsplit_once(": ")
            .or_else(|| line.split_once([':', '=', '\t']))?;
        let (name, unit_of_key) = key.split_once(['(', '[', ',']).unwrap_or((key, ""));
        let value = value.trim_matches(|c: char| !(c.is_alphanumeric() || "+-./".contains(c)));
        // Some instruments write `V 65.3 nm/V`, where the first V says that the value is related to
        // a voltage.
        let value = value.strip_prefix("V ").unwrap_or(value).trim();
        let end = value
            .find(|c: char| !(c.is_ascii_digit() || ".,+-eE".contains(c)))
            .unwrap_or(value.len());
        let (number, unit_of_value) = value.split_at(end);
        let TextCell::Number(number) = Decimal::default().read(number, Separator::SPACE) else {
            return None;
        };
        if number <= 0.0 {
            return None;
        }
        let mut unit = only_unit(unit_of_value);
        if unit.is_empty() {
            unit = only_unit(unit_of_key);
        }
        Some(Entry {
            name: name.trim_matches(|c: char| !c.is_alphanumeric()),
            number,
            unit,
        })
    }

    /// Returns the deflection for 1 V in m/V. The file may also state the inverse, in V/m.
    fn sensitivity(&self) -> Option<f64> {
        // A value of exactly 1, such as 1 mV/nm, is not used, because it is the default of an
        // instrument without calibration.
        if !self.unit.is_empty()
            && self.number != 1.0
            && let Some(unit) = ratio(self.unit, "V", "m")
        {
            return Some(1.0 / (self.number * unit));
        }
        Some(self.number * ratio(self.unit, "m", "V")?)
    }
}

fn only_unit(text: &str) -> &str {
    text.trim_matches(|c: char| !(c.is_alphabetic() || c == '/'))
}

/// Returns the SI value that the number 1 means in a ratio of two units, such as nN/nm with `over`
/// N and `under` m. Returns 1 if there is no unit.
fn ratio(text: &str, over: &str, under: &str) -> Option<f64> {
    if text.is_empty() {
        return Some(1.0);
    }
    let (above, below) = text.split_once('/')?;
    Some(unit(above, over)? / unit(below, under)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_instrument_is_read_from_the_lines_of_each_program() {
        let read = |line: &str| {
            let mut metadata = Metadata::default();
            metadata.take(line);
            (
                metadata.stiffness.map(|(_, value)| value),
                metadata.sensitivity,
                metadata.ramp,
            )
        };
        let close = |one: Option<f64>, other: Option<f64>| match (one, other) {
            (Some(one), Some(other)) => (one / other - 1.0).abs() < 1e-12,
            (one, other) => one == other,
        };
        for (line, expected) in [
            ("# springConstant: 0.0122", (Some(0.0122), None, None)),
            ("#   \"spring constant\": 3.0,", (Some(3.0), None, None)),
            ("k (N/m)\t0.28", (Some(0.28), None, None)),
            ("Force Constant, nN/nm: 0.2", (Some(0.2), None, None)),
            ("\\Spring Constant: 42.5", (Some(42.5), None, None)),
            ("Spring constant (pN/nm) = 35,5", (Some(0.0355), None, None)),
            ("# sensitivity: 7.363E-8", (None, Some(7.363e-8), None)),
            ("Light Lever Gain, mV/nm: 20", (None, Some(5e-8), None)),
            ("Light Lever Gain, mV/nm: 1", (None, None, None)),
            (
                "\"\\@Sens. DeflSens: V 65.3 nm/V\"",
                (None, Some(65.3e-9), None),
            ),
            ("Ramp size: 500 nm", (None, None, Some(5e-7))),
            ("# springConstant: unknown", (None, None, None)),
            ("# springConstant: 3 furlong", (None, None, None)),
            ("k-value 3", (None, None, None)),
        ] {
            let found = read(line);
            let all = close(found.0, expected.0)
                && close(found.1, expected.1)
                && close(found.2, expected.2);
            assert!(all, "{line}: {found:?}");
        }
    }
}
