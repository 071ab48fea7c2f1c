//! Units and sizes: results scale with their units, up to the limits of floating-point numbers.

use super::{Body, RULES, WORK, ensure, largest, on_tour, points, press_and_pull, rough, same_bits};
use crate::check::case::{CASE, Case, Evidence, Scope};
use crate::check::{Fault, LENGTH, RMS_HEIGHT, end};
use crate::contact::{Foundation, History};
use crate::scene::{Adhesion, Document, Edges, Move, Roughness, Scene};
use crate::simulation::Simulation;

pub const CASES: &[Case] = &[
    Case {
        name: "modulus-1-pa-to-10-tpa",
        holds: "E* and γ scaled alike, from 1 Pa to 8.8 TPa, change no bit of contact and forces; at 1 Pa and \
                10 TPa with the same γ both follow the rules.",
        evidence: &[Evidence::IndependentComputation, Evidence::SelfConsistency],
        measure: modulus,
        ..RULES
    },
    Case {
        name: "lengths-nm-to-m",
        holds: "A scene from 1 nm to 8.6 m long, all lengths scaled, gives one result bit for bit; made anew at \
                1 nm, 1 µm, 1 mm and 10 m, contact and forces follow the rules.",
        evidence: &[Evidence::IndependentComputation, Evidence::SelfConsistency],
        measure: lengths,
        ..RULES
    },
    Case {
        name: "heights-1e-15-to-10-lengths",
        holds: "A scene with an rms height from 1e−15 to 8 lengths, γ with its square, is one scene to the last \
                bit; at one γ contact and forces follow the rules for all of them.",
        evidence: &[Evidence::IndependentComputation, Evidence::SelfConsistency],
        measure: heights,
        ..RULES
    },
    Case {
        name: "subnormal-gaps",
        holds: "Heights down to subnormal numbers give finite, ordered curves, forces within 2⁻¹⁰⁰⁰ m for each \
                spring, and to 2⁻⁴⁰⁰ the same bits.",
        evidence: &[Evidence::SelfConsistency],
        error_of: "force, over n Δk 2⁻¹⁰⁰⁰ m",
        scope: Scope::BothEdges(1.0, 1.0),
        measure: subnormal,
        ..CASE
    },
    Case {
        name: "near-overflow",
        holds: "Heights up to 1e294 m only scale, to the last bit; with adhesion up to 1e128 m.",
        evidence: &[Evidence::SelfConsistency],
        error_of: "force",
        scope: Scope::BothEdges(0.0, 0.0),
        measure: near_overflow,
        ..CASE
    },
];

/// A scene of 1 nm under a stiffness of 1 Pa, its loading in natural units of length and force.
fn scene(edges: Edges) -> Result<Scene, Fault> {
    let text = "(version: 1, material: (effective_modulus: 1.0), length: 1.0e-9,
        roughness: SelfAffine(hurst: 0.7, rms_height: 1.0e-12, modes: (1, 128), seed: 3),
        adhesion: (work: 1.0e-14),
        loading: [ToIndentation(2.0e-12), ToIndentation(1.0e-12), ToForce(2.0e-21), ToZeroForce, ToSeparation],
        numerics: (points: 512, samples: 65))";
    let mut scene = Document::parse(text, "check")?.scene().clone();
    scene.numerics.edges = edges;
    Ok(scene)
}

/// The scene with lengths along the profile, heights and stresses multiplied, and γ adapted to them.
fn scaled(scene: &Scene, length: f64, height: f64, stress: f64) -> Scene {
    let mut scene = scene.clone();
    scene.length *= length;
    if let Some(modulus) = &mut scene.material.effective_modulus {
        *modulus *= stress;
    }
    if let Some(Roughness::SelfAffine { rms_height: Some(rms_height), .. }) = &mut scene.roughness {
        *rms_height *= height;
    }
    // Δl² = π ℓ γ/E* must scale with the square of heights.
    if let Some(Adhesion { work: Some(work), .. }) = &mut scene.adhesion {
        *work *= height * height / length * stress;
    }
    for leg in &mut scene.loading {
        match leg {
            Move::ToIndentation(to) => *to *= height,
            Move::ToForce(to) => *to *= stress * length * height,
            _ => {}
        }
    }
    scene
}

fn run(scene: &Scene) -> Result<History, Fault> {
    let violations = crate::scene::check(scene);
    ensure(violations.is_empty(), || format!("the scene is not allowed: {violations:?}"))?;
    Ok(Simulation::default().run(scene, &|| false, &mut |_, _, _| Ok(()))?.history)
}

/// Runs the scene at all of these scales (length, height, stress), powers of two.
fn only_scales(edges: Edges, scales: impl Iterator<Item = (f64, f64, f64)>) -> Result<(), Fault> {
    let scene = scene(edges)?;
    let one = run(&scene)?;
    ensure(one.legs[0].attached > 50 && one.legs[4].smallest.force < 0.0, || "nothing sticks".into())?;
    for (length, height, stress) in scales {
        let other = run(&scaled(&scene, length, height, stress))?;
        same_bits(&one, &other, height, stress * length * height)?;
    }
    Ok(())
}

fn modulus(edges: Edges) -> Result<f64, Fault> {
    only_scales(edges, (1..=43).map(|k| (1.0, 1.0, 2.0_f64.powi(k))))?;
    largest([1.0, 1e3, 1e8, 1e13].map(|effective_modulus| {
        let body = rough(512, WORK)?;
        let foundation = Foundation { effective_modulus, ..body.foundation };
        on_tour(&Body { foundation, ..body }, edges)
    }))
}

fn lengths(edges: Edges) -> Result<f64, Fault> {
    only_scales(edges, (1..=33).map(|k| (2.0_f64.powi(k), 2.0_f64.powi(k), 1.0)))?;
    largest([1e-9, 1e-6, 1e-3, 10.0].map(|length| {
        let body = rough(512, 0.0)?;
        let share = length / LENGTH;
        let gaps = body.gaps.iter().map(|gap| share * gap).collect();
        let foundation = Foundation { spacing: share * body.foundation.spacing, ..body.foundation };
        on_tour(&Body { gaps, foundation, work: share * WORK }, edges)
    }))
}

fn heights(edges: Edges) -> Result<f64, Fault> {
    // From 1e−15 L upwards.
    let mut low = scene(edges)?;
    low = scaled(&low, 2.0_f64.powi(30), 1.0, 1.0);
    let height = 2.0_f64.powi(-10);
    low = scaled(&low, 1.0, height, 1.0);
    if let Some(Roughness::SelfAffine { rms_height: Some(rms_height), .. }) = &mut low.roughness {
        ensure(*rms_height <= 1e-15 * low.length, || format!("{rms_height:e} m"))?;
    }
    let one = run(&low)?;
    for k in 1..=53 {
        let lambda = 2.0_f64.powi(k);
        same_bits(&one, &run(&scaled(&low, 1.0, lambda, 1.0))?, lambda, lambda)?;
    }
    largest([1e-15, 1e-12, 1e-9, 1e-6, 1e-3, 0.1, 1.0, 10.0].map(|share| {
        let body = rough(512, WORK)?;
        let height = share * LENGTH / RMS_HEIGHT;
        on_tour(&Body { gaps: body.gaps.iter().map(|gap| height * gap).collect(), ..body }, edges)
    }))
}

/// Compares the tour of a body with those of the same body with heights multiplied by powers of two.
fn only_heights_scale(body: &Body, edges: Edges, powers: &[i32]) -> Result<(), Fault> {
    let tour = |body: &Body| body.history(edges, &body.tour(), 33);
    let one = tour(body)?;
    for &power in powers {
        let lambda = 2.0_f64.powi(power);
        let gaps = body.gaps.iter().map(|gap| lambda * gap).collect();
        // One factor after the other: their product alone may overflow or underflow.
        let other = Body { gaps, work: lambda * (lambda * body.work), ..body.clone() };
        same_bits(&one, &tour(&other)?, lambda, lambda)?;
    }
    Ok(())
}

fn subnormal(edges: Edges) -> Result<f64, Fault> {
    let body = rough(500, WORK)?;
    only_heights_scale(&body, edges, &[-100, -200, -300, -400])?;
    // Beyond, γ is out of range. Gaps lose digits, so the reference is their own exact multiple.
    let mut worst = 0.0_f64;
    for k in [850, 900, 950, 980, 1000, 1020, 1040] {
        let lambda = 2.0_f64.powi(-k / 2);
        let down = |gap: &f64| lambda * (lambda * gap);
        let up = |value: f64| value / lambda / lambda;
        let small = Body { gaps: body.gaps.iter().map(down).collect(), work: 0.0, ..body.clone() };
        ensure(k < 1020 || !small.deepest().is_normal(), || "not subnormal".into())?;
        let large = Body { gaps: small.gaps.iter().map(|&gap| up(gap)).collect(), ..small.clone() };
        for share in [0.25, 0.5, 0.75, 1.0, 2.0] {
            let to = small.deepest() * share;
            let found = small.history(edges, &press_and_pull(to), 33)?;
            for record in &found.legs {
                ensure(points(record).all(|p| p.force.is_finite() && p.indentation.is_finite()), || {
                    format!("heights times 2^−{k}: not finite")
                })?;
            }
            let ordered = found.legs[0]
                .curve
                .windows(2)
                .all(|pair| pair[0].indentation <= pair[1].indentation && pair[0].springs <= pair[1].springs);
            ensure(ordered, || format!("heights times 2^−{k}: not in order"))?;
            let expected = end(&large.history(edges, &[Move::ToIndentation(up(to))], 33)?.legs[0]);
            let found = end(&found.legs[0]);
            ensure(found.springs == expected.springs, || format!("heights times 2^−{k}: another contact"))?;
            // In units without subnormal numbers.
            let unit = body.gaps.len() as f64 * body.foundation.spring_stiffness() * 2.0_f64.powi(-1000);
            worst = worst.max((up(found.force) - expected.force).abs() / up(unit));
        }
    }
    Ok(worst)
}

fn near_overflow(edges: Edges) -> Result<f64, Fault> {
    let body = rough(500, WORK)?;
    only_heights_scale(&body, edges, &[100, 200, 300, 400, 450])?;
    only_heights_scale(&Body { work: 0.0, ..body }, edges, &[500, 700, 900, 1000])?;
    Ok(0.0)
}
