//! Cases with laws that hold for every body: reversible loading without adhesion, memory of turning
//! points, balance of energy, scaling, and agreement between the exact and the stepwise solver.

use super::case::Subject::{Bodies, Scene as OfScene};
use super::case::{
    Body, Case, INDEPENDENT, Measured, SELF_CONSISTENCY, both, ensure, largest, outcome, with,
};
use asperity_contact::{CurvePoint, Cycle, Edges, StageRecord};
use asperity_scene::{CheckedScene, Solver};

const LAW: [&str; 2] = ["laws", SELF_CONSISTENCY];
const COMPUTED: [&str; 2] = ["laws", INDEPENDENT];
const FORCE: &str = "force, over the scale";

const ROUGH: &str = "(version: 1, material: (modulus: 2.0e6), length: 1.0e-4,
    roughness: SelfAffine(hurst: 0.7, rms_height: 1.0e-7, modes: (1, 128), seed: 1), adhesion: (work: 2.0e-5),
    loading: [ToTouch, ToIndentation(1.9e-7), ToIndentation(0.43e-7), ToIndentation(1.1e-7), ToIndentation(3.1e-7),
    ToIndentation(-0.2e-7)], numerics: (points: 400, samples: 9), observe: [Patches])";

#[rustfmt::skip]
pub const CASES: &[Case] = &[
    Case::row(LAW, ["no-adhesion", "At γ = 0 unloading retraces loading bit for bit, and no energy is dissipated.",
        "force, over the largest"], &both(0.0, 0.0), Bodies(no_adhesion)),
    Case::row(LAW, ["return-point-memory", "A minor loop closes to the last bit, and a deeper load erases the memory of \
        earlier turning points.", FORCE], &both(0.0, 0.0), Bodies(memory)),
    Case::row(LAW, ["no-energy-for-nothing", "No closed loop gains energy, and the energy dissipated from separation to \
        separation is ∮F dd.", "energy, over the scale"], &both(1e-4, 1e-4), Bodies(energy)),
    Case::row(LAW, ["lengths-and-moduli", "Lengths from 2 nm to 6.6 m and E* from 2 Pa to 8.4 TPa, all else scaled \
        alike, change no bit of contact and forces.", FORCE], &both(0.0, 0.0), Bodies(units)),
    Case::row(COMPUTED, ["stepwise-solver", "On profiles from bare to sticky the stepwise solver, which applies the \
        rules spring by spring, comes to the same contact and forces.", FORCE],
        &[(Edges::Grid, 1e-15)], OfScene(ROUGH, stepwise)),
];

pub fn end(stage: &StageRecord) -> CurvePoint {
    stage.curve.last().copied().unwrap_or_default()
}

/// Loads and unloads a body without adhesion, and returns the largest difference between the forces
/// of loading and unloading, divided by the largest force. The law is that no energy is released,
/// and that the unloading passes through the same contacts as the loading.
fn no_adhesion(body: &Body) -> Measured {
    let cycle = Body {
        work: 0.0,
        ..body.clone()
    }
    .load(&[0.8 * body.depth()], true, 301)?;
    let [loading, unloading] = cycle.stages() else {
        return Ok(f64::NAN);
    };
    let is_lossless = cycle
        .stages()
        .iter()
        .all(|stage| stage.released_energy == 0.0);
    ensure(is_lossless, || "energy is lost".into())?;
    ensure(loading.curve.len() == unloading.curve.len(), || {
        "other points on the way back".into()
    })?;
    largest(
        loading
            .curve
            .iter()
            .zip(unloading.curve.iter().rev())
            .map(|(pressed, pulled)| {
                let is_same = pressed.indentation.to_bits() == pulled.indentation.to_bits()
                    && pressed.springs == pulled.springs
                    && pressed.patches == pulled.patches;
                ensure(is_same, || {
                    format!("at {:e} m another contact", pressed.indentation)
                })?;
                Ok((pressed.force - pulled.force).abs() / loading.largest.force)
            }),
    )
}

fn memory(body: &Body) -> Measured {
    let mut turns: [f64; 3] = body.turns(10);
    turns.sort_by(f64::total_cmp);
    let [low, middle, high] = turns;
    let pairs: [(&[f64], &[f64]); 3] = [
        (&[high], &[middle, low, middle, high]),
        (&[high, low], &[high, low, middle, low]),
        (
            &[high, low, middle],
            &[high, middle, high, low, middle, low, middle],
        ),
    ];
    largest(pairs.map(|(short, long)| {
        let after_short = body.load(short, false, 2)?;
        let after_long = body.load(long, false, 2)?;
        ensure(after_short.patches() == after_long.patches(), || {
            format!("{long:?} leaves another contact")
        })?;
        Ok((last_force(&after_short) - last_force(&after_long)).abs() / body.force_unit())
    }))
}

/// Returns the force in N at the end of a loading.
fn last_force(cycle: &Cycle) -> f64 {
    match cycle.stages().last() {
        Some(stage) => end(stage).force,
        None => f64::NAN,
    }
}

/// Returns the energy in J that several stages release.
fn released(stages: &[StageRecord]) -> f64 {
    stages.iter().map(|stage| stage.released_energy).sum()
}

fn energy(body: &Body) -> Measured {
    let scale = body.force_unit() * (body.depth() + body.stretch());
    let [a, b] = body.turns(12);
    let low = a.min(b);
    let high = a.max(b).max(0.0);
    let of_loop = released(&body.load(&[high, low, high], false, 2)?.stages()[1..]);
    ensure(of_loop >= -1e-14 * scale, || {
        format!("a loop from {high:e} to {low:e} m gains {:e} J", -of_loop)
    })?;
    let cycle = body.load(&[high, low, high], true, 20_000)?;
    // A jump of the force may lie anywhere between two points of the curve. The error of the work,
    // computed by the trapezoidal rule, therefore decreases with the number of points.
    let mut done = -0.0;
    for stage in cycle.stages() {
        for pair in stage.curve.windows(2) {
            let [before, after] = [pair[0], pair[1]];
            done += 0.5 * (before.force + after.force) * (after.indentation - before.indentation);
        }
    }
    Ok((released(cycle.stages()) - done).abs() / scale)
}

/// Measures whether a body and its scaled copies have the same loading, apart from the scale. In a
/// copy, lengths along the profile, heights and stresses are multiplied by powers of two. Each
/// element of `powers` has the three exponents of one copy. All results must then change by powers
/// of two only, so that no bit of a mantissa changes.
pub fn only_scales(body: &Body, powers: &[[i32; 3]]) -> Measured {
    let turns: [f64; 6] = body.turns(15);
    let original = body.load(&turns, false, 33)?;
    for factors in powers {
        let [length, height, stress] = factors.map(|power| 2.0_f64.powi(power));
        let scaled = Body {
            heights: body.heights.iter().map(|point| height * point).collect(),
            length: length * body.length,
            modulus: stress * body.modulus,
            // The square of the largest stretch, Δl² = πℓγ/E*, is proportional to the work γ, so γ
            // is scaled with the square of the factor of heights. The factors are multiplied one
            // after another, because the square alone may overflow or underflow.
            work: height * (height * body.work) * (stress / length),
            edges: body.edges,
        };
        let cycle = scaled.load(&turns.map(|turn| height * turn), false, 33)?;
        let is_same = bits(&original, height, length * height * stress) == bits(&cycle, 1.0, 1.0);
        ensure(is_same, || {
            format!("2 to the powers {factors:?}: other bits")
        })?;
    }
    Ok(0.0)
}

/// Returns the bits of all points and released energies, after multiplication by the factors
/// `height` and `force`, and the number of springs in contact. Adding 0 turns −0 into 0.
fn bits(cycle: &Cycle, height: f64, force: f64) -> Vec<([u64; 2], u64)> {
    let mut bits = Vec::new();
    for point in cycle.points() {
        let values = [point.indentation * height, point.force * force];
        bits.push((values.map(|value| (value + 0.0).to_bits()), point.springs));
    }
    for stage in cycle.stages() {
        let energy = stage.released_energy * force * height;
        bits.push(([(energy + 0.0).to_bits(), 0], stage.detached));
    }
    bits
}

fn units(body: &Body) -> Measured {
    only_scales(
        body,
        &[
            [-15, 0, 0],
            [16, 0, 0],
            [-15, -15, 0],
            [16, 16, 0],
            [0, 0, -20],
            [0, 0, 22],
            [7, -9, 5],
        ],
    )
}

/// Computes a scene with several works of adhesion and Hurst exponents by both solvers, exact and
/// stepwise. Returns the largest difference between their forces, divided by E* times length times
/// largest gap.
fn stepwise(scene: &CheckedScene) -> Measured {
    largest(
        [0.0, 1e-8, 1e-7, 1e-6, 5e-6, 2e-5, 1e-4, 1e-3]
            .into_iter()
            .zip(1..)
            .map(|(work, tenths)| {
                let scene = with(
                    &with(scene, "adhesion.work", work)?,
                    "roughness.hurst",
                    0.1 * f64::from(tenths),
                )?;
                let exact = outcome(&scene)?;
                let steps =
                    outcome(&scene.with(|scene| {
                        scene.numerics.solver = Solver::Stepwise { step: 1.0e-8 }
                    })?)?;
                ensure(exact.patches == steps.patches, || {
                    format!("γ = {work:e} J/m²: another contact")
                })?;
                let unit = exact.governing.modulus * scene.length * exact.line.deepest;
                let stages = exact.history.stages.iter().zip(&steps.history.stages);
                largest(
                    stages.map(|(first, second)| {
                        Ok((end(first).force - end(second).force).abs() / unit)
                    }),
                )
            }),
    )
}
