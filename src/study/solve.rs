//! The runner of studies: solves cases unit by unit and hands each record to a sink.
//!
//! `run --lines` is one cell on many profiles, a sweep many cells with a folder as sink, the live map a sequence of
//! units from coarse to fine.

use super::cells::{Cells, Unit};
use super::plan::Plan;
use super::recorder::{Recorder, Records};
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
    /// Leaves the case out.
    Skip,
    /// Ends the work.
    End,
}

/// Solver of one case.
pub(super) trait CaseSolver {
    /// Result on one profile.
    type Record;

    /// Solves a scene on the profile of a seed.
    ///
    /// # Errors
    /// When the profile or the contact fails, or when stopped.
    fn solve(&mut self, scene: &mut Scene, seed: u64) -> Result<Self::Record, RunError>;
}

impl CaseSolver for Recorder<'_> {
    type Record = Records;

    fn solve(&mut self, scene: &mut Scene, seed: u64) -> Result<Records, RunError> {
        self.record(scene, seed)
    }
}

/// Receiver of records.
pub(crate) trait Sink<R = Records> {
    /// Next step before a case.
    fn next(&mut self, case: Case) -> Next;

    /// Takes the records of a case, or the reason why there are none; `Break` ends the work.
    fn take(&mut self, case: Case, records: Result<R, RunError>) -> ControlFlow<()>;
}

/// Runner on one thread. Neighbouring cases share the profile and its tree.
pub(super) struct Solver<'p, C> {
    plan: &'p Plan,
    cells: &'p Cells,
    of_case: C,
    scene: Scene,
}

impl<'p, C: CaseSolver> Solver<'p, C> {
    /// A runner of a plan, each case by a solver.
    pub fn new(plan: &'p Plan, cells: &'p Cells, of_case: C) -> Self {
        Solver { plan, cells, of_case, scene: plan.prototype() }
    }

    /// Solves the cases of a unit that the sink wants; `Break` where the sink ends the work.
    pub fn solve(&mut self, unit: &Unit, sink: &mut dyn Sink<C::Record>) -> ControlFlow<()> {
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
                sink.take(case, self.of_case.solve(&mut self.scene, seed))?;
            }
        }
        ControlFlow::Continue(())
    }
}

/// Units of a plan that several threads share.
pub(super) struct SharedWork<'p, I> {
    plan: &'p Plan,
    cells: &'p Cells,
    /// The units that no thread has taken; `None` once a sink has ended the work.
    units: Mutex<Option<I>>,
}

impl<'p, I: Iterator<Item = Unit>> SharedWork<'p, I> {
    /// Work on these units.
    pub fn new(plan: &'p Plan, cells: &'p Cells, units: I) -> Self {
        SharedWork { plan, cells, units: Mutex::new(Some(units)) }
    }

    /// Solves one unit after the other until none is left or a sink ends the work of all threads.
    pub fn solve<C: CaseSolver>(&self, of_case: C, sink: &mut dyn Sink<C::Record>) {
        let mut solver = Solver::new(self.plan, self.cells, of_case);
        while let Some(unit) = self.next_unit() {
            if solver.solve(&unit, sink).is_break() {
                *self.units() = None;
            }
        }
    }

    fn next_unit(&self) -> Option<Unit> {
        self.units().as_mut()?.next()
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
    use std::sync::atomic::{AtomicUsize, Ordering};
    use std::time::{Duration, Instant};

    /// Waits for other sinks before its first case and ends the work after a number of cases of all.
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
                        work.solve(Recorder::new(plan, Simulation::default(), &|| false), &mut sink);
                    });
                }
            });
            let taken = taken.into_inner();
            assert!((most..most + threads).contains(&taken), "{taken} of {most} on {threads} threads");
        }
    }
}
