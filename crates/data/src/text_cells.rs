//! Cells of a line of text: the separators of columns, and the notation of numbers.

use crate::text_lines::TextFault;

/// Character that separates the columns of a text table: a semicolon, a tab, a comma, or white
/// space.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Separator(char);

impl Separator {
    /// White space: any number of blanks and tabs separates two columns.
    pub const SPACE: Separator = Separator(' ');

    /// Finds the separator of the columns from a line of numbers.
    ///
    /// * The separator is the first of the following marks that the line contains outside quotation
    ///   marks: a semicolon, a tab, a comma.
    /// * If the line contains none of these marks, the separator is white space.
    /// * The separator is also white space for a line such as `0,5 1,25`: the words between blanks
    ///   are all numbers, and commas occur only inside these numbers.
    pub fn of(line: &str) -> Separator {
        let mut is_outside = outside_quotes();
        let outside: String = line.chars().filter(|c| is_outside(*c)).collect();
        for mark in [';', '\t'] {
            if outside.contains(mark) {
                return Separator(mark);
            }
        }
        if outside.contains(',') && !has_decimal_commas(line) {
            return Separator(',');
        }
        Separator::SPACE
    }

    /// Splits a line into its columns. The line must not begin or end with blanks. Separators
    /// inside quotation marks do not split the line.
    pub fn split(self, line: &str) -> impl Iterator<Item = &str> {
        let is_spaced = self == Separator::SPACE;
        let mut is_outside = outside_quotes();
        let is_mark = move |c: char| {
            let is_separator = if is_spaced {
                c.is_ascii_whitespace()
            } else {
                c == self.0
            };
            is_outside(c) && is_separator
        };
        line.split(is_mark)
            .filter(move |cell| !(is_spaced && cell.is_empty()))
            .map(|cell| cell.trim().trim_matches('"').trim())
    }
}

/// Returns a function to be called with each character of a line in turn. The function returns true
/// if the character is outside quotation marks.
fn outside_quotes() -> impl FnMut(char) -> bool {
    let mut is_inside = false;
    move |c| {
        is_inside ^= c == '"';
        !is_inside
    }
}

/// Returns true if the line consists of two or more numbers, separated by blanks, that have the
/// same decimal mark and contain commas only between digits.
fn has_decimal_commas(line: &str) -> bool {
    let mut decimal = Decimal::default();
    for word in line.split_ascii_whitespace() {
        let content = decimal.read(word, Separator::SPACE);
        let is_number = matches!(content, TextCell::Number(_) | TextCell::Missing);
        if !is_number || !has_digits_around_comma(word) {
            return false;
        }
    }
    line.split_ascii_whitespace().count() > 1
}

/// Returns true if a word contains no comma, or if its first comma is between two digits.
fn has_digits_around_comma(word: &str) -> bool {
    let Some((before, after)) = word.split_once(',') else {
        return true;
    };
    before.ends_with(|c: char| c.is_ascii_digit())
        && after.starts_with(|c: char| c.is_ascii_digit())
}

/// Content of a cell of a text table, as [`Decimal::read`] returns it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TextCell {
    /// A number.
    Number(f64),
    /// An empty cell, or a text such as `NaN` that marks a missing point.
    Missing,
    /// A number whose decimal mark differs from the decimal mark of earlier numbers in the table,
    /// such as `0,5` after `0.5`.
    OtherMark,
    /// Text that cannot be read as a number.
    NoNumber,
}

/// Texts that mark a missing point, in addition to an empty cell and `NaN`.
const MISSING: [&str; 9] = [
    "bad", "missing", "void", "n/a", "#n/a", "--", "---", "***", "*",
];

/// Part of the error message for a cell with a different decimal mark ([`TextCell::OtherMark`]).
/// The text states which decimal marks and thousands separators a text table may have.
pub const ONE_MARK: &str =
    "one decimal mark throughout, and no separators of thousands but spaces or apostrophes";

/// Characters that can separate thousands. A comma or a point can also be a decimal mark.
const GROUPING: [char; 8] = [
    ',', '.', ' ', '\u{a0}', '\u{2009}', '\u{202f}', '\'', '\u{2019}',
];

/// Reader of the numbers in a text table. The reader learns the decimal mark from the first number
/// that has one, and the thousands separator from the first number that has one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Decimal {
    /// Decimal mark; `None` as long as no number has one.
    mark: Option<char>,
    /// Comma or point, if a number has shown that it separates thousands: a number with two
    /// different marks, such as `1,234.5`, or with two groups, such as `1,234,567`. Otherwise
    /// `None`.
    group: Option<char>,
    /// True if a number has been read whose comma cannot separate thousands, such as `0,5`.
    is_certain: bool,
    /// True if a number without a decimal mark has been read.
    has_whole: bool,
}

impl Decimal {
    /// Reads the content of a cell. The first number with a decimal mark determines the decimal
    /// mark of all later numbers.
    pub fn read(&mut self, cell: &str, separator: Separator) -> TextCell {
        // Spreadsheets and papers use this character as minus sign.
        if cell.contains('\u{2212}') {
            return self.read(&cell.replace('\u{2212}', "-"), separator);
        }
        let parsed = cell.parse::<f64>();
        if (parsed.is_err() || self.group == Some('.'))
            && let Some(grouped) = Grouped::read(cell, self.group)
        {
            return self.read_grouped(&grouped, separator);
        }
        if let Ok(value) = parsed {
            let mark = cell.contains('.').then_some('.');
            return self.take(value, mark);
        }
        if cell.is_empty() || MISSING.iter().any(|mark| mark.eq_ignore_ascii_case(cell)) {
            return TextCell::Missing;
        }
        if separator == Separator(',') && may_be_grouped(cell) {
            return TextCell::OtherMark;
        }
        if separator == Separator(',') || cell.contains('.') {
            return TextCell::NoNumber;
        }
        let Ok(value) = cell.replacen(',', ".", 1).parse() else {
            return TextCell::NoNumber;
        };
        self.is_certain |= !may_be_grouped(cell);
        self.take(value, Some(','))
    }

    /// Reads a number that contains thousands separators.
    fn read_grouped(&mut self, number: &Grouped, separator: Separator) -> TextCell {
        let mark = Some(number.group).filter(|mark| [',', '.'].contains(mark));
        if mark.is_some() && mark == self.mark {
            return TextCell::OtherMark;
        }
        self.group = self.group.or(mark);
        self.read(&number.ungrouped, separator)
    }

    /// Returns the value, or [`TextCell::OtherMark`] if earlier numbers have another decimal mark.
    fn take(&mut self, value: f64, mark: Option<char>) -> TextCell {
        if value.is_nan() {
            return TextCell::Missing;
        }
        if mark.is_some() {
            let differs = self.mark.is_some() && mark != self.mark;
            if differs || mark == self.group {
                return TextCell::OtherMark;
            }
        }
        self.mark = self.mark.or(mark);
        self.has_whole |= mark.is_none();
        TextCell::Number(value)
    }

    /// Returns an error if the commas in the numbers read so far are ambiguous. For example, the
    /// comma in `1,234` can be a decimal mark or a thousands separator.
    pub fn check(&self) -> Result<(), TextFault> {
        let is_doubtful = self.mark == Some(',') && self.has_whole && !self.is_certain;
        if is_doubtful {
            Err(TextFault::DoubtfulCommas)
        } else {
            Ok(())
        }
    }
}

/// Returns true for a number such as `1,234`, in which the comma may separate thousands.
fn may_be_grouped(cell: &str) -> bool {
    Grouped::read(cell, Some(',')).is_some_and(|number| number.group == ',')
}

/// A number that contained thousands separators.
struct Grouped {
    /// The number without its thousands separators.
    ungrouped: String,
    /// The thousands separator.
    group: char,
}

impl Grouped {
    /// Reads a number that contains thousands separators; `None` for any other text. A comma or a
    /// point that occurs only once is a thousands separator if it is equal to `known`, or if a
    /// decimal mark follows it.
    fn read(cell: &str, known: Option<char>) -> Option<Self> {
        let unsigned = cell.trim_start_matches(['+', '-']);
        let sign = &cell[..cell.len() - unsigned.len()];
        let group = unsigned.chars().find(|c| !c.is_ascii_digit())?;
        if !GROUPING.contains(&group) {
            return None;
        }
        let (first, mut rest) = unsigned.split_once(group)?;
        if !(1..=3).contains(&first.len()) || first.starts_with('0') {
            return None;
        }
        let mut ungrouped = sign.to_owned() + first;
        let mut groups = 0;
        loop {
            let end = rest
                .find(|c: char| !c.is_ascii_digit())
                .unwrap_or(rest.len());
            if end != 3 {
                return None;
            }
            ungrouped += &rest[..end];
            groups += 1;
            rest = &rest[end..];
            let Some(next) = rest.strip_prefix(group) else {
                break;
            };
            rest = next;
        }
        let has_decimals = rest.starts_with([',', '.']);
        let may_be_decimal_mark = [',', '.'].contains(&group);
        if may_be_decimal_mark && groups == 1 && !has_decimals && known != Some(group) {
            return None;
        }
        ungrouped += rest;
        Some(Grouped { ungrouped, group })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(line: &str) -> Vec<TextCell> {
        let separator = Separator::of(line);
        let mut decimal = Decimal::default();
        separator
            .split(line)
            .map(|cell| decimal.read(cell, separator))
            .collect()
    }

    #[test]
    fn separators_and_decimal_marks_differ() {
        use TextCell::{Missing, NoNumber, Number, OtherMark};
        for (line, expected) in [
            ("0.5 1.25", vec![Number(0.5), Number(1.25)]),
            ("0.5\t1.25", vec![Number(0.5), Number(1.25)]),
            ("0.5, 1.25", vec![Number(0.5), Number(1.25)]),
            ("0.5,1.25", vec![Number(0.5), Number(1.25)]),
            ("0,5", vec![Number(0.0), Number(5.0)]),
            ("0,5 1,25", vec![Number(0.5), Number(1.25)]),
            (
                "0,5 1,25e-3 7",
                vec![Number(0.5), Number(1.25e-3), Number(7.0)],
            ),
            ("0,5;1,25", vec![Number(0.5), Number(1.25)]),
            ("0,5\t-1,25E+2", vec![Number(0.5), Number(-125.0)]),
            ("0,5; 1.25", vec![Number(0.5), OtherMark]),
            ("0.5;1,25", vec![Number(0.5), OtherMark]),
            ("1.2,34;2", vec![NoNumber, Number(2.0)]),
            (
                "1;;NaN;bad;x",
                vec![Number(1.0), Missing, Missing, Missing, NoNumber],
            ),
            ("1,,2", vec![Number(1.0), Missing, Number(2.0)]),
            ("12", vec![Number(12.0)]),
            ("\"0.5\",\"-1.25\"", vec![Number(0.5), Number(-1.25)]),
            (
                "\"0,5\";\" 1,25 \";\"\"",
                vec![Number(0.5), Number(1.25), Missing],
            ),
            ("\"0,5\" \"1,25\"", vec![Number(0.5), Number(1.25)]),
            ("\"1,234\",\"5\"", vec![OtherMark, Number(5.0)]),
            ("\"0,5\",\"5\"", vec![NoNumber, Number(5.0)]),
        ] {
            assert_eq!(read(line), expected, "{line}");
        }
    }

    /// A comma or a point is a thousands separator if it cannot be a decimal mark.
    #[test]
    fn thousands_are_separated_where_no_mark_is_doubtful() {
        use TextCell::{NoNumber, Number, OtherMark};
        for (line, expected) in [
            (
                "1,234.5;-2,345,678;1,234",
                vec![Number(1234.5), Number(-2345678.0), Number(1234.0)],
            ),
            (
                "1.234,5;2.345;0,5",
                vec![Number(1234.5), Number(2345.0), Number(0.5)],
            ),
            (
                "1'234.5\t2\u{2019}345\t0.5",
                vec![Number(1234.5), Number(2345.0), Number(0.5)],
            ),
            (
                "1 234,5;\u{2212}12 345 678e-3;0,5",
                vec![Number(1234.5), Number(-12345.678), Number(0.5)],
            ),
            (
                "1\u{a0}234.5 2\u{202f}345.5",
                vec![Number(1234.5), Number(2345.5)],
            ),
            ("1,234.5 999.5", vec![Number(1234.5), Number(999.5)]),
            (
                "\"1,234.5\",\"2,345\"",
                vec![Number(1234.5), Number(2345.0)],
            ),
            // In each line, the comma of one number contradicts the decimal mark of another number.
            ("0.5;1,234", vec![Number(0.5), OtherMark]),
            ("1,234;1,234.5", vec![Number(1.234), OtherMark]),
            ("1,234.5;0,5", vec![Number(1234.5), OtherMark]),
            // Each group must have three digits, so none of these texts is a number.
            (
                "1 23;1,2345.6;0,123.4;1234,567.8;1,234,56",
                vec![NoNumber; 5],
            ),
        ] {
            assert_eq!(read(line), expected, "{line}");
        }
    }

    /// If the other numbers have no comma, `1,234` can mean 1.234 or 1234.
    #[test]
    fn doubtful_commas_are_refused() {
        for (line, is_doubtful) in [
            ("999;1,234", true),
            ("999;-1,234;5;2,345", true),
            // In these lines the meaning of a comma is certain, for example because all numbers
            // have three decimals, or because some commas can only be decimal marks.
            ("1,234;2,345", false),
            ("999;1,234;0,123", false),
            ("999;1,234;2,5", false),
            ("999;1.234", false),
            ("999;1,234.5", false),
        ] {
            let separator = Separator::of(line);
            let mut decimal = Decimal::default();
            separator.split(line).for_each(|cell| {
                assert!(matches!(decimal.read(cell, separator), TextCell::Number(_)))
            });
            assert_eq!(decimal.check().is_err(), is_doubtful, "{line}");
        }
    }
}
