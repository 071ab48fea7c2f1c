//! From no adhesion to adhesion that keeps full contact, and forces or decisions that depend on rounding.

use super::{RULES, WORK, ensure, on_tour, press_and_pull, relative_error, rough, two_legs};
use crate::check::case::{CASE, Case, Evidence, Scope};
use crate::check::{Body, Extended, Fault, end, force_error};
use crate::contact::Solver;
use crate::scene::{Edges, Move};
use std::f64::consts::PI;

pub const CASES: &[Case] = &[
    Case {
        name: "no-adhesion",
        holds: "At γ = 0 unloading retraces loading bit for bit, and no energy is dissipated.",
        evidence: &[Evidence::SelfConsistency],
        error_of: "force, over the largest",
        scope: Scope::BothEdges(0.0, 0.0),
        measure: no_adhesion,
        ..CASE
    },
    Case {
        name: "vanishing-adhesion",
        holds: "For γ from 1e−280 to 1e−3 J/m² contact and forces follow the rules, and F(γ) goes to \
                F(0) no slower than the longest stretch.",
        measure: vanishing_adhesion,
        ..RULES
    },
    Case {
        name: "everything-sticks",
        holds: "Adhesion far beyond the roughness closes the whole profile at first touch and opens it at once, at \
                the threshold of the deepest spring.",
        evidence: &[Evidence::ClosedForm],
        error_of: "force and place of pull-off",
        scope: Scope::BothEdges(2e-15, 2e-15),
        measure: everything_sticks,
        ..CASE
    },
    Case {
        name: "balance-at-full-contact",
        holds: "With all in contact and F = 0 a difference of sums, each F is right to the bound its \
                documentation gives.",
        evidence: &[Evidence::IndependentComputation],
        error_of: "force, in documented units",
        scope: Scope::BothEdges(4e-16, 1e-15),
        measure: balance,
        ..CASE
    },
    Case {
        name: "preload-at-an-event",
        holds: "Loaded exactly to an attachment, or to a neighbouring number, the contact is that of the whole \
                loading stage, and the force there is reached at that indentation.",
        evidence: &[Evidence::IndependentComputation],
        error_of: "force, in documented units",
        scope: Scope::BothEdges(4e-16, 1e-15),
        measure: preload_at_an_event,
        ..CASE
    },
];

fn no_adhesion(edges: Edges) -> Result<f64, Fault> {
    let body = rough(4096, 0.0)?;
    let history = body.history(edges, &press_and_pull(0.8 * body.deepest()), 301)?;
    let [loading, unloading] = two_legs(&history)?;
    let lost = (loading.released_energy, unloading.released_energy);
    ensure(lost == (0.0, 0.0), || format!("lost {lost:?} J"))?;
    ensure(loading.curve.len() == unloading.curve.len(), || "other points on the way back".into())?;
    let mut worst = 0.0_f64;
    for (one, other) in loading.curve.iter().zip(unloading.curve.iter().rev()) {
        ensure(one.indentation == other.indentation, || format!("{} m on the way back", other.indentation))?;
        ensure((one.springs, one.fragments) == (other.springs, other.fragments), || {
            format!("at {:e} m another contact on the way back", one.indentation)
        })?;
        worst = worst.max((one.force - other.force).abs());
    }
    Ok(worst / loading.largest.force)
}

fn vanishing_adhesion(edges: Edges) -> Result<f64, Fault> {
    let bare = rough(1024, 0.0)?;
    let deepest = Move::ToIndentation(0.6 * bare.deepest());
    let without = bare.history(edges, &[deepest], 2)?;
    let mut worst = 0.0_f64;
    for power in [-280, -200, -100, -50, -30, -20, -12, -9, -7, -6, -5, -4, -3] {
        let body = Body { work: 10.0_f64.powi(power), ..bare.clone() };
        worst = worst.max(on_tour(&body, edges)?);
        let with = body.history(edges, &[deepest], 2)?;
        let pulls = end(&without.legs[0]).force - end(&with.legs[0]).force;
        // No stretch by adhesion exceeds that of a fragment as long as the profile.
        let stiffness = body.gaps.len() as f64 * body.foundation.spring_stiffness();
        let most = stiffness * body.largest_stretch() + 1e-14 * end(&without.legs[0]).force;
        ensure((-1e-14 * most..=most).contains(&pulls), || {
            format!("γ = 1e{power} J/m² pulls with {pulls:e} N, at most {most:e} N are possible")
        })?;
    }
    Ok(worst)
}

fn everything_sticks(edges: Edges) -> Result<f64, Fault> {
    let mut worst = 0.0_f64;
    for points in [3, 10, 999] {
        let bare = rough(points, 0.0)?;
        // A single spring is held far beyond the depth, independent of its neighbours.
        for reach in [1e4, 1e8, 1e15] {
            let stretch = reach * bare.deepest();
            let work = stretch * stretch * bare.foundation.effective_modulus / (PI * bare.foundation.spacing);
            let body = Body { work, ..bare.clone() };
            let history = body.history(edges, &[Move::ToTouch, Move::ToSeparation], 9)?;
            let count = points as u64;
            let touch = end(&history.legs[0]);
            ensure(touch.springs == count, || {
                format!("{} of {count} springs at first touch", touch.springs)
            })?;
            let last = history.legs[1].smallest;
            ensure(last.springs == count, || format!("{} of {count} springs at the last", last.springs))?;
            let (cells, deepest) = (Extended::from(points as f64), Extended::from(body.deepest()));
            let area = Extended::PI * cells * Extended::from(body.foundation.spacing);
            let range = Extended::from(work) / Extended::from(body.foundation.effective_modulus);
            let detachment = deepest - (area * range).sqrt();
            let stiffness =
                Extended::from(body.foundation.effective_modulus) * Extended::from(body.foundation.spacing);
            let force = stiffness * (cells * detachment - Extended::sum(body.gaps.iter().copied()));
            for (found, expected) in [
                (last.force, force),
                (last.indentation, detachment),
                (end(&history.legs[1]).indentation, detachment),
            ] {
                worst = worst.max(relative_error(found, expected));
            }
        }
    }
    Ok(worst)
}

fn balance(edges: Edges) -> Result<f64, Fault> {
    let bare = rough(10_007, 0.0)?;
    // The whole profile is held at ten times its depth.
    let stretch = 10.0 * bare.deepest();
    let length = bare.gaps.len() as f64 * bare.foundation.spacing;
    let work = stretch * stretch * bare.foundation.effective_modulus / (PI * length);
    let body = Body { work, ..bare };
    let cells = Extended::from(body.gaps.len() as f64);
    let mean = (Extended::sum(body.gaps.iter().copied()) / cells).rounded();
    body.with(edges, 9, |solver| {
        let mut worst = 0.0_f64;
        let beside = [mean, mean.next_up(), mean.next_down(), mean * (1.0 + 1e-12), mean * (1.0 - 1e-9)];
        let legs = [Move::ToIndentation(1.1 * body.deepest()), Move::ToZeroForce];
        for leg in legs.into_iter().chain(beside.map(Move::ToIndentation)) {
            let point = end(&solver.advance(leg)?);
            ensure(point.springs == body.gaps.len() as u64, || "not all in contact".into())?;
            worst = worst.max(force_error(&body, edges, solver, &point)?);
        }
        Ok(worst)
    })
}

fn preload_at_an_event(edges: Edges) -> Result<f64, Fault> {
    let body = rough(300, WORK)?;
    let deepest = Move::ToIndentation(0.9 * body.deepest());
    body.with(edges, 9, |whole| {
        whole.advance(deepest)?;
        let thresholds = whole.leg().thresholds();
        let mut worst = 0.0_f64;
        let mut events: Vec<f64> = thresholds.iter().copied().filter(|at| at.is_finite()).collect();
        events.sort_by(f64::total_cmp);
        events.dedup();
        ensure(events.len() > 10, || format!("only {} events", events.len()))?;
        for event in events.into_iter().filter(|&event| event > 0.0) {
            for at in [event.next_down(), event, event.next_up()] {
                worst = worst.max(press_exactly_to(&body, edges, at, whole)?);
            }
        }
        Ok(worst)
    })
}

/// Presses a separated body to an indentation on a single loading stage.
fn press_exactly_to(body: &Body, edges: Edges, at: f64, whole: &dyn Solver) -> Result<f64, Fault> {
    body.with(edges, 9, |solver| {
        let point = end(&solver.advance(Move::ToIndentation(at))?);
        ensure(solver.leg().patches(at) == whole.leg().patches(at), || {
            format!("at {at:e} m another contact")
        })?;
        let error = force_error(body, edges, solver, &point)?;
        let back = solver.advance(Move::ToSeparation)?;
        ensure(end(&back).springs == 0 && back.detached == point.springs, || {
            format!("at {at:e} m some springs stay attached")
        })?;
        // Nothing separated can be pulled. Just before a jump the force has a local maximum: a force larger by a
        // rounding is reached only beyond it.
        if point.force > 0.0 {
            let wanted = point.force * (1.0 - 4.0 * f64::EPSILON);
            let again = end(&solver.advance(Move::ToForce(wanted))?);
            let slack = 1e-15 * body.force_scale();
            ensure(again.indentation <= at && again.force >= wanted - slack, || {
                format!("the force at {at:e} m is reached at {:e} m", again.indentation)
            })?;
        }
        Ok(error)
    })
}
