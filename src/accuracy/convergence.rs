//! Orders of convergence, and bounds that errors keep.

/// Finer solutions that confirm an error.
pub(super) const REFINEMENTS: usize = 2;

/// Observed order of convergence between two errors, the second of a solution that is `ratio` times as fine:
/// ln(coarse/fine)/ln(ratio). `None` if the order is meaningless.
#[must_use]
pub(super) fn observed_order(coarse: f64, fine: f64, ratio: f64) -> Option<f64> {
    let order = (coarse / fine).ln() / ratio.ln();
    (coarse > 0.0 && fine > 0.0 && order.is_finite()).then_some(order)
}

/// Slope of the straight line of least squares through some points; `None` with fewer than three.
pub(super) fn slope(points: &[(f64, f64)]) -> Option<f64> {
    let mean = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / points.len() as f64;
    let (x, y) = (mean(|point| point.0), mean(|point| point.1));
    let product: f64 = points.iter().map(|point| (point.0 - x) * (point.1 - y)).sum();
    let square: f64 = points.iter().map(|point| (point.0 - x).powi(2)).sum();
    Some(product / square).filter(|slope| points.len() >= 3 && slope.is_finite())
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
    fn an_order_is_that_of_a_power() {
        assert!((observed_order(1.0, 0.125, 2.0).unwrap() - 3.0).abs() < 1e-15);
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
