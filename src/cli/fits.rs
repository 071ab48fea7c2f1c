//! `asperity fit` for several curves: fits all curves in files and folders on several threads, and
//! writes a table. If the table already exists, only its missing rows are computed.

use super::advice::option;
use super::curve_tables::CurveTables;
use super::error::CliError;
use super::output::{Origin, OutputArguments, command_without};
use super::progress::{ProgressLine, SignalWatch, Task, watched};
use super::scene::{Overrides, threads, warn_beside};
use asperity_data::{
    Control, Remedied, check_writable, counted, grouped, on_threads, path_name, printable,
    read_regular_text, write_new,
};
use asperity_experiment::{CurveOptions, CurveSource, Fit, Free, Parameter, PlacedCurve};
use asperity_report::{CurveRow, FitReport, FitsReport, Format, Report, scene_provenance, write};
use asperity_scene::Document;
use asperity_scene::library::open_argument;
use std::collections::{HashMap, HashSet};
use std::fs::{File, OpenOptions, canonicalize};
use std::io;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

const FORMATS: &[Format] = &[
    Format::Text,
    Format::Json,
    Format::Csv,
    Format::Svg,
    Format::Png,
    Format::Pdf,
];
/// Formats of curves that are fitted together, whose shared parameters have no distribution.
const FORMATS_TOGETHER: &[Format] = &[Format::Text, Format::Json, Format::Csv];
/// Beginning of the first line of a table.
const PROGRAM: &str = "# asperity ";
/// Beginning of the line with the command in a table.
const COMMAND: &str = "# command: ";
/// Largest size in bytes of an existing table to which rows can be added.
const LARGEST_TABLE: usize = 1 << 28;

/// Shows the number of computed curves.
pub(super) fn show_curves(computed: &u64, line: &mut ProgressLine) {
    line.show(&format!("{} computed", counted(*computed, "curve")), None);
}

/// Reason why a curve has no row in the table.
enum RowError {
    Unwritable(CliError),
    Stopped,
}

/// State of the fits: the rows computed so far, and the table to which further rows are appended.
struct Progress {
    rows: HashMap<String, CurveRow>,
    /// Table to which a row is appended after each fit; `None` if no table is written.
    table: Option<File>,
    line: ProgressLine,
}

/// Measured curves, and the arguments of their fits.
pub(super) struct Curves<'a> {
    /// Paths of files with curves, or of folders with such files.
    pub paths: &'a [PathBuf],
    pub scene: &'a str,
    pub overrides: &'a Overrides,
    pub free: &'a [Free],
    pub reading: &'a CurveOptions,
    pub jobs: Option<u16>,
    /// Folder in which each fitted curve gets a table.
    pub tables: Option<&'a Path>,
    pub output: &'a OutputArguments,
}

impl Curves<'_> {
    /// Returns the options for reading the measured curves. They contain the stiffness of the
    /// instrument from the scene in `document`.
    pub(super) fn reading_for(&self, document: &Document) -> CurveOptions {
        CurveOptions {
            instrument: document.scene().loading_stiffness,
            ..self.reading.clone()
        }
    }
}

/// Data that the fits of all curves share.
struct Batch<'a> {
    document: Document,
    free: Vec<Parameter>,
    reading: CurveOptions,
    curves: &'a Curves<'a>,
    /// Provenance that is written at the beginning of a table.
    provenance: String,
    tables: Option<CurveTables>,
}

/// Fits a scene to each of the curves in turn, and writes a table with a row for each curve.
pub(super) fn fit_all(curves: &Curves<'_>, stdout: &mut dyn Write) -> Result<(), CliError> {
    let output = curves.output;
    let format = format_of(output, FORMATS)?;
    let table = output.file().filter(|_| format == Format::Csv);
    if let Some(path) = output.file() {
        check_writable(path, output.force || table.is_some())?;
    }
    let prepared = Prepared::new(curves)?;
    let batch = &prepared.batch;
    let rows = batch.rows(&prepared.sources, table)?;
    let report = batch.report(&rows);
    let failure = report.failure().map(CliError::message);
    if let Some(failure) = failure.filter(|_| format.is_picture()) {
        return Err(failure);
    }
    match table {
        Some(path) => write_new(path, true, |out| {
            write(out, &report, format, &batch.provenance)
        })?,
        None => batch.write(&report, format, stdout)?,
    }
    stdout.flush()?;
    warn_beside(&batch.document, &report, format);
    if let Some(failure) = report.failure() {
        return Err(CliError::message(failure));
    }
    let failures = report.failures().count();
    if failures > 0 {
        let failures = grouped(failures as u64);
        let all = grouped(rows.len() as u64);
        // An error in writing to standard error is ignored, so that the results are written in any
        // case.
        let _ = writeln!(
            io::stderr(),
            "{failures} of {all} curves were not read or not fitted; their rows have the reason"
        );
    }
    Ok(())
}

/// Fits a scene to all curves together, and writes a table with a row for each curve.
pub(super) fn fit_together(curves: &Curves<'_>, stdout: &mut dyn Write) -> Result<(), CliError> {
    let output = curves.output;
    let format = format_of(output, FORMATS_TOGETHER)?;
    if let Some(path) = output.file() {
        check_writable(path, output.force)?;
    }
    let Prepared { batch, sources } = Prepared::new(curves)?;
    let names: Vec<String> = sources.iter().map(CurveSource::name).collect();
    check_names(&names)?;
    let mut measured = Vec::with_capacity(sources.len());
    let mut positions = Vec::with_capacity(sources.len());
    for (source, name) in sources.iter().zip(&names) {
        let placed = source.read(&batch.reading);
        let PlacedCurve {
            curve, position, ..
        } = placed.map_err(|error| CliError::named(name, error.in_words(option)))?;
        measured.push((name.clone(), curve));
        positions.push(position);
    }
    let fit = batch.fit();
    let task = Task {
        name: Some(batch.document.name()),
        threads: threads(None),
        begins: "0 curves computed".to_owned(),
    };
    let together = watched(task, show_curves, |control| {
        fit.run_together(&measured, control)
    })?;
    let mut rows = Vec::with_capacity(together.len());
    for (((name, curve), found), position) in measured.iter().zip(&together).zip(positions) {
        let report = FitReport {
            wording: option,
            title: name,
            curve,
            fit: found,
        };
        if let Some(tables) = &batch.tables {
            tables.write(name, &report)?;
        }
        rows.push(CurveRow::fitted(&report, position));
    }
    let report = FitsReport {
        together: &together,
        ..batch.report(&rows)
    };
    batch.write(&report, format, stdout)?;
    stdout.flush()?;
    warn_beside(&batch.document, &report, format);
    Ok(())
}

fn format_of(output: &OutputArguments, allowed: &[Format]) -> Result<Format, CliError> {
    let format = Format::of_file(output.file(), output.format, allowed, Format::Text);
    format.map_err(CliError::message)
}

/// Curves that have been found, and what their fits share.
struct Prepared<'a> {
    batch: Batch<'a>,
    sources: Vec<CurveSource>,
}

impl<'a> Prepared<'a> {
    fn new(curves: &'a Curves<'a>) -> Result<Self, CliError> {
        let output = curves.output;
        let document = curves.overrides.apply(open_argument(curves.scene)?)?;
        let reading = curves.reading_for(&document);
        let sources = CurveSource::all(curves.paths, output.file(), &reading)
            .map_err(|error| CliError::message(error.in_words(option)))?;
        // The number of threads and the tables of the curves have no influence on the rows.
        // Therefore the command in the table does not contain them, and the same table can be
        // continued with other values of these options.
        let command = command_without(&["--jobs", "--curves"]);
        let provenance_in = |folder: &Path| {
            scene_provenance(&command, document.scene(), &document.resolve(""), folder)
                .map_err(CliError::message)
        };
        let provenance = provenance_in(output.folder())?;
        let is_same_folder = |path: &PathBuf| {
            let folder = curves.tables.and_then(|folder| canonicalize(folder).ok());
            folder.is_some() && canonicalize(path).ok() == folder
        };
        if let Some(folder) = curves.paths.iter().find(|path| is_same_folder(path)) {
            let fault =
                "the tables would lie among the curves; allowed: another folder for --curves";
            return Err(CliError::named(path_name(folder), fault));
        }
        let tables = match curves.tables {
            Some(folder) => Some(CurveTables::prepare(
                folder,
                &sources,
                output.file(),
                provenance_in(folder)?,
                output.force,
            )?),
            None => None,
        };
        let mut free = Vec::new();
        for parameter in Parameter::ALL {
            if curves.free.iter().any(|free| free.parameter == parameter) {
                free.push(parameter);
            }
        }
        let batch = Batch {
            free,
            reading,
            curves,
            provenance,
            tables,
            document,
        };
        Ok(Prepared { batch, sources })
    }
}

/// Returns an error if a file is named twice, because the table can have only one row for each
/// file.
fn check_names(names: &[String]) -> Result<(), CliError> {
    let mut seen = HashSet::new();
    for name in names {
        if !seen.insert(name) {
            return Err(CliError::named(
                printable(name),
                "named twice; allowed: each curve once",
            ));
        }
    }
    Ok(())
}

impl Batch<'_> {
    fn report<'a>(&'a self, rows: &'a [CurveRow]) -> FitsReport<'a> {
        FitsReport {
            scene: self.document.scene(),
            free: &self.free,
            rows,
            together: &[],
            wording: option,
        }
    }

    /// Returns the row of each file, in the order of the files. A row that the table already
    /// contains is not computed again. Each new row is appended to the table as soon as it is
    /// computed.
    fn rows(
        &self,
        sources: &[CurveSource],
        table: Option<&Path>,
    ) -> Result<Vec<CurveRow>, CliError> {
        let names: Vec<String> = sources.iter().map(CurveSource::name).collect();
        check_names(&names)?;
        let mut rows = table
            .map(|path| self.kept(path))
            .transpose()?
            .unwrap_or_default();
        if let Some(tables) = &self.tables {
            rows.retain(|name, _| tables.has(name));
        }
        let todo: Vec<usize> = (0..sources.len())
            .filter(|index| !rows.contains_key(&names[*index]))
            .collect();
        let table_path = table;
        let table = table.map(|path| self.begun(path, &rows)).transpose()?;
        let all = counted(sources.len() as u64, "curve");
        let watch = SignalWatch::begin()?;
        let stop = || watch.is_signalled();
        let mut line = ProgressLine::default();
        line.show(&format!("{} of {all}", grouped(rows.len() as u64)), None);
        let progress = Mutex::new(Progress { rows, table, line });
        let worker = || {
            |number: u64| {
                let index = todo[number as usize];
                let row = self.row(&sources[index], &stop);
                if stop() {
                    return Err(RowError::Stopped);
                }
                let row = row.map_err(RowError::Unwritable)?;
                let mut progress = progress.lock().unwrap_or_else(PoisonError::into_inner);
                let line = self.text_of(std::slice::from_ref(&row));
                let written = progress
                    .table
                    .as_mut()
                    .map_or(Ok(()), |table| table.write_all(last_line(&line).as_bytes()));
                let written = written.map_err(|error| {
                    let name = table_path.map(path_name).unwrap_or_default();
                    RowError::Unwritable(CliError::named(
                        name,
                        format!("cannot be written: {error}"),
                    ))
                });
                progress.rows.insert(names[index].clone(), row);
                let done = grouped(progress.rows.len() as u64);
                progress.line.show(&format!("{done} of {all}"), None);
                written
            }
        };
        let written = on_threads(todo.len() as u64, threads(self.curves.jobs), worker);
        let progress = progress
            .into_inner()
            .unwrap_or_else(PoisonError::into_inner);
        progress.line.clear();
        let mut rows = progress.rows;
        written.map_err(|error| match error {
            RowError::Unwritable(error) => error,
            RowError::Stopped => {
                let done = grouped(rows.len() as u64);
                let next = match table_path {
                    Some(_) => "the same command goes on",
                    None => "the same command begins anew, and with -o FILE.csv it would go on",
                };
                watch.interrupted(format!("stopped: {done} of {all} done; {next}"))
            }
        })?;
        Ok(names.iter().filter_map(|name| rows.remove(name)).collect())
    }

    /// Returns the fit of the scene.
    fn fit(&self) -> Fit<'_> {
        let mut fit = Fit::of(&self.document);
        for free in self.curves.free {
            fit = fit.free(*free);
        }
        fit
    }

    /// Writes a report in a format to its file or to the output.
    fn write(
        &self,
        report: &FitsReport<'_>,
        format: Format,
        stdout: &mut dyn Write,
    ) -> Result<(), CliError> {
        let origin = Origin::Scene(&self.document, self.document.scene());
        self.curves.output.write(stdout, report, format, origin)
    }

    /// Fits the scene to a curve, and writes the table of the curve if one is asked for.
    ///
    /// # Errors
    /// Returns an error if the table of the curve cannot be written. The row has the reason if the
    /// curve cannot be read or fitted.
    fn row(
        &self,
        source: &CurveSource,
        stop: &(dyn Fn() -> bool + Sync),
    ) -> Result<CurveRow, CliError> {
        let name = &source.name();
        let PlacedCurve {
            curve, position, ..
        } = match source.read(&self.reading) {
            Ok(placed) => placed,
            Err(error) => return Ok(CurveRow::failed(name, &error.in_words(option))),
        };
        let found = match self.fit().run(&curve, Control::default().stopped_by(stop)) {
            Ok(found) => found,
            Err(error) => return Ok(CurveRow::failed(name, &error.in_words(option))),
        };
        let report = FitReport {
            title: name,
            curve: &curve,
            fit: &found,
            wording: option,
        };
        if let Some(tables) = &self.tables {
            tables.write(name, &report)?;
        }
        Ok(CurveRow::fitted(&report, position))
    }

    /// Returns a table of these rows as text in CSV.
    fn text_of(&self, rows: &[CurveRow]) -> String {
        let mut text = Vec::new();
        let table = self
            .report(rows)
            .table()
            .map(|table| table.write_csv(&mut text, &self.provenance));
        debug_assert!(
            matches!(table, Some(Ok(()))),
            "writing to memory cannot fail"
        );
        String::from_utf8_lossy(&text).into_owned()
    }

    /// Returns the rows that an existing table contains. The result is empty if there is no table,
    /// or if the table is to be overwritten.
    fn kept(&self, path: &Path) -> Result<HashMap<String, CurveRow>, CliError> {
        if !path.exists() || self.curves.output.force {
            return Ok(HashMap::new());
        }
        let text = read_regular_text(path, LARGEST_TABLE)
            .map_err(|error| CliError::named(path_name(path), error))?;
        let Some(rows) = text.strip_prefix(&self.text_of(&[])) else {
            return Err(CliError::named(
                path_name(path),
                refusal(&text, &self.text_of(&[])),
            ));
        };
        // If an earlier process was killed, the last row may be incomplete. Such a row is computed
        // again.
        let whole = rows.rsplit_once('\n').map_or("", |(whole, _)| whole);
        let rows = whole
            .lines()
            .filter_map(|line| CurveRow::from_line(line, self.free.len()));
        // A curve that could not be read or fitted is tried again, because its file may have been
        // repaired since.
        let rows = rows.filter(|row| row.error.is_empty());
        Ok(rows.map(|row| (row.file.clone(), row)).collect())
    }

    /// Writes a table with the rows that are kept, and opens it to append further rows.
    fn begun(&self, path: &Path, rows: &HashMap<String, CurveRow>) -> Result<File, CliError> {
        let mut rows: Vec<CurveRow> = rows.values().cloned().collect();
        rows.sort_by(|one, other| one.file.cmp(&other.file));
        write_new(path, true, |out| {
            out.write_all(self.text_of(&rows).as_bytes())
        })?;
        let opened = OpenOptions::new().append(true).open(path);
        opened.map_err(|error| {
            CliError::named(path_name(path), format!("cannot be written: {error}"))
        })
    }
}

/// Returns the reason why an existing table with this text cannot be continued. `expected` is the
/// beginning of a table that this command would write.
fn refusal(text: &str, expected: &str) -> String {
    if !text.starts_with(PROGRAM) {
        return "this is not a table of fits; allowed: another file, or --force, which overwrites this file"
            .to_owned();
    }
    let differing = text
        .lines()
        .zip(expected.lines())
        .find(|(found, expected)| found != expected);
    let what = match differing.map_or("", |(_, expected)| expected) {
        line if line.starts_with(PROGRAM) => "version",
        line if line.starts_with(COMMAND) => "command",
        _ => "scene",
    };
    let lines = text.lines().filter(|line| !line.starts_with('#')).count();
    let rows = match lines.saturating_sub(1) {
        1 => "1 finished row".to_owned(),
        count => format!("{} finished rows", grouped(count as u64)),
    };
    format!(
        "this is the table of another {what}, with {rows}; allowed: the {what} of the table, which continues it, another file, \
         or --force, which discards its rows"
    )
}

fn last_line(text: &str) -> &str {
    let start = text
        .trim_end_matches('\n')
        .rfind('\n')
        .map_or(0, |end| end + 1);
    &text[start..]
}
