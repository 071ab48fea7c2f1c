//! Lines of a text: units and sizes before the numbers, and columns of numbers with their separators and decimal marks.

use super::super::Unit;

/// Separator of the columns of a text, from its first line of numbers: a semicolon, a tab, a comma, or a space for any
/// white space.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Separator(char);

impl Separator {
    pub const SPACE: Separator = Separator(' ');

    /// Separator of a line of numbers: a semicolon if there is one, else a tab, else a comma, else spaces. Commas
    /// are decimal marks beside semicolons and tabs, and if each word between spaces is a number with a comma
    /// inside, as in `0,5 1,25`; `0.5, 1.25` and `0,5` are two columns.
    pub fn of(line: &str) -> Separator {
        let is_in_line = |mark: &char| line.contains(*mark) && (*mark != ',' || !has_decimal_commas(line));
        [';', '\t', ','].into_iter().find(is_in_line).map_or(Separator::SPACE, Separator)
    }

    /// Columns of a line without spaces around it. Separators other than spaces have columns on both sides, which may
    /// be empty.
    pub fn split(self, line: &str) -> impl Iterator<Item = &str> {
        let is_spaced = self == Separator::SPACE;
        let is_mark = move |c: char| if is_spaced { c.is_ascii_whitespace() } else { c == self.0 };
        line.split(is_mark).filter(move |cell| !(is_spaced && cell.is_empty())).map(str::trim)
    }
}

/// Returns true for two or more words, each a number, at least one with a comma inside and none with a point.
fn has_decimal_commas(line: &str) -> bool {
    let is_number = |word: &str| {
        let inside = word.split_once(',').is_none_or(|(before, after)| {
            before.ends_with(|c: char| c.is_ascii_digit()) && after.starts_with(|c: char| c.is_ascii_digit())
        });
        inside && !word.contains('.') && word.replacen(',', ".", 1).parse::<f64>().is_ok()
    };
    line.split_ascii_whitespace().count() > 1 && line.split_ascii_whitespace().all(is_number)
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Cell {
    Number(f64),
    /// A mark of a missing point, or an empty column.
    Missing,
    /// A number with a decimal comma, in a text with decimal points, or the other way round.
    OtherMark,
    NoNumber,
}

/// Marks of missing points, in addition to an empty column and `NaN`.
const MISSING: [&str; 9] = ["bad", "missing", "void", "n/a", "#n/a", "--", "---", "***", "*"];

/// Decimal mark of a text: the first one found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Decimal(Option<char>);

impl Decimal {
    pub fn read(&mut self, cell: &str, separator: Separator) -> Cell {
        // The minus sign of spreadsheets and papers.
        if cell.contains('\u{2212}') {
            return self.read(&cell.replace('\u{2212}', "-"), separator);
        }
        let (value, mark) = if let Ok(value) = cell.parse::<f64>() {
            (value, cell.contains('.').then_some('.'))
        } else if cell.is_empty() || MISSING.iter().any(|mark| mark.eq_ignore_ascii_case(cell)) {
            return Cell::Missing;
        } else if separator == Separator(',') || cell.contains('.') {
            return Cell::NoNumber;
        } else {
            let Ok(value) = cell.replacen(',', ".", 1).parse() else { return Cell::NoNumber };
            (value, Some(','))
        };
        if value.is_nan() {
            return Cell::Missing;
        }
        match (self.0, mark) {
            (Some(found), Some(mark)) if found != mark => return Cell::OtherMark,
            (None, mark) => self.0 = mark,
            _ => {}
        }
        Cell::Number(value)
    }
}

/// Longest header line that is examined, bytes.
const LONGEST: usize = 4096;

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

    fn read(line: &str) -> Vec<Cell> {
        let separator = Separator::of(line);
        let mut decimal = Decimal::default();
        separator.split(line).map(|cell| decimal.read(cell, separator)).collect()
    }

    #[test]
    fn separators_and_decimal_marks_differ() {
        use Cell::{Missing, NoNumber, Number, OtherMark};
        for (line, expected) in [
            ("0.5 1.25", vec![Number(0.5), Number(1.25)]),
            ("0.5\t1.25", vec![Number(0.5), Number(1.25)]),
            ("0.5, 1.25", vec![Number(0.5), Number(1.25)]),
            ("0.5,1.25", vec![Number(0.5), Number(1.25)]),
            ("0,5", vec![Number(0.0), Number(5.0)]),
            ("0,5 1,25", vec![Number(0.5), Number(1.25)]),
            ("0,5 1,25e-3 7", vec![Number(0.5), Number(1.25e-3), Number(7.0)]),
            ("0,5;1,25", vec![Number(0.5), Number(1.25)]),
            ("0,5\t-1,25E+2", vec![Number(0.5), Number(-125.0)]),
            ("0,5; 1.25", vec![Number(0.5), OtherMark]),
            ("0.5;1,25", vec![Number(0.5), OtherMark]),
            ("1,234.5;2", vec![NoNumber, Number(2.0)]),
            ("1;;NaN;bad;x", vec![Number(1.0), Missing, Missing, Missing, NoNumber]),
            ("1,,2", vec![Number(1.0), Missing, Number(2.0)]),
            ("12", vec![Number(12.0)]),
        ] {
            assert_eq!(read(line), expected, "{line}");
        }
    }

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
