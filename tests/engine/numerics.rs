//! Small numerics of the tests.

/// Observed order of convergence: the slope of ln(error) over −ln(N) by least squares.
pub fn observed_order(grids: &[usize], errors: &[f64]) -> f64 {
    let xs: Vec<f64> = grids.iter().map(|&points| -(points as f64).ln()).collect();
    let ys: Vec<f64> = errors.iter().map(|error| error.ln()).collect();
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let (x, y) = (mean(&xs), mean(&ys));
    let covariance: f64 = xs.iter().zip(&ys).map(|(a, b)| (a - x) * (b - y)).sum();
    covariance / xs.iter().map(|a| (a - x) * (a - x)).sum::<f64>()
}

/// Argument between `low` and `high` at which a rising function takes a value.
pub fn invert(function: impl Fn(f64) -> f64, value: f64, mut low: f64, mut high: f64) -> f64 {
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        *(if function(middle) < value { &mut low } else { &mut high }) = middle;
    }
    0.5 * (low + high)
}

/// ∫ f(x) dx by Simpson's rule.
pub fn integral(f: impl Fn(f64) -> f64, from: f64, to: f64) -> f64 {
    let steps = 2000;
    let width = (to - from) / f64::from(steps);
    let weight = |k| if k == 0 || k == steps { 1.0 } else { f64::from(2 + 2 * (k % 2)) };
    (0..=steps).map(|k| weight(k) * f(from + width * f64::from(k))).sum::<f64>() * width / 3.0
}
