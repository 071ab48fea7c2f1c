//! Tables of a study: all recorded values, their statistics over the profiles, and a description of
//! the columns.

use super::axis::Axis;
use super::error::StudyError;
use super::grid::GridCell;
use super::plan::Plan;
use super::quantity::{Quantity, regime_of};
use super::results::{Merged, Results};
use super::statistics::{CONFIDENCE, Statistics};
use super::store::{Folder, lines};
use asperity_data::{
    Kind, ReadError, Table, TableOf, object, open_regular, read_regular_text, remove_abandoned,
    sha256_of, write_json, write_new_file,
};
use asperity_scene::Regime;
use serde::Serialize;
use std::io;
use std::io::BufReader;
use std::path::Path;

/// Version of the format of the files that [`merge`] writes.
pub const RESULTS_VERSION: u32 = 1;
/// Name of the column with the reasons of records without values.
const REASON: &str = "reason";
/// Largest length in bytes of a description of the columns that is read.
const LONGEST_SIDECAR: usize = 1 << 26;

impl Merged {
    /// Name of the file with the table of all results. The table has one row for each [cell](Plan)
    /// and profile.
    pub const RESULTS: &str = "results.csv";
    /// Name of the file with the table of statistics over the profiles. The table has one row for
    /// each [cell](Plan).
    pub const SUMMARY: &str = "summary.csv";
    /// Name of the file that describes the columns of the tables [`Merged::RESULTS`] and
    /// [`Merged::SUMMARY`].
    pub const SIDECAR: &str = "results.json";
}

/// Merges the results of all processes in the folder of a study, and writes the tables
/// [`Merged::RESULTS`] and [`Merged::SUMMARY`] with their description [`Merged::SIDECAR`]. If some
/// results are missing, the tables have the existing ones.
///
/// # Errors
/// Returns an error if two files have different results for the same [cell](Plan) and profile, or
/// if a file cannot be read or written.
pub fn merge(folder: &Folder) -> Result<Merged, StudyError> {
    let (results, merged) = Results::of_shards(folder)?;
    remove_abandoned(folder.path());
    let plan = results.plan();
    let path = |name| folder.path().join(name);
    write_new_file(&path(Merged::RESULTS), true, |out| {
        results.table().write_csv(out, "")
    })?;
    write_new_file(&path(Merged::SUMMARY), true, |out| {
        results.summary().write_csv(out, "")
    })?;
    let hash = sha256_of(&path(Merged::RESULTS))
        .map_err(|error| StudyError::folder(&path(Merged::RESULTS), error))?;
    write_new_file(&path(Merged::SIDECAR), true, |out| {
        write_json(out, &sidecar(plan, &merged, &hash), &[])
    })?;
    Ok(merged)
}

/// Returns the description of the columns, with the plan and what a merge found.
fn sidecar<'a>(plan: &'a Plan, merged: &'a Merged, hash: &'a str) -> impl Serialize + 'a {
    let axis = |axis: &'a Axis| {
        object! {
            "path": &axis.path, "symbol": axis.symbol, "unit": axis.unit, "scale": axis.spacing,
            "values": &axis.values,
        }
    };
    let quantity = |quantity: &Quantity| {
        object! {
            "name": quantity.name(),
            "symbol": quantity.symbol(),
            "unit": quantity.unit(),
            "meaning": quantity.meaning(),
        }
    };
    object! {
        "format": RESULTS_VERSION,
        "program": format!("{} {}", "asperity", env!("CARGO_PKG_VERSION")),
        "plan": object! {
            "title": &plan.title, "notice": &plan.notice, "scene": &plan.scene, "text": plan.to_ron(),
        },
        "axes": plan.scene_axes().iter().map(axis).collect::<Vec<_>>(),
        "preloads": plan.preloads().map(|axis| &axis.values),
        "preload_symbol": plan.preloads().map(|axis| axis.symbol),
        "quantities": plan.record.iter().map(quantity).collect::<Vec<_>>(),
        "cells": plan.cells(),
        "lines": plan.lines,
        "first_seed": plan.seed,
        "confidence": CONFIDENCE,
        "records": merged.records,
        "total": merged.total,
        "failed": merged.failed,
        "first_failed": &merged.first_failed,
        "missing_cells": merged.missing_cells,
        "first_missing": &merged.first_missing,
        "programs": &merged.programs,
        "results_sha256": hash,
    }
}

/// Adds the columns for the cell, its values on the axes and the preload.
fn with_cell<'a, T: 'a>(
    plan: &'a Plan,
    rows: TableOf<'a, T>,
    cell: fn(&T) -> u64,
) -> TableOf<'a, T> {
    let mut table = rows.whole("cell", cell);
    for (number, axis) in plan.scene_axes().iter().enumerate() {
        let (name, value) = (axis.path.clone(), move |row: &T| {
            plan.value(cell(row), number)
        });
        table = match axis.is_whole() {
            true => table.with(name, Kind::Whole, move |row| value(row) as u64),
            false => table.with(name, Kind::Real, value),
        };
    }
    let preload = plan.preloads().map(|_| plan.axes.len() - 1);
    table.real("preload", move |row| {
        preload.map(|axis| plan.value(cell(row), axis))
    })
}

/// Returns the SHA-256 of the results of the last merge, if it is recorded.
fn recorded_hash(folder: &Path) -> Option<String> {
    let text = read_regular_text(&folder.join(Merged::SIDECAR), LONGEST_SIDECAR).ok()?;
    let all: serde_json::Value = serde_json::from_str(&text).ok()?;
    Some(all.get("results_sha256")?.as_str()?.to_owned())
}

impl Results {
    /// Returns a table with a row for each [cell](Plan) and each profile on which the cell is
    /// computed. Its columns are the values on the axes, the seed of the profile, and the recorded
    /// quantities.
    pub fn table(&self) -> Table<'_> {
        let rows = || {
            let of_cell = |cell| (0..self.plan.lines).map(move |line| (cell, line));
            let record =
                |(cell, line)| (cell, line, self.record(cell, line), self.reason(cell, line));
            (0..self.plan.cells())
                .flat_map(of_cell)
                .map(record)
                .filter(|row| row.2.is_some() || row.3.is_some())
        };
        let mut table = with_cell(&self.plan, Table::of(rows), |row| row.0);
        table = table.whole("seed", |row| self.plan.seed_of(row.1));
        for (column, quantity) in self.plan.record.iter().enumerate() {
            let (name, text) = (quantity.name(), Kind::Text(Regime::LONGEST_NAME));
            table = match quantity.is_regime() {
                true => table.with(name, text, move |row| {
                    regime_of(row.2?[column]).map(Regime::name)
                }),
                false => table.real(name, move |row| row.2.map(|values| values[column])),
            };
        }
        self.with_reasons(table, |row| row.3)
    }

    /// Completes the table with a column of the reasons of records without values, if there are
    /// any.
    fn with_reasons<'a, T: 'a>(
        &'a self,
        table: TableOf<'a, T>,
        reason: impl Fn(&T) -> Option<&'a str> + 'a,
    ) -> Table<'a> {
        let longest = self
            .failed()
            .map(|(_, _, reason)| reason.chars().count())
            .max();
        match longest {
            Some(longest) => table.with(REASON, Kind::Text(longest), reason).done(),
            None => table.done(),
        }
    }

    /// Returns the table of the cells with records: number of profiles and, for each quantity,
    /// mean, standard deviation and confidence interval.
    fn summary(&self) -> Table<'_> {
        let record = &self.plan.record;
        let nothing = |cell| GridCell {
            statistics: vec![None; record.len()],
            regimes: self.regimes(cell),
        };
        let of_cell = move |cell| {
            let reason = self.failure_of(cell);
            self.cell(cell, record)
                .or_else(|| reason.map(|_| nothing(cell)))
                .map(|all| (cell, all, reason))
        };
        let rows = move || (0..self.plan.cells()).filter_map(of_cell);
        let mut table = with_cell(&self.plan, Table::of(rows), |row| row.0);
        table = table.whole("lines", |row| row.1.regimes[0].profiles() as u64);
        for (place, quantity) in record.iter().enumerate() {
            if quantity.is_regime() {
                for (index, regime) in Regime::ALL.into_iter().enumerate() {
                    let name = format!("{}_{}", quantity.name(), regime.name().replace('-', "_"));
                    let share =
                        move |cell: &GridCell| Some(cell.regimes_of(*quantity).shares()?[index]);
                    table = table.with(name, Kind::Real, move |row| share(&row.1));
                }
                continue;
            }
            for (ending, of) in Statistics::COLUMNS {
                let name = format!("{}_{ending}", quantity.name());
                table = table.with(name, Kind::Real, move |row| {
                    row.1.statistics[place].as_ref().and_then(of)
                });
            }
        }
        self.with_reasons(table, |row| row.2)
    }

    /// Reads the results of a study from the folder of the study, in which [`merge`] has written
    /// the tables.
    ///
    /// # Errors
    /// Returns an error if the folder contains no study. It is also an error if the table
    /// [`Merged::RESULTS`] is missing, was changed or belongs to another plan.
    pub fn open(folder: &Path) -> Result<Results, StudyError> {
        let mut results = Results::empty(Folder::open(folder)?.plan().clone())?;
        let path = folder.join(Merged::RESULTS);
        let merge = asperity_scene::text::quoted(folder.display().to_string());
        let again = format!("asperity sweep merge {merge} makes it again");
        let wrong = |reason: String| StudyError::folder(&path, format!("{reason}; {again}"));
        let file = open_regular(&path).map_err(|error| match error {
            ReadError::Failed(error) if error.kind() == io::ErrorKind::NotFound => {
                let reason = format!(
                    "the study has not been merged yet; asperity sweep merge {merge} does it"
                );
                StudyError::folder(folder, reason)
            }
            error => StudyError::folder(&path, error),
        })?;
        let header = results
            .table()
            .columns()
            .iter()
            .map(|(name, _)| name.as_ref())
            .collect::<Vec<_>>()
            .join(",");
        let mut has_reasons = false;
        for (number, line) in (1..).zip(lines(BufReader::new(file))) {
            let line = line
                .map_err(StudyError::unreadable(&path))?
                .unwrap_or_default();
            let row = line.trim_end_matches('\r');
            if number == 1 {
                let rest = row.strip_prefix(&header);
                has_reasons = rest.and_then(|rest| rest.strip_prefix(',')) == Some(REASON);
                if !has_reasons && rest != Some("") {
                    return Err(wrong("its columns are not those of the plan".into()));
                }
            } else if results.add_row(row, has_reasons).is_none() {
                return Err(wrong(format!("line {number} is not a row of this study")));
            }
        }
        // Rows that are doubled, missing or changed may still be rows.
        let found = sha256_of(&path).map_err(|error| StudyError::folder(&path, error))?;
        match recorded_hash(folder) {
            Some(recorded) if recorded == found => Ok(results),
            Some(_) => Err(wrong(format!(
                "this is not the table of the last merge, by its SHA-256 in {}",
                Merged::SIDECAR
            ))),
            None => Err(wrong(format!(
                "{}, which has the SHA-256 of this table, is missing or damaged",
                Merged::SIDECAR
            ))),
        }
    }

    /// Adds a row of the table of records; `None` if it is not a row of this study.
    fn add_row(&mut self, row: &str, has_reason: bool) -> Option<()> {
        let plan = &self.plan;
        // Only the last column, a reason, may contain a comma.
        let count = 3 + plan.scene_axes().len() + plan.record.len() + usize::from(has_reason);
        let mut columns = row.splitn(count, ',');
        let cell = columns
            .next()?
            .parse()
            .ok()
            .filter(|cell| *cell < plan.cells())?;
        // The values of the axes are those of the plan.
        for axis in 0..plan.axes.len() {
            columns
                .next()?
                .parse::<f64>()
                .ok()
                .filter(|value| plan.value(cell, axis) == *value)?;
        }
        if plan.preloads().is_none() {
            columns.next().filter(|preload| preload.is_empty())?;
        }
        let line = columns.next()?.parse::<u64>().ok()?.wrapping_sub(plan.seed);
        let value = |(quantity, text): (&Quantity, &str)| match quantity {
            _ if text.is_empty() => Some(f64::NAN),
            _ if quantity.is_regime() => Regime::ALL
                .iter()
                .position(|one| one.name() == text)
                .map(|place| place as f64),
            _ => text.parse().ok(),
        };
        let values: Option<Vec<f64>> = plan.record.iter().zip(&mut columns).map(value).collect();
        let values = values.filter(|values| values.len() == plan.record.len())?;
        let reason = columns.next().unwrap_or_default();
        if columns.next().is_some()
            || line >= plan.lines
            || values.iter().any(|value| value.is_infinite())
        {
            return None;
        }
        let quoted = reason
            .strip_prefix('"')
            .and_then(|reason| reason.strip_suffix('"'));
        let reason =
            quoted.map_or_else(|| reason.to_owned(), |reason| reason.replace("\"\"", "\""));
        self.set_record(
            cell * self.plan.lines + line,
            if reason.is_empty() {
                Ok(values)
            } else {
                Err(reason)
            },
        );
        Some(())
    }
}
