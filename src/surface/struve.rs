//! Struve functions H₀ and H₁, which transform a wave about an axis of revolution into the equivalent profile.

use std::f64::consts::{FRAC_2_PI, FRAC_PI_2, PI};
use std::sync::LazyLock;

/// Argument from which on the asymptotic series is fully accurate: its smallest term is about e^−z.
const LARGE: f64 = 40.0;
/// Nodes of the integral below: enough for the waves of its integrand up to `LARGE`.
const NODES: usize = 56;

/// Nodes in (0, π/2) and weights of Gauss-Legendre quadrature.
static RULE: LazyLock<[(f64, f64); NODES]> = LazyLock::new(|| std::array::from_fn(node));

/// H₀(z), z ≥ 0.
#[must_use]
pub fn struve_0(z: f64) -> f64 {
    if z < LARGE {
        return FRAC_2_PI * integral(|angle| (z * angle.cos()).sin());
    }
    // H₀ − Y₀ ~ (2/π) Σ (−1)^k ((2k−1)!!)²/z^(2k+1)
    let difference = asymptotic(z.recip(), |k| -((2.0 * k + 1.0) / z).powi(2));
    libm::y0(z) + FRAC_2_PI * difference
}

/// ∫ over the quarter circle.
fn integral(of: impl Fn(f64) -> f64) -> f64 {
    RULE.iter().map(|&(angle, weight)| weight * of(angle)).sum()
}

/// Sum of a series from its first term and the factor after term k, down to rounding.
fn asymptotic(first: f64, factor: impl Fn(f64) -> f64) -> f64 {
    let (mut sum, mut term) = (0.0, first);
    for k in 0..LARGE as u32 {
        sum += term;
        let next = term * factor(f64::from(k));
        if next.abs() >= term.abs() || next.abs() < f64::EPSILON * f64::abs(sum) {
            break;
        }
        term = next;
    }
    sum
}

/// A zero of the Legendre polynomial and its weight, on the quarter circle.
fn node(index: usize) -> (f64, f64) {
    let count = NODES as f64;
    let mut x = (PI * (index as f64 + 0.75) / (count + 0.5)).cos();
    let mut slope = 1.0;
    for _ in 0..20 {
        let (mut before, mut value) = (1.0, x);
        for k in 2..=NODES {
            let k = k as f64;
            (before, value) = (value, ((2.0 * k - 1.0) * x * value - (k - 1.0) * before) / k);
        }
        slope = count * (x * value - before) / (x * x - 1.0);
        x -= value / slope;
    }
    let weight = 2.0 / ((1.0 - x * x) * slope * slope);
    (0.5 * FRAC_PI_2 * (1.0 + x), 0.5 * FRAC_PI_2 * weight)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Power series, accurate for small arguments.
    fn series(z: f64) -> f64 {
        let (mut term, mut sum) = (z, 0.0);
        for k in 1..60 {
            sum += term;
            term *= -z * z / (2.0 * f64::from(k) + 1.0).powi(2);
        }
        FRAC_2_PI * sum
    }

    #[test]
    fn small_arguments_are_those_of_the_power_series() {
        for k in 0..100 {
            let z = 0.05 * f64::from(k);
            let (found, expected) = (struve_0(z), series(z));
            assert!((found - expected).abs() <= 1e-14 * expected.abs().max(0.1), "{z}: {found} {expected}");
        }
    }

    #[test]
    fn both_ways_agree_where_they_meet_and_solve_the_equation_of_struve() {
        assert!((struve_0(LARGE.next_down()) - struve_0(LARGE)).abs() < 4e-14);
        // z H₀″ + H₀′ + z H₀ = 2/π
        for z in [0.3, 3.0, 20.0, 39.9, 40.1, 300.0] {
            let step = 1e-3;
            let [below, at, above] = [-step, 0.0, step].map(|by| struve_0(z + by));
            let (slope, bend) = ((above - below) / (2.0 * step), (above - 2.0 * at + below) / (step * step));
            assert!((z * (bend + at) + slope - FRAC_2_PI).abs() < 2e-7 * z.max(1.0), "{z}: {slope} {bend}");
        }
    }
}
