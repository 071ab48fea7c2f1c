//! Errors of fitted coordinates: a bootstrap of blocks of the residuals through the linearised fit.

use super::MeasuredCurve;
use super::baseline::{Line, dot};
use super::search::Linear;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

const DRAWS: usize = 1000;
const SEED: u64 = 29;
/// Fewest points of a block, and fewest blocks in a curve.
const FEWEST: usize = 5;
const BLOCKS: usize = 20;

/// Changes of the coordinates in each draw. The zero of the force, and a removed drift, are estimated anew in each draw,
/// since their errors are those of all points.
pub(super) fn draws(linear: &Linear, curve: &MeasuredCurve) -> Vec<Vec<f64>> {
    let Linear { residuals, derivatives, information } = linear;
    let (count, block) = (residuals.len(), block_length(residuals));
    let middle = 0.5 * (curve.free - 1) as f64;
    let mut generator = ChaCha8Rng::seed_from_u64(SEED);
    let mut drawn = Vec::with_capacity(count + block);
    let draw = |_| {
        drawn.clear();
        while drawn.len() < count {
            let start = generator.random_range(0..count);
            drawn.extend((start..start + block).map(|index| residuals[index % count]));
        }
        let line = Line::through(&drawn[..curve.free]);
        let zero = if curve.is_estimated[0] { line.mean } else { 0.0 };
        let slope = if curve.is_estimated[1] { line.slope } else { 0.0 };
        let rest = |index: usize| drawn[index] - zero - slope * (index as f64 - middle);
        let rests: Vec<f64> = (0..count).map(rest).collect();
        information.solve(derivatives.iter().map(|column| dot(column, &rests)).collect())
    };
    (0..DRAWS).map(draw).collect()
}

/// Length of a block: several times that over which residuals are correlated.
fn block_length(residuals: &[f64]) -> usize {
    let most = (residuals.len() / BLOCKS).max(1);
    let noise = 2.0 / (residuals.len() as f64).sqrt() * dot(residuals, residuals);
    let correlated = (1..most).take_while(|&lag| dot(residuals, &residuals[lag..]) > noise).count();
    (4 * (1 + correlated)).max(FEWEST).min(most)
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

/// Correlation of two coordinates over draws, 0 of one that does not vary.
pub(super) fn correlation(draws: &[Vec<f64>], pair: [usize; 2]) -> f64 {
    let [one, other] = pair.map(|index| {
        let mean = draws.iter().map(|draw| draw[index]).sum::<f64>() / draws.len() as f64;
        draws.iter().map(|draw| draw[index] - mean).collect::<Vec<f64>>()
    });
    let squares = dot(&one, &one) * dot(&other, &other);
    if squares > 0.0 { dot(&one, &other) / squares.sqrt() } else { 0.0 }
}
