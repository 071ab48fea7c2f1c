//! Edges between grid points: against brute force, closed forms, and laws for every line.

pub mod brute_force;
mod closed_forms;
mod laws;
mod rule;
mod wavy_sphere;

use super::solvers::{adhesive, nonadhesive};
use super::{formed, numerics};
use asperity::contact::{CurvePoint, Foundation, HessRule, History, LegRecord, Solver, run};
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
    /// γ₁ on closing, at most γ, J/m².
    closing_work: f64,
}

impl Body {
    fn hess(&self) -> HessRule {
        HessRule::from_works(self.foundation, self.closing_work, self.work)
    }

    fn on(&self, samples: usize) -> asperity::contact::Body {
        adhesive(&self.gaps, Edges::SubCell, self.hess(), self.foundation, samples)
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

/// Gaps of a line of one of several kinds: random walk, noise, few springs, a few levels, flat, a ramp.
fn gaps(most: usize) -> impl Strategy<Value = Vec<f64>> {
    let walk = prop::collection::vec(-1.0..1.0_f64, 1..most).prop_map(|steps| {
        let mut height = 0.0;
        let heights = steps.iter().map(|step| {
            height += 0.1 * step;
            height
        });
        heights.collect::<Vec<f64>>()
    });
    let noise = prop::collection::vec(0.0..1.0_f64, 1..most);
    let few = prop::collection::vec(0.0..1.0_f64, 1..5);
    let levels = prop::collection::vec(0_u8..5, 1..most)
        .prop_map(|levels| levels.iter().map(|&level| 0.25 * f64::from(level)).collect());
    let flat = (1_usize..most).prop_map(|count| vec![0.0; count]);
    let ramp = (1_usize..most, any::<bool>(), 1_usize..4).prop_map(|(count, falls, step)| {
        let rising = (0..count).map(|k| ((k / step) as f64 / 50.0).powi(2));
        if falls { rising.rev().collect() } else { rising.collect() }
    });
    prop_oneof![6 => walk, 2 => noise, 2 => few, 3 => levels, 1 => flat, 2 => ramp].prop_map(
        |heights: Vec<f64>| {
            let lowest = heights.iter().copied().fold(f64::INFINITY, f64::min);
            heights.iter().map(|height| height - lowest).collect()
        },
    )
}

/// Bodies about 1 m deep: without adhesion, with hardly any, and with far more than full adhesion needs.
fn body(most: usize) -> impl Strategy<Value = Body> {
    let range = prop_oneof![
        5 => (-5.0..2.0_f64).prop_map(|power| 10_f64.powf(power)),
        1 => (-32.0..-5.0_f64).prop_map(|power| 10_f64.powf(power)),
        1 => Just(0.0),
    ];
    (gaps(most), range, 0.003..0.03_f64, 0.3..3.0_f64).prop_map(
        |(gaps, range, spacing, effective_modulus)| Body {
            gaps,
            foundation: Foundation::endless(spacing, effective_modulus),
            work: range * effective_modulus,
            closing_work: range * effective_modulus,
        },
    )
}

/// Bodies with a smaller work of adhesion on closing: none, hardly less than on opening, or any.
fn two_works(most: usize) -> impl Strategy<Value = Body> {
    let share = prop_oneof![1 => Just(0.0), 1 => Just(1.0 - 1e-6), 3 => 0.0..1.0_f64];
    (body(most), share).prop_map(|(body, share)| Body { closing_work: share * body.work, ..body })
}

/// Bodies with one and with two works of adhesion.
fn any_body(most: usize) -> impl Strategy<Value = Body> {
    prop_oneof![body(most), two_works(most)]
}

fn cases(cases: u32) -> ProptestConfig {
    ProptestConfig { cases, failure_persistence: None, ..ProptestConfig::default() }
}

/// End of a leg.
fn end(record: &LegRecord) -> CurvePoint {
    *record.curve.last().unwrap()
}
