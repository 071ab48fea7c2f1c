//! Memory of a study, for as many threads as it may take.

use super::axis::Axis;
use super::plan::{MOST_CHECKED, Plan};
use crate::simulation;

/// Code, stacks, files and the reserve of the allocator, bytes.
const PROGRAM: u64 = 16 << 20;
/// Bytes per spring of a transform that is kept for the next profile, up to [`LONGEST_KEPT`] springs.
const KEPT: u64 = 20;
const LONGEST_KEPT: u64 = 1 << 22;
/// Bytes per spring of the unloadings from several preloads, where nearly every spring is an event.
const REVERSED: u64 = 192;

/// Memory of a study, bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Memory {
    /// Memory of one thread.
    pub job: u64,
    /// Memory shared by all threads.
    pub shared: u64,
}

impl Memory {
    /// Memory of a study of this plan: that of its largest scene.
    pub fn of(plan: &Plan) -> Memory {
        let of_cell = |cell| {
            let scene = plan.scene_of(cell).ok()?;
            let spare = 16 * scene.numerics.samples * scene.loading.len() as u64;
            let peak = simulation::Plan::of(&scene).peak_bytes;
            let points = scene.numerics.points;
            let kept = if points <= LONGEST_KEPT { KEPT * points } else { 0 };
            // The contact without adhesion or at zero force may add to the memory of the scene itself.
            let turns = plan.preloads().is_some() && scene.adhesion.is_some();
            let reversed = if turns { REVERSED * points } else { 0 };
            Some((peak + kept + reversed, spare))
        };
        let cells = plan.extremes(MOST_CHECKED).into_iter().filter_map(of_cell);
        let (job, spare) = cells.fold((0, 0), |(job, spare), one| (job.max(one.0), spare.max(one.1)));
        // The axes, and one byte for each record.
        let values: u64 = plan.axes.iter().map(Axis::count).sum();
        Memory { job: job + spare, shared: PROGRAM + 8 * values + plan.records_in_all() }
    }

    /// Memory with this number of threads, bytes.
    pub fn of_jobs(&self, jobs: u64) -> u64 {
        self.shared + jobs * self.job
    }
}
