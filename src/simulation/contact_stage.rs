//! The contact stage of a run: the loading by the solver of the scene and F_a(0).

use super::AfterLeg;
use crate::analysis::Figures;
use crate::contact::{Body, Contact, ContactError, History, Leg, LegRecord, Solver, Stepwise, run};
use crate::scene::{Move, Scene, Solver as SolverChoice};
use std::time::Instant;

/// Parameters of the contact of one run.
pub(super) struct ContactStage<'a> {
    pub contact: Contact,
    /// Number of the first spring under the body, from the first one of the foundation.
    pub first: usize,
    pub scene: &'a Scene,
    pub stop: &'a dyn Fn() -> bool,
}

/// Result of the contact stage.
pub(super) struct Contacted {
    pub history: History,
    /// Seconds spent on curves and extremes.
    pub curve_seconds: f64,
    /// F_a(0), N, if requested and if the contact of first touch pulls.
    pub zero_load_adhesion_force: Option<f64>,
    /// Additional seconds of the run for F_a(0).
    pub zero_load_seconds: f64,
}

impl ContactStage<'_> {
    /// Runs the loading of the scene with its solver, and the touch protocol if F_a(0) is requested.
    pub fn run(&self, zero_load: bool, after: &mut AfterLeg<'_>) -> Result<Contacted, ContactError> {
        let samples = self.scene.numerics.samples as usize;
        match self.scene.numerics.solver {
            SolverChoice::Stepwise { step } => {
                let body = |samples| Stepwise::new(&self.contact, step, samples, self.stop);
                let mut contacted = self.load(&mut body(samples)?, after)?;
                if zero_load {
                    let clock = Instant::now();
                    let touch = [Move::ToTouch, Move::ToSeparation];
                    let touch = run(&mut body(2)?, &touch, |_, _| Ok(()))?;
                    contacted.zero_load_adhesion_force = Figures::of(&touch).adhesion_force;
                    let work = &mut contacted.history.work;
                    work.steps += touch.work.steps;
                    work.relaxation_sweeps += touch.work.relaxation_sweeps;
                    work.spring_updates += touch.work.spring_updates;
                    contacted.zero_load_seconds = clock.elapsed().as_secs_f64();
                }
                Ok(contacted)
            }
            SolverChoice::Exact => {
                let mut body = self.body();
                let mut contacted = self.load(&mut body, after)?;
                if zero_load && self.contact.has_adhesion() {
                    let clock = Instant::now();
                    let force = body.pull_off_at_touch()?;
                    contacted.history.work = body.work();
                    // Not −F, which would make a force of zero negative.
                    contacted.zero_load_adhesion_force =
                        Some(force).filter(|&force| force <= 0.0).map(|force| 0.0 - force);
                    contacted.zero_load_seconds = clock.elapsed().as_secs_f64();
                }
                Ok(contacted)
            }
        }
    }

    /// The separated body of the exact solver.
    pub fn body(&self) -> Body {
        Body::new(&self.contact, self.scene.numerics.samples as usize)
    }

    /// Runs the loading of the scene.
    fn load(&self, body: &mut dyn Solver, after: &mut AfterLeg<'_>) -> Result<Contacted, ContactError> {
        let mut stage = 0;
        let mut history = run(body, &self.scene.loading, |record, leg| {
            if (self.stop)() {
                return Err(ContactError::Interrupted);
            }
            after(stage, record, leg)?;
            stage += 1;
            Ok(())
        })?;
        history.contacts.iter_mut().for_each(|contact| *contact = self.on_foundation(*contact));
        Ok(Contacted {
            history,
            curve_seconds: body.curve_seconds(),
            zero_load_adhesion_force: None,
            zero_load_seconds: 0.0,
        })
    }

    /// The fragments in contact at the end of a loading stage.
    pub fn fragments_after(&self, record: &LegRecord, leg: &Leg) -> Vec<(usize, usize)> {
        match record.curve.last() {
            Some(end) if end.springs > 0 => {
                leg.patches(end.indentation).into_iter().map(|patch| self.on_foundation(patch)).collect()
            }
            _ => Vec::new(),
        }
    }

    /// Springs under the body, numbered from the first spring of the foundation.
    fn on_foundation(&self, (first, last): (usize, usize)) -> (usize, usize) {
        (first + self.first, last + self.first)
    }
}
