//! Maps that are written row by row in a text. The first row and the first column may be positions.

use super::super::grid::Map;
use super::super::positions::first_uneven;
use super::super::printed::{Digits, Grid, move_to_printed_grid};
use crate::error::{Place, SurfaceError, refused};
use asperity_data::{Remedy, gathered};

/// Smallest number of evenly spaced numbers along one axis that are taken for positions although
/// the numbers along the other axis are not evenly spaced.
const LEAST_STEPS: usize = 8;

/// Returns the map in rows. If the first row and the first column of `numbers` are positions, they
/// are left out of the map. `columns` is the number of cells in a row of `numbers`. The distances
/// between points follow from the positions. If the positions only count the columns and rows, from
/// 0 or 1, the distances remain unknown. `digits` are the printed digits of the first row and of
/// the first column.
pub(super) fn without_positions(
    mut numbers: Vec<f64>,
    columns: usize,
    digits: [Digits; 2],
    place: impl Fn(usize) -> Place,
) -> Result<Map, SurfaceError> {
    let matrix = Matrix {
        numbers: &numbers,
        columns,
        digits,
    };
    let positions = if matrix.rows() < 2 {
        Positions::default()
    } else {
        matrix.positions()?
    };
    match positions {
        Positions {
            along: None,
            between: None,
        } => Ok(Map {
            heights: numbers,
            columns,
            distances: None,
        }),
        Positions {
            along: Some(along),
            between: Some(between),
        } => {
            let mut index = 0;
            numbers.retain(|_| {
                let is_height = index >= columns && index % columns > 0;
                index += 1;
                is_height
            });
            let are_counts = is_count(along) && is_count(between);
            let distances = [along.distance.abs(), between.distance.abs()];
            Ok(Map {
                heights: numbers,
                columns: columns - 1,
                distances: (!are_counts).then_some(distances),
            })
        }
        Positions {
            along: Some(along),
            between: None,
        } => Err(single_positions(place(0), "row", along)),
        Positions {
            along: None,
            between: Some(between),
        } => Err(single_positions(place(0), "column", between)),
    }
}

/// Numbers in rows, of which the first row and the first column may be positions.
struct Matrix<'a> {
    numbers: &'a [f64],
    columns: usize,
    digits: [Digits; 2],
}

/// Positions of an even grid, in the first row (`along`) and in the first column (`between`).
#[derive(Default)]
struct Positions {
    along: Option<Grid>,
    between: Option<Grid>,
}

impl Matrix<'_> {
    fn rows(&self) -> usize {
        self.numbers.len() / self.columns
    }

    /// Returns the positions in the first row and the first column. If the second row or column is
    /// evenly spaced too, the surface may be a plane, and no numbers are taken for positions.
    fn positions(&self) -> Result<Positions, SurfaceError> {
        let along = self.row_steps(0)?;
        let between = self.column_steps(0)?;
        if self.row_steps(1)?.is_some() || self.column_steps(1)?.is_some() {
            return Ok(Positions::default());
        }
        Ok(Positions { along, between })
    }

    /// Returns the first position and the step of a row, whose first number is left out; `None` if
    /// the row is not evenly spaced.
    fn row_steps(&self, row: usize) -> Result<Option<Grid>, SurfaceError> {
        let numbers = &self.numbers[row * self.columns + 1..(row + 1) * self.columns];
        even_steps(self.columns - 1, numbers.iter().copied(), self.digits[0])
    }

    /// Returns the first position and the step of a column, whose first number is left out; `None`
    /// if the column is not evenly spaced.
    fn column_steps(&self, column: usize) -> Result<Option<Grid>, SurfaceError> {
        let numbers = self.numbers.iter().skip(self.columns + column);
        let numbers = numbers.step_by(self.columns).copied();
        even_steps(self.rows() - 1, numbers, self.digits[1])
    }
}

/// Returns the first number and the step of numbers that rise or fall in even steps; `None` for
/// other numbers.
fn even_steps(
    count: usize,
    numbers: impl Iterator<Item = f64>,
    digits: Digits,
) -> Result<Option<Grid>, SurfaceError> {
    let mut numbers = gathered(count, numbers)?;
    let is_ordered = numbers.is_sorted_by(|a, b| a < b) || numbers.is_sorted_by(|a, b| a > b);
    if count < LEAST_STEPS || !is_ordered {
        return Ok(None);
    }
    move_to_printed_grid(&mut numbers, digits)?;
    let first = numbers[0];
    let distance = (numbers[count - 1] - first) / (count - 1) as f64;
    let is_even = first_uneven(&numbers, first, distance).is_none();
    Ok(is_even.then_some(Grid { first, distance }))
}

/// Returns true for the numbers 0, 1, 2, … and for 1, 2, 3, …, which only number rows or columns.
fn is_count(grid: Grid) -> bool {
    (grid.first == 0.0 || grid.first == 1.0) && grid.distance == 1.0
}

/// Returns the error for a map with positions only in the first row, or only in the first column.
fn single_positions(place: Place, name: &str, grid: Grid) -> SurfaceError {
    let Grid { first, distance } = grid;
    let found = format!(
        "the first {name} runs from {first:e} in even steps of {distance:e} beside uneven numbers: positions, no heights"
    );
    let allowed = "positions in the first row and the first column, or heights alone and the \
                   distance of their points";
    refused(place, found, allowed).with(Remedy::Spacing)
}

#[cfg(test)]
mod tests {
    use super::*;

    const COLUMNS: usize = 12;

    /// Returns the numbers of a map whose heights are rough, with positions in the first row and
    /// the first column.
    fn numbers(along: impl Fn(usize) -> f64, between: impl Fn(usize) -> f64) -> Vec<f64> {
        let rough = |index: usize| (7.3 * (index * index % 101) as f64).sin();
        let number = |index: usize| match (index / COLUMNS, index % COLUMNS) {
            (0, 0) => f64::NAN,
            (0, column) => along(column - 1),
            (row, 0) => between(row - 1),
            _ => rough(index),
        };
        (0..10 * COLUMNS).map(number).collect()
    }

    fn read(numbers: &[f64]) -> Result<Map, String> {
        let found = without_positions(numbers.to_vec(), COLUMNS, [Digits::default(); 2], |row| {
            Place::Line(row + 1)
        });
        found.map_err(|error| error.to_string())
    }

    #[test]
    fn positions_in_even_steps_are_no_heights() {
        let half = |index: usize| 0.5 * index as f64;
        let all = numbers(half, |row| 3.0 - 0.25 * row as f64);
        let Map {
            heights,
            columns,
            distances,
        } = read(&all).unwrap();
        assert_eq!(
            (columns, distances, heights.len()),
            (11, Some([0.5, 0.25]), 99)
        );
        assert_eq!(
            (heights[0], heights[11]),
            (all[COLUMNS + 1], all[2 * COLUMNS + 1])
        );
        // Numbers that only count rows and columns are removed, but are not taken for positions.
        let counted = numbers(|column| column as f64, |row| 1.0 + row as f64);
        assert_eq!(
            read(&counted).map(|found| (found.columns, found.distances)),
            Ok((11, None))
        );
        let uneven = |index: usize| (index * index) as f64;
        let error = read(&numbers(uneven, half)).unwrap_err();
        assert!(
            error
                .starts_with("line 1: the first column runs from 0e0 in even steps of 5e-1 beside"),
            "{error}"
        );
        assert!(
            read(&numbers(half, uneven))
                .unwrap_err()
                .contains("the first row runs from")
        );
        let rough = numbers(uneven, uneven);
        assert_eq!(
            read(&rough).map(|found| (found.heights.len(), found.columns)),
            Ok((rough.len(), COLUMNS))
        );
        let plane: Vec<f64> = (0..120)
            .map(|index| (index % COLUMNS + 2 * (index / COLUMNS)) as f64)
            .collect();
        assert_eq!(
            read(&plane),
            Ok(Map {
                heights: plane,
                columns: COLUMNS,
                distances: None
            })
        );
    }
}
