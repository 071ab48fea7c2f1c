//! Maps whose rows alternate between two scans, trace and retrace, that are displaced against each
//! other along the rows.

/// Largest number of compared pairs of neighbouring rows, of each order, and the largest
/// displacement searched, in points.
const MOST_PAIRS: usize = 128;
const REACH: usize = 16;

/// Largest share of the mean square difference of neighbouring rows that may remain after the
/// displacement.
const LEFT: f64 = 0.75;

/// Returns the number of points by which the odd rows are displaced against the even rows; `None`
/// unless this is certain.
///
/// Neighbouring rows of a surface are most alike without a displacement, or with the same
/// displacement from each row to the next. The latter results from a lay askew to the rows or from
/// a drift. A displacement whose sign alternates from row to row comes from two scans.
pub(super) fn displacement(heights: &[f64], columns: usize) -> Option<f64> {
    let rows = heights.len() / columns;
    let reach = REACH.min(columns / 8);
    let row = |number: usize| &heights[number * columns..][..columns];
    let [from_even, from_odd] = [0, 1].map(|first| {
        let pairs = rows.saturating_sub(1 + first).div_ceil(2);
        let mut differences = [0.0; 2 * REACH + 1];
        for pair in (0..pairs).step_by(pairs.div_ceil(MOST_PAIRS).max(1)) {
            let (one, next) = (row(first + 2 * pair), row(first + 2 * pair + 1));
            let one = &one[reach..columns - reach];
            for (moved, sum) in differences.iter_mut().enumerate().take(2 * reach + 1) {
                *sum += variance(one.iter().zip(&next[moved..]).map(|(z, beside)| beside - z));
            }
        }
        let least = (0..=2 * reach)
            .min_by(|one, other| differences[*one].total_cmp(&differences[*other]))?;
        (differences[least] < LEFT * differences[reach]).then_some(least as f64 - reach as f64)
    });
    let (one, other) = (from_even?, from_odd?);
    (one * other < 0.0 && (one + other).abs() <= 1.0).then_some(0.5 * (one - other).abs())
}

/// Sums the squares of values about their mean, because rows may differ in their mean height.
fn variance(values: impl Iterator<Item = f64>) -> f64 {
    let (count, sum, squares) = values.fold((0.0, 0.0, 0.0), |(count, sum, squares), value| {
        (count + 1.0, sum + value, squares + value * value)
    });
    squares - sum * sum / count
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Waves of all directions in rows of 64 points, each row displaced by some points.
    fn rows(displaced: impl Fn(usize) -> f64) -> Vec<f64> {
        let wave = |k: u32, x: f64, y: f64| {
            let angle = f64::from(k * k);
            let along = 0.06 * f64::from(k) * (x * angle.cos() + y * angle.sin());
            (along + angle).sin() / f64::from(k).powf(1.4)
        };
        let height = |x: f64, y: f64| (1..40).map(|k| wave(k, x, y)).sum::<f64>();
        let point = |index: usize| {
            height(
                (index % 64) as f64 + displaced(index / 64),
                (index / 64) as f64,
            )
        };
        (0..64 * 48).map(point).collect()
    }

    #[test]
    fn only_rows_of_two_scans_are_displaced_to_and_fro() {
        let parity = |row: usize| (row % 2) as f64;
        assert_eq!(displacement(&rows(|row| 3.0 * parity(row)), 64), Some(3.0));
        assert_eq!(displacement(&rows(|row| -parity(row)), 64), Some(1.0));
        // No displacement, drift, and a lay askew.
        assert_eq!(displacement(&rows(|_| 0.0), 64), None);
        assert_eq!(displacement(&rows(|row| 2.0 * row as f64), 64), None);
        let lay: Vec<f64> = (0..64 * 48)
            .map(|i| (0.3 * (i % 64 + 4 * (i / 64)) as f64).sin())
            .collect();
        assert_eq!(displacement(&lay, 64), None);
        // Noise, and rows at two levels in turn.
        let noise: Vec<f64> = (0..64 * 48_u32).map(|i| f64::from(i * i % 8191)).collect();
        assert_eq!(displacement(&noise, 64), None);
        let levels: Vec<f64> = rows(|_| 0.0)
            .iter()
            .enumerate()
            .map(|(i, z)| z + 5.0 * parity(i / 64))
            .collect();
        assert_eq!(displacement(&levels, 64), None);
    }
}
