//! Tables of a study. The first table has all recorded values, the second the statistics of these
//! values over the profiles. A third file describes the columns of both tables.

use super::axis::Spacing;
use super::error::StudyError;
use super::grid::GridCell;
use super::plan::Plan;
use super::quantity::{Quantity, regime_of};
use super::results::{Merged, Results};
use super::statistics::{CONFIDENCE, Statistics};
use super::store::{Folder, lines};
use asperity_data::{
    Kind, ReadError, Table, TableOf, open_regular, read_regular_text, remove_abandoned, sha256_of,
    write_json, write_new_file,
};
use asperity_scene::{Regime, Scene};
use serde::Serialize;
use std::io;
use std::io::BufReader;
use std::path::{Path, PathBuf};

/// Version of the format of the files that [`merge`] writes.
pub const RESULTS_VERSION: u32 = 1;
/// Name of the column that states why a record has no values.
const REASON: &str = "reason";
/// Largest allowed length in bytes of the file that describes the columns. A longer file is
/// refused.
const LONGEST_SIDECAR: usize = 1 << 26;

impl Merged {
    /// Name of the file with the table of all results. The table has one row for each [cell](Plan)
    /// and profile.
    pub const RESULTS: &str = "results.csv";
    /// Name of the file with the table of statistics over the profiles. The table has one row for
    /// each [cell](Plan).
    pub const SUMMARY: &str = "summary.csv";
    /// Name of the file that describes the columns of both tables, [`Merged::RESULTS`] and
    /// [`Merged::SUMMARY`].
    pub const SIDECAR: &str = "results.json";
}

/// Merges the results of all processes in the folder of a study into tables. It writes the table of
/// all results ([`Merged::RESULTS`]), the table of statistics ([`Merged::SUMMARY`]), and a
/// description of their columns ([`Merged::SIDECAR`]). If some results are missing, the tables have
/// the results that exist.
///
/// # Errors
/// Returns an error if two files have different results for the same [cell](Plan) and profile, or
/// if a file cannot be read or written.
pub fn merge(folder: &Folder) -> Result<Merged, StudyError> {
    let (results, merged) = Results::of_shards(folder)?;
    remove_abandoned(folder.path());
    let plan = results.plan();
    let table = folder.path().join(Merged::RESULTS);
    let summary = folder.path().join(Merged::SUMMARY);
    let description = folder.path().join(Merged::SIDECAR);
    write_new_file(&table, true, |out| results.table().write_csv(out, ""))?;
    write_new_file(&summary, true, |out| results.summary().write_csv(out, ""))?;
    let hash = sha256_of(&table).map_err(|error| StudyError::folder(&table, error))?;
    write_new_file(&description, true, |out| {
        write_json(out, &sidecar(plan, &merged, &hash), &[])
    })?;
    Ok(merged)
}

/// Description of the columns, with the plan and the numbers of records found by the merge. The
/// fields are in the order of the keys in the JSON file.
#[derive(Serialize)]
struct Sidecar<'a> {
    format: u32,
    program: &'static str,
    plan: PlanJson<'a>,
    axes: Vec<AxisJson<'a>>,
    preloads: Option<&'a [f64]>,
    preload_symbol: Option<&'static str>,
    quantities: Vec<QuantityJson>,
    cells: u64,
    lines: u64,
    first_seed: u64,
    confidence: f64,
    records: u64,
    total: u64,
    failed: u64,
    first_failed: &'a [(u64, u64, String)],
    missing_cells: u64,
    first_missing: &'a [u64],
    programs: &'a [String],
    results_sha256: &'a str,
}

#[derive(Serialize)]
struct PlanJson<'a> {
    title: &'a str,
    notice: &'a str,
    scene: &'a Scene,
    text: String,
}

#[derive(Serialize)]
struct AxisJson<'a> {
    path: &'a str,
    symbol: &'a str,
    unit: &'a str,
    scale: Spacing,
    values: &'a [f64],
}

#[derive(Serialize)]
struct QuantityJson {
    name: &'static str,
    symbol: &'static str,
    unit: &'static str,
    meaning: &'static str,
}

fn sidecar<'a>(plan: &'a Plan, merged: &'a Merged, hash: &'a str) -> Sidecar<'a> {
    let mut axes = Vec::new();
    for axis in plan.scene_axes() {
        axes.push(AxisJson {
            path: &axis.path,
            symbol: axis.symbol,
            unit: axis.unit,
            scale: axis.spacing,
            values: &axis.values,
        });
    }
    let mut quantities = Vec::with_capacity(plan.record.len());
    for quantity in &plan.record {
        quantities.push(QuantityJson {
            name: quantity.name(),
            symbol: quantity.symbol(),
            unit: quantity.unit(),
            meaning: quantity.meaning(),
        });
    }
    Sidecar {
        format: RESULTS_VERSION,
        program: concat!("asperity ", env!("CARGO_PKG_VERSION")),
        plan: PlanJson {
            title: &plan.title,
            notice: &plan.notice,
            scene: &plan.scene,
            text: plan.to_ron(),
        },
        axes,
        preloads: plan.preloads().map(|axis| &axis.values[..]),
        preload_symbol: plan.preloads().map(|axis| axis.symbol),
        quantities,
        cells: plan.cells(),
        lines: plan.lines,
        first_seed: plan.seed,
        confidence: CONFIDENCE,
        records: merged.records,
        total: merged.total,
        failed: merged.failed,
        first_failed: &merged.first_failed,
        missing_cells: merged.missing_cells,
        first_missing: &merged.first_missing,
        programs: &merged.programs,
        results_sha256: hash,
    }
}

/// Adds the columns with the number of the cell and its values on the axes, including the preload.
fn with_cell<'a, T: 'a>(
    plan: &'a Plan,
    rows: TableOf<'a, T>,
    cell: fn(&T) -> u64,
) -> TableOf<'a, T> {
    let mut table = rows.whole("cell", cell);
    for (number, axis) in plan.scene_axes().iter().enumerate() {
        let name = axis.path.clone();
        let value = move |row: &T| plan.value(cell(row), number);
        table = if axis.is_whole() {
            table.with(name, Kind::Whole, move |row| value(row) as u64)
        } else {
            table.with(name, Kind::Real, value)
        };
    }
    let preload = plan.preloads().map(|_| plan.axes.len() - 1);
    table.real("preload", move |row| {
        preload.map(|axis| plan.value(cell(row), axis))
    })
}

/// Returns the SHA-256 of the table of results, as the last merge has written it into the
/// description; `None` if there is no such description.
fn recorded_hash(folder: &Path) -> Option<String> {
    let text = read_regular_text(&folder.join(Merged::SIDECAR), LONGEST_SIDECAR).ok()?;
    let all: serde_json::Value = serde_json::from_str(&text).ok()?;
    Some(all.get("results_sha256")?.as_str()?.to_owned())
}

/// Row of the table of all results.
struct RecordRow<'a> {
    cell: u64,
    line: u64,
    /// Values of the recorded quantities; `None` if they cannot be computed.
    values: Option<&'a [f64]>,
    /// Reason why the record has no values; `None` if it has values.
    reason: Option<&'a str>,
}

impl RecordRow<'_> {
    fn value(&self, column: usize) -> Option<f64> {
        Some(self.values?[column])
    }
}

/// Row of the table of statistics.
struct SummaryRow<'a> {
    cell: u64,
    results: GridCell,
    /// Reason why the cell has no values on any profile; `None` if it has values.
    reason: Option<&'a str>,
}

impl Results {
    /// Returns a table with a row for each [cell](Plan) and each profile on which the cell is
    /// computed. Its columns are the values on the axes, the seed of the profile, and the recorded
    /// quantities.
    pub fn table(&self) -> Table<'_> {
        let rows = Table::of(|| (0..self.plan.cells()).flat_map(|cell| self.rows_of(cell)));
        let mut table = with_cell(&self.plan, rows, |row: &RecordRow<'_>| row.cell);
        table = table.whole("seed", |row| self.plan.seed_of(row.line));
        for (column, quantity) in self.plan.record.iter().enumerate() {
            let name = quantity.name();
            table = if quantity.is_regime() {
                table.with(name, Kind::Text(Regime::LONGEST_NAME), move |row| {
                    regime_of(row.value(column)?).map(Regime::name)
                })
            } else {
                table.real(name, move |row| row.value(column))
            };
        }
        self.with_reasons(table, |row| row.reason)
    }

    /// Returns the rows of a cell, one for each profile on which the cell is computed.
    fn rows_of(&self, cell: u64) -> impl Iterator<Item = RecordRow<'_>> {
        let rows = (0..self.plan.lines).map(move |line| RecordRow {
            cell,
            line,
            values: self.record(cell, line),
            reason: self.reason(cell, line),
        });
        rows.filter(|row| row.values.is_some() || row.reason.is_some())
    }

    /// Returns the row of statistics of a cell; `None` if the cell is not computed.
    fn summary_row(&self, cell: u64) -> Option<SummaryRow<'_>> {
        let record = &self.plan.record;
        let reason = self.failure_of(cell);
        let mut results = self.cell(cell, record);
        if results.is_none() && reason.is_some() {
            results = Some(GridCell {
                statistics: vec![None; record.len()],
                regimes: self.regimes(cell),
            });
        }
        Some(SummaryRow {
            cell,
            results: results?,
            reason,
        })
    }

    /// Completes a table: if some records have no values, adds a last column with the reasons.
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

    /// Returns a table with a row for each cell that has records. Its columns are the number of
    /// profiles and, for each quantity, mean, standard deviation and confidence interval.
    fn summary(&self) -> Table<'_> {
        let record = &self.plan.record;
        let rows = Table::of(|| (0..self.plan.cells()).filter_map(|cell| self.summary_row(cell)));
        let mut table = with_cell(&self.plan, rows, |row: &SummaryRow<'_>| row.cell);
        table = table.whole("profiles", |row| row.results.regimes[0].profiles() as u64);
        for (place, quantity) in record.iter().enumerate() {
            if quantity.is_regime() {
                for (index, regime) in Regime::ALL.into_iter().enumerate() {
                    let name = format!("{}_{}", quantity.name(), regime.name().replace('-', "_"));
                    table = table.with(name, Kind::Real, move |row| {
                        let counts = row.results.regimes_of(*quantity);
                        Some(counts.shares()?[index])
                    });
                }
                continue;
            }
            for (ending, value) in Statistics::COLUMNS {
                let name = format!("{}_{ending}", quantity.name());
                table = table.with(name, Kind::Real, move |row| {
                    row.results.statistics[place].as_ref().and_then(value)
                });
            }
        }
        self.with_reasons(table, |row| row.reason)
    }

    /// Reads the results of a study from the folder of the study, in which [`merge`] has written
    /// the tables.
    ///
    /// # Errors
    /// Returns an error if the folder contains no study. It is also an error if the table
    /// [`Merged::RESULTS`] is missing, was changed or belongs to another plan.
    pub fn open(folder: &Path) -> Result<Results, StudyError> {
        let mut results = Results::empty(Folder::open(folder)?.plan().clone())?;
        let merged = MergedTable::of(folder);
        let path = &merged.path;
        let file = open_regular(path).map_err(|error| merged.not_opened(folder, error))?;
        let header = results.header();
        let mut has_reasons = false;
        for (number, line) in (1..).zip(lines(BufReader::new(file))) {
            let line = line.map_err(StudyError::unreadable(path))?;
            let line = line.unwrap_or_default();
            let row = line.trim_end_matches('\r');
            if number == 1 {
                let further = row.strip_prefix(&header);
                let last = further.and_then(|further| further.strip_prefix(','));
                has_reasons = last == Some(REASON);
                if !has_reasons && further != Some("") {
                    return Err(merged.wrong("its columns are not those of the plan"));
                }
            } else if results.add_row(row, has_reasons).is_none() {
                return Err(merged.wrong(&format!("line {number} is not a row of this study")));
            }
        }
        // The hash of the table is compared, because a table can still be read after rows were
        // repeated, deleted or changed.
        let found = sha256_of(path).map_err(|error| StudyError::folder(path, error))?;
        match recorded_hash(folder) {
            Some(recorded) if recorded == found => Ok(results),
            Some(_) => Err(merged.wrong(&format!(
                "this is not the table of the last merge, by its SHA-256 in {}",
                Merged::SIDECAR
            ))),
            None => Err(merged.wrong(&format!(
                "{}, which has the SHA-256 of this table, is missing or damaged",
                Merged::SIDECAR
            ))),
        }
    }

    /// Returns the first line of the table of all results. The column of reasons, which the table
    /// may lack, is not included.
    fn header(&self) -> String {
        let table = self.table();
        let names: Vec<&str> = table
            .columns()
            .iter()
            .map(|(name, _)| name.as_ref())
            .collect();
        names.join(",")
    }

    /// Adds the results in a row of the table of all results. Returns `None` if the text is not a
    /// row of this study.
    fn add_row(&mut self, row: &str, has_reason: bool) -> Option<()> {
        let plan = &self.plan;
        // Only the reason may contain a comma, so it is the last column.
        let count = 3 + plan.scene_axes().len() + plan.record.len() + usize::from(has_reason);
        let mut columns = row.splitn(count, ',');
        let cell: u64 = columns.next()?.parse().ok()?;
        if cell >= plan.cells() {
            return None;
        }
        // The values on the axes must equal those of the plan.
        for axis in 0..plan.axes.len() {
            let value: f64 = columns.next()?.parse().ok()?;
            if plan.value(cell, axis) != value {
                return None;
            }
        }
        if plan.preloads().is_none() && !columns.next()?.is_empty() {
            return None;
        }
        let line = columns.next()?.parse::<u64>().ok()?.wrapping_sub(plan.seed);
        let mut values = Vec::with_capacity(plan.record.len());
        for quantity in &plan.record {
            values.push(read_value(*quantity, columns.next()?)?);
        }
        let reason = unquoted(columns.next().unwrap_or_default());
        if columns.next().is_some()
            || line >= plan.lines
            || values.iter().any(|value| value.is_infinite())
        {
            return None;
        }
        let record = if reason.is_empty() {
            Ok(values)
        } else {
            Err(reason)
        };
        self.set_record(cell * self.plan.lines + line, record);
        Some(())
    }
}

/// Reads the value of a quantity in a cell of the table; NaN if the cell is empty. Returns `None`
/// for another text.
fn read_value(quantity: Quantity, text: &str) -> Option<f64> {
    if text.is_empty() {
        return Some(f64::NAN);
    }
    if !quantity.is_regime() {
        return text.parse().ok();
    }
    let index = Regime::ALL
        .iter()
        .position(|regime| regime.name() == text)?;
    Some(index as f64)
}

/// Returns the text of a cell of the table without the quotes around it.
fn unquoted(text: &str) -> String {
    let inner = text
        .strip_prefix('"')
        .and_then(|inner| inner.strip_suffix('"'));
    match inner {
        Some(inner) => inner.replace("\"\"", "\""),
        None => text.to_owned(),
    }
}

/// File with the table of all results of a study, and the error messages about this file.
struct MergedTable {
    path: PathBuf,
    /// Path of the folder of the study, quoted for a shell.
    study: String,
}

impl MergedTable {
    fn of(folder: &Path) -> MergedTable {
        MergedTable {
            path: folder.join(Merged::RESULTS),
            study: asperity_scene::text::quoted(folder.display().to_string()),
        }
    }

    fn wrong(&self, reason: &str) -> StudyError {
        let again = format!("asperity sweep merge {} makes it again", self.study);
        StudyError::folder(&self.path, format!("{reason}; {again}"))
    }

    fn not_opened(&self, folder: &Path, error: ReadError) -> StudyError {
        match error {
            ReadError::Failed(error) if error.kind() == io::ErrorKind::NotFound => {
                let merge = format!("asperity sweep merge {}", self.study);
                let reason = format!("the study has not been merged yet; {merge} does it");
                StudyError::folder(folder, reason)
            }
            error => StudyError::folder(&self.path, error),
        }
    }
}
