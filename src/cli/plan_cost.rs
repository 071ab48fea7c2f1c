//! What the stages of a scene cost, as far as the scene alone tells: passes and memory.

use super::plan_legs::Legs;
use crate::contact::CurvePoint;
use crate::scene::{Form, Scene, Solver};
use crate::simulation::{Plan, PlannedStage, Stage};
use serde::Serialize;

/// Bytes for each spring: a height of the roughness, or a gap of the line.
const HEIGHT: u64 = 8;
/// Largest prime factor of a number of springs that the Fourier transform takes in its stride.
const LARGEST_FACTOR: u64 = 11;
/// Bytes for each spring: a node of the tree.
const NODE: u64 = 20;
/// Bytes for each spring: its gap, the levels of its node and the integral up to it.
const LEVELS: u64 = 48;
/// Bytes for each spring: the indentation at which it joins or leaves.
const THRESHOLD: u64 = 8;
/// Bytes for each spring of the stepwise solver: its threshold and whether it touches.
const RELAXED: u64 = THRESHOLD + 1;

/// What a scene costs.
pub(super) struct Cost {
    /// Springs N of the foundation.
    points: u64,
    /// Springs under the body.
    pub(super) springs: u64,
    /// Points of all curves.
    curve_points: u64,
    legs: Legs,
    exact: bool,
    rough: bool,
}

/// What one stage costs; nothing where it is skipped.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub(super) struct StageCost {
    /// Passes over the line or its tree; `None` where only the run can tell.
    pub(super) passes: Option<u64>,
    /// Bytes of the arrays it adds while it runs.
    pub(super) bytes: u64,
}

impl Cost {
    pub(super) fn of(scene: &Scene) -> Cost {
        let loading = scene.loading.as_slice();
        Cost {
            points: scene.numerics.points,
            springs: springs_under_body(scene),
            curve_points: scene.numerics.samples * loading.len() as u64,
            legs: Legs::of(loading),
            exact: scene.numerics.solver == Solver::Exact,
            rough: scene.roughness.is_some(),
        }
    }

    pub(super) fn stage(&self, planned: &PlannedStage) -> StageCost {
        if !planned.runs {
            return StageCost { passes: Some(0), bytes: 0 };
        }
        let on_line = |passes, per_spring: u64| StageCost { passes, bytes: per_spring * self.springs };
        match planned.stage {
            Stage::Form | Stage::HeightHistogram => on_line(Some(1), 0),
            Stage::Synthesis => StageCost { passes: Some(1), bytes: self.synthesis_bytes() },
            Stage::MeasuredProfile => StageCost { passes: Some(1), bytes: HEIGHT * self.points },
            Stage::Tree => on_line(Some(1), NODE),
            Stage::LevelSets => on_line(Some(1), LEVELS),
            Stage::RuleOfHess => on_line(Some(0), 0),
            Stage::LoadingPass => on_line(self.legs.loading(), THRESHOLD),
            Stage::UnloadingPass => on_line(self.legs.unloading(), 0),
            Stage::Relaxation => on_line(None, RELAXED),
            Stage::ZeroLoadAdhesion if self.exact => {
                // What first touches is known from the first leg that touches, if there is one.
                on_line(Some(if self.legs.loading() == Some(0) { 2 } else { 1 }), THRESHOLD)
            }
            Stage::ZeroLoadAdhesion => on_line(None, RELAXED),
            Stage::Fragments => on_line(Some(self.legs.all()), 0),
        }
    }

    /// About the most memory the arrays of a run take at any one time, bytes.
    pub(super) fn peak_bytes(&self, plan: &Plan) -> u64 {
        let kept = if self.rough { HEIGHT * self.points } else { 0 };
        let of_contact = match (self.exact, plan.runs(Stage::Tree)) {
            (false, _) => RELAXED,
            // At the most, where all that touches under load touches at first touch as well.
            (true, true) if plan.runs(Stage::ZeroLoadAdhesion) => NODE + 2 * THRESHOLD,
            (true, true) => NODE + THRESHOLD,
            (true, false) => 0,
        };
        let of_levels = if plan.runs(Stage::LevelSets) { LEVELS } else { 0 };
        let curves = self.curve_points * size_of::<CurvePoint>() as u64;
        let contact = kept + (HEIGHT + of_contact + of_levels) * self.springs + curves;
        if plan.runs(Stage::Synthesis) { contact.max(self.synthesis_bytes()) } else { contact }
    }

    /// Bytes of a synthesis: heights, and as measured the transform's coefficients, scratch space and
    /// twiddle factors. Odd numbers of springs transform at twice the length, those with a large prime
    /// factor by way of a much longer convolution.
    fn synthesis_bytes(&self) -> u64 {
        let even = self.points.is_multiple_of(2);
        let transform = match (even, has_small_factors(self.points)) {
            (true, true) => 20,
            (false, true) => 56,
            (true, false) => 96,
            (false, false) => 176,
        };
        (HEIGHT + transform) * self.points
    }
}

fn has_small_factors(mut number: u64) -> bool {
    for factor in 2..=LARGEST_FACTOR {
        while number > 1 && number.is_multiple_of(factor) {
            number /= factor;
        }
    }
    number <= 1
}

/// Springs of the foundation that stand under the body: all of them but those beside a punch.
fn springs_under_body(scene: &Scene) -> u64 {
    let points = scene.numerics.points;
    let Some(Form::Punch { radius }) = scene.form else { return points };
    let cells = radius / scene.spacing();
    // Pairs at half or whole cells from the axis, and one on it where the number of springs is odd.
    let under =
        if points.is_multiple_of(2) { 2.0 * (cells + 0.5).floor() } else { 2.0 * cells.floor() + 1.0 };
    (under as u64).min(points)
}
