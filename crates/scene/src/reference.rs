//! Closed forms that the profile must reproduce: adhesive contact of a power-law body b rⁿ, which includes JKR (n = 2) and
//! the cone (n = 1), and of the flat punch (Kendall).

use crate::analysis::governing::ideal_adhesion_force;
use asperity_surface::Form;
use std::f64::consts::PI;

/// A body with the equivalent profile g(x) = c |x|ⁿ on a half-space with adhesion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PowerLaw {
    /// Coefficient c = κₙ b of the equivalent profile, m^(1−n).
    pub line_coefficient: f64,
    /// Exponent n > 1/2.
    pub exponent: f64,
    /// Effective modulus E*, Pa.
    pub effective_modulus: f64,
    /// Work of adhesion γ, J/m².
    pub work_of_adhesion: f64,
}

impl PowerLaw {
    /// The closed form of a form, if its profile is a power law; `None` for punches, waves and tables.
    pub fn of(form: &Form, effective_modulus: f64, work_of_adhesion: f64) -> Option<Self> {
        let (line_coefficient, exponent) = form.power_law()?;
        Some(PowerLaw { line_coefficient, exponent, effective_modulus, work_of_adhesion })
    }

    /// Indentation d(a) = c aⁿ − √(2π a γ/E*), m, at contact radius a.
    pub fn indentation(&self, radius: f64) -> f64 {
        // Rule of Hess, eq. (3).
        let stretch = (2.0 * PI * radius * self.work_of_adhesion / self.effective_modulus).sqrt();
        self.line_coefficient * radius.powf(self.exponent) - stretch
    }

    /// Force F(a) = 2E* n c a^(n+1)/(n+1) − √(8π a³ E* γ), N, at contact radius a.
    pub fn force(&self, radius: f64) -> f64 {
        let n = self.exponent;
        let pressed =
            2.0 * self.effective_modulus * n * self.line_coefficient * radius.powf(n + 1.0) / (n + 1.0);
        pressed - self.detaching(radius)
    }

    /// Contact radius, m, and force, N, at pull-off under force control, where dF/da = 0: the smallest force.
    pub fn force_controlled_pull_off(&self) -> (f64, f64) {
        let n = self.exponent;
        let radius = self.critical_radius(9.0);
        (radius, -(2.0 * n - 1.0) / (2.0 * (n + 1.0)) * self.detaching(radius))
    }

    /// Contact radius, m, and force, N, at pull-off under displacement control, where dd/da = 0.
    pub fn displacement_controlled_pull_off(&self) -> (f64, f64) {
        let n = self.exponent;
        let radius = self.critical_radius(1.0);
        (radius, -(2.0 * n + 1.0) / (2.0 * (n + 1.0)) * self.detaching(radius))
    }

    /// Contact radius [m π γ/(2n²c²E*)]^(1/(2n−1)), m, for m = `multiple`.
    fn critical_radius(&self, multiple: f64) -> f64 {
        let n = self.exponent;
        let scale = 2.0 * (n * self.line_coefficient).powi(2) * self.effective_modulus;
        (multiple * PI * self.work_of_adhesion / scale).powf((2.0 * n - 1.0).recip())
    }

    fn detaching(&self, radius: f64) -> f64 {
        flat_punch(radius, self.effective_modulus, self.work_of_adhesion)
    }
}

/// Adhesion force √(8π a³ E* γ), N, of a flat punch of radius a (m) (Kendall).
pub fn flat_punch(radius: f64, effective_modulus: f64, work_of_adhesion: f64) -> f64 {
    (8.0 * PI * radius.powi(3) * effective_modulus * work_of_adhesion).sqrt()
}

/// Adhesion force, N, in closed form, of a smooth body with this form (`None`: flat) and apparent diameter `length` (m),
/// after a preload (N), for works of adhesion on closing and on opening (J/m²). `None` where there is no closed form: for
/// waves and tables, for a body whose contact at pull-off is longer than the profile, and for a preload that does not press
/// it beyond that contact.
pub fn smooth_adhesion_force(
    form: Option<&Form>,
    length: f64,
    effective_modulus: f64,
    [closing, work]: [f64; 2],
    preload: f64,
) -> Option<f64> {
    let flat = ideal_adhesion_force(work, effective_modulus, length);
    let Some(form) = form else { return Some(flat) };
    if let Some(radius) = form.flat_end() {
        return Some(flat_punch(radius, effective_modulus, work).min(flat));
    }
    let body = PowerLaw::of(form, effective_modulus, work)?;
    let (radius, force) = body.force_controlled_pull_off();
    let pressed = PowerLaw { work_of_adhesion: closing, ..body }.force(radius);
    Some(-force).filter(|_| radius <= 0.5 * length && pressed <= preload)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_paraboloid_is_jkr() {
        let (radius, modulus, work) = (2.0e-3, 1.5e6, 0.07);
        let body = PowerLaw::of(&Form::Paraboloid { radius }, modulus, work).unwrap();
        let scale = PI * work * radius;
        assert!((body.force_controlled_pull_off().1 / (-1.5 * scale) - 1.0).abs() < 1e-14);
        assert!((body.displacement_controlled_pull_off().1 / (-5.0 / 6.0 * scale) - 1.0).abs() < 1e-14);
    }

    #[test]
    fn pull_off_radii_are_where_the_derivatives_vanish() {
        for form in [
            Form::Cone { angle: 0.3 },
            Form::Power { coefficient: 2.0, exponent: 1.5 },
            Form::Power { coefficient: 0.7, exponent: 4.0 },
        ] {
            let body = PowerLaw::of(&form, 3.0, 0.5).unwrap();
            let (a, force) = body.force_controlled_pull_off();
            assert!((body.force(a) / force - 1.0).abs() < 1e-12);
            assert!(body.force(a * 1.001) > force && body.force(a * 0.999) > force);
            let (a, force) = body.displacement_controlled_pull_off();
            assert!((body.force(a) / force - 1.0).abs() < 1e-12);
            let d = body.indentation(a);
            assert!(body.indentation(a * 1.001) > d && body.indentation(a * 0.999) > d);
        }
    }
}
