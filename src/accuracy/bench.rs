//! One measurement: its budget, its rows and its progress.

use super::clock::Budget;
use super::convergence::observed_order;
use super::solution::{Solution, Solved, solve};
use super::{CostTable, ErrorFigure, Knob, Measures, Reference, Row, Timing};
use crate::scene::Scene;
use crate::simulation::{RunError, Simulation};
use std::path::Path;
use thiserror::Error;

/// Points of all legs of a curve that is compared: many, so that samples blur no error of the springs.
const COMPARED_POINTS: u64 = 1 << 16;
/// Samples of a leg that is compared, at most.
const MOST_COMPARED: u64 = 4096;
/// Errors below this cannot be distinguished from rounding.
pub(super) const ROUNDING: f64 = 1e-14;

/// Reason for which there is no table.
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
    /// The measurement was stopped.
    #[error("the measurement was stopped")]
    Stopped,
}

/// Progress of a measurement.
pub enum Progress<'a> {
    /// A knob and a setting of it will be tried next.
    Trying(Knob, &'a str),
    /// There is another row. The table so far is made when it is asked for, `None` while there is nothing to
    /// compare with; until the ladder of edges between springs has ended, errors in it are counted from the
    /// finest of its solutions so far.
    Rows(&'a dyn Fn() -> Option<CostTable>),
}

/// Observer of the progress of a measurement.
pub(super) type Watch<'a> = dyn FnMut(Progress<'_>) + 'a;

/// Measurement of a scene within a budget of time.
pub(super) struct Bench<'a> {
    pub scene: &'a Scene,
    pub folder: &'a Path,
    pub budget: Budget<'a>,
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

/// The rows so far, and the observer of added rows.
pub(super) struct Rows<'a, 'b> {
    pub rows: Vec<Row>,
    pub reference: Reference,
    pub watch: &'a mut Watch<'b>,
}

impl Rows<'_, '_> {
    /// Reports the next setting.
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
    /// The table as far as it is.
    pub(super) fn table(&self, reference: Reference, rows: Vec<Row>) -> CostTable {
        CostTable {
            budget: self.budget.seconds(),
            spent: self.budget.spent(),
            transform_seconds: self.transform_seconds,
            reference,
            rows,
            left_out: self.left_out.clone(),
        }
    }

    /// Notes settings of a knob that were not tried or not reached.
    pub(super) fn leave_out(&mut self, knob: Knob, settings: &str) {
        self.left_out.push(format!("{}: {settings}", knob.name()));
    }

    /// Runs a scene with everything made anew, at most until the budget is over.
    pub fn solve(&self, scene: &Scene) -> Result<Solved, RunError> {
        solve(&mut Simulation::new(self.folder.to_path_buf()), scene, &|| self.budget.is_over())
    }

    /// Solves the scene from which settings of a knob differ; without a solution the settings are left out.
    pub fn reference(
        &mut self,
        scene: &Scene,
        knob: Knob,
        settings: &str,
    ) -> Result<Option<Solution>, RunError> {
        if !self.budget.is_over()
            && let Solved::Outcome(outcome) = self.solve(scene)?
        {
            return Ok(Some(Solution::of(&outcome)));
        }
        self.leave_out(knob, settings);
        Ok(None)
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
    pub(super) fn push(&self, rows: &mut Vec<Row>, tried: Tried, floors: &Measures<Option<f64>>) {
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
