//! Gauss-Legendre quadrature on the quarter circle.

use std::f64::consts::{FRAC_PI_2, PI};

/// Nodes in (0, π/2) and weights of Gauss-Legendre quadrature with this number of nodes.
pub fn quadrature<const COUNT: usize>() -> [(f64, f64); COUNT] {
    std::array::from_fn(|index| node(COUNT, index))
}

/// A zero of the Legendre polynomial of this degree and its weight, on the quarter circle.
fn node(degree: usize, index: usize) -> (f64, f64) {
    let count = degree as f64;
    let mut x = (PI * (index as f64 + 0.75) / (count + 0.5)).cos();
    let mut slope = 1.0;
    for _ in 0..20 {
        let (mut before, mut value) = (1.0, x);
        for k in 2..=degree {
            let k = k as f64;
            (before, value) = (value, ((2.0 * k - 1.0) * x * value - (k - 1.0) * before) / k);
        }
        slope = count * (x * value - before) / (x * x - 1.0);
        x -= value / slope;
    }
    let weight = 2.0 / ((1.0 - x * x) * slope * slope);
    (0.5 * FRAC_PI_2 * (1.0 + x), 0.5 * FRAC_PI_2 * weight)
}
