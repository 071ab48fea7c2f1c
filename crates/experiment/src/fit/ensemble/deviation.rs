//! Test whether random profiles describe the measured curves, and effect of errors of the roughness
//! on the result.

use super::computed::{Specimen, Workers};
use super::predictions::Predictions;
use super::scatter::{InverseCovariance, Scatter};
use super::summary::{MeanSummaries, Measurement, NAMES, SUMMARIES, Summaries};
use super::table::{Place, Table};
use crate::error::ExperimentError;
use asperity_data::{mean, quantile};
use asperity_scene::{Roughness, RunError};
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};

/// Number of ensembles of profiles that are drawn from the random profiles of the table.
const DRAWS: usize = 1000;
/// Share of the drawn ensembles that the test accepts as described by the random profiles.
const DESCRIBED: f64 = 0.99;
/// Step of ln(γ/E*) and ln E* in the numerical derivatives of the means.
const STEP: f64 = 0.05;
/// Step of the logarithm of the rms height in a numerical derivative.
const HEIGHT_STEP: f64 = 0.05;
/// Step of the Hurst exponent in a numerical derivative.
const HURST_STEP: f64 = 0.05;

/// Difference between the measured curves and the random profiles in one summary. A summary is a
/// number computed from a curve, such as its pull-off force.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct SummaryDeviation {
    /// Name of the summary, such as `pull-off force`.
    pub summary: &'static str,
    /// Mean of the natural logarithm of the summary over the measured curves, minus the mean over
    /// the random profiles with the fitted γ and E*.
    pub logarithm: f64,
    /// [`Self::logarithm`] divided by its standard error.
    pub deviation: f64,
    /// True if the difference is significant. If random profiles describe the curves, the
    /// probability that at least one of all summaries has a significant difference is 1 %.
    pub deviates: bool,
}

/// Derivatives of the two mean predictions with respect to ln γ and to ln E*.
#[derive(Clone, Copy)]
struct Slopes {
    by_work: [f64; 2],
    by_modulus: [f64; 2],
}

impl Slopes {
    fn at(scatter: &Scatter, place: Place) -> Self {
        Slopes {
            by_work: derivative(scatter, place, 1.0, 0.0),
            // If E* grows at constant γ, the range γ/E* decreases by the same factor.
            by_modulus: derivative(scatter, place, -1.0, 1.0),
        }
    }
}

/// Returns the derivatives of both means along a direction. `range` and `modulus` are the
/// components of the direction in ln(γ/E*) and ln E*.
fn derivative(scatter: &Scatter, place: Place, range: f64, modulus: f64) -> [f64; 2] {
    let means_at = |sign: f64| {
        let place = Place {
            range: place.range + sign * range * STEP,
            modulus: place.modulus + sign * modulus * STEP,
        };
        scatter.at(place).mean
    };
    let high = means_at(1.0);
    let low = means_at(-1.0);
    [0, 1].map(|index| (high[index] - low[index]) / (2.0 * STEP))
}

/// Relation between changes of the predicted values and changes of the parameters, at a place.
pub(crate) struct Response {
    /// Derivatives of both predicted values with respect to the parameters.
    slopes: Slopes,
    inverse: InverseCovariance,
    is_modulus_free: bool,
}

impl Response {
    pub fn at(scatter: &Scatter, place: Place, is_modulus_free: bool) -> Self {
        Response {
            slopes: Slopes::at(scatter, place),
            inverse: scatter.at(place).inverse(),
            is_modulus_free,
        }
    }

    /// Returns the changes of ln γ and ln E* that change the predicted values by `change`. If E* is
    /// given, only ln γ changes, and the agreement is the best by least squares.
    pub fn explain(&self, change: [f64; 2]) -> [f64; 2] {
        let work = self.slopes.by_work;
        let modulus = self.slopes.by_modulus;
        if self.is_modulus_free {
            let determinant = work[0] * modulus[1] - work[1] * modulus[0];
            return [
                (change[0] * modulus[1] - change[1] * modulus[0]) / determinant,
                (work[0] * change[1] - work[1] * change[0]) / determinant,
            ];
        }
        [self.along_work(change) / self.along_work(work), 0.0]
    }

    /// Returns the scalar product of a change and the derivatives with respect to ln γ, weighted by
    /// the inverse of the covariance matrix.
    fn along_work(&self, change: [f64; 2]) -> f64 {
        let work = self.slopes.by_work;
        let weighted = self.inverse.times(change);
        work[0] * weighted[0] + work[1] * weighted[1]
    }
}

/// Mean and other properties of one summary over the random profiles at a place.
struct Expected {
    mean: f64,
    standard_deviation: f64,
    /// Part of the variance of the difference between a curve and the mean that comes from the
    /// finite distances between the points of the curve.
    of_steps: f64,
    slopes: Slopes,
}

impl Expected {
    fn at(table: &Table, index: usize, place: Place) -> Self {
        let scatter = Scatter::of_summary(table, index);
        let moments = scatter.at(place);
        Expected {
            mean: moments.mean[0],
            standard_deviation: moments.covariance[0].max(f64::MIN_POSITIVE).sqrt(),
            of_steps: scatter.error_of_steps(place)[0],
            slopes: Slopes::at(&scatter, place),
        }
    }
}

/// Summaries and predictions of a random profile at one node of a table.
struct Profile {
    summaries: Summaries,
    /// Predicted ln γ and ln E*.
    predicted: [f64; 2],
}

/// Compares the means of all summaries with the means of the table at the most probable place.
/// `predicted` has the predicted values of each random profile at each node. Ensembles of profiles
/// drawn from the table show how large a deviation must be to be significant.
pub(crate) fn deviations(
    table: &Table,
    predicted: &[Vec<[f64; 2]>],
    response: &Response,
    place: Place,
    measured: &MeanSummaries,
) -> Vec<SummaryDeviation> {
    let expected: Vec<Expected> = (0..SUMMARIES)
        .map(|index| Expected::at(table, index, place))
        .collect();
    let node = nearest_node(table, place);
    let mut profiles = Vec::with_capacity(table.profiles.len());
    for (curves, predicted) in table.profiles.iter().zip(predicted) {
        profiles.push(Profile {
            summaries: curves[node],
            predicted: predicted[node],
        });
    }
    let draws = Draws::new(&profiles, &expected, response, measured.curves);
    let threshold = draws.threshold();

    let count = measured.curves as f64;
    let computed = profiles.len() as f64;
    let mut deviations = Vec::with_capacity(SUMMARIES);
    for (index, expected) in expected.iter().enumerate() {
        let logarithm = measured.summaries[index] - expected.mean;
        let of_profiles = expected.standard_deviation * (1.0 / count + 1.0 / computed).sqrt();
        let error = of_profiles.hypot(expected.of_steps.sqrt());
        let deviation = logarithm / error;
        deviations.push(SummaryDeviation {
            summary: NAMES[index],
            logarithm,
            deviation,
            deviates: deviation.abs() > threshold,
        });
    }
    deviations
}

/// Returns the index of the node of a table that is nearest to a place.
fn nearest_node(table: &Table, place: Place) -> usize {
    let distance =
        |node: &Place| (node.range - place.range).abs() + (node.modulus - place.modulus).abs();
    let nodes = table.places().into_iter().enumerate();
    let nearest = nodes.min_by(|(_, node), (_, next)| distance(node).total_cmp(&distance(next)));
    nearest.map_or(0, |(index, _)| index)
}

/// Ensembles of `curves` profiles each, drawn from the random profiles of a table.
struct Draws<'a> {
    profiles: &'a [Profile],
    expected: &'a [Expected],
    response: &'a Response,
    curves: usize,
    /// Means of the summaries over all profiles.
    mean_summaries: Summaries,
    mean_predicted: [f64; 2],
}

impl<'a> Draws<'a> {
    fn new(
        profiles: &'a [Profile],
        expected: &'a [Expected],
        response: &'a Response,
        curves: usize,
    ) -> Self {
        let all: Vec<&Profile> = profiles.iter().collect();
        Draws {
            profiles,
            expected,
            response,
            curves,
            mean_summaries: std::array::from_fn(|index| mean_summary(&all, index)),
            mean_predicted: [0, 1].map(|index| mean_prediction(&all, index)),
        }
    }

    /// Returns the deviation, in standard errors, that the largest deviation of a summary exceeds
    /// only in 1 % of the ensembles.
    fn threshold(&self) -> f64 {
        let count = self.profiles.len();
        let mut generator = ChaCha8Rng::seed_from_u64(count as u64);
        let mut largest = Vec::with_capacity(DRAWS);
        for _ in 0..DRAWS {
            let chosen: Vec<&Profile> = (0..self.curves)
                .map(|_| &self.profiles[generator.random_range(0..count)])
                .collect();
            largest.push(self.largest_deviation(&chosen));
        }
        largest.sort_by(f64::total_cmp);
        quantile(&largest, DESCRIBED).unwrap_or(f64::INFINITY)
    }

    /// Returns the largest deviation among the summaries of an ensemble, in standard errors, after
    /// subtraction of the part that a change of the parameters explains.
    fn largest_deviation(&self, chosen: &[&Profile]) -> f64 {
        let change =
            [0, 1].map(|index| mean_prediction(chosen, index) - self.mean_predicted[index]);
        let [work, modulus] = self.response.explain(change);
        let root = (self.curves as f64).sqrt();
        let mut largest = 0.0_f64;
        for (index, expected) in self.expected.iter().enumerate() {
            let change = mean_summary(chosen, index) - self.mean_summaries[index];
            let by_work = expected.slopes.by_work[0] * work;
            let by_modulus = expected.slopes.by_modulus[0] * modulus;
            let residual = change - by_work - by_modulus;
            largest = largest.max((residual / (expected.standard_deviation / root)).abs());
        }
        largest
    }
}

fn mean_summary(profiles: &[&Profile], index: usize) -> f64 {
    let values = profiles.iter().map(|profile| profile.summaries[index]);
    values.sum::<f64>() / profiles.len() as f64
}

fn mean_prediction(profiles: &[&Profile], index: usize) -> f64 {
    let values = profiles.iter().map(|profile| profile.predicted[index]);
    values.sum::<f64>() / profiles.len() as f64
}

/// Effect of a wrong roughness on the result: the derivatives of ln γ and ln E* with respect to ln
/// h and to H. h is the rms height and H the Hurst exponent of the scene.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct RoughnessShifts {
    /// Derivative of ln γ with respect to ln h, a number without a unit.
    pub work_by_height: f64,
    /// Derivative of ln γ with respect to the Hurst exponent H, a number without a unit.
    pub work_by_hurst: f64,
    /// Derivative of ln E* with respect to ln h, a number without a unit.
    pub modulus_by_height: f64,
    /// Derivative of ln E* with respect to the Hurst exponent H, a number without a unit.
    pub modulus_by_hurst: f64,
}

/// Data from which the derivatives of the result are computed.
pub(crate) struct Shifts<'a> {
    pub workers: &'a Workers<'a>,
    pub predictions: &'a Predictions,
    pub measured: &'a Measurement,
    pub response: &'a Response,
    /// Number of random profiles.
    pub profiles: u64,
}

impl Shifts<'_> {
    /// Returns the effect of a wrong roughness, if `place` is the result of the fit: a pair of ln γ
    /// and ln E*. Returns `None` if the scene has no self-affine roughness.
    ///
    /// # Errors
    /// Returns an error if a force curve cannot be computed, or if the computation is stopped.
    pub fn at(&self, place: Place) -> Result<Option<RoughnessShifts>, ExperimentError> {
        let Some(Roughness::SelfAffine { hurst, .. }) = self.workers.specimen.scene.roughness
        else {
            return Ok(None);
        };
        let hurst_step = HURST_STEP.min(0.5 * hurst).min(0.5 * (1.0 - hurst));
        let [work_by_height, modulus_by_height] =
            self.derivatives(place, HEIGHT_STEP, change_height)?;
        let [work_by_hurst, modulus_by_hurst] =
            self.derivatives(place, hurst_step, change_hurst)?;
        Ok(Some(RoughnessShifts {
            work_by_height,
            work_by_hurst,
            modulus_by_height,
            modulus_by_hurst,
        }))
    }

    /// Computes the derivatives of ln γ and ln E* with respect to a change of the roughness.
    fn derivatives(
        &self,
        place: Place,
        step: f64,
        change: fn(&mut Roughness, f64),
    ) -> Result<[f64; 2], ExperimentError> {
        let low = self.mean_prediction(place, |roughness| change(roughness, -step))?;
        let high = self.mean_prediction(place, |roughness| change(roughness, step))?;
        // If a change of the roughness increases the predicted values, the parameters have to
        // change so that these values decrease again. So the difference has the opposite sign.
        let shift = self
            .response
            .explain([0, 1].map(|index| low[index] - high[index]));
        Ok(shift.map(|shift| shift / (2.0 * step)))
    }

    /// Returns the mean prediction over random profiles with a changed roughness.
    fn mean_prediction(
        &self,
        place: Place,
        change: impl Fn(&mut Roughness),
    ) -> Result<[f64; 2], ExperimentError> {
        let scene = self.workers.specimen.scene.with(|scene| {
            if let Some(roughness) = &mut scene.roughness {
                change(roughness);
            }
        });
        let scene = scene.map_err(RunError::from)?;
        let workers = Workers {
            specimen: Specimen {
                scene: &scene,
                ..self.workers.specimen
            },
            ..*self.workers
        };
        let curves = workers.curves(self.profiles, &[place.range], &[place.modulus])?;
        let mut works = Vec::with_capacity(curves.len());
        let mut moduli = Vec::with_capacity(curves.len());
        for (profile, curve) in curves.iter().enumerate() {
            let [work, modulus] = self
                .predictions
                .of_profile(profile, &curve[0], self.measured);
            works.push(work);
            moduli.push(modulus);
        }
        Ok([mean(&works), mean(&moduli)])
    }
}

/// Adds a change to the logarithm of the rms height of a roughness.
fn change_height(roughness: &mut Roughness, change: f64) {
    if let Roughness::SelfAffine {
        rms_height,
        rms_gradient,
        ..
    } = roughness
    {
        for size in rms_height.iter_mut().chain(rms_gradient) {
            *size *= change.exp();
        }
    }
}

/// Adds a change to the Hurst exponent of a roughness.
fn change_hurst(roughness: &mut Roughness, change: f64) {
    if let Roughness::SelfAffine { hurst, .. } = roughness {
        *hurst += change;
    }
}
