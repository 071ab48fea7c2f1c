//! Stages of a scene, the fields that require them, and their costs. The run follows this plan.

mod call;
mod table;

use crate::contact::CurvePoint;
use crate::scene::Scene;
use call::{Call, Called, HEIGHT};
use serde::Serialize;
use table::TABLE;

pub use call::StageCost;
pub use table::Stage;

/// A stage, its selection by a scene, and its cost.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct PlannedStage {
    /// The stage.
    pub stage: Stage,
    /// True if the stage runs.
    pub runs: bool,
    /// The field that requires the stage, or the reason why it is skipped.
    pub because: &'static str,
    /// Cost; zero for a skipped stage.
    #[serde(flatten)]
    pub cost: StageCost,
}

/// The stages of a scene, in the order of execution.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Plan {
    /// Springs under the body.
    pub springs: u64,
    /// Approximate peak memory of a run beside the program itself, bytes: all its arrays, and the resulting curves.
    /// Additional memory, unknown here: the content of a measured file, 16 bytes for each of its points, and lists
    /// of fragments.
    pub peak_bytes: u64,
    /// Approximate largest resident memory of `asperity run`, bytes: with the program itself, and without the
    /// heights of roughness, whose memory a single scene reuses for its gaps.
    pub resident_bytes: u64,
    /// All stages, including skipped ones.
    pub stages: Vec<PlannedStage>,
}

impl Plan {
    /// Resident bytes of the program after a small scene: code, tables and stacks.
    pub const PROGRAM: u64 = 14 << 20;

    /// The plan of a checked scene.
    #[must_use]
    pub fn of(scene: &Scene) -> Self {
        let call = Call::of(scene);
        let stages = TABLE.map(|row| {
            let (runs, because) = match (row.called)(&call) {
                Called::For(because) => (true, because),
                Called::Not(because) => (false, because),
            };
            let cost = if runs { (row.cost)(&call) } else { StageCost::NOTHING };
            PlannedStage { stage: row.stage, runs, because, cost }
        });
        let stages = stages.into();
        let mut plan = Plan { springs: call.springs, peak_bytes: 0, resident_bytes: Plan::PROGRAM, stages };
        let heights = if call.is_rough() { HEIGHT * call.points } else { 0 };
        plan.peak_bytes = plan.peak_of(&call, heights);
        plan.resident_bytes += plan.peak_of(&call, 0);
        plan
    }

    /// Returns true if a stage runs.
    #[must_use]
    pub fn runs(&self, stage: Stage) -> bool {
        self.stages.iter().any(|planned| planned.stage == stage && planned.runs)
    }

    fn bytes(&self, stage: Stage) -> u64 {
        self.stages.iter().find(|planned| planned.stage == stage).map_or(0, |planned| planned.cost.bytes)
    }

    /// Bytes of all stages that make the profile.
    pub(super) fn line_bytes(&self) -> u64 {
        HEIGHT * self.springs + self.bytes(Stage::Synthesis).max(self.bytes(Stage::MeasuredProfile))
    }

    /// The profile is made before the contact is solved: the larger of both amounts of memory, with so many bytes
    /// of the profile kept beside its gaps.
    fn peak_of(&self, call: &Call<'_>, kept: u64) -> u64 {
        let contact = [
            Stage::Tree,
            Stage::LoadingPass,
            Stage::Relaxation,
            // At most, if the whole contact under load also exists at first touch.
            Stage::ZeroLoadAdhesion,
        ];
        let curves = call.curve_points * size_of::<CurvePoint>() as u64 + call.bytes_of_sampling();
        let contact = contact.map(|stage| self.bytes(stage)).iter().sum::<u64>();
        (kept + HEIGHT * call.springs + contact + curves).max(self.bytes(Stage::Synthesis))
    }
}
