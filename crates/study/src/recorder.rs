//! The recorder of a streak, which computes its loadings on one profile and reads the recorded
//! quantities.

use super::case_outcome::{CaseOutcome, LoadingOutcome, ProfileRecord};
use super::cells::Streak;
use super::plan::{Plan, StiffnessRange};
use super::quantity::{Needs, Quantity};
use asperity_contact::{ContactError, Move};
use asperity_data::{Warning, printable, slope};
use asperity_scene::{CheckedScene, Governing, Outcome, Roughness, RunError, Simulation, Solver};
use asperity_surface::SurfaceError;
use std::mem::take;

/// Values of the recorded quantities for each preload, in the order of the plan; NaN for a quantity
/// that the case does not have.
pub(super) type Records = Vec<Vec<f64>>;

/// Values of a record, or the reason in one line why they cannot be computed.
pub(super) type Recorded = Result<Vec<f64>, String>;

/// Recorder of the cases of a plan. It keeps the profile, its contact tree and its properties from
/// case to case.
pub(super) struct Recorder<'p> {
    plan: &'p Plan,
    pub simulation: Simulation,
    /// Properties of the last profile, with its scene without adhesion and loading.
    profile: Option<(CheckedScene, ProfileRecord)>,
    /// Premises that recorded cases do not meet, with the numbers of the cells.
    warnings: Vec<(u64, Vec<Warning>)>,
    stop: &'p dyn Fn() -> bool,
}

impl<'p> Recorder<'p> {
    /// Creates a recorder that stops within a case as soon as `stop` returns true.
    pub fn new(plan: &'p Plan, simulation: Simulation, stop: &'p dyn Fn() -> bool) -> Self {
        Recorder {
            plan,
            simulation,
            profile: None,
            warnings: Vec::new(),
            stop,
        }
    }

    /// Returns the premises that the cases recorded so far do not meet, each list with the number
    /// of the cell, and forgets them.
    pub fn take_warnings(&mut self) -> Vec<(u64, Vec<Warning>)> {
        take(&mut self.warnings)
    }

    /// Computes a streak. A cell that cannot be computed gets the reason in place of its values.
    ///
    /// # Errors
    /// The memory does not suffice, or `stop` returned true. Neither is due to a cell.
    pub fn record_each(&mut self, streak: &Streak) -> Result<Vec<Recorded>, RunError> {
        match self.record(streak) {
            Ok(records) => Ok(records.into_iter().map(Ok).collect()),
            Err(error) if is_of_machine(&error) => Err(error),
            Err(error) if streak.cells.end - streak.cells.start == 1 => {
                let reason = error.to_string();
                Ok(vec![Err(printable(
                    reason.lines().next().unwrap_or_default(),
                )
                .into_owned())])
            }
            // Of several preloads some may be within reach.
            Err(_) => {
                let one = |cell| {
                    self.record_each(&Streak {
                        cells: cell..cell + 1,
                        line: streak.line,
                    })
                };
                Ok(streak
                    .cells
                    .clone()
                    .map(one)
                    .collect::<Result<Vec<_>, _>>()?
                    .concat())
            }
        }
    }

    /// Computes a streak.
    ///
    /// # Errors
    /// The profile or the contact fails, or `stop` returned true.
    pub fn record(&mut self, streak: &Streak) -> Result<Records, RunError> {
        let plan = self.plan;
        let scene = plan
            .scene_of(streak.cells.start)?
            .with_seed(plan.seed_of(streak.line))
            .stripped();
        let profile = self.profile_record(&scene)?;
        let (_, _, governing) = self.simulation.make_line(&scene)?;
        let mut loops = Vec::new();
        if plan.records(Needs::Loading) {
            match plan.preloads() {
                Some(preloads) => {
                    // Preloads in units of E* h L, or in N.
                    let unit = || governing.force_unit(scene.length).unwrap_or(f64::NAN);
                    let unit = if preloads.unit == "N" { 1.0 } else { unit() };
                    let press =
                        |preload: &f64| vec![Move::ToForce(preload * unit), Move::ToSeparation];
                    let first = streak.cells.start as usize % preloads.values.len();
                    let count = (streak.cells.end - streak.cells.start) as usize;
                    loops.extend(preloads.values[first..first + count].iter().map(press));
                }
                None => loops.push(scene.loading.clone()),
            }
        }
        let count = loops.len();
        let [touch_regime, regime] = Quantity::REGIMES.map(|regime| plan.column(regime).is_some());
        let needs_zero_force = plan.records(Needs::ZeroForce) || regime;
        if needs_zero_force {
            loops.push(vec![Move::ToZeroForce, Move::ToSeparation]);
        }
        let (mut each, mut first_touch) = (Vec::new(), None);
        if !loops.is_empty() || plan.records(Needs::Touch) {
            (each, first_touch) = self.solve(&scene, &governing, loops)?;
        }
        let zero_force = each.get(count).filter(|_| needs_zero_force);
        let zero_force = zero_force.and_then(|of| of.figures.adhesion_force);
        each.truncate(count);
        each.resize(
            (streak.cells.end - streak.cells.start) as usize,
            LoadingOutcome::default(),
        );
        let of_scene = self.simulation.warnings(&scene)?;
        let mut records = Vec::with_capacity(each.len());
        for (loading, cell) in each.into_iter().zip(streak.cells.clone()) {
            let smooth = match touch_regime || regime {
                true => {
                    self.simulation
                        .smooth_adhesion_force(&scene, &governing, &loading.figures)?
                }
                false => None,
            };
            let warnings = [&loading.warnings[..], &of_scene].concat();
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
            records.push(
                plan.record
                    .iter()
                    .map(|quantity| quantity.of(&case))
                    .collect(),
            );
            if !case.warnings.is_empty() {
                self.warnings.push((cell, case.warnings));
            }
        }
        Ok(records)
    }

    /// Returns the outcomes of loadings that each begin at separation, and F_a(d=0) in N.
    fn solve(
        &mut self,
        scene: &CheckedScene,
        governing: &Governing,
        loops: Vec<Vec<Move>>,
    ) -> Result<(Vec<LoadingOutcome>, Option<f64>), RunError> {
        let press = |legs: &Vec<Move>| match legs[..] {
            [
                press @ (Move::ToForce(_) | Move::ToTouch | Move::ToZeroForce),
                Move::ToSeparation,
            ] => Some(press),
            _ => None,
        };
        let turned: Option<Vec<Move>> = loops.iter().map(press).collect();
        if let (Some(turned), Solver::Exact) = (turned, scene.numerics.solver) {
            // One loading serves all reversals.
            let ends = [&[Move::ToTouch], turned.as_slice()].concat();
            let mut each = vec![LoadingOutcome::default(); ends.len()];
            let own_profile = self.simulation.profile(scene)?;
            self.simulation
                .reverse(scene, &ends, &[], self.stop, &mut |index, reversal| {
                    each[index] = LoadingOutcome::of_reversal(ends[index], &reversal, &own_profile);
                    Ok(())
                })?;
            let at_touch = each.remove(0).figures.adhesion_force;
            return Ok((
                each,
                at_touch.filter(|_| governing.adhesive_work().is_some()),
            ));
        }
        let loops = if loops.is_empty() {
            vec![vec![Move::ToTouch, Move::ToSeparation]]
        } else {
            loops
        };
        let (mut each, mut first_touch) = (Vec::with_capacity(loops.len()), None);
        for one in loops {
            let outcome = self.run(&scene.with(|scene| scene.loading = one)?)?;
            first_touch = first_touch.or(outcome.first_touch_adhesion_force);
            let own_profile = self.simulation.profile(scene)?;
            each.push(LoadingOutcome::of_legs(outcome.history.legs, &own_profile));
        }
        Ok((each, first_touch))
    }

    fn run(&mut self, scene: &CheckedScene) -> Result<Outcome, RunError> {
        self.simulation.run(scene, self.stop, &mut |_, _, _| Ok(()))
    }

    fn profile_record(&mut self, scene: &CheckedScene) -> Result<ProfileRecord, RunError> {
        let (heights, stiffness) = (
            self.plan.records(Needs::Heights),
            self.plan.records(Needs::Stiffness),
        );
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
                // The amplitude may depend on the adhesion.
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
            // Without the form, which is the same on all profiles.
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

    /// Returns the exponents of the contact without adhesion, fitted to logarithms over the range
    /// of forces of the plan. No spring is stretched, so the stiffness is E* times the contact
    /// length.
    fn exponents(&mut self, scene: &CheckedScene) -> Result<Option<(f64, f64)>, RunError> {
        let (_, _, governing) = self.simulation.make_line(scene)?;
        let Some(unit) = governing.force_unit(scene.length) else {
            return Ok(None);
        };
        let StiffnessRange { from, to, count } = self.plan.stiffness;
        let step = (to / from).ln() / (count - 1) as f64;
        let force = |index: u64| unit * from * (step * index as f64).exp();
        let loading = (0..count)
            .map(|index| Move::ToForce(force(index)))
            .collect();
        let outcome = self.run(&scene.with(|scene| scene.loading = loading)?)?;
        let points = outcome
            .history
            .legs
            .iter()
            .filter_map(|leg| leg.curve.last());
        let points: Vec<_> = points
            .filter(|point| point.force > 0.0 && point.indentation > 0.0)
            .collect();
        let lengths: Vec<_> = points
            .iter()
            .map(|at| (at.force.ln(), at.contact_length.ln()))
            .collect();
        let forces: Vec<_> = points
            .iter()
            .map(|at| (at.indentation.ln(), at.force.ln()))
            .collect();
        Ok(slope(&lengths).zip(slope(&forces)))
    }
}

/// Records cases of a plan with a recorder that has this simulation, and returns the simulation.
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

/// Returns true for an error due to the machine or the user rather than to a cell.
fn is_of_machine(error: &RunError) -> bool {
    let is_short = matches!(
        error,
        RunError::OutOfMemory { .. }
            | RunError::Surface(SurfaceError::OutOfMemory { .. })
            | RunError::Contact(ContactError::OutOfMemory(_))
    );
    is_short || error.is_interruption()
}
