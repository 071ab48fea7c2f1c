//! Tables of a study: columns, rows, and the sidecar with the meanings of the columns.

use super::axis::Axis;
use super::cell_summary::CellSummary;
use super::plan::Plan;
use super::quantity::Quantity;
use super::statistics::CONFIDENCE;
use super::target::{Target, symbol_and_unit};
use crate::analysis::Regime;
use crate::io::object;
use serde::Serialize;

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

/// A number in the shortest form that is read back bit for bit; empty for `None`.
pub(super) fn number(value: Option<f64>) -> String {
    value.filter(|value| !value.is_nan()).map_or_else(String::new, |value| format!("{value:?}"))
}

/// A value of an axis, as an integer if it is one.
fn coordinate(path: &str, value: f64) -> String {
    match Target::of(path) {
        Ok(target) if target.is_whole() => format!("{}", value as u64),
        _ => format!("{value:?}"),
    }
}

/// Start of a row: cell, axes and preload.
pub(super) fn row_start(plan: &Plan, cell: u64) -> String {
    let mut row = cell.to_string();
    let values = plan.values(cell);
    for (axis, value) in plan.axes.iter().zip(&values) {
        row.push(',');
        row.push_str(&coordinate(axis.path(), *value));
    }
    row.push(',');
    if plan.preloads.is_some() {
        row.push_str(&number(values.last().copied()));
    }
    row
}

pub(super) fn header(plan: &Plan, single: bool) -> String {
    let mut columns = vec!["cell".to_string()];
    columns.extend(plan.axes.iter().map(|axis| axis.path().to_string()));
    columns.push("preload".into());
    columns.push(if single { "seed" } else { "lines" }.into());
    for quantity in &plan.record {
        let name = quantity.name();
        match (single, quantity) {
            (true, _) => columns.push(name.into()),
            (false, Quantity::Regime) => columns.extend(REGIME_COLUMNS.map(String::from)),
            (false, _) => {
                columns.extend(["mean", "sd", "low", "high"].map(|of| format!("{name}_{of}")));
            }
        }
    }
    columns.join(",")
}

/// Columns of the summary for the share of profiles in each regime.
pub(super) const REGIME_COLUMNS: [&str; 3] =
    ["regime_pressure_insensitive", "regime_pressure_sensitive", "regime_non_adhesive"];

pub(super) fn regime_name(quantity: Quantity, value: f64) -> Option<&'static str> {
    let regime =
        Regime::ALL.get(value as usize).filter(|_| quantity == Quantity::Regime && !value.is_nan())?;
    Some(regime.name())
}

/// Number of profiles and, for each quantity, mean, standard deviation and confidence interval.
pub(super) fn summary_row(plan: &Plan, summary: &CellSummary) -> String {
    let mut row = summary.lines.to_string();
    let mut add = |value: Option<f64>| {
        row.push(',');
        row.push_str(&number(value));
    };
    for (quantity, spread) in plan.record.iter().zip(&summary.quantities) {
        if *quantity == Quantity::Regime {
            (0..Regime::ALL.len()).for_each(|place| add(summary.regimes.map(|shares| shares[place])));
            continue;
        }
        let interval = spread.and_then(|spread| spread.confidence_interval);
        add(spread.map(|spread| spread.mean));
        add(spread.and_then(|spread| spread.standard_deviation));
        add(interval.map(|(low, _)| low));
        add(interval.map(|(_, high)| high));
    }
    row
}

/// Contents found by a merge.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Merged {
    /// Existing records, each counted once.
    pub records: u64,
    /// All records of the study.
    pub total: u64,
    /// Records that occurred more than once, bit for bit the same.
    pub duplicates: u64,
    /// Torn or damaged lines of shard files, left out.
    pub damaged: u64,
    /// Number of cells with missing profiles.
    pub missing_cells: u64,
    /// The first of these cells.
    pub first_missing: Vec<u64>,
    /// Number of files with records.
    pub files: usize,
    /// Versions of the program that wrote the records.
    pub programs: Vec<String>,
}

/// The sidecar of a plan with the contents found by a merge and the SHA-256 of the summary.
pub(super) fn sidecar<'a>(
    plan: &'a Plan,
    merged: &'a Merged,
    summary_sha256: &'a str,
) -> impl Serialize + 'a {
    let axis = |axis: &'a Axis| {
        let (symbol, unit) = symbol_and_unit(axis.path());
        let scale = match axis {
            Axis::Linear { .. } => "linear",
            Axis::Logarithmic { .. } => "logarithmic",
            Axis::List { .. } => "list",
        };
        object! {
            "path": axis.path(), "symbol": symbol, "unit": unit, "scale": scale, "values": axis.values(),
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
        "axes": plan.axes.iter().map(axis).collect::<Vec<_>>(),
        "preloads": plan.preloads.as_ref().map(Axis::values),
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
        "summary_sha256": summary_sha256,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_coordinates_are_written_so() {
        assert_eq!(coordinate("numerics.points", 1024.0), "1024");
        assert_eq!(coordinate("roughness.hurst", 1.0), "1.0");
    }
}
