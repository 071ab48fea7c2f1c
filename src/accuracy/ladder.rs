//! The cost of accuracy of one scene: one ladder from coarse to fine within a budget of time. Each rung has twice the springs
//! of the one before, with both edge models, and half of the step of the stepwise solver.

use super::convergence::observed_order;
use super::estimate::others;
use super::solution::{Runs, Solution, Target, allowed_points, is_too_coarse, refined};
use super::{CostTable, ErrorFigure, Knob, Reference, Row, Timing};
use crate::scene::{Edges, Scene, Solver, check, format_quantity};
use crate::simulation::RunError;
use realfft::RealFftPlanner;
use std::path::Path;
use std::time::{Duration, Instant};
use thiserror::Error;

/// Least time left for another rung over that of the last one: a rung takes about twice as long, the error of the finest
/// solution as long as the last one, and a busy machine longer.
const LATER: f64 = 4.0;
/// Points of a compared curve, all loading stages together: many, so that sampling hides no error of the springs.
const COMPARED_POINTS: u64 = 1 << 16;
/// Most samples of a compared loading stage.
const MOST_COMPARED: u64 = 4096;
/// Errors below this are indistinguishable from rounding.
const ROUNDING: f64 = 1e-14;
/// Springs of the stepwise solver, unless the scene needs more.
const STEPWISE_SPRINGS: u64 = 256;
/// Steps of the coarsest run over the range of its indentations.
const FEWEST_STEPS: f64 = 16.0;
/// Most runs of one setting for its time, and the time after which no other begins, s.
const MOST_RUNS: usize = 9;
const ENOUGH_RUNS: f64 = 0.05;
/// Points of the transform that is the unit of time.
const TRANSFORM_POINTS: usize = 1 << 20;

/// Error of the measurement of a table of costs.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum CostError {
    /// The scene could not be computed.
    #[error(transparent)]
    Run(#[from] RunError),
    /// Fewer than two solutions fit into the budget, so that their errors are unknown.
    #[error(
        "the budget of {budget} s is spent before two solutions could be compared, of which the coarsest has \
         {springs} springs"
    )]
    BudgetTooShort {
        /// The budget, s.
        budget: f64,
        /// Fewest springs that the scene allows.
        springs: u64,
    },
    /// The measurement was stopped.
    #[error("the measurement was stopped")]
    Stopped,
}

/// Progress of a measurement.
pub enum Progress<'a> {
    /// A setting of a knob is tried next.
    Trying(Knob, &'a str),
    /// The table so far, with errors relative to the finest solution so far.
    Rows(&'a CostTable),
}

/// Relative errors or differences of a solution, in the order of [`super::Measures`], as far as known.
type Errors = [Option<f64>; 4];

/// Solution of one setting.
struct Rung {
    knob: Knob,
    setting: f64,
    solution: Solution,
    seconds: Option<Timing>,
}

/// Measurement of a scene within a budget of time.
struct Ladder<'a> {
    scene: &'a Scene,
    folder: &'a Path,
    /// Seconds left; none once the measurement is stopped.
    left: &'a dyn Fn() -> f64,
    watch: &'a mut dyn FnMut(Progress<'_>),
    rungs: Vec<Rung>,
    table: CostTable,
}

/// Measures the table of a checked scene with files in `folder`, within a budget of time. `stop` is polled now and
/// then; `watch` receives each setting and its result.
///
/// # Errors
/// [`CostError`].
pub fn measure(
    scene: &Scene,
    folder: &Path,
    budget: Duration,
    stop: &dyn Fn() -> bool,
    watch: &mut dyn FnMut(Progress<'_>),
) -> Result<CostTable, CostError> {
    let (begun, budget) = (Instant::now(), budget.as_secs_f64());
    let left = || if stop() { 0.0 } else { budget - begun.elapsed().as_secs_f64() };
    let table = CostTable {
        budget,
        transform_seconds: time_of_transform().unwrap_or(f64::NAN),
        ..CostTable::default()
    };
    let mut ladder = Ladder { scene, folder, left: &left, watch, rungs: Vec::new(), table };
    let refused = ladder.climb()?;
    let own = ladder.finest().and_then(|finest| ladder.own_errors(finest));
    if !ladder.count(own) {
        let springs = allowed_points(scene).next().unwrap_or(scene.numerics.points);
        return Err(match refused {
            _ if stop() => CostError::Stopped,
            Some(error) if ladder.rungs.is_empty() => error.into(),
            _ => CostError::BudgetTooShort { budget, springs },
        });
    }
    if stop() {
        return Err(CostError::Stopped);
    }
    Ok(CostTable { spent: begun.elapsed().as_secs_f64(), ..ladder.table })
}

/// Returns the scene with the number of samples for a comparison of curves.
fn compared(scene: &Scene) -> Scene {
    let legs = scene.loading.len().max(1) as u64;
    let mut scene = scene.clone();
    scene.numerics.samples = (COMPARED_POINTS / legs).clamp(2, MOST_COMPARED);
    scene
}

impl Ladder<'_> {
    /// Measures the times of a few whole runs of a scene, at least one, without any reuse; `None` without time for one.
    fn time(&self, scene: &Scene) -> Option<Timing> {
        let (began, mut seconds) = (Instant::now(), Vec::new());
        while seconds.is_empty() || (seconds.len() < MOST_RUNS && began.elapsed().as_secs_f64() < ENOUGH_RUNS)
        {
            let (clock, stop) = (Instant::now(), || (self.left)() <= 0.0);
            let Ok(Some(_)) = Runs::new(self.folder, &stop).solve(scene) else { break };
            seconds.push(clock.elapsed().as_secs_f64());
        }
        Timing::of(seconds)
    }

    /// Solves and times one setting and adds its rung; false without time for that, and for too few springs the error.
    fn attempt(&mut self, knob: Knob, setting: f64, scene: &Scene) -> Result<bool, RunError> {
        let (left, compared) = (self.left, compared(scene));
        let stop = || left() <= 0.0;
        let mut runs = Runs::new(self.folder, &stop);
        let is_step = knob == Knob::Step;
        let solution = if is_step { runs.solve(&compared)? } else { runs.solve_around(&compared)? };
        let Some(solution) = solution else { return Ok(false) };
        let seconds = self.time(scene);
        let is_timed = seconds.is_some();
        self.rungs.extend(is_timed.then_some(Rung { knob, setting, solution, seconds }));
        Ok(is_timed)
    }

    /// Returns the settings of the rung with this number of springs. The step of the stepwise solver halves from rung to
    /// rung once its reference is known.
    fn settings(&self, points: u64) -> Vec<(Knob, f64, Scene)> {
        let of = |(knob, edges)| (knob, points as f64, refined(self.scene, points, edges));
        let springs = [(Knob::SubCellSprings, Edges::SubCell), (Knob::GridSprings, Edges::Grid)].map(of);
        let step = || {
            let exact = self.exact()?;
            let (low, high) = exact.curve.indentations().filter(|(low, high)| low < high)?;
            let halvings = self.rungs_of(Knob::Step).count() as i32;
            let step = (high - low) / FEWEST_STEPS * 0.5_f64.powi(halvings);
            let mut scene = refined(self.scene, exact.points, Edges::Grid);
            scene.numerics.solver = Solver::Stepwise { step };
            check(&compared(&scene)).is_empty().then_some((Knob::Step, step, scene))
        };
        springs.into_iter().chain(step()).collect()
    }

    /// Adds rungs while there is time; returns the error that refused too few springs.
    fn climb(&mut self) -> Result<Option<RunError>, RunError> {
        let (left, mut refused, mut took) = (self.left, None, 0.0);
        for points in allowed_points(self.scene) {
            let began = left();
            // The first two may take all of the time, so that a comparison is possible.
            let mut goes_on = began > if self.finest().is_some() { LATER * took } else { 0.0 };
            for (knob, setting, scene) in self.settings(points) {
                let (named, rest) = match knob {
                    Knob::Step => (format_quantity(setting, "m"), "less"),
                    _ => (format!("{points} springs"), "more"),
                };
                if goes_on {
                    (self.watch)(Progress::Trying(knob, &named));
                    match self.attempt(knob, setting, &scene) {
                        Err(error) if is_too_coarse(&error) => refused = Some(error),
                        solved => goes_on = solved?,
                    }
                }
                if !goes_on {
                    self.table.left_out.push(format!("{}: {named} and {rest}", knob.name()));
                }
            }
            if !goes_on {
                break;
            }
            took = began - left();
            if self.count(None) {
                (self.watch)(Progress::Rows(&self.table));
            }
        }
        Ok(refused)
    }

    fn rungs_of(&self, knob: Knob) -> impl DoubleEndedIterator<Item = &Rung> {
        self.rungs.iter().filter(move |rung| rung.knob == knob)
    }

    /// Returns the reference of steps: the exact solution on as many springs as the stepwise solver has.
    fn exact(&self) -> Option<&Solution> {
        let rung = self.rungs_of(Knob::GridSprings).find(|rung| rung.solution.points >= STEPWISE_SPRINGS);
        rung.map(|rung| &rung.solution)
    }

    /// Returns the finest solution with edges between springs, if there are two.
    fn finest(&self) -> Option<&Solution> {
        let mut finer = self.rungs_of(Knob::SubCellSprings).rev();
        let finest = finer.next()?;
        finer.next().map(|_| &finest.solution)
    }

    /// Estimates the errors of a solution with edges between springs; `None` without time for others.
    fn own_errors(&self, finest: &Solution) -> Option<Errors> {
        let stop = || (self.left)() <= 0.0;
        let mut runs = Runs::new(self.folder, &stop);
        let mut solved = |scene: &Scene| runs.solve_around(scene).ok()?;
        let others = others(&compared(&refined(self.scene, finest.points, Edges::SubCell)), &mut solved)?;
        Some([0, 1, 2, 3].map(|index| others.error(|other| other.errors(finest)[index])))
    }

    /// Makes the rows, with errors relative to the finest solution or the closed form, and those of steps to the exact
    /// solution. The reference has these errors, or without them twice the last differences. Returns false with fewer than
    /// two solutions.
    fn count(&mut self, own: Option<Errors>) -> bool {
        let finer: Vec<&Rung> = self.rungs_of(Knob::SubCellSprings).rev().take(2).collect();
        let &[Rung { solution: finest, .. }, Rung { solution: last, .. }] = &finer[..] else { return false };
        let twice = || last.errors(finest).map(|last| last.map(|last| 2.0 * last));
        let (mut errors, mut target) = (own.unwrap_or_else(twice), finest.clone());
        let closed_form = target.closed_form.is_some();
        if closed_form {
            target.adhesion_force = target.closed_form;
            target.around.clear();
            errors[Target::AdhesionForce as usize] = Some(ROUNDING);
        }
        let (springs, adhesion_force) = (target.points, target.adhesion_force);
        // With few springs each of them is a jump, which is late by up to one distance of samples.
        let late = [None, Some(1.0 / compared(self.scene).numerics.samples as f64), None, None];
        let mut rows = Vec::new();
        for knob in Knob::ALL {
            let is_step = knob == Knob::Step;
            // The difference of the finest solution from itself is zero, which is not its error.
            let floors = if is_step { late } else { errors };
            let target = self.exact().filter(|_| is_step).unwrap_or(&target);
            for rung in self.rungs_of(knob) {
                rows.push(row(rung, rows.last(), target, floors, self.table.transform_seconds));
            }
        }
        self.table.reference = Reference { springs, adhesion_force, closed_form, errors: errors.into() };
        self.table.rows = rows;
        true
    }
}

/// Returns the row of a setting; errors below the floors are not resolved, and orders are relative to the row before of
/// the same knob.
fn row(rung: &Rung, before: Option<&Row>, target: &Solution, floors: Errors, transform_seconds: f64) -> Row {
    let Rung { knob, setting, seconds, .. } = *rung;
    let before = before.filter(|row| row.knob == knob);
    let ratio = before.map_or(1.0, |row| (setting / row.setting).max(row.setting / setting));
    let coarse = before.map(|row| row.errors).unwrap_or_default().each();
    let errors = rung.solution.errors(target);
    let errors = [0, 1, 2, 3].map(|index| {
        let (error, floor) = (errors[index]?, floors[index].unwrap_or(0.0).max(ROUNDING));
        let resolved = error > floor;
        let coarse = coarse[index].filter(|coarse| coarse.resolved && resolved);
        let order = coarse.and_then(|coarse| observed_order(coarse.error, error, ratio));
        Some(ErrorFigure { error: error.max(floor), resolved, order })
    });
    let transforms = seconds.map(|seconds| seconds.minimum / transform_seconds);
    Row { knob, setting, springs: rung.solution.points, seconds, transforms, errors: errors.into() }
}

/// Measures the shortest time of one real Fourier transform of 2^20 points, planned beforehand, s.
fn time_of_transform() -> Option<f64> {
    let transform = RealFftPlanner::<f64>::new().plan_fft_forward(TRANSFORM_POINTS);
    let mut points = transform.make_input_vec();
    let (mut modes, mut scratch) = (transform.make_output_vec(), transform.make_scratch_vec());
    let run = |_| {
        points.iter_mut().enumerate().for_each(|(index, point)| *point = (index % 17) as f64);
        let clock = Instant::now();
        transform.process_with_scratch(&mut points, &mut modes, &mut scratch).ok()?;
        Some(clock.elapsed().as_secs_f64())
    };
    // The first run is not measured.
    let times: Option<Vec<f64>> = (0..=MOST_RUNS).map(run).collect();
    times?.into_iter().skip(1).reduce(f64::min)
}
