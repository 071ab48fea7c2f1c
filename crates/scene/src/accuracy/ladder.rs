//! Cost of accuracy of one scene: solutions from coarse to fine within a budget of time. Each step
//! of this ladder has twice the springs of the step before, with both edge models, and half the
//! step of the stepwise solver.

use super::estimate::own_errors;
use super::solution::{
    Errors, Runs, Solution, Target, allowed_points, is_spent, is_too_coarse, refined,
};
use super::table::{CostReference, CostTable, ErrorFigure, Knob, Row, Timing};
use crate::scene::checked::CheckedScene;
use crate::scene::errors::SceneErrors;
use crate::scene::model::{Scene, Solver};
use crate::simulation::outcome::RunError;
use asperity_contact::{ContactError, Edges};
use asperity_data::{format_quantity, grouped};
use asperity_fourier::plan_real_forward;
use std::path::Path;
use std::time::{Duration, Instant};

/// Least ratio of the time that is left to the time of the last rung before another rung begins.
/// The next rung takes about twice as long, the error of the finest solution as long as the last
/// rung. A busy machine takes longer.
const LATER: f64 = 4.0;
/// Number of points of a compared curve, over all loading stages. With so many points sampling
/// hides no error of the springs.
const COMPARED_POINTS: u64 = 1 << 16;
/// Largest number of points of a compared loading stage.
const MOST_COMPARED: u64 = 4096;
/// Relative error below which errors cannot be distinguished from rounding.
const ROUNDING: f64 = 1e-14;
/// Number of springs for the stepwise solver, unless the scene needs more.
const STEPWISE_SPRINGS: u64 = 256;
/// Number of steps of the coarsest run over its range of indentations.
const FEWEST_STEPS: f64 = 16.0;
/// Largest number of runs that time one setting, and the time in s after which no further run
/// begins.
const MOST_RUNS: usize = 9;
const ENOUGH_RUNS: f64 = 0.05;
/// Number of points of the Fourier transform whose time is the unit of time.
const TRANSFORM_POINTS: usize = 1 << 20;

/// Progress of [`measure`], which measures errors and computing times of a scene and passes this to
/// its argument `watch`.
pub enum Progress<'a> {
    /// Setting that is varied next, with its next value as text, such as `512 springs`.
    Trying(Knob, &'a str),
    /// Table of the solutions so far. The errors in the table are relative to the finest of these
    /// solutions.
    Rows(&'a CostTable),
}

/// Solutions of a scene from coarse to fine, within a budget of time.
struct Ladder<'a> {
    scene: &'a CheckedScene,
    folder: &'a Path,
    is_over: &'a dyn Fn() -> bool,
    /// Rows without errors yet, which have setting and times, each with its solution.
    rungs: Vec<(Row, Solution)>,
    table: CostTable,
}

/// Measures the errors of a scene and the times of its computation, with more and more springs and,
/// for the stepwise [`Solver`], with smaller and smaller steps. The measurement ends when the time
/// `budget` is spent. Names of measured files are relative to `folder`. `watch` receives each
/// setting before it is tried, and the table so far.
///
/// # Errors
/// Returns a message if the scene cannot be computed, if the budget is too small for two solutions,
/// or if `stop` returned true.
pub fn measure(
    scene: &CheckedScene,
    folder: &Path,
    budget: Duration,
    stop: &dyn Fn() -> bool,
    watch: &mut dyn FnMut(Progress<'_>),
) -> Result<CostTable, String> {
    let (begun, budget) = (Instant::now(), budget.as_secs_f64());
    let left = || {
        if stop() {
            0.0
        } else {
            budget - begun.elapsed().as_secs_f64()
        }
    };
    let is_over = || left() <= 0.0;
    let transform_seconds = time_of_transform().unwrap_or(f64::NAN);
    let table = CostTable {
        budget,
        transform_seconds,
        ..CostTable::default()
    };
    let mut ladder = Ladder {
        scene,
        folder,
        is_over: &is_over,
        rungs: Vec::new(),
        table,
    };
    let refused = ladder
        .climb(&left, watch)
        .map_err(|error| error.to_string())?;
    let own = ladder.finest().and_then(|[finest, _]| {
        let mut runs = Runs::new(folder, &is_over);
        own_errors(&compared(scene).ok()?, finest, &mut runs)
    });
    let springs = allowed_points(scene)
        .next()
        .unwrap_or(scene.numerics.points);
    match refused {
        _ if stop() => Err("the measurement was stopped".to_owned()),
        _ if ladder.count(own) => Ok(CostTable {
            spent: begun.elapsed().as_secs_f64(),
            ..ladder.table
        }),
        Some(error) if ladder.rungs.is_empty() => Err(error.to_string()),
        _ => Err(format!(
            "the budget of {budget} s is spent before two solutions could be compared, of which the coarsest has \
             {springs} springs"
        )),
    }
}

/// Returns the scene with as many curve points as a comparison of curves needs.
fn compared(scene: &CheckedScene) -> Result<CheckedScene, SceneErrors> {
    scene.with(|scene| scene.numerics.samples = compared_samples(scene))
}

fn compared_samples(scene: &Scene) -> u64 {
    let legs = scene.loading.len().max(1) as u64;
    (COMPARED_POINTS / legs).clamp(2, MOST_COMPARED)
}

impl Ladder<'_> {
    /// Adds rungs while there is time. Returns the error with which too few springs were refused,
    /// if there was one.
    fn climb(
        &mut self,
        left: &dyn Fn() -> f64,
        watch: &mut dyn FnMut(Progress<'_>),
    ) -> Result<Option<RunError>, RunError> {
        let (mut refused, mut took) = (None, 0.0);
        for points in allowed_points(self.scene) {
            let began = left();
            // The first two may take all of the time, so that a comparison is possible.
            let mut goes_on = began
                > if self.finest().is_some() {
                    LATER * took
                } else {
                    0.0
                };
            for (knob, setting, scene) in self.settings(points) {
                let (named, rest) = match knob {
                    Knob::Step => (format_quantity(setting, "m"), "less"),
                    _ => (format!("{} springs", grouped(points)), "more"),
                };
                if goes_on {
                    watch(Progress::Trying(knob, &named));
                    match self.rung(knob, setting, &scene) {
                        Err(error) if is_too_coarse(&error) => refused = Some(error),
                        Err(error) if is_spent(&error) => goes_on = false,
                        rung => self.rungs.push(rung?),
                    }
                }
                if !goes_on {
                    self.table
                        .left_out
                        .push(format!("{}: {named} and {rest}", knob.name()));
                }
            }
            if !goes_on {
                break;
            }
            took = began - left();
            if self.count(None) {
                watch(Progress::Rows(&self.table));
            }
        }
        Ok(refused)
    }

    /// Returns the settings with this number of springs. The step of the stepwise solver is halved
    /// from rung to rung, once the exact reference solution is known.
    fn settings(&self, points: u64) -> Vec<(Knob, f64, CheckedScene)> {
        let of = |(knob, edges)| {
            Some((
                knob,
                points as f64,
                refined(self.scene, points, edges).ok()?,
            ))
        };
        let springs = [
            (Knob::SubCellSprings, Edges::SubCell),
            (Knob::GridSprings, Edges::Grid),
        ]
        .map(of);
        let step = || {
            let exact = self.exact()?;
            let at = exact.curve.iter().flatten().map(|point| point[0]);
            let (low, high) = at.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), at| {
                (at.min(low), at.max(high))
            });
            let halvings = self.rungs_of(Knob::Step).count() as i32;
            let step = (high - low) / FEWEST_STEPS * 0.5_f64.powi(halvings);
            let scene = refined(self.scene, exact.points, Edges::Grid).ok()?;
            let scene = scene
                .with(|scene| scene.numerics.solver = Solver::Stepwise { step })
                .ok()?;
            (low < high).then_some((Knob::Step, step, scene))
        };
        springs.into_iter().flatten().chain(step()).collect()
    }

    fn rung(
        &self,
        knob: Knob,
        setting: f64,
        scene: &CheckedScene,
    ) -> Result<(Row, Solution), RunError> {
        let (mut runs, compared) = (Runs::new(self.folder, self.is_over), compared(scene)?);
        let is_step = knob == Knob::Step;
        let solution = if is_step {
            runs.solve(&compared)?
        } else {
            runs.solve_around(&compared)?
        };
        let seconds = self.time(scene).ok_or(ContactError::Interrupted)?;
        let transforms = Some(seconds.minimum / self.table.transform_seconds);
        let (springs, seconds, errors) = (solution.points, Some(seconds), [None; 4]);
        Ok((
            Row {
                knob,
                setting,
                springs,
                seconds,
                transforms,
                errors,
            },
            solution,
        ))
    }

    /// Measures the times of a few whole runs of a scene, at least one, in which nothing is reused.
    /// Returns `None` if no time is left.
    fn time(&self, scene: &CheckedScene) -> Option<Timing> {
        let (began, mut seconds) = (Instant::now(), Vec::new());
        while seconds.is_empty()
            || (seconds.len() < MOST_RUNS && began.elapsed().as_secs_f64() < ENOUGH_RUNS)
        {
            let clock = Instant::now();
            let Ok(_) = Runs::new(self.folder, self.is_over).solve(scene) else {
                break;
            };
            seconds.push(clock.elapsed().as_secs_f64());
        }
        Timing::of(seconds)
    }

    fn rungs_of(&self, knob: Knob) -> impl DoubleEndedIterator<Item = &(Row, Solution)> {
        self.rungs.iter().filter(move |(row, _)| row.knob == knob)
    }

    /// Returns the reference for steps: the exact solution with as many springs as the stepwise
    /// solver has.
    fn exact(&self) -> Option<&Solution> {
        let mut exact = self
            .rungs_of(Knob::GridSprings)
            .map(|(_, solution)| solution);
        exact.find(|solution| solution.points >= STEPWISE_SPRINGS)
    }

    /// Returns the two finest solutions with edges between springs, the finest first.
    fn finest(&self) -> Option<[&Solution; 2]> {
        let mut finer = self
            .rungs_of(Knob::SubCellSprings)
            .rev()
            .map(|(_, solution)| solution);
        Some([finer.next()?, finer.next()?])
    }

    /// Computes the errors of all rows, relative to the finest solution or the closed form. Errors
    /// of steps are relative to the exact solution. The error of the reference itself is `own`, or
    /// twice the last differences. Returns false for fewer than two solutions.
    fn count(&mut self, own: Option<Errors>) -> bool {
        let Some([finest, last]) = self.finest() else {
            return false;
        };
        let twice = || last.errors(finest).map(|last| last.map(|last| 2.0 * last));
        let (mut errors, target) = (own.unwrap_or_else(twice), finest.reference());
        let closed_form = target.closed_form.is_some();
        if closed_form {
            errors[Target::AdhesionForce as usize] = Some(ROUNDING);
        }
        // With few springs each of them is a jump, which is late by up to one distance of samples.
        let late = [
            None,
            Some(1.0 / compared_samples(self.scene) as f64),
            None,
            None,
        ];
        let mut rows: Vec<Row> = Vec::new();
        for knob in Knob::ALL {
            // The difference of the finest solution from itself is zero, which is not its error.
            let (target, floors) = match (knob, self.exact()) {
                (Knob::Step, Some(exact)) => (exact, late),
                _ => (&target, errors),
            };
            for (row, solution) in self.rungs_of(knob) {
                let before = rows.last().filter(|row| row.knob == knob);
                let errors = resolved(solution.errors(target), floors, row.setting, before);
                rows.push(Row {
                    errors,
                    ..row.clone()
                });
            }
        }
        let (springs, adhesion_force) = (target.points, target.adhesion_force);
        self.table.reference = CostReference {
            springs,
            adhesion_force,
            closed_form,
            errors,
        };
        self.table.rows = rows;
        true
    }
}

/// Returns the errors of a setting where they exceed the errors of the reference, with orders of
/// convergence relative to the row before.
fn resolved(
    errors: Errors,
    floors: Errors,
    setting: f64,
    before: Option<&Row>,
) -> [Option<ErrorFigure>; 4] {
    let ratio = before.map_or(1.0, |row| {
        (setting / row.setting).max(row.setting / setting)
    });
    let coarse = before.map_or([None; 4], |row| row.errors);
    std::array::from_fn(|index| {
        let (error, floor) = (errors[index]?, floors[index].unwrap_or(0.0).max(ROUNDING));
        let resolved = error > floor;
        let coarse = coarse[index].filter(|coarse| coarse.resolved && resolved);
        let order = coarse.and_then(|coarse| observed_order(coarse.error, error, ratio));
        Some(ErrorFigure {
            error: error.max(floor),
            resolved,
            order,
        })
    })
}

/// Returns the observed order of convergence ln(coarse/fine)/ln(ratio) between two errors; the
/// second solution is `ratio` times as fine. Returns `None` if the order has no meaning.
fn observed_order(coarse: f64, fine: f64, ratio: f64) -> Option<f64> {
    let order = (coarse / fine).ln() / ratio.ln();
    (coarse > 0.0 && fine > 0.0 && order.is_finite()).then_some(order)
}

/// Measures the shortest time in s of one real Fourier transform of 2^20 points, which is planned
/// before.
fn time_of_transform() -> Option<f64> {
    let transform = plan_real_forward(TRANSFORM_POINTS);
    let mut points = transform.make_input_vec();
    let (mut modes, mut scratch) = (transform.make_output_vec(), transform.make_scratch_vec());
    let run = |_| {
        points
            .iter_mut()
            .enumerate()
            .for_each(|(index, point)| *point = (index % 17) as f64);
        let clock = Instant::now();
        transform
            .process_with_scratch(&mut points, &mut modes, &mut scratch)
            .ok()?;
        Some(clock.elapsed().as_secs_f64())
    };
    // The first run is not measured.
    let times: Option<Vec<f64>> = (0..=MOST_RUNS).map(run).collect();
    times?.into_iter().skip(1).reduce(f64::min)
}
