//! Plain lines of numbers, read in the buffer itself: most lines of large files.
//!
//! A plain line consists of finite decimal numbers, separators between them, and spaces. Any other line is left to
//! the general reader.

use super::super::reading::LARGEST;
use super::layout::Separator;
use crate::parallel::{for_each_in_parallel, threads};

/// Fewest bytes of a block for a thread.
const LEAST_SHARE: usize = 1 << 19;

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
    /// the bytes and the number of lines read. All cores share a large block; `spare` is memory for their points.
    pub fn read_shared(&mut self, block: &[u8], form: PlainForm, spare: &mut Vec<Points>) -> (usize, usize) {
        let parts = block.len() / LEAST_SHARE;
        if parts < 2 {
            // Most blocks: without a query of the number of cores.
            return self.read(block, form);
        }
        self.read_in_parts(whole_lines(block, parts.min(threads())), form, spare)
    }

    /// Reads parts of whole lines in parallel, and joins their content in order.
    fn read_in_parts<'b>(
        &mut self,
        parts: impl Iterator<Item = &'b [u8]>,
        form: PlainForm,
        spare: &mut Vec<Points>,
    ) -> (usize, usize) {
        let lines: Vec<&[u8]> = parts.collect();
        let others = lines.len().saturating_sub(1);
        spare.resize_with(spare.len().max(others), Points::default);
        let spare = &mut spare[..others];
        for points in &mut *spare {
            points.clear();
            points.direction = self.direction;
        }
        let points = std::iter::once(&mut *self).chain(&mut *spare);
        let mut parts: Vec<_> =
            lines.iter().zip(points).map(|(lines, points)| (lines, points, (0, 0))).collect();
        for_each_in_parallel(&mut parts, &|(lines, points, read)| *read = points.read(lines, form));
        let read: Vec<(usize, usize)> = parts.into_iter().map(|(.., read)| read).collect();
        let (mut bytes, mut count) = read.first().copied().unwrap_or_default();
        for (index, points) in spare.iter().enumerate() {
            // After an incomplete part the position of the next one is unknown.
            if read[index].0 < lines[index].len() || !self.append(points, form) {
                break;
            }
            (bytes, count) = (bytes + read[index + 1].0, count + read[index + 1].1);
        }
        (bytes, count)
    }

    fn read(&mut self, block: &[u8], form: PlainForm) -> (usize, usize) {
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

    /// Appends points. Returns false, and appends nothing, if the memory does not suffice, or their first position
    /// is out of order.
    fn append(&mut self, behind: &Points, form: PlainForm) -> bool {
        let count = self.heights.len();
        let more = behind.heights.len();
        if more == 0 {
            return true;
        }
        let mut columns =
            std::iter::once(&mut self.heights).chain(&mut self.positions[..form.position_columns()]);
        if columns.any(|values| values.try_reserve(more).is_err()) {
            return false;
        }
        self.positions[0].extend(behind.positions[0].first());
        let is_in_order = self.is_in_order(count, form);
        self.positions[0].truncate(count);
        if is_in_order {
            self.heights.extend_from_slice(&behind.heights);
            let columns = self.positions.iter_mut().zip(&behind.positions);
            columns.for_each(|(positions, more)| positions.extend_from_slice(more));
        }
        is_in_order
    }

    fn clear(&mut self) {
        self.heights.clear();
        self.positions.iter_mut().for_each(Vec::clear);
    }
}

/// At most so many parts of a block, of about equal length, each of whole lines except for the last one.
fn whole_lines(block: &[u8], parts: usize) -> impl Iterator<Item = &[u8]> {
    let mut begin = 0;
    (1..=parts).filter_map(move |part| {
        let from = (block.len() / parts * part).max(begin);
        let line_end = block[from..].iter().position(|byte| *byte == b'\n').filter(|_| part < parts);
        let end = line_end.map_or(block.len(), |line_end| from + line_end + 1);
        let lines = &block[begin..end];
        begin = end;
        (!lines.is_empty()).then_some(lines)
    })
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
        fn parts_side_by_side_are_read_as_the_whole(
            lines in prop::collection::vec((0..40_u32, -9..9_i32, 0..60_u32), 1..40),
            separator in prop::sample::select(vec![Separator::Space, Separator::Semicolon]),
            columns in 1..4_usize,
            parts in 2..9_usize,
            ends in any::<bool>(),
        ) {
            // Most positions ascend; one of thirty lines is not plain.
            let mark = if separator == Separator::Space { " " } else { ";" };
            let line = |(index, (step, z, kind)): (usize, &(u32, i32, u32))| {
                let x = if *step == 0 { 0 } else { 40 * index as u32 + step };
                let cells = [x.to_string(), "0".to_owned(), format!("{z}.5")];
                let word = if *kind < 2 { "bad" } else { "" };
                format!("{}{word}", cells[3 - columns..].join(mark))
            };
            let mut text = lines.iter().enumerate().map(line).collect::<Vec<_>>().join("\n");
            text.push_str(if ends { "\n" } else { "" });
            let read = |parts: usize| {
                let mut points = Points { direction: Direction::Ascending, ..Points::default() };
                let block = text.as_bytes();
                let found = points.read_in_parts(whole_lines(block, parts), form(separator, false, columns), &mut Vec::new());
                format!("{found:?} {points:?}")
            };
            prop_assert_eq!(whole_lines(text.as_bytes(), parts).collect::<Vec<_>>().concat(), text.as_bytes());
            prop_assert_eq!(read(parts), read(1));
        }
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
            let (bytes, lines) = points.read_shared(block.as_bytes(), form, &mut Vec::new());
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

    #[test]
    fn large_blocks_are_read_as_their_lines_are() {
        let line = |index: usize| format!("{index} {:.9}\n", (index as f64).sin());
        let lines = 4 * LEAST_SHARE / 18;
        // Whole, and with one line that ends the reading, in either half or at their border.
        for wrong in
            [lines, lines / 3, lines / 2, lines - 1].into_iter().chain(lines / 2 - 40..lines / 2 + 40)
        {
            let text: String = (0..lines).map(|index| line(if index == wrong { 0 } else { index })).collect();
            assert!(text.len() > 3 * LEAST_SHARE);
            let form = form(Separator::Space, false, 2);
            let mut found = [(); 2].map(|()| Points { direction: Direction::Ascending, ..Points::default() });
            let [shared, alone] = &mut found;
            let counts = shared.read_shared(text.as_bytes(), form, &mut Vec::new());
            assert_eq!(counts, alone.read(text.as_bytes(), form), "{wrong}");
            assert_eq!((counts.1, shared.heights.len()), (wrong.min(lines), wrong.min(lines)));
            assert!(shared.heights == alone.heights && shared.positions == alone.positions, "{wrong}");
        }
    }
}
