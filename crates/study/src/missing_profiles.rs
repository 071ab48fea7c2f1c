//! The profiles of a study in memory that are not computed yet, and their computation.

use super::cells::Streak;
use super::error::StudyError;
use super::plan::Plan;
use super::profiles::{Stop, on_profiles};
use super::recorder::{Recorded, with_recorder};
use asperity_data::Warning;
use asperity_scene::{RunError, Simulation};

/// Profiles of a plan that are not computed yet. A profile is computed in all cells of the plan
/// together.
pub(super) struct MissingProfiles {
    pub plan: Plan,
    /// Indices of the random profiles that are to be computed, from 0.
    pub lines: Vec<u64>,
    /// What to do if a cell cannot be computed.
    pub failures: Failures,
}

/// What happens if a cell cannot be computed on a profile.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Failures {
    /// The error of the cell ends the computation.
    End,
    /// The reason of the error is recorded instead of values, and the computation continues.
    Keep,
}

/// Records of one profile in all cells of a plan.
pub(super) struct SolvedProfile {
    pub line: u64,
    pub records: Vec<Recorded>,
    /// Warnings on this profile, one for each cell that does not meet all premises of the model.
    /// Each has the number of the cell and the premises that the cell does not meet.
    pub warnings: Vec<(u64, Vec<Warning>)>,
}

impl MissingProfiles {
    /// Computes the profiles on at most `threads` threads. `receive` is called on the calling
    /// thread with the records of each profile.
    ///
    /// # Errors
    /// Returns an error if a profile or its contact cannot be computed, or if `stop` returned true.
    pub fn solve(
        &self,
        simulation: &mut Simulation,
        threads: usize,
        stop: &Stop<'_>,
        receive: &mut dyn FnMut(SolvedProfile),
    ) -> Result<(), StudyError> {
        on_profiles(
            &self.plan,
            &self.lines,
            simulation,
            threads,
            |simulation: &mut Simulation, line| self.solve_line(simulation, line, stop),
            &mut |_, solved| receive(solved),
        )
    }

    fn solve_line(
        &self,
        simulation: &mut Simulation,
        line: u64,
        stop: &Stop<'_>,
    ) -> Result<SolvedProfile, RunError> {
        let streak = Streak {
            cells: 0..self.plan.cells(),
            line,
        };
        with_recorder(&self.plan, simulation, stop, |recorder| {
            let records = match self.failures {
                Failures::End => recorder.record(&streak)?.into_iter().map(Ok).collect(),
                Failures::Keep => recorder.record_each(&streak)?,
            };
            Ok(SolvedProfile {
                line,
                records,
                warnings: recorder.take_warnings(),
            })
        })
    }
}
