//! Reader of the merged results of a study, for plots and views.

use super::StudyError;
use super::axis::Axis;
use super::cell_summary::{CellSummary, Spread};
use super::figure::Estimate;
use super::numbering::number_at;
use super::plan::Plan;
use super::quantity::Quantity;
use super::store::{Folder, LONGEST_LINE};
use super::tables::{REGIME_COLUMNS, RESULTS, SIDECAR, SUMMARY};
use crate::analysis::Regime;
use crate::io::{ReadError, open_regular, sha256_of};
use serde::Deserialize;
use std::io::{self, BufRead, BufReader, Read};
use std::path::Path;

/// A study with published tables, cell by cell.
#[derive(Clone, Debug, PartialEq)]
pub struct Finished {
    plan: Plan,
    cells: Vec<Option<CellSummary>>,
}

/// One row of the results: one cell on one profile.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Index of the cell.
    pub cell: u64,
    /// Seed of the profile.
    pub seed: u64,
    /// For each quantity that the plan records, in that order; `None` where the profile has no value, and for the
    /// regime.
    pub values: Vec<Option<f64>>,
    /// The regime, where recorded and known.
    pub regime: Option<Regime>,
}

impl Finished {
    /// Reads the summary of a merged study.
    ///
    /// # Errors
    /// A folder of no study, or tables that are not published or were changed.
    pub fn open(path: &Path) -> Result<Finished, StudyError> {
        let plan = Folder::open(path)?.plan().clone();
        let mut cells: Vec<Option<CellSummary>> = vec![None; plan.cells() as usize];
        each_row(&path.join(SUMMARY), &plan, |columns| {
            let summary = summary_of(&plan, columns)?;
            let place = cells.get_mut(summary.cell as usize)?;
            *place = Some(summary);
            Some(())
        })?;
        check_merge(path)?;
        Ok(Finished { plan, cells })
    }

    /// The plan, with its axes.
    #[must_use]
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// Summary of a cell; `None` where the tables were published without it. In the numbering of cells the last
    /// axis is the fastest but for the preload; [`Plan::values`] has their coordinates.
    #[must_use]
    pub fn cell(&self, cell: u64) -> Option<&CellSummary> {
        self.cells.get(cell as usize)?.as_ref()
    }

    /// The cell at these places on the axes, the preload's last if there are preloads.
    #[must_use]
    pub fn at(&self, places: &[u64]) -> Option<&CellSummary> {
        self.cell(number_at(places, self.plan.all_axes().into_iter().map(Axis::count))?)
    }

    /// A recorded quantity in all cells.
    pub(super) fn estimates(&self, column: usize) -> Vec<Option<Estimate>> {
        self.cells.iter().map(|cell| cell.as_ref()?.estimate(column)).collect()
    }

    /// The cells over one axis or two, by their numbers, at these places on the others: row by row, both axes by
    /// ascending values.
    pub(super) fn grid(
        &self,
        across: usize,
        up: Option<usize>,
        mut places: Vec<u64>,
    ) -> Vec<Option<&CellSummary>> {
        let axes = self.plan.all_axes();
        let columns = axes[across].ascending();
        let mut cells = Vec::with_capacity(columns.len());
        for row in up.map_or(vec![0], |up| axes[up].ascending()) {
            if let Some(up) = up {
                places[up] = row;
            }
            for column in &columns {
                places[across] = *column;
                cells.push(self.at(&places));
            }
        }
        cells
    }

    /// Place of a quantity among the recorded quantities.
    pub(super) fn column(&self, quantity: Quantity) -> Option<usize> {
        self.plan.record.iter().position(|one| *one == quantity)
    }

    /// Mean and spread of a quantity in a cell.
    #[must_use]
    pub fn spread(&self, cell: u64, quantity: Quantity) -> Option<Spread> {
        self.cell(cell)?.quantities[self.column(quantity)?]
    }

    /// Calls `each` with every row of the results, sorted by cell, then by seed.
    ///
    /// # Errors
    /// As [`Finished::open`].
    pub fn rows(path: &Path, mut each: impl FnMut(Row)) -> Result<(), StudyError> {
        let plan = Folder::open(path)?.plan().clone();
        each_row(&path.join(RESULTS), &plan, |columns| {
            each(row_of(&plan, columns)?);
            Some(())
        })
    }
}

/// Checks that summary and sidecar are of one merge.
fn check_merge(path: &Path) -> Result<(), StudyError> {
    #[derive(Deserialize)]
    struct Sidecar {
        summary_sha256: String,
    }
    // A study without a summary has not been merged; one without a sidecar cannot be of two merges.
    let (Ok(hash), true) = (sha256_of(&path.join(SUMMARY)), path.join(SIDECAR).exists()) else {
        return Ok(());
    };
    let wrong = |error: ReadError| StudyError::folder(&path.join(SIDECAR), error.to_string());
    let file = open_regular(&path.join(SIDECAR)).map_err(wrong)?;
    let sidecar: Option<Sidecar> = serde_json::from_reader(BufReader::new(file)).ok();
    if sidecar.is_some_and(|sidecar| sidecar.summary_sha256 == hash) {
        return Ok(());
    }
    let merge = crate::scene::quoted(path);
    let reason =
        format!("{SUMMARY} and {SIDECAR} are not of one merge; asperity sweep merge {merge} renews both");
    Err(StudyError::folder(path, reason))
}

/// Calls `each` with the columns of every row but the first, whose number of columns is checked.
fn each_row(path: &Path, plan: &Plan, mut each: impl FnMut(&[&str]) -> Option<()>) -> Result<(), StudyError> {
    let wrong = |reason: String| StudyError::folder(path, reason);
    let file = open_regular(path).map_err(|error| match error {
        ReadError::Failed(error) if error.kind() == io::ErrorKind::NotFound => {
            not_merged(path.parent().unwrap_or(path))
        }
        error => wrong(error.to_string()),
    })?;
    let mut reader = BufReader::new(file);
    let (mut count, mut line) = (None, Vec::new());
    for number in 0.. {
        line.clear();
        let read = reader.by_ref().take(LONGEST_LINE).read_until(b'\n', &mut line);
        if read.map_err(StudyError::unreadable(path))? == 0 {
            break;
        }
        // A line that is too long, torn or not text has no acceptable columns.
        let text =
            line.strip_suffix(b"\n").and_then(|line| std::str::from_utf8(line).ok()).unwrap_or_default();
        let columns: Vec<&str> = text.trim_end_matches('\r').split(',').collect();
        match count {
            None => {
                let start = plan.axes.iter().map(Axis::path);
                let known = ["cell"].into_iter().chain(start).zip(&columns).all(|(a, b)| a == *b);
                if !known {
                    return Err(wrong("its columns are not those of the plan".into()));
                }
                count = Some(columns.len());
            }
            Some(count) if count == columns.len() && each(&columns).is_some() => {}
            Some(_) => return Err(wrong(format!("line {} is no row of this table", number + 1))),
        }
    }
    Ok(())
}

fn not_merged(folder: &Path) -> StudyError {
    let merge = crate::scene::quoted(folder.display().to_string());
    let reason = format!("the study has not been merged yet; asperity sweep merge {merge} does it");
    StudyError::folder(folder, reason)
}

fn value(text: &str) -> Option<Option<f64>> {
    if text.is_empty() { Some(None) } else { text.parse().ok().map(Some) }
}

fn summary_of(plan: &Plan, columns: &[&str]) -> Option<CellSummary> {
    let mut columns = columns.iter();
    let cell = columns.next()?.parse().ok()?;
    let lines = columns.nth(plan.axes.len() + 1)?.parse().ok()?;
    let mut next = || value(columns.next()?);
    let mut quantities = Vec::with_capacity(plan.record.len());
    let mut regimes = None;
    for quantity in &plan.record {
        if *quantity == Quantity::Regime {
            let shares: Vec<Option<f64>> =
                REGIME_COLUMNS.iter().map(|_| next()).collect::<Option<Vec<_>>>()?;
            regimes = shares.into_iter().collect::<Option<Vec<_>>>().and_then(|all| all.try_into().ok());
            quantities.push(None);
            continue;
        }
        let (mean, standard_deviation, low, high) = (next()?, next()?, next()?, next()?);
        let confidence_interval = low.zip(high);
        quantities.push(mean.map(|mean| Spread { mean, standard_deviation, confidence_interval }));
    }
    columns.next().is_none().then_some(CellSummary { cell, lines, quantities, regimes })
}

fn row_of(plan: &Plan, columns: &[&str]) -> Option<Row> {
    let mut columns = columns.iter();
    let cell = columns.next()?.parse().ok()?;
    let seed = columns.nth(plan.axes.len() + 1)?.parse().ok()?;
    let mut values = Vec::with_capacity(plan.record.len());
    let mut regime = None;
    for quantity in &plan.record {
        let text = *columns.next()?;
        if *quantity == Quantity::Regime {
            regime = Regime::ALL.into_iter().find(|regime| regime.name() == text);
            values.push(None);
        } else {
            values.push(value(text)?);
        }
    }
    columns.next().is_none().then_some(Row { cell, seed, values, regime })
}
