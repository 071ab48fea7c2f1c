//! Maps written row by row, with or without positions in the first row and the first column.

use super::super::grid::{Digits, Map, move_to_printed_grid};
use super::super::surface::first_uneven;
use crate::error::{Place, SurfaceError, refused};
use asperity_data::gathered;

/// Smallest number of evenly spaced numbers that count as positions, if the numbers along the other
/// axis are not evenly spaced.
const LEAST_STEPS: usize = 8;

/// Returns the first number and the step of numbers that rise or fall in even steps.
fn even_steps(
    count: usize,
    numbers: impl Iterator<Item = f64>,
    digits: Digits,
) -> Result<Option<[f64; 2]>, SurfaceError> {
    let mut numbers = gathered(count, numbers)?;
    let is_ordered = |is_before: fn(&f64, &f64) -> bool| numbers.is_sorted_by(is_before);
    if count < LEAST_STEPS || !(is_ordered(|a, b| a < b) || is_ordered(|a, b| a > b)) {
        return Ok(None);
    }
    move_to_printed_grid(&mut numbers, digits)?;
    let (first, distance) = (
        numbers[0],
        (numbers[count - 1] - numbers[0]) / (count - 1) as f64,
    );
    Ok(first_uneven(&numbers, first, distance)
        .is_none()
        .then_some([first, distance]))
}

/// Returns the map in rows of `columns` numbers. If the first row and column hold positions, they
/// are removed and give the distances. If these positions only count from 0 or 1, the distances
/// remain unknown. `digits` are the printed digits of the first row and column.
pub(super) fn without_positions(
    mut numbers: Vec<f64>,
    columns: usize,
    digits: [Digits; 2],
    place: impl Fn(usize) -> Place,
) -> Result<Map, SurfaceError> {
    let rows = numbers.len() / columns;
    if rows < 2 {
        return Ok(Map {
            heights: numbers,
            columns,
            distances: None,
        });
    }
    let row = |row: usize| {
        numbers[row * columns + 1..(row + 1) * columns]
            .iter()
            .copied()
    };
    let column = |column: usize| {
        numbers
            .iter()
            .skip(columns + column)
            .step_by(columns)
            .copied()
    };
    let along = even_steps(columns - 1, row(0), digits[0])?;
    let between = even_steps(rows - 1, column(0), digits[1])?;
    // A plane is even in all its rows.
    let is_plane = even_steps(columns - 1, row(1), digits[0])?.is_some()
        || even_steps(rows - 1, column(1), digits[1])?.is_some();
    let (name, [first, distance]) = match (along, between) {
        (along, between) if is_plane || (along, between) == (None, None) => {
            return Ok(Map {
                heights: numbers,
                columns,
                distances: None,
            });
        }
        (Some(along), Some(between)) => {
            let mut index = 0;
            numbers.retain(|_| {
                index += 1;
                index > columns && !(index - 1).is_multiple_of(columns)
            });
            let counts =
                |[first, distance]: [f64; 2]| (first == 0.0 || first == 1.0) && distance == 1.0;
            let is_known = !(counts(along) && counts(between));
            let distances = is_known.then_some([along[1].abs(), between[1].abs()]);
            return Ok(Map {
                heights: numbers,
                columns: columns - 1,
                distances,
            });
        }
        (Some(along), _) => ("row", along),
        (_, between) => ("column", between.unwrap_or_default()),
    };
    let fault = format!(
        "the first {name} runs from {first:e} in even steps of {distance:e} beside uneven numbers: positions, no heights"
    );
    let allowed =
        "heights alone, with --spacing, or positions in the first row and the first column";
    Err(refused(place(0), fault, allowed))
}

#[cfg(test)]
mod tests {
    use super::*;

    const COLUMNS: usize = 12;

    /// Rows of rough heights below and beside positions.
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
        // Numbers of rows and columns are no positions.
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
