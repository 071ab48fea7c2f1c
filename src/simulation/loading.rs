//! The loading of a prepared contact by the solver of the scene, and F_a(0).

use super::Timings;
use crate::analysis::Figures;
use crate::contact::{Body, Contact, ContactError, History, Leg, LegRecord, Solver, Stepwise, run};
use crate::scene::{Move, Scene, Solver as SolverChoice};
use std::time::Instant;

/// Loads a contact with the solver of the scene and, if F_a(0) is requested, turned at first touch and at zero force.
/// Returns the history, and F_a(0) by both protocols, N, where the contact pulls.
pub(super) fn load(
    scene: &Scene,
    contact: &Contact,
    zero_load: bool,
    timings: &mut Timings,
    stop: &dyn Fn() -> bool,
    see: &mut dyn FnMut(&LegRecord, &Leg) -> Result<(), ContactError>,
) -> Result<(History, [Option<f64>; 2]), ContactError> {
    let samples = scene.numerics.samples as usize;
    let mut forces = [None; 2];
    match scene.numerics.solver {
        SolverChoice::Stepwise { step } => {
            let body = |samples| Stepwise::new(contact, step, samples, stop);
            let mut solver = body(samples)?;
            let mut history = run(&mut solver, &scene.loading, see)?;
            timings.curve = solver.curve_seconds();
            if zero_load {
                let clock = Instant::now();
                for (force, turn) in forces.iter_mut().zip([Move::ToTouch, Move::ToZeroForce]) {
                    let turned = match run(&mut body(2)?, &[turn, Move::ToSeparation], |_, _| Ok(())) {
                        Err(ContactError::Interrupted) => return Err(ContactError::Interrupted),
                        // A turn out of reach of the steps has no F_a(0).
                        Err(_) => continue,
                        Ok(turned) => turned,
                    };
                    *force = Figures::of(&turned).adhesion_force;
                    let work = &mut history.work;
                    work.steps += turned.work.steps;
                    work.relaxation_sweeps += turned.work.relaxation_sweeps;
                    work.spring_updates += turned.work.spring_updates;
                }
                timings.zero_load = clock.elapsed().as_secs_f64();
            }
            Ok((history, forces))
        }
        SolverChoice::Exact => {
            let mut body = Body::new(contact, samples);
            let mut history = run(&mut body, &scene.loading, see)?;
            timings.curve = body.curve_seconds();
            if zero_load && contact.has_adhesion() {
                let clock = Instant::now();
                forces = body.zero_load_adhesion()?;
                history.work = body.work();
                timings.zero_load = clock.elapsed().as_secs_f64();
            }
            Ok((history, forces))
        }
    }
}
