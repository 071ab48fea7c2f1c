//! Measurement of the cost of accuracy for one scene: each knob from coarse to fine, within the budget.

use super::clock::Budget;
use super::convergence::observed_order;
use super::estimate::others;
use super::solution::{Solution, Solved, allowed_points, closed_form_adhesion, refined, solve};
use super::{CostTable, ErrorFigure, Knob, Measures, Reference, Row, Timing};
use crate::scene::{Edges, Scene, Solver, check, format_quantity};
use crate::simulation::{Outcome, RunError, Simulation};
use std::path::Path;
use std::time::Duration;
use thiserror::Error;

/// Assumed ratio of times for twice as many springs, before a measurement.
const GROWTH: f64 = 2.2;
/// Shares of the budget at which the ladders of springs end.
const SUB_CELL_BY: f64 = 0.4;
const GRID_BY: f64 = 0.75;

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
/// Most halvings of the step.
const MOST_HALVINGS: u32 = 20;

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
    /// The table so far. Until the ladder of edges between springs has ended, its errors are relative to the finest of
    /// its solutions so far.
    Rows(&'a CostTable),
}

/// Relative errors or differences of a solution, as far as known.
type Errors = Measures<Option<f64>>;

/// Measurement of a scene within a budget of time.
struct Bench<'a> {
    scene: &'a Scene,
    folder: &'a Path,
    budget: Budget<'a>,
    table: CostTable,
    watch: &'a mut dyn FnMut(Progress<'_>),
    /// The error that refused the last setting.
    refused: Option<RunError>,
}

/// Solution on one number of springs.
struct Rung {
    solution: Solution,
    /// The adhesion force in closed form, N, if the scene has one.
    closed_form: Option<f64>,
    seconds: Option<Timing>,
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
    let clock = Budget::begin(budget, stop);
    let table = CostTable {
        budget: clock.seconds(),
        spent: 0.0,
        transform_seconds: clock.of_one_transform().unwrap_or(f64::NAN),
        reference: Reference {
            springs: 0,
            adhesion_force: None,
            closed_form: false,
            errors: Measures::default(),
        },
        rows: Vec::new(),
        left_out: Vec::new(),
    };
    let mut bench = Bench { scene, folder, budget: clock, table, watch, refused: None };
    let mut rungs = Vec::new();
    bench.climb(Knob::SubCellSprings, SUB_CELL_BY, &mut |bench, rung| {
        rungs.push(rung);
        bench.count(&rungs, None);
    })?;
    let own = rungs.last().filter(|_| rungs.len() > 1).map(|finest| bench.own_errors(&finest.solution));
    let Some(target) = own.and_then(|own| bench.count(&rungs, own)) else {
        return Err(match (stop(), bench.refused) {
            (true, _) => CostError::Stopped,
            (false, Some(error)) if rungs.is_empty() => error.into(),
            (false, _) => CostError::BudgetTooShort {
                budget: budget.as_secs_f64(),
                springs: allowed_points(scene).next().unwrap_or(scene.numerics.points),
            },
        });
    };
    drop(rungs);
    let floors = bench.table.reference.errors;
    bench.climb(Knob::GridSprings, GRID_BY, &mut |bench, rung| {
        let springs = rung.solution.points;
        let errors = rung.solution.errors(&target);
        bench.push((Knob::GridSprings, springs as f64, springs), rung.seconds, &errors, &floors);
    })?;
    bench.steps()?;
    if stop() {
        return Err(CostError::Stopped);
    }
    bench.table.spent = bench.budget.spent();
    Ok(bench.table)
}

impl Bench<'_> {
    /// Reports the table so far.
    fn report(&mut self) {
        self.table.spent = self.budget.spent();
        (self.watch)(Progress::Rows(&self.table));
    }

    /// Records settings of a knob that were not tried or not reached.
    fn leave_out(&mut self, knob: Knob, settings: &str) {
        self.table.left_out.push(format!("{}: {settings}", knob.name()));
    }

    /// Runs a scene without any reuse, at most until the end of the budget.
    fn solve(&self, scene: &Scene) -> Result<Solved, RunError> {
        solve(&mut Simulation::new(self.folder.to_path_buf()), scene, &|| self.budget.is_over())
    }

    /// The solution of an outcome with the adhesion forces under the loads around; `None` without time.
    fn around(&self, scene: &Scene, outcome: &Outcome) -> Result<Option<Solution>, RunError> {
        let simulation = &mut Simulation::new(self.folder.to_path_buf());
        Solution::around(simulation, scene, outcome, &|| self.budget.is_over())
    }

    /// Measures the time of whole runs of a scene.
    fn time(&self, scene: &Scene) -> Option<Timing> {
        self.budget.time(|| matches!(self.solve(scene), Ok(Solved::Outcome(_))))
    }

    /// The scene with the number of samples for a comparison of curves.
    fn compared(scene: &Scene) -> Scene {
        let legs = scene.loading.len().max(1) as u64;
        let mut scene = scene.clone();
        scene.numerics.samples = (COMPARED_POINTS / legs).clamp(2, MOST_COMPARED);
        scene
    }

    /// Solutions on more and more springs, until the next would take longer than a share of the budget.
    fn climb(
        &mut self,
        knob: Knob,
        share: f64,
        take: &mut dyn FnMut(&mut Self, Rung),
    ) -> Result<(), RunError> {
        let edges = if knob == Knob::GridSprings { Edges::Grid } else { Edges::SubCell };
        let (mut rungs, mut guess) = (0, 0.0);
        for points in allowed_points(self.scene) {
            // The first two of a ladder may exceed their share, so that a comparison is possible.
            let may_take = if rungs < 2 { 1.0 } else { share };
            let mut solution = None;
            let began = self.budget.spent();
            let scene = refined(self.scene, points, edges);
            if self.budget.left_of(may_take) > guess {
                (self.watch)(Progress::Trying(knob, &format!("{points} springs")));
                solution = match self.solve(&Self::compared(&scene))? {
                    Solved::TooCoarse(error) => {
                        self.refused = Some(error);
                        continue;
                    }
                    Solved::TooMuch => None,
                    Solved::Outcome(outcome) => {
                        let closed_form = closed_form_adhesion(self.scene, &outcome);
                        self.around(&scene, &outcome)?.map(|solution| (solution, closed_form))
                    }
                };
            }
            let Some((solution, closed_form)) = solution else {
                self.leave_out(knob, &format!("{points} springs and more"));
                break;
            };
            let took = self.budget.spent() - began;
            let seconds = self.time(&scene);
            guess = GROWTH * (took + seconds.map_or(took, |seconds| seconds.minimum));
            rungs += 1;
            take(self, Rung { solution, closed_form, seconds });
            self.report();
        }
        Ok(())
    }

    /// Estimated errors of the finest solution with edges between springs; `None` without time for them.
    fn own_errors(&self, finest: &Solution) -> Option<Errors> {
        let scene = Self::compared(&refined(self.scene, finest.points, Edges::SubCell));
        let mut solved = |scene: &Scene| match self.solve(scene) {
            Ok(Solved::Outcome(outcome)) => self.around(scene, &outcome).ok()?,
            _ => None,
        };
        let others = others(&scene, &mut solved)?;
        Some(Measures {
            adhesion_force: others.error(|other| other.errors(finest).adhesion_force),
            curve: others.error(|other| other.errors(finest).curve),
            dissipated_energy: others.error(|other| other.errors(finest).dissipated_energy),
            contact_length: others.error(|other| other.errors(finest).contact_length),
        })
    }

    /// Makes the rows of a ladder with edges between springs, with errors relative to its finest solution or the closed
    /// form, and returns this reference; `None` with fewer than two rungs. The reference has these errors, or without
    /// them twice the last differences.
    fn count(&mut self, sub_cell: &[Rung], own: Option<Errors>) -> Option<Solution> {
        let (finest, coarser) = sub_cell.split_last()?;
        let last = coarser.last()?.solution.errors(&finest.solution);
        let mut errors = own.unwrap_or_else(|| last.map(|last| last.map(|last| 2.0 * last)));
        let mut target = finest.solution.clone();
        if let Some(force) = finest.closed_form {
            target.adhesion_force = Some(force);
            target.around.clear();
            errors.adhesion_force = Some(ROUNDING);
        }
        self.table.reference = Reference {
            springs: target.points,
            adhesion_force: target.adhesion_force,
            closed_form: finest.closed_form.is_some(),
            errors,
        };
        self.table.rows.clear();
        for Rung { solution, seconds, .. } in sub_cell {
            // The difference of the finest solution from itself is zero, which is not its error.
            let own = solution.errors(&target);
            let setting = (Knob::SubCellSprings, solution.points as f64, solution.points);
            self.push(setting, *seconds, &own, &errors);
        }
        Some(target)
    }

    /// Adds the row of a setting on these springs; errors below the floors are not resolved, and orders are relative to
    /// the previous row of the same knob.
    fn push(
        &mut self,
        (knob, setting, springs): (Knob, f64, u64),
        seconds: Option<Timing>,
        errors: &Errors,
        floors: &Errors,
    ) {
        let before = self.table.rows.last().filter(|row| row.knob == knob);
        let ratio = before.map_or(1.0, |row| (setting / row.setting).max(row.setting / setting));
        let coarse = before.map(|row| row.errors).unwrap_or_default();
        let figures = errors.zip(floors, |&error, &floor| Some((error?, floor.unwrap_or(0.0).max(ROUNDING))));
        let errors = figures.zip(&coarse, |&figure, coarse| {
            let (error, floor) = figure?;
            let resolved = error > floor;
            let coarse = coarse.filter(|coarse| coarse.resolved && resolved);
            let order = coarse.and_then(|coarse| observed_order(coarse.error, error, ratio));
            Some(ErrorFigure { error: error.max(floor), resolved, order })
        });
        let transforms = seconds.map(|seconds| seconds.minimum / self.table.transform_seconds);
        self.table.rows.push(Row { knob, setting, springs, seconds, transforms, errors });
    }

    /// The step of the stepwise solver, against the exact solver on as many springs.
    fn steps(&mut self) -> Result<(), RunError> {
        let knob = Knob::Step;
        let Some(points) = allowed_points(self.scene).find(|&points| points >= STEPWISE_SPRINGS) else {
            return Ok(());
        };
        let mut timed = refined(self.scene, points, Edges::Grid);
        let mut scene = Self::compared(&timed);
        // With few springs each of them is a jump, which is late by up to one distance of samples.
        let floors = Measures { curve: Some(1.0 / scene.numerics.samples as f64), ..Measures::default() };
        let exact = if self.budget.is_over() { Solved::TooMuch } else { self.solve(&scene)? };
        let Solved::Outcome(exact) = exact else {
            self.leave_out(knob, "all steps");
            return Ok(());
        };
        let exact = Solution::of(&exact);
        let Some((low, high)) = exact.curve.indentations().filter(|(low, high)| low < high) else {
            return Ok(());
        };
        let mut guess = 0.0;
        for halving in 0..MOST_HALVINGS {
            let step = (high - low) / FEWEST_STEPS * (-f64::from(halving)).exp2();
            scene.numerics.solver = Solver::Stepwise { step };
            timed.numerics.solver = scene.numerics.solver;
            if !check(&scene).is_empty() {
                break;
            }
            let named = format_quantity(step, "m");
            let began = self.budget.spent();
            let mut solved = Solved::TooMuch;
            if self.budget.left_of(1.0) > guess {
                (self.watch)(Progress::Trying(knob, &named));
                solved = self.solve(&scene)?;
            }
            let Solved::Outcome(outcome) = solved else {
                self.leave_out(knob, &format!("{named} and less, on {points} springs"));
                break;
            };
            let took = self.budget.spent() - began;
            // No second run of one that takes seconds already.
            let seconds = if took < self.budget.left_of(1.0) / 4.0 {
                self.time(&timed)
            } else {
                Timing::of(vec![took])
            };
            guess = 2.0 * took;
            self.push((knob, step, points), seconds, &Solution::of(&outcome).errors(&exact), &floors);
            self.report();
        }
        Ok(())
    }
}
