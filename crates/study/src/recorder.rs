//! Computation of the recorded quantities of a streak, which consists of all cells that differ only
//! in the preload, on one profile.

use super::case_outcome::{CaseOutcome, LoadingOutcome, ProfileRecord};
use super::cells::Streak;
use super::plan::{Plan, StiffnessRange};
use super::quantity::{Needs, Quantity};
use asperity_contact::{ContactError, Move};
use asperity_data::{Warning, printable, slope};
use asperity_scene::{CheckedScene, Governing, Outcome, Roughness, RunError, Simulation, Solver};
use asperity_surface::SurfaceError;
use std::mem::take;

/// For each preload, the values of the recorded quantities in the order of the plan; NaN for a
/// quantity that has no value.
pub(super) type Records = Vec<Vec<f64>>;

/// Values of a record or, if they cannot be computed, the reason as one line of text.
pub(super) type Recorded = Result<Vec<f64>, String>;

/// Recorder, which computes the records of a plan. A record has the recorded quantities of one cell
/// on one profile. The recorder keeps the profile, its contact tree and its statistics for the next
/// record on the same profile.
pub(super) struct Recorder<'p> {
    plan: &'p Plan,
    pub simulation: Simulation,
    /// Scene of the last profile without adhesion and loading, and the properties of this profile.
    profile: Option<(CheckedScene, ProfileRecord)>,
    /// For each recorded cell with such warnings, its number and the premises of the model that it
    /// does not meet.
    warnings: Vec<(u64, Vec<Warning>)>,
    stop: &'p dyn Fn() -> bool,
}

/// Outcomes of several loadings, each of which starts in separation.
#[derive(Default)]
struct SolvedLoops {
    loadings: Vec<LoadingOutcome>,
    /// Pull-off force F_a(d=0) in N of a loading that turns at first touch.
    first_touch: Option<f64>,
}

/// Returns the move at whose end a loading turns, if the loading consists of this move and a
/// separation; `None` for any other loading.
fn turn_of(loading: &[Move]) -> Option<Move> {
    match loading {
        [
            turn @ (Move::ToForce(_) | Move::ToTouch | Move::ToZeroForce),
            Move::ToSeparation,
        ] => Some(*turn),
        _ => None,
    }
}

impl<'p> Recorder<'p> {
    /// Creates a recorder, which computes the cells of a plan and returns their recorded
    /// quantities. The recorder stops, even within the computation of a cell, as soon as the
    /// function `stop` returns true.
    pub fn new(plan: &'p Plan, simulation: Simulation, stop: &'p dyn Fn() -> bool) -> Self {
        Recorder {
            plan,
            simulation,
            profile: None,
            warnings: Vec::new(),
            stop,
        }
    }

    /// Returns the warnings collected so far, and removes them from this recorder. There is a
    /// warning for each cell that does not meet all premises of the model. It has the number of the
    /// cell and the premises that the cell does not meet.
    pub fn take_warnings(&mut self) -> Vec<(u64, Vec<Warning>)> {
        take(&mut self.warnings)
    }

    /// Computes a streak, which consists of all cells of the plan that differ only in the preload,
    /// on one profile. A cell that cannot be computed gets the reason instead of values.
    ///
    /// # Errors
    /// Returns an error if the memory does not suffice, or if the function `stop` of this recorder
    /// returned true. Both are independent of the values of the cell.
    pub fn record_each(&mut self, streak: &Streak) -> Result<Vec<Recorded>, RunError> {
        let error = match self.record(streak) {
            Ok(records) => return Ok(records.into_iter().map(Ok).collect()),
            Err(error) => error,
        };
        if is_of_machine(&error) {
            return Err(error);
        }
        if streak.cells.end - streak.cells.start == 1 {
            let reason = error.to_string();
            let first_line = reason.lines().next().unwrap_or_default();
            return Ok(vec![Err(printable(first_line).into_owned())]);
        }
        // The error may be due to a single preload, such as a force that cannot be reached. Each
        // preload is therefore computed separately.
        let mut records = Vec::new();
        for cell in streak.cells.clone() {
            let cells = cell..cell + 1;
            let line = streak.line;
            records.extend(self.record_each(&Streak { cells, line })?);
        }
        Ok(records)
    }

    /// Computes the records of a streak. A streak consists of all [cells](Plan) that differ only in
    /// the preload, so that one loading of the profile is enough. A record has the recorded
    /// quantities of one cell.
    ///
    /// # Errors
    /// Returns an error if the profile or the contact cannot be computed, or if the user has
    /// stopped the computation.
    pub fn record(&mut self, streak: &Streak) -> Result<Records, RunError> {
        let plan = self.plan;
        let scene = plan
            .scene_of(streak.cells.start)?
            .with_seed(plan.seed_of(streak.line))
            .stripped();
        let profile = self.profile_record(&scene)?;
        let (_, _, governing) = self.simulation.make_line(&scene)?;
        let mut loops = self.loops(streak, &scene, &governing);
        let count = loops.len();
        let [needs_touch_regime, needs_regime] =
            Quantity::REGIMES.map(|regime| plan.column(regime).is_some());
        let needs_zero_force = plan.records(Needs::ZeroForce) || needs_regime;
        if needs_zero_force {
            loops.push(vec![Move::ToZeroForce, Move::ToSeparation]);
        }
        let mut solved = SolvedLoops::default();
        if !loops.is_empty() || plan.records(Needs::Touch) {
            solved = self.solve(&scene, &governing, loops)?;
        }
        let first_touch = solved.first_touch;
        let mut loadings = solved.loadings;
        let mut zero_force = None;
        if needs_zero_force {
            let loading = loadings.get(count);
            zero_force = loading.and_then(|loading| loading.figures.pull_off_force);
        }
        loadings.truncate(count);
        let cells = (streak.cells.end - streak.cells.start) as usize;
        loadings.resize(cells, LoadingOutcome::default());
        let warnings_of_scene = self.simulation.warnings(&scene)?;
        let mut records = Vec::with_capacity(cells);
        for (loading, cell) in loadings.into_iter().zip(streak.cells.clone()) {
            let mut smooth = None;
            // The smooth body is computed without relaxation. A scene that relaxes cannot be
            // compared with it.
            if (needs_touch_regime || needs_regime) && !scene.relaxes() {
                let figures = &loading.figures;
                let simulation = &mut self.simulation;
                smooth = simulation.smooth_pull_off_force(&scene, &governing, figures)?;
            }
            let warnings = [&loading.warnings[..], &warnings_of_scene].concat();
            let case = CaseOutcome {
                governing,
                profile,
                scene: &scene,
                first_touch,
                zero_force,
                smooth,
                loading,
                warnings,
            };
            let values = plan.record.iter().map(|quantity| quantity.of(&case));
            records.push(values.collect());
            if !case.warnings.is_empty() {
                self.warnings.push((cell, case.warnings));
            }
        }
        Ok(records)
    }

    /// Returns the loading of each cell of a streak; empty if no recorded quantity depends on the
    /// loading. The preloads of the plan may be in units of E* h L or in N.
    fn loops(
        &self,
        streak: &Streak,
        scene: &CheckedScene,
        governing: &Governing,
    ) -> Vec<Vec<Move>> {
        if !self.plan.records(Needs::Loading) {
            return Vec::new();
        }
        let Some(preloads) = self.plan.preloads() else {
            return vec![scene.loading.clone()];
        };
        let mut unit = 1.0;
        if preloads.unit != "N" {
            unit = governing.force_unit(scene.length).unwrap_or(f64::NAN);
        }
        let first = streak.cells.start as usize % preloads.values.len();
        let count = (streak.cells.end - streak.cells.start) as usize;
        preloads.values[first..first + count]
            .iter()
            .map(|preload| vec![Move::ToForce(preload * unit), Move::ToSeparation])
            .collect()
    }

    /// Computes several loadings, each of which starts in separation.
    fn solve(
        &mut self,
        scene: &CheckedScene,
        governing: &Governing,
        loops: Vec<Vec<Move>>,
    ) -> Result<SolvedLoops, RunError> {
        let turns: Option<Vec<Move>> = loops.iter().map(|loading| turn_of(loading)).collect();
        if let (Some(turns), Solver::Exact, false) = (turns, scene.numerics.solver, scene.relaxes())
        {
            return self.solve_reversals(scene, governing, &turns);
        }
        let loops = if loops.is_empty() {
            vec![vec![Move::ToTouch, Move::ToSeparation]]
        } else {
            loops
        };
        let mut solved = SolvedLoops::default();
        for loading in loops {
            let outcome = self.run(&scene.with(|scene| scene.loading = loading)?)?;
            solved.first_touch = solved.first_touch.or(outcome.first_touch_pull_off_force);
            let own_profile = self.simulation.profile(scene)?;
            let loading = LoadingOutcome::of_stages(outcome.history.stages, &own_profile);
            solved.loadings.push(loading);
        }
        Ok(solved)
    }

    /// Computes loops that turn at the ends of the moves, by a single loading through all turning
    /// points.
    fn solve_reversals(
        &mut self,
        scene: &CheckedScene,
        governing: &Governing,
        turns: &[Move],
    ) -> Result<SolvedLoops, RunError> {
        let ends = [&[Move::ToTouch], turns].concat();
        let mut loadings = vec![LoadingOutcome::default(); ends.len()];
        let own_profile = self.simulation.profile(scene)?;
        self.simulation
            .reverse(scene, &ends, &[], self.stop, &mut |index, reversal| {
                loadings[index] = LoadingOutcome::of_reversal(ends[index], &reversal, &own_profile);
                Ok(())
            })?;
        let mut first_touch = loadings.remove(0).figures.pull_off_force;
        if governing.adhesive_work().is_none() {
            first_touch = None;
        }
        Ok(SolvedLoops {
            loadings,
            first_touch,
        })
    }

    fn run(&mut self, scene: &CheckedScene) -> Result<Outcome, RunError> {
        self.simulation.run(scene, self.stop, &mut |_, _, _| Ok(()))
    }

    /// Returns the recorded properties of the profile of a scene. The properties depend neither on
    /// the adhesion nor on the loading, so the recorder keeps them for the next scene with the same
    /// profile.
    fn profile_record(&mut self, scene: &CheckedScene) -> Result<ProfileRecord, RunError> {
        let heights = self.plan.records(Needs::Heights);
        let stiffness = self.plan.records(Needs::Stiffness);
        if !heights && !stiffness {
            return Ok(ProfileRecord::default());
        }
        let amplitude = self.simulation.make_line(scene)?.2.amplitude;
        let nonadhesive = scene.with(|scene| {
            (scene.adhesion, scene.loading) = (None, vec![Move::ToTouch]);
            if let (
                Some(Roughness::SelfAffine {
                    rms_height,
                    rms_gradient,
                    ..
                }),
                Some(amplitude),
            ) = (&mut scene.roughness, amplitude)
            {
                // The amplitude in the scene may depend on κ, which has no meaning without
                // adhesion. It is therefore replaced by its rms height.
                (*rms_height, *rms_gradient) = (Some(amplitude.rms_height), None);
            }
        })?;
        if let Some((known, record)) = &self.profile
            && *known == nonadhesive
        {
            return Ok(*record);
        }
        let mut record = ProfileRecord::default();
        if heights {
            // The form is the same for all profiles and is removed, so that the heights are those
            // of the roughness alone.
            let (line, ..) = self
                .simulation
                .make_line(&nonadhesive.with(|scene| scene.form = None)?)?;
            record = ProfileRecord::of_gaps(&line.gaps, line.deepest);
        }
        if stiffness {
            record.exponents = self.exponents(&nonadhesive)?;
        }
        self.profile = Some((nonadhesive, record));
        Ok(record)
    }

    /// Returns the exponents of stiffness and force of the contact without adhesion; `None` if they
    /// cannot be fitted. They are slopes of logarithms over the range of forces in the plan. The
    /// stiffness is E* times the contact length, because without adhesion no spring is stretched.
    fn exponents(&mut self, scene: &CheckedScene) -> Result<Option<(f64, f64)>, RunError> {
        let (_, _, governing) = self.simulation.make_line(scene)?;
        let Some(unit) = governing.force_unit(scene.length) else {
            return Ok(None);
        };
        let StiffnessRange { from, to, count } = self.plan.stiffness;
        let step = (to / from).ln() / (count - 1) as f64;
        let loading = (0..count)
            .map(|index| Move::ToForce(unit * from * (step * index as f64).exp()))
            .collect();
        let outcome = self.run(&scene.with(|scene| scene.loading = loading)?)?;
        let mut lengths = Vec::new();
        let mut forces = Vec::new();
        for stage in &outcome.history.stages {
            let Some(end) = stage.curve.last() else {
                continue;
            };
            if end.force > 0.0 && end.indentation > 0.0 {
                lengths.push((end.force.ln(), end.contact_length.ln()));
                forces.push((end.indentation.ln(), end.force.ln()));
            }
        }
        Ok(slope(&lengths).zip(slope(&forces)))
    }
}

/// Calls `record` with a recorder that uses `simulation`, and stores the simulation back
/// afterwards.
pub(super) fn with_recorder<R>(
    plan: &Plan,
    simulation: &mut Simulation,
    stop: &dyn Fn() -> bool,
    record: impl FnOnce(&mut Recorder<'_>) -> Result<R, RunError>,
) -> Result<R, RunError> {
    let mut recorder = Recorder::new(plan, take(simulation), stop);
    let recorded = record(&mut recorder);
    *simulation = recorder.simulation;
    recorded
}

/// Returns true for an error that is caused by the machine (memory) or the user, and not by the
/// values of a cell.
fn is_of_machine(error: &RunError) -> bool {
    let is_short = matches!(
        error,
        RunError::OutOfMemory { .. }
            | RunError::Surface(SurfaceError::OutOfMemory { .. })
            | RunError::Contact(ContactError::OutOfMemory(_))
    );
    is_short || error.is_interruption()
}
