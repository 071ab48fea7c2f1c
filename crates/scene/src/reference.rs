//! Closed forms: exact formulas for the contact of a form without roughness.

use asperity_contact::ClosedForm;
use asperity_surface::Form;

/// Returns the closed-form solution for the adhesive contact of a form that is a power law:
/// paraboloid, cone or power. The effective modulus is in Pa, the work of adhesion in J/m². Returns
/// `None` for all other forms, such as punches, wavy spheres and tables.
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
pub fn closed_form(form: &Form, modulus: f64, work_of_adhesion: f64) -> Option<ClosedForm> {
    let (line_coefficient, exponent) = form.power_law()?;
    Some(ClosedForm {
        line_coefficient,
        exponent,
        modulus,
        work_of_adhesion,
    })
}

/// Returns the pull-off force in N of a smooth body after a preload in N, by a formula.
///
/// `form` is `None` for a flat body. `length` is the apparent diameter in m. `works_of_adhesion`
/// are the works on closing and on opening in J/m². Returns `None` in three cases:
///
/// * the form is a wavy sphere or a table;
/// * the contact at pull-off is longer than the profile;
/// * the preload is so small that the contact after the loading is smaller than the contact at
///   pull-off.
pub fn smooth_pull_off_force(
    form: Option<&Form>,
    length: f64,
    modulus: f64,
    works_of_adhesion: [f64; 2],
    preload: f64,
) -> Option<f64> {
    let [closing, work] = works_of_adhesion;
    let flat = ClosedForm::ideal_pull_off_force(work, modulus, length);
    let Some(form) = form else { return Some(flat) };
    if let Some(radius) = form.flat_end() {
        return Some(ClosedForm::flat_punch(radius, modulus, work).min(flat));
    }
    let body = closed_form(form, modulus, work)?;
    let (radius, force) = body.force_controlled_pull_off();
    let closing_body = ClosedForm {
        work_of_adhesion: closing,
        ..body
    };
    let is_inside = radius <= 0.5 * length;
    (is_inside && closing_body.force(radius) <= preload).then_some(-force)
}
