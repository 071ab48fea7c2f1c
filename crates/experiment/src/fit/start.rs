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

/// Work of adhesion, J/m², where the curve says nothing about it.
const USUAL_WORK: f64 = 0.05;

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
        let force = Extent::of(curve.force.iter().copied());
        let pull_off = curve.noise.max(-force.low);
        let preload = force.high.max(curve.noise);
        let way = curve.turns[0] - curve.touch;
        let deflection = match known.stiffness {
            Some(stiffness) => preload / stiffness,
            None => 0.0,
        };
        let indentation = (way - deflection).max(LEAST * way);
        let found_modulus =
            (preload + 2.0 * pull_off) / force_of_unit_modulus(contact, indentation)?;
        let modulus = known.modulus.unwrap_or(found_modulus);
        let least_pull_off = curve.noise.max(LINEAR * pull_off);
        Ok(Starts {
            work: known.work_of_smooth_body(pull_off, modulus),
            least_work: known.work_of_smooth_body(least_pull_off, modulus),
            modulus,
            stiffness: STIFFER * preload / way,
        })
    }
}

/// Returns the force in N at an indentation in m of the body without adhesion, if its effective
/// modulus is 1 Pa.
fn force_of_unit_modulus(contact: &Contact, indentation: f64) -> Result<f64, ExperimentError> {
    let contact = contact.with(Modulus::effective(1.0)?).build()?;
    Ok(Leg::approach(&contact)?.point(indentation)?.force)
}

impl Known {
    /// Returns the work of adhesion in J/m² with which a smooth body has this pull-off force in N:
    /// a sphere (JKR), or a flat body as long as the profile (Kendall).
    fn work_of_smooth_body(self, pull_off: f64, modulus: f64) -> f64 {
        if let Some(radius) = self.radius {
            let work = pull_off / (1.5 * PI * radius);
            if is_positive(work) {
                return work;
            }
        }
        let work = pull_off.powi(2) / (PI * modulus * self.length.powi(3));
        if is_positive(work) { work } else { USUAL_WORK }
    }
}

fn is_positive(work: f64) -> bool {
    work.is_finite() && work > 0.0
}
