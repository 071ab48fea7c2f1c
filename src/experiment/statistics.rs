//! Statistics of samples and residuals.

use super::baseline::dot;

/// Fewest ranges without correlation in a curve.
const RANGES: usize = 20;

/// Factor of the variance of a mean of residuals by their correlation along the curve: 1 without one.
pub(super) fn correlated(residuals: &[f64]) -> f64 {
    let square = dot(residuals, residuals);
    let least = 2.0 / (residuals.len() as f64).sqrt();
    let correlations = (1..residuals.len() / RANGES).map(|lag| dot(residuals, &residuals[lag..]) / square);
    1.0 + 2.0 * correlations.take_while(|correlation| *correlation > least).sum::<f64>()
}

/// Multiplies the deviations of samples from their mean by a factor.
pub(super) fn widen(samples: &mut [Vec<f64>], factor: f64) {
    let count = samples.len() as f64;
    for index in 0..samples.first().map_or(0, Vec::len) {
        let mean = samples.iter().map(|sample| sample[index]).sum::<f64>() / count;
        samples.iter_mut().for_each(|sample| sample[index] = mean + factor * (sample[index] - mean));
    }
}

/// Standard deviation, and 2.5 % and 97.5 % quantiles.
pub(super) fn spread(mut values: Vec<f64>) -> (f64, (f64, f64)) {
    values.sort_by(f64::total_cmp);
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let deviation = (values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / (count - 1.0)).sqrt();
    let quantile = |share: f64| values[((share * count) as usize).min(values.len() - 1)];
    (deviation, (quantile(0.025), quantile(0.975)))
}

/// Correlation of two coordinates over samples, 0 of one that does not vary.
pub(super) fn correlation(samples: &[Vec<f64>], pair: [usize; 2]) -> f64 {
    let [one, other] = pair.map(|index| {
        let mean = samples.iter().map(|sample| sample[index]).sum::<f64>() / samples.len() as f64;
        samples.iter().map(|sample| sample[index] - mean).collect::<Vec<f64>>()
    });
    let squares = dot(&one, &one) * dot(&other, &other);
    if squares > 0.0 { dot(&one, &other) / squares.sqrt() } else { 0.0 }
}
