//! The loading of a prepared contact by the solver of the scene, and F_a(0).

use super::Timings;
use crate::analysis::Figures;
use crate::contact::{Body, Contact, ContactError, History, Leg, LegRecord, Solver, Stepwise, run};
use crate::scene::{Move, Scene, Solver as SolverChoice};
use std::time::Instant;

/// Loads a contact with the solver of the scene, and by the touch protocol if F_a(0) is requested. Returns the history,
/// and F_a(0), N, if the contact of first touch pulls.
pub(super) fn load(
    scene: &Scene,
    contact: &Contact,
    zero_load: bool,
    timings: &mut Timings,
    stop: &dyn Fn() -> bool,
    see: &mut dyn FnMut(&LegRecord, &Leg) -> Result<(), ContactError>,
) -> Result<(History, Option<f64>), ContactError> {
    let samples = scene.numerics.samples as usize;
    let mut force = None;
    match scene.numerics.solver {
        SolverChoice::Stepwise { step } => {
            let body = |samples| Stepwise::new(contact, step, samples, stop);
            let mut solver = body(samples)?;
            let mut history = run(&mut solver, &scene.loading, see)?;
            timings.curve = solver.curve_seconds();
            if zero_load {
                let clock = Instant::now();
                let touch = run(&mut body(2)?, &[Move::ToTouch, Move::ToSeparation], |_, _| Ok(()))?;
                force = Figures::of(&touch).adhesion_force;
                let work = &mut history.work;
                work.steps += touch.work.steps;
                work.relaxation_sweeps += touch.work.relaxation_sweeps;
                work.spring_updates += touch.work.spring_updates;
                timings.zero_load = clock.elapsed().as_secs_f64();
            }
            Ok((history, force))
        }
        SolverChoice::Exact => {
            let mut body = Body::new(contact, samples);
            let mut history = run(&mut body, &scene.loading, see)?;
            timings.curve = body.curve_seconds();
            if zero_load && contact.has_adhesion() {
                let clock = Instant::now();
                let least = body.pull_off_at_touch()?;
                history.work = body.work();
                // Not −F, which would make a force of zero negative.
                force = Some(0.0 - least).filter(|_| least <= 0.0);
                timings.zero_load = clock.elapsed().as_secs_f64();
            }
            Ok((history, force))
        }
    }
}
