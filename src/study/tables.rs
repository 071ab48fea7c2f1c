//! Tables of a merged study: the records, their statistics over the profiles, and the meanings of the columns.

use super::StudyError;
use super::axis::Axis;
use super::plan::Plan;
use super::quantity::{Quantity, regime_of};
use super::results::{Merged, Results};
use super::statistics::{CONFIDENCE, Statistics, StudentT};
use super::store::{Folder, LONGEST_LINE};
use crate::analysis::Regime;
use crate::io::{ReadError, object, open_regular, write_json_value, write_new_file};
use serde::Serialize;
use std::fmt::Write as _;
use std::io::{self, BufRead, BufReader, Read, Write};
use std::path::Path;

/// Version of the merged files.
pub const RESULTS_VERSION: u32 = 1;
/// One row for each cell and profile.
pub const RESULTS: &str = "results.csv";
/// One row for each cell.
pub const SUMMARY: &str = "summary.csv";
/// The results with types, if requested.
pub const PARQUET: &str = "results.parquet";
/// Name of the file with the meanings of the columns.
pub const SIDECAR: &str = "results.json";

/// Columns of the summary for the share of profiles in each regime.
const REGIME_COLUMNS: [&str; 3] =
    ["regime_pressure_insensitive", "regime_pressure_sensitive", "regime_non_adhesive"];

/// Merges the shard files of a study and writes its tables, each whole. With `partial`, tables of the existing records.
/// Removes [`PARQUET`] of an earlier merge.
///
/// # Errors
/// Missing records if `partial` is not set, or two records of one cell and profile that differ.
pub fn merge(folder: &Folder, partial: bool) -> Result<Merged, StudyError> {
    let (results, merged) = Results::of_shards(folder)?;
    let plan = results.plan();
    if merged.records < merged.total && !partial {
        let named = |&cell: &u64| format!("cell {cell} ({})", plan.coordinates(cell));
        let named: Vec<String> = merged.first_missing.iter().map(named).collect();
        let more = if merged.missing_cells > named.len() as u64 { ", …" } else { "" };
        return Err(StudyError::Records(format!(
            "{} of {} records are missing, in {} cells: {}{more}; run the study to its end, or merge with --partial",
            merged.total - merged.records,
            merged.total,
            merged.missing_cells,
            named.join(", ")
        )));
    }
    let path = |name| folder.path().join(name);
    let parquet = path(PARQUET);
    if parquet.exists() {
        std::fs::remove_file(&parquet).map_err(StudyError::unwritable(&parquet))?;
    }
    write_new_file(&path(RESULTS), true, |out| write_results(&results, out))?;
    write_new_file(&path(SUMMARY), true, |out| write_summary(&results, out))?;
    write_new_file(&path(SIDECAR), true, |out| write_json_value(out, &sidecar(plan, &merged)))?;
    Ok(merged)
}

/// A number in the shortest form that is read back bit for bit; empty for NaN and `None`.
fn number(value: impl Into<Option<f64>>) -> String {
    value.into().filter(|value| !value.is_nan()).map_or_else(String::new, |value| format!("{value:?}"))
}

/// Start of a row: cell, axes and preload.
fn row_start(plan: &Plan, cell: u64) -> String {
    let mut row = cell.to_string();
    for (axis, value) in plan.axes.iter().zip(plan.values(cell)) {
        let value = if axis.is_whole() { format!("{}", value as u64) } else { format!("{value:?}") };
        row.extend([",", &value]);
    }
    if plan.preloads().is_none() {
        row.push(',');
    }
    row
}

/// Names of the columns before the quantities; `profiles` is the last of them.
fn leading_columns(plan: &Plan, profiles: &str) -> Vec<String> {
    let axes = plan.scene_axes().iter().map(|axis| axis.path.as_str());
    ["cell"].into_iter().chain(axes).chain(["preload", profiles]).map(String::from).collect()
}

/// Names of the columns of the results.
pub(super) fn columns(plan: &Plan) -> Vec<String> {
    let quantities = plan.record.iter().map(|quantity| quantity.name().to_owned());
    leading_columns(plan, "seed").into_iter().chain(quantities).collect()
}

fn write_results(results: &Results, out: &mut dyn Write) -> io::Result<()> {
    let plan = results.plan();
    writeln!(out, "{}", columns(plan).join(","))?;
    for cell in 0..plan.cells() {
        let start = row_start(plan, cell);
        for (line, values) in results.records_of(cell) {
            write!(out, "{start},{}", plan.seed_of(line))?;
            for (quantity, value) in plan.record.iter().zip(values) {
                match regime_of(*quantity, *value) {
                    Some(regime) => write!(out, ",{}", regime.name())?,
                    None => write!(out, ",{}", number(*value))?,
                }
            }
            writeln!(out)?;
        }
    }
    Ok(())
}

/// Writes the number of profiles of each cell and, for each quantity, mean, standard deviation and confidence interval.
fn write_summary(results: &Results, out: &mut dyn Write) -> io::Result<()> {
    let plan = results.plan();
    let mut header = leading_columns(plan, "lines");
    for quantity in &plan.record {
        let of = |of| format!("{}_{of}", quantity.name());
        match quantity {
            Quantity::Regime => header.extend(REGIME_COLUMNS.map(String::from)),
            _ => header.extend(["mean", "sd", "low", "high"].map(of)),
        }
    }
    writeln!(out, "{}", header.join(","))?;
    let mut quantiles = StudentT::default();
    for cell in 0..plan.cells() {
        let lines = results.records_of(cell).count();
        if lines == 0 {
            continue;
        }
        let mut row = format!("{},{lines}", row_start(plan, cell));
        for (column, quantity) in plan.record.iter().enumerate() {
            if *quantity == Quantity::Regime {
                let shares = results.regimes(cell).map_or([None; 3], |shares| shares.map(Some));
                shares.into_iter().for_each(|share| row.extend([",", &number(share)]));
                continue;
            }
            let values = results.values_of(cell, column);
            let all = Statistics::with(&values, quantity.bounds(), &mut quantiles);
            let mean = all.map(|all| all.mean).or(values.first().copied());
            let interval = all.map(|all| all.confidence_interval);
            let (low, high) = (interval.map(|ends| ends.0), interval.map(|ends| ends.1));
            for value in [mean, all.map(|all| all.standard_deviation), low, high] {
                let _ = write!(row, ",{}", number(value));
            }
        }
        writeln!(out, "{row}")?;
    }
    Ok(())
}

/// The meanings of the columns, with the plan and the contents found by a merge.
fn sidecar<'a>(plan: &'a Plan, merged: &'a Merged) -> impl Serialize + 'a {
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
        "program": format!("{} {}", env!("CARGO_PKG_NAME"), env!("CARGO_PKG_VERSION")),
        "plan": object! {
            "title": &plan.title, "notice": &plan.notice, "scene": &plan.scene, "text": plan.to_ron(),
        },
        "axes": plan.scene_axes().iter().map(axis).collect::<Vec<_>>(),
        "preloads": plan.preloads().map(|axis| &axis.values),
        "quantities": plan.record.iter().map(quantity).collect::<Vec<_>>(),
        "cells": plan.cells(),
        "lines": plan.lines,
        "first_seed": plan.seed,
        "confidence": CONFIDENCE,
        "records": merged.records,
        "total": merged.total,
        "duplicates": merged.duplicates,
        "damaged": merged.damaged,
        "missing_cells": merged.missing_cells,
        "first_missing": &merged.first_missing,
        "files": merged.files,
        "programs": &merged.programs,
    }
}

impl Results {
    /// Reads the results of a merged study.
    ///
    /// # Errors
    /// The folder of no study, or a table that is missing, was changed or belongs to another plan.
    pub fn open(folder: &Path) -> Result<Results, StudyError> {
        let mut results = Results::empty(Folder::open(folder)?.plan().clone())?;
        let path = folder.join(RESULTS);
        let wrong = |reason: String| StudyError::folder(&path, reason);
        let file = open_regular(&path).map_err(|error| match error {
            ReadError::Failed(error) if error.kind() == io::ErrorKind::NotFound => {
                let merge = crate::scene::quoted(folder.display().to_string());
                let reason =
                    format!("the study has not been merged yet; asperity sweep merge {merge} does it");
                StudyError::folder(folder, reason)
            }
            error => wrong(error.to_string()),
        })?;
        let mut reader = BufReader::new(file);
        let (mut line, mut start) = (Vec::new(), (u64::MAX, String::new()));
        for number in 1.. {
            line.clear();
            let read = reader.by_ref().take(LONGEST_LINE).read_until(b'\n', &mut line);
            if read.map_err(StudyError::unreadable(&path))? == 0 {
                break;
            }
            // A line that is too long, torn or not text is not a row.
            let text = line.strip_suffix(b"\n").and_then(|line| std::str::from_utf8(line).ok());
            let text = text.unwrap_or_default().trim_end_matches('\r');
            if number == 1 {
                if text != columns(&results.plan).join(",") {
                    return Err(wrong("its columns are not those of the plan".into()));
                }
            } else if results.add_row(text, &mut start).is_none() {
                return Err(wrong(format!("line {number} is not a row of this study")));
            }
        }
        Ok(results)
    }

    /// Adds a row of the results; `start` is the cell of the row before and the start of its rows.
    fn add_row(&mut self, row: &str, start: &mut (u64, String)) -> Option<()> {
        let cell = row.split(',').next()?.parse().ok().filter(|cell| *cell < self.plan.cells())?;
        if start.0 != cell {
            *start = (cell, row_start(&self.plan, cell) + ",");
        }
        // The values of the axes are those of the plan.
        let mut columns = row.strip_prefix(start.1.as_str())?.split(',');
        let line = columns.next()?.parse::<u64>().ok()?.wrapping_sub(self.plan.seed);
        let value = |(quantity, text): (&Quantity, &str)| match quantity {
            _ if text.is_empty() => Some(f64::NAN),
            Quantity::Regime => {
                Regime::ALL.iter().position(|one| one.name() == text).map(|place| place as f64)
            }
            _ => text.parse().ok(),
        };
        let values: Option<Vec<f64>> = self.plan.record.iter().zip(&mut columns).map(value).collect();
        let values = values.filter(|values| values.len() == self.plan.record.len())?;
        if columns.next().is_some() || line >= self.plan.lines {
            return None;
        }
        self.set(cell * self.plan.lines + line, &values);
        Some(())
    }
}
