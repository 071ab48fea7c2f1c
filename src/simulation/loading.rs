//! The loading of a prepared contact by the solver of the scene, and F_a(0).

use crate::analysis::Figures;
use crate::contact::{Body, Contact, ContactError, History, Leg, LegRecord, Solver, Stepwise, run};
use crate::scene::{Move, Scene, Solver as SolverChoice};
use std::time::Instant;

/// Result of a loading.
pub(super) struct Loaded {
    pub history: History,
    /// Seconds spent on curves and extremes.
    pub curve_seconds: f64,
    /// F_a(0), N, if requested and if the contact of first touch pulls.
    pub zero_load_adhesion_force: Option<f64>,
    /// Additional seconds for F_a(0).
    pub zero_load_seconds: f64,
}

impl Loaded {
    fn new(history: History, solver: &dyn Solver) -> Self {
        let curve_seconds = solver.curve_seconds();
        Loaded { history, curve_seconds, zero_load_adhesion_force: None, zero_load_seconds: 0.0 }
    }
}

/// Loads a contact with the solver of the scene, and by the touch protocol if F_a(0) is requested.
pub(super) fn load(
    scene: &Scene,
    contact: &Contact,
    zero_load: bool,
    stop: &dyn Fn() -> bool,
    see: &mut dyn FnMut(&LegRecord, &Leg) -> Result<(), ContactError>,
) -> Result<Loaded, ContactError> {
    let samples = scene.numerics.samples as usize;
    match scene.numerics.solver {
        SolverChoice::Stepwise { step } => {
            let body = |samples| Stepwise::new(contact, step, samples, stop);
            let mut solver = body(samples)?;
            let mut loaded = Loaded::new(run(&mut solver, &scene.loading, see)?, &solver);
            if zero_load {
                let clock = Instant::now();
                let touch = run(&mut body(2)?, &[Move::ToTouch, Move::ToSeparation], |_, _| Ok(()))?;
                loaded.zero_load_adhesion_force = Figures::of(&touch).adhesion_force;
                let work = &mut loaded.history.work;
                work.steps += touch.work.steps;
                work.relaxation_sweeps += touch.work.relaxation_sweeps;
                work.spring_updates += touch.work.spring_updates;
                loaded.zero_load_seconds = clock.elapsed().as_secs_f64();
            }
            Ok(loaded)
        }
        SolverChoice::Exact => {
            let mut body = Body::new(contact, samples);
            let mut loaded = Loaded::new(run(&mut body, &scene.loading, see)?, &body);
            if zero_load && contact.has_adhesion() {
                let clock = Instant::now();
                let force = body.pull_off_at_touch()?;
                loaded.history.work = body.work();
                // Not −F, which would make a force of zero negative.
                loaded.zero_load_adhesion_force = Some(0.0 - force).filter(|_| force <= 0.0);
                loaded.zero_load_seconds = clock.elapsed().as_secs_f64();
            }
            Ok(loaded)
        }
    }
}
