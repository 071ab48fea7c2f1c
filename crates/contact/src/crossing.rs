//! Searches for the argument at which a function passes zero or a condition becomes true. The
//! result is exact to the last digit of a floating-point number.

/// Largest number of halvings of an interval in a search. Fewer halvings are enough for any two
/// floating-point numbers.
const HALVINGS: usize = 2200;
/// Number of guesses by interpolation before a crossing is searched by halving alone.
const GUESSES: usize = 20;

/// Finds the smallest floating-point number in (low, high] for which `is_past` returns true.
/// `is_past(high)` must be true.
pub fn bisect(mut low: f64, mut high: f64, is_past: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..HALVINGS {
        let middle = low + 0.5 * (high - low);
        if middle <= low || middle >= high {
            break;
        }
        if is_past(middle) {
            high = middle
        } else {
            low = middle
        }
    }
    high
}

/// Finds the smallest floating-point number in (low, high] at which `value` is at least zero.
/// `value` must be negative at `low` and change sign only once.
pub fn crossing(low: f64, high: f64, value: impl Fn(f64) -> f64) -> f64 {
    let (low, high) = enclose(low, high, &value, |value| value >= 0.0);
    bisect(low, high, |place| value(place) >= 0.0)
}

/// Finds the largest floating-point number in \[low, high) at which `value` is at most zero.
/// `value` must be positive at `high` and change sign only once.
pub fn last_before(low: f64, high: f64, value: impl Fn(f64) -> f64) -> f64 {
    let (before, past) = enclose(low, high, &value, |value| value > 0.0);
    let first_past = bisect(before, past, |place| value(place) > 0.0);
    first_past.next_down().max(low)
}

/// Narrows an interval around a zero of `value` by interpolation. The returned lower end lies
/// before the zero, and the returned upper end past it.
///
/// If the same end moves twice, the interpolation uses half the value at the other end (the
/// Illinois rule), so that both ends move. Every fourth guess is the middle of the interval,
/// because interpolation alone may narrow the interval slowly.
fn enclose(
    mut low: f64,
    mut high: f64,
    value: &impl Fn(f64) -> f64,
    is_past: impl Fn(f64) -> bool,
) -> (f64, f64) {
    let mut value_at_low = value(low);
    let mut value_at_high = value(high);
    // `moved_end` is 1 if the last guess moved the upper end, and −1 if it moved the lower end.
    let mut moved_end = 0_i32;
    for guess in 0..GUESSES {
        let middle = low + 0.5 * (high - low);
        let between = high - value_at_high * ((high - low) / (value_at_high - value_at_low));
        let place = if guess % 4 != 3 && between > low && between < high {
            between
        } else {
            middle
        };
        if place <= low || place >= high {
            break;
        }
        let value_at_place = value(place);
        if is_past(value_at_place) {
            high = place;
            value_at_high = value_at_place;
            if moved_end > 0 {
                value_at_low *= 0.5;
            }
            moved_end = 1;
        } else {
            low = place;
            value_at_low = value_at_place;
            if moved_end < 0 {
                value_at_high *= 0.5;
            }
            moved_end = -1;
        }
    }
    (low, high)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::Cell;

    /// The search finds each zero to the last digit. In total it needs far fewer evaluations than
    /// halving, which needs about fifty for each zero.
    #[test]
    fn a_rising_zero_is_found_in_few_evaluations() {
        let evaluations = Cell::new(0);
        let mut zeros = 0;
        for root in (1..100).map(|k| f64::from(k) / 100.0) {
            for bend in [0.0, 1.0, 10.0] {
                let value = |at: f64| {
                    evaluations.set(evaluations.get() + 1);
                    (at - root) * (1.0 + bend * (at + 0.5))
                };
                let found = crossing(-0.5, 1.0, value);
                assert!(value(found) >= 0.0 && value(found.next_down()) < 0.0);
                let before = last_before(-0.5, 1.0, value);
                assert!(value(before) <= 0.0 && value(before.next_up()) > 0.0);
                zeros += 2;
            }
        }
        assert!(
            evaluations.get() <= 40 * zeros,
            "{} evaluations for {zeros} zeros",
            evaluations.get()
        );
    }
}
