//! The spectrum of largest penalised likelihood (Whittle). The powers of waves are exponentially
//! distributed about their means.
//!
//! The sum Σ w (P/m + ln m) + λ Σ (x_{i−1} − 2x_i + x_{i+1})² is minimised over the values x = ln
//! C2D at the nodes. P are the observed powers of w waves each, and m(x) their means. Steps follow
//! Fisher's scoring and are halved until the sum falls.
//!
//! In the self-affine fit C2D is constant below a roll-off wave number and ∝ q^(−2−2H) above.

use super::isotropic::{End, IsotropicSpectrum, Nodes, Term, ValueWithError, cut};
use super::observation::Observation;
use asperity_data::Cholesky;
use std::f64::consts::TAU;

/// Weight λ of the squared second differences.
const SMOOTHNESS: f64 = 1.0;

const NODES_PER_DECADE: f64 = 6.0;

/// Largest number of steps, and the decrease of the objective below which the search ends.
const MOST_STEPS: usize = 200;
const SMALL_DECREASE: f64 = 1e-9;

const LARGEST_STEP: f64 = 1.5;

/// Observed powers, with the terms that give their means from a spectrum.
pub(super) struct Model<'a> {
    pub observations: &'a [Observation],
    pub terms: Vec<Vec<Term>>,
    pub nodes: Nodes,
}

impl<'a> Model<'a> {
    /// Creates a model with nodes over the range of wave numbers of the observations in rad/m.
    pub fn new(observations: &'a [Observation], [low, high]: [f64; 2], end: End) -> Self {
        let nodes = Nodes::new(low, high, NODES_PER_DECADE, end);
        let terms = observations
            .iter()
            .map(|observation| observation.terms(&nodes))
            .collect();
        Model {
            observations,
            terms,
            nodes,
        }
    }

    /// Computes the objective without the penalty, for given means of the powers.
    pub fn misfit(&self, means: impl Iterator<Item = f64>) -> f64 {
        let each = self.observations.iter().zip(means);
        each.map(|(observed, mean)| observed.waves * (observed.power / mean + mean.ln()))
            .sum()
    }

    /// Returns the means of the observed powers for these values of ln C2D at the nodes.
    pub fn means<'b>(&'b self, values: &'b [f64]) -> impl Iterator<Item = f64> + 'b {
        self.terms
            .iter()
            .map(|terms| terms.iter().map(|term| term.value(values)).sum::<f64>())
    }

    fn objective(&self, values: &[f64]) -> f64 {
        let rough: f64 = values
            .windows(3)
            .map(|x| (x[0] - 2.0 * x[1] + x[2]).powi(2))
            .sum();
        self.misfit(self.means(values)) + SMOOTHNESS * rough
    }

    /// Computes the gradient and the information matrix of the objective at these values.
    fn linearise(&self, values: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let count = values.len();
        let (mut gradient, mut information) = (vec![0.0; count], vec![0.0; count * count]);
        let mut slope = vec![0.0; count];
        for (observed, terms) in self.observations.iter().zip(&self.terms) {
            slope.fill(0.0);
            let mut mean = 0.0;
            for term in terms {
                let value = term.value(values);
                mean += value;
                slope[term.index] += (1.0 - term.share) * value;
                slope[term.index + 1] += term.share * value;
            }
            slope.iter_mut().for_each(|slope| *slope /= mean);
            let residual = observed.waves * (1.0 - observed.power / mean);
            for row in 0..count {
                gradient[row] += residual * slope[row];
                for column in 0..=row {
                    information[row * count + column] +=
                        observed.waves * slope[row] * slope[column];
                }
            }
        }
        for (first, x) in values.windows(3).enumerate() {
            let difference = x[0] - 2.0 * x[1] + x[2];
            for (row, a) in [1.0, -2.0, 1.0].into_iter().enumerate() {
                gradient[first + row] += 2.0 * SMOOTHNESS * a * difference;
                for (column, b) in [1.0, -2.0, 1.0].into_iter().enumerate().take(row + 1) {
                    information[(first + row) * count + first + column] += 2.0 * SMOOTHNESS * a * b;
                }
            }
        }
        (gradient, information)
    }

    /// Returns the initial values: C2D from the powers as if it were a power law with the exponent
    /// −3, constant outside the observations.
    fn start(&self) -> Vec<f64> {
        let count = self.nodes.count;
        let mut sums = vec![(0.0, 0.0); count];
        for (observed, terms) in self.observations.iter().zip(&self.terms) {
            // The mean of a spectrum of ones is the normalisation.
            let ln_q = observed.wave_number.ln();
            let weights = terms
                .iter()
                .map(|term| term.weight * ((ln_q - term.ln_q) * 3.0).exp());
            let weight: f64 = weights.sum();
            if observed.power > 0.0 && weight > 0.0 {
                let (index, share) = self.nodes.place(ln_q);
                let nearest = if share < 0.5 {
                    index
                } else {
                    (index + 1).min(count - 1)
                };
                sums[nearest].0 += observed.waves * (observed.power / weight).ln();
                sums[nearest].1 += observed.waves;
            }
        }
        let known = (0..count).filter(|index| sums[*index].1 > 0.0);
        let known: Vec<_> = known
            .map(|index| (index, sums[index].0 / sums[index].1))
            .collect();
        let between = |index: usize| {
            let after = known.iter().find(|(place, _)| *place >= index);
            let before = known.iter().rev().find(|(place, _)| *place <= index);
            match (before, after) {
                (Some((i, a)), Some((j, b))) if i < j => {
                    a + (b - a) * (index - i) as f64 / (j - i) as f64
                }
                (Some((_, value)), _) | (None, Some((_, value))) => *value,
                (None, None) => 0.0,
            }
        };
        (0..count).map(between).collect()
    }

    /// Finds the spectrum of the smallest objective. `None` if the information matrix is not
    /// positive definite, as for powers that are zero or not finite.
    pub fn fit(&self) -> Option<IsotropicSpectrum> {
        let moved = |values: &Vec<f64>, step: &[f64], share: f64| {
            let largest = step
                .iter()
                .fold(0.0_f64, |largest, change| largest.max(change.abs()));
            let limited = share * (LARGEST_STEP / largest).min(1.0);
            values
                .iter()
                .zip(step)
                .map(|(x, change)| x - limited * change)
                .collect()
        };
        let objective = |values: &Vec<f64>| self.objective(values);
        let linearise = |values: &Vec<f64>| self.linearise(values);
        let (values, _) = descend(self.start(), MOST_STEPS, objective, linearise, moved)?;
        let (_, information) = self.linearise(&values);
        let information = Cholesky::new(information, values.len())?;
        let mut found = IsotropicSpectrum {
            nodes: self.nodes,
            values,
            information,
            method: [0.0; 3],
            missing: [0.0; 3],
        };
        found.method = self.departure(&found);
        Some(found)
    }

    /// Compares the moments of the measured powers with the moments of the fitted means over the
    /// same waves. Returns the largest difference among profiles and maps of one kind, relative to
    /// the moments of the whole spectrum. With several kinds, only the excess over chance counts.
    fn departure(&self, found: &IsotropicSpectrum) -> [f64; 3] {
        let mut largest = [0.0_f64; 3];
        let mut means = self.means(&found.values);
        let kinds: Vec<_> = self
            .observations
            .chunk_by(|one, next| one.kind == next.kind)
            .collect();
        for kind in &kinds {
            let (mut sums, mut variances) = ([0.0; 3], [0.0; 3]);
            for (observed, mean) in kind.iter().zip(&mut means) {
                let (differences, scatter) = (
                    observed.moments(observed.power - mean),
                    observed.moments(mean),
                );
                for index in 0..3 {
                    sums[index] += differences[index];
                    variances[index] += scatter[index].powi(2) / observed.waves;
                }
            }
            for ((largest, sum), variance) in largest.iter_mut().zip(sums).zip(variances) {
                // Scans that share a spectrum depart from it by chance, which is in the statistical
                // error.
                let chance = if kinds.len() > 1 {
                    2.0 * f64::sqrt(variance)
                } else {
                    0.0
                };
                *largest = largest.max(sum.abs() - chance);
            }
        }
        let whole = found.integrals();
        [0, 1, 2].map(|index| TAU * largest[index] / whole[index])
    }
}

/// Minimises an objective by Fisher's scoring. Steps solve the linearised equations (gradient,
/// information matrix) and are halved until the objective falls. `moved` makes a share of a step.
/// `None` if an information matrix is not positive definite.
pub(super) fn descend<P>(
    start: P,
    most_steps: usize,
    objective: impl Fn(&P) -> f64,
    linearise: impl Fn(&P) -> (Vec<f64>, Vec<f64>),
    moved: impl Fn(&P, &[f64], f64) -> P,
) -> Option<(P, f64)> {
    let mut least = objective(&start);
    let mut parameters = start;
    for _ in 0..most_steps {
        let (gradient, information) = linearise(&parameters);
        let step = Cholesky::new(information, gradient.len())?.solve(gradient);
        let shares = (0..30).map(|halvings| moved(&parameters, &step, 0.5_f64.powi(halvings)));
        let lower = shares
            .map(|next| (objective(&next), next))
            .find(|(found, _)| *found < least);
        let Some((found, next)) = lower else { break };
        let decrease = least - found;
        (parameters, least) = (next, found);
        if decrease <= SMALL_DECREASE * least.abs().max(1.0) {
            break;
        }
    }
    least.is_finite().then_some((parameters, least))
}

/// Gain of the log-likelihood that justifies a roll-off. With one more parameter, chance exceeds
/// this gain once in a hundred times.
const LEAST_GAIN: f64 = 3.3;

/// Number of initial roll-off wave numbers per decade.
const STARTS_PER_DECADE: f64 = 4.0;

/// Number of steps from each initial wave number, and then from the best result.
const FEW_STEPS: usize = 6;
const MOST_SEARCHED: usize = 60;

const HURST: [f64; 2] = [-0.5, 1.5];

/// Self-affine spectrum fitted to the powers of measured waves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SelfAffineFit {
    /// Hurst exponent H.
    pub hurst: ValueWithError,
    /// Roll-off wave number in rad/m; `None` if the fitted spectrum has no roll-off.
    pub roll_off: Option<ValueWithError>,
    /// Two-dimensional spectral density C2D in m⁴ at the roll-off wave number. If there is no
    /// roll-off, it is C2D at the first wave number of the fit.
    pub level: ValueWithError,
}

impl SelfAffineFit {
    /// Returns the power spectral density in m³ of a cut, a profile across the surface, at a wave
    /// number. `first` and `last` are the wave numbers between which the surface has the spectrum.
    /// All wave numbers are in rad/m.
    pub fn cut(&self, wave_number: f64, [first, last]: [f64; 2]) -> f64 {
        let corner = self.roll_off.map_or(first, |roll_off| roll_off.value);
        let (level, exponent) = (self.level.value, -2.0 - 2.0 * self.hurst.value);
        cut(
            |q| level * (q / corner).max(1.0).powf(exponent),
            wave_number,
            last,
        )
    }
}

/// Parameters of the self-affine fit: ln C2D at the roll-off, H, ln q of the roll-off.
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
        let limited = |index: usize, most: f64| {
            step.get(index)
                .map_or(0.0, |step| (share * step).clamp(-most, most))
        };
        Parameters {
            level: self.level - limited(0, 3.0),
            hurst: (self.hurst - limited(1, 0.3)).clamp(HURST[0], HURST[1]),
            roll_off: (self.roll_off - limited(2, 0.7)).clamp(low, high),
        }
    }
}

/// Fits a self-affine spectrum to the observations of a model. `spectrum` is the fit with nodes to
/// the same observations. `None` if the fit does not converge or no exponent between 0 and 1 fits.
pub(super) fn fit_power_law(
    model: &Model<'_>,
    spectrum: &IsotropicSpectrum,
) -> Option<SelfAffineFit> {
    let low = model.nodes.first;
    let high = low + model.nodes.step * (model.nodes.count - 1) as f64;
    // Above a third of the range no exponent could be determined.
    let bounds = [low, low + 0.67 * (high - low)];
    let count = (STARTS_PER_DECADE * (bounds[1] - low) / std::f64::consts::LN_10)
        .ceil()
        .max(1.0);
    let without = search(model, start(model, low), 2, bounds, MOST_SEARCHED)?;
    let mut best: Option<(Parameters, f64)> = None;
    for index in 1..=count as usize {
        let roll_off = low + (bounds[1] - low) * index as f64 / count;
        // Level and exponent first, then all three.
        let near = search(model, start(model, roll_off), 2, bounds, FEW_STEPS);
        let found = near.and_then(|(near, _)| search(model, near, 3, bounds, FEW_STEPS));
        best = best
            .into_iter()
            .chain(found)
            .reduce(|best, found| if found.1 < best.1 { found } else { best });
    }
    let best = best.and_then(|(parameters, _)| search(model, parameters, 3, bounds, MOST_SEARCHED));
    let with_roll_off = best.map_or(without.0.hurst, |(parameters, _)| parameters.hurst);
    let found = best.filter(|(_, misfit)| without.1 - misfit > LEAST_GAIN);
    let ((parameters, misfit), free) = found.map_or((without, 2), |found| (found, 3));
    // Of a self-affine surface twice the difference has as its mean the number of further
    // parameters of the spectrum.
    let excess = 2.0 * (misfit - model.misfit(model.means(&spectrum.values)));
    let scale = (excess / (spectrum.values.len() - free) as f64)
        .max(1.0)
        .sqrt();
    let (_, information) = linearise(model, &parameters, free);
    let information = Cholesky::new(information, free)?;
    let error = |index: usize| scale * information.standard_error(index);
    let exponential = |value: f64, error: f64| ValueWithError {
        value: value.exp(),
        error: value.exp() * error,
    };
    (0.0 < parameters.hurst && parameters.hurst < 1.0).then(|| SelfAffineFit {
        // A roll-off may be there even though chance could show it.
        hurst: ValueWithError {
            value: parameters.hurst,
            error: error(1).hypot(with_roll_off - parameters.hurst),
        },
        roll_off: (free == 3).then(|| exponential(parameters.roll_off, error(2))),
        level: exponential(parameters.level, error(0)),
    })
}

fn start(model: &Model<'_>, roll_off: f64) -> Parameters {
    let mut parameters = Parameters {
        level: 0.0,
        hurst: 0.7,
        roll_off,
    };
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
    model.terms.iter().map(|terms| {
        terms
            .iter()
            .map(|term| term.weight * parameters.value(term.ln_q))
            .sum()
    })
}

/// Minimises the misfit over the first `free` parameters, from initial values.
fn search(
    model: &Model<'_>,
    start: Parameters,
    free: usize,
    bounds: [f64; 2],
    most_steps: usize,
) -> Option<(Parameters, f64)> {
    let misfit = |parameters: &Parameters| model.misfit(means(model, parameters));
    let linearise = |parameters: &Parameters| linearise(model, parameters, free);
    let moved =
        |parameters: &Parameters, step: &[f64], share: f64| parameters.moved(step, share, bounds);
    descend(start, most_steps, misfit, linearise, moved)
}

/// Computes the gradient and the information matrix of the misfit with respect to the first `free`
/// parameters.
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
            slope[2] += if above > 0.0 {
                parameters.exponent() * value
            } else {
                0.0
            };
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
