//! Errors of a sequence of finer solutions, from their differences.

/// Weight of a difference against that of the next finer one.
const SHARE_OF_COARSER: f64 = 0.2;

/// Estimated distance of the finest of a sequence of solutions from the limit; each has half the spacing of the one
/// before, and `differences` are their distances from it, the coarsest first. NaN for an empty list.
///
/// Twice the sum of the differences, each with a fifth of the weight of the next finer one:
/// e = 2 (d_n + d_(n−1)/5 + d_(n−2)/25 + …).
///
/// Assumption: the error falls by a factor of two or more with each halving of the spacing, as at first order and above;
/// the remaining error is then at most the last difference. On rough profiles the error also changes its sign by
/// chance, so that one difference may be small: hence the factor of two and the coarser differences. On random scenes at
/// least 95 of 100 true errors are within the estimate, and the estimate is at most ten times the true error in the
/// median (`tests/program/cost/estimates.rs`).
#[must_use]
pub fn error_of_finest(differences: &[f64]) -> f64 {
    match differences {
        [] => f64::NAN,
        all => 2.0 * all.iter().fold(0.0, |sum, difference| SHARE_OF_COARSER * sum + difference),
    }
}

/// Observed order of convergence between two errors, the second of a solution that is `ratio` times as fine:
/// ln(coarse/fine)/ln(ratio). `None` if the order is meaningless.
#[must_use]
pub fn observed_order(coarse: f64, fine: f64, ratio: f64) -> Option<f64> {
    let order = (coarse / fine).ln() / ratio.ln();
    (coarse > 0.0 && fine > 0.0 && order.is_finite()).then_some(order)
}

/// Index of the first of these errors from which on none is above a bound.
#[must_use]
pub fn first_within(errors: impl DoubleEndedIterator<Item = Option<f64>>, bound: f64) -> Option<usize> {
    let errors: Vec<_> = errors.collect();
    let above = errors.iter().rposition(|error| error.is_none_or(|error| error.is_nan() || error > bound));
    let first = above.map_or(0, |above| above + 1);
    (first < errors.len()).then_some(first)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_orders_are_within_the_estimate() {
        for order in [1.0, 1.5, 2.0, 4.0] {
            let error = |k: i32| 0.3 * (-order * f64::from(k)).exp2();
            let differences: Vec<f64> = (0..4).map(|k| error(k) - error(k + 1)).collect();
            let estimate = error_of_finest(&differences);
            assert!(error(4) <= estimate, "{order}: {estimate}");
            assert!(order > 2.0 || estimate <= 20.0 * error(4), "{order}: {estimate}");
            assert!((observed_order(error(2), error(3), 2.0).unwrap() - order).abs() < 1e-9);
        }
    }

    #[test]
    fn a_small_last_difference_does_not_hide_those_before() {
        assert!((error_of_finest(&[1.0, 0.5, 0.0]) - 0.28).abs() < 1e-15);
        assert_eq!(error_of_finest(&[1.0, 2.0]), 4.4);
        assert_eq!(error_of_finest(&[0.25]), 0.5);
        assert_eq!(error_of_finest(&[0.0, 0.0]), 0.0);
        assert!(error_of_finest(&[]).is_nan());
        assert_eq!(observed_order(1.0, 0.0, 2.0), None);
    }

    #[test]
    fn a_bound_is_kept_from_the_first_on() {
        let first = |errors: &[f64], bound| first_within(errors.iter().copied().map(Some), bound);
        assert_eq!(first(&[0.5, 0.01, 0.2, 0.1, 0.05], 0.1), Some(3));
        assert_eq!(first(&[0.5, 0.2], 0.1), None);
        assert_eq!(first(&[0.05], 0.1), Some(0));
        assert_eq!(first(&[], 0.1), None);
        assert_eq!(first(&[f64::NAN, 0.0], 0.1), Some(1));
        assert_eq!(first_within([Some(0.0), None].into_iter(), 0.1), None);
    }
}
