//! Initial values of a fit. They follow from the curve and the known parameters. They do not depend
//! on the values that the scene has for free parameters.

use crate::curve::MeasuredCurve;
use crate::curve::numerics::{Extent, dot};
use crate::error::ExperimentError;
use crate::fit::instrument::{carried_force, stiffness_by_slope};
use asperity_contact::motion::Stage;
use asperity_contact::{Contact, Modulus};
use asperity_data::mean;
use std::f64::consts::PI;

/// Pull-off force of a smooth body, divided by the pull-off force of the curve, up to which the
/// coordinate of the work of adhesion is linear. If the noise is larger than this force, the
/// coordinate is linear up to the noise.
const LINEAR: f64 = 0.01;
/// Smallest indentation, as a share of the way from first touch to the turning point. The rest of
/// the way is the deflection of the instrument.
const LEAST: f64 = 0.05;
/// Share of the largest force above which the points of a loading are used to determine the
/// modulus.
const HALF: f64 = 0.5;
/// Smallest number of points that determine the modulus.
const FEWEST: usize = 5;
/// Initial stiffness of the instrument, divided by the mean slope of the force over the
/// displacement.
const STIFFER: f64 = 10.0;

/// Initial work of adhesion in J/m², if none follows from the curve.
const USUAL_WORK: f64 = 0.05;

/// Known parameters of the scene of a fit.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Known {
    /// Radius of the form in m; `None` for a form without a radius.
    pub radius: Option<f64>,
    /// Length of the profile in m.
    pub length: f64,
    /// Effective modulus in Pa; `None` if the modulus is free.
    pub modulus: Option<f64>,
    /// Stiffness of the instrument in N/m, infinite for a rigid instrument. `None` if the stiffness
    /// is free.
    pub stiffness: Option<f64>,
}

/// Initial values of a fit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Starts {
    /// Work of adhesion in J/m² with which a smooth body would have the measured pull-off force.
    pub work: f64,
    /// Work of adhesion in J/m² below which the pull-off force of a smooth body would be hidden by
    /// the noise.
    pub least_work: f64,
    /// Effective modulus in Pa with which a body without adhesion would have the measured loading.
    /// Only the upper half of the loading is used.
    pub modulus: f64,
    /// Stiffness of the instrument in N/m.
    pub stiffness: f64,
    /// Displacement in m at first touch.
    pub touch: f64,
    /// Distance in m by which the instrument moves from first touch to the largest force.
    pub way: f64,
}

impl Starts {
    /// Estimates the initial values. The modulus follows from the upper half of the loading. The
    /// work of adhesion follows from the pull-off force, as if the body were smooth. The contact
    /// point is the one that was found when the curve was read, unless the extrapolated loading
    /// gives a very different one.
    ///
    /// # Errors
    /// Returns an error if the contact without adhesion cannot be computed.
    pub fn of(
        curve: &MeasuredCurve,
        contact: &Contact,
        known: Known,
    ) -> Result<Starts, ExperimentError> {
        let force = Extent::of(curve.force.iter().copied());
        let pull_off = curve.noise.max(-force.low);
        let preload = force.high.max(curve.noise);
        let carried = carried_force(curve);
        let loading = Loading::of(curve, known.stiffness, 2.0 * pull_off);
        let mut whole_way = loading.turn - curve.touch;
        if whole_way <= 0.0 {
            whole_way = curve.turns[0] - curve.touch;
        }
        let exponent = exponent(contact, LEAST * whole_way)?;
        let mut starts = Starts {
            work: 0.0,
            least_work: 0.0,
            modulus: 0.0,
            stiffness: STIFFER * preload / whole_way,
            touch: curve.touch,
            way: whole_way,
        };
        let indentation = match loading.indentation(exponent) {
            Some(indentation) => {
                let deflection = loading.turn - loading.last_indentation();
                let extrapolated = loading.last_indentation() - indentation;
                let is_near = (extrapolated - curve.touch).abs() < indentation;
                if !is_near && extrapolated < loading.turn {
                    starts.touch = extrapolated;
                    starts.way = indentation + deflection.max(0.0);
                }
                indentation
            }
            None => (whole_way - preload / known.stiffness.unwrap_or(f64::INFINITY))
                .max(LEAST * whole_way),
        };
        let found_modulus = carried / force_of_unit_modulus(contact, indentation)?;
        let modulus = known.modulus.unwrap_or(found_modulus);
        if known.modulus.is_some()
            && let Some(stiffness) = stiffness_by_slope(curve, contact, modulus)?
        {
            starts.stiffness = stiffness;
        }
        let least_pull_off = curve.noise.max(LINEAR * pull_off);
        starts.work = known.work_of_smooth_body(pull_off, modulus);
        starts.least_work = known.work_of_smooth_body(least_pull_off, modulus);
        starts.modulus = modulus;
        Ok(starts)
    }
}

/// Upper half, by the force, of the loading that reaches the largest force of a curve, or of the
/// unloading from this force.
struct Loading {
    /// Displacement in m at the largest force.
    turn: f64,
    /// Displacements of the body in m: those of the instrument minus its deflection, if its
    /// stiffness is known.
    indentations: Vec<f64>,
    /// Forces in N, to which a constant is added that allows for adhesion.
    forces: Vec<f64>,
}

impl Loading {
    /// Selects the points of the loading. `tension` in N is added to the forces. An unknown
    /// stiffness counts as infinite.
    fn of(curve: &MeasuredCurve, stiffness: Option<f64>, tension: f64) -> Self {
        let points = curve.force.iter().enumerate();
        let highest = points.max_by(|(_, force), (_, next)| force.total_cmp(next));
        let top = highest.map_or(0, |(index, _)| index);
        let half = HALF * curve.force[top];
        let belongs = |index: &usize| {
            curve.segment[*index] == curve.segment[top] && curve.force[*index] >= half
        };
        let is_pressed = curve.segment[top].is_multiple_of(2);
        let indices: Vec<usize> = if is_pressed {
            let mut indices: Vec<usize> = (0..=top).rev().take_while(belongs).collect();
            indices.reverse();
            indices
        } else {
            (top..curve.force.len()).take_while(belongs).collect()
        };
        let compliance = 1.0 / stiffness.unwrap_or(f64::INFINITY);
        let mut loading = Loading {
            turn: curve.displacement[top],
            indentations: Vec::with_capacity(indices.len()),
            forces: Vec::with_capacity(indices.len()),
        };
        for index in indices {
            let force = curve.force[index];
            loading
                .indentations
                .push(curve.displacement[index] - compliance * force);
            loading.forces.push(force + tension);
        }
        loading
    }

    fn last_indentation(&self) -> f64 {
        Extent::of(self.indentations.iter().copied()).high
    }

    /// Returns the indentation in m at the largest force, from a straight line through F^(1/n) over
    /// the displacement of the body, where n is the exponent; `None` if the points determine no
    /// rising line. The contact point need not be known for this.
    fn indentation(&self, exponent: f64) -> Option<f64> {
        if self.forces.len() < FEWEST {
            return None;
        }
        let roots: Vec<f64> = self
            .forces
            .iter()
            .map(|force| force.max(0.0).powf(1.0 / exponent))
            .collect();
        let middle = mean(&self.indentations);
        let distances: Vec<f64> = self
            .indentations
            .iter()
            .map(|indentation| indentation - middle)
            .collect();
        let slope = dot(&distances, &roots) / dot(&distances, &distances);
        let indentation = mean(&roots) / slope + self.last_indentation() - middle;
        (slope > 0.0 && slope.is_finite() && indentation.is_finite()).then_some(indentation)
    }
}

/// Returns the exponent n of the force F ~ dⁿ of the body without adhesion, for indentations d near
/// `indentation` in m.
fn exponent(contact: &Contact, indentation: f64) -> Result<f64, ExperimentError> {
    let once = force_of_unit_modulus(contact, indentation)?;
    let twice = force_of_unit_modulus(contact, 2.0 * indentation)?;
    let exponent = (twice / once).log2();
    Ok(if exponent.is_finite() {
        exponent.clamp(1.0, 3.0)
    } else {
        1.5
    })
}

/// Returns the force in N at an indentation in m of the body without adhesion, if its effective
/// modulus is 1 Pa.
fn force_of_unit_modulus(contact: &Contact, indentation: f64) -> Result<f64, ExperimentError> {
    let contact = contact.with(Modulus::effective(1.0)?).build()?;
    Ok(Stage::approach(&contact)?.point(indentation)?.force)
}

impl Known {
    /// Returns the work of adhesion in J/m² with which a smooth body has this pull-off force in N.
    /// The body is a sphere (JKR) if the form has a radius, and otherwise a flat body as long as
    /// the profile (Kendall).
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
