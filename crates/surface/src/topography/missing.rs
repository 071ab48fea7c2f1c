//! Interpolation of missing points from their neighbours.

use crate::error::{Place, SurfaceError, refused};
use asperity_data::{OutOfMemory, between, gathered};
use std::ops::Range;

/// Smallest share of the points that must be measured. With fewer measured points, nothing is
/// interpolated.
const LEAST_MEASURED: f64 = 0.5;

/// Number of times that the missing points are replaced by the means of their neighbours, at each
/// resolution.
const PASSES: usize = 12;

pub(super) fn count(heights: &[f64]) -> usize {
    heights.iter().filter(|height| !height.is_finite()).count()
}

/// Returns the indices of the missing heights.
fn missing_places(heights: &[f64]) -> Result<Vec<usize>, OutOfMemory> {
    let places = (0..heights.len()).filter(|index| !heights[*index].is_finite());
    gathered(count(heights), places)
}

/// Returns the range of columns and the range of rows that contain all measured points. Each range
/// begins and ends with a column or row that has a measured point. The ranges are empty if no point
/// is measured.
pub(super) fn measured_part(heights: &[f64], columns: usize) -> [Range<usize>; 2] {
    let mut across = 0..0;
    let mut down = 0..0;
    for (index, height) in heights.iter().enumerate() {
        if height.is_finite() {
            extend(&mut across, index % columns);
            extend(&mut down, index / columns);
        }
    }
    [across, down]
}

/// Extends a range so that it contains a place.
fn extend(range: &mut Range<usize>, place: usize) {
    let is_empty = range.start == range.end;
    if is_empty {
        *range = place..place + 1;
    } else {
        range.start = range.start.min(place);
        range.end = range.end.max(place + 1);
    }
}

/// Interpolates the missing heights of a map with `columns` columns, or of a profile, which is one
/// row. Returns the indices of the interpolated heights.
///
/// In a profile, a missing height lies on the straight line between the nearest measured points on
/// both sides; at an end it equals the nearest measured height. In a map, a missing height is
/// nearly the mean of its neighbours. The interpolated surface then has the shape of a soap film
/// attached to the measured points: see [`fill`].
pub(super) fn interpolate(heights: &mut [f64], columns: usize) -> Result<Vec<usize>, SurfaceError> {
    let share = 1.0 - count(heights) as f64 / heights.len() as f64;
    if share < LEAST_MEASURED {
        let found = format!("{:.1} % of the points are measured", 100.0 * share);
        let allowed = format!("at least {:.0} %", 100.0 * LEAST_MEASURED);
        return Err(refused(Place::File, found, allowed));
    }
    let places = missing_places(heights)?;
    if heights.len() > columns {
        fill(heights, columns, &places)?;
    } else {
        fill_profile(heights);
    }
    Ok(places)
}

fn fill_profile(heights: &mut [f64]) {
    let mut before = None;
    let mut place = 0;
    while place < heights.len() {
        let after = (place..heights.len()).find(|place| heights[*place].is_finite());
        for gap in place..after.unwrap_or(heights.len()) {
            heights[gap] = match (before, after) {
                (Some(before), Some(after)) => {
                    let share = (gap - before) as f64 / (after - before) as f64;
                    between(heights[before], heights[after], share)
                }
                (Some(nearest), None) | (None, Some(nearest)) => heights[nearest],
                (None, None) => continue,
            };
        }
        let Some(measured) = after else {
            return;
        };
        before = Some(measured);
        place = measured + 1;
    }
}

/// Fills the missing points with these indices. First a map of half the resolution is made from the
/// means of blocks of 2 × 2 points, and its missing points are filled in the same way. This map
/// gives the initial heights. Then each missing height is replaced [`PASSES`] times by the mean of
/// its neighbours. The result nearly solves Laplace's equation in the gaps, with zero slope across
/// the borders of the map.
fn fill(heights: &mut [f64], columns: usize, places: &[usize]) -> Result<(), OutOfMemory> {
    if places.is_empty() {
        return Ok(());
    }
    let half_columns = columns.div_ceil(2);
    let mut halved = halved(heights, columns)?;
    let gaps = missing_places(&halved)?;
    fill(&mut halved, half_columns, &gaps)?;

    for &index in places {
        let row = index / columns;
        let column = index % columns;
        heights[index] = halved[row / 2 * half_columns + column / 2];
    }
    for _ in 0..PASSES {
        for &index in places {
            heights[index] = mean_of_neighbours(heights, columns, index);
        }
    }
    Ok(())
}

/// Returns the means of the measured points in blocks of 2 × 2 points. The mean of a block without
/// a measured point is a missing point.
fn halved(heights: &[f64], columns: usize) -> Result<Vec<f64>, OutOfMemory> {
    let rows = heights.len() / columns;
    let half_columns = columns.div_ceil(2);
    let blocks = half_columns * rows.div_ceil(2);
    let means = (0..blocks).map(|block| {
        let row = 2 * (block / half_columns);
        let column = 2 * (block % half_columns);
        mean_of_block(heights, columns, row, column)
    });
    gathered(blocks, means)
}

/// Returns the mean of the measured points in the block with this first row and column.
fn mean_of_block(heights: &[f64], columns: usize, row: usize, column: usize) -> f64 {
    let rows = heights.len() / columns;
    let mut mean = Mean::default();
    for row in row..rows.min(row + 2) {
        for column in column..columns.min(column + 2) {
            let height = heights[row * columns + column];
            if height.is_finite() {
                mean.add(height);
            }
        }
    }
    mean.value()
}

fn mean_of_neighbours(heights: &[f64], columns: usize, index: usize) -> f64 {
    let rows = heights.len() / columns;
    let row = index / columns;
    let column = index % columns;
    let mut mean = Mean::default();
    if column > 0 {
        mean.add(heights[index - 1]);
    }
    if row > 0 {
        mean.add(heights[index - columns]);
    }
    if column + 1 < columns {
        mean.add(heights[index + 1]);
    }
    if row + 1 < rows {
        mean.add(heights[index + columns]);
    }
    mean.value()
}

/// Mean of a few heights; NaN if there is no height.
#[derive(Default)]
struct Mean {
    sum: f64,
    count: u8,
}

impl Mean {
    fn add(&mut self, height: f64) {
        self.sum += height;
        self.count += 1;
    }

    fn value(&self) -> f64 {
        self.sum / f64::from(self.count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NONE: f64 = f64::NAN;

    #[test]
    fn gaps_of_a_profile_are_straight_and_its_ends_level() {
        let mut heights = [NONE, 1.0, NONE, NONE, 4.0, 6.0, 7.0, NONE];
        assert!(interpolate(&mut heights, 8).is_ok());
        assert_eq!(heights, [1.0, 1.0, 2.0, 3.0, 4.0, 6.0, 7.0, 7.0]);
    }

    #[test]
    fn a_point_of_a_map_is_the_mean_of_its_neighbours() {
        let mut heights = [0.0, 1.0, 2.0, 3.0, NONE, 7.0, 6.0, 9.0, 8.0];
        assert_eq!(interpolate(&mut heights, 3), Ok(vec![4]));
        assert_eq!(heights[4], 0.25 * (1.0 + 3.0 + 7.0 + 9.0));
        let mut corner = [NONE, 1.0, 3.0, 4.0];
        assert!(interpolate(&mut corner, 2).is_ok());
        assert_eq!(corner[0], 2.0);
    }

    #[test]
    fn wide_gaps_are_filled_from_all_sides() {
        // A plane solves Laplace's equation. The interpolated surface differs from it only near the
        // borders of the map, where it has zero slope.
        let columns = 60;
        let plane = |index: usize| (index % columns) as f64 + 2.0 * (index / columns) as f64;
        let place = |index: usize| (index % columns, index / columns);
        let is_hole = |index: usize| {
            let (x, y) = place(index);
            // The holes are a rectangle, a whole column and a whole row.
            (20..40).contains(&x) && (15..35).contains(&y) || x == 50 || y == 10
        };
        let mut heights: Vec<f64> = (0..columns * 50)
            .map(|index| if is_hole(index) { NONE } else { plane(index) })
            .collect();
        let filled = interpolate(&mut heights, columns).unwrap();
        assert!(
            filled
                .into_iter()
                .eq((0..heights.len()).filter(|index| is_hole(*index)))
        );
        let off = |index: usize| (heights[index] - plane(index)).abs();
        let largest = (0..heights.len()).map(off).fold(0.0, f64::max);
        // The plane rises by 140 from one corner to the opposite corner.
        assert!(largest < 1.0, "{largest}");
    }

    #[test]
    fn too_few_points_are_refused() {
        let mut few = [NONE, NONE, 1.0];
        assert!(
            interpolate(&mut few, 3)
                .unwrap_err()
                .to_string()
                .contains("allowed: at least 50 %")
        );
        let mut corner = [NONE, NONE, NONE, 1.0, NONE, 3.0];
        assert!(
            interpolate(&mut corner, 3)
                .unwrap_err()
                .to_string()
                .contains("33.3 % of the points")
        );
    }

    #[test]
    fn the_measured_part_has_a_measured_point_in_each_row_and_column_of_its_border() {
        let map = [
            NONE, NONE, NONE, NONE, 1.0, NONE, NONE, NONE, 2.0, NONE, NONE, NONE,
        ];
        assert_eq!(measured_part(&map, 3), [1..3, 1..3]);
        assert_eq!(measured_part(&map, 4), [0..1, 1..3]);
        assert_eq!(measured_part(&[NONE; 4], 2), [0..0, 0..0]);
    }
}
