//! Laws for every line with any heights: symmetries, memory, order, energy, and exact extremes and crossings of the
//! force.

mod brute_force;
mod extreme_inputs;
mod memory;
mod patches;
mod refusals;
mod reuse;
mod search;
mod symmetries;
mod ties;
mod work;

use super::formed;
use super::solvers::{adhesive, nonadhesive};
use asperity::contact::{Contact, CurvePoint, Foundation, HessRule, History, LegRecord, Solver, run};
use asperity::scene::{Edges, Move};
use proptest::prelude::*;

/// Springs under adhesion.
#[derive(Clone, Debug)]
struct Body {
    /// m, the smallest 0.
    gaps: Vec<f64>,
    foundation: Foundation,
    /// γ, J/m².
    work: f64,
    /// γ₁/γ on closing.
    closing: f64,
}

impl Body {
    fn hess(&self) -> HessRule {
        HessRule::from_works(self.foundation, self.closing * self.work, self.work)
    }

    fn contact(&self) -> Contact {
        Contact::new(self.gaps.clone(), Edges::Grid, self.foundation, Some(self.hess()))
    }

    /// The exact solver.
    fn on(&self, samples: usize) -> asperity::contact::Body {
        adhesive(&self.gaps, Edges::Grid, self.hess(), self.foundation, samples)
    }

    fn history(&self, legs: &[Move], samples: usize) -> History {
        run(&mut self.on(samples), legs, |_, _| Ok(())).unwrap()
    }

    fn deepest(&self) -> f64 {
        self.gaps.iter().copied().fold(0.0, f64::max)
    }

    /// Largest stretch of a fragment over the whole line, m.
    fn largest_stretch(&self) -> f64 {
        let length = self.gaps.len() as f64 * self.foundation.spacing;
        (std::f64::consts::PI * length * self.work / self.foundation.effective_modulus).sqrt()
    }

    /// Order of magnitude of the acting forces, N.
    fn force_scale(&self) -> f64 {
        let springs = self.gaps.len() as f64 * self.foundation.spring_stiffness();
        springs * (self.deepest() + self.largest_stretch()).max(1e-3)
    }
}

/// Gaps of a line of one of several kinds: random walk, noise, a few levels, flat.
fn gaps() -> impl Strategy<Value = Vec<f64>> {
    let walk = prop::collection::vec(-1.0..1.0_f64, 1..200).prop_map(|steps| {
        let mut height = 0.0;
        let heights = steps.iter().map(|step| {
            height += 0.1 * step;
            height
        });
        heights.collect::<Vec<f64>>()
    });
    let noise = prop::collection::vec(0.0..1.0_f64, 1..100);
    let levels = prop::collection::vec(0_u8..5, 1..100)
        .prop_map(|levels| levels.iter().map(|&level| 0.25 * f64::from(level)).collect());
    let flat = (1_usize..50).prop_map(|count| vec![0.0; count]);
    prop_oneof![6 => walk, 2 => noise, 2 => levels, 1 => flat].prop_map(|heights: Vec<f64>| {
        let lowest = heights.iter().copied().fold(f64::INFINITY, f64::min);
        heights.iter().map(|height| height - lowest).collect()
    })
}

/// Bodies about 1 m deep, from hardly any adhesion to far more than full adhesion needs.
fn body() -> impl Strategy<Value = Body> {
    (gaps(), -5.0..2.0_f64, 0.003..0.03_f64, 0.3..3.0_f64).prop_map(
        |(gaps, range, spacing, effective_modulus)| Body {
            gaps,
            foundation: Foundation::endless(spacing, effective_modulus),
            work: effective_modulus * 10_f64.powf(range),
            closing: 1.0,
        },
    )
}

/// Bodies with one work of adhesion, or with a smaller one on closing: none, or any.
fn body_of_two_works() -> impl Strategy<Value = Body> {
    let closing = prop_oneof![2 => Just(1.0), 1 => Just(0.0), 2 => 0.0..1.0_f64];
    (body(), closing).prop_map(|(body, closing)| Body { closing, ..body })
}

/// Bodies without adhesion.
fn bare_body() -> impl Strategy<Value = Body> {
    body().prop_map(|body| Body { work: 0.0, ..body })
}

/// Indentations of turning points; some of them equal, some on a level.
fn indentations(most: usize) -> impl Strategy<Value = Vec<f64>> {
    let indentation = prop_oneof![4 => -0.8..1.2_f64, 1 => (-3_i8..6).prop_map(|l| 0.25 * f64::from(l))];
    prop::collection::vec(indentation, 1..most)
}

fn cases(cases: u32) -> ProptestConfig {
    ProptestConfig { cases, failure_persistence: None, ..ProptestConfig::default() }
}

/// The end of a history.
fn end(history: &History) -> CurvePoint {
    *history.legs.last().unwrap().curve.last().unwrap()
}

/// All bits of a point.
fn bits(point: &CurvePoint) -> [u64; 4] {
    [point.indentation.to_bits(), point.force.to_bits(), point.springs, point.fragments]
}

fn curve_bits(record: &LegRecord) -> Vec<[u64; 4]> {
    record.curve.iter().map(bits).collect()
}

fn indices(fragments: &[(usize, usize)]) -> Vec<usize> {
    fragments.iter().flat_map(|&(first, last)| first..=last).collect()
}

fn to_indentations(indentations: &[f64]) -> Vec<Move> {
    indentations.iter().map(|&to| Move::ToIndentation(to)).collect()
}
