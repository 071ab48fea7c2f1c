//! Questions of the stages to a scene, and their answers.

use super::legs::Legs;
use crate::scene::{Edges, Effect, Roughness, Scene, Solver};
use serde::Serialize;

/// Bytes for each spring: a height of the roughness, or a gap of the line.
pub const HEIGHT: u64 = 8;
/// Bytes for each sample of the leg that is under way, beside its curve: grid of indentations, what is in contact at
/// each, and where the force is looked for. As measured.
const SAMPLED: u64 = 64;
/// The same with edges between springs, which are summed for each sample as well.
const SAMPLED_WITH_EDGES: u64 = 120;

/// Decision on a stage of a scene.
pub enum Called {
    /// Called for by this field.
    For(&'static str),
    /// Skipped for this reason.
    Not(&'static str),
}

impl Called {
    /// By `field` if it does, else for this reason.
    pub fn when(does: bool, field: &'static str, reason: &'static str) -> Self {
        if does { Called::For(field) } else { Called::Not(reason) }
    }
}

/// Cost of one stage.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct StageCost {
    /// Passes over the line or its tree; `None` where only the run shows it.
    pub passes: Option<u64>,
    /// Springs looked at in all of them, at the most; `None` where only the run shows it.
    pub springs_touched: Option<u64>,
    /// Bytes of the arrays it adds while it runs.
    pub bytes: u64,
}

impl StageCost {
    /// That of a stage that is skipped.
    pub const NOTHING: StageCost = StageCost { passes: Some(0), springs_touched: Some(0), bytes: 0 };
}

/// Requirements of a scene.
pub struct Call<'a> {
    pub scene: &'a Scene,
    /// Springs N of the foundation.
    pub points: u64,
    /// Springs under the body.
    pub springs: u64,
    /// Points of all curves.
    pub curve_points: u64,
    pub legs: Legs,
    pub adhesive: bool,
    /// Solved exactly, not step by step.
    pub exact: bool,
    /// Edges between springs.
    pub between: bool,
    /// True if the loading may turn back.
    pub pulls: bool,
}

impl<'a> Call<'a> {
    pub fn of(scene: &'a Scene) -> Self {
        let loading = scene.loading.as_slice();
        Call {
            scene,
            points: scene.numerics.points,
            springs: scene.springs_under_body().count() as u64,
            curve_points: scene.numerics.samples * loading.len() as u64,
            legs: Legs::of(loading),
            adhesive: Effect::Adhesion.is_on(scene),
            exact: scene.numerics.solver == Solver::Exact,
            between: scene.numerics.edges == Edges::SubCell,
            pulls: Effect::Unloading.is_on(scene),
        }
    }

    pub fn is_rough(&self) -> bool {
        Effect::Roughness.is_on(self.scene)
    }

    pub fn is_synthesised(&self) -> bool {
        self.scene.seed().is_some()
    }

    pub fn is_measured(&self) -> bool {
        matches!(self.scene.roughness, Some(Roughness::Measured { .. }))
    }

    /// Bytes that sampling the curve of one leg takes while it is under way.
    pub fn bytes_of_sampling(&self) -> u64 {
        let each = if self.between && self.exact { SAMPLED_WITH_EDGES } else { SAMPLED };
        self.scene.numerics.samples.saturating_mul(each)
    }

    /// Passes over the springs under the body, with arrays of so many bytes for each.
    pub fn passes(&self, passes: Option<u64>, bytes_per_spring: u64) -> StageCost {
        self.passes_over(self.springs, passes, bytes_per_spring)
    }

    /// Passes over so many springs, with arrays of so many bytes for each.
    pub fn passes_over(&self, springs: u64, passes: Option<u64>, bytes_per_spring: u64) -> StageCost {
        let springs_touched = passes.map(|passes| passes.saturating_mul(springs));
        StageCost { passes, springs_touched, bytes: bytes_per_spring.saturating_mul(springs) }
    }
}
