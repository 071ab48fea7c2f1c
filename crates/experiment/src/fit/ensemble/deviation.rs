//! Whether random profiles describe the curves, and the effect of errors of the roughness.

use super::posterior::Compared;
use super::summary::{Mean, Measured, NAMES, SUMMARIES, Summaries};
use super::table::{Place, Scatter, Specimen, Table, Workers};
use crate::error::ExperimentError;
use asperity_data::{mean, quantile};
use asperity_scene::{Roughness, RunError};
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};

/// Number of ensembles drawn from the random profiles of the table, and share of them that counts
/// as described.
const DRAWS: usize = 1000;
const DESCRIBED: f64 = 0.99;
/// Step of a logarithm for the derivatives of the means.
const STEP: f64 = 0.05;
/// Steps of the logarithm of the rms height and of the Hurst exponent.
const HEIGHT_STEP: f64 = 0.05;
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

/// How learned values and parameters change together at a place.
pub(crate) struct Response {
    /// Derivatives of both predicted values with respect to ln γ and to ln E*.
    slopes: [[f64; 2]; 2],
    inverse: [f64; 3],
    is_modulus_free: bool,
}

/// Derivatives of the means with respect to ln γ and to ln E*.
fn slopes(scatter: &Scatter, place: Place) -> [[f64; 2]; 2] {
    let between = |range: f64, modulus: f64| {
        let at = |sign: f64| {
            let place = Place {
                range: place.range + sign * range * STEP,
                modulus: place.modulus + sign * modulus * STEP,
            };
            scatter.at(place).mean
        };
        let [high, low] = [at(1.0), at(-1.0)];
        [0, 1].map(|index| (high[index] - low[index]) / (2.0 * STEP))
    };
    // At a constant γ, γ/E* falls as E* grows.
    [between(1.0, 0.0), between(-1.0, 1.0)]
}

impl Response {
    pub fn at(scatter: &Scatter, place: Place, is_modulus_free: bool) -> Self {
        let inverse = scatter.at(place).inverse().0;
        Response {
            slopes: slopes(scatter, place),
            inverse,
            is_modulus_free,
        }
    }

    /// Returns the changes of ln γ and ln E* that explain a change of the predicted values.
    pub fn explain(&self, change: [f64; 2]) -> [f64; 2] {
        let [work, modulus] = self.slopes;
        if self.is_modulus_free {
            let determinant = work[0] * modulus[1] - work[1] * modulus[0];
            return [
                (change[0] * modulus[1] - change[1] * modulus[0]) / determinant,
                (work[0] * change[1] - work[1] * change[0]) / determinant,
            ];
        }
        let product = |of: [f64; 2]| {
            let [one, both, other] = self.inverse;
            work[0] * (one * of[0] + both * of[1]) + work[1] * (both * of[0] + other * of[1])
        };
        [product(change) / product(work), 0.0]
    }
}

/// Compares the means of all summaries with the means of the table at the most probable place.
/// `learned` returns the predicted values of each random profile at each node. Ensembles drawn from
/// the table show how large a deviation must be to count.
pub(crate) fn deviations(
    table: &Table,
    learned: &dyn Fn(usize, usize) -> [f64; 2],
    response: &Response,
    place: Place,
    mean: &Mean,
) -> Vec<SummaryDeviation> {
    let scatters: Vec<Scatter> = (0..SUMMARIES)
        .map(|index| Scatter::of(table, |line, node| [table.lines[line][node][index], 0.0]))
        .collect();
    let (count, lines) = (mean.curves as f64, table.lines.len());
    let rows: Vec<(f64, f64, [f64; 2])> = scatters
        .iter()
        .map(|scatter| {
            let moments = scatter.at(place);
            let slopes = slopes(scatter, place).map(|slope| slope[0]);
            (
                moments.mean[0],
                moments.covariance[0].max(f64::MIN_POSITIVE).sqrt(),
                slopes,
            )
        })
        .collect();
    // The node nearest to the place.
    let away = |one: &Place| (one.range - place.range).abs() + (one.modulus - place.modulus).abs();
    let nearest = table
        .places()
        .enumerate()
        .min_by(|one, other| away(&one.1).total_cmp(&away(&other.1)));
    let node = nearest.map_or(0, |(node, _)| node);
    let at_node: Vec<(Summaries, [f64; 2])> = (0..lines)
        .map(|line| (table.lines[line][node], learned(line, node)))
        .collect();
    let average = |of: &dyn Fn(usize) -> f64, chosen: &[usize]| {
        chosen.iter().map(|&line| of(line)).sum::<f64>() / chosen.len() as f64
    };
    let all: Vec<usize> = (0..lines).collect();
    let centre: Summaries =
        std::array::from_fn(|index| average(&|line| at_node[line].0[index], &all));
    let learned_centre = [0, 1].map(|index| average(&|line| at_node[line].1[index], &all));
    let mut generator = ChaCha8Rng::seed_from_u64(lines as u64);
    let mut largest: Vec<f64> = (0..DRAWS)
        .map(|_| {
            let chosen: Vec<usize> = (0..mean.curves)
                .map(|_| generator.random_range(0..lines))
                .collect();
            let change = [0, 1].map(|index| {
                average(&|line| at_node[line].1[index], &chosen) - learned_centre[index]
            });
            let explained = response.explain(change);
            let deviation = |index: usize| {
                let (_, error, slopes) = rows[index];
                let change = average(&|line| at_node[line].0[index], &chosen) - centre[index];
                let rest = change - slopes[0] * explained[0] - slopes[1] * explained[1];
                (rest / (error / count.sqrt())).abs()
            };
            (0..SUMMARIES).map(deviation).fold(0.0, f64::max)
        })
        .collect();
    largest.sort_by(f64::total_cmp);
    let threshold = quantile(&largest, DESCRIBED).unwrap_or(f64::INFINITY);
    let of = |index: usize| {
        let (expected, error, _) = rows[index];
        let logarithm = mean.summaries[index] - expected;
        let deviation = logarithm / (error * (1.0 / count + 1.0 / lines as f64).sqrt());
        SummaryDeviation {
            summary: NAMES[index],
            logarithm,
            deviation,
            deviates: deviation.abs() > threshold,
        }
    };
    (0..SUMMARIES).map(of).collect()
}

/// Derivatives of ln γ and ln E* with respect to ln h and to H, the rms height and Hurst exponent
/// of the scene. They show how far a wrong roughness shifts the result.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct RoughnessShifts {
    /// Derivative of ln γ with respect to ln h.
    pub work_by_height: f64,
    /// Derivative of ln γ with respect to H.
    pub work_by_hurst: f64,
    /// Derivative of ln E* with respect to ln h.
    pub modulus_by_height: f64,
    /// Derivative of ln E* with respect to H.
    pub modulus_by_hurst: f64,
}

/// Data from which the derivatives of the result are computed.
pub(crate) struct Shifts<'a> {
    pub workers: &'a Workers<'a>,
    pub compared: &'a Compared,
    pub measured: &'a Measured,
    pub response: &'a Response,
}

impl Shifts<'_> {
    /// Returns the derivatives at a place, from `lines` random profiles; `None` for a measured
    /// roughness.
    pub fn at(&self, place: Place, lines: u64) -> Result<Option<RoughnessShifts>, ExperimentError> {
        let Some(Roughness::SelfAffine { hurst, .. }) = self.workers.specimen.scene.roughness
        else {
            return Ok(None);
        };
        let step = HURST_STEP.min(0.5 * hurst).min(0.5 * (1.0 - hurst));
        let [work_by_height, modulus_by_height] =
            self.between(place, lines, HEIGHT_STEP, &|roughness, change| {
                if let Roughness::SelfAffine {
                    rms_height,
                    rms_gradient,
                    ..
                } = roughness
                {
                    rms_height
                        .iter_mut()
                        .chain(rms_gradient)
                        .for_each(|of| *of *= change.exp());
                }
            })?;
        let [work_by_hurst, modulus_by_hurst] =
            self.between(place, lines, step, &|roughness, change| {
                if let Roughness::SelfAffine { hurst, .. } = roughness {
                    *hurst += change;
                }
            })?;
        Ok(Some(RoughnessShifts {
            work_by_height,
            work_by_hurst,
            modulus_by_height,
            modulus_by_hurst,
        }))
    }

    /// Computes the derivatives of ln γ and ln E* with respect to a change of the roughness.
    fn between(
        &self,
        place: Place,
        lines: u64,
        step: f64,
        change: &dyn Fn(&mut Roughness, f64),
    ) -> Result<[f64; 2], ExperimentError> {
        let at = |change_by: f64| {
            let scene = self.workers.specimen.scene.with(|scene| {
                if let Some(roughness) = &mut scene.roughness {
                    change(roughness, change_by);
                }
            });
            let scene = scene.map_err(RunError::from)?;
            let others = Workers {
                specimen: Specimen {
                    scene: &scene,
                    ..self.workers.specimen
                },
                ..*self.workers
            };
            let curves = others.curves(lines, &[place.range], &[place.modulus])?;
            let of = |(line, curve): (usize, &Vec<_>)| {
                self.compared.of_line(line, &curve[0], self.measured)
            };
            let all: Vec<[f64; 2]> = curves.iter().enumerate().map(of).collect();
            let of = |index: usize| mean(&all.iter().map(|of| of[index]).collect::<Vec<_>>());
            Ok::<_, ExperimentError>([of(0), of(1)])
        };
        let [low, high] = [at(-step)?, at(step)?];
        // A model whose values are larger needs parameters that make them smaller again.
        let shift = self
            .response
            .explain([0, 1].map(|index| low[index] - high[index]));
        Ok(shift.map(|shift| shift / (2.0 * step)))
    }
}
