//! Sums and integrals of powers.

use crate::numerics::CompensatedSum;

/// Number of terms of a sum of powers that are added one by one. The Euler-Maclaurin formula gives
/// the sum of the other terms.
const DIRECT_TERMS: u64 = 64;

/// Coefficients B₂/2!, B₄/4!, … of the Euler-Maclaurin formula, where B₂, B₄, … are Bernoulli
/// numbers. If 64 terms are added one by one, the first correction that is left out is below 1e-18
/// of the sum.
const EULER_MACLAURIN: [f64; 5] = [
    1.0 / 12.0,
    -1.0 / 720.0,
    1.0 / 30_240.0,
    -1.0 / 1_209_600.0,
    1.0 / 47_900_160.0,
];

/// Returns Σ k^exponent for the integers k from `first` (at least 1) to `last`. The sum is 0 if
/// `last` is below `first`. Its relative error is a few units in the last place.
///
/// ```
/// let exact: f64 = (1..=100_000).rev().map(|k| f64::from(k).powi(-2)).sum();
/// assert!((asperity_data::sum_of_powers(-2.0, 1, 100_000) / exact - 1.0).abs() < 1e-14);
/// ```
pub fn sum_of_powers(exponent: f64, first: u64, last: u64) -> f64 {
    let end = last.min(first.saturating_add(DIRECT_TERMS - 1));
    let mut sum = CompensatedSum::default();
    for k in first..=end {
        sum.add((k as f64).powf(exponent));
    }
    if end == last {
        return sum.total();
    }
    // Euler-Maclaurin formula for the terms from m to n: Σ_{k=m}^{n} f(k) = ∫ f dk + (f(m) +
    // f(n))/2 + Σ B_2j/(2j)! (f^(2j−1)(n) − f^(2j−1)(m)). Here m is `low`, n is `high`, and the
    // last sum is over j = 1, 2, …
    let low = (end + 1) as f64;
    let high = last as f64;
    let mut derivative = Derivative::of_order_zero(exponent, low, high);
    sum.add(integral_of_power(exponent, low, high));
    sum.add(0.5 * derivative.at_low);
    sum.add(0.5 * derivative.at_high);
    for (index, coefficient) in EULER_MACLAURIN.into_iter().enumerate() {
        if index > 0 {
            derivative.differentiate();
        }
        derivative.differentiate();
        sum.add(coefficient * (derivative.at_high - derivative.at_low));
    }
    sum.total()
}

/// Derivative of f(k) = k^exponent at `low` and `high`, the first and the last k of the
/// Euler-Maclaurin formula.
struct Derivative {
    low: f64,
    high: f64,
    at_low: f64,
    at_high: f64,
    /// Exponent of k in this derivative.
    exponent: f64,
}

impl Derivative {
    fn of_order_zero(exponent: f64, low: f64, high: f64) -> Self {
        Derivative {
            low,
            high,
            at_low: low.powf(exponent),
            at_high: high.powf(exponent),
            exponent,
        }
    }

    fn differentiate(&mut self) {
        self.at_low *= self.exponent / self.low;
        self.at_high *= self.exponent / self.high;
        self.exponent -= 1.0;
    }
}

/// Returns ∫ q^power dq from `low` to `high`. The result is accurate even if the power is near −1.
pub fn integral_of_power(power: f64, low: f64, high: f64) -> f64 {
    let s = power + 1.0;
    // This form of ln(high/low) keeps all significant digits if `low` and `high` are nearly equal.
    let ratio = ((high - low) / low).ln_1p();
    if (s * ratio).abs() > 1.0 {
        return (high.powf(s) - low.powf(s)) / s;
    }
    let growth = if s == 0.0 {
        ratio
    } else {
        (s * ratio).exp_m1() / s
    };
    low.powf(s) * growth
}

#[cfg(test)]
mod tests {
    use super::*;

    fn direct_sum(exponent: f64, first: u64, last: u64) -> f64 {
        let mut sum = CompensatedSum::default();
        for k in (first..=last).rev() {
            sum.add((k as f64).powf(exponent));
        }
        sum.total()
    }

    #[test]
    fn sums_are_those_of_their_terms() {
        let ranges = [
            (1, 1),
            (1, 64),
            (1, 65),
            (1, 66),
            (1, 1000),
            (7, 70_001),
            (64, 129),
            (1000, 1064),
            (1_000_000, 1_000_065),
            (1, 1 << 20),
        ];
        for exponent in [
            -3.0,
            -2.4,
            -1.0 - 1e-300,
            -1.0,
            -1.0 + 1e-12,
            -0.4,
            0.0,
            0.8,
            1.0,
        ] {
            for (first, last) in ranges {
                let found = sum_of_powers(exponent, first, last);
                let expected = direct_sum(exponent, first, last);
                let error = (found / expected - 1.0).abs();
                assert!(
                    error <= 9e-16,
                    "Σ k^{exponent} from {first} to {last}: error {error:e}"
                );
            }
        }
    }
}
