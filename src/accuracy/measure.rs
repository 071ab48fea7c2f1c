//! Measurement of the cost of accuracy for one scene: each knob from coarse to fine, within the budget.

use super::bench::{Bench, CostError, Progress, ROUNDING, Rows, Tried, Watch};
use super::clock::Budget;
use super::convergence::{error_of_finest, first_within};
use super::others;
use super::solution::{Solution, Solved, allowed_points, closed_form_adhesion, refined};
use super::{CostTable, Knob, Measures, Reference, Row, Timing};
use crate::scene::{Edges, Scene};
use crate::simulation::RunError;
use std::path::Path;
use std::time::Duration;

/// Assumed ratio of times for twice as many springs, before a measurement.
const GROWTH: f64 = 2.2;
/// Shares of the budget at which the ladders end.
const SUB_CELL_BY: f64 = 0.35;
const GRID_BY: f64 = 0.65;

/// The ladder of edges between springs, with errors relative to its finest solution or the closed form.
struct Counted {
    reference: Reference,
    target: Solution,
    rows: Vec<Row>,
    /// Springs of the first row from which on the main error is at most one per cent, or of the finest row.
    good: u64,
}

/// One rung of a ladder of springs.
struct Rung {
    solution: Solution,
    /// The adhesion force in closed form, N, if the scene has one.
    closed_form: Option<f64>,
    seconds: Option<Timing>,
}

impl Rung {
    fn tried(&self, knob: Knob, errors: Measures<Option<f64>>) -> Tried {
        let springs = self.solution.points;
        Tried { knob, setting: springs as f64, springs, seconds: self.seconds, errors }
    }
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
    let transform_seconds = clock.of_one_transform().unwrap_or(f64::NAN);
    let mut bench = Bench { scene, folder, budget: clock, transform_seconds, left_out: Vec::new() };
    let too_short = || match stop() {
        true => CostError::Stopped,
        false => CostError::BudgetTooShort {
            budget: budget.as_secs_f64(),
            springs: allowed_points(scene).next().unwrap_or(scene.numerics.points),
        },
    };

    let sub_cell = bench.climb(Knob::SubCellSprings, SUB_CELL_BY, watch, &|bench, rungs| {
        let Counted { reference, rows, .. } = bench.count(rungs)?;
        Some(bench.table(reference, rows))
    })?;
    let Counted { reference, target, mut rows, good } = bench.count(&sub_cell).ok_or_else(too_short)?;
    drop(sub_cell);
    let with_grid = |bench: &Bench<'_>, rungs: &[Rung], rows: &mut Vec<Row>| {
        for rung in rungs {
            let own = rung.solution.errors(&target);
            bench.push(rows, rung.tried(Knob::GridSprings, own), &reference.errors);
        }
    };
    let grid = bench.climb(Knob::GridSprings, GRID_BY, watch, &|bench, rungs| {
        let mut rows = rows.clone();
        with_grid(bench, rungs, &mut rows);
        Some(bench.table(reference, rows))
    })?;
    with_grid(&bench, &grid, &mut rows);
    drop(grid);
    let mut table = Rows { rows, reference, watch };
    others::measure(&mut bench, good, &mut table)?;
    if stop() {
        return Err(CostError::Stopped);
    }
    let rows = table.rows;
    Ok(bench.table(reference, rows))
}

impl Bench<'_> {
    /// Solutions on more and more springs, until the next would take longer than a share of the budget.
    fn climb(
        &mut self,
        knob: Knob,
        share: f64,
        watch: &mut Watch<'_>,
        so_far: &dyn Fn(&Bench<'_>, &[Rung]) -> Option<CostTable>,
    ) -> Result<Vec<Rung>, RunError> {
        let edges = if knob == Knob::GridSprings { Edges::Grid } else { Edges::SubCell };
        let (mut rungs, mut guess) = (Vec::new(), 0.0);
        for points in allowed_points(self.scene) {
            // The first two of a ladder may exceed their share, so that a comparison is possible.
            let may_take = if rungs.len() < 2 { 1.0 } else { share };
            if self.budget.left_of(may_take) <= guess {
                self.leave_out(knob, &format!("{points} springs and more"));
                break;
            }
            watch(Progress::Trying(knob, &format!("{points} springs")));
            let began = self.budget.spent();
            let scene = refined(self.scene, points, edges);
            let outcome = match self.solve(&self.compared(&scene))? {
                Solved::TooCoarse => continue,
                Solved::TooMuch => {
                    self.leave_out(knob, &format!("{points} springs and more"));
                    break;
                }
                Solved::Outcome(outcome) => outcome,
            };
            let took = self.budget.spent() - began;
            let seconds = self.time(&scene);
            guess = GROWTH * (took + seconds.map_or(took, |seconds| seconds.minimum));
            let closed_form = closed_form_adhesion(self.scene, &outcome);
            rungs.push(Rung { solution: Solution::of(&outcome), closed_form, seconds });
            watch(Progress::Rows(&|| so_far(self, &rungs)));
        }
        Ok(rungs)
    }

    /// Computes the errors of a ladder with edges between springs; `None` with fewer than two rungs.
    fn count(&self, sub_cell: &[Rung]) -> Option<Counted> {
        let (finest, coarser) = sub_cell.split_last()?;
        let last = coarser.last()?.solution.errors(&finest.solution);
        let before = match coarser {
            [.., one, other] => one.solution.errors(&other.solution),
            _ => Measures::default(),
        };
        let mut errors = before.zip(&last, |&before, &last| {
            let differences: Vec<f64> = before.into_iter().chain([last?]).collect();
            Some(error_of_finest(&differences))
        });
        let mut target = finest.solution.clone();
        if let Some(force) = finest.closed_form {
            target.adhesion_force = Some(force);
            errors.adhesion_force = Some(ROUNDING);
        }
        let reference = Reference {
            springs: target.points,
            adhesion_force: target.adhesion_force,
            closed_form: finest.closed_form.is_some(),
            errors,
        };
        let known = |rung: &Rung| {
            let own = rung.solution.errors(&target);
            let is_finest = rung.solution.points == target.points;
            // The difference of the finest solution from itself is zero, which is not its error.
            own.zip(&errors, |own, floor| if is_finest && *own == Some(0.0) { *floor } else { *own })
        };
        let own: Vec<_> = sub_cell.iter().map(known).collect();
        let mut rows = Vec::new();
        for (rung, &own) in sub_cell.iter().zip(&own) {
            self.push(&mut rows, rung.tried(Knob::SubCellSprings, own), &errors);
        }
        let main = |errors: &Measures<Option<f64>>| errors.adhesion_force.or(errors.curve);
        let first_good = first_within(own.iter().map(main), 0.01).unwrap_or(sub_cell.len() - 1);
        let good = sub_cell.get(first_good).map_or(target.points, |rung| rung.solution.points);
        Some(Counted { reference, target, rows, good })
    }
}
