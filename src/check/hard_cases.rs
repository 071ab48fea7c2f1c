//! Input at the limits: far too much adhesion, ties, heights of any size, loads far beyond the
//! roughness, and very many springs.

use super::case::Subject::{Bodies, Scene as OfScene};
use super::case::{
    Body, CLOSED_FORM, Case, Measured, SELF_CONSISTENCY, both, ensure, largest, outcome, relative_error,
    relative_errors, with,
};
use super::laws::{end, only_scales};
use crate::scene::{CheckedScene, Edges, Move};
use crate::simulation::Outcome;
use crate::surface::phases;
use std::f64::consts::PI;

const KNOWN: [&str; 2] = ["hard-cases", CLOSED_FORM];
const LAW: [&str; 2] = ["hard-cases", SELF_CONSISTENCY];
const PULL_OFF: &str = "force and place of pull-off";
const ROUNDINGS: &str = "force, over the effect of a rounding of the indentation";

const STICKY: &str = "(version: 1, material: (effective_modulus: 2.0e6), length: 1.0e-4,
    roughness: SelfAffine(hurst: 0.7, rms_height: 1.0e-12, modes: (1, 1), seed: 1),
    adhesion: (work: 0.05), loading: [ToTouch, ToSeparation], numerics: (samples: 9))";
const PLAIN: &str =
    "(version: 1, material: (effective_modulus: 2.0e6), length: 1.0e-4, adhesion: (work: 2.0e-5))";
const ROUGH: &str = "(version: 1, material: (effective_modulus: 2.0e6), length: 1.0e-4,
    roughness: SelfAffine(hurst: 0.7, rms_height: 1.0e-25, modes: (1, 128), seed: 1),
    adhesion: (work: 1.0e-41), numerics: (points: 257, samples: 17))";
const MANY: &str = "(version: 1, material: (effective_modulus: 2.0e6), length: 1.0e-4,
    roughness: SelfAffine(hurst: 0.7, rms_height: 1.0e-7, modes: (1, 8388607), seed: 7), adhesion: (work: 2.0e-5),
    loading: [ToIndentation(1.0e-6), ToSeparation], numerics: (points: 16777216, samples: 33))";

#[rustfmt::skip]
pub const CASES: &[Case] = &[
    Case::row(KNOWN, ["everything-sticks", "Adhesion far beyond the roughness closes the whole profile at first touch \
        and opens it at once, at the threshold of the deepest spring.", PULL_OFF],
        &both(2e-15, 2e-15), OfScene(STICKY, everything_sticks)),
    Case::row(KNOWN, ["equal-teeth", "Ties: 16 equal flat teeth of 8 springs between deep valleys detach at once, at 16 \
        times Kendall's force.", PULL_OFF], &both(2e-15, 2e-15), OfScene(PLAIN, equal_teeth)),
    Case::row(LAW, ["near-ties", "Profiles, plateaus among them, whose heights are changed by roundings carry the same \
        forces, up to loads a hundred times their depth.", "force, over the scale"], &both(1e-15, 1e-15), Bodies(near_ties)),
    Case::row(LAW, ["heights-1e-263-to-1e5-m", "Heights from 1e−127 to 1 m with adhesion, and from 1e−263 to 1e5 m \
        without, only scale, to the last bit.", "force, over the scale"], &both(0.0, 0.0), Bodies(heights_of_any_size)),
    Case::row(KNOWN, ["far-loads", "Pressed by 1 to 1e20 times its depth, to an indentation or to a force, \
        a rough profile is wholly in contact and carries E*L(d − c̄) over its mean gap c̄.", ROUNDINGS],
        &both(4.0, 4.0), OfScene(ROUGH, far_loads)),
    Case { large: true, ..Case::row(KNOWN, ["springs-2^24", "2^24 springs with half as many modes carry E*L(d − c̄) in \
        full contact, and all springs that attach detach again.", "force"],
        &both(1e-14, 1e-14), OfScene(MANY, very_many_springs)) },
];

/// Returns the force on a rough flat face in full contact, N: cosines have the mean 0, so the mean gap is the height of
/// the summit.
fn full_contact(outcome: &Outcome, indentation: f64) -> f64 {
    outcome.governing.effective_modulus * outcome.line.length * (indentation - outcome.line.summit)
}

fn everything_sticks(scene: &CheckedScene) -> Measured {
    let cases =
        [3, 10, 999].into_iter().flat_map(|points| [1e-12, 1e-16, 1e-23].map(|height| (points, height)));
    largest(cases.map(|(points, height)| {
        let scene = with(scene, "roughness.rms_height", height)?;
        let scene = scene.with(|scene| scene.numerics.points = points)?;
        let outcome = outcome(&scene)?;
        let [touch, last] = &outcome.history.legs[..] else { return Ok(f64::NAN) };
        let held = [touch.attached, last.smallest.springs];
        ensure(held == [points; 2], || format!("{held:?} of {points} springs"))?;
        let (modulus, work) = (outcome.governing.effective_modulus, outcome.governing.adhesive_work());
        let place = outcome.line.deepest - (PI * scene.length * work.unwrap_or(0.0) / modulus).sqrt();
        let force = full_contact(&outcome, place);
        relative_errors([
            (last.smallest.force, force),
            (last.smallest.indentation, place),
            (last.end(), place),
        ])
    }))
}

fn equal_teeth(scene: &CheckedScene) -> Measured {
    let (teeth, springs) = (16.0, 8);
    let heights = (0..33 * springs).map(|index| if index / springs % 2 == 1 { 0.0 } else { -1.0e-6 });
    let (length, edges) = (scene.length, scene.numerics.edges);
    let body = Body { heights: heights.collect(), length, modulus: 2.0e6, work: 2.0e-5, edges };
    let cycle = body.load(&[1.0e-9], true, 9)?;
    let last = &cycle.legs()[1];
    // Edges between springs have come down to the last springs of the teeth, half a cell inside of whole cells.
    let cells = if body.edges == Edges::Grid { springs } else { springs - 1 };
    let width = cells as f64 * (body.length / body.heights.len() as f64);
    let place = -(PI * width * body.work / body.modulus).sqrt();
    ensure(last.smallest.fragments == 16, || format!("{:?}", last.smallest))?;
    relative_errors([(last.smallest.force, teeth * body.modulus * width * place), (last.end(), place)])
}

fn near_ties(body: &Body) -> Measured {
    // A few units in the last place of each height.
    let jitter = |(height, phase): (&f64, f64)| height * (1.0 + f64::EPSILON * (phase - PI).round());
    let near = Body { heights: body.heights.iter().zip(phases(9, 1)).map(jitter).collect(), ..body.clone() };
    largest([0.0, 0.01, 1.0].map(|share| {
        let [one, other] = [body, &near].map(|body| Body { work: share * body.work, ..body.clone() });
        let far = [1.037, 100.0].map(|share| share * (body.depth() + body.stretch()));
        let turns = [&far[..], &body.turns::<8>(16)].concat();
        let (exact, near) = (one.load(&turns, false, 2)?, other.load(&turns, false, 2)?);
        largest(exact.legs().iter().zip(near.legs()).map(|(a, b)| {
            let [a, b] = [a, b].map(|leg| end(leg).force);
            Ok((a - b).abs() / (body.force_unit() + a.abs()))
        }))
    }))
}

fn heights_of_any_size(body: &Body) -> Measured {
    let of = |powers: [i32; 4]| powers.map(|power| [0, power, 0]);
    // A modulus of 1 Pa keeps γ within its range.
    only_scales(&Body { modulus: 1.0, work: 0.5e-6 * body.work, ..body.clone() }, &of([-400, -200, 10, 23]))?;
    only_scales(&Body { work: 0.0, ..body.clone() }, &of([-850, -500, 20, 39]))
}

/// Presses a scene to indentations and by the forces found there; returns the largest error of a force over its change
/// by one rounding of the indentation.
fn far_loads(scene: &CheckedScene) -> Measured {
    let (depth, bare) = (outcome(scene)?.line.deepest, with(scene, "adhesion.work", 0.0)?);
    largest((0..=20).flat_map(|power| [scene, &bare].map(|scene| (scene, 10.0_f64.powi(power) * depth))).map(
        |(scene, load)| {
            let pressed = |target| outcome(&scene.with(|scene| scene.loading = vec![target])?);
            let there = pressed(Move::ToIndentation(load))?;
            let (expected, there) = (full_contact(&there, load), end(&there.history.legs[0]));
            let again = end(&pressed(Move::ToForce(there.force))?.history.legs[0]);
            let is_whole = relative_error(there.contact_length, scene.length) <= 2.0 * f64::EPSILON;
            ensure(is_whole, || format!("{:e} m in contact at {load:e} m", there.contact_length))?;
            let stiffness = scene.material.effective_modulus() * scene.length;
            let rounding = stiffness * (load - load.next_down()) + f64::EPSILON * there.force;
            let errors = [there.force - expected, again.force - there.force];
            largest(errors.map(|error| Ok(error.abs() / rounding)))
        },
    ))
}

fn very_many_springs(scene: &CheckedScene) -> Measured {
    let outcome = outcome(scene)?;
    let [loading, unloading] = &outcome.history.legs[..] else { return Ok(f64::NAN) };
    let counts = [loading.attached, unloading.detached];
    ensure(counts == [scene.numerics.points; 2], || format!("{counts:?} springs attached and detached"))?;
    ensure(unloading.smallest.force < 0.0, || "it does not stick".into())?;
    Ok(relative_error(loading.largest.force, full_contact(&outcome, loading.end())))
}
