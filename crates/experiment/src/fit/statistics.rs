//! Statistics of samples and of residuals (measured minus computed forces).

use crate::curve::numerics::dot;
use asperity_data::{mean, quantile, standard_deviation};

/// Number of parts into which the points in contact of each segment are divided. These parts are
/// the blocks of the curve.
pub(crate) const PARTS: usize = 4;

/// Returns a robust root mean square of residuals, called the scale. A residual above `cut` times
/// the scale is replaced by `cut` times the scale (Huber, Robust Statistics, proposal 2). Single
/// points on the wrong side of a jump therefore have little influence.
pub(crate) fn scale(residuals: &[f64], cut: f64) -> f64 {
    let mut squares: Vec<f64> = residuals
        .iter()
        .map(|residual| residual * residual)
        .collect();
    squares.sort_by(f64::total_cmp);
    let mut sum: f64 = squares.iter().sum();
    let mut count = squares.len() as f64;
    while let Some(largest) = squares.pop() {
        let is_beyond = count > cut * cut && largest * count > cut * cut * sum;
        if !is_beyond {
            break;
        }
        // If n of all residuals are beyond the limit and `sum` is the sum of the squares of the
        // others, the scale solves (sum + n · cut² · scale²)/total = scale². So each residual
        // beyond the limit reduces the divisor of `sum` by cut².
        sum = squares.iter().sum();
        count -= cut * cut;
    }
    (sum / count).sqrt()
}

/// Returns the standard error of a value that follows from a curve, computed from the scatter of
/// the value over blocks of the curve (infinitesimal jackknife; Giordano and Broderick, arXiv
/// 2305.06466). `values` are the values of the samples, and `blocks` has the cost of each sample in
/// each block. This error is needed if a model does not describe a curve: the residuals are then
/// not independent noise, and each block alone would give another value. The error is also computed
/// for several neighbouring blocks joined, up to whole segments, and the largest error is returned.
pub(crate) fn block_error(values: &[f64], blocks: &[Vec<f64>]) -> f64 {
    let count = values.len() as f64;
    let average = mean(values);
    let block_count = blocks.first().map_or(0, Vec::len);
    let mut influences = Vec::with_capacity(block_count);
    for block in 0..block_count {
        let sum: f64 = values
            .iter()
            .zip(blocks)
            .map(|(value, costs)| (value - average) * costs[block])
            .sum();
        influences.push(sum / count);
    }
    let mut largest = 0.0_f64;
    for joined in [1, 2, PARTS] {
        largest = largest.max(error_of_joined(&influences, joined));
    }
    largest
}

/// Returns the standard error from the influences of blocks, with `joined` neighbouring blocks
/// taken together.
fn error_of_joined(influences: &[f64], joined: usize) -> f64 {
    let sums: Vec<f64> = influences
        .chunks(joined)
        .map(|part| part.iter().sum())
        .collect();
    let average = mean(&sums);
    let squares: f64 = sums.iter().map(|sum| (sum - average).powi(2)).sum();
    squares.sqrt()
}

fn column(samples: &[Vec<f64>], index: usize) -> Vec<f64> {
    samples.iter().map(|sample| sample[index]).collect()
}

/// Multiplies the deviation of each sample from the mean of the samples by a factor.
pub(crate) fn widen(samples: &mut [Vec<f64>], factor: f64) {
    for index in 0..samples.first().map_or(0, Vec::len) {
        let mean = mean(&column(samples, index));
        for sample in samples.iter_mut() {
            sample[index] = mean + factor * (sample[index] - mean);
        }
    }
}

/// Spread of the values of a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Spread {
    pub standard_deviation: f64,
    /// Ends of the 95 % interval: the quantiles of the values at 2.5 % and 97.5 %.
    pub interval: (f64, f64),
}

impl Spread {
    /// Returns the spread of a single value, which is zero.
    pub(crate) fn at(value: f64) -> Self {
        Spread {
            standard_deviation: 0.0,
            interval: (value, value),
        }
    }
}

/// Returns the spread of values; `None` for fewer than two values.
pub(crate) fn spread(mut values: Vec<f64>) -> Option<Spread> {
    if values.len() < 2 {
        return None;
    }
    values.sort_by(f64::total_cmp);
    let low = quantile(&values, 0.025)?;
    let high = quantile(&values, 0.975)?;
    Some(Spread {
        standard_deviation: standard_deviation(&values, mean(&values)),
        interval: (low, high),
    })
}

/// Returns the correlation of two coordinates over samples; 0 if one of them does not vary.
pub(crate) fn correlation(samples: &[Vec<f64>], pair: [usize; 2]) -> f64 {
    let [first, second] = pair.map(|index| deviations(column(samples, index)));
    let squares = dot(&first, &first) * dot(&second, &second);
    if squares > 0.0 {
        dot(&first, &second) / squares.sqrt()
    } else {
        0.0
    }
}

fn deviations(mut values: Vec<f64>) -> Vec<f64> {
    let mean = mean(&values);
    for value in &mut values {
        *value -= mean;
    }
    values
}

#[cfg(test)]
mod tests {
    use super::*;

    fn is_close(found: f64, expected: f64) -> bool {
        (found - expected).abs() < 1e-12 * expected.abs()
    }

    #[test]
    fn single_residuals_beyond_the_scale_count_little() {
        // 98 residuals are 1, and two are replaced by 5 times the scale: scale² = (98 + 2 · 25
        // scale²)/100.
        let mut residuals = vec![1.0; 98];
        residuals.extend([-1000.0, 1e12]);
        assert!(is_close(scale(&residuals, 5.0), (98.0_f64 / 50.0).sqrt()));
        // If all residuals are large, the scale is as large, and no residual is replaced.
        assert!(is_close(scale(&[350.0, -350.0, 350.0], 5.0), 350.0));
        assert!(is_close(scale(&[3.0, 4.0, 0.0, 0.0], 5.0), 2.5));
        assert_eq!(scale(&[0.0; 30], 5.0), 0.0);
    }

    #[test]
    fn the_error_by_blocks_is_that_of_their_influence() {
        // The values are ±1, and the costs change with them by the slopes ±2, so the influences of
        // the 8 blocks are alternately 2 and −2.
        let values: Vec<f64> = (0..64).map(|index| [-1.0, 1.0][index % 2]).collect();
        let costs = |slope: &dyn Fn(usize) -> f64| -> Vec<Vec<f64>> {
            values
                .iter()
                .map(|value| (0..8).map(|block| 7.0 + value * slope(block)).collect())
                .collect()
        };
        let alternating = block_error(&values, &costs(&|block| [2.0, -2.0][block % 2]));
        assert!(is_close(alternating, 32.0_f64.sqrt()), "{alternating}");
        // Approach and retraction differ: if the blocks are joined to two segments, their
        // influences are 8 and −8.
        let branches = block_error(&values, &costs(&|block| if block < 4 { 2.0 } else { -2.0 }));
        assert!(is_close(branches, 128.0_f64.sqrt()), "{branches}");
        // A single block has no scatter. An influence that is equal in all blocks, as for a
        // population beside the minimum, is no scatter either.
        let error = block_error(&values, &costs(&|_| 2.0));
        assert!(error.abs() < 1e-9, "{error}");
        assert_eq!(
            (
                block_error(&values, &[]),
                block_error(&[1.0, 2.0], &[vec![1.0], vec![3.0]])
            ),
            (0.0, 0.0)
        );
    }

    #[test]
    fn samples_have_deviation_quantiles_and_correlation() {
        let values: Vec<f64> = (0..=200).rev().map(f64::from).collect();
        let found = spread(values.clone()).unwrap();
        assert!(
            is_close(found.standard_deviation, (201.0_f64 * 202.0 / 12.0).sqrt()),
            "{found:?}"
        );
        assert_eq!(found.interval, (5.0, 195.0));
        assert_eq!((spread(Vec::new()), spread(vec![1.0])), (None, None));
        let mut samples: Vec<Vec<f64>> = values
            .iter()
            .map(|value| vec![*value, 3.0 - 2.0 * value, 5.0])
            .collect();
        assert!(is_close(correlation(&samples, [0, 1]), -1.0));
        assert_eq!(correlation(&samples, [0, 2]), 0.0);
        widen(&mut samples, 2.0);
        assert_eq!(
            (samples[0][0], samples[200][0], samples[9][2]),
            (300.0, -100.0, 5.0)
        );
    }
}
