//! `asperity fit` for several curves: fits all curves in files and folders on several threads, and
//! writes a table. If the table already exists, only its missing rows are computed.

use super::advice::option;
use super::error::CliError;
use super::output::{Origin, OutputArguments, command_without};
use super::progress::{ProgressLine, SignalWatch};
use super::scene::{Overrides, holds_warnings, threads, warn};
use asperity_data::Remedied;
use asperity_data::{
    Control, check_writable, grouped, on_threads, path_name, printable, read_regular_text,
    write_new,
};
use asperity_experiment::{CurveOptions, Fit, Free, MeasuredCurve, Parameter};
use asperity_report::{CurveRow, FitsReport, Format, Report, scene_provenance, write};
use asperity_scene::Document;
use asperity_scene::library::open_argument;
use std::collections::{HashMap, HashSet};
use std::fs::{File, OpenOptions, read_dir};
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
/// Beginning of the first line of a table.
const PROGRAM: &str = "# asperity ";
/// Beginning of the line with the command in a table.
const COMMAND: &str = "# command: ";
/// Largest size in bytes of an existing table to which rows can be added.
const LARGEST_TABLE: usize = 1 << 28;

/// Returns the files that the arguments name. In place of a folder, it returns the files in the
/// folder that may be curves, sorted by their names.
pub(super) fn files_of(
    curves: &[PathBuf],
    output: Option<&Path>,
) -> Result<Vec<PathBuf>, CliError> {
    let mut files = Vec::new();
    for path in curves {
        if !path.is_dir() {
            files.push(path.clone());
            continue;
        }
        let mut entries = paths_in(path).map_err(|error| {
            CliError::named(path_name(path), format!("cannot be read: {error}"))
        })?;
        entries.retain(|entry| may_be_curve(entry) && Some(&**entry) != output);
        entries.sort();
        if entries.is_empty() {
            return Err(CliError::named(
                path_name(path),
                "no files in this folder; allowed: a folder of curves",
            ));
        }
        files.extend(entries);
    }
    Ok(files)
}

fn paths_in(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let mut paths = Vec::new();
    for entry in read_dir(folder)? {
        paths.push(entry?.path());
    }
    Ok(paths)
}

/// Returns true for a file that is neither hidden nor a scene.
fn may_be_curve(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default();
    let is_hidden = name.to_string_lossy().starts_with('.');
    let is_scene = path.extension().is_some_and(|end| end == "ron");
    path.is_file() && !is_hidden && !is_scene
}

/// Shows in the progress line how many force curves have been computed.
pub(super) fn show_curves(computed: &u64, line: &mut ProgressLine) {
    line.show(&format!("{} curves computed", grouped(*computed)), None);
}

/// Reason why a curve has no row in the table.
enum RowError {
    Unwritable(io::Error),
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
}

/// Fits a scene to each of the curves in turn, and writes a table with a row for each curve.
pub(super) fn fit_all(curves: &Curves<'_>, stdout: &mut dyn Write) -> Result<(), CliError> {
    let output = curves.output;
    let format = Format::of_file(output.file(), output.format, FORMATS, Format::Text);
    let format = format.map_err(CliError::message)?;
    let table = output.file().filter(|_| format == Format::Csv);
    if let Some(path) = output.file() {
        check_writable(path, output.force || table.is_some())?;
    }
    let files = files_of(curves.paths, output.file())?;
    let document = curves.overrides.apply(open_argument(curves.scene)?)?;
    // The number of threads has no influence on the rows. Therefore the command in the table does
    // not contain it, and the table can be continued with another number of threads.
    let command = command_without(&["--jobs"]);
    let provenance = scene_provenance(
        &command,
        document.scene(),
        &document.resolve(""),
        output.folder(),
    );
    let mut free = Vec::new();
    for parameter in Parameter::ALL {
        if curves.free.iter().any(|free| free.parameter == parameter) {
            free.push(parameter);
        }
    }
    let batch = Batch {
        free,
        reading: curves.reading_for(&document),
        curves,
        provenance: provenance.map_err(CliError::message)?,
        document,
    };
    let rows = batch.rows(&files, table)?;
    let report = batch.report(&rows);
    let failure = report.failure().map(CliError::message);
    if let Some(failure) = failure.filter(|_| format.is_picture()) {
        return Err(failure);
    }
    match table {
        Some(path) => write_new(path, true, |out| {
            write(out, &report, format, &batch.provenance)
        })?,
        None => output.write(
            stdout,
            &report,
            format,
            Origin::Scene(&batch.document, batch.document.scene()),
        )?,
    }
    stdout.flush()?;
    if !holds_warnings(format) {
        warn(&batch.document, &report.warning_texts());
    }
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
            wording: option,
        }
    }

    /// Returns the row of each file, in the order of the files. A row that the table already
    /// contains is not computed again. Each new row is appended to the table as soon as it is
    /// computed.
    fn rows(&self, files: &[PathBuf], table: Option<&Path>) -> Result<Vec<CurveRow>, CliError> {
        let names: Vec<String> = files
            .iter()
            .map(|path| path.to_string_lossy().into_owned())
            .collect();
        check_names(&names)?;
        let rows = table
            .map(|path| self.kept(path))
            .transpose()?
            .unwrap_or_default();
        let todo: Vec<usize> = (0..files.len())
            .filter(|index| !rows.contains_key(&names[*index]))
            .collect();
        let table_path = table;
        let table = table.map(|path| self.begun(path, &rows)).transpose()?;
        let count = grouped(files.len() as u64);
        let watch = SignalWatch::begin()?;
        let stop = || watch.is_signalled();
        let mut line = ProgressLine::default();
        line.show(
            &format!("{} of {count} curves", grouped(rows.len() as u64)),
            None,
        );
        let progress = Mutex::new(Progress { rows, table, line });
        let worker = || {
            |number: u64| {
                let index = todo[number as usize];
                let row = self.row(&files[index], &names[index], &stop);
                if stop() {
                    return Err(RowError::Stopped);
                }
                let mut progress = progress.lock().unwrap_or_else(PoisonError::into_inner);
                let line = self.text_of(std::slice::from_ref(&row));
                let written = progress
                    .table
                    .as_mut()
                    .map_or(Ok(()), |table| table.write_all(last_line(&line).as_bytes()));
                let written = written.map_err(RowError::Unwritable);
                progress.rows.insert(names[index].clone(), row);
                let done = grouped(progress.rows.len() as u64);
                progress
                    .line
                    .show(&format!("{done} of {count} curves"), None);
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
            RowError::Unwritable(error) => CliError::named(
                table_path.map(path_name).unwrap_or_default(),
                format!("cannot be written: {error}"),
            ),
            RowError::Stopped => {
                let done = grouped(rows.len() as u64);
                let lost = match table_path {
                    Some(_) => "the same command continues the table",
                    None => "no results are written",
                };
                watch.interrupted(format!(
                    "stopped: {done} of {count} curves are fitted; {lost}"
                ))
            }
        })?;
        Ok(names.iter().filter_map(|name| rows.remove(name)).collect())
    }

    fn row(&self, path: &Path, name: &str, stop: &(dyn Fn() -> bool + Sync)) -> CurveRow {
        let fit = self
            .curves
            .free
            .iter()
            .copied()
            .fold(Fit::of(&self.document), Fit::free);
        CurveRow::of(
            name,
            MeasuredCurve::read(path, &self.reading).map_err(|error| error.in_words(option)),
            &fit,
            Control::default().stopped_by(stop),
            option,
        )
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
