//! Measures what accuracy costs for one scene: each knob from coarse to fine, as far as the budget goes.

use super::clock::Budget;
use super::convergence::{error_of_finest, first_within, observed_order};
use super::others;
use super::solution::{Solution, Solved, allowed_points, closed_form_adhesion, refined, solve};
use super::{CostTable, ErrorFigure, Knob, Measures, Reference, Row, Timing};
use crate::scene::{Edges, Scene};
use crate::simulation::{RunError, Simulation};
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
    /// The measurement was told to stop.
    #[error("the measurement was stopped")]
    Stopped,
}

/// What a measurement tells while it goes on.
pub enum Progress<'a> {
    /// A knob and a setting of it will be tried next.
    Trying(Knob, &'a str),
    /// There is another row. The table so far is made when it is asked for, `None` while there is nothing to
    /// compare with; until the ladder of edges between springs has ended, errors in it are counted from the
    /// finest of its solutions so far.
    Rows(&'a dyn Fn() -> Option<CostTable>),
}

/// Who is told the progress of a measurement.
pub(super) type Watch<'a> = dyn FnMut(Progress<'_>) + 'a;

/// What is measured, of what, and until when.
pub(super) struct Bench<'a> {
    pub scene: &'a Scene,
    pub folder: &'a Path,
    pub budget: Budget<'a>,
    pub transform_seconds: f64,
    pub left_out: Vec<String>,
}

/// The ladder of edges between springs, with errors counted from its finest solution or the closed form.
struct Counted {
    reference: Reference,
    target: Solution,
    rows: Vec<Row>,
    /// Springs of the first row from which on the main error is at most one per cent, or of the finest.
    good: u64,
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
    solution: Solution,
    /// The adhesion force in closed form, N, where the scene has one.
    closed_form: Option<f64>,
    seconds: Option<Timing>,
}

impl Rung {
    fn tried(&self, knob: Knob, errors: Measures<Option<f64>>) -> Tried {
        let springs = self.solution.points;
        Tried { knob, setting: springs as f64, springs, seconds: self.seconds, errors }
    }
}

/// Measures the table of a checked scene whose files lie in `folder`, within a budget of time. `stop` is asked
/// now and then whether to give up; `watch` is told what is tried and what came of it.
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

/// The rows so far, and who is told of each that is added.
pub(super) struct Rows<'a, 'b> {
    rows: Vec<Row>,
    reference: Reference,
    watch: &'a mut Watch<'b>,
}

impl Rows<'_, '_> {
    /// Tells what will be tried next.
    pub(super) fn trying(&mut self, knob: Knob, setting: &str) {
        (self.watch)(Progress::Trying(knob, setting));
    }

    /// Adds a row.
    pub(super) fn add(&mut self, bench: &Bench<'_>, tried: Tried, floors: &Measures<Option<f64>>) {
        bench.push(&mut self.rows, tried, floors);
        let (rows, reference) = (&self.rows, self.reference);
        (self.watch)(Progress::Rows(&|| Some(bench.table(reference, rows.clone()))));
    }
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
            // The first two of a ladder may take what they need, so that there is something to compare.
            let may_take = if rungs.len() < 2 { 1.0 } else { share };
            if self.budget.left_of(may_take) <= guess {
                self.not_affordable(knob, points);
                break;
            }
            watch(Progress::Trying(knob, &format!("{points} springs")));
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
            let closed_form = closed_form_adhesion(self.scene, &outcome);
            rungs.push(Rung { solution: Solution::of(&outcome), closed_form, seconds });
            watch(Progress::Rows(&|| so_far(self, &rungs)));
        }
        Ok(rungs)
    }

    /// The table as far as it is.
    fn table(&self, reference: Reference, rows: Vec<Row>) -> CostTable {
        CostTable {
            budget: self.budget.seconds(),
            spent: self.budget.spent(),
            transform_seconds: self.transform_seconds,
            reference,
            rows,
            left_out: self.left_out.clone(),
        }
    }

    /// Counts the errors of a ladder with edges between springs; `None` with fewer than two rungs.
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
            // From itself the finest solution differs by nothing, which is not its error.
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

    fn not_affordable(&mut self, knob: Knob, points: u64) {
        self.left_out.push(format!("{}: {points} springs and more", knob.name()));
    }

    /// Runs a scene with everything made anew, at most until the budget is over.
    pub fn solve(&self, scene: &Scene) -> Result<Solved, RunError> {
        solve(&mut Simulation::new(self.folder.to_path_buf()), scene, &|| self.budget.is_over())
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
    fn push(&self, rows: &mut Vec<Row>, tried: Tried, floors: &Measures<Option<f64>>) {
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
