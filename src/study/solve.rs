//! The runner of studies: solves cases unit by unit and passes each record to a sink.

use super::cells::{Cells, Unit};
use super::recorder::{Recorder, Records};
use super::target::strip;
use crate::simulation::RunError;
use std::ops::{ControlFlow, Range};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// One run of a plan on one profile.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Case {
    /// Cells of the run, which differ in the preload alone.
    pub cells: Range<u64>,
    /// Number of the profile.
    pub line: u64,
}

/// Next step of a runner.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Next {
    /// Solves the case.
    Solve,
    /// Skips the case.
    Skip,
    /// Ends the work.
    End,
}

/// Receiver of records.
pub(super) trait Sink {
    /// Next step before a case.
    fn next(&mut self, case: &Case) -> Next;

    /// Takes the records of a case, or the reason of their absence; `Break` ends the work.
    fn take(&mut self, case: Case, records: Result<Records, RunError>) -> ControlFlow<()>;
}

/// Solves the cases of a unit that the sink requests; `Break` if the sink ends the work.
pub(super) fn solve_unit(
    cells: &Cells<'_>,
    unit: &Unit,
    recorder: &mut Recorder<'_>,
    sink: &mut dyn Sink,
) -> ControlFlow<()> {
    let plan = recorder.plan();
    for run in cells.runs_of(unit) {
        let case = Case { cells: run, line: unit.line };
        match sink.next(&case) {
            Next::Solve => {}
            Next::Skip => continue,
            Next::End => return ControlFlow::Break(()),
        }
        // The scene of every cell has been checked.
        if let Ok(mut scene) = plan.scene_of(case.cells.start) {
            strip(&mut scene);
            scene.set_seed(plan.seed_of(case.line));
            let records = recorder.record(scene);
            sink.take(case, records)?;
        }
    }
    ControlFlow::Continue(())
}

/// Units of a plan that several threads share.
pub(super) struct SharedWork<'p, I> {
    cells: &'p Cells<'p>,
    /// The remaining units; `None` once a sink has ended the work.
    units: Mutex<Option<I>>,
}

impl<'p, I: Iterator<Item = Unit>> SharedWork<'p, I> {
    /// Work on these units.
    pub fn new(cells: &'p Cells<'p>, units: I) -> Self {
        SharedWork { cells, units: Mutex::new(Some(units)) }
    }

    /// Solves one unit after the other until none is left or a sink ends the work of all threads.
    pub fn solve(&self, mut recorder: Recorder<'_>, sink: &mut dyn Sink) {
        let next = || self.units().as_mut()?.next();
        while let Some(unit) = next() {
            if solve_unit(self.cells, &unit, &mut recorder, sink).is_break() {
                *self.units() = None;
            }
        }
    }

    fn units(&self) -> MutexGuard<'_, Option<I>> {
        self.units.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
