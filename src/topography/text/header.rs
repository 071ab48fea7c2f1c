//! Lines before the numbers of a text: units and sizes.

use super::super::Unit;
use super::layout::{Cell, Decimal, Separator};

/// Longest header line that is examined, bytes.
const LONGEST: usize = 4096;

/// Content of the lines before the numbers.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Header {
    /// Units in the order of the columns, from the last line with units.
    pub columns: Vec<Unit>,
    pub lateral: Option<Unit>,
    pub height: Option<Unit>,
    /// Width and height of a map, m.
    pub sizes: [Option<f64>; 2],
}

impl Header {
    /// Reads a line: `key: value` or `key = value` with a unit or a size, or names of columns with units, such as
    /// `x [µm]`, `z (nm)` or `x/mm`, or a row of units alone.
    pub fn take(&mut self, line: &str) {
        if line.len() > LONGEST {
            return;
        }
        let line = line.trim_start_matches(['#', '%', '!', ' ', '\t']);
        if let Some((key, value)) = line.split_once([':', '=']) {
            self.take_entry(&key.trim().to_ascii_lowercase(), value.trim());
        }
        let units: Vec<Unit> = units_of(line);
        if !units.is_empty() {
            self.columns = units;
        }
    }

    fn take_entry(&mut self, key: &str, value: &str) {
        if key.contains("unit") {
            let Ok(unit) = value.trim_matches(['[', ']', '(', ')']).parse::<Unit>() else { return };
            let of_heights = ["value", "z", "height"].iter().any(|name| key.starts_with(name));
            let of_positions = ["x", "lateral"].iter().any(|name| key.starts_with(name));
            if !of_positions {
                self.height = Some(unit);
            }
            if !of_heights {
                self.lateral = Some(unit);
            }
        } else if let Some(axis) = ["width", "height"].iter().position(|name| *name == key) {
            self.sizes[axis] = size(value);
        }
    }

    /// Units of positions and of heights of a text with this number of columns.
    pub fn units(&self, columns: usize) -> [Option<Unit>; 2] {
        let [lateral, height] = match self.columns[..] {
            [first, ..] if columns == 1 => [None, Some(first)],
            // In a map both positions share a unit, or none is known.
            [x, height] if columns == 2 => [Some(x), Some(height)],
            [x, y, height] if columns == 3 => [(x == y).then_some(x), Some(height)],
            _ => [None; 2],
        };
        [lateral.or(self.lateral), height.or(self.height)]
    }
}

/// Size in m, such as `10.5 µm`.
fn size(text: &str) -> Option<f64> {
    let (number, unit) = text.split_once(char::is_whitespace)?;
    let unit: Unit = unit.parse().ok()?;
    match Decimal::default().read(number, Separator::SPACE) {
        Cell::Number(value) if value.is_finite() => Some(unit.to_metres(value)),
        _ => None,
    }
}

/// Units of a line of names: those in brackets; else those after a slash; else all words, if each is a unit.
fn units_of(line: &str) -> Vec<Unit> {
    let in_brackets = |open: char, close: char| -> Vec<Unit> {
        let parts = line.split(open).skip(1);
        parts.filter_map(|part| part.split_once(close)?.0.parse().ok()).collect()
    };
    let words = || line.split([',', ';', '\t', ' ']).map(str::trim).filter(|word| !word.is_empty());
    let behind_slash =
        || words().filter_map(|word| word.split_once('/')?.1.parse().ok()).collect::<Vec<Unit>>();
    let found = [in_brackets('[', ']'), in_brackets('(', ')'), behind_slash()];
    found.into_iter().find(|units| !units.is_empty()).unwrap_or_else(|| {
        words().map(|word| word.parse().ok()).collect::<Option<Vec<Unit>>>().unwrap_or_default()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn units(lines: &[&str], columns: usize) -> [Option<&'static str>; 2] {
        let mut header = Header::default();
        lines.iter().for_each(|line| header.take(line));
        header.units(columns).map(|unit| unit.map(Unit::name))
    }

    #[test]
    fn units_are_found_where_instruments_write_them() {
        let both = [Some("µm"), Some("nm")];
        for lines in [
            &["x [µm]\tz [nm]"][..],
            &["X (um);Z (nm)"],
            &["x/µm z/nm"],
            &["# x [um], z [nm]"],
            &["Position,Height", "µm,nm"],
            &["x unit: µm", "z unit = nm"],
            &["Sample 7 (old)", "x [µm] z [nm]"],
        ] {
            assert_eq!(units(lines, 2), both, "{lines:?}");
        }
        assert_eq!(units(&["# units: mm"], 2), [Some("mm"); 2]);
        assert_eq!(units(&["x [mm] y [mm] z [µm]"], 3), [Some("mm"), Some("µm")]);
        assert_eq!(units(&["x [mm] y [µm] z [µm]"], 3), [None, Some("µm")]);
        assert_eq!(units(&["Value units: m"], 64), [None, Some("m")]);
        for unknown in ["x,z", "x [px], z [V]", "Length 5 mm", ""] {
            assert_eq!(units(&[unknown], 2), [None, None], "{unknown}");
        }
    }

    #[test]
    fn sizes_of_a_map_have_units() {
        let mut header = Header::default();
        ["# Width: 2,5 µm", "# Height: 1.0 mm", "# Width of nothing: 5"]
            .iter()
            .for_each(|line| header.take(line));
        assert_eq!(header.sizes, [Some(2.5e-6), Some(1e-3)]);
    }
}
