//! Errors of solutions from their differences.

/// Finer solutions that confirm an error.
pub(super) const REFINEMENTS: usize = 2;

/// Error of a solution over its larger difference from two others on 7/8 and on 3/4 of its springs.
///
/// For an error that falls with the square of the spacing, as with edges between springs, the larger difference is 0.78
/// of the error; for one that falls with the spacing, as of whole springs on a smooth body, it is a third. On rough
/// profiles errors change their sign by chance, and four differences cover at least 95 of 100 errors, at most ten times
/// the error in the median (`tests/program/cost/estimates.rs`).
const ERROR_PER_DIFFERENCE: f64 = 4.0;

/// Estimated error of a solution from its differences from two others, whose springs are not among its own.
#[must_use]
pub(super) fn error_of(differences: [f64; 2]) -> f64 {
    ERROR_PER_DIFFERENCE * differences[0].max(differences[1])
}

/// Observed order of convergence between two errors, the second of a solution that is `ratio` times as fine:
/// ln(coarse/fine)/ln(ratio). `None` if the order is meaningless.
#[must_use]
pub(super) fn observed_order(coarse: f64, fine: f64, ratio: f64) -> Option<f64> {
    let order = (coarse / fine).ln() / ratio.ln();
    (coarse > 0.0 && fine > 0.0 && order.is_finite()).then_some(order)
}

/// Index of the first of these errors, from coarse to fine, from which on none is above a bound. Two finer ones confirm
/// an error: one that changes its sign may be small by chance.
#[must_use]
pub(super) fn first_within(
    errors: impl DoubleEndedIterator<Item = Option<f64>>,
    bound: f64,
) -> Option<usize> {
    let errors: Vec<_> = errors.collect();
    let above = errors.iter().rposition(|error| error.is_none_or(|error| error.is_nan() || error > bound));
    let first = above.map_or(0, |above| above + 1);
    (first + REFINEMENTS < errors.len()).then_some(first)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_orders_are_within_the_estimate() {
        for order in [1.0, 1.5, 2.0, 4.0] {
            let error = |share: f64| 0.3 * share.powf(-order);
            let estimate = error_of([7.0 / 8.0, 3.0 / 4.0].map(|share| error(share) - error(1.0)));
            assert!((1.0..10.0).contains(&(estimate / error(1.0))), "{order}: {estimate}");
            assert!((observed_order(error(0.5), error(1.0), 2.0).unwrap() - order).abs() < 1e-9);
        }
        assert_eq!(observed_order(1.0, 0.0, 2.0), None);
    }

    #[test]
    fn a_bound_is_met_from_the_first_error_on_that_two_finer_ones_confirm() {
        let first = |errors: &[f64], bound| first_within(errors.iter().copied().map(Some), bound);
        assert_eq!(first(&[0.5, 0.01, 0.2, 0.1, 0.05, 0.02], 0.1), Some(3));
        assert_eq!(first(&[0.5, 0.01, 0.2], 0.1), None, "small by chance");
        assert_eq!(first(&[0.5, 0.01, 0.02], 0.1), None, "one refinement");
        assert_eq!(first(&[0.05, 0.0, 0.0], 0.1), Some(0));
        assert_eq!(first(&[], 0.1), None);
        assert_eq!(first(&[f64::NAN, 0.0, 0.0, 0.0], 0.1), Some(1));
        assert_eq!(first_within([Some(0.0), Some(0.0), None].into_iter(), 0.1), None);
    }
}
