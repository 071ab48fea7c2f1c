//! What a row of ever finer solutions tells of its own errors.

/// Orders of convergence that an estimate believes in: with less it could promise nothing, and more than
/// second order no rule of edges has.
const BELIEVED: (f64, f64) = (0.5, 2.0);

/// Estimated distance of the finest solution from the limit, of solutions of which each has half the spacing
/// of the one before: `last` is the distance of the two finest from each other, `before` that of the finest
/// but one from the one before it, where there is one.
///
/// Differences that fall by 2^p from one to the next leave last/(2^p − 1) to go. An order p beyond 0.5 to 2 is
/// taken for the nearer of the two, and where the differences do not fall at all, the larger of them is the
/// estimate; so is the only difference there is.
#[must_use]
pub fn error_of_finest(before: Option<f64>, last: f64) -> f64 {
    let Some(before) = before else { return last };
    if last >= before {
        return last.max(before);
    }
    let order = if last > 0.0 { (before / last).log2() } else { f64::INFINITY };
    let ratio = order.clamp(BELIEVED.0, BELIEVED.1).exp2();
    // With a believed order of 2 the difference before leaves a twelfth part over: a chance agreement of the
    // two finest does not make the limit known.
    (last / (ratio - 1.0)).max(before / (ratio * (ratio - 1.0)))
}

/// Observed order of convergence between two errors, the second of a solution that is `ratio` times as fine:
/// ln(coarse/fine)/ln(ratio). `None` where it says nothing.
#[must_use]
pub fn observed_order(coarse: f64, fine: f64, ratio: f64) -> Option<f64> {
    let order = (coarse / fine).ln() / ratio.ln();
    (coarse > 0.0 && fine > 0.0 && order.is_finite()).then_some(order)
}

/// The first of these errors from which on none is above a bound.
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

    /// Values 1 + c 2^(−pk) of ever finer solutions.
    fn differences(order: f64, finest: i32) -> (f64, f64, f64) {
        let value = |k: i32| 1.0 + 0.3 * (-order * f64::from(k)).exp2();
        let [coarse, middle, fine] = [finest - 2, finest - 1, finest].map(value);
        ((coarse - middle).abs(), (middle - fine).abs(), (fine - 1.0).abs())
    }

    #[test]
    fn known_orders_give_known_errors() {
        for order in [0.5, 1.0, 1.5, 2.0] {
            let (before, last, error) = differences(order, 6);
            let estimate = error_of_finest(Some(before), last);
            assert!((estimate / error - 1.0).abs() < 1e-9, "order {order}: {estimate} for {error}");
            let (_, _, coarse) = differences(order, 5);
            assert!((observed_order(coarse, error, 2.0).unwrap() - order).abs() < 1e-9);
        }
    }

    #[test]
    fn estimates_do_not_promise_what_they_cannot_know() {
        // Better than second order, by chance or not.
        let (before, last, error) = differences(4.0, 3);
        assert!(error_of_finest(Some(before), last) > error);
        assert!((error_of_finest(Some(1.2), 0.0) - 0.1).abs() < 1e-15);
        // None at all.
        assert_eq!(error_of_finest(Some(1.0), 2.0), 2.0);
        assert_eq!(error_of_finest(Some(2.0), 2.0), 2.0);
        assert_eq!(error_of_finest(None, 0.25), 0.25);
        assert_eq!(error_of_finest(Some(0.0), 0.0), 0.0);
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
