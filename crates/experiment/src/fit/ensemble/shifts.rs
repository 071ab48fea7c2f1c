//! Effect of errors of the roughness of the scene on the result of an ensemble.

use super::compared::Compared;
use super::computed::{Place, Specimen};
use super::deviation::Response;
use super::measured::Measured;
use super::result::RoughnessShifts;
use super::table::Workers;
use crate::error::ExperimentError;
use asperity_data::mean;
use asperity_scene::{Roughness, RunError};

/// Steps of the logarithm of the rms height and of the Hurst exponent.
const HEIGHT_STEP: f64 = 0.05;
const HURST_STEP: f64 = 0.05;

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
