//! Approximate JKR solution for a general contact: an adhesive curve from the contact without adhesion.
//!
//! M. Ciavarella, J. Mech. Phys. Solids 114 (2018) 209, arXiv 1712.05844: the body is pressed without adhesion to an
//! indentation d₁ and then lifted with an unchanged contact area A₁, as a flat punch of the stiffness F₁′. The energy of
//! both steps less the work of adhesion γA₁ is least where
//!
//! d = d₁ − √(2γA₁′/F₁″), F = F₁ − F₁′ √(2γA₁′/F₁″),
//!
//! primes by d₁. The rule of Hess takes a patch of length l as a circle, A₁ = Σ πl²/4, and F₁′ = E* Σ l, so that
//! A₁′/F₁″ = (π/2E*) Σ l l′/Σ l′. The lift √(2γA₁′/F₁″) is then the largest stretch by the rule of Hess, of a patch of
//! mean length weighted by growth. Where patches merge the area of the circles jumps although nothing attaches: these
//! jumps do not count.
//!
//! For a single patch of a body of revolution the curve is exact. Over many patches the lift is a mean: the curve
//! has no hysteresis of single patches, and no patch that merged on loading holds longer.

use crate::contact::NonadhesivePoint;
use std::f64::consts::PI;

/// Assumptions of the curve, for a reader.
pub const APPROXIMATE_JKR_ASSUMPTIONS: &str =
    "contact areas as without adhesion, patches as circles that never merge, no hysteresis of single patches";

/// Approximate JKR curve.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ApproximateJkr {
    /// Points in the order of their contact areas.
    pub points: Vec<ApproximatePoint>,
}

/// A point of the curve, in SI units.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ApproximatePoint {
    /// The contact without adhesion of the same area.
    pub nonadhesive: NonadhesivePoint,
    /// Indentation d, m.
    pub indentation: f64,
    /// Force F, N.
    pub force: f64,
}

impl ApproximateJkr {
    /// The curve under a work of adhesion, J/m², of a body with this effective modulus, Pa, from its contact
    /// without adhesion. Points without a growing patch are left out.
    #[must_use]
    pub fn new(contact: &[NonadhesivePoint], effective_modulus: f64, work_of_adhesion: f64) -> Self {
        let point = |nonadhesive: &NonadhesivePoint| {
            let lift = (PI * nonadhesive.growing_length? * work_of_adhesion / effective_modulus).sqrt();
            Some(ApproximatePoint {
                nonadhesive: *nonadhesive,
                indentation: nonadhesive.indentation - lift,
                force: nonadhesive.force - effective_modulus * nonadhesive.contact_length * lift,
            })
        };
        ApproximateJkr { points: contact.iter().filter_map(point).collect() }
    }

    /// Point of the smallest force, if that is tensile.
    #[must_use]
    pub fn pull_off(&self) -> Option<ApproximatePoint> {
        let smallest = self.points.iter().min_by(|one, other| one.force.total_cmp(&other.force));
        smallest.copied().filter(|point| point.force <= 0.0)
    }

    /// Adhesion force F_a, N: minus the smallest force of the curve; `None` without a tensile force.
    #[must_use]
    pub fn adhesion_force(&self) -> Option<f64> {
        // Not −F, which would make a force of zero negative.
        self.pull_off().map(|point| 0.0 - point.force)
    }
}
