//! Small numerics of the tests.

/// Observed order of convergence: the slope of ln(error) over ln(step) by least squares.
pub fn observed_order(steps: &[f64], errors: &[f64]) -> f64 {
    let mean =
        |values: &[f64]| values.iter().map(|value| value.ln()).sum::<f64>() / values.len() as f64;
    let (x, y) = (mean(steps), mean(errors));
    let pairs = || {
        steps
            .iter()
            .zip(errors)
            .map(|(step, error)| (step.ln() - x, error.ln() - y))
    };
    pairs().map(|(a, b)| a * b).sum::<f64>() / pairs().map(|(a, _)| a * a).sum::<f64>()
}

/// Argument between `low` and `high` at which a rising function takes a value.
pub fn invert(function: impl Fn(f64) -> f64, value: f64, mut low: f64, mut high: f64) -> f64 {
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            return middle;
        }
        *(if function(middle) < value {
            &mut low
        } else {
            &mut high
        }) = middle;
    }
}

/// ∫ f(x) dx by Simpson's rule.
pub fn integral(f: impl Fn(f64) -> f64, from: f64, to: f64) -> f64 {
    let steps = 2000;
    let width = (to - from) / f64::from(steps);
    let weight = |k| {
        if k == 0 || k == steps {
            1.0
        } else {
            f64::from(2 + 2 * (k % 2))
        }
    };
    (0..=steps)
        .map(|k| weight(k) * f(from + width * f64::from(k)))
        .sum::<f64>()
        * width
        / 3.0
}
