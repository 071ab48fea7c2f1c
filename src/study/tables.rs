//! Columns and rows of the tables of a study.

use super::cell_summary::CellSummary;
use super::plan::Plan;
use super::quantity::Quantity;
use super::target::Target;
use crate::analysis::Regime;

/// Version of the merged files.
pub const RESULTS_VERSION: u32 = 1;
/// One row for each cell and line.
pub const RESULTS: &str = "results.csv";
/// One row for each cell.
pub const SUMMARY: &str = "summary.csv";
/// The results with types, where they are asked for.
pub const PARQUET: &str = "results.parquet";
/// Name of the file with the meanings of the columns.
pub const SIDECAR: &str = "results.json";

/// A number in the shortest form that reads back bit for bit; nothing for what there is not.
pub(super) fn number(value: Option<f64>) -> String {
    value.filter(|value| !value.is_nan()).map_or_else(String::new, |value| format!("{value:?}"))
}

/// A value of an axis: whole where it is.
fn coordinate(path: &str, value: f64) -> String {
    match Target::of(path) {
        Ok(target) if target.is_whole() => format!("{}", value as u64),
        _ => format!("{value:?}"),
    }
}

/// Cell, axes and preload.
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

/// Columns of the summary for the share of lines in each regime.
pub(super) const REGIME_COLUMNS: [&str; 3] =
    ["regime_pressure_insensitive", "regime_pressure_sensitive", "regime_non_adhesive"];

pub(super) fn regime_name(quantity: Quantity, value: f64) -> Option<&'static str> {
    let regime =
        Regime::ALL.get(value as usize).filter(|_| quantity == Quantity::Regime && !value.is_nan())?;
    Some(regime.name())
}

/// Number of lines and, for each quantity, mean, standard deviation and confidence interval.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_coordinates_are_written_so() {
        assert_eq!(coordinate("numerics.points", 1024.0), "1024");
        assert_eq!(coordinate("roughness.hurst", 1.0), "1.0");
    }
}
