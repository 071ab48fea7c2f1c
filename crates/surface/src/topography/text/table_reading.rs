//! Conversion of a table to a surface: heights alone, a profile, points of a map, or rows of a map.

use super::super::channel::Wanted;
use super::super::grid::PointList;
use super::super::printed::{Digits, move_to_printed_grid};
use super::super::reading::Reading;
use super::super::stated_units::StatedUnits;
use super::super::transpose::transposed;
use super::super::unit::Unit;
use super::columns::{List, list_of};
use super::header::{TextHeader, X, Y, Z};
use super::table::{FEW_COLUMNS, Table};
use super::{matrix, warnings};
use crate::error::{Place, SurfaceError, refused};
use asperity_data::text_table::{Role, TextColumn};
use asperity_data::{gathered, shown};
use std::ops::Range;

const COLUMNS: &str = "text columns";

const MATRIX: &str = "text matrix";

impl Table {
    /// Returns the surface in the given rows of the table. If several columns may be heights,
    /// `wanted` chooses one of these columns. `is_open` is true if the last line of the text has no
    /// line end.
    ///
    /// # Errors
    /// Returns an error if the rows do not contain a surface.
    pub fn reading(
        mut self,
        header: &TextHeader,
        rows: Range<usize>,
        wanted: Wanted<'_>,
        is_open: bool,
    ) -> Result<Reading, SurfaceError> {
        self.decimal.check()?;
        if rows.len() < self.rows() {
            self.keep_rows(rows);
        }
        let names = &header.lines;
        let columns = names.columns(self.columns(), self.cells(), self.separator, Unit::is_name);
        let reading = match list_of(&columns, wanted)? {
            Some(list) => self.list(header, &columns, list, is_open)?,
            None => self.map(header, is_open)?,
        };
        Ok(reading.scaled(|_| false, header.scale()))
    }

    /// Returns the surface that a list of points describes.
    fn list(
        self,
        header: &TextHeader,
        columns: &[TextColumn],
        list: List,
        is_open: bool,
    ) -> Result<Reading, SurfaceError> {
        self.check_counts(self.rows(), self.columns())?;
        let heights = self.heights(columns, list)?;
        let missing = heights.iter().position(|height| height.is_nan());
        let first_missing = missing.map(|row| self.place(row));
        let warnings = warnings::of_heights(&heights, is_open, |row| self.place(row));
        let units = ColumnUnits::new(header, columns, list);
        let reading = match (list.x, list.y) {
            (Some(x), Some(y)) => self.points(x, y, heights, units, header)?,
            (Some(x), None) => self.profile(x, heights, units)?,
            (None, _) => even(heights, header, units),
        };
        Ok(Reading {
            first_missing,
            warnings,
            ..reading
        })
    }

    /// Returns the heights of a list of points. The height is NaN if the column `valid` marks a
    /// point as invalid.
    fn heights(&self, columns: &[TextColumn], list: List) -> Result<Vec<f64>, SurfaceError> {
        let mut heights = self.column(list.height)?;
        let Some(valid) = list.valid else {
            return Ok(heights);
        };
        for (row, height) in heights.iter_mut().enumerate() {
            let mark = self.values[row * self.cells() + valid];
            if mark == 0.0 {
                *height = f64::NAN;
            } else if mark != 1.0 {
                let name = shown(&columns[valid].name);
                let found = format!("{mark:e} in the column {name:?}");
                let allowed = "1 for a measured point, or 0";
                return Err(refused(self.place(row), found, allowed));
            }
        }
        Ok(heights)
    }

    /// Returns the map that a list of points describes. Each point has a position x and a position
    /// y.
    fn points(
        mut self,
        x: usize,
        y: usize,
        heights: Vec<f64>,
        units: ColumnUnits,
        header: &TextHeader,
    ) -> Result<Reading, SurfaceError> {
        let x_positions = self.column(x)?;
        let y_positions = self.take_column(y);
        self.check_measured(&y_positions)?;
        self.check_measured(&x_positions)?;
        let list = PointList {
            x: &x_positions,
            y: &y_positions,
            heights: &heights,
            digits: [self.digits_of(x), self.digits_of(y)],
            place: |row: usize| self.place(row),
        };
        let mut map = list.map()?;
        let mut units = StatedUnits {
            along: units.x,
            between: units.y,
            heights: units.heights,
        };
        if header.has_counted_positions {
            let rows = map.heights.len() / map.columns;
            map.distances = header.distances(map.columns, rows);
            units.along = map.distances.map(|_| Unit::METRE);
            units.between = units.along;
        }
        check_both(units)?;
        let heights = map.heights;
        Ok(Reading::even(
            COLUMNS,
            heights,
            map.columns,
            map.distances,
            units,
        ))
    }

    fn profile(
        mut self,
        x: usize,
        heights: Vec<f64>,
        units: ColumnUnits,
    ) -> Result<Reading, SurfaceError> {
        let mut positions = self.take_column(x);
        self.check_measured(&positions)?;
        move_to_printed_grid(&mut positions, self.digits_of(x))?;
        self.check_order(&positions)?;
        let units = StatedUnits::new(units.x, units.heights);
        Ok(Reading::profile(COLUMNS, positions, heights, units))
    }

    /// Returns the surface if the lines are rows of a map.
    fn map(mut self, header: &TextHeader, is_open: bool) -> Result<Reading, SurfaceError> {
        let columns_with_positions = self.columns();
        self.keep_columns(columns_with_positions);
        let values = std::mem::take(&mut self.values);
        let digits = [self.first_line, self.digits[0]];
        let place = |row: usize| self.place(row);
        let map = matrix::without_positions(values, columns_with_positions, digits, place)?;
        let columns = map.columns;
        let rows = map.heights.len() / columns;
        self.check_counts(rows, columns)?;
        check_stated(columns, header.counts[0], "columns")?;
        check_stated(rows, header.counts[1], "rows")?;

        // Positions in the first row shift the lines of the heights by one.
        let rows_above = columns_with_positions - columns;
        let place_of_point = |index: usize| place(index / columns + rows_above);
        let warnings = warnings::of_heights(&map.heights, is_open, place_of_point);
        let first_missing = map.heights.iter().position(|height| height.is_nan());

        let stated = header.distances(columns, rows);
        let mut units = StatedUnits {
            along: header.unit(X, None),
            between: header.unit(Y, None),
            heights: header.unit(Z, None),
        };
        if stated.is_some() {
            // These distances are from the header and already in m.
            units.along = Some(Unit::METRE);
            units.between = Some(Unit::METRE);
        }
        if stated.is_some() || map.distances.is_some() {
            check_both(units)?;
        }
        let reading = if header.is_along_y {
            let heights = transposed(&map.heights, columns)?;
            let stated = stated.map(|[along, between]| [between, along]);
            Reading::even(MATRIX, heights, rows, stated.or(map.distances), units)
        } else {
            let distances = stated.or(map.distances);
            Reading::even(MATRIX, map.heights, columns, distances, units)
        };
        Ok(Reading {
            first_missing: first_missing.map(place_of_point),
            warnings,
            ..reading
        })
    }

    fn place(&self, row: usize) -> Place {
        Place::Line(self.line(row))
    }

    fn column(&self, column: usize) -> Result<Vec<f64>, SurfaceError> {
        let values = self.values.iter().skip(column).step_by(self.cells());
        Ok(gathered(self.rows(), values.copied())?)
    }

    fn digits_of(&self, column: usize) -> Digits {
        self.digits[column.min(FEW_COLUMNS - 1)]
    }

    fn check_measured(&self, positions: &[f64]) -> Result<(), SurfaceError> {
        let Some(row) = positions.iter().position(|x| x.is_nan()) else {
            return Ok(());
        };
        let place = self.place(row);
        Err(refused(
            place,
            "a position is missing",
            "a number for each position",
        ))
    }

    /// Returns an error if numbers before the first row do not fit the table. Such a number may
    /// count rows, distances between rows, columns or points.
    fn check_counts(&self, rows: usize, columns: usize) -> Result<(), SurfaceError> {
        let Some(counts) = &self.counts else {
            return Ok(());
        };
        let known = [rows, rows - 1, columns, rows * columns].map(|count| count as f64);
        let are_known = counts.values.iter().all(|count| known.contains(count));
        if are_known || counts.values.iter().product::<f64>() == rows as f64 {
            return Ok(());
        }
        let numbers: Vec<String> = counts.values.iter().map(f64::to_string).collect();
        let numbers = numbers.join(" ");
        let found =
            format!("{numbers} is no count of the {rows} lines of {columns} columns that follow");
        let allowed =
            format!("numbers of lines, of columns or of points, or {columns} columns throughout");
        Err(refused(Place::Line(counts.line), found, allowed))
    }

    /// Returns an error unless the positions of a profile all ascend or all descend.
    fn check_order(&self, positions: &[f64]) -> Result<(), SurfaceError> {
        let [first, second, ..] = positions else {
            return Ok(());
        };
        let ascends = first < second;
        let descends = first > second;
        for (row, pair) in positions.windows(2).enumerate() {
            let is_ordered = (ascends && pair[0] < pair[1]) || (descends && pair[0] > pair[1]);
            if is_ordered {
                continue;
            }
            let allowed = if ascends {
                "ascending positions, as before"
            } else if descends {
                "descending positions, as before"
            } else {
                "another position than before"
            };
            let found = format!("x = {:e} after {:e}", pair[1], pair[0]);
            return Err(refused(self.place(row + 1), found, allowed));
        }
        Ok(())
    }
}

/// Units that the names of the columns of a list state.
#[derive(Clone, Copy)]
struct ColumnUnits {
    /// Unit of the positions of a profile, or of the coordinate x of a map.
    x: Option<Unit>,
    y: Option<Unit>,
    heights: Option<Unit>,
}

impl ColumnUnits {
    fn new(header: &TextHeader, columns: &[TextColumn], list: List) -> Self {
        let unit = |axis: usize, column: usize| header.unit(axis, Some(&columns[column]));
        let is_y = |column: usize| columns[column].role == Role::Y;
        let mut heights = unit(Z, list.height);
        if heights.is_none() && is_y(list.height) {
            // If X and Y are the only columns, then Y is the heights of a profile.
            heights = unit(Y, list.height);
        }
        let x = list.x.and_then(|x| match list.y {
            None if is_y(x) => unit(Y, x),
            _ => unit(X, x),
        });
        ColumnUnits {
            x,
            y: list.y.and_then(|y| unit(Y, y)),
            heights,
        }
    }
}

/// Returns a profile of evenly spaced heights without positions.
fn even(heights: Vec<f64>, header: &TextHeader, units: ColumnUnits) -> Reading {
    let points = heights.len();
    let distance = header.distance();
    let along = match distance {
        // The distance of the header is already in m.
        Some(_) => Some(Unit::METRE),
        None => header.unit(X, None),
    };
    let units = StatedUnits::new(along, units.heights);
    let spacing = distance.map(|distance| [distance; 2]);
    Reading::even(COLUMNS, heights, points, spacing, units)
}

/// Returns an error if only one of the two axes of a map has a unit.
fn check_both(units: StatedUnits) -> Result<(), SurfaceError> {
    let unit = match (units.along, units.between) {
        (Some(unit), None) | (None, Some(unit)) => unit,
        _ => return Ok(()),
    };
    let found = format!("{unit} is the unit of one position, and the other one has none");
    let allowed = "units of both x and y in the file, or of none";
    Err(refused(Place::File, found, allowed))
}

/// Returns an error if the number of columns or rows differs from the number stated in the header.
fn check_stated(count: usize, stated: Option<usize>, name: &str) -> Result<(), SurfaceError> {
    match stated {
        Some(stated) if stated != count => {
            let found = format!("{count} {name} of numbers, {stated} in the header");
            let allowed = "as many as the header states";
            Err(refused(Place::File, found, allowed))
        }
        _ => Ok(()),
    }
}
