//! Even grids whose positions are printed with few digits, and maps from lists of points.

use super::surface::{UNEVEN, first_uneven};
use crate::error::{Place, SurfaceError, refused};
use asperity_data::{gathered, resized};

/// Smallest number of positions whose digits show an even grid. Fewer may be uneven by intention.
const LEAST_PRINTED: usize = 32;

/// Share of the largest distance between positions below which two positions are on the same line
/// of a grid.
const SAME_LINE: f64 = 0.05;

/// Largest number of lines of a grid over the number of lines that have points.
const MOST_LINES: f64 = 1.25;

/// Largest number of cells of a grid over the number of points: half of the points may be missing.
const MOST_CELLS: usize = 2;

/// Relative difference between the distance of points and the last printed digit below which a
/// missing point looks like a rounded distance.
const LIKE_DIGIT: f64 = 0.1;

/// Limit of the number of cuts in the search for an even grid.
const MOST_CUTS: usize = 64;

/// Digits with which the numbers of a column are printed: the largest numbers of decimals and of
/// significant digits.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Digits {
    decimals: i32,
    significant: i32,
}

impl Digits {
    pub const EXACT: Digits = Digits {
        decimals: 400,
        significant: 15,
    };

    pub fn take(&mut self, cell: &str) {
        let (mut decimals, mut significant, mut is_behind) = (0, 0, false);
        for (index, byte) in cell.bytes().enumerate() {
            match byte {
                b'0'..=b'9' => {
                    decimals += i32::from(is_behind);
                    significant += i32::from(byte != b'0' || significant > 0);
                }
                // The last one: others separate thousands.
                b'.' | b',' => (is_behind, decimals) = (true, 0),
                b'e' | b'E' => {
                    decimals -= cell[index + 1..]
                        .parse::<i32>()
                        .map_or(0, |power| power.clamp(-400, 400));
                    break;
                }
                _ => {}
            }
        }
        self.decimals = self.decimals.max(decimals);
        self.significant = self.significant.max(significant);
    }

    /// Returns half of the last printed digit of a number, plus some rounding errors.
    fn half(self, value: f64) -> f64 {
        let before = if value == 0.0 {
            i32::MIN / 2
        } else {
            value.abs().log10().floor() as i32 + 1
        };
        let digit = (before - self.significant).max(-self.decimals);
        0.500_001 * 10.0_f64.powi(digit)
    }
}

/// Returns the first position and the distance of an even grid that agrees with all positions to
/// within half a printed digit. Positions are given as (number, position) in the order of the
/// numbers.
fn printed_grid(points: &[(f64, f64)], digits: Digits) -> Option<[f64; 2]> {
    let [(_, first), .., (last_number, last)] = points else {
        return None;
    };
    if points.len() < LEAST_PRINTED {
        return None;
    }
    let of_ends = (digits.half(*first) + digits.half(*last)) / last_number;
    let mean = (last - first) / last_number;
    let digit = 2.0 * digits.half(*first).max(digits.half(*last));
    if (mean.abs() / digit - 1.0).abs() < LIKE_DIGIT {
        return None;
    }
    let [mut low, mut high] = [mean - of_ends, mean + of_ends];
    for _ in 0..MOST_CUTS {
        let distance = f64::midpoint(low, high);
        // The largest lower bound and the least upper bound of the first position.
        let (mut least, mut most) = ((f64::NEG_INFINITY, 0.0, 0.0), (f64::INFINITY, 0.0, 0.0));
        for (number, position) in points {
            let (half, before) = (digits.half(*position), number * distance);
            if position - half - before > least.0 {
                least = (position - half - before, *number, position - half);
            }
            if position + half - before < most.0 {
                most = (position + half - before, *number, position + half);
            }
        }
        if least.0 <= most.0 {
            return Some([f64::midpoint(least.0, most.0), distance]);
        }
        let bound = (least.2 - most.2) / (least.1 - most.1);
        if least.1 > most.1 {
            low = low.max(bound)
        } else {
            high = high.min(bound)
        }
        if low > high {
            return None;
        }
    }
    None
}

/// Moves positions onto an even grid if that changes none by more than its printed digits.
/// Otherwise they remain unchanged.
pub(super) fn move_to_printed_grid(
    positions: &mut [f64],
    digits: Digits,
) -> Result<(), SurfaceError> {
    let [first, .., last] = positions else {
        return Ok(());
    };
    let (first, distance) = (*first, (*last - *first) / (positions.len() - 1) as f64);
    if distance == 0.0 || first_uneven(positions, first, distance).is_none() {
        return Ok(());
    }
    let points = gathered(
        positions.len(),
        positions
            .iter()
            .enumerate()
            .map(|(number, x)| (number as f64, *x)),
    )?;
    if let Some([first, distance]) = printed_grid(&points, digits) {
        positions
            .iter_mut()
            .enumerate()
            .for_each(|(number, x)| *x = first + number as f64 * distance);
    }
    Ok(())
}

/// Evenly spaced lines of a grid along one axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Axis {
    pub first: f64,
    /// Distance between lines, negative if the first points are in descending order; 0 for a single
    /// line.
    pub distance: f64,
    pub count: usize,
}

impl Axis {
    /// Finds the lines through the positions, some of which may be missing. The inner error is a
    /// position that lies off the even grid.
    pub fn of(positions: &[f64], digits: Digits) -> Result<Result<Axis, f64>, SurfaceError> {
        let mut sorted = gathered(positions.len(), positions.iter().copied())?;
        sorted.sort_unstable_by(f64::total_cmp);
        sorted.dedup();
        let (first, last) = (sorted[0], sorted[sorted.len() - 1]);
        let gap = |pair: &[f64]| pair[1] - pair[0];
        let widest = sorted.windows(2).map(gap).fold(0.0, f64::max);
        let lines = sorted.chunk_by(|one, next| next - one < SAME_LINE * widest);
        let lines = lines.map(|line| f64::midpoint(line[0], line[line.len() - 1]));
        let lines = gathered(sorted.len(), lines)?;
        if lines.len() < 2 {
            return Ok(Ok(Axis {
                first,
                distance: 0.0,
                count: 1,
            }));
        }
        // Without missing lines, or at the mean of the smaller distances.
        let least = lines.windows(2).map(gap).fold(f64::INFINITY, f64::min);
        let small = || lines.windows(2).map(gap).filter(|gap| *gap < 1.5 * least);
        let step = small().sum::<f64>() / small().count() as f64;
        let mut number = 0.0;
        let sparse = lines.windows(2).map(|pair| {
            number += (gap(pair) / step).round();
            (number, pair[1])
        });
        let sparse: Vec<_> = std::iter::once((0.0, lines[0])).chain(sparse).collect();
        let full: Vec<_> = (0..lines.len())
            .map(|number| (number as f64, lines[number]))
            .collect();
        let found = [&full, &sparse].into_iter().find_map(|points| {
            let (last_number, last) = *points.last()?;
            if last_number + 1.0 > MOST_LINES * points.len() as f64 {
                return None;
            }
            let [first, distance] = [lines[0], (last - lines[0]) / last_number];
            let is_even = |(number, x): &(f64, f64)| {
                (x - first - number * distance).abs() <= UNEVEN * distance
            };
            let even = points.iter().all(is_even).then_some([first, distance]);
            Some((
                even.or_else(|| printed_grid(points, digits))?,
                last_number as usize + 1,
            ))
        });
        let Some(([first, distance], count)) = found else {
            let mean = (last - first) / (lines.len() - 1) as f64;
            let off = first_uneven(&lines, first, mean).unwrap_or(0);
            return Ok(Err(lines[off]));
        };
        let turn = positions
            .iter()
            .find(|x| (**x - positions[0]).abs() > 0.5 * distance);
        if turn.is_some_and(|x| *x < positions[0]) {
            let last = first + (count - 1) as f64 * distance;
            return Ok(Ok(Axis {
                first: last,
                distance: -distance,
                count,
            }));
        }
        Ok(Ok(Axis {
            first,
            distance,
            count,
        }))
    }

    /// Returns the number of the line through a position; `None` if it lies off the grid.
    fn line(self, position: f64, digits: Digits) -> Option<usize> {
        if self.count == 1 {
            return Some(0);
        }
        let number = ((position - self.first) / self.distance).round();
        let off = (position - self.first - number * self.distance).abs();
        // Printed digits and errors within a line may add.
        let most = 2.0 * UNEVEN * self.distance.abs() + digits.half(position);
        let number = (off <= most && number >= 0.0).then_some(number as usize);
        number.filter(|number| *number < self.count)
    }
}

/// Heights of a map, row by row along x.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Map {
    pub heights: Vec<f64>,
    pub columns: usize,
    /// Distances along and between rows, where they are known.
    pub distances: Option<[f64; 2]>,
}

/// Makes the map of points in any order. Points of the grid that are not listed are missing.
pub(super) fn map_of(
    [x, y]: [&[f64]; 2],
    heights: &[f64],
    digits: [Digits; 2],
    place: impl Fn(usize) -> Place,
) -> Result<Map, SurfaceError> {
    let points = heights.len();
    if points < 2 {
        return Err(refused(
            Place::File,
            format!("{points} points"),
            "at least 2",
        ));
    }
    let off_grid = |index: usize| {
        let fault = format!("({:e}, {:e}) is off the even grid", x[index], y[index]);
        let allowed =
            format!("points of a grid, within {UNEVEN} of their distance or half a printed digit");
        refused(place(index), fault, allowed)
    };
    let axis = |positions: &[f64], digits: Digits| {
        let at = |found: f64| {
            positions
                .iter()
                .position(|position| *position >= found)
                .unwrap_or(0)
        };
        Axis::of(positions, digits)?.map_err(|found| off_grid(at(found)))
    };
    let (along, between) = (axis(x, digits[0])?, axis(y, digits[1])?);
    let (columns, rows) = (along.count, between.count);
    let cells = columns
        .checked_mul(rows)
        .filter(|cells| *cells <= MOST_CELLS * points)
        .ok_or_else(|| {
            let fault = format!("{points} points at {columns} positions x and {rows} positions y");
            refused(Place::File, fault, "points of a grid, at least half of it")
        })?;
    let mut map = resized(Vec::new(), cells, f64::NAN)?;
    let mut is_taken = resized(Vec::new(), cells, false)?;
    for index in 0..points {
        let lines = along
            .line(x[index], digits[0])
            .zip(between.line(y[index], digits[1]));
        let (column, row) = lines.ok_or_else(|| off_grid(index))?;
        let cell = row * columns + column;
        if std::mem::replace(&mut is_taken[cell], true) {
            let fault = format!(
                "({:e}, {:e}) is the position of a point before",
                x[index], y[index]
            );
            return Err(refused(place(index), fault, "one height for each position"));
        }
        map[cell] = heights[index];
    }
    let [along, between] = [along, between].map(|axis| axis.distance.abs());
    let other = |one: f64, other: f64| if one > 0.0 { one } else { other };
    let distances = Some([other(along, between), other(between, along)]);
    Ok(Map {
        heights: map,
        columns,
        distances,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn digits(cells: &[&str]) -> Digits {
        let mut digits = Digits::default();
        cells.iter().for_each(|cell| digits.take(cell));
        digits
    }

    #[test]
    fn the_last_printed_digit_is_that_of_decimals_or_of_significant_digits() {
        for (cells, value, half) in [
            (&["0.00", "13.33"][..], 13.33, 0.005),
            (&["0.00", "13.33"], 0.33, 0.005),
            (&["0", "0.5", "10.5"], 10.0, 0.05),
            (&["0.333", "12.3"], 12.3, 0.05),
            (&["0.333", "12.3"], 0.333, 0.0005),
            (&["1.338e+01", "9.5e0"], 13.38, 0.005),
            (&["-0,33"], -0.33, 0.005),
            (&["10", "20"], 10.0, 0.5),
        ] {
            assert!(
                (digits(cells).half(value) / half - 1.0).abs() < 1e-5,
                "{cells:?}"
            );
        }
    }

    #[test]
    fn positions_rounded_in_print_are_even() {
        let printed = |of: &dyn Fn(u32) -> f64, decimals: usize| {
            let cells: Vec<String> = (0..200).map(|i| format!("{:.decimals$}", of(i))).collect();
            let digits = digits(&cells.iter().map(String::as_str).collect::<Vec<_>>());
            (
                cells
                    .iter()
                    .map(|cell| cell.parse().unwrap())
                    .collect::<Vec<f64>>(),
                digits,
            )
        };
        for (first, distance, decimals) in [
            (0.0, 0.156, 1),
            (-3.0, 1.0 / 3.0, 2),
            (100.0, -0.0333, 2),
            (0.0, 0.07, 1),
        ] {
            let (mut positions, digits) = printed(&|i| first + distance * f64::from(i), decimals);
            let before = positions.clone();
            move_to_printed_grid(&mut positions, digits).unwrap();
            let step = (positions[199] - positions[0]) / 199.0;
            assert!((step / distance - 1.0).abs() < 0.01, "{step}");
            assert_eq!(first_uneven(&positions, positions[0], step), None);
            let half = 0.5000001 * 10_f64.powi(-(decimals as i32));
            assert!(
                positions
                    .iter()
                    .zip(&before)
                    .all(|(one, other)| (one - other).abs() <= half)
            );
        }
        // Really uneven, or few.
        let (before, digits) = printed(&|i| f64::from(i) + f64::from(i * i % 7) * 0.03, 2);
        let mut positions = before.clone();
        move_to_printed_grid(&mut positions, digits).unwrap();
        assert_eq!(positions, before);
        // A point is missing.
        let (before, digits) = printed(&|i| f64::from(i + u32::from(i > 70)), 0);
        let mut positions = before.clone();
        move_to_printed_grid(&mut positions, digits).unwrap();
        assert_eq!(positions, before);
        let mut few = [0.0, 1.0, 3.0, 4.0, 6.0];
        move_to_printed_grid(&mut few, Digits::default()).unwrap();
        assert_eq!(few, [0.0, 1.0, 3.0, 4.0, 6.0]);
    }

    fn map(points: &[(f64, f64)]) -> Result<Map, String> {
        let (x, y): (Vec<f64>, Vec<f64>) = points.iter().copied().unzip();
        let heights: Vec<f64> = points.iter().map(|(x, y)| 10.0 * x + y).collect();
        let place = |index: usize| Place::Line(index + 1);
        map_of(
            [&x, &y],
            &heights,
            [Digits {
                decimals: 9,
                significant: 9,
            }; 2],
            place,
        )
        .map_err(|error| error.to_string())
    }

    #[test]
    fn points_in_any_order_are_rows_along_x() {
        let rows = [
            (3.0, 0.0),
            (2.0, 0.0),
            (1.0, 0.0),
            (3.0, 5.0),
            (2.0, 5.0),
            (1.0, 5.0),
        ];
        let heights = vec![30.0, 20.0, 10.0, 35.0, 25.0, 15.0];
        let expected = Map {
            heights,
            columns: 3,
            distances: Some([1.0, 5.0]),
        };
        assert_eq!(map(&rows), Ok(expected.clone()));
        let by_columns = [0, 3, 1, 4, 2, 5].map(|index| rows[index]);
        assert_eq!(map(&by_columns), Ok(expected.clone()));
        let serpentine = [0, 1, 2, 5, 4, 3].map(|index| rows[index]);
        assert_eq!(map(&serpentine), Ok(expected));
        let profile = Map {
            heights: vec![1.0, 3.0, 5.0],
            columns: 1,
            distances: Some([2.0; 2]),
        };
        assert_eq!(map(&[(0.0, 1.0), (0.0, 3.0), (0.0, 5.0)]), Ok(profile));
    }

    #[test]
    fn points_that_are_left_out_are_missing() {
        let all = || (0..40).map(|i| (f64::from(i % 8), 0.5 * f64::from(i / 8)));
        let read = |points: Vec<(f64, f64)>| {
            let Map {
                heights,
                columns,
                distances,
            } = map(&points).unwrap();
            let missing = heights
                .iter()
                .enumerate()
                .filter(|(_, height)| height.is_nan())
                .map(|(index, _)| index);
            (columns, distances, missing.collect::<Vec<_>>())
        };
        let distances = Some([1.0, 0.5]);
        assert_eq!(
            read(all().filter(|p| *p != (3.0, 1.0)).collect()),
            (8, distances, vec![19])
        );
        let without_column = all().filter(|p| p.0 != 2.0).collect();
        assert_eq!(
            read(without_column),
            (8, distances, vec![2, 10, 18, 26, 34])
        );
    }

    #[test]
    fn points_off_the_grid_are_named() {
        for (points, expected) in [
            (
                &[(0.0, 0.0), (1.0, 1.0), (2.0, 2.0), (3.0, 3.0)][..],
                "4 points at 4 positions x and 4",
            ),
            (
                &[(0.0, 0.0), (0.0, 0.0)],
                "line 2: (0e0, 0e0) is the position of a point before",
            ),
            (
                &[(0.0, 0.0), (1.0, 0.0), (2.5, 0.0), (3.0, 0.0)],
                "line 3: (2.5e0, 0e0) is off",
            ),
            (
                &[(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.01, 1.0)],
                "line 2: (1e0, 0e0) is off",
            ),
        ] {
            let error = map(points).unwrap_err();
            assert!(error.starts_with(expected), "{points:?}: {error}");
        }
    }
}
