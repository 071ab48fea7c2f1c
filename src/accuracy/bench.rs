//! One measurement: its budget, its rows and its progress.

use super::clock::Budget;
use super::convergence::observed_order;
use super::solution::{Solution, Solved, solve};
use super::{CostTable, ErrorFigure, Knob, Measures, Reference, Row, Timing};
use crate::scene::Scene;
use crate::simulation::{RunError, Simulation};
use std::path::Path;
use thiserror::Error;

/// Points of a compared curve, all loading stages together: many, so that sampling hides no error of the springs.
const COMPARED_POINTS: u64 = 1 << 16;
/// Most samples of a compared loading stage.
const MOST_COMPARED: u64 = 4096;
/// Errors below this are indistinguishable from rounding.
pub(super) const ROUNDING: f64 = 1e-14;

/// Reason why there is no table.
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
    /// A row was added. The function makes the table so far, `None` without a comparison; until the ladder of edges
    /// between springs has ended, errors in it are relative to the finest of its solutions so far.
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

/// A tried setting.
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
    /// The table so far.
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

    /// Records settings of a knob that were not tried or not reached.
    pub(super) fn leave_out(&mut self, knob: Knob, settings: &str) {
        self.left_out.push(format!("{}: {settings}", knob.name()));
    }

    /// Runs a scene without any reuse, at most until the end of the budget.
    pub fn solve(&self, scene: &Scene) -> Result<Solved, RunError> {
        solve(&mut Simulation::new(self.folder.to_path_buf()), scene, &|| self.budget.is_over())
    }

    /// Solves the reference scene of the settings of a knob; without a solution the settings are left out.
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

    /// Measures the time of whole runs of a scene.
    pub fn time(&self, scene: &Scene) -> Option<Timing> {
        self.budget.time(|| matches!(self.solve(scene), Ok(Solved::Outcome(_))))
    }

    /// The scene with the number of samples for a comparison of curves.
    pub fn compared(&self, scene: &Scene) -> Scene {
        let legs = scene.loading.len().max(1) as u64;
        let mut scene = scene.clone();
        scene.numerics.samples = (COMPARED_POINTS / legs).clamp(2, MOST_COMPARED);
        scene
    }

    /// Adds a row; its orders are relative to the previous row of the same knob.
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
