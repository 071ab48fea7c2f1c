//! Missing points, interpolated from their neighbours, and outliers: heights far from those around them, as spikes of an
//! instrument and grains of dust are.

use super::{Place, TopographyError, refused};
use crate::memory::{OutOfMemory, emptied, gathered};

/// Smallest share of measured points for interpolation.
const LEAST_MEASURED: f64 = 0.5;

pub(super) fn count(heights: &[f64]) -> usize {
    heights.iter().filter(|height| !height.is_finite()).count()
}

/// Interpolates the missing heights of a map with `columns` columns, or of a profile, which is one row. Returns the indices
/// of the interpolated heights.
///
/// A missing height is the mean of two linear interpolations, one along its row and one along its column, each from
/// the nearest measured point before to the nearest one behind. Before the first or behind the last measured point
/// of a row or column the height is constant; a row or column without any measured point does not contribute.
pub(super) fn interpolate(heights: &mut [f64], columns: usize) -> Result<Vec<usize>, TopographyError> {
    let missing = count(heights);
    let share = 1.0 - missing as f64 / heights.len() as f64;
    if share < LEAST_MEASURED {
        let fault = format!("{:.1} % of the points are measured", 100.0 * share);
        return Err(refused(Place::File, fault, format!("at least {:.0} %", 100.0 * LEAST_MEASURED)));
    }
    let rows = heights.len() / columns;
    let mut filled: Vec<(usize, f64)> = emptied(Vec::new(), missing)?;
    for row in 0..rows {
        for_each_gap(heights, row * columns, 1, columns, |index, height| filled.push((index, height)));
    }
    // Heights along rows are in order; those along columns are added to them, or appended.
    let along_rows = filled.len();
    for column in (0..columns).filter(|_| rows > 1) {
        for_each_gap(heights, column, columns, rows, |index, height| {
            match filled[..along_rows].binary_search_by_key(&index, |(index, _)| *index) {
                Ok(place) => filled[place].1 = 0.5 * (filled[place].1 + height),
                Err(_) => filled.push((index, height)),
            }
        });
    }
    filled.iter().for_each(|(index, height)| heights[*index] = *height);
    match heights.iter().position(|height| !height.is_finite()) {
        Some(index) => Err(refused(
            Place::Point(index + 1),
            "missing like all points of its row and its column",
            "a measured point in the row or the column",
        )),
        None => Ok(filled.into_iter().map(|(index, _)| index).collect()),
    }
}

/// Calls `fill` with the index and the interpolated height of each missing one of `count` heights, `step` indices apart.
fn for_each_gap(heights: &[f64], first: usize, step: usize, count: usize, mut fill: impl FnMut(usize, f64)) {
    let at = |place: usize| heights[first + place * step];
    let mut before = None;
    let mut place = 0;
    while place < count {
        let end = (place..count).find(|place| at(*place).is_finite());
        for gap in place..end.unwrap_or(count) {
            let height = match (before, end) {
                (Some(from), Some(to)) => {
                    at(from) + (gap - from) as f64 / (to - from) as f64 * (at(to) - at(from))
                }
                (Some(near), None) | (None, Some(near)) => at(near),
                (None, None) => continue,
            };
            fill(first + gap * step, height);
        }
        before = end;
        place = end.map_or(count, |end| end + 1);
    }
}

/// Points around a point on either side along each axis.
const REACH: usize = 2;

/// Least distance of an outlier from the median around it, in standard deviations of these distances.
const FAR: f64 = 4.0;

/// Standard deviation of the normal distribution over its median absolute deviation.
const OF_DEVIATION: f64 = 1.482_602_218_505_602;

/// Makes outliers in rows of `columns` points missing (NaN), by the identifier of Hampel: heights whose distance from the
/// median of the points around them exceeds [`FAR`] standard deviations, which follow from the median of all distances.
/// The tilt does not count, nor do more points on one side than on the other at borders. Returns the number of outliers.
pub(super) fn remove_outliers(heights: &mut [f64], columns: usize) -> Result<usize, OutOfMemory> {
    let rows = heights.len() / columns;
    let slope = |step: usize| {
        let pairs = heights.iter().zip(heights.iter().skip(step));
        let known = pairs.map(|(one, other)| other - one).filter(|difference| difference.is_finite());
        gathered(heights.len(), known).map(|mut differences| median(&mut differences))
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
        if around.is_empty() { 0.0 } else { level(index) - median(&mut around) }
    });
    let distances = gathered(heights.len(), distances)?;
    let known = || distances.iter().filter(|distance| distance.is_finite());
    let mut sizes = gathered(known().count(), known().map(|distance| distance.abs()))?;
    let most = FAR * OF_DEVIATION * median(&mut sizes);
    let mut count = 0;
    // Where most distances are zero, as between few digits, nothing is known of their spread.
    for (height, _) in heights.iter_mut().zip(&distances).filter(|(_, one)| most > 0.0 && one.abs() > most) {
        *height = f64::NAN;
        count += 1;
    }
    Ok(count)
}

/// Subtracts from each row of `columns` points the median of its heights.
pub(super) fn level_rows(heights: &mut [f64], columns: usize) -> Result<(), OutOfMemory> {
    let mut known = gathered(columns, std::iter::repeat_n(0.0, columns))?;
    for row in heights.chunks_exact_mut(columns) {
        known.clear();
        known.extend(row.iter().filter(|height| height.is_finite()));
        let level = median(&mut known);
        row.iter_mut().for_each(|height| *height -= level);
    }
    Ok(())
}

/// The median of values in any order; 0 of none.
fn median(values: &mut [f64]) -> f64 {
    let count = values.len();
    if count == 0 {
        return 0.0;
    }
    let (below, &mut upper, _) = values.select_nth_unstable_by(count / 2, f64::total_cmp);
    let lower = below.iter().copied().reduce(f64::max).filter(|_| count.is_multiple_of(2));
    lower.map_or(upper, |lower| f64::midpoint(lower, upper))
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
    fn a_point_of_a_map_is_the_mean_of_row_and_column() {
        let mut heights = [0.0, 1.0, 2.0, 3.0, NONE, 7.0, 6.0, 9.0, 8.0];
        assert!(interpolate(&mut heights, 3).is_ok());
        assert_eq!(heights[4], 0.5 * (5.0 + 5.0));
        // A row without any measured point is interpolated from its columns.
        let mut heights = [0.0, 1.0, NONE, NONE, 4.0, 5.0];
        assert!(interpolate(&mut heights, 2).is_ok());
        assert_eq!(heights, [0.0, 1.0, 2.0, 3.0, 4.0, 5.0]);
    }

    #[test]
    fn too_few_points_are_refused() {
        let mut few = [NONE, NONE, 1.0];
        assert!(interpolate(&mut few, 3).unwrap_err().to_string().contains("allowed: at least 50 %"));
        let mut cross = [NONE, NONE, NONE, 1.0, NONE, 2.0, 3.0, 4.0, NONE, 6.0, 7.0, 8.0];
        cross[1] = NONE;
        assert!(interpolate(&mut cross, 3).is_ok());
        let mut corner = [NONE, NONE, NONE, 1.0, NONE, 3.0];
        // The middle column and the upper row are empty.
        assert!(interpolate(&mut corner, 3).unwrap_err().to_string().contains("33.3 % of the points"));
    }

    #[test]
    fn spikes_are_outliers_and_slopes_are_not() {
        let columns = 40;
        let rough = |i: usize| (7.3 * (i * i % 101) as f64).sin();
        let tilted = |i: usize| 50.0 * (i % columns) as f64 - 20.0 * (i / columns) as f64 + rough(i);
        for rows in [1, 30] {
            let heights: Vec<f64> = (0..columns * rows).map(tilted).collect();
            let mut same = heights.clone();
            assert_eq!((remove_outliers(&mut same, columns), &same), (Ok(0), &heights));
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
        let mut heights = [1.0, 5.0, 2.0, 9.0, f64::NAN, 7.0, f64::NAN, f64::NAN, f64::NAN];
        level_rows(&mut heights, 3).unwrap();
        assert_eq!(heights[..4], [-1.0, 3.0, 0.0, 1.0]);
        assert!(heights[5] == -1.0 && heights[6..].iter().all(|height| height.is_nan()));
    }
}
