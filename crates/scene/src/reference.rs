//! Closed forms of the contact of a form without roughness, where there are any.

use asperity_contact::closed_forms::{ClosedForm, flat_punch, ideal_adhesion_force};
use asperity_surface::Form;

/// The closed form of the contact of a form, for an effective modulus (Pa) and a work of adhesion (J/m²), if its profile is a
/// power law; `None` for punches, waves and tables.
///
/// ```
/// use asperity_scene::theory::closed_form;
/// use asperity_surface::Form;
///
/// let sphere = closed_form(&Form::Paraboloid { radius: 1.0e-4 }, 1.0e6, 0.05).unwrap();
/// let jkr = 1.5 * std::f64::consts::PI * 0.05 * 1.0e-4;
/// assert!((sphere.force_controlled_pull_off().1 / -jkr - 1.0).abs() < 1e-14);
/// assert!(closed_form(&Form::Punch { radius: 1.0e-5 }, 1.0e6, 0.05).is_none());
/// ```
pub fn closed_form(form: &Form, effective_modulus: f64, work_of_adhesion: f64) -> Option<ClosedForm> {
    let (line_coefficient, exponent) = form.power_law()?;
    Some(ClosedForm { line_coefficient, exponent, effective_modulus, work_of_adhesion })
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
    let body = closed_form(form, effective_modulus, work)?;
    let (radius, force) = body.force_controlled_pull_off();
    let pressed = ClosedForm { work_of_adhesion: closing, ..body }.force(radius);
    Some(-force).filter(|_| radius <= 0.5 * length && pressed <= preload)
}
