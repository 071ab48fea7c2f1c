//! Laws valid for every body: mirrors, finer grids, memory, order, energy, and any number of threads.

use super::{RULES, WORK, ensure, indices, largest, points, press_and_pull, rough};
use crate::check::case::{CASE, Case, Evidence, Scope};
use crate::check::{Body, Fault, end, follow};
use crate::contact::{CurvePoint, Foundation};
use crate::scene::{Document, Edges, Move};
use crate::study;
use crate::surface::{SelfAffine, UnitRoughness, phases};
use std::cell::Cell;
use std::f64::consts::TAU;
use std::path::Path;

/// Number of bodies for each law.
const BODIES: u64 = 48;

pub const CASES: &[Case] = &[
    Case {
        name: "random-bodies",
        holds: "On 48 random bodies, self-affine, noise, few levels, random walks, contact and forces follow \
                the rules.",
        measure: random_bodies,
        ..RULES
    },
    Case {
        name: "thousand-legs",
        holds: "After each of a thousand random loading stages contact and forces follow the rules.",
        measure: thousand_legs,
        ..RULES
    },
    Case {
        name: "return-point-memory",
        holds: "A minor loop closes to the last bit, and a deeper load erases the memory of earlier turning points.",
        evidence: &[Evidence::SelfConsistency],
        error_of: "force, over the scale",
        scope: Scope::BothEdges(0.0, 0.0),
        measure: memory,
        ..CASE
    },
    Case {
        name: "ordered-contact",
        holds: "At the same d more springs are in contact after a deeper load and on unloading than on loading, \
                and pull-off is no weaker.",
        evidence: &[Evidence::SelfConsistency],
        error_of: "pull-off force, over the scale",
        scope: Scope::BothEdges(1e-15, 1e-15),
        measure: order,
        ..CASE
    },
    Case {
        name: "no-energy-for-nothing",
        holds: "No closed loop gains energy, and the energy dissipated from separation to separation is ∮F dd.",
        evidence: &[Evidence::SelfConsistency],
        error_of: "energy, over the scale",
        scope: Scope::BothEdges(1e-4, 1e-4),
        measure: energy,
        ..CASE
    },
    Case {
        name: "mirror",
        holds: "A mirrored profile has the mirrored contact and the same forces.",
        evidence: &[Evidence::SelfConsistency],
        error_of: "force, over the scale",
        scope: Scope::BothEdges(0.0, 1e-15),
        measure: mirror,
        ..CASE
    },
    Case {
        name: "refined-line",
        holds: "3, 5 and 9 times as many springs lie on the same profile.",
        evidence: &[Evidence::SelfConsistency],
        error_of: "height over rms height",
        scope: Scope::Line(2e-14),
        measure: |_| refined_line(),
        ..CASE
    },
    Case {
        name: "refined-cells",
        holds: "More springs on the same straight pieces change nothing but rounding.",
        evidence: &[Evidence::SelfConsistency],
        error_of: "force, over the scale",
        scope: Scope::OneKind(Edges::SubCell, 1e-14),
        measure: |edges| refined_cells(edges),
        ..CASE
    },
    Case {
        name: "any-number-of-threads",
        holds: "16 random profiles give the same bits with 1, 2, 3 and 8 threads.",
        evidence: &[Evidence::SelfConsistency],
        error_of: "figures with other bits",
        scope: Scope::BothEdges(0.0, 0.0),
        measure: threads,
        ..CASE
    },
];

/// Largest error over all bodies.
fn worst(measure: impl Fn(&Body) -> Result<f64, Fault>) -> Result<f64, Fault> {
    largest((0..BODIES).map(|seed| {
        let error = measure(&Body::random(seed)?);
        let error = error.map_err(|fault| Fault::Wrong(format!("body {seed}: {fault}")))?;
        ensure(!error.is_nan(), || format!("body {seed}: not a number"))?;
        Ok(error)
    }))
}

fn random_bodies(edges: Edges) -> Result<f64, Fault> {
    let partial = Cell::new(0);
    let error = worst(|body| {
        let agreement = follow(body, edges, &body.tour())?;
        partial.set(partial.get() + agreement.partial);
        Ok(agreement.force)
    })?;
    ensure(partial.get() > 4 * BODIES as usize, || format!("only {} partial contacts", partial.get()))?;
    Ok(error)
}

/// Irregular indentations from just before separation to full contact.
fn turns(body: &Body, seed: u64) -> impl Iterator<Item = f64> + use<> {
    let (low, high) = (-0.9 * body.largest_stretch(), 1.1 * body.deepest() + 1e-3 * body.largest_stretch());
    phases(seed, 1).map(move |phase| low + (high - low) * phase / TAU)
}

/// Four times three indentations, each in ascending order.
fn ordered_threes(body: &Body, seed: u64) -> Vec<[f64; 3]> {
    let turns: Vec<f64> = turns(body, seed).take(12).collect();
    let ordered = |three: &[f64]| {
        let mut three = [three[0], three[1], three[2]];
        three.sort_by(f64::total_cmp);
        three
    };
    turns.chunks_exact(3).map(ordered).collect()
}

fn to(turns: &[f64]) -> Vec<Move> {
    turns.iter().map(|&to| Move::ToIndentation(to)).collect()
}

fn thousand_legs(edges: Edges) -> Result<f64, Fault> {
    let body = rough(400, WORK)?;
    let legs: Vec<Move> = to(&turns(&body, 9).take(1000).collect::<Vec<_>>());
    let agreement = follow(&body, edges, &legs)?;
    ensure(agreement.undecided * 10 < agreement.states && agreement.partial > 500, || {
        format!("{agreement:?}: too few states that the bounds decide")
    })?;
    Ok(agreement.force)
}

/// The contact and the last point of a loading.
fn state(body: &Body, edges: Edges, legs: &[Move]) -> Result<(Vec<(usize, usize)>, CurvePoint), Fault> {
    let history = body.history(edges, legs, 2)?;
    let last = history.legs.last().map(end).unwrap_or_default();
    Ok((history.contacts, last))
}

fn memory(edges: Edges) -> Result<f64, Fault> {
    worst(|body| {
        let mut error = 0.0_f64;
        for [low, middle, high] in ordered_threes(body, 10) {
            for (short, long) in [
                (vec![high], vec![middle, low, middle, high]),
                (vec![high, low], vec![high, low, middle, low]),
                (vec![high, low, middle], vec![high, middle, high, low, middle, low, middle]),
            ] {
                let (one, other) = (state(body, edges, &to(&short))?, state(body, edges, &to(&long))?);
                ensure(one.0 == other.0, || format!("{long:?} leaves another contact than {short:?}"))?;
                error = error.max((one.1.force - other.1.force).abs() / body.force_scale());
            }
        }
        Ok(error)
    })
}

fn order(edges: Edges) -> Result<f64, Fault> {
    worst(|body| {
        let mut error = 0.0_f64;
        for [probe, less, more] in ordered_threes(body, 11) {
            let contact = |legs: &[f64]| Ok::<_, Fault>(indices(&state(body, edges, &to(legs))?.0));
            let (on_the_way, after_less, after_more) =
                (contact(&[probe])?, contact(&[less, probe])?, contact(&[more, probe])?);
            let within = |a: &[usize], b: &[usize]| a.iter().all(|spring| b.binary_search(spring).is_ok());
            ensure(within(&on_the_way, &after_less) && within(&after_less, &after_more), || {
                format!("at {probe:e} m fewer springs after a deeper load: {less:e}, {more:e} m")
            })?;
            let pull_off = |turn: f64| {
                let history = body.history(edges, &press_and_pull(turn.max(0.0)), 2)?;
                Ok::<_, Fault>(history.legs[1].smallest.force)
            };
            error = error.max((pull_off(more)? - pull_off(less)?) / body.force_scale());
        }
        Ok(error)
    })
}

fn energy(edges: Edges) -> Result<f64, Fault> {
    worst(|body| {
        let scale = body.force_scale() * (body.deepest() + body.largest_stretch());
        let mut turns = turns(body, 12);
        let mut next = || turns.next().unwrap_or(0.0);
        let (a, b) = (next(), next());
        let (low, high) = (a.min(b), a.max(b).max(0.0));
        let history = body.history(edges, &to(&[high, low, high]), 2)?;
        let lost: f64 = history.legs[1..].iter().map(|leg| leg.released_energy).sum();
        ensure(lost >= -1e-14 * scale, || format!("a loop from {high:e} to {low:e} m gains {:e} J", -lost))?;
        let legs = [to(&[high, low, high]), vec![Move::ToSeparation]].concat();
        let history = body.history(edges, &legs, 20_000)?;
        let lost: f64 = history.legs.iter().map(|leg| leg.released_energy).sum();
        // A jump may lie anywhere between two points of the curve: the remaining error of the trapezia falls with
        // their number.
        let trapezium = |pair: &[CurvePoint]| {
            0.5 * (pair[0].force + pair[1].force) * (pair[1].indentation - pair[0].indentation)
        };
        let done: f64 = history.legs.iter().flat_map(|leg| leg.curve.windows(2)).map(trapezium).sum();
        Ok((lost - done).abs() / scale)
    })
}

fn mirror(edges: Edges) -> Result<f64, Fault> {
    worst(|body| {
        let mirrored = Body { gaps: body.gaps.iter().rev().copied().collect(), ..body.clone() };
        let last = body.gaps.len() - 1;
        let mut error = 0.0_f64;
        body.with(edges, 17, |one| {
            mirrored.with(edges, 17, |other| {
                for leg in body.tour() {
                    let (here, there) = (one.advance(leg)?, other.advance(leg)?);
                    for (a, b) in points(&here).zip(points(&there)) {
                        error = error.max((a.force - b.force).abs() / body.force_scale());
                    }
                    let at = end(&here).indentation;
                    let turned: Vec<_> =
                        other.leg().patches(at).iter().rev().map(|(a, b)| (last - b, last - a)).collect();
                    ensure(one.leg().patches(at) == turned, || format!("at {at:e} m another contact"))?;
                }
                Ok(error)
            })
        })
    })
}

fn refined_line() -> Result<f64, Fault> {
    let points = 1000;
    let spectrum = SelfAffine { hurst: 0.4, first: 1, last: points as u64 / 2 };
    let coarse = UnitRoughness::synthesize(spectrum, 13, points)?;
    largest([3, 5, 9].map(|factor| {
        // Every spring is at the place of one of the finer profile, in the middle of a cell.
        let fine = UnitRoughness::synthesize(spectrum, 13, factor * points)?;
        let fine = fine.heights.iter().skip(factor / 2).step_by(factor);
        largest(coarse.heights.iter().zip(fine).map(|(height, finer)| Ok((finer - height).abs())))
    }))
}

/// The same straight pieces with `factor`, odd, times as many springs.
fn refined(body: &Body, factor: usize) -> Body {
    let count = body.gaps.len();
    let gaps = (0..factor * count).map(|index| {
        let (cell, part) = (index / factor, index % factor);
        let beside = if part < factor / 2 { cell.checked_sub(1) } else { Some(cell + 1) };
        let here = body.gaps[cell];
        // Beyond the first and the last spring the profile is level.
        let there = beside.and_then(|beside| body.gaps.get(beside)).copied().unwrap_or(here);
        let share = part.abs_diff(factor / 2) as f64 / factor as f64;
        here + share * (there - here)
    });
    let foundation = Foundation { spacing: body.foundation.spacing / factor as f64, ..body.foundation };
    Body { gaps: gaps.collect(), foundation, work: body.work }
}

fn refined_cells(edges: Edges) -> Result<f64, Fault> {
    worst(|body| {
        let mut error = 0.0_f64;
        let coarse = body.history(edges, &body.tour(), 17)?;
        for factor in [3, 5] {
            let fine = refined(body, factor).history(edges, &body.tour(), 17)?;
            for (one, other) in coarse.legs.iter().zip(&fine.legs) {
                let (a, b) = (end(one), end(other));
                error = error.max((a.force - b.force).abs() / body.force_scale());
                error = error.max((one.smallest.force - other.smallest.force).abs() / body.force_scale());
            }
        }
        Ok(error)
    })
}

fn threads(edges: Edges) -> Result<f64, Fault> {
    let text = "(version: 1, material: (effective_modulus: 2.0e6), length: 1.0e-4,
        roughness: SelfAffine(hurst: 0.7, rms_height: 1.0e-7, modes: (1, 512), seed: 1),
        adhesion: (work: 5.0e-3), loading: [ToForce(1.0e-5), ToSeparation],
        numerics: (points: 2048, samples: 33))";
    let mut scene = Document::parse(text, "check")?.scene().clone();
    scene.numerics.edges = edges;
    let alone = study::solve_lines(&scene, Path::new(""), 16, 1)?;
    ensure(alone.iter().all(|line| line.adhesion_force.is_some()), || "a line gives no force".into())?;
    let mut others = 0;
    for jobs in [2, 3, 8] {
        let shared = study::solve_lines(&scene, Path::new(""), 16, jobs)?;
        ensure(shared.len() == alone.len(), || format!("{} lines by {jobs} threads", shared.len()))?;
        others += alone
            .iter()
            .zip(&shared)
            .filter(|(one, other)| format!("{one:?}") != format!("{other:?}"))
            .count();
    }
    Ok(others as f64)
}
