//! Heights of few digits or bits, whose steps look like roughness.

use asperity_data::format_quantity;
use std::collections::HashSet;

/// Largest number of levels that are counted: more are as good as none.
const MOST_LEVELS: usize = 256;

/// Smallest number of points for each level: fewer points may all be on levels of their own.
const LEAST_POINTS: usize = 4;

/// Share of the squared differences between neighbours that rounding to levels adds, from which on
/// a message states it.
const LARGE: f64 = 0.1;

/// Returns a message about heights (m) in rows of `columns` points that have few levels. Rounding
/// to steps s adds errors of mean square s²/12 to each of two neighbours.
pub(super) fn warning(heights: &[f64], columns: usize) -> Option<String> {
    let levels = few_levels(heights)?;
    let step = levels
        .windows(2)
        .map(|pair| pair[1] - pair[0])
        .filter(|step| *step > 0.0)
        .fold(f64::INFINITY, f64::min);
    let share = step * step / 6.0 / mean_square_difference(heights, columns);
    if !share.is_finite() || share < LARGE || heights.len() < LEAST_POINTS * levels.len() {
        return None;
    }
    Some(format!(
        "the heights have {} levels, {} apart: if they are rounded to these, that adds {:.0} % of \
         the squared gradient, and the Hurst exponent is too small",
        levels.len(),
        format_quantity(step, "m"),
        100.0 * share.min(1.0)
    ))
}

/// Returns the different heights in ascending order; `None` if there are too many.
fn few_levels(heights: &[f64]) -> Option<Vec<f64>> {
    let mut found = HashSet::new();
    for height in heights.iter().filter(|height| height.is_finite()) {
        // 0 and -0 are one level.
        found.insert((height + 0.0).to_bits());
        if found.len() > MOST_LEVELS {
            return None;
        }
    }
    let mut levels: Vec<f64> = found.into_iter().map(f64::from_bits).collect();
    levels.sort_unstable_by(f64::total_cmp);
    Some(levels)
}

/// Returns the mean square difference of measured neighbours in rows; NaN if there are none.
fn mean_square_difference(heights: &[f64], columns: usize) -> f64 {
    let mut sum = 0.0;
    let mut count = 0_u32;
    for row in heights.chunks_exact(columns) {
        for pair in row.windows(2) {
            let square = (pair[1] - pair[0]).powi(2);
            if square.is_finite() {
                sum += square;
                count += 1;
            }
        }
    }
    sum / f64::from(count)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heights_of_few_bits_are_named_and_fine_ones_are_not() {
        let rounded = |step: f64| {
            let height = |i: i32| (40.0 * (0.05 * f64::from(i)).sin() / step).round() * step * 1e-9;
            (0..1024).map(height).collect::<Vec<_>>()
        };
        let found = warning(&rounded(5.0), 32).unwrap();
        assert!(
            found.starts_with(
                "the heights have 17 levels, 5 nm apart: if they are rounded to these, that adds "
            ),
            "{found}"
        );
        assert_eq!(
            (
                warning(&rounded(0.5), 32),
                warning(&rounded(1e-3), 32),
                warning(&[0.0, 1.0], 2)
            ),
            (None, None, None)
        );
        assert_eq!(warning(&[1e-9; 64], 8), None);
    }
}
