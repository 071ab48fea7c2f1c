//! Cells of a line of text: separators and decimal marks.

/// Characters that begin a comment.
pub(crate) const COMMENT: [char; 3] = ['#', '%', '!'];

/// Separator of the columns of a text, determined from its first line of numbers: a semicolon, a tab, a comma, or a space
/// for any white space.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Separator(char);

impl Separator {
    /// Blanks and tabs.
    pub const SPACE: Separator = Separator(' ');

    /// Separator of a line of numbers: a semicolon if there is one, else a tab, else a comma, else spaces. Commas are
    /// decimal marks if semicolons or tabs separate, and if each word between spaces is a number with a comma inside, as in
    /// `0,5 1,25`; `0.5, 1.25` and `0,5` are two columns each.
    pub fn of(line: &str) -> Separator {
        let mut is_outside = outside_quotes();
        let outside: String = line.chars().filter(|c| is_outside(*c)).collect();
        let is_in_line = |mark: &char| outside.contains(*mark) && (*mark != ',' || !has_decimal_commas(line));
        [';', '\t', ','].into_iter().find(is_in_line).map_or(Separator::SPACE, Separator)
    }

    /// Splits a line without spaces around it into columns; separators within quotation marks do not count. A separator
    /// other than spaces has a column on both sides, which may be empty.
    pub fn split(self, line: &str) -> impl Iterator<Item = &str> {
        let is_spaced = self == Separator::SPACE;
        let mut is_outside = outside_quotes();
        let is_mark =
            move |c: char| is_outside(c) && if is_spaced { c.is_ascii_whitespace() } else { c == self.0 };
        let cells = line.split(is_mark).filter(move |cell| !(is_spaced && cell.is_empty()));
        cells.map(|cell| cell.trim().trim_matches('"').trim())
    }
}

/// Function that returns, for each character of a line in turn, whether it is outside quotation marks.
fn outside_quotes() -> impl FnMut(char) -> bool {
    let mut is_inside = false;
    move |c| {
        is_inside ^= c == '"';
        !is_inside
    }
}

/// Returns true for two or more words that are numbers, at least one with a comma inside and none with a point.
fn has_decimal_commas(line: &str) -> bool {
    let is_number = |word: &str| {
        let inside = word.split_once(',').is_none_or(|(before, after)| {
            before.ends_with(|c: char| c.is_ascii_digit()) && after.starts_with(|c: char| c.is_ascii_digit())
        });
        inside && !word.contains('.') && word.replacen(',', ".", 1).parse::<f64>().is_ok()
    };
    line.split_ascii_whitespace().count() > 1 && line.split_ascii_whitespace().all(is_number)
}

/// Content of a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cell {
    /// A number.
    Number(f64),
    /// A mark of a missing point, or an empty column.
    Missing,
    /// A number with a decimal comma, in a text with decimal points, or the other way round.
    OtherMark,
    /// Text that is no number.
    NoNumber,
}

/// Marks of missing points, besides an empty column and `NaN`.
const MISSING: [&str; 9] = ["bad", "missing", "void", "n/a", "#n/a", "--", "---", "***", "*"];

/// Decimal mark of a text, determined by the first one read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Decimal(Option<char>);

impl Decimal {
    /// Reads a cell; the first decimal mark of a text holds for all its numbers.
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
            ("\"0.5\",\"-1.25\"", vec![Number(0.5), Number(-1.25)]),
            ("\"0,5\";\" 1,25 \";\"\"", vec![Number(0.5), Number(1.25), Missing]),
            ("\"0,5\" \"1,25\"", vec![Number(0.5), Number(1.25)]),
            ("\"1,234\",\"5\"", vec![NoNumber, Number(5.0)]),
        ] {
            assert_eq!(read(line), expected, "{line}");
        }
    }
}
