//! Loading of a prepared scene with the solver that the scene states.

use super::outcome::{LineFacts, RunError, Timings};
use super::workload::{WorkPart, Workload};
use crate::analysis::governing::Governing;
use crate::scene::model::{Scene, Solver as SolverChoice};
use asperity_contact::motion::{Body, MovingBody, RelaxingBody, Stage, Stepwise, load_body};
use asperity_contact::{Contact, ContactError, Figures, History, Move, Patch, StageRecord};
use asperity_data::Warning;
use std::time::Instant;

/// Contact of a scene before its loading, with facts about its profile.
pub(super) struct Prepared {
    pub contact: Contact,
    pub facts: LineFacts,
    pub governing: Governing,
    pub random_phases: u64,
    pub heights_binned: u64,
    /// Times in s for the profile and the tree.
    pub timings: Timings,
    /// Warnings about the scene before its loading.
    pub warnings: Vec<Warning>,
}

/// Function that [`Simulation::run`](super::stages::Simulation::run) calls after each loading
/// stage. Its arguments are the index of the stage, the record of the stage with its force curve
/// ([`StageRecord`]), and the motion ([`Stage`]), which gives the contact at each indentation. If
/// the function returns an error, the computation ends with this error.
pub type AfterStage<'a> = dyn FnMut(usize, &StageRecord, &Stage) -> Result<(), ContactError> + 'a;

/// Result of the loading of a scene.
pub(super) struct Loaded {
    pub history: History,
    /// Contact patches at the end of each loading stage.
    pub patches: Vec<Vec<Patch>>,
    /// F_a(d=0) and F_a(F=0) in N; `None` if they were not computed.
    pub without_preload: [Option<f64>; 2],
}

impl Prepared {
    /// Loads the contact of a scene. `after` is called after each loading stage.
    pub fn load(
        &mut self,
        scene: &Scene,
        plan: &Workload,
        stop: &dyn Fn() -> bool,
        after: &mut AfterStage<'_>,
    ) -> Result<Loaded, RunError> {
        let first_spring = self.facts.first;
        let begun = Instant::now();
        let mut stage = 0;
        let mut patches = Vec::new();
        let mut after_stage = |record: &StageRecord, motion: &Stage| {
            check_interruption(stop)?;
            if plan.runs(WorkPart::Patches) {
                patches.push(patches_at_end(record, motion, first_spring));
            }
            stage += 1;
            after(stage - 1, record, motion)
        };
        let (mut history, without_preload) = load(
            scene,
            &self.contact,
            plan.runs(WorkPart::WithoutPreload),
            &mut self.timings,
            stop,
            &mut after_stage,
        )?;
        let timings = &mut self.timings;
        let seconds = begun.elapsed().as_secs_f64();
        timings.passes = (seconds - timings.curve - timings.without_preload).max(0.0);
        for contact in &mut history.contacts {
            *contact = on_foundation(*contact, first_spring);
        }
        history.work.random_phases = self.random_phases;
        history.work.transforms = u64::from(self.random_phases > 0);
        history.work.heights_binned = self.heights_binned;
        Ok(Loaded {
            history,
            patches,
            without_preload,
        })
    }
}

pub(super) fn check_interruption(stop: &dyn Fn() -> bool) -> Result<(), ContactError> {
    if stop() {
        Err(ContactError::Interrupted)
    } else {
        Ok(())
    }
}

/// Returns the patches at the end of a loading stage. `first_spring` is the index of the first
/// spring under the body.
fn patches_at_end(record: &StageRecord, motion: &Stage, first_spring: usize) -> Vec<Patch> {
    let Some(end) = record.end_in_contact() else {
        return Vec::new();
    };
    motion
        .patches(end.indentation)
        .into_iter()
        .map(|patch| on_foundation(patch, first_spring))
        .collect()
}

/// Returns a patch whose indices count from the first spring of the foundation. The indices of the
/// given patch count from the first spring under the body.
fn on_foundation(patch: Patch, first_spring: usize) -> Patch {
    Patch {
        first: patch.first + first_spring,
        last: patch.last + first_spring,
    }
}

/// Loads a contact with the solver of the scene. Returns its history. If the contact has adhesion
/// and `without_preload` is true, also returns F_a(d=0) and F_a(F=0) in N.
fn load(
    scene: &Scene,
    contact: &Contact,
    without_preload: bool,
    timings: &mut Timings,
    stop: &dyn Fn() -> bool,
    see: &mut dyn FnMut(&StageRecord, &Stage) -> Result<(), ContactError>,
) -> Result<(History, [Option<f64>; 2]), ContactError> {
    match scene.numerics.solver {
        SolverChoice::Stepwise { step } => {
            load_stepwise(scene, contact, step, without_preload, timings, stop, see)
        }
        SolverChoice::Exact if contact.relaxation().is_some() => {
            let mut body = RelaxingBody::new(contact)?.with_stop(stop);
            Ok((load_body(&mut body, &scene.loading, see)?, [None; 2]))
        }
        SolverChoice::Exact => load_exactly(scene, contact, without_preload, timings, see),
    }
}

fn load_exactly(
    scene: &Scene,
    contact: &Contact,
    without_preload: bool,
    timings: &mut Timings,
    see: &mut dyn FnMut(&StageRecord, &Stage) -> Result<(), ContactError>,
) -> Result<(History, [Option<f64>; 2]), ContactError> {
    let mut body = Body::new(contact, scene.numerics.samples as usize);
    let mut history = load_body(&mut body, &scene.loading, see)?;
    timings.curve = body.curve_seconds();
    let mut forces = [None; 2];
    if without_preload && contact.has_adhesion() {
        let begun = Instant::now();
        forces = body.adhesion_without_preload()?;
        history.work = body.work();
        timings.without_preload = begun.elapsed().as_secs_f64();
    }
    Ok((history, forces))
}

fn load_stepwise(
    scene: &Scene,
    contact: &Contact,
    step: f64,
    without_preload: bool,
    timings: &mut Timings,
    stop: &dyn Fn() -> bool,
    see: &mut dyn FnMut(&StageRecord, &Stage) -> Result<(), ContactError>,
) -> Result<(History, [Option<f64>; 2]), ContactError> {
    let samples = scene.numerics.samples as usize;
    let mut solver = Stepwise::new(contact, step, samples, stop)?;
    let mut history = load_body(&mut solver, &scene.loading, see)?;
    timings.curve = solver.curve_seconds();
    let mut forces = [None; 2];
    if !without_preload {
        return Ok((history, forces));
    }
    let begun = Instant::now();
    for (force, turn) in forces.iter_mut().zip([Move::ToTouch, Move::ToZeroForce]) {
        let mut solver = Stepwise::new(contact, step, 2, stop)?;
        let turned = match load_body(&mut solver, &[turn, Move::ToSeparation], |_, _| Ok(())) {
            Ok(turned) => turned,
            Err(ContactError::Interrupted) => return Err(ContactError::Interrupted),
            // If the steps of the stepwise solver do not reach a turning point, the pull-off force
            // after this turning point remains unknown.
            Err(_) => continue,
        };
        *force = Figures::of(&turned).pull_off_force;
        history.work.steps += turned.work.steps;
        history.work.equilibrium_sweeps += turned.work.equilibrium_sweeps;
        history.work.spring_updates += turned.work.spring_updates;
    }
    timings.without_preload = begun.elapsed().as_secs_f64();
    Ok((history, forces))
}
