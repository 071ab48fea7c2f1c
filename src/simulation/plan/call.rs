//! Requirements and costs of the stages of a scene.

use crate::scene::{Edges, Effect, Roughness, Scene, Solver};
use serde::Serialize;

/// Bytes per spring: a height of the roughness, or a gap of the profile.
pub const HEIGHT: u64 = 8;
/// Bytes per sample of the present loading stage, in addition to its curve: grid of indentations, the contact at
/// each, and the search for the force. As measured.
const SAMPLED: u64 = 64;
/// The same with edges between springs, which are also summed for each sample.
const SAMPLED_WITH_EDGES: u64 = 120;

/// Decision on a stage of a scene.
pub enum Called {
    /// Required by this field.
    For(&'static str),
    /// Skipped for this reason.
    Not(&'static str),
}

impl Called {
    /// Required by `field` if `does`, else skipped for this reason.
    pub fn when(does: bool, field: &'static str, reason: &'static str) -> Self {
        if does { Called::For(field) } else { Called::Not(reason) }
    }
}

/// Cost of one stage.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct StageCost {
    /// Passes over the profile or its tree; `None` for one or more in each loading stage, by its direction.
    pub passes: Option<u64>,
    /// Most springs visited in all passes; `None` if their number is.
    pub springs_touched: Option<u64>,
    /// Bytes of the arrays added during the stage.
    pub bytes: u64,
}

impl StageCost {
    /// Cost of a skipped stage.
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
    pub adhesive: bool,
    /// True for the exact solver, false for the stepwise one.
    pub exact: bool,
    /// True for edges between springs.
    pub between: bool,
    /// True if the loading may turn back.
    pub pulls: bool,
}

impl<'a> Call<'a> {
    pub fn of(scene: &'a Scene) -> Self {
        Call {
            scene,
            points: scene.numerics.points,
            springs: scene.springs_under_body().count() as u64,
            curve_points: scene.numerics.samples * scene.loading.len() as u64,
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

    /// Bytes for sampling the curve of one loading stage.
    pub fn bytes_of_sampling(&self) -> u64 {
        let each = if self.between && self.exact { SAMPLED_WITH_EDGES } else { SAMPLED };
        self.scene.numerics.samples.saturating_mul(each)
    }

    /// Cost of passes over the springs under the body, with arrays of so many bytes per spring.
    pub fn passes(&self, passes: Option<u64>, bytes_per_spring: u64) -> StageCost {
        self.passes_over(self.springs, passes, bytes_per_spring)
    }

    /// Cost of passes over so many springs, with arrays of so many bytes per spring.
    pub fn passes_over(&self, springs: u64, passes: Option<u64>, bytes_per_spring: u64) -> StageCost {
        let springs_touched = passes.map(|passes| passes.saturating_mul(springs));
        StageCost { passes, springs_touched, bytes: bytes_per_spring.saturating_mul(springs) }
    }
}
