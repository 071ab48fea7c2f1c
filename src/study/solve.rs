//! The runner of studies: solves cases unit by unit and passes each record to a sink.
//!
//! `run --lines` is one cell on many profiles, a sweep many cells with a folder as sink, the live map a sequence of
//! units from coarse to fine.

use super::cells::{Cells, Unit};
use super::plan::Plan;
use super::recorder::Records;
use crate::scene::Scene;
use crate::simulation::RunError;
use std::ops::ControlFlow;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// One run of a plan, which is all cells that differ in the preload alone, on one profile.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Case {
    /// Number of the run.
    pub run: u64,
    /// Number of the profile.
    pub line: u64,
}

/// Next step of a runner.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Next {
    /// Solves the case.
    Solve,
    /// Skips the case.
    Skip,
    /// Ends the work.
    End,
}

/// Receiver of records.
pub(crate) trait Sink<R = Records> {
    /// Next step before a case.
    fn next(&mut self, case: Case) -> Next;

    /// Takes the records of a case, or the reason of their absence; `Break` ends the work.
    fn take(&mut self, case: Case, records: Result<R, RunError>) -> ControlFlow<()>;
}

/// Runner on one thread. Neighbouring cases share the profile and its tree.
pub(super) struct Solver<'p, C> {
    plan: &'p Plan,
    cells: &'p Cells,
    /// Solves a scene on the profile of a seed.
    of_case: C,
    scene: Scene,
}

impl<'p, C> Solver<'p, C> {
    /// A runner of a plan; `of_case` solves a scene on the profile of a seed.
    pub fn new<R>(plan: &'p Plan, cells: &'p Cells, of_case: C) -> Self
    where
        C: FnMut(&mut Scene, u64) -> Result<R, RunError>,
    {
        Solver { plan, cells, of_case, scene: plan.prototype() }
    }

    /// Solves the cases of a unit that the sink requests; `Break` if the sink ends the work.
    pub fn solve<R>(&mut self, unit: &Unit, sink: &mut dyn Sink<R>) -> ControlFlow<()>
    where
        C: FnMut(&mut Scene, u64) -> Result<R, RunError>,
    {
        let seed = self.plan.seed_of(unit.line);
        for run in self.cells.runs_of(unit) {
            let case = Case { run, line: unit.line };
            match sink.next(case) {
                Next::Solve => {}
                Next::Skip => continue,
                Next::End => return ControlFlow::Break(()),
            }
            // The scene of every cell has been checked.
            if self.cells.shape(run, &self.plan.scene, &mut self.scene).is_ok() {
                sink.take(case, (self.of_case)(&mut self.scene, seed))?;
            }
        }
        ControlFlow::Continue(())
    }
}

/// Units of a plan that several threads share.
pub(super) struct SharedWork<'p, I> {
    plan: &'p Plan,
    cells: &'p Cells,
    /// The remaining units; `None` once a sink has ended the work.
    units: Mutex<Option<I>>,
}

impl<'p, I: Iterator<Item = Unit>> SharedWork<'p, I> {
    /// Work on these units.
    pub fn new(plan: &'p Plan, cells: &'p Cells, units: I) -> Self {
        SharedWork { plan, cells, units: Mutex::new(Some(units)) }
    }

    /// Solves one unit after the other until none is left or a sink ends the work of all threads.
    pub fn solve<R>(
        &self,
        of_case: impl FnMut(&mut Scene, u64) -> Result<R, RunError>,
        sink: &mut dyn Sink<R>,
    ) {
        let mut solver = Solver::new(self.plan, self.cells, of_case);
        let next = || self.units().as_mut()?.next();
        while let Some(unit) = next() {
            if solver.solve(&unit, sink).is_break() {
                *self.units() = None;
            }
        }
    }

    fn units(&self) -> MutexGuard<'_, Option<I>> {
        self.units.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Roughness, open};
    use crate::simulation::Simulation;
    use crate::study::Quantity;
    use crate::study::recorder::Recorder;
    use std::sync::atomic::{AtomicUsize, Ordering};
    use std::time::{Duration, Instant};

    /// Sink that waits for others before its first case and ends the work after a total number of cases.
    struct Meeting<'a> {
        met: &'a AtomicUsize,
        threads: usize,
        taken: &'a AtomicUsize,
        most: usize,
        first: bool,
    }

    impl Sink for Meeting<'_> {
        fn next(&mut self, _: Case) -> Next {
            if std::mem::take(&mut self.first) {
                self.met.fetch_add(1, Ordering::SeqCst);
                let clock = Instant::now();
                while self.met.load(Ordering::SeqCst) < self.threads {
                    assert!(clock.elapsed() < Duration::from_secs(30), "threads wait for each other");
                    std::thread::yield_now();
                }
            }
            Next::Solve
        }

        fn take(&mut self, _: Case, records: Result<Records, RunError>) -> ControlFlow<()> {
            assert_eq!(records.unwrap().concat().len(), 1);
            let taken = self.taken.fetch_add(1, Ordering::SeqCst) + 1;
            if taken < self.most { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        }
    }

    #[test]
    fn threads_solve_units_at_the_same_time_and_end_together() {
        let mut scene = open("pressure-sensitive").unwrap().scene().clone();
        scene.numerics.points = 64;
        if let Some(Roughness::SelfAffine { modes, .. }) = &mut scene.roughness {
            *modes = (1, 16);
        }
        let plan = Plan::of_scene(&scene, 50, &[Quantity::AdhesionForce]);
        let cells = Cells::of(&plan);
        for (threads, most) in [(1, 50), (3, 50), (3, 20)] {
            let work = SharedWork::new(&plan, &cells, (0..cells.units()).map(|unit| cells.unit(unit)));
            let (met, taken) = (AtomicUsize::new(0), AtomicUsize::new(0));
            std::thread::scope(|scope| {
                for _ in 0..threads {
                    let mut sink = Meeting { met: &met, threads, taken: &taken, most, first: true };
                    let (work, plan) = (&work, &plan);
                    scope.spawn(move || {
                        let mut recorder = Recorder::new(plan, Simulation::default(), &|| false);
                        work.solve(|scene, seed| recorder.record(scene, seed), &mut sink);
                    });
                }
            });
            let taken = taken.into_inner();
            assert!((most..most + threads).contains(&taken), "{taken} of {most} on {threads} threads");
        }
    }
}
