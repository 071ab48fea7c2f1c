//! Lines of numbers in a text, and their meaning: heights, a profile, or a map.

use super::super::Unit;
use super::super::grid::{Digits, Map, map_of, move_to_printed_grid};
use super::super::reading::Reading;
use super::super::surface::LARGEST;
use super::columns::{List, list_of};
use super::header::TextHeader;
use super::{matrix, warnings};
use crate::error::{Place, SurfaceError, refused};
use asperity_data::text_table::{Decimal, ONE_MARK, Role, Separator, TextCell, TextColumn};
use asperity_data::{gathered, push, reserve, shown};
use std::ops::Range;

/// Number of first columns whose printed digits are recorded, because they may be positions.
const FEW_COLUMNS: usize = 4;

/// Largest number of lines, and of numbers in a line, that count the rows and columns that follow.
const MOST_COUNTS: usize = 3;

/// Lines of numbers of a text, in the units of the file.
#[derive(Debug)]
pub(super) struct Table {
    separator: Separator,
    decimal: Decimal,
    /// Number of cells of a line, including empty ones at its end, and number of cells up to the
    /// last one that is not empty.
    cells: usize,
    width: usize,
    values: Vec<f64>,
    /// True for each column with a cell that is not empty.
    is_filled: Vec<bool>,
    /// Printed digits of the first columns, and of the first line without its first number.
    digits: [Digits; FEW_COLUMNS],
    first_line: Digits,
    /// Row and line number wherever a row is not on the line after the row before.
    lines: Vec<(usize, usize)>,
    /// Rows that follow an empty line.
    breaks: Vec<usize>,
    is_paused: bool,
    /// Line number and values of numbers before the first row that count rows and columns.
    counts: Option<(usize, Vec<f64>)>,
}

/// Returns the number of cells of a line, and the number of cells up to the last one that is not
/// empty.
fn widths(separator: Separator, line: &str) -> (usize, usize) {
    let count = |(_, width), (index, cell): (usize, &str)| {
        (index + 1, if cell.is_empty() { width } else { index + 1 })
    };
    separator.split(line).enumerate().fold((0, 0), count)
}

/// Returns an error if one of the two axes of positions has a unit and the other has none.
fn check_both([x, y]: [Option<Unit>; 2]) -> Result<(), SurfaceError> {
    let (Some(unit), None) = (x.or(y), x.and(y)) else {
        return Ok(());
    };
    let found = format!("{unit} is the unit of one position, and the other one has none");
    Err(refused(
        Place::File,
        found,
        "units of both x and y in the file, or of none",
    ))
}

fn is_word(cell: &str) -> bool {
    cell.contains(char::is_alphabetic) && !cell.contains(|c: char| c.is_ascii_digit())
}

/// Returns true for a line before the numbers. Its first cell is no number, another cell is a word,
/// or all cells are empty.
pub(super) fn is_header(line: &str) -> bool {
    let separator = Separator::of(line);
    let is_none = |cell: &str| Decimal::default().read(cell, separator) == TextCell::NoNumber;
    let mut cells = separator.split(line);
    cells.next().is_none_or(is_none)
        || cells.any(|cell| is_none(cell) && is_word(cell))
        || !line.contains(char::is_alphanumeric)
}

impl Table {
    /// Creates an empty table with the layout of this first line.
    fn empty(line: &str) -> Self {
        let separator = Separator::of(line);
        let (cells, width) = widths(separator, line);
        Table {
            separator,
            decimal: Decimal::default(),
            cells,
            width,
            values: Vec::new(),
            is_filled: vec![false; cells],
            digits: [Digits::default(); FEW_COLUMNS],
            first_line: Digits::default(),
            lines: Vec::new(),
            breaks: Vec::new(),
            is_paused: false,
            counts: None,
        }
    }

    /// Begins a table with its first line of numbers. The line before belongs to the table if it
    /// has as many cells, most of them numbers: positions after a word, as in `y\x 0 1 2`.
    pub fn new(
        before: Option<(usize, &str)>,
        number: usize,
        line: &str,
    ) -> Result<Self, SurfaceError> {
        let mut table = Table::empty(line);
        if let Some((number, before)) = before {
            let separator = table.separator;
            let is_number = |cell: &str| {
                matches!(
                    Decimal::default().read(cell, separator),
                    TextCell::Number(_)
                )
            };
            let mut cells = separator.split(before);
            let first = cells.next().unwrap_or_default();
            let numbers = separator
                .split(before)
                .filter(|cell| is_number(cell))
                .count();
            let is_same = widths(separator, before).1 == table.width;
            let has_corner =
                numbers > MOST_COUNTS && numbers + 1 == table.width && !is_number(first);
            if is_same && (has_corner || (2 * numbers > table.width && is_number(first))) {
                table.take_cells(number, before, has_corner)?;
            }
        }
        table.take(number, line)?;
        Ok(table)
    }

    pub fn rows(&self) -> usize {
        self.values.len() / self.cells
    }

    pub fn last_line(&self) -> usize {
        self.line(self.rows() - 1)
    }

    pub fn line(&self, row: usize) -> usize {
        let run = self
            .lines
            .partition_point(|(first, _)| *first <= row)
            .saturating_sub(1);
        self.lines
            .get(run)
            .map_or(0, |(first, line)| line + row - first)
    }

    pub fn pause(&mut self) {
        self.is_paused = true;
    }

    /// Returns true for a line of words between or after lines of numbers.
    pub fn is_heading(&self, line: &str) -> bool {
        // Most lines have no letters but those of exponents.
        if line
            .bytes()
            .all(|byte| byte.is_ascii() && !(byte.is_ascii_alphabetic() && byte | 32 != b'e'))
        {
            return false;
        }
        let mut decimal = self.decimal;
        let is_number =
            |cell: &str| matches!(decimal.read(cell, self.separator), TextCell::Number(_));
        let width = widths(self.separator, line).1;
        let is_other = width != self.width
            || (width < FEW_COLUMNS && !self.separator.split(line).any(is_number));
        is_other && self.separator.split(line).any(is_word)
    }

    /// Reads a line without white space around it. The first lines may count the rows and columns
    /// that follow.
    pub fn take(&mut self, number: usize, line: &str) -> Result<(), SurfaceError> {
        let are_counts = self
            .values
            .iter()
            .all(|value| *value >= 1.0 && value.fract() == 0.0);
        if (1..=MOST_COUNTS).contains(&self.values.len()) && self.counts.is_none() && are_counts {
            let table = Table::empty(line);
            if table.cells > self.cells {
                let counts = (self.line(0), std::mem::take(&mut self.values));
                *self = Table {
                    counts: Some(counts),
                    ..table
                };
            }
        }
        self.take_cells(number, line, false)
    }

    /// Reads a line; with `has_corner` its first cell may be a word.
    fn take_cells(
        &mut self,
        number: usize,
        line: &str,
        has_corner: bool,
    ) -> Result<(), SurfaceError> {
        let (start, row) = (self.values.len(), self.rows());
        let (mut found, mut width) = (0, 0);
        reserve(&mut self.values, self.cells)?;
        for cell in self.separator.split(line) {
            if !cell.is_empty() {
                width = found + 1;
            }
            if found < self.cells {
                let value = if has_corner && found == 0 {
                    f64::NAN
                } else {
                    self.value(number, cell)?
                };
                self.values.push(value);
                self.is_filled[found] |= !cell.is_empty();
                if found < FEW_COLUMNS {
                    self.digits[found].take(cell);
                }
                if row == 0 && found > 0 {
                    self.first_line.take(cell);
                }
            }
            found += 1;
        }
        // Separators at the ends of lines may differ.
        if found != self.cells && width != self.width {
            let expected = match self.width {
                1 => "1, the height".to_owned(),
                2 => "2, position and height".to_owned(),
                3 => "3, two positions and height".to_owned(),
                columns => format!("{columns}, as in the first row"),
            };
            return Err(refused(
                Place::Line(number),
                format!("{found} columns"),
                expected,
            ));
        }
        self.values.resize(start + self.cells, f64::NAN);
        if self
            .lines
            .last()
            .is_none_or(|(first, line)| line + row - first != number)
        {
            push(&mut self.lines, (row, number))?;
        }
        if std::mem::take(&mut self.is_paused) && row > 0 {
            push(&mut self.breaks, row)?;
        }
        Ok(())
    }

    fn value(&mut self, number: usize, cell: &str) -> Result<f64, SurfaceError> {
        let quoted = || format!("{:?}", shown(cell));
        let (fault, allowed) = match self.decimal.read(cell, self.separator) {
            TextCell::Number(value) if value.abs() <= LARGEST * 1e12 => return Ok(value),
            TextCell::Missing => return Ok(f64::NAN),
            TextCell::OtherMark => {
                let fault = format!(
                    "{} has another decimal mark than the numbers before",
                    quoted()
                );
                (fault, ONE_MARK.to_owned())
            }
            TextCell::Number(_) | TextCell::NoNumber => (
                quoted(),
                format!("a number from -{LARGEST:e} to {LARGEST:e}"),
            ),
        };
        Err(refused(Place::Line(number), fault, allowed))
    }

    /// Returns the number of columns up to the last one with a cell that is not empty.
    fn columns(&self) -> usize {
        self.is_filled
            .iter()
            .rposition(|is_filled| *is_filled)
            .map_or(1, |last| last + 1)
    }

    /// Returns the ranges of rows between empty lines where these separate channels. A single range
    /// is returned if each row follows an empty line, or the rows hold positions.
    pub fn parts(&self) -> Vec<Range<usize>> {
        let (rows, columns) = (self.rows(), self.columns());
        let are_apart = (columns == 1 || columns >= FEW_COLUMNS) && self.breaks.len() + 1 < rows;
        let starts = std::iter::once(0).chain(self.breaks.iter().copied().filter(|_| are_apart));
        let ends = self
            .breaks
            .iter()
            .copied()
            .filter(|_| are_apart)
            .chain([rows]);
        starts.zip(ends).map(|(start, end)| start..end).collect()
    }

    /// Returns the surface in these rows. `is_open` is true if the last line has no line end.
    pub fn reading(
        mut self,
        header: &TextHeader,
        rows: Range<usize>,
        is_open: bool,
    ) -> Result<Reading, SurfaceError> {
        self.decimal.check()?;
        let cells = self.cells;
        if rows.len() < self.rows() {
            self.values.truncate(rows.end * cells);
            self.values.drain(..rows.start * cells);
            self.breaks.clear();
            self.lines = vec![(0, self.line(rows.start))];
        }
        let columns = header
            .lines
            .columns(self.columns(), cells, self.separator, Unit::is_name);
        let Some(list) = list_of(&columns)? else {
            return Ok(self.map(header, is_open)?.scaled(|_| false, header.scale()));
        };
        self.check_counts(&[])?;
        let place = |row: usize| Place::Line(self.line(row));
        let mut heights = self.column(list.height)?;
        if let Some(valid) = list.valid {
            for (row, height) in heights.iter_mut().enumerate() {
                match self.values[row * cells + valid] {
                    1.0 => {}
                    0.0 => *height = f64::NAN,
                    other => {
                        let fault =
                            format!("{other:e} in the column {:?}", shown(&columns[valid].name));
                        return Err(refused(place(row), fault, "1 for a measured point, or 0"));
                    }
                }
            }
        }
        let first_missing = heights.iter().position(|height| height.is_nan()).map(place);
        let warnings = warnings::of_heights(&heights, is_open, place);
        let reading = self.points(header, &columns, list, heights)?;
        let reading = reading.scaled(|_| false, header.scale());
        Ok(Reading {
            first_missing,
            warnings,
            ..reading
        })
    }

    fn points(
        mut self,
        header: &TextHeader,
        columns: &[TextColumn],
        List { x, y, height, .. }: List,
        heights: Vec<f64>,
    ) -> Result<Reading, SurfaceError> {
        let format = "text columns";
        let unit = |axis: usize, column: usize| header.unit(axis, Some(&columns[column]));
        let is_y = |column: usize| columns[column].role == Role::Y;
        // Of the columns X and Y the second is the height.
        let of_heights = unit(2, height).or(unit(1, height).filter(|_| is_y(height)));
        let digits = self.digits;
        let digits = |column: usize| digits[column.min(FEW_COLUMNS - 1)];
        match (x, y) {
            (Some(x), Some(y)) => {
                let [of_x, of_y] = [unit(0, x), unit(1, y)];
                let (xs, ys) = (self.column(x)?, self.take_positions(y)?);
                self.check_measured(&xs)?;
                let place = |row: usize| Place::Line(self.line(row));
                let map = map_of([&xs, &ys], &heights, [digits(x), digits(y)], place)?;
                check_both([of_x, of_y])?;
                let units = [of_x, of_y, of_heights];
                Ok(Reading::even(
                    format,
                    map.heights,
                    map.columns,
                    map.distances,
                    units,
                ))
            }
            (Some(x), None) => {
                let lateral = unit(if is_y(x) { 1 } else { 0 }, x);
                let mut positions = self.take_positions(x)?;
                move_to_printed_grid(&mut positions, digits(x))?;
                self.check_order(&positions)?;
                Ok(Reading::profile(
                    format,
                    positions,
                    heights,
                    [lateral, of_heights],
                ))
            }
            (None, _) => {
                let count = heights.len();
                let lateral = header.unit(0, None);
                Ok(Reading::even(
                    format,
                    heights,
                    count,
                    None,
                    [lateral, lateral, of_heights],
                ))
            }
        }
    }

    fn map(mut self, header: &TextHeader, is_open: bool) -> Result<Reading, SurfaceError> {
        let (cells, columns) = (self.cells, self.columns());
        let mut index = 0;
        self.values.retain(|_| {
            index += 1;
            (index - 1) % cells < columns
        });
        self.cells = columns;
        let values = std::mem::take(&mut self.values);
        let place = |row: usize| Place::Line(self.line(row));
        let digits = [self.first_line, self.digits[0]];
        let Map {
            heights,
            columns: found,
            distances,
        } = matrix::without_positions(values, columns, digits, place)?;
        // Positions take the first row and column.
        let above = columns - found;
        let line_of = |index: usize| place(index / found + above);
        let rows = heights.len() / found;
        self.check_counts(&[found, rows])?;
        for (count, stated, name) in [
            (found, header.counts[0], "columns"),
            (rows, header.counts[1], "rows"),
        ] {
            if stated.is_some_and(|stated| stated != count) {
                let fault = format!(
                    "{count} {name} of numbers, {} in the header",
                    stated.unwrap_or_default()
                );
                return Err(refused(Place::File, fault, "as many as the header states"));
            }
        }
        let warnings = warnings::of_heights(&heights, is_open, line_of);
        let first_missing = heights
            .iter()
            .position(|height| height.is_nan())
            .map(line_of);
        let stated = header.distances(found, rows);
        // Sizes are in m.
        let of_axes = if stated.is_some() {
            [Some(Unit::METRE); 2]
        } else {
            [0, 1].map(|axis| header.unit(axis, None))
        };
        if stated.or(distances).is_some() {
            check_both(of_axes)?;
        }
        let units = [of_axes[0], of_axes[1], header.unit(2, None)];
        let (heights, found, stated) = if header.is_along_y {
            let turned = (0..found).flat_map(|y| heights.iter().skip(y).step_by(found).copied());
            (
                gathered(heights.len(), turned)?,
                rows,
                stated.map(|[y, x]| [x, y]),
            )
        } else {
            (heights, found, stated)
        };
        let reading = Reading::even("text matrix", heights, found, stated.or(distances), units);
        Ok(Reading {
            first_missing,
            warnings,
            ..reading
        })
    }

    /// Returns the positions in a column. They take the memory of all numbers, which are no longer
    /// needed.
    fn take_positions(&mut self, column: usize) -> Result<Vec<f64>, SurfaceError> {
        let (cells, mut index) = (self.cells, 0);
        let mut positions = std::mem::take(&mut self.values);
        positions.retain(|_| {
            index += 1;
            (index - 1) % cells == column
        });
        positions.shrink_to_fit();
        self.check_measured(&positions)?;
        Ok(positions)
    }

    fn check_measured(&self, positions: &[f64]) -> Result<(), SurfaceError> {
        let Some(row) = positions.iter().position(|x| x.is_nan()) else {
            return Ok(());
        };
        Err(refused(
            Place::Line(self.line(row)),
            "a position is missing",
            "a number for each position",
        ))
    }

    fn column(&self, column: usize) -> Result<Vec<f64>, SurfaceError> {
        let values = self.values.iter().skip(column).step_by(self.cells).copied();
        Ok(gathered(self.rows(), values)?)
    }

    /// Returns an error unless the numbers before the first row are the numbers of rows, of
    /// distances between them, of columns or of points.
    fn check_counts(&self, of_map: &[usize]) -> Result<(), SurfaceError> {
        let Some((line, counts)) = &self.counts else {
            return Ok(());
        };
        let rows = if of_map.is_empty() {
            self.rows()
        } else {
            of_map[1]
        };
        let columns = of_map.first().copied().unwrap_or(self.columns());
        let known = [rows, rows - 1, columns, rows * columns].map(|count| count as f64);
        let is_known = counts.iter().all(|count| known.contains(count));
        if is_known || counts.iter().product::<f64>() == rows as f64 {
            return Ok(());
        }
        let counts: Vec<String> = counts.iter().map(f64::to_string).collect();
        let fault = format!(
            "{} is no count of the {rows} lines of {columns} columns that follow",
            counts.join(" ")
        );
        let allowed =
            format!("numbers of lines, of columns or of points, or {columns} columns throughout");
        Err(refused(Place::Line(*line), fault, allowed))
    }

    /// Returns an error unless the positions of a profile all ascend or all descend.
    fn check_order(&self, positions: &[f64]) -> Result<(), SurfaceError> {
        let [first, second, ..] = positions else {
            return Ok(());
        };
        let (is_before, allowed): (fn(f64, f64) -> bool, _) = if first < second {
            (|before, x| before < x, "ascending positions, as before")
        } else if first > second {
            (|before, x| before > x, "descending positions, as before")
        } else {
            (|_, _| false, "another position than before")
        };
        let turn = positions
            .windows(2)
            .position(|pair| !is_before(pair[0], pair[1]));
        let Some(row) = turn else { return Ok(()) };
        let fault = format!("x = {:e} after {:e}", positions[row + 1], positions[row]);
        Err(refused(Place::Line(self.line(row + 1)), fault, allowed))
    }
}
