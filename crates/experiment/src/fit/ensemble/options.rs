//! Options of a comparison of measured curves with random profiles, and the checks of curves, scene
//! and options before the comparison.

use super::precision::NORMAL;
use crate::curve::MeasuredCurve;
use crate::error::{ExperimentError, refused, refused_with};
use asperity_data::Remedy;
use asperity_scene::{Roughness, Scene, Solver};

/// Smallest allowed number of random profiles. With fewer profiles, the covariance of the
/// predictions is too uncertain.
const FEWEST_PROFILES: u64 = 16;
/// Largest allowed standard error of the roughness. For larger errors the results would not change
/// in proportion to the error.
const MOST_ERROR: f64 = 0.5;

/// Options of [`fit_ensemble`](crate::fit_ensemble), which compares measured curves with random
/// profiles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EnsembleOptions {
    /// Number of random profiles whose computed curves are compared with the measured curves, at
    /// least 16.
    pub profiles: u64,
    /// True if the effective modulus is a free parameter too; false if its value in the scene is
    /// used.
    pub is_modulus_free: bool,
    /// Standard error of the rms height of the scene divided by this height; `None` if it is not
    /// stated.
    pub height_error: Option<f64>,
    /// Standard error of the Hurst exponent of the scene; `None` if it is not stated.
    pub hurst_error: Option<f64>,
}

impl EnsembleOptions {
    /// Returns half the width of the 95 % interval of a quantity that results from the stated
    /// errors of the roughness. `by_height` and `by_hurst` are the derivatives of the quantity with
    /// respect to ln h and H.
    pub(super) fn half_width_by(&self, by_height: f64, by_hurst: f64) -> f64 {
        let height_error = self.height_error.unwrap_or_default();
        let hurst_error = self.hurst_error.unwrap_or_default();
        NORMAL * (by_height * height_error).hypot(by_hurst * hurst_error)
    }
}

/// Returns an error if the curves, the scene or the options allow no comparison.
pub(super) fn check(
    curves: &[(String, MeasuredCurve)],
    scene: &Scene,
    options: &EnsembleOptions,
) -> Result<(), ExperimentError> {
    if curves.is_empty() {
        return refused("no curve", "one or more curves");
    }
    if scene.seed().is_none() {
        let found = "a comparison with random profiles, and the profile of the scene is not random";
        let allowed = "a scene with random roughness, or a fit of the profile of the scene";
        return refused_with(found, allowed, [Remedy::NoProfiles]);
    }
    if scene.numerics.solver != Solver::Exact {
        let found =
            "numerics.solver = Stepwise: a comparison with random profiles needs the exact solver";
        return refused(found, "numerics.solver = Exact");
    }
    if scene.material.relaxation.is_some() {
        let found = "material.relaxation: a comparison with random profiles needs an elastic body";
        return refused(found, "material.relaxation = None, or a fit of each curve");
    }
    check_error("error of the rms height", options.height_error)?;
    check_error("error of the Hurst exponent", options.hurst_error)?;
    let states_errors = options.height_error.or(options.hurst_error).is_some();
    if states_errors && !matches!(scene.roughness, Some(Roughness::SelfAffine { .. })) {
        let found = "errors of the roughness, which is measured";
        let allowed = "roughness: SelfAffine(…), or no errors";
        return refused_with(found, allowed, [Remedy::NoRoughnessErrors]);
    }
    if options.profiles < FEWEST_PROFILES {
        let found = format!("{} profiles", options.profiles);
        let allowed = format!("at least {FEWEST_PROFILES}");
        return refused_with(found, allowed, [Remedy::Profiles(FEWEST_PROFILES)]);
    }
    for (index, (name, curve)) in curves.iter().enumerate() {
        for (other_name, other) in &curves[..index] {
            if other.force == curve.force && other.displacement == curve.displacement {
                let found = format!("{name}: the same curve as {other_name}");
                return refused(found, "each curve once");
            }
        }
    }
    Ok(())
}

/// Returns an error for a standard error of the roughness that is out of range.
fn check_error(name: &str, error: Option<f64>) -> Result<(), ExperimentError> {
    if let Some(error) = error
        && !(0.0..=MOST_ERROR).contains(&error)
    {
        return refused(format!("{name} {error}"), format!("from 0 to {MOST_ERROR}"));
    }
    Ok(())
}
