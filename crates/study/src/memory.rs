//! Memory in bytes that the computation of a study needs.

use super::axis::Axis;
use super::error::StudyError;
use super::plan::{MOST_CHECKED, Plan};
use asperity_data::check_room;

/// Memory in bytes for the code of the program, its stacks and files, and the reserve of the
/// allocator.
const PROGRAM: u64 = 16 << 20;
/// Memory in bytes per spring for a Fourier transform, which each thread keeps for the next profile
/// if the profile has at most [`LONGEST_KEPT`] springs.
const KEPT: u64 = 20;
const LONGEST_KEPT: u64 = 1 << 22;
/// Memory in bytes per spring for the unloadings from several preloads. It is large because nearly
/// every spring causes an event.
const REVERSED: u64 = 192;

impl Plan {
    /// Returns the memory in bytes that a study of this plan needs at most on `jobs` threads.
    ///
    /// # Errors
    /// Returns an error if the study needs more memory than the system provides now.
    pub fn memory(&self, jobs: u64) -> Result<u64, StudyError> {
        let mut job = 0;
        let mut spare = 0;
        for cell in self.extremes(MOST_CHECKED) {
            let Ok(scene) = self.scene_of(cell) else {
                continue;
            };
            spare = spare.max(16 * scene.numerics.samples * scene.loading.len() as u64);
            let peak = asperity_scene::workload::Workload::of(&scene).peak_bytes;
            let points = scene.numerics.points;
            let kept = if points <= LONGEST_KEPT {
                KEPT * points
            } else {
                0
            };
            // Unloading from several preloads, and the contacts without adhesion and at zero force,
            // may need more memory than the loading of the scene.
            let turns = self.preloads().is_some() && scene.adhesion.is_some();
            let reversed = if turns { REVERSED * points } else { 0 };
            job = job.max(peak + kept + reversed);
        }
        // The axes take 8 bytes for each value, and the study takes one byte for each record.
        let values: u64 = self.axes.iter().map(Axis::count).sum();
        let bytes = PROGRAM + 8 * values + self.records_in_all() + jobs.saturating_mul(job + spare);
        check_room(bytes).map_err(|_| StudyError::Memory { jobs, bytes })?;
        Ok(bytes)
    }
}
