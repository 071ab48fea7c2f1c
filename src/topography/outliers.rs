//! Outliers: heights far from those around them, as spikes of an instrument and grains of dust are.

use super::error::{TopographyError, gathered};

/// Points around a point on either side along each axis.
const REACH: usize = 2;

/// Least distance of an outlier from the median around it, in standard deviations of these distances.
const FAR: f64 = 4.0;

/// Standard deviation of the normal distribution over its median absolute deviation.
const OF_DEVIATION: f64 = 1.482_602_218_505_602;

/// Makes outliers in rows of `columns` points missing (NaN), by the identifier of Hampel: heights whose distance from the
/// median of the points around them exceeds [`FAR`] standard deviations, which follow from the median of all distances.
/// The tilt does not count, nor do more points on one side than on the other at borders. Returns the number of outliers.
pub(super) fn remove(heights: &mut [f64], columns: usize) -> Result<usize, TopographyError> {
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
pub(super) fn level_rows(heights: &mut [f64], columns: usize) -> Result<(), TopographyError> {
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

    #[test]
    fn spikes_are_outliers_and_slopes_are_not() {
        let columns = 40;
        let rough = |i: usize| (7.3 * (i * i % 101) as f64).sin();
        let tilted = |i: usize| 50.0 * (i % columns) as f64 - 20.0 * (i / columns) as f64 + rough(i);
        for rows in [1, 30] {
            let heights: Vec<f64> = (0..columns * rows).map(tilted).collect();
            let mut same = heights.clone();
            assert_eq!((remove(&mut same, columns), &same), (Ok(0), &heights));
            let mut spiked = heights.clone();
            let places = [17, columns * rows - 10];
            places.iter().for_each(|&place| spiked[place] += 400.0);
            spiked[5] = f64::NAN;
            assert_eq!(remove(&mut spiked, columns), Ok(places.len()));
            assert!(places.iter().all(|&place| spiked[place].is_nan()));
        }
        let mut flat = vec![1.0; 64];
        flat[30] = 9.0;
        assert_eq!(remove(&mut flat, 8), Ok(0));
    }

    #[test]
    fn levelled_rows_have_medians_of_zero() {
        let mut heights = [1.0, 5.0, 2.0, 9.0, f64::NAN, 7.0, f64::NAN, f64::NAN, f64::NAN];
        level_rows(&mut heights, 3).unwrap();
        assert_eq!(heights[..4], [-1.0, 3.0, 0.0, 1.0]);
        assert!(heights[5] == -1.0 && heights[6..].iter().all(|height| height.is_nan()));
    }
}
