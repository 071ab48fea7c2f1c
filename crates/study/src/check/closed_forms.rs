//! Cases of the catalogue of checks in which the force curve is known in closed form.

use super::case::Subject::Scene as OfScene;
use super::case::{CLOSED_FORM, Case, Measured, both, largest, outcome, relative_errors};
use asperity_contact::ClosedForm;
use asperity_scene::CheckedScene;
use asperity_scene::theory::closed_form;
use asperity_surface::Form;
use std::f64::consts::PI;

const KNOWN: [&str; 2] = ["closed-forms", CLOSED_FORM];
const PULL_OFF: &str = "force and place of pull-off";

const HERTZ: &str =
    "(version: 1, material: (modulus: 1.0), length: 4.0, form: Paraboloid(radius: 1.0),
    loading: [ToIndentation(1.0)], numerics: (points: 4001, samples: 257))";
const SPHERE: &str =
    "(version: 1, material: (modulus: 1.0), length: 6.0, form: Paraboloid(radius: 0.5),
    adhesion: (work: 0.5), loading: [ToIndentation(0.75), ToSeparation], numerics: (points: 4001))";
const CONE: &str = "(version: 1, material: (modulus: 1.0), length: 8.0, form: Cone(angle: 1.0),
    adhesion: (work: 0.5), loading: [ToIndentation(2.0), ToSeparation], numerics: (points: 4001))";
const FLAT: &str =
    "(version: 1, material: (modulus: 2.0e6), length: 1.0e-4, adhesion: (work: 2.0e-5),
    loading: [ToIndentation(1.0e-7), ToSeparation], numerics: (samples: 9))";
const PUNCH: &str =
    "(version: 1, material: (modulus: 2.0e6), length: 1.0e-4, form: Punch(radius: 2.0e-5),
    adhesion: (work: 0.05), loading: [ToIndentation(1.0e-7), ToSeparation], numerics: (samples: 9))";

#[rustfmt::skip]
pub const CASES: &[Case] = &[
    Case::row(KNOWN, ["hertz-sphere", "Without adhesion 4001 springs press a sphere by Hertz.",
        "force, over the largest"], &both(2e-6, 2e-6), OfScene(HERTZ, hertz)),
    Case::row(KNOWN, ["jkr-sphere", "4001 springs pull a sphere off at (3/2)πγR and detach at the indentation of \
        Johnson, Kendall and Roberts.", PULL_OFF], &both(1e-2, 1e-5), OfScene(SPHERE, pull_off)),
    Case::row(KNOWN, ["cone", "4001 springs pull a cone off at the force and the indentation of the closed form.",
        PULL_OFF], &both(1e-2, 1e-5), OfScene(CONE, pull_off)),
    Case::row(KNOWN, ["flat-line", "5 to 100 000 springs of a flat profile attach and detach at once, at the ideal \
        pull-off force √(πγE*L³).", "force, indentation, energy"], &both(2e-15, 2e-15), OfScene(FLAT, flat)),
    Case::row(KNOWN, ["flat-punch", "A flat punch of whole cells attaches and detaches at once, at Kendall's force \
        √(8πa³E*γ).", "force, indentation, energy"], &both(2e-15, 2e-15), OfScene(PUNCH, flat)),
];

fn power_law(scene: &CheckedScene) -> Measured<ClosedForm> {
    let work = scene
        .adhesion
        .and_then(|adhesion| adhesion.work())
        .unwrap_or(0.0);
    let modulus = scene.material.modulus_in_pascals();
    let closed = scene
        .form
        .as_ref()
        .and_then(|form| closed_form(form, modulus, work));
    Ok(closed.ok_or("no closed form")?)
}

fn hertz(scene: &CheckedScene) -> Measured {
    let closed = power_law(scene)?;
    let outcome = outcome(scene)?;
    let force = |d: f64| closed.force((d / closed.line_coefficient).powf(closed.exponent.recip()));
    let stage = &outcome.history.stages[0];
    let errors = stage
        .curve
        .iter()
        .map(|point| (point.force - force(point.indentation)).abs());
    Ok(errors.fold(0.0, f64::max) / force(stage.end()))
}

fn pull_off(scene: &CheckedScene) -> Measured {
    let closed = power_law(scene)?;
    let outcome = outcome(scene)?;
    let unloading = &outcome.history.stages[1];
    let place = closed.indentation(closed.displacement_controlled_pull_off().0);
    let force = closed.force_controlled_pull_off().1;
    relative_errors([(unloading.smallest.force, force), (unloading.end(), place)])
}

fn flat(scene: &CheckedScene) -> Measured {
    let width = scene
        .form
        .as_ref()
        .and_then(Form::flat_end)
        .map_or(scene.length, |radius| 2.0 * radius);
    largest([5, 1000, 100_000].map(|points| {
        let outcome = outcome(&scene.with(|scene| scene.numerics.points = points)?)?;
        let stiffness = outcome.governing.modulus * width;
        let work = outcome.governing.adhesive_work().unwrap_or(0.0);
        let place = -(PI * width * work / outcome.governing.modulus).sqrt();
        let [loading, unloading] = &outcome.history.stages[..] else {
            return Ok(f64::NAN);
        };
        relative_errors([
            (loading.largest.force, stiffness * loading.end()),
            (unloading.smallest.force, stiffness * place),
            (unloading.smallest.indentation, place),
            (unloading.end(), place),
            (
                outcome.figures.dissipated_energy.unwrap_or(0.0),
                0.5 * stiffness * place * place,
            ),
        ])
    }))
}
