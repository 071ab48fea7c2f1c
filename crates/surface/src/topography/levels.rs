//! Warning about heights that are stored with few digits or bits. The steps between such heights
//! look like roughness.

use asperity_data::format_quantity;
use std::collections::HashSet;

/// Largest number of different heights (levels) that are counted. If there are more levels, the
/// rounding of the heights is negligible.
const MOST_LEVELS: usize = 256;

/// Smallest number of points per level with which a warning is possible. If there are fewer points,
/// each point may have a level of its own by chance.
const LEAST_POINTS: usize = 4;

/// Smallest share of the mean square difference between neighbours that must result from rounding
/// to levels, for a warning to be returned.
const LARGE: f64 = 0.1;

/// Returns a warning if the heights are rounded to few different values (levels); otherwise `None`.
/// The heights are in m, in rows of `columns` points. Rounding to multiples of a step s adds an
/// error with the mean square s²/12 to each height. It therefore adds s²/6 to the mean square
/// difference of two neighbours.
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

/// Returns the different heights in ascending order; `None` if there are more than [`MOST_LEVELS`].
fn few_levels(heights: &[f64]) -> Option<Vec<f64>> {
    let mut found = HashSet::new();
    for height in heights.iter().filter(|height| height.is_finite()) {
        // Adding 0 turns −0 into 0, so that these two count as the same level.
        found.insert((height + 0.0).to_bits());
        if found.len() > MOST_LEVELS {
            return None;
        }
    }
    let mut levels: Vec<f64> = found.into_iter().map(f64::from_bits).collect();
    levels.sort_unstable_by(f64::total_cmp);
    Some(levels)
}

/// Returns the mean square difference between neighbouring measured heights of a row; NaN if no two
/// measured heights are neighbours.
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
