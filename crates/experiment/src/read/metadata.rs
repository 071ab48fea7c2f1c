//! What the lines above the numbers of a curve say about the instrument.

use asperity_data::parse_quantity;
use asperity_data::text_table::{Decimal, Separator, TextCell};

/// Names of the stiffness of the instrument, of the deflection for 1 V, and of the travel of the
/// piezo, as letters.
const STIFFNESS: [&str; 6] = [
    "springconstant",
    "forceconstant",
    "cantileverstiffness",
    "cantileverspringconstant",
    "springk",
    "k",
];
const SENSITIVITY: [&str; 5] = [
    "sensitivity",
    "deflectionsensitivity",
    "sensdeflsens",
    "sensdeflection",
    "lightlevergain",
];
const RAMP: [&str; 3] = ["rampsize", "ramplength", "zscansize"];

/// Stiffness and sensitivity of the instrument, and the travel of its piezo.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Metadata {
    /// Name in the file and value of the stiffness of the instrument, N/m.
    pub stiffness: Option<(String, f64)>,
    /// Deflection for 1 V, m/V.
    pub sensitivity: Option<f64>,
    /// Travel of the piezo, m.
    pub ramp: Option<f64>,
}

impl Metadata {
    /// Reads a line `key: value`, `key = value`, or `key`, a tab and `value`. The unit is behind
    /// the key or the value; without a unit the value is in SI units.
    pub fn take(&mut self, line: &str) {
        let parts = line
            .rsplit_once(": ")
            .or_else(|| line.split_once([':', '=', '\t']));
        let Some((key, value)) = parts else { return };
        let (name, of_key) = key.split_once(['(', '[', ',']).unwrap_or((key, ""));
        let name = name.trim_matches(|c: char| !c.is_alphanumeric());
        let letters: String = name
            .chars()
            .filter(|c| c.is_alphanumeric())
            .flat_map(char::to_lowercase)
            .collect();
        let value = value.trim_matches(|c: char| !(c.is_alphanumeric() || "+-./".contains(c)));
        // Instruments write `V 65.3 nm/V` for a value that depends on a voltage.
        let value = value.strip_prefix("V ").unwrap_or(value).trim();
        let end = value
            .find(|c: char| !(c.is_ascii_digit() || ".,+-eE".contains(c)))
            .unwrap_or(value.len());
        let (number, of_value) = value.split_at(end);
        let TextCell::Number(number) = Decimal::default().read(number, Separator::SPACE) else {
            return;
        };
        if number <= 0.0 {
            return;
        }
        let unit = [of_value, of_key]
            .map(|unit| unit.trim_matches(|c: char| !(c.is_alphabetic() || c == '/')));
        let unit = unit
            .into_iter()
            .find(|unit| !unit.is_empty())
            .unwrap_or_default();
        let is = |names: &[&str]| names.contains(&&*letters);
        if is(&STIFFNESS) {
            if let Some(of_one) = ratio(unit, "N", "m") {
                self.stiffness = Some((name.to_owned(), number * of_one));
            }
        } else if is(&SENSITIVITY) {
            let inverse = ratio(unit, "V", "m").map(|of_one| 1.0 / (number * of_one));
            // A gain of 1 mV/nm is that of an instrument without calibration.
            let inverse = inverse.filter(|_| !unit.is_empty() && number != 1.0);
            self.sensitivity = inverse
                .or(ratio(unit, "m", "V").map(|of_one| number * of_one))
                .or(self.sensitivity);
        } else if is(&RAMP) {
            self.ramp = parse_quantity(&format!("{number:e} {unit}"), "m")
                .ok()
                .or(self.ramp);
        }
    }
}

/// Returns the SI value of 1 in a unit that is a ratio, such as nN/nm; 1 without a unit.
fn ratio(unit: &str, over: &str, under: &str) -> Option<f64> {
    if unit.is_empty() {
        return Some(1.0);
    }
    let (above, below) = unit.split_once('/')?;
    let of_one = |text: &str, unit: &str| {
        parse_quantity(&format!("1 {text}"), unit)
            .ok()
            .filter(|_| text.ends_with(unit))
    };
    Some(of_one(above, over)? / of_one(below, under)?)
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
