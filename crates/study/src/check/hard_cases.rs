//! Cases at the limits of numbers: nearly equal gaps, heights of any magnitude, and loads far
//! beyond the roughness.

use super::case::Subject::{Bodies, Scene as OfScene};
use super::case::{
    Body, CLOSED_FORM, Case, Measured, SELF_CONSISTENCY, both, ensure, largest, outcome,
    relative_error, with,
};
use super::laws::{end, only_scales};
use asperity_contact::Move;
use asperity_scene::{CheckedScene, Outcome};
use asperity_surface::lines::phases;
use std::f64::consts::PI;

const KNOWN: [&str; 2] = ["hard-cases", CLOSED_FORM];
const LAW: [&str; 2] = ["hard-cases", SELF_CONSISTENCY];
const ROUNDINGS: &str = "force, over the effect of a rounding of the indentation";

const ROUGH: &str = "(version: 1, material: (modulus: 2.0e6), length: 1.0e-4,
    roughness: SelfAffine(hurst: 0.7, rms_height: 1.0e-25, modes: (1, 128), seed: 1),
    adhesion: (work: 1.0e-41), numerics: (points: 257, samples: 17))";
#[rustfmt::skip]
pub const CASES: &[Case] = &[
    Case::row(LAW, ["near-ties", "Profiles, plateaus among them, whose heights are changed by roundings carry the same \
        forces, up to loads a hundred times their depth.", "force, over the scale"], &both(1e-15, 1e-15), Bodies(near_ties)),
    Case::row(LAW, ["heights-1e-263-to-1e5-m", "Heights from 1e−127 to 1 m with adhesion, and from 1e−263 to 1e5 m \
        without, only scale, to the last bit.", "force, over the scale"], &both(0.0, 0.0), Bodies(heights_of_any_size)),
    Case::row(KNOWN, ["far-loads", "Pressed by 1 to 1e20 times its depth, to an indentation or to a force, \
        a rough profile is wholly in contact and carries E*L(d − c̄) over its mean gap c̄.", ROUNDINGS],
        &both(4.0, 4.0), OfScene(ROUGH, far_loads)),
];

/// Returns the force in N on a rough flat body in full contact at this indentation in m, from a
/// closed form. The roughness is a sum of cosines with the mean 0, so the mean gap at first touch
/// equals the height of the highest point.
fn full_contact(outcome: &Outcome, indentation: f64) -> f64 {
    outcome.governing.modulus * outcome.line.length * (indentation - outcome.line.summit)
}

fn near_ties(body: &Body) -> Measured {
    // Each height is changed by a few units in the last place. Heights that were equal are then
    // nearly equal.
    let jitter =
        |(height, phase): (&f64, f64)| height * (1.0 + f64::EPSILON * (phase - PI).round());
    let near = Body {
        heights: body.heights.iter().zip(phases(9, 1)).map(jitter).collect(),
        ..body.clone()
    };
    largest([0.0, 0.01, 1.0].map(|share| {
        let [exact_body, near_body] = [body, &near].map(|body| Body {
            work: share * body.work,
            ..body.clone()
        });
        let far = [1.037, 100.0].map(|share| share * (body.depth() + body.stretch()));
        let turns = [&far[..], &body.turns::<8>(16)].concat();
        let exact = exact_body.load(&turns, false, 2)?;
        let near = near_body.load(&turns, false, 2)?;
        let stages = exact.stages().iter().zip(near.stages());
        largest(stages.map(|(exact, near)| {
            let force = end(exact).force;
            Ok((force - end(near).force).abs() / (body.force_unit() + force.abs()))
        }))
    }))
}

fn heights_of_any_size(body: &Body) -> Measured {
    // The modulus is 1 Pa, so that the work of adhesion γ remains within its allowed range for all
    // factors.
    only_scales(
        &Body {
            modulus: 1.0,
            work: 0.5e-6 * body.work,
            ..body.clone()
        },
        &[-400, -200, 10, 23].map(|power| [0, power, 0]),
    )?;
    only_scales(
        &Body {
            work: 0.0,
            ..body.clone()
        },
        &[-850, -500, 20, 39].map(|power| [0, power, 0]),
    )
}

/// Presses the body of a scene to large indentations, and then to the forces found there. Returns
/// the largest error of a force, divided by the change of the force due to one rounding of the
/// indentation.
fn far_loads(scene: &CheckedScene) -> Measured {
    let depth = outcome(scene)?.line.deepest;
    let bare = with(scene, "adhesion.work", 0.0)?;
    let mut errors = Vec::new();
    for power in 0..=20 {
        let load = 10.0_f64.powi(power) * depth;
        errors.push(far_load(scene, load));
        errors.push(far_load(&bare, load));
    }
    largest(errors)
}

fn far_load(scene: &CheckedScene, load: f64) -> Measured {
    let outcome = pressed(scene, Move::ToIndentation(load))?;
    let expected = full_contact(&outcome, load);
    let there = end(&outcome.history.stages[0]);
    let again = end(&pressed(scene, Move::ToForce(there.force))?.history.stages[0]);
    let is_whole = relative_error(there.contact_length, scene.length) <= 2.0 * f64::EPSILON;
    ensure(is_whole, || {
        format!("{:e} m in contact at {load:e} m", there.contact_length)
    })?;
    let stiffness = scene.material.modulus_in_pascals() * scene.length;
    let rounding = stiffness * (load - load.next_down()) + f64::EPSILON * there.force;
    let errors = [there.force - expected, again.force - there.force];
    largest(errors.map(|error| Ok(error.abs() / rounding)))
}

fn pressed(scene: &CheckedScene, target: Move) -> Measured<Outcome> {
    outcome(&scene.with(|scene| scene.loading = vec![target])?)
}
