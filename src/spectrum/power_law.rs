//! Self-affine fit: C2D constant below a roll-off wave number, ∝ q^(−2−2H) above.

use super::fit::{Model, descend};
use super::isotropic::{Estimate, IsotropicSpectrum, cut};
use super::linear::Cholesky;

/// Least gain of the log-likelihood for a roll-off: for one more parameter, chance exceeds this once in a hundred
/// times.
const LEAST_GAIN: f64 = 3.3;

/// Initial wave numbers of the roll-off per decade.
const STARTS_PER_DECADE: f64 = 4.0;

/// Steps from each start, and from the best one.
const FEW_STEPS: usize = 6;
const MOST_STEPS: usize = 60;

const HURST: [f64; 2] = [-0.5, 1.5];

/// Self-affine spectrum fitted to observed powers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PowerLaw {
    /// Hurst exponent H.
    pub hurst: Estimate,
    /// Roll-off wave number, rad/m; `None` without a roll-off.
    pub roll_off: Option<Estimate>,
    /// C2D at the roll-off, or at the first wave number without one, m⁴.
    pub level: Estimate,
}

impl PowerLaw {
    /// PSD of a cut, m³, at a wave number, for a spectrum over a range of wave numbers, rad/m.
    pub(crate) fn cut(&self, wave_number: f64, [first, last]: [f64; 2]) -> f64 {
        let corner = self.roll_off.map_or(first, |roll_off| roll_off.value);
        let (level, exponent) = (self.level.value, -2.0 - 2.0 * self.hurst.value);
        cut(|q| level * (q / corner).max(1.0).powf(exponent), wave_number, last)
    }
}

/// Parameters: ln C2D of the level, H, ln q of the roll-off.
#[derive(Clone, Copy, Debug)]
struct Parameters {
    level: f64,
    hurst: f64,
    roll_off: f64,
}

impl Parameters {
    fn value(&self, ln_q: f64) -> f64 {
        (self.level - self.exponent() * (ln_q - self.roll_off).max(0.0)).exp()
    }

    fn exponent(&self) -> f64 {
        2.0 + 2.0 * self.hurst
    }

    fn moved(&self, step: &[f64], share: f64, [low, high]: [f64; 2]) -> Parameters {
        let limited =
            |index: usize, most: f64| step.get(index).map_or(0.0, |step| (share * step).clamp(-most, most));
        Parameters {
            level: self.level - limited(0, 3.0),
            hurst: (self.hurst - limited(1, 0.3)).clamp(HURST[0], HURST[1]),
            roll_off: (self.roll_off - limited(2, 0.7)).clamp(low, high),
        }
    }
}

/// Fit to the observations of a model, which the spectrum explains; `None` if it does not converge or no exponent between 0
/// and 1 fits.
pub(super) fn fit(model: &Model<'_>, spectrum: &IsotropicSpectrum) -> Option<PowerLaw> {
    let low = model.nodes.first;
    let high = low + model.nodes.step * (model.nodes.count - 1) as f64;
    // Above a third of the range no exponent could be determined.
    let bounds = [low, low + 0.67 * (high - low)];
    let count = (STARTS_PER_DECADE * (bounds[1] - low) / std::f64::consts::LN_10).ceil().max(1.0);
    let without = search(model, start(model, low), 2, bounds, MOST_STEPS)?;
    let mut best: Option<(Parameters, f64)> = None;
    for index in 1..=count as usize {
        let roll_off = low + (bounds[1] - low) * index as f64 / count;
        // Level and exponent first, then all three.
        let near = search(model, start(model, roll_off), 2, bounds, FEW_STEPS);
        let found = near.and_then(|(near, _)| search(model, near, 3, bounds, FEW_STEPS));
        best =
            best.into_iter().chain(found).reduce(|best, found| if found.1 < best.1 { found } else { best });
    }
    let best = best.and_then(|(parameters, _)| search(model, parameters, 3, bounds, MOST_STEPS));
    let with_roll_off = best.map_or(without.0.hurst, |(parameters, _)| parameters.hurst);
    let found = best.filter(|(_, misfit)| without.1 - misfit > LEAST_GAIN);
    let ((parameters, misfit), free) = found.map_or((without, 2), |found| (found, 3));
    // Of a self-affine surface twice the difference has as its mean the number of further parameters of the spectrum.
    let excess = 2.0 * (misfit - model.misfit(model.means(&spectrum.values)));
    let scale = (excess / (spectrum.values.len() - free) as f64).max(1.0).sqrt();
    let (_, information) = linearise(model, &parameters, free);
    let information = Cholesky::new(information, free)?;
    let error = |index: usize| scale * information.standard_error(index);
    let exponential = |value: f64, error: f64| Estimate { value: value.exp(), error: value.exp() * error };
    (0.0 < parameters.hurst && parameters.hurst < 1.0).then(|| PowerLaw {
        // A roll-off may be there even though chance could show it.
        hurst: Estimate { value: parameters.hurst, error: error(1).hypot(with_roll_off - parameters.hurst) },
        roll_off: (free == 3).then(|| exponential(parameters.roll_off, error(2))),
        level: exponential(parameters.level, error(0)),
    })
}

fn start(model: &Model<'_>, roll_off: f64) -> Parameters {
    let mut parameters = Parameters { level: 0.0, hurst: 0.7, roll_off };
    let (mut sum, mut waves) = (0.0, 0.0);
    for (observed, mean) in model.observations.iter().zip(means(model, &parameters)) {
        if observed.power > 0.0 && mean > 0.0 {
            sum += observed.waves * (observed.power / mean).ln();
            waves += observed.waves;
        }
    }
    parameters.level = sum / waves.max(1.0);
    parameters
}

fn means<'a>(model: &'a Model<'_>, parameters: &'a Parameters) -> impl Iterator<Item = f64> + 'a {
    model.terms.iter().map(|terms| terms.iter().map(|term| term.weight * parameters.value(term.ln_q)).sum())
}

/// Descends over the first `free` parameters from a start.
fn search(
    model: &Model<'_>,
    start: Parameters,
    free: usize,
    bounds: [f64; 2],
    most_steps: usize,
) -> Option<(Parameters, f64)> {
    let misfit = |parameters: &Parameters| model.misfit(means(model, parameters));
    let linearise = |parameters: &Parameters| linearise(model, parameters, free);
    let moved = |parameters: &Parameters, step: &[f64], share: f64| parameters.moved(step, share, bounds);
    descend(start, most_steps, misfit, linearise, moved)
}

/// Gradient and information matrix of the misfit by the first `free` parameters.
fn linearise(model: &Model<'_>, parameters: &Parameters, free: usize) -> (Vec<f64>, Vec<f64>) {
    let (mut gradient, mut information) = (vec![0.0; free], vec![0.0; free * free]);
    for (observed, terms) in model.observations.iter().zip(&model.terms) {
        let (mut mean, mut slope) = (0.0, [0.0; 3]);
        for term in terms {
            let value = term.weight * parameters.value(term.ln_q);
            let above = (term.ln_q - parameters.roll_off).max(0.0);
            mean += value;
            slope[0] += value;
            slope[1] -= 2.0 * above * value;
            slope[2] += if above > 0.0 { parameters.exponent() * value } else { 0.0 };
        }
        let residual = observed.waves * (1.0 - observed.power / mean);
        for row in 0..free {
            gradient[row] += residual * slope[row] / mean;
            for column in 0..=row {
                information[row * free + column] +=
                    observed.waves * slope[row] * slope[column] / (mean * mean);
            }
        }
    }
    (gradient, information)
}
