//! Values at which a fit begins. They follow from the curve and the known parameters; the values of
//! the scene for free parameters have no effect.

use crate::curve::MeasuredCurve;
use crate::curve::numerics::Extent;
use crate::error::ExperimentError;
use asperity_contact::motion::Leg;
use asperity_contact::{Contact, Modulus};
use std::f64::consts::PI;

/// Pull-off force of a smooth body, divided by the pull-off force of the curve, up to which the
/// coordinate of the work of adhesion is linear. The limit is larger if the noise hides more.
const LINEAR: f64 = 0.01;
/// Smallest share of the way from first touch to the turning point that indents the body. The
/// deflection of the instrument takes the rest.
const LEAST: f64 = 0.05;
/// Stiffness of an instrument divided by the mean slope of the force.
const STIFFER: f64 = 10.0;

/// Known parameters of the scene of a fit.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Known {
    /// Radius of the form, m.
    pub radius: Option<f64>,
    /// Length of the profile, m.
    pub length: f64,
    /// Effective modulus, Pa; `None` if it is free.
    pub modulus: Option<f64>,
    /// Stiffness of the instrument, N/m, infinite for a rigid one; `None` if it is free.
    pub stiffness: Option<f64>,
}

/// Values at which a fit begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Starts {
    /// Work of adhesion, J/m², with which a smooth body would have the pull-off force of the curve.
    pub work: f64,
    /// Work of adhesion that the noise hides, J/m².
    pub least_work: f64,
    /// Effective modulus, Pa, with which the body without adhesion would carry the largest force at
    /// the turning point.
    pub modulus: f64,
    /// Stiffness of the instrument, N/m.
    pub stiffness: f64,
}

impl Starts {
    pub fn of(
        curve: &MeasuredCurve,
        contact: &Contact,
        known: Known,
    ) -> Result<Starts, ExperimentError> {
        let Extent { low, high } = Extent::of(curve.force.iter().copied());
        let (pull_off, pressed) = (curve.noise.max(-low), high.max(curve.noise));
        let way = curve.turns[0] - curve.touch;
        let deflection = known.stiffness.map_or(0.0, |stiffness| pressed / stiffness);
        let indentation = (way - deflection).max(LEAST * way);
        let leg = Leg::approach(&contact.with(Modulus::effective(1.0)?).build()?)?;
        let modulus = (pressed + 2.0 * pull_off) / leg.point(indentation)?.force;
        let modulus = known.modulus.unwrap_or(modulus);
        let smooth = |force: f64| {
            let of_sphere = known.radius.map(|radius| force / (1.5 * PI * radius));
            let of_flat = force.powi(2) / (PI * modulus * known.length.powi(3));
            let works = of_sphere.into_iter().chain([of_flat]);
            works
                .into_iter()
                .find(|work| work.is_finite() && *work > 0.0)
                .unwrap_or(0.05)
        };
        Ok(Starts {
            work: smooth(pull_off),
            least_work: smooth(curve.noise.max(LINEAR * pull_off)),
            modulus,
            stiffness: STIFFER * pressed / way,
        })
    }
}
