//! Interpolation of missing points from their neighbours, and removal of outliers. Outliers are
//! heights far from the heights around them, such as spikes of an instrument and grains of dust.

use crate::error::{Place, SurfaceError, refused};
use asperity_data::{OutOfMemory, between, gathered, median};
use std::ops::Range;

/// Smallest share of points that must be measured for the others to be interpolated.
const LEAST_MEASURED: f64 = 0.5;

pub(super) fn count(heights: &[f64]) -> usize {
    heights.iter().filter(|height| !height.is_finite()).count()
}

/// Returns the ranges of columns and rows from the first to the last with a measured point; empty
/// if no point is measured.
pub(super) fn measured_part(heights: &[f64], columns: usize) -> [Range<usize>; 2] {
    let range = |places: &mut dyn Iterator<Item = usize>| {
        let reach = |(low, high): (usize, usize), place| (low.min(place), high.max(place + 1));
        let (low, high) = places.fold((usize::MAX, 0), reach);
        low.min(high)..high
    };
    let measured = || (0..heights.len()).filter(|index| heights[*index].is_finite());
    [
        range(&mut measured().map(|index| index % columns)),
        range(&mut measured().map(|index| index / columns)),
    ]
}

/// Interpolates the missing heights of a map with `columns` columns, or of a profile, which is one
/// row. Returns the indices of the interpolated heights.
///
/// In a profile a missing height lies on the straight line between the nearest measured points on
/// both sides, or equals the nearest one at an end. In a map it is the mean of its neighbours, like
/// a soap film attached to the measured points: see [`fill`].
pub(super) fn interpolate(heights: &mut [f64], columns: usize) -> Result<Vec<usize>, SurfaceError> {
    let missing = count(heights);
    let share = 1.0 - missing as f64 / heights.len() as f64;
    if share < LEAST_MEASURED {
        let fault = format!("{:.1} % of the points are measured", 100.0 * share);
        return Err(refused(
            Place::File,
            fault,
            format!("at least {:.0} %", 100.0 * LEAST_MEASURED),
        ));
    }
    let places = gathered(
        missing,
        (0..heights.len()).filter(|index| !heights[*index].is_finite()),
    )?;
    if heights.len() > columns {
        fill(heights, columns, &places)?
    } else {
        fill_profile(heights)
    }
    Ok(places)
}

fn fill_profile(heights: &mut [f64]) {
    let (mut before, mut place) = (None, 0);
    while place < heights.len() {
        let end = (place..heights.len()).find(|place| heights[*place].is_finite());
        for gap in place..end.unwrap_or(heights.len()) {
            heights[gap] = match (before, end) {
                (Some(from), Some(to)) => between(
                    heights[from],
                    heights[to],
                    (gap - from) as f64 / (to - from) as f64,
                ),
                (Some(near), None) | (None, Some(near)) => heights[near],
                (None, None) => continue,
            };
        }
        before = end;
        place = end.map_or(heights.len(), |end| end + 1);
    }
}

fn mean(heights: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = heights.fold((0.0, 0_u8), |(sum, count), height| {
        (sum + height, count + 1)
    });
    sum / f64::from(count)
}

/// Number of passes over the missing points at each resolution.
const PASSES: usize = 12;

/// Fills the missing points at these indices from all sides. It begins with the means of blocks of
/// 2 × 2 points, filled in the same way. It then replaces each height several times by the mean of
/// its neighbours. This nearly solves Laplace's equation in the gaps, with zero slope across the
/// borders of the map.
fn fill(heights: &mut [f64], columns: usize, places: &[usize]) -> Result<(), OutOfMemory> {
    let rows = heights.len() / columns;
    let (half_columns, half_rows) = (columns.div_ceil(2), rows.div_ceil(2));
    let block = |index: usize| {
        let (row, column) = (2 * (index / half_columns), 2 * (index % half_columns));
        let points = (row..rows.min(row + 2))
            .flat_map(|y| (column..columns.min(column + 2)).map(move |x| (x, y)));
        mean(
            points
                .map(|(x, y)| heights[y * columns + x])
                .filter(|height| height.is_finite()),
        )
    };
    if places.is_empty() {
        return Ok(());
    }
    let mut halved = gathered(
        half_columns * half_rows,
        (0..half_columns * half_rows).map(block),
    )?;
    let gaps = gathered(
        count(&halved),
        (0..halved.len()).filter(|index| !halved[*index].is_finite()),
    )?;
    fill(&mut halved, half_columns, &gaps)?;
    for &index in places {
        let (row, column) = (index / columns, index % columns);
        heights[index] = halved[row / 2 * half_columns + column / 2];
    }
    for _ in 0..PASSES {
        for &index in places {
            let (row, column) = (index / columns, index % columns);
            let before =
                [(column > 0, 1), (row > 0, columns)].map(|(is, step)| is.then(|| index - step));
            let behind = [(column + 1 < columns, 1), (row + 1 < rows, columns)];
            let behind = behind.map(|(is, step)| is.then(|| index + step));
            let around = before.into_iter().chain(behind).flatten();
            heights[index] = mean(around.map(|index| heights[index]));
        }
    }
    Ok(())
}

/// Number of points on either side, along each axis, with which a point is compared.
const REACH: usize = 2;

/// Least distance of an outlier from the median around it, in standard deviations of these
/// distances.
const FAR: f64 = 4.0;

/// Standard deviation over median absolute deviation of the normal distribution.
const OF_DEVIATION: f64 = 1.482_602_218_505_602;

/// Marks outliers in rows of `columns` points as missing (NaN), by the identifier of Hampel, and
/// returns their number. The distance of an outlier from the median of the points around it exceeds
/// [`FAR`] standard deviations, which follow from the median of all distances. The tilt of the
/// surface is allowed for, also at borders, where one side has fewer points.
pub(super) fn remove_outliers(heights: &mut [f64], columns: usize) -> Result<usize, OutOfMemory> {
    let rows = heights.len() / columns;
    let slope = |step: usize| {
        let pairs = heights.iter().zip(heights.iter().skip(step));
        let known = pairs
            .map(|(one, other)| other - one)
            .filter(|difference| difference.is_finite());
        gathered(heights.len(), known)
            .map(|mut differences| median(&mut differences).unwrap_or(0.0))
    };
    let tilt = [slope(1)?, if rows > 1 { slope(columns)? } else { 0.0 }];
    let level = |index: usize| {
        heights[index] - tilt[0] * (index % columns) as f64 - tilt[1] * (index / columns) as f64
    };
    let mut around = Vec::with_capacity((2 * REACH + 1) * (2 * REACH + 1));
    let distances = (0..heights.len()).map(|index| {
        let (row, column) = (index / columns, index % columns);
        let reach = |place: usize, count: usize| REACH.min(place).min(count - 1 - place);
        let (across, along) = (reach(row, rows), reach(column, columns));
        around.clear();
        for row in row - across..=row + across {
            let first = row * columns + column - along;
            let others = (first..=first + 2 * along).filter(|other| *other != index);
            around.extend(others.map(level).filter(|height| height.is_finite()));
        }
        // A corner has no points around it.
        median(&mut around).map_or(0.0, |median| level(index) - median)
    });
    let distances = gathered(heights.len(), distances)?;
    let known = || distances.iter().filter(|distance| distance.is_finite());
    let mut sizes = gathered(known().count(), known().map(|distance| distance.abs()))?;
    let most = FAR * OF_DEVIATION * median(&mut sizes).unwrap_or(0.0);
    let mut count = 0;
    // Where most distances are zero, as between few digits, nothing is known of their spread.
    for (height, _) in heights
        .iter_mut()
        .zip(&distances)
        .filter(|(_, one)| most > 0.0 && one.abs() > most)
    {
        *height = f64::NAN;
        count += 1;
    }
    Ok(count)
}

/// Subtracts from each row of `columns` points its median height.
pub(super) fn level_rows(heights: &mut [f64], columns: usize) -> Result<(), OutOfMemory> {
    let mut known = gathered(columns, std::iter::repeat_n(0.0, columns))?;
    for row in heights.chunks_exact_mut(columns) {
        known.clear();
        known.extend(row.iter().filter(|height| height.is_finite()));
        let level = median(&mut known).unwrap_or(0.0);
        row.iter_mut().for_each(|height| *height -= level);
    }
    Ok(())
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
        // A plane solves Laplace's equation; beyond its rim the surface is level.
        let columns = 60;
        let plane = |index: usize| (index % columns) as f64 + 2.0 * (index / columns) as f64;
        let place = |index: usize| (index % columns, index / columns);
        let is_hole = |index: usize| {
            let (x, y) = place(index);
            // Also a row and a column without any measured point.
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
        // Of 140 from corner to corner.
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

    #[test]
    fn spikes_are_outliers_and_slopes_are_not() {
        let columns = 40;
        let rough = |i: usize| (7.3 * (i * i % 101) as f64).sin();
        let tilted =
            |i: usize| 50.0 * (i % columns) as f64 - 20.0 * (i / columns) as f64 + rough(i);
        for rows in [1, 30] {
            let heights: Vec<f64> = (0..columns * rows).map(tilted).collect();
            let mut same = heights.clone();
            assert_eq!(
                (remove_outliers(&mut same, columns), &same),
                (Ok(0), &heights)
            );
            let mut spiked = heights.clone();
            let places = [17, columns * rows - 10];
            places.iter().for_each(|&place| spiked[place] += 400.0);
            spiked[5] = f64::NAN;
            assert_eq!(remove_outliers(&mut spiked, columns), Ok(places.len()));
            assert!(places.iter().all(|&place| spiked[place].is_nan()));
        }
        let mut flat = vec![1.0; 64];
        flat[30] = 9.0;
        assert_eq!(remove_outliers(&mut flat, 8), Ok(0));
    }

    #[test]
    fn levelled_rows_have_medians_of_zero() {
        let mut heights = [
            1.0,
            5.0,
            2.0,
            9.0,
            f64::NAN,
            7.0,
            f64::NAN,
            f64::NAN,
            f64::NAN,
        ];
        level_rows(&mut heights, 3).unwrap();
        assert_eq!(heights[..4], [-1.0, 3.0, 0.0, 1.0]);
        assert!(heights[5] == -1.0 && heights[6..].iter().all(|height| height.is_nan()));
    }
}
