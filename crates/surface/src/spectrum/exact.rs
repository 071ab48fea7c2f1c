//! Correction of the fitted spectrum of periodic surfaces, with which its moments equal those of
//! the measured powers.
//!
//! All waves of a periodic surface are known, so the rms height, the gradient and the elastic
//! energy of its equivalent line follow from the measured powers. A spectrum of largest likelihood
//! has other values: the likelihood compares ratios of powers, so that a band with little power
//! counts as much as a band with most of the power. The fitted spectrum is smooth between its
//! nodes, the wave numbers at which it is given. Where the powers rise or end within the distance
//! of two nodes, the fitted spectrum cannot follow, and has too much power beside the step. The
//! values at the nodes are therefore changed so that the moments become exact. The change is the
//! least one possible, in units of the standard errors.

use super::grid_model::scalar_product;
use super::isotropic::IsotropicSpectrum;
use super::likelihood::Model;
use super::observation::Kind;
use asperity_data::Cholesky;
use std::f64::consts::TAU;

/// Moments that are matched, by their index. The first set is used for which there is a spectrum:
/// a profile of nearly equal waves is no cut of an isotropic surface, and its elastic energy, or
/// its gradient too, is not that of a line with its height.
const SETS: [&[usize]; 3] = [&[0, 1, 2], &[0, 2], &[0]];

/// Largest number of steps of the search.
const MOST_STEPS: usize = 100;

/// Largest change of ln C2D at a node in one step of the search.
const LARGEST_STEP: f64 = 0.5;

/// Largest change of ln C2D at a node altogether. With a larger change the spectrum would be unlike
/// the measured one.
const LARGEST_CHANGE: f64 = 4.0;

/// Largest relative difference of moments that count as equal.
const EQUAL: f64 = 1e-12;

/// Three moments ∫ q^p C2D dq/2π, p = 1, 2, 3, as a spectrum has them.
struct ModelMoments {
    values: [f64; 3],
    /// Derivatives of the moments with respect to ln C2D at the nodes.
    gradients: [Vec<f64>; 3],
}

/// Changes a spectrum so that three moments equal those of the observed powers of periodic
/// surfaces: the mean square height, the elastic energy and the mean square gradient, up to
/// constant factors. Returns the magnitudes of the differences that remain between the moments of
/// the spectrum and the observed moments; 0 for a moment that is equal. `scans` is the number of
/// surfaces whose waves are observed one by one.
pub(super) fn match_moments(
    model: &Model<'_>,
    spectrum: &mut IsotropicSpectrum,
    scans: f64,
) -> [f64; 3] {
    let mut observed = [0.0; 3];
    for observation in model.observations {
        for (sum, moment) in observed.iter_mut().zip(observation.measured_moments()) {
            *sum += moment / scans;
        }
    }
    let matched = SETS
        .into_iter()
        .find_map(|set| matching_values(model, spectrum, scans, observed, set));
    if let Some(values) = matched {
        spectrum.values = values;
    }
    let moments = moments(model, spectrum, scans).values;
    [0, 1, 2].map(|index| {
        let difference = (observed[index] - moments[index]).abs();
        if difference > 2.0 * EQUAL * observed[index] {
            difference
        } else {
            0.0
        }
    })
}

/// Returns values of ln C2D with which the moments in `set` are those observed; `None` if there are
/// none near the values of the spectrum.
fn matching_values(
    model: &Model<'_>,
    spectrum: &IsotropicSpectrum,
    scans: f64,
    observed: [f64; 3],
    set: &[usize],
) -> Option<Vec<f64>> {
    let mut changed = spectrum.clone();
    for _ in 0..MOST_STEPS {
        let moments = moments(model, &changed, scans);
        let missing: Vec<f64> = set
            .iter()
            .map(|&index| (observed[index] / moments.values[index]).ln())
            .collect();
        if missing.iter().all(|missing| missing.abs() <= EQUAL) {
            return is_near(&changed.values, &spectrum.values).then_some(changed.values);
        }
        let slopes: Vec<Vec<f64>> = set
            .iter()
            .map(|&index| {
                let slopes = moments.gradients[index].iter();
                slopes.map(|slope| slope / moments.values[index]).collect()
            })
            .collect();
        // The step of least length, where the information matrix measures lengths.
        let covariances: Vec<Vec<f64>> = slopes
            .iter()
            .map(|slopes| spectrum.information.solve(slopes.clone()))
            .collect();
        let matrix = slopes.iter().flat_map(|slopes| {
            let products = covariances.iter();
            products.map(|covariances| scalar_product(slopes, covariances))
        });
        let factors = Cholesky::new(matrix.collect(), set.len())?.solve(missing);
        let step: Vec<f64> = (0..changed.values.len())
            .map(|node| {
                let terms = factors.iter().zip(&covariances);
                terms
                    .map(|(factor, covariances)| factor * covariances[node])
                    .sum()
            })
            .collect();
        let largest = step.iter().fold(0.0_f64, |largest, x| largest.max(x.abs()));
        if !largest.is_finite() {
            return None;
        }
        let share = (LARGEST_STEP / largest).min(1.0);
        for (value, step) in changed.values.iter_mut().zip(step) {
            *value += share * step;
        }
    }
    None
}

fn is_near(values: &[f64], others: &[f64]) -> bool {
    let mut pairs = values.iter().zip(others);
    pairs.all(|(value, other)| (value - other).abs() <= LARGEST_CHANGE)
}

/// Returns the moments of the waves that are observed. The waves of maps are those of the
/// equivalent line, so their moments are integrals over the spectrum. A profile has no waves that
/// run across it, or nearly so, and the moments of its waves are sums over them. Both contain
/// aliases, as far as the spectrum continues beyond the waves that the points resolve.
fn moments(model: &Model<'_>, spectrum: &IsotropicSpectrum, scans: f64) -> ModelMoments {
    let count = spectrum.values.len();
    let mut moments = ModelMoments {
        values: [0.0; 3],
        gradients: [0, 1, 2].map(|_| vec![0.0; count]),
    };
    let nodes = &model.nodes;
    let is_map = matches!(
        model
            .observations
            .first()
            .map(|observation| observation.kind),
        Some(Kind::Plane { .. })
    );
    if is_map {
        let resolved = spectrum.up_to(spectrum.last_node());
        for index in 0..3 {
            let integral = resolved.integral(index as i32 + 1, 0.5 * nodes.wave_number(0));
            moments.values[index] = integral.value / TAU;
            moments.gradients[index] = integral.gradient;
            for slope in &mut moments.gradients[index] {
                *slope /= TAU;
            }
        }
        if nodes.end <= spectrum.last_node() {
            return moments;
        }
    }
    let mut slopes = vec![0.0; count];
    for (observation, terms) in model.observations.iter().zip(&model.terms) {
        slopes.fill(0.0);
        let mut mean = 0.0;
        for term in terms {
            let value = term.value(&spectrum.values);
            mean += value;
            term.place.distribute(value, &mut slopes);
        }
        if is_map {
            // The integral has the wave itself, so that only its aliases are added.
            let own = nodes.term(observation.wave_number, -1.0);
            let value = own.value(&spectrum.values);
            mean += value;
            own.place.distribute(value, &mut slopes);
        }
        let factors = observation.moments(1.0 / scans);
        for (index, factor) in factors.into_iter().enumerate() {
            moments.values[index] += factor * mean;
            for (sum, slope) in moments.gradients[index].iter_mut().zip(&slopes) {
                *sum += factor * slope;
            }
        }
    }
    moments
}
