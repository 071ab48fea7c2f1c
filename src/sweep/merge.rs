//! All records of a study as tables: each once, sorted, and what the lines of a cell have in common.

use super::SweepError;
use super::measure::REGIMES;
use super::plan::{MOST_RECORDS, Plan};
use super::quantity::Quantity;
use super::record::{Key, key_of, values_of};
use super::store::{Folder, Lines, ShardFile};
use super::target::symbol_and_unit;
use crate::ensemble::{Statistics, StudentT};
use crate::export::{WriteError, write_json_value, write_new};
use serde::Serialize;
use std::collections::BTreeSet;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Version of the merged files.
pub const RESULTS_VERSION: u32 = 1;
/// One row for each cell and line.
pub const RESULTS: &str = "results.csv";
/// One row for each cell.
pub const SUMMARY: &str = "summary.csv";
/// The results with types, where they are asked for.
pub const PARQUET: &str = "results.parquet";
/// What the columns mean.
pub const SIDECAR: &str = "results.json";

/// Missing cells that are named.
const MOST_NAMED: usize = 8;
/// Bits of a place that tell the file; the others tell where in it.
const FILE_BITS: u32 = 24;
const NOWHERE: u64 = u64::MAX;

/// What a merge has found.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Merged {
    /// Records there are, each counted once.
    pub records: u64,
    /// Records there are to be.
    pub total: u64,
    /// Records that were there more than once, bit for bit the same.
    pub duplicates: u64,
    /// Lines of shard files that were torn or damaged, and left out.
    pub damaged: u64,
    /// Cells of which lines are missing.
    pub missing_cells: u64,
    /// The first of them.
    pub first_missing: Vec<u64>,
    /// Files that hold records.
    pub files: usize,
    /// Versions of the program that wrote them.
    pub programs: Vec<String>,
}

/// Where every record stands.
struct Index {
    files: Vec<ShardFile>,
    places: Vec<u64>,
    merged: Merged,
}

/// Merges the shard files of a study and publishes its tables, whole or not at all. With `partial`, those of
/// what there is. [`PARQUET`] of an earlier merge goes.
///
/// # Errors
/// [`SweepError::Missing`] where records are missing and `partial` is not set; [`SweepError::Disagree`] where
/// two records of one cell and line differ.
pub fn merge(folder: &Folder, partial: bool) -> Result<Merged, SweepError> {
    let index = Index::of(folder)?;
    if index.merged.records < index.merged.total && !partial {
        let plan = folder.plan();
        let cells = index.merged.first_missing.iter();
        let named = cells.map(|&cell| format!("cell {cell} ({})", plan.coordinates(cell))).collect();
        return Err(SweepError::Missing {
            records: index.merged.total - index.merged.records,
            total: index.merged.total,
            cells: index.merged.missing_cells,
            named,
        });
    }
    index.publish(folder)?;
    Ok(index.merged)
}

impl Index {
    fn of(folder: &Folder) -> Result<Index, SweepError> {
        let plan = folder.plan();
        let total = plan.records_in_all();
        debug_assert!(total <= MOST_RECORDS);
        let mut places = Vec::new();
        places.try_reserve_exact(total as usize).map_err(|_| SweepError::OutOfMemory { records: total })?;
        places.resize(total as usize, NOWHERE);
        let files = folder.files()?;
        let (mut records, mut duplicates, mut damaged, mut holding) = (0, 0, 0, 0);
        let mut programs = BTreeSet::new();
        for (number, file) in files.iter().enumerate() {
            let mut here = 0;
            damaged += folder.records(file, &mut |found| {
                here += 1;
                let Some(place) = folder.place(found.key).map(|place| &mut places[place as usize]) else {
                    return Ok(());
                };
                let new = (number as u64) << (64 - FILE_BITS) | found.offset;
                if *place == NOWHERE {
                    *place = new;
                    records += 1;
                    return Ok(());
                }
                duplicates += 1;
                let other = &files[(*place >> (64 - FILE_BITS)) as usize];
                let there = Lines::open(&other.path)
                    .and_then(|mut lines| {
                        let payload = lines.at(offset_of(*place))?;
                        Ok(key_of(payload).and_then(|(_, values)| values_of(values, plan.record.len())))
                    })
                    .map_err(|error| unreadable(&other.path, &error))?;
                if same(there.as_deref(), found.values().as_deref()) {
                    return Ok(());
                }
                Err(SweepError::Disagree {
                    key: found.key,
                    coordinates: plan.coordinates(found.key.cell),
                    one: other.path.clone(),
                    other: file.path.clone(),
                })
            })?;
            if here > 0 {
                holding += 1;
                programs.extend(file.header.as_ref().map(|header| header.program.clone()));
            }
        }
        let lines = plan.lines as usize;
        let (mut missing_cells, mut first_missing) = (0, Vec::new());
        for (cell, places) in places.chunks(lines).enumerate() {
            if places.contains(&NOWHERE) {
                missing_cells += 1;
                if first_missing.len() < MOST_NAMED {
                    first_missing.push(cell as u64);
                }
            }
        }
        let merged = Merged {
            records,
            total,
            duplicates,
            damaged,
            missing_cells,
            first_missing,
            files: holding,
            programs: programs.into_iter().collect(),
        };
        Ok(Index { files, places, merged })
    }

    fn publish(&self, folder: &Folder) -> Result<(), SweepError> {
        // Only the files whose records are asked for are opened.
        let mut readers: Vec<Option<Lines>> = self.files.iter().map(|_| None).collect();
        let plan = folder.plan();
        let mut values_at = |place: u64| -> io::Result<Vec<f64>> {
            let number = (place >> (64 - FILE_BITS)) as usize;
            let (reader, file) = (&mut readers[number], &self.files[number]);
            let reader = match reader {
                Some(reader) => reader,
                None => reader.insert(Lines::open(&file.path)?),
            };
            let payload = reader.at(offset_of(place))?;
            let values = key_of(payload).and_then(|(_, values)| values_of(values, plan.record.len()));
            values.ok_or_else(|| io::Error::new(io::ErrorKind::InvalidData, "a record has changed"))
        };
        // Rows of the summary are gathered while those of the results are written: each record is read once.
        let path = folder.path();
        let summary = path.join(SUMMARY);
        // One of an earlier merge would stand beside tables that it does not belong to.
        let earlier = path.join(PARQUET);
        match fs::remove_file(&earlier) {
            Err(reason) if reason.kind() != io::ErrorKind::NotFound => {
                return Err(WriteError::Failed { path: earlier, reason }.into());
            }
            _ => {}
        }
        let mut write_both = |results: &mut dyn Write, summary: &mut dyn Write| -> io::Result<()> {
            writeln!(results, "{}", header(plan, true))?;
            writeln!(summary, "{}", header(plan, false))?;
            let mut quantiles = StudentT::default();
            for (cell, places) in (0..).zip(self.places.chunks(plan.lines as usize)) {
                let coordinates = row_start(plan, cell);
                let mut lines = Vec::with_capacity(places.len());
                for (line, &place) in (0..).zip(places) {
                    if place == NOWHERE {
                        continue;
                    }
                    let values = values_at(place)?;
                    write!(results, "{coordinates},{}", plan.seed_of(line))?;
                    for (quantity, value) in plan.record.iter().zip(&values) {
                        match regime_name(*quantity, *value) {
                            Some(name) => write!(results, ",{name}")?,
                            None => write!(results, ",{}", number(Some(*value)))?,
                        }
                    }
                    writeln!(results)?;
                    lines.push(values);
                }
                if !lines.is_empty() {
                    writeln!(summary, "{coordinates},{}", summary_row(plan, &lines, &mut quantiles))?;
                }
            }
            Ok(())
        };
        let mut failure = None;
        write_new(&path.join(RESULTS), true, |results| {
            let written = write_new(&summary, true, |summary| write_both(results, summary));
            written.map_err(|error| match error {
                WriteError::Failed { reason, .. } => reason,
                other => {
                    let text = other.to_string();
                    failure = Some(other);
                    io::Error::other(text)
                }
            })
        })
        .map_err(|error| failure.take().unwrap_or(error))?;
        write_new(&path.join(SIDECAR), true, |out| write_json_value(out, &Sidecar::of(plan, &self.merged)))?;
        Ok(())
    }
}

fn offset_of(place: u64) -> u64 {
    place & (u64::MAX >> FILE_BITS)
}

fn unreadable(path: &Path, error: &io::Error) -> SweepError {
    SweepError::Folder { path: PathBuf::from(path), reason: format!("cannot be read: {error}") }
}

fn same(one: Option<&[f64]>, other: Option<&[f64]>) -> bool {
    let (Some(one), Some(other)) = (one, other) else { return false };
    one.iter().zip(other).all(|(a, b)| a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan()))
}

/// A number in the shortest form that reads back bit for bit; nothing for what there is not.
fn number(value: Option<f64>) -> String {
    value.filter(|value| !value.is_nan()).map_or_else(String::new, |value| format!("{value:?}"))
}

/// A value of an axis: whole where it is.
fn coordinate(path: &str, value: f64) -> String {
    match super::target::Target::of(path) {
        Ok(target) if target.is_whole() => format!("{}", value as u64),
        _ => format!("{value:?}"),
    }
}

/// Cell, axes and preload.
fn row_start(plan: &Plan, cell: u64) -> String {
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

fn header(plan: &Plan, single: bool) -> String {
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

fn regime_name(quantity: Quantity, value: f64) -> Option<&'static str> {
    let regime = REGIMES.get(value as usize).filter(|_| quantity == Quantity::Regime && !value.is_nan())?;
    Some(regime.name())
}

/// Number of lines and, for each quantity, mean, standard deviation and confidence interval.
fn summary_row(plan: &Plan, lines: &[Vec<f64>], quantiles: &mut StudentT) -> String {
    let mut row = lines.len().to_string();
    let mut add = |value: Option<f64>| {
        row.push(',');
        row.push_str(&number(value));
    };
    for (column, quantity) in plan.record.iter().enumerate() {
        let values = lines.iter().map(|line| line[column]).filter(|value| !value.is_nan());
        let values: Vec<f64> = values.collect();
        if *quantity == Quantity::Regime {
            for regime in 0..REGIMES.len() {
                let here = values.iter().filter(|value| **value as usize == regime).count();
                add((!values.is_empty()).then(|| here as f64 / values.len() as f64));
            }
            continue;
        }
        let statistics = Statistics::with(&values, quantiles);
        add(statistics.map(|all| all.mean).or(values.first().copied()));
        add(statistics.map(|all| all.standard_deviation));
        add(statistics.map(|all| all.confidence_interval.0));
        add(statistics.map(|all| all.confidence_interval.1));
    }
    row
}

/// The sidecar; its keys stand in the order of these fields.
#[derive(Serialize)]
struct Sidecar<'a> {
    format: u32,
    program: String,
    plan: PlanReport<'a>,
    axes: Vec<AxisReport<'a>>,
    preloads: Option<Vec<f64>>,
    quantities: Vec<QuantityReport>,
    cells: u64,
    lines: u64,
    first_seed: u64,
    confidence: f64,
    #[serde(flatten)]
    merged: &'a Merged,
}

#[derive(Serialize)]
struct PlanReport<'a> {
    title: &'a str,
    notice: &'a str,
    scene: &'a crate::scene::Scene,
    text: String,
}

#[derive(Serialize)]
struct AxisReport<'a> {
    path: &'a str,
    symbol: &'static str,
    unit: &'static str,
    scale: &'static str,
    values: Vec<f64>,
}

#[derive(Serialize)]
struct QuantityReport {
    name: &'static str,
    symbol: &'static str,
    unit: &'static str,
    meaning: &'static str,
}

impl<'a> Sidecar<'a> {
    fn of(plan: &'a Plan, merged: &'a Merged) -> Sidecar<'a> {
        let axis = |axis: &'a super::Axis| {
            let (symbol, unit) = symbol_and_unit(axis.path());
            let scale = match axis {
                super::Axis::Linear { .. } => "linear",
                super::Axis::Logarithmic { .. } => "logarithmic",
                super::Axis::List { .. } => "list",
            };
            AxisReport { path: axis.path(), symbol, unit, scale, values: axis.values() }
        };
        let quantity = |quantity: &Quantity| QuantityReport {
            name: quantity.name(),
            symbol: quantity.symbol(),
            unit: quantity.unit(),
            meaning: quantity.meaning(),
        };
        Sidecar {
            format: RESULTS_VERSION,
            program: format!("{} {}", env!("CARGO_PKG_NAME"), env!("CARGO_PKG_VERSION")),
            plan: PlanReport {
                title: &plan.title,
                notice: &plan.notice,
                scene: &plan.scene,
                text: plan.to_ron(),
            },
            axes: plan.axes.iter().map(axis).collect(),
            preloads: plan.preloads.as_ref().map(super::Axis::values),
            quantities: plan.record.iter().map(quantity).collect(),
            cells: plan.cells(),
            lines: plan.lines,
            first_seed: plan.seed,
            confidence: crate::ensemble::CONFIDENCE,
            merged,
        }
    }
}

/// The key of a record, for messages.
impl std::fmt::Display for Key {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "cell {}, seed {}", self.cell, self.seed)
    }
}
