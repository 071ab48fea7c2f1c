//! Maps that are made from lists of points in any order.

use super::positions::{UNEVEN, first_uneven};
use super::printed::{Digits, Grid, GridPoint, printed_grid};
use crate::error::{Place, SurfaceError, refused};
use asperity_data::{gathered, resized};

/// Largest distance between two positions that count as the same line of a grid, as a share of the
/// largest distance between neighbouring positions.
const SAME_LINE: f64 = 0.05;

/// Largest ratio of the number of lines of a grid to the number of its lines that have points.
const MOST_LINES: f64 = 1.25;

/// Two lines count as neighbours, with no missing line between them, if their distance is smaller
/// than this factor times the smallest distance between lines.
const SMALL_GAP: f64 = 1.5;

/// Largest ratio of the number of cells of a grid to the number of points. At most half of the
/// points may then be missing.
const MOST_CELLS: usize = 2;

/// Evenly spaced lines of a grid along one axis.
#[derive(Clone, Copy)]
struct Axis {
    first: f64,
    /// Distance between neighbouring lines. It is negative if the first points are in descending
    /// order, and 0 if there is only one line.
    distance: f64,
    count: usize,
}

/// Result of the search for the lines of a grid.
enum AxisSearch {
    Found(Axis),
    /// The positions do not form an even grid. The value is a position that lies off the grid.
    Uneven(f64),
}

impl Axis {
    /// Finds the evenly spaced lines through the positions. Some lines may be missing.
    fn search(positions: &[f64], digits: Digits) -> Result<AxisSearch, SurfaceError> {
        let mut sorted = gathered(positions.len(), positions.iter().copied())?;
        sorted.sort_unstable_by(f64::total_cmp);
        sorted.dedup();
        let first = sorted[0];
        let last = sorted[sorted.len() - 1];
        let lines = lines(&sorted)?;
        if lines.len() < 2 {
            return Ok(AxisSearch::Found(Axis {
                first,
                distance: 0.0,
                count: 1,
            }));
        }
        // First it is assumed that no line is missing. If this fails, the lines are numbered by
        // their distances, so that lines may be missing.
        let found = Axis::through(&numbered(&lines), digits)
            .or_else(|| Axis::through(&numbered_by_distance(&lines), digits));
        let Some(mut axis) = found else {
            let mean = (last - first) / (lines.len() - 1) as f64;
            let off = first_uneven(&lines, first, mean).unwrap_or(0);
            return Ok(AxisSearch::Uneven(lines[off]));
        };
        let second = positions
            .iter()
            .find(|x| (**x - positions[0]).abs() > 0.5 * axis.distance);
        if second.is_some_and(|second| *second < positions[0]) {
            axis.first += (axis.count - 1) as f64 * axis.distance;
            axis.distance = -axis.distance;
        }
        Ok(AxisSearch::Found(axis))
    }

    /// Returns the even grid through numbered lines; `None` if the lines are uneven or if too many
    /// lines are missing.
    fn through(lines: &[GridPoint], digits: Digits) -> Option<Axis> {
        let first = lines.first()?.position;
        let last = lines.last()?;
        if last.number + 1.0 > MOST_LINES * lines.len() as f64 {
            return None;
        }
        let distance = (last.position - first) / last.number;
        let is_even = |line: &GridPoint| {
            (line.position - first - line.number * distance).abs() <= UNEVEN * distance
        };
        let grid = if lines.iter().all(is_even) {
            Grid { first, distance }
        } else {
            printed_grid(lines, digits)?
        };
        Some(Axis {
            first: grid.first,
            distance: grid.distance,
            count: last.number as usize + 1,
        })
    }

    /// Returns the number of the line through a position; `None` if the position lies off the grid.
    fn line(self, position: f64, digits: Digits) -> Option<usize> {
        if self.count == 1 {
            return Some(0);
        }
        let number = ((position - self.first) / self.distance).round();
        let off = (position - self.first - number * self.distance).abs();
        // The rounding of the printed position and the real displacement of the point from its line
        // may add up to this distance.
        let most = 2.0 * UNEVEN * self.distance.abs() + digits.half(position);
        let is_on_grid = off <= most && number >= 0.0 && (number as usize) < self.count;
        is_on_grid.then_some(number as usize)
    }
}

/// Returns the positions of the lines of a grid from the sorted positions of its points.
fn lines(sorted: &[f64]) -> Result<Vec<f64>, SurfaceError> {
    let widest = sorted
        .windows(2)
        .map(|pair| pair[1] - pair[0])
        .fold(0.0, f64::max);
    let lines = sorted
        .chunk_by(|position, next| next - position < SAME_LINE * widest)
        .map(|line| f64::midpoint(line[0], line[line.len() - 1]));
    Ok(gathered(sorted.len(), lines)?)
}

/// Numbers the lines one after another. This is right if the grid has no missing lines.
fn numbered(lines: &[f64]) -> Vec<GridPoint> {
    let points = (0..lines.len()).map(|index| GridPoint {
        number: index as f64,
        position: lines[index],
    });
    points.collect()
}

/// Numbers the lines by their distance from the first line, so that numbers of missing lines are
/// skipped. The unit of distance is the mean of the small distances between lines.
fn numbered_by_distance(lines: &[f64]) -> Vec<GridPoint> {
    let gaps = || lines.windows(2).map(|pair| pair[1] - pair[0]);
    let least = gaps().fold(f64::INFINITY, f64::min);
    let small = || gaps().filter(|gap| *gap < SMALL_GAP * least);
    let step = small().sum::<f64>() / small().count() as f64;

    let mut number = 0.0;
    let mut points = vec![GridPoint {
        number,
        position: lines[0],
    }];
    for pair in lines.windows(2) {
        number += ((pair[1] - pair[0]) / step).round();
        points.push(GridPoint {
            number,
            position: pair[1],
        });
    }
    points
}

/// Heights of a map, row by row along x.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Map {
    pub heights: Vec<f64>,
    pub columns: usize,
    /// Distances between points along the rows, and distance between the rows, in the unit of the
    /// positions; `None` if the distances are not known.
    pub distances: Option<[f64; 2]>,
}

/// A list of points, in the order of the file.
pub(super) struct PointList<'a, P> {
    pub x: &'a [f64],
    pub y: &'a [f64],
    pub heights: &'a [f64],
    /// Numbers of digits with which x and y are printed.
    pub digits: [Digits; 2],
    /// Function that returns where the point with a given index is in the file.
    pub place: P,
}

impl<P: Fn(usize) -> Place> PointList<'_, P> {
    /// Creates a map from the list of points. Points of the map that are not in the list are
    /// missing points.
    ///
    /// # Errors
    /// Returns an error if there are fewer than two points, if they do not form an even grid, if
    /// they fill less than half of the grid, if two points have the same place, or if the memory
    /// does not suffice.
    pub fn map(&self) -> Result<Map, SurfaceError> {
        let points = self.heights.len();
        if points < 2 {
            return Err(refused(
                Place::File,
                format!("{points} points"),
                "at least 2",
            ));
        }
        let along = self.axis(self.x, self.digits[0])?;
        let between = self.axis(self.y, self.digits[1])?;
        let columns = along.count;
        let rows = between.count;
        let cells = match columns.checked_mul(rows) {
            Some(cells) if cells <= MOST_CELLS * points => cells,
            _ => {
                let found =
                    format!("{points} points at {columns} positions x and {rows} positions y");
                let allowed = "points of a grid, at least half of it";
                return Err(refused(Place::File, found, allowed));
            }
        };
        let mut heights = resized(Vec::new(), cells, f64::NAN)?;
        let mut is_taken = resized(Vec::new(), cells, false)?;
        for index in 0..points {
            let column = along.line(self.x[index], self.digits[0]);
            let row = between.line(self.y[index], self.digits[1]);
            let (Some(column), Some(row)) = (column, row) else {
                return Err(self.off_grid(index));
            };
            let cell = row * columns + column;
            if is_taken[cell] {
                let position = self.position(index);
                let found = format!("{position} is the position of a point before");
                let allowed = "one height for each position";
                return Err(refused((self.place)(index), found, allowed));
            }
            is_taken[cell] = true;
            heights[cell] = self.heights[index];
        }
        Ok(Map {
            heights,
            columns,
            distances: Some(distances(along, between)),
        })
    }

    fn axis(&self, positions: &[f64], digits: Digits) -> Result<Axis, SurfaceError> {
        match Axis::search(positions, digits)? {
            AxisSearch::Found(axis) => Ok(axis),
            AxisSearch::Uneven(line) => {
                let index = positions.iter().position(|position| *position >= line);
                Err(self.off_grid(index.unwrap_or(0)))
            }
        }
    }

    fn off_grid(&self, index: usize) -> SurfaceError {
        let found = format!("{} is off the even grid", self.position(index));
        let allowed =
            format!("points of a grid, within {UNEVEN} of their distance or half a printed digit");
        refused((self.place)(index), found, allowed)
    }

    fn position(&self, index: usize) -> String {
        format!("({:e}, {:e})", self.x[index], self.y[index])
    }
}

/// Returns the distances along and between rows. If there is a single row or column, the unknown
/// distance is set equal to the other one.
fn distances(along: Axis, between: Axis) -> [f64; 2] {
    let along = along.distance.abs();
    let between = between.distance.abs();
    let known = |distance: f64, other: f64| if distance > 0.0 { distance } else { other };
    [known(along, between), known(between, along)]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn map(points: &[(f64, f64)]) -> Result<Map, String> {
        let (x, y): (Vec<f64>, Vec<f64>) = points.iter().copied().unzip();
        let heights: Vec<f64> = points.iter().map(|(x, y)| 10.0 * x + y).collect();
        let place = |index: usize| Place::Line(index + 1);
        let list = PointList {
            x: &x,
            y: &y,
            heights: &heights,
            digits: [Digits::at_most(9, 9); 2],
            place,
        };
        list.map().map_err(|error| error.to_string())
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
