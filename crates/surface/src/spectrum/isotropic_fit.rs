//! The isotropic spectrum of largest penalised likelihood. The spectrum is given at several wave
//! numbers, the nodes.
//!
//! The fit finds the values x_i = ln C2D at the nodes that minimise Σ w (P/m + ln m) + λ Σ (x_{i−1}
//! − 2x_i + x_{i+1})². The first sum runs over the observations: P is the observed mean power of w
//! waves, and m is the mean power that the values x_i predict. The second sum makes the spectrum
//! smooth.

use super::exact::match_moments;
use super::isotropic::IsotropicSpectrum;
use super::likelihood::{Model, misfit};
use super::observation::Observation;
use super::parts::student_factor;
use super::scoring::{Linearised, Objective, descend};
use std::f64::consts::TAU;

/// Weight λ of the sum of squared second differences of ln C2D, which makes the spectrum smooth.
const SMOOTHNESS: f64 = 1.0;

/// Weights of three neighbouring values in a second difference.
const SECOND_DIFFERENCE: [f64; 3] = [1.0, -2.0, 1.0];

/// Largest number of steps of the search.
const MOST_STEPS: usize = 200;

/// Largest change of ln C2D at a node in one step of the search.
const LARGEST_STEP: f64 = 1.5;

/// Largest difference, in standard errors, that counts as chance. Chance exceeds it once in a few
/// hundred times.
const LEAST_DEVIATIONS: f64 = 3.0;

/// Exponent 3 of the power law q^(−3). The initial values are computed as if the spectrum followed
/// this law near each observation.
const INITIAL_EXPONENT: f64 = 3.0;

/// Finds the isotropic spectrum of largest penalised likelihood. If `periodic_scans` is given, the
/// moments of the spectrum, such as its mean square height, are then made equal to those of the
/// observed powers ([`match_moments`]). `periodic_scans` is the number of periodic surfaces whose
/// waves are observed one by one. Returns `None` if the information matrix is not positive
/// definite, which happens for powers that are zero or not finite.
pub(super) fn fit_isotropic(
    model: &Model<'_>,
    periodic_scans: Option<f64>,
) -> Option<IsotropicSpectrum> {
    let likelihood = PenalisedLikelihood { model };
    let values = descend(&likelihood, initial_values(model), MOST_STEPS)?.parameters;
    let information = likelihood.linearise(&values).factor()?;
    let mut departure = departure(model, &values);
    let mut spectrum = IsotropicSpectrum {
        nodes: model.nodes,
        values,
        information,
        method: [0.0; 3],
        missing: [0.0; 3],
        ratio_of_kinds: departure.ratio_of_kinds,
    };
    if let Some(scans) = periodic_scans {
        departure.moments = match_moments(model, &mut spectrum, scans);
    }
    let integrals = spectrum.integrals();
    spectrum.method = [0, 1, 2].map(|index| TAU * departure.moments[index] / integrals[index]);
    Some(spectrum)
}

/// The penalised negative log-likelihood, as a function of the values of ln C2D at the nodes.
struct PenalisedLikelihood<'a> {
    model: &'a Model<'a>,
}

impl Objective for PenalisedLikelihood<'_> {
    type Parameters = Vec<f64>;

    fn value(&self, values: &Vec<f64>) -> f64 {
        let roughness: f64 = values
            .windows(3)
            .map(|x| (x[0] - 2.0 * x[1] + x[2]).powi(2))
            .sum();
        let means = self.model.means(values);
        misfit(self.model.observations, means) + SMOOTHNESS * roughness
    }

    fn linearise(&self, values: &Vec<f64>) -> Linearised {
        let mut linearised = Linearised::zeros(values.len());
        add_likelihood(self.model, values, &mut linearised);
        add_penalty(values, &mut linearised);
        linearised
    }

    fn moved(&self, values: &Vec<f64>, step: &[f64], share: f64) -> Vec<f64> {
        let largest = step
            .iter()
            .fold(0.0_f64, |largest, change| largest.max(change.abs()));
        let limited = share * (LARGEST_STEP / largest).min(1.0);
        values
            .iter()
            .zip(step)
            .map(|(x, change)| x - limited * change)
            .collect()
    }
}

fn add_likelihood(model: &Model<'_>, values: &[f64], linearised: &mut Linearised) {
    let count = values.len();
    // Derivatives of the logarithm of an expected mean power with respect to ln C2D at the nodes.
    let mut slope = vec![0.0; count];
    for (observed, terms) in model.observations.iter().zip(&model.terms) {
        slope.fill(0.0);
        let mut mean = 0.0;
        for term in terms {
            let value = term.value(values);
            mean += value;
            term.place.distribute(value, &mut slope);
        }
        for slope in &mut slope {
            *slope /= mean;
        }
        let residual = observed.waves * (1.0 - observed.power / mean);
        for row in 0..count {
            linearised.gradient[row] += residual * slope[row];
            for column in 0..=row {
                let information = observed.waves * slope[row] * slope[column];
                linearised.information[row * count + column] += information;
            }
        }
    }
}

fn add_penalty(values: &[f64], linearised: &mut Linearised) {
    let count = values.len();
    for (first, x) in values.windows(3).enumerate() {
        let difference = x[0] - 2.0 * x[1] + x[2];
        for (row, a) in SECOND_DIFFERENCE.into_iter().enumerate() {
            linearised.gradient[first + row] += 2.0 * SMOOTHNESS * a * difference;
            for (column, b) in SECOND_DIFFERENCE.into_iter().enumerate().take(row + 1) {
                let place = (first + row) * count + first + column;
                linearised.information[place] += 2.0 * SMOOTHNESS * a * b;
            }
        }
    }
}

/// Mean of ln C2D over the observations that are nearest to a node.
#[derive(Clone, Copy, Default)]
struct NodeMean {
    sum: f64,
    waves: f64,
}

/// Returns the initial values of ln C2D at the nodes. They are computed from the observed powers as
/// if C2D were a power law, and are constant outside the range of the observations.
fn initial_values(model: &Model<'_>) -> Vec<f64> {
    let count = model.nodes.count;
    let mut means = vec![NodeMean::default(); count];
    for (observed, terms) in model.observations.iter().zip(&model.terms) {
        let ln_q = observed.wave_number.ln();
        // Expected mean power for a power law whose value at the observed wave number is 1.
        let weight: f64 = terms
            .iter()
            .map(|term| term.weight * ((ln_q - term.ln_q) * INITIAL_EXPONENT).exp())
            .sum();
        if observed.power > 0.0 && weight > 0.0 {
            let place = model.nodes.place(ln_q);
            let nearest = if place.share < 0.5 {
                place.index
            } else {
                (place.index + 1).min(count - 1)
            };
            means[nearest].sum += observed.waves * (observed.power / weight).ln();
            means[nearest].waves += observed.waves;
        }
    }
    (0..count).map(|index| between(&means, index)).collect()
}

/// Returns the mean at a node. If no observation is near the node, the mean is interpolated
/// linearly.
fn between(means: &[NodeMean], index: usize) -> f64 {
    let is_known = |index: &usize| means[*index].waves > 0.0;
    let value = |index: usize| means[index].sum / means[index].waves;
    let before = (0..=index).rev().find(is_known);
    let after = (index..means.len()).find(is_known);
    match (before, after) {
        (Some(before), Some(after)) if before < after => {
            let rise = value(after) - value(before);
            value(before) + rise * (index - before) as f64 / (after - before) as f64
        }
        (Some(nearest), _) | (None, Some(nearest)) => value(nearest),
        (None, None) => 0.0,
    }
}

/// Differences between the moments of the measured powers and those of the fitted mean powers.
struct Departure {
    /// Largest difference of each moment among the kinds of surfaces, in the unit of the moment. A
    /// kind is all profiles or all maps with equal points.
    moments: [f64; 3],
    /// Ratio of the largest to the smallest rms height or rms gradient among the kinds of surfaces;
    /// 1 if chance explains the differences.
    ratio_of_kinds: f64,
}

/// Moments of the measured powers of one kind of surfaces, and of the fitted mean powers of the
/// same waves.
struct KindMoments {
    differences: [f64; 3],
    fitted: [f64; 3],
    /// Standard errors of the fitted moments that result from the finite number of waves.
    errors: [f64; 3],
}

impl KindMoments {
    fn new(observations: &[Observation], means: &mut impl Iterator<Item = f64>) -> Self {
        let mut moments = KindMoments {
            differences: [0.0; 3],
            fitted: [0.0; 3],
            errors: [0.0; 3],
        };
        let mut variances = [0.0; 3];
        for (observed, mean) in observations.iter().zip(means) {
            let difference = observed.moments(observed.power - mean);
            let fitted = observed.moments(mean);
            for index in 0..3 {
                moments.differences[index] += difference[index];
                moments.fitted[index] += fitted[index];
                variances[index] += fitted[index].powi(2) / observed.waves;
            }
        }
        moments.errors = variances.map(f64::sqrt);
        moments
    }

    /// Returns the ratio of the measured to the fitted moment.
    fn ratio(&self, index: usize) -> f64 {
        1.0 + self.differences[index] / self.fitted[index]
    }
}

/// Compares the moments of the measured powers with those of the fitted mean powers of the same
/// waves, for each kind of profiles and maps. If there are several kinds, only that part of a
/// difference counts which exceeds chance. If the kinds differ by more than chance, this part is
/// multiplied by Student's factor.
fn departure(model: &Model<'_>, values: &[f64]) -> Departure {
    let mut means = model.means(values);
    let mut kinds = Vec::new();
    for observations in model
        .observations
        .chunk_by(|observation, next| observation.kind == next.kind)
    {
        // `take` leaves the means of the following kinds in the iterator `means`.
        let mut own_means = means.by_ref().take(observations.len());
        kinds.push(KindMoments::new(observations, &mut own_means));
    }
    let mut departure = Departure {
        moments: [0.0; 3],
        ratio_of_kinds: 1.0,
    };
    let mut is_chance = true;
    for kind in &kinds {
        for index in 0..3 {
            let difference = kind.differences[index].abs();
            is_chance &= difference <= LEAST_DEVIATIONS * kind.errors[index];
            // If there are several kinds, scans with the same spectrum differ by chance. This part
            // of the difference is already contained in the statistical error.
            let chance = if kinds.len() > 1 {
                2.0 * kind.errors[index]
            } else {
                0.0
            };
            departure.moments[index] = departure.moments[index].max(difference - chance);
        }
    }
    if kinds.len() > 1 && !is_chance {
        departure.moments = departure
            .moments
            .map(|moment| student_factor(kinds.len()) * moment);
        departure.ratio_of_kinds = ratio_of_kinds(&kinds);
    }
    departure
}

fn ratio_of_kinds(kinds: &[KindMoments]) -> f64 {
    let mut largest = 1.0_f64;
    for index in [0, 2] {
        let ratios = kinds.iter().map(|kind| kind.ratio(index));
        let most = ratios.clone().fold(0.0, f64::max);
        let least = ratios.fold(f64::INFINITY, f64::min);
        largest = largest.max((most / least).sqrt());
    }
    largest
}
