//! Plain text with aligned columns, for a terminal of 80 columns.

use asperity_data::{format_quantity, printable, wrap};
use std::ops::Range;

/// Largest width of a line in characters. It is the width of the smallest usual terminal.
pub(crate) const WIDTH: usize = 80;

/// Smallest width in characters of the last column of a table. If there is less room, the last
/// column begins on the next line.
const FEWEST_IN_LAST: usize = 20;

/// Indentation in characters of a last column that begins on the next line.
const INDENT: usize = 4;

/// Width in characters of the labels of rows.
const LABEL: usize = 26;

/// Number of blanks between two columns of a table.
const BETWEEN: usize = 2;

/// Plain text whose lines have at most 80 columns. Headings, rows, tables and paragraphs are added
/// to its end.
#[derive(Default)]
pub struct Sheet {
    text: String,
}

/// Cell of a table, with the width of its column in characters.
struct Cell<'a> {
    text: &'a str,
    width: usize,
}

impl Sheet {
    /// Returns a text that consists of one table.
    pub fn of_table<R: AsRef<[String]>>(rows: &[R]) -> String {
        let mut sheet = Sheet::default();
        sheet.table(rows);
        sheet.into_text()
    }

    pub fn into_text(self) -> String {
        self.text
    }

    /// Adds a heading, with an empty line before it unless it is the first line of the text.
    pub fn heading(&mut self, heading: &str) {
        if !self.text.is_empty() {
            self.text.push('\n');
        }
        self.paragraph(heading);
    }

    /// Adds a paragraph, which is broken into lines of at most 80 columns.
    pub fn paragraph(&mut self, text: &str) {
        for line in text.lines() {
            for part in wrap(line, WIDTH) {
                self.line(&part);
            }
        }
    }

    /// Adds a row of a label and a value.
    pub fn row(&mut self, label: &str, value: impl AsRef<str>) {
        let mut label = label;
        for line in wrap(value.as_ref(), WIDTH - LABEL) {
            debug_assert!(label.chars().count() < LABEL - 2, "{label}");
            self.line(&format!("  {}{line}", padded(label, LABEL - 2)));
            label = "";
        }
    }

    /// Adds a row with a label and a number. The number is given in the SI unit `unit` and written
    /// with a prefix. Adds nothing for `None`.
    pub fn quantity(&mut self, label: &str, value: impl Into<Option<f64>>, unit: &str) {
        if let Some(value) = value.into() {
            self.row(label, format_quantity(value, unit));
        }
    }

    /// Adds a row with a label and a value. Adds nothing for `None`.
    pub fn row_of(&mut self, label: &str, value: Option<String>) {
        if let Some(value) = value {
            self.row(label, value);
        }
    }

    /// Adds a table with aligned columns. If the table is too wide, it is divided into several
    /// tables, each of which begins with the first column.
    pub fn table<R: AsRef<[String]>>(&mut self, rows: &[R]) {
        let widths = widths_of(rows);
        let mut begin = widths.len().min(1);
        loop {
            let end = end_of_part(&widths, begin);
            for row in rows {
                self.table_row(row.as_ref(), &widths, begin..end);
            }
            if end >= widths.len() {
                return;
            }
            self.text.push('\n');
            begin = end;
        }
    }

    /// Adds a line with those cells of a row that are in the first column or in the columns
    /// `columns`.
    fn table_row(&mut self, row: &[String], widths: &[usize], columns: Range<usize>) {
        let mut cells = Vec::with_capacity(row.len());
        for (column, text) in row.iter().enumerate() {
            if column == 0 || columns.contains(&column) {
                let width = widths[column];
                cells.push(Cell { text, width });
            }
        }
        self.cells(&cells);
    }

    /// Adds a line of cells. If there is too little room for the last cell, this cell begins on the
    /// next line.
    fn cells(&mut self, cells: &[Cell<'_>]) {
        let Some((last, others)) = cells.split_last() else {
            return;
        };
        let mut before = String::new();
        for cell in others {
            before += &padded(cell.text, cell.width + BETWEEN);
        }
        let mut room = WIDTH.saturating_sub(before.chars().count());
        if room < FEWEST_IN_LAST && last.text.chars().count() > room {
            self.line(&before);
            before = " ".repeat(INDENT);
            room = WIDTH - INDENT;
        }
        for line in wrap(last.text, room) {
            self.line(&format!("{before}{line}"));
            before = " ".repeat(before.chars().count());
        }
    }

    fn line(&mut self, line: &str) {
        // Titles and names of files, machines and processes may contain control characters.
        // `printable` replaces them.
        self.text.push_str(&printable(line.trim_end()));
        self.text.push('\n');
    }
}

/// Returns the width of each column of a table: the number of characters of its longest cell.
fn widths_of<R: AsRef<[String]>>(rows: &[R]) -> Vec<usize> {
    let mut widths = Vec::new();
    for row in rows {
        for (column, text) in row.as_ref().iter().enumerate() {
            let width = text.chars().count();
            if column == widths.len() {
                widths.push(width);
            } else {
                widths[column] = width.max(widths[column]);
            }
        }
    }
    widths
}

/// Returns the index after the last column that fits into a line, if the line contains the first
/// column and then the columns from `begin` on. Column `begin` always counts as fitting.
fn end_of_part(widths: &[usize], begin: usize) -> usize {
    let first = widths.first().map_or(0, |width| width + BETWEEN);
    let mut room = WIDTH.saturating_sub(first);
    for (column, &width) in widths.iter().enumerate().skip(begin) {
        // The last column needs less room, because its long sentences are broken into several
        // lines.
        let is_last = column + 1 == widths.len();
        let needed = if is_last {
            width.min(FEWEST_IN_LAST)
        } else {
            width
        };
        if needed > room && column > begin {
            return column;
        }
        room = room.saturating_sub(width + BETWEEN);
    }
    widths.len()
}

/// Returns at most `most` evenly spaced rows of a table, including the last row.
pub(crate) fn thinned<I: ExactSizeIterator>(rows: I, most: usize) -> impl Iterator<Item = I::Item> {
    let last = rows.len().saturating_sub(1);
    let stride = rows.len().div_ceil(most).max(1);
    rows.skip(last % stride).step_by(stride)
}

fn padded(text: &str, width: usize) -> String {
    let blanks = width.saturating_sub(text.chars().count());
    format!("{text}{}", " ".repeat(blanks))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(rows: &[Vec<String>]) -> Vec<String> {
        let mut sheet = Sheet::default();
        sheet.table(rows);
        sheet.into_text().lines().map(str::to_owned).collect()
    }

    #[test]
    fn columns_are_as_wide_as_their_cells() {
        let lines = lines(
            &[["a", "b", &"c ".repeat(60)], ["aaa", "", "d"]]
                .map(|row| row.map(String::from).to_vec()),
        );
        assert_eq!(lines.len(), 3, "{lines:?}");
        assert!(lines[0].starts_with("a    b  c c"), "{lines:?}");
        assert!(lines[1].starts_with("        c c"), "{lines:?}");
        assert_eq!(lines[2], "aaa     d");
        assert!(lines.iter().all(|line| line.len() <= WIDTH));
    }

    #[test]
    fn columns_that_do_not_fit_are_a_further_table() {
        let row = |first: &str| {
            let others = (1..8).map(|column| format!("{column}{}", "x".repeat(13)));
            std::iter::once(first.to_owned())
                .chain(others)
                .collect::<Vec<_>>()
        };
        let lines = lines(&[row("setting"), row("16")]);
        let starts: Vec<String> = lines
            .iter()
            .map(|line| line.chars().take(10).collect())
            .collect();
        assert_eq!(
            starts,
            ["setting  1", "16       1", "", "setting  5", "16       5"]
        );
        assert!(lines.iter().all(|line| line.len() <= WIDTH));
    }
}
