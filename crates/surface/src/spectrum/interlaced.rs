//! Recognition of maps whose rows come alternately from two scans (trace and retrace) that are
//! displaced against each other along the rows.

/// Largest number of pairs of neighbouring rows that are compared. The limit holds separately for
/// pairs that begin with an even row and for pairs that begin with an odd row.
const MOST_PAIRS: usize = 128;

/// Largest displacement along the rows that is tried, in points.
const REACH: usize = 16;

/// Largest ratio of the mean square difference between neighbouring rows with the displacement to
/// that without displacement. If the ratio is larger, the displacement is not certain.
const LEFT: f64 = 0.75;

/// Returns the number of points by which the odd rows of a map are displaced against the even rows.
/// Returns `None` unless the displacement is certain.
///
/// A displacement whose sign alternates from row to row comes from two scans. Other displacements
/// do not count: most surfaces have none, or the same displacement from each row to the next. The
/// same displacement in all rows comes from a drift, or from a surface with a lay (direction of
/// machining marks) oblique to the rows.
pub(super) fn displacement(heights: &[f64], columns: usize) -> Option<f64> {
    // `of_odd` is the displacement of odd rows against the even rows before them, and `of_even`
    // that of even rows against the odd rows before them.
    let of_odd = displacement_of_pairs(heights, columns, 0)?;
    let of_even = displacement_of_pairs(heights, columns, 1)?;
    let has_two_scans = of_odd * of_even < 0.0 && (of_odd + of_even).abs() <= 1.0;
    has_two_scans.then_some(0.5 * (of_odd - of_even).abs())
}

/// Returns the number of points by which the second row of each pair is displaced against the first
/// row. The pairs begin at the rows `first`, `first` + 2, and so on. Returns `None` if no
/// displacement makes the rows much more alike.
fn displacement_of_pairs(heights: &[f64], columns: usize, first: usize) -> Option<f64> {
    let rows = heights.len() / columns;
    let reach = REACH.min(columns / 8);
    let pairs = rows.saturating_sub(1 + first).div_ceil(2);
    let row = |number: usize| &heights[number * columns..][..columns];
    let mut differences = [0.0; 2 * REACH + 1];
    for pair in (0..pairs).step_by(pairs.div_ceil(MOST_PAIRS).max(1)) {
        let number = first + 2 * pair;
        let inner = &row(number)[reach..columns - reach];
        let next = row(number + 1);
        for (moved, sum) in differences.iter_mut().enumerate().take(2 * reach + 1) {
            *sum += squares_about_mean(inner, &next[moved..]);
        }
    }
    let least = (0..=2 * reach)
        .min_by(|moved, other| differences[*moved].total_cmp(&differences[*other]))?;
    let is_certain = differences[least] < LEFT * differences[reach];
    is_certain.then_some(least as f64 - reach as f64)
}

/// Returns the sum of the squared differences of two rows about their mean difference. Rows may
/// differ in their mean height.
fn squares_about_mean(row: &[f64], next: &[f64]) -> f64 {
    let mut count = 0.0;
    let mut sum = 0.0;
    let mut squares = 0.0;
    for (height, next) in row.iter().zip(next) {
        let difference = next - height;
        count += 1.0;
        sum += difference;
        squares += difference * difference;
    }
    squares - sum * sum / count
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns heights in rows of 64 points. The surface has waves in all directions, and each row
    /// is displaced by `displaced` points.
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
        // The next maps have no displacement, a drift, or a lay oblique to the rows.
        assert_eq!(displacement(&rows(|_| 0.0), 64), None);
        assert_eq!(displacement(&rows(|row| 2.0 * row as f64), 64), None);
        let lay: Vec<f64> = (0..64 * 48)
            .map(|i| (0.3 * (i % 64 + 4 * (i / 64)) as f64).sin())
            .collect();
        assert_eq!(displacement(&lay, 64), None);
        // The next maps have noise, or rows that alternate between two levels.
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
