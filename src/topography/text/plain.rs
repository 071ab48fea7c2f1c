//! Plain lines of numbers, read in the buffer itself: most lines of large files.
//!
//! A plain line consists of finite decimal numbers, separators between them, and spaces. Any other line is left to
//! the general reader.

use super::super::reading::LARGEST;
use super::layout::Separator;

/// Most bytes of a number with a decimal comma.
const LONGEST_WITH_COMMA: usize = 32;

/// Form of plain lines.
#[derive(Clone, Copy, Debug)]
pub(super) struct PlainForm {
    pub separator: Separator,
    /// True for decimal commas instead of points.
    pub has_commas: bool,
    pub columns: usize,
}

/// Order of the positions of a profile.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Direction {
    #[default]
    Unknown,
    Ascending,
    Descending,
}

/// Numbers of lines, in the units of the file.
#[derive(Debug, Default)]
pub(super) struct Points {
    /// Columns of positions: none, x, or x and y.
    pub positions: [Vec<f64>; 2],
    /// Heights row by row.
    pub heights: Vec<f64>,
    /// Order of the positions of a profile.
    pub direction: Direction,
}

impl PlainForm {
    /// Number of columns of positions.
    pub fn position_columns(self) -> usize {
        if self.columns <= 3 { self.columns - 1 } else { 0 }
    }

    /// Bytes of a separator with the spaces around it.
    fn separator_length(self, bytes: &[u8]) -> Option<usize> {
        let before = spaces(bytes);
        let mark = match self.separator {
            Separator::Semicolon => b';',
            Separator::Tab => b'\t',
            Separator::Comma => b',',
            Separator::Space => return Some(before).filter(|count| *count > 0),
        };
        let behind = bytes[before..].strip_prefix(&[mark])?;
        Some(before + 1 + spaces(behind))
    }

    /// A number and its bytes; `None` if another rule is needed.
    fn read_number(self, bytes: &[u8]) -> Option<(f64, usize)> {
        let (value, length) = if self.has_commas {
            let mut copy = [0; LONGEST_WITH_COMMA];
            let is_part = |byte: &u8| matches!(byte, b'0'..=b'9' | b',' | b'-' | b'+' | b'e' | b'E');
            let part = copy.iter_mut().zip(bytes.iter().take_while(|byte| is_part(byte)));
            part.for_each(|(to, byte)| *to = if *byte == b',' { b'.' } else { *byte });
            fast_float2::parse_partial(copy).ok()?
        } else {
            fast_float2::parse_partial(bytes).ok()?
        };
        // Neither words such as NaN, nor numbers beyond all lengths.
        (f64::abs(value) <= LARGEST * 1e12).then_some((value, length))
    }
}

impl Points {
    /// Reads plain lines from the beginning of a block, until one is not plain, not whole, or out of order. Returns
    /// the bytes and the number of lines read.
    pub fn read(&mut self, block: &[u8], form: PlainForm) -> (usize, usize) {
        // A number has a digit and a mark after it.
        let most = 1 + block.len() / 2 / form.columns.min(3);
        let mut columns =
            std::iter::once(&mut self.heights).chain(&mut self.positions[..form.position_columns()]);
        if columns.any(|values| values.try_reserve(most).is_err()) {
            // Line by line the memory may still suffice.
            return (0, 0);
        }
        let (mut bytes, mut lines) = (0, 0);
        while let Some(length) = self.read_line(&block[bytes..], form) {
            bytes += length;
            lines += 1;
        }
        (bytes, lines)
    }

    /// Reads a plain line. Returns its bytes, line break included.
    fn read_line(&mut self, bytes: &[u8], form: PlainForm) -> Option<usize> {
        let count = self.heights.len();
        let length = self.read_numbers(bytes, form).filter(|_| self.is_in_order(count, form));
        if length.is_none() {
            // Truncates both columns of positions to the number of heights.
            self.positions.iter_mut().for_each(|positions| positions.truncate(count));
            self.heights.truncate(count);
        }
        length
    }

    fn read_numbers(&mut self, bytes: &[u8], form: PlainForm) -> Option<usize> {
        let position_columns = form.position_columns();
        let mut at = spaces(bytes);
        for column in 0..form.columns {
            if column > 0 {
                at += form.separator_length(&bytes[at..])?;
            }
            let (value, length) = form.read_number(&bytes[at..])?;
            at += length;
            if column < position_columns {
                self.positions[column].push(value);
            } else {
                self.heights.push(value);
            }
        }
        at += spaces(&bytes[at..]);
        match bytes[at..] {
            [b'\n', ..] => Some(at + 1),
            [b'\r', b'\n', ..] => Some(at + 2),
            _ => None,
        }
    }

    /// Returns true if the position with this number continues the direction of a profile.
    fn is_in_order(&self, number: usize, form: PlainForm) -> bool {
        if form.columns != 2 || number == 0 {
            return true;
        }
        let (before, x) = (self.positions[0][number - 1], self.positions[0][number]);
        match self.direction {
            Direction::Ascending => x > before,
            Direction::Descending => x < before,
            Direction::Unknown => false,
        }
    }
}

/// Number of spaces at the beginning.
fn spaces(bytes: &[u8]) -> usize {
    bytes.iter().take_while(|byte| **byte == b' ').count()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn form(separator: Separator, has_commas: bool, columns: usize) -> PlainForm {
        PlainForm { separator, has_commas, columns }
    }

    proptest! {
        #[test]
        fn plain_numbers_are_those_of_the_standard_library(
            text in "[-+]?([0-9]{0,20}([.,][0-9]{0,20})?([eE][-+]?[0-9]{0,4})?|inf|nan|NaN|infinity)[ \n]{0,9}",
            has_commas in any::<bool>(),
        ) {
            if let Some((value, length)) = form(Separator::Space, has_commas, 1).read_number(text.as_bytes()) {
                let number = if has_commas { text[..length].replace(',', ".") } else { text[..length].to_owned() };
                prop_assert_eq!(number.parse::<f64>().map(f64::to_bits), Ok(value.to_bits()), "{}", number);
                prop_assert!(value.is_finite());
            }
        }

        #[test]
        fn usual_numbers_are_plain(
            value in -1e6..1e6_f64,
            decimals in 0..19_usize,
            scientific in any::<bool>(),
            has_commas in any::<bool>(),
        ) {
            let text = if scientific { format!("{value:.decimals$e}") } else { format!("{value:.decimals$}") };
            let written = if has_commas { text.replace('.', ",") } else { text.clone() };
            let (read, length) = form(Separator::Space, has_commas, 1).read_number(written.as_bytes()).unwrap();
            prop_assert_eq!((read.to_bits(), length), (text.parse::<f64>().unwrap().to_bits(), text.len()));
        }
    }

    #[test]
    fn lines_that_are_not_plain_are_left() {
        fn read(block: &str, form: PlainForm) -> (Vec<f64>, Vec<f64>, &str) {
            let mut points = Points { direction: Direction::Ascending, ..Points::default() };
            let (bytes, lines) = points.read(block.as_bytes(), form);
            assert_eq!(lines, block[..bytes].lines().count());
            let Points { positions: [x, _], heights, .. } = points;
            (x, heights, &block[bytes..])
        }
        fn two(rest: &str) -> (Vec<f64>, Vec<f64>, &str) {
            (vec![1.0, 3e2], vec![-2.5, 4.0], rest)
        }
        assert_eq!(read("1\t-2.5\r\n3e2\t4\n", form(Separator::Tab, false, 2)), two(""));
        assert_eq!(read(" 1  -2.5 \r\n3e2 4\n5 6", form(Separator::Space, false, 2)), two("5 6"));
        assert_eq!(read("1; -2,5\n3e2 ;4\n1;1.5\n", form(Separator::Semicolon, true, 2)), two("1;1.5\n"));
        for rest in [
            "# 1;2\n",
            "1e4;2;3\n",
            "1e4\n",
            ";2\n",
            "1e4;\t2\n",
            "NaN;1\n",
            "1e4;NaN\n",
            "1e4;2,5\n",
            "\n",
            "1e99;1\n",
            "1e9999;1\n",
            "99;1\n",
            "1e4;\u{0}\n",
        ] {
            let block = format!("1;-2.5\n3e2;4\n{rest}1e5;8\n");
            assert_eq!(read(&block, form(Separator::Semicolon, false, 2)), two(&block[13..]), "{rest}");
        }
        assert_eq!(read("1,2,3\n", form(Separator::Comma, false, 3)), (vec![1.0], vec![3.0], ""));
        assert_eq!(
            read("1 2 3 4\n5 6 7 8\n9 1\n", form(Separator::Space, false, 4)),
            (vec![], (1..9).map(f64::from).collect(), "9 1\n")
        );
    }
}
