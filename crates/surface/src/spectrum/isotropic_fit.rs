//! The isotropic spectrum of largest penalised likelihood.
//!
//! The sum Σ w (P/m + ln m) + λ Σ (x_{i−1} − 2x_i + x_{i+1})² is minimised over the values x = ln
//! C2D at the nodes. P are the observed powers of w waves each, and m(x) their means.

use super::isotropic::IsotropicSpectrum;
use super::likelihood::Model;
use super::scoring::{Linearised, Objective, descend};
use std::f64::consts::TAU;

/// Weight λ of the squared second differences.
const SMOOTHNESS: f64 = 1.0;

/// Weights of three neighbouring values in a second difference.
const SECOND_DIFFERENCE: [f64; 3] = [1.0, -2.0, 1.0];

/// Largest number of steps of the search.
const MOST_STEPS: usize = 200;

/// Largest change of ln C2D at a node in one step.
const LARGEST_STEP: f64 = 1.5;

/// Exponent of the power law q^(−3) by which initial values are interpolated.
const INITIAL_EXPONENT: f64 = 3.0;

/// Finds the isotropic spectrum. `None` if the information matrix is not positive definite, as for
/// powers that are zero or not finite.
pub(super) fn fit_isotropic(model: &Model<'_>) -> Option<IsotropicSpectrum> {
    let likelihood = PenalisedLikelihood { model };
    let values = descend(&likelihood, initial_values(model), MOST_STEPS)?.parameters;
    let information = likelihood.linearise(&values).factor()?;
    let method = departure(model, &values);
    let mut spectrum = IsotropicSpectrum {
        nodes: model.nodes,
        values,
        information,
        method: [0.0; 3],
        missing: [0.0; 3],
    };
    let integrals = spectrum.integrals();
    spectrum.method = [0, 1, 2].map(|index| TAU * method[index] / integrals[index]);
    Some(spectrum)
}

/// The objective as a function of ln C2D at the nodes.
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
        self.model.misfit(self.model.means(values)) + SMOOTHNESS * roughness
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
    // Slope of the logarithm of a mean.
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

/// Mean of ln C2D of the observations nearest to a node.
#[derive(Clone, Copy, Default)]
struct NodeMean {
    sum: f64,
    waves: f64,
}

/// Returns the initial values: C2D from the powers as if it were a power law, constant outside the
/// observations.
fn initial_values(model: &Model<'_>) -> Vec<f64> {
    let count = model.nodes.count;
    let mut means = vec![NodeMean::default(); count];
    for (observed, terms) in model.observations.iter().zip(&model.terms) {
        let ln_q = observed.wave_number.ln();
        // The mean of a spectrum that is 1 at the observed wave number.
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

/// Returns the mean at a node, interpolated linearly where no observation is near.
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

/// Compares the moments of the measured powers with the moments of the fitted means over the same
/// waves. Returns the largest difference of each moment among profiles and maps of one kind. With
/// several kinds, only the excess over chance counts.
fn departure(model: &Model<'_>, values: &[f64]) -> [f64; 3] {
    let kinds: Vec<_> = model
        .observations
        .chunk_by(|observation, next| observation.kind == next.kind)
        .collect();
    let mut largest = [0.0_f64; 3];
    let mut means = model.means(values);
    for kind in &kinds {
        let mut differences = [0.0; 3];
        let mut variances = [0.0; 3];
        for (observed, mean) in kind.iter().zip(&mut means) {
            let difference = observed.moments(observed.power - mean);
            let deviation = observed.moments(mean);
            for index in 0..3 {
                differences[index] += difference[index];
                variances[index] += deviation[index].powi(2) / observed.waves;
            }
        }
        for index in 0..3 {
            // Scans that share a spectrum depart from it by chance, which is in the statistical
            // error.
            let chance = if kinds.len() > 1 {
                2.0 * f64::sqrt(variances[index])
            } else {
                0.0
            };
            largest[index] = largest[index].max(differences[index].abs() - chance);
        }
    }
    largest
}
