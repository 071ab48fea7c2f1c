//! Measures what accuracy costs for one scene: each knob from coarse to fine, as far as the budget goes.

use super::clock::Budget;
use super::convergence::{error_of_finest, first_within, observed_order};
use super::others;
use super::solution::{Solution, Solved, allowed_points, closed_form_adhesion, refined, solve};
use super::{CostTable, ErrorFigure, Knob, Measures, Reference, Row, Timing};
use crate::scene::{Edges, Scene};
use crate::simulation::{Outcome, RunError};
use std::path::Path;
use std::time::Duration;
use thiserror::Error;

/// How much longer twice as many springs take, for a guess before they are tried.
const GROWTH: f64 = 2.2;
/// Points of all legs of a curve that is compared: many, so that samples blur no error of the springs.
const COMPARED_POINTS: u64 = 1 << 16;
/// Samples of a leg that is compared, at most.
const MOST_COMPARED: u64 = 4096;
/// Errors below this are not told from rounding.
const ROUNDING: f64 = 1e-14;
/// Shares of the budget by the end of which the ladders have ended.
const SUB_CELL_BY: f64 = 0.35;
const GRID_BY: f64 = 0.65;

/// Why there is no table.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum CostError {
    /// The scene could not be computed.
    #[error(transparent)]
    Run(#[from] RunError),
    /// Fewer than two solutions fit into the budget: nothing is known of their errors.
    #[error(
        "the budget of {budget} s is spent before two solutions could be compared, of which the coarsest has \
         {springs} springs"
    )]
    BudgetTooShort {
        /// The budget, s.
        budget: f64,
        /// Fewest springs the scene allows.
        springs: u64,
    },
}

/// What is measured, of what, and until when.
pub(super) struct Bench<'a> {
    pub scene: &'a Scene,
    pub folder: &'a Path,
    pub budget: Budget,
    pub transform_seconds: f64,
    pub left_out: Vec<String>,
}

/// A setting that was tried.
pub(super) struct Tried {
    pub knob: Knob,
    pub setting: f64,
    pub springs: u64,
    pub seconds: Option<Timing>,
    pub errors: Measures<Option<f64>>,
}

/// One rung of a ladder of springs.
struct Rung {
    outcome: Box<Outcome>,
    solution: Solution,
    seconds: Option<Timing>,
}

impl Rung {
    fn tried(&self, knob: Knob, errors: Measures<Option<f64>>) -> Tried {
        let springs = self.solution.points;
        Tried { knob, setting: springs as f64, springs, seconds: self.seconds, errors }
    }
}

/// Measures the table of a checked scene whose files lie in `folder`, within a budget of time. `progress` is
/// told each knob and setting before it is tried.
///
/// # Errors
/// [`CostError`].
pub fn measure(
    scene: &Scene,
    folder: &Path,
    budget: Duration,
    progress: &mut dyn FnMut(Knob, &str),
) -> Result<CostTable, CostError> {
    let clock = Budget::begin(budget);
    let transform_seconds = clock.of_one_transform().unwrap_or(f64::NAN);
    let mut bench = Bench { scene, folder, budget: clock, transform_seconds, left_out: Vec::new() };
    let too_short = || CostError::BudgetTooShort {
        budget: budget.as_secs_f64(),
        springs: allowed_points(scene).next().unwrap_or(scene.numerics.points),
    };

    let sub_cell = bench.climb(Knob::SubCellSprings, SUB_CELL_BY, progress)?;
    let (finest, coarser) = sub_cell.split_last().ok_or_else(too_short)?;
    let last = coarser.last().ok_or_else(too_short)?.solution.errors(&finest.solution);
    let before = match coarser {
        [.., one, other] => one.solution.errors(&other.solution),
        _ => Measures::default(),
    };
    let mut errors = before.zip(&last, |&before, &last| Some(error_of_finest(before, last?)));
    let mut target = finest.solution.clone();
    let closed_form = closed_form_adhesion(scene, &finest.outcome);
    if let Some(force) = closed_form {
        target.adhesion_force = Some(force);
        errors.adhesion_force = Some(ROUNDING);
    }
    let reference = Reference {
        springs: target.points,
        adhesion_force: target.adhesion_force,
        closed_form: closed_form.is_some(),
        errors,
    };
    let known = |rung: &Rung| {
        let own = rung.solution.errors(&target);
        let is_finest = rung.solution.points == target.points;
        // From itself the finest solution differs by nothing, which is not its error.
        own.zip(&errors, |own, floor| if is_finest && *own == Some(0.0) { *floor } else { *own })
    };

    let mut rows = Vec::new();
    let sub_cell_errors: Vec<_> = sub_cell.iter().map(known).collect();
    for (rung, &own) in sub_cell.iter().zip(&sub_cell_errors) {
        bench.push(&mut rows, rung.tried(Knob::SubCellSprings, own), &errors);
    }
    let grid = bench.climb(Knob::GridSprings, GRID_BY, progress)?;
    for rung in &grid {
        let own = rung.solution.errors(&target);
        bench.push(&mut rows, rung.tried(Knob::GridSprings, own), &errors);
    }

    let main = |errors: &Measures<Option<f64>>| errors.adhesion_force.or(errors.curve);
    let good = first_within(sub_cell_errors.iter().map(main), 0.01);
    let points =
        sub_cell.get(good.unwrap_or(sub_cell.len() - 1)).map_or(target.points, |rung| rung.solution.points);
    drop((sub_cell, grid));
    others::measure(&mut bench, points, &mut rows, progress)?;
    let (spent, left_out) = (bench.budget.spent(), bench.left_out);
    Ok(CostTable { budget: budget.as_secs_f64(), spent, transform_seconds, reference, rows, left_out })
}

impl Bench<'_> {
    /// Solutions on more and more springs, until the next would take longer than a share of the budget.
    fn climb(
        &mut self,
        knob: Knob,
        share: f64,
        progress: &mut dyn FnMut(Knob, &str),
    ) -> Result<Vec<Rung>, RunError> {
        let edges = if knob == Knob::GridSprings { Edges::Grid } else { Edges::SubCell };
        let (mut rungs, mut guess) = (Vec::new(), 0.0);
        for points in allowed_points(self.scene) {
            // The first two of a ladder may take what they need, so that there is something to compare.
            let may_take = if rungs.len() < 2 { 1.0 } else { share };
            if self.budget.left_of(may_take) <= guess {
                self.not_affordable(knob, points);
                break;
            }
            progress(knob, &format!("{points} springs"));
            let began = self.budget.spent();
            let scene = refined(self.scene, points, edges);
            let outcome = match self.solve(&self.compared(&scene))? {
                Solved::TooCoarse => continue,
                Solved::TooMuch => {
                    self.not_affordable(knob, points);
                    break;
                }
                Solved::Outcome(outcome) => outcome,
            };
            let took = self.budget.spent() - began;
            let seconds = self.time(&scene);
            guess = GROWTH * (took + seconds.map_or(took, |seconds| seconds.minimum));
            rungs.push(Rung { solution: Solution::of(&outcome), outcome, seconds });
        }
        Ok(rungs)
    }

    fn not_affordable(&mut self, knob: Knob, points: u64) {
        self.left_out.push(format!("{}: {points} springs and more", knob.name()));
    }

    /// Runs a scene with everything made anew, at most until the budget is over.
    pub fn solve(&self, scene: &Scene) -> Result<Solved, RunError> {
        solve(scene, self.folder, &|| self.budget.is_over())
    }

    /// Times whole runs of a scene.
    pub fn time(&self, scene: &Scene) -> Option<Timing> {
        self.budget.time(|| matches!(self.solve(scene), Ok(Solved::Outcome(_))))
    }

    /// The scene with as many samples as curves are compared with.
    pub fn compared(&self, scene: &Scene) -> Scene {
        let legs = scene.loading.len().max(1) as u64;
        let mut scene = scene.clone();
        scene.numerics.samples = (COMPARED_POINTS / legs).clamp(2, MOST_COMPARED);
        scene
    }

    /// Adds a row; its orders follow from the row before of the same knob.
    pub fn push(&self, rows: &mut Vec<Row>, tried: Tried, floors: &Measures<Option<f64>>) {
        let Tried { knob, setting, springs, seconds, errors } = tried;
        let before = rows.last().filter(|row| row.knob == knob);
        let ratio = before.map_or(1.0, |row| (setting / row.setting).max(row.setting / setting));
        let figures = errors.zip(floors, |&error, &floor| {
            let (error, floor) = (error?, floor.unwrap_or(0.0).max(ROUNDING));
            let resolved = error > floor;
            Some(ErrorFigure { error: error.max(floor), resolved, order: None })
        });
        let figures = match before {
            None => figures,
            Some(row) => figures.zip(&row.errors, |&figure, before| {
                let figure = figure?;
                let coarse = before.filter(|before| before.resolved && figure.resolved);
                let order = coarse.and_then(|coarse| observed_order(coarse.error, figure.error, ratio));
                Some(ErrorFigure { order, ..figure })
            }),
        };
        let transforms = seconds.map(|seconds| seconds.minimum / self.transform_seconds);
        rows.push(Row { knob, setting, springs, seconds, transforms, errors: figures });
    }
}
