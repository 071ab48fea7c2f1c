//! The lines of numbers of a text, read into a table.

use super::super::positions::LARGEST;
use super::super::printed::Digits;
use crate::error::{Place, SurfaceError, refused};
use asperity_data::text_table::{Decimal, ONE_MARK, Separator, TextCell};
use asperity_data::{push, reserve, shown};
use std::ops::Range;

/// Number of columns at the left whose printed digits are recorded, because these columns may be
/// positions.
pub(super) const FEW_COLUMNS: usize = 4;

/// Largest number of whole numbers before the rows of a table, and of lines with such numbers, that
/// may state how many rows and columns follow.
const MOST_COUNTS: usize = 3;

/// Largest magnitude of a number in a text, in the unit of the text.
const LARGEST_NUMBER: f64 = LARGEST * 1e12;

/// Numbers in the lines of a text, in the units of the file.
#[derive(Debug)]
pub(super) struct Table {
    pub separator: Separator,
    pub decimal: Decimal,
    widths: Widths,
    /// All numbers of the table, line by line. Each line has as many numbers as cells.
    pub values: Vec<f64>,
    /// For each column, true if at least one of its cells is not empty.
    is_filled: Vec<bool>,
    /// Digits with which the numbers in the first columns are printed.
    pub digits: [Digits; FEW_COLUMNS],
    /// Digits with which the numbers in the first line are printed, except the first number.
    pub first_line: Digits,
    /// Runs of rows that are on consecutive lines of the file.
    runs: Vec<Run>,
    /// Indices of the rows before which the file has an empty line.
    breaks: Vec<usize>,
    is_paused: bool,
    /// Numbers before the first row that state how many rows and columns the table has; `None` if
    /// there are no such numbers.
    pub counts: Option<Counts>,
}

/// Numbers of cells in a line.
#[derive(Clone, Copy, Debug, Default)]
struct Widths {
    /// Number of all cells, including empty ones at the end.
    cells: usize,
    /// Number of cells up to the last cell that is not empty.
    filled: usize,
}

impl Widths {
    fn of_line(separator: Separator, line: &str) -> Self {
        let mut widths = Widths::default();
        for cell in separator.split(line) {
            widths.add(cell);
        }
        widths
    }

    fn add(&mut self, cell: &str) {
        self.cells += 1;
        if !cell.is_empty() {
            self.filled = self.cells;
        }
    }
}

/// Run of rows on consecutive lines, given by the index and the line number of its first row.
#[derive(Clone, Copy, Debug)]
struct Run {
    row: usize,
    line: usize,
}

/// Numbers above the rows of a table that state how many rows and columns the table has.
#[derive(Debug)]
pub(super) struct Counts {
    pub line: usize,
    pub values: Vec<f64>,
}

/// A line with its number in the file.
#[derive(Clone, Copy)]
pub(super) struct NumberedLine<'a> {
    pub number: usize,
    pub text: &'a str,
}

fn is_word(cell: &str) -> bool {
    cell.contains(char::is_alphabetic) && !cell.contains(|c: char| c.is_ascii_digit())
}

/// Returns true for a line before the numbers: the first cell is not a number, another cell is a
/// word, or all cells are empty.
pub(super) fn is_header(line: &str) -> bool {
    let separator = Separator::of(line);
    let is_no_number = |cell: &str| Decimal::default().read(cell, separator) == TextCell::NoNumber;
    let mut cells = separator.split(line);
    cells.next().is_none_or(is_no_number)
        || cells.any(|cell| is_no_number(cell) && is_word(cell))
        || !line.contains(char::is_alphanumeric)
}

fn is_number(separator: Separator, cell: &str) -> bool {
    let read = Decimal::default().read(cell, separator);
    matches!(read, TextCell::Number(_))
}

impl Table {
    /// Creates an empty table whose separator and number of cells are those of `line`.
    fn empty(line: &str) -> Self {
        let separator = Separator::of(line);
        let widths = Widths::of_line(separator, line);
        Table {
            separator,
            decimal: Decimal::default(),
            widths,
            values: Vec::new(),
            is_filled: vec![false; widths.cells],
            digits: [Digits::default(); FEW_COLUMNS],
            first_line: Digits::default(),
            runs: Vec::new(),
            breaks: Vec::new(),
            is_paused: false,
            counts: None,
        }
    }

    /// Begins a table with `first`, its first line of numbers. `before` is the line before `first`.
    /// The line `before` also belongs to the table if it has as many cells and one of two forms:
    ///
    /// * It begins with a number and consists mostly of numbers.
    /// * It has positions after a word, as in `y\x 0 1 2`.
    ///
    /// # Errors
    /// Returns an error if a cell of the line cannot be read.
    pub fn new(
        before: Option<NumberedLine<'_>>,
        first: NumberedLine<'_>,
    ) -> Result<Self, SurfaceError> {
        let mut table = Table::empty(first.text);
        if let Some(before) = before {
            table.take_line_before(before)?;
        }
        table.take(first.number, first.text)?;
        Ok(table)
    }

    fn take_line_before(&mut self, line: NumberedLine<'_>) -> Result<(), SurfaceError> {
        let separator = self.separator;
        let width = self.widths.filled;
        if Widths::of_line(separator, line.text).filled != width {
            return Ok(());
        }
        let cells = || separator.split(line.text);
        let begins_with_number = is_number(separator, cells().next().unwrap_or_default());
        let numbers = cells().filter(|cell| is_number(separator, cell)).count();
        let has_corner = !begins_with_number && numbers > MOST_COUNTS && numbers + 1 == width;
        let has_numbers = begins_with_number && 2 * numbers > width;
        if has_corner || has_numbers {
            self.take_cells(line.number, line.text, has_corner)?;
        }
        Ok(())
    }

    /// Returns the number of cells of each row.
    pub fn cells(&self) -> usize {
        self.widths.cells
    }

    pub fn rows(&self) -> usize {
        self.values.len() / self.widths.cells
    }

    pub fn last_line(&self) -> usize {
        self.line(self.rows() - 1)
    }

    /// Returns the number of the line of a row in the file, counted from 1.
    pub fn line(&self, row: usize) -> usize {
        let later = self.runs.partition_point(|run| run.row <= row);
        match self.runs.get(later.saturating_sub(1)) {
            Some(run) => run.line + row - run.row,
            None => 0,
        }
    }

    /// Notes an empty line in the text, so that there is a gap before the next row.
    pub fn pause(&mut self) {
        self.is_paused = true;
    }

    /// Returns true if a line has words instead of numbers. Such a line is a heading between the
    /// lines of numbers, or a text after the last of these lines.
    pub fn is_heading(&self, line: &str) -> bool {
        // A line without letters, except the e of exponents, is a line of numbers. Most lines need
        // no further test.
        let may_be_of_number =
            |byte: u8| byte.is_ascii() && !(byte.is_ascii_alphabetic() && byte | 32 != b'e');
        if line.bytes().all(may_be_of_number) {
            return false;
        }
        let mut decimal = self.decimal;
        let mut is_number =
            |cell: &str| matches!(decimal.read(cell, self.separator), TextCell::Number(_));
        let width = Widths::of_line(self.separator, line).filled;
        let is_other = width != self.widths.filled
            || (width < FEW_COLUMNS && !self.separator.split(line).any(&mut is_number));
        is_other && self.separator.split(line).any(is_word)
    }

    /// Reads one line of the table. The line has no white space at its ends. The first lines may
    /// state how many rows and columns follow.
    ///
    /// # Errors
    /// Returns an error if a cell cannot be read, or if the number of cells differs from that of
    /// the earlier lines.
    pub fn take(&mut self, number: usize, line: &str) -> Result<(), SurfaceError> {
        if self.may_be_counts() {
            let table = Table::empty(line);
            if table.widths.cells > self.widths.cells {
                let counts = Counts {
                    line: self.line(0),
                    values: std::mem::take(&mut self.values),
                };
                *self = Table {
                    counts: Some(counts),
                    ..table
                };
            }
        }
        self.take_cells(number, line, false)
    }

    /// Returns true if all numbers read so far may be numbers of rows or columns that follow.
    fn may_be_counts(&self) -> bool {
        let is_count = |value: &f64| *value >= 1.0 && value.fract() == 0.0;
        (1..=MOST_COUNTS).contains(&self.values.len())
            && self.counts.is_none()
            && self.values.iter().all(is_count)
    }

    /// Reads the cells of a line. If `has_corner` is true, the first cell may be a word.
    fn take_cells(
        &mut self,
        number: usize,
        line: &str,
        has_corner: bool,
    ) -> Result<(), SurfaceError> {
        let cells = self.widths.cells;
        let start = self.values.len();
        let row = self.rows();
        let mut found = Widths::default();
        reserve(&mut self.values, cells)?;
        for cell in self.separator.split(line) {
            let column = found.cells;
            found.add(cell);
            if column >= cells {
                continue;
            }
            let value = if has_corner && column == 0 {
                f64::NAN
            } else {
                self.value(number, cell)?
            };
            self.values.push(value);
            self.is_filled[column] |= !cell.is_empty();
            if column < FEW_COLUMNS {
                self.digits[column].take(cell);
            }
            if row == 0 && column > 0 {
                self.first_line.take(cell);
            }
        }
        // Lines may end with different numbers of separators. Therefore it suffices if the lines
        // agree in their cells up to the last one that is not empty.
        if found.cells != cells && found.filled != self.widths.filled {
            let columns = format!("{} columns", found.cells);
            let allowed = match self.widths.filled {
                1 => "1, the height".to_owned(),
                2 => "2, position and height".to_owned(),
                3 => "3, two positions and height".to_owned(),
                filled => format!("{filled}, as in the first row"),
            };
            return Err(refused(Place::Line(number), columns, allowed));
        }
        self.values.resize(start + cells, f64::NAN);
        let follows = |run: &Run| run.line + row - run.row == number;
        if !self.runs.last().is_some_and(follows) {
            push(&mut self.runs, Run { row, line: number })?;
        }
        if self.is_paused && row > 0 {
            push(&mut self.breaks, row)?;
        }
        self.is_paused = false;
        Ok(())
    }

    /// Reads the number in a cell; NaN for a missing point.
    fn value(&mut self, line: usize, cell: &str) -> Result<f64, SurfaceError> {
        let quoted = || format!("{:?}", shown(cell));
        let (found, allowed) = match self.decimal.read(cell, self.separator) {
            TextCell::Number(value) if value.abs() <= LARGEST_NUMBER => return Ok(value),
            TextCell::Missing => return Ok(f64::NAN),
            TextCell::OtherMark => {
                let cell = quoted();
                let found = format!("{cell} has another decimal mark than the numbers before");
                (found, ONE_MARK.to_owned())
            }
            TextCell::Number(_) | TextCell::NoNumber => {
                let allowed = format!("a number from -{LARGEST:e} to {LARGEST:e}");
                (quoted(), allowed)
            }
        };
        Err(refused(Place::Line(line), found, allowed))
    }

    /// Returns the number of columns up to the last column in which some cell is not empty.
    pub fn columns(&self) -> usize {
        match self.is_filled.iter().rposition(|is_filled| *is_filled) {
            Some(last) => last + 1,
            None => 1,
        }
    }

    /// Returns the rows of each channel as ranges. Empty lines separate the channels. All rows are
    /// one channel if an empty line precedes every row, or if the table has columns of positions.
    pub fn parts(&self) -> Vec<Range<usize>> {
        let rows = self.rows();
        let columns = self.columns();
        let has_no_positions = columns == 1 || columns >= FEW_COLUMNS;
        let mut parts = Vec::new();
        let mut start = 0;
        if has_no_positions && self.breaks.len() + 1 < rows {
            for end in &self.breaks {
                parts.push(start..*end);
                start = *end;
            }
        }
        parts.push(start..rows);
        parts
    }

    /// Removes all rows except `rows`, the rows of one channel.
    pub fn keep_rows(&mut self, rows: Range<usize>) {
        let cells = self.widths.cells;
        let line = self.line(rows.start);
        self.values.truncate(rows.end * cells);
        self.values.drain(..rows.start * cells);
        self.breaks.clear();
        self.runs = vec![Run { row: 0, line }];
    }

    /// Removes all columns after the first `columns`.
    pub fn keep_columns(&mut self, columns: usize) {
        let cells = self.widths.cells;
        let mut index = 0;
        self.values.retain(|_| {
            let is_kept = index % cells < columns;
            index += 1;
            is_kept
        });
        self.widths.cells = columns;
    }

    /// Returns the numbers in a column. The result uses the memory of the table, so that all other
    /// numbers of the table are lost.
    pub fn take_column(&mut self, column: usize) -> Vec<f64> {
        let cells = self.widths.cells;
        let mut values = std::mem::take(&mut self.values);
        let mut index = 0;
        values.retain(|_| {
            let is_of_column = index % cells == column;
            index += 1;
            is_of_column
        });
        values.shrink_to_fit();
        values
    }
}
