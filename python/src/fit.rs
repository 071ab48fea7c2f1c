//! Fits of scenes to measured force curves, for calls from Python.

use crate::advice::argument;
use crate::computing::{Call, Case};
use crate::failure::Failure;
use crate::results::{Report, bytes, named};
use crate::scene::{read_again, written};
use crate::words::command;
use asperity::cli::arguments::Command;
use asperity::cli::fit::FitArguments;
use asperity::data::{Control, Remedied, counted, on_threads, path_name};
use asperity::experiment::{
    CurveOptions, CurveSource, EnsembleOptions, ExperimentError, Fit, FitResult, MeasuredCurve,
    Parameter, SeveralCurves, fit_ensemble,
};
use asperity_report::{CurveRow, EnsembleFitReport, FitReport, FitsReport};
use pyo3::prelude::*;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// A measured curve, given by its name and its columns: displacements in m, forces in N, and times
/// in s or nothing. If the columns are `None`, the curve is read from a file, and the name is the
/// path of this file.
#[derive(FromPyObject)]
pub struct Curve(String, Option<(Vec<f64>, Vec<f64>, Vec<f64>)>);

impl Curve {
    /// Returns the curves that this one names: those of a folder, and those of a file with
    /// several.
    fn sources(&self, options: &CurveOptions) -> Result<Vec<Source<'_>>, Failure> {
        if let Some((displacement, force, seconds)) = &self.1 {
            return Ok(vec![Source::Columns {
                name: &self.0,
                displacement,
                force,
                seconds,
            }]);
        }
        let path = PathBuf::from(&self.0);
        let sources = CurveSource::all(std::slice::from_ref(&path), None, options);
        let sources = sources
            .map_err(|error| Failure::of_files(&[path], error.in_words(argument)))?
            .into_iter();
        Ok(sources.map(Source::File).collect())
    }

    /// Returns true unless this one names a folder or a file with several curves.
    fn is_one(&self, options: &CurveOptions) -> bool {
        let path = Path::new(&self.0);
        self.1.is_some() || !path.is_dir() && SeveralCurves::read(path, options).is_none()
    }

    /// Returns the only curve that this one names.
    fn source(&self, options: &CurveOptions) -> Result<Source<'_>, Failure> {
        if self.1.is_none() {
            let path = PathBuf::from(&self.0);
            let source = CurveSource::new(&path, options);
            return Ok(Source::File(
                source.map_err(|error| in_file(&path, &error))?,
            ));
        }
        let mut sources = self.sources(options)?;
        sources.pop().ok_or_else(|| "no curve".to_owned().into())
    }
}

/// A single measured curve.
enum Source<'a> {
    Columns {
        name: &'a str,
        displacement: &'a [f64],
        force: &'a [f64],
        seconds: &'a [f64],
    },
    File(CurveSource),
}

/// A curve, and the coordinates in m of the place at which it was measured, if they are known.
struct Placed {
    curve: MeasuredCurve,
    position: Option<[f64; 2]>,
}

impl Source<'_> {
    fn name(&self) -> String {
        match self {
            Source::Columns { name, .. } => (*name).to_owned(),
            Source::File(source) => source.name(),
        }
    }

    fn read(&self, options: &CurveOptions) -> Result<Placed, Failure> {
        match self {
            Source::Columns {
                displacement,
                force,
                seconds,
                ..
            } => Ok(Placed {
                curve: MeasuredCurve::from_timed_columns(displacement, force, seconds, options)?,
                position: None,
            }),
            Source::File(source) => {
                let placed = source.read(options);
                let placed = placed.map_err(|error| in_file(source.path(), &error))?;
                Ok(Placed {
                    curve: placed.curve,
                    position: placed.position,
                })
            }
        }
    }
}

fn in_file(path: &Path, error: &ExperimentError) -> Failure {
    let message = format!("{}: {}", path_name(path), error.in_words(argument));
    Failure::of_files(&[path.to_owned()], message)
}

/// Returns the curves that these ones name.
fn all_sources<'a>(
    curves: &'a [Curve],
    options: &CurveOptions,
) -> Result<Vec<Source<'a>>, Failure> {
    let mut sources = Vec::with_capacity(curves.len());
    // Files beside each other are found together, so that a file with several curves is read once.
    for group in curves.chunk_by(|one, next| one.1.is_none() && next.1.is_none()) {
        if let [curve] = group {
            sources.extend(curve.sources(options)?);
            continue;
        }
        let paths: Vec<PathBuf> = group.iter().map(|curve| PathBuf::from(&curve.0)).collect();
        let found = CurveSource::all(&paths, None, options);
        let found = found.map_err(|error| Failure::of_files(&paths, error.in_words(argument)))?;
        sources.extend(found.into_iter().map(Source::File));
    }
    Ok(sources)
}

/// Returns the names of all curves that these ones name: those of folders and of files with several
/// curves one by one. `words` are options of the command `asperity fit`.
#[pyfunction]
pub fn curve_names(
    py: Python<'_>,
    call: Call,
    given: CurvesToFit,
) -> PyResult<Vec<Option<String>>> {
    let CurvesToFit(curves, words) = given;
    call.computed(py, move |case| {
        let asked = Asked::new(&case, words)?;
        let mut names = Vec::new();
        for source in all_sources(&curves, &asked.reading)? {
            names.push(match source {
                Source::Columns { .. } => None,
                Source::File(source) => Some(source.name()),
            });
        }
        Ok(names)
    })
}

/// Returns an error if no curve was fitted. The error states the reason for the first curve.
fn check_any_fitted(curves: &[Curve], rows: &[CurveRow]) -> Result<(), Failure> {
    let mut reason = "";
    for row in rows.iter().rev() {
        if row.error.is_empty() {
            return Ok(());
        }
        reason = &row.error;
    }
    let message = format!(
        "none of {} is fitted; the first one: {reason}",
        counted(rows.len() as u64, "curve")
    );
    let mut files = Vec::new();
    for curve in curves {
        if curve.1.is_none() {
            files.push(PathBuf::from(&curve.0));
        }
    }
    Err(Failure::of_files(&files, message))
}

/// A fit as the caller has asked for it: options of the command `asperity fit`, and those of
/// reading the curves.
struct Asked {
    arguments: FitArguments,
    reading: CurveOptions,
}

impl Asked {
    fn new(case: &Case, words: Vec<String>) -> Result<Self, Failure> {
        let Some(Command::Fit(arguments)) = command("fit", words)? else {
            return Err("fit: no options of a fit".to_owned().into());
        };
        let reading = CurveOptions {
            instrument: case.document.scene().loading_stiffness,
            ..arguments.reading.clone()
        };
        Ok(Asked { arguments, reading })
    }

    /// Returns true if these are several curves of one specimen, which are fitted together: with
    /// relaxation, and without folders and files of several curves.
    fn shares_parameters(&self, curves: &[Curve]) -> bool {
        let mut free = self.arguments.free.iter();
        let relaxes = free.any(|free| free.parameter.is_of_relaxation());
        relaxes && curves.len() > 1 && curves.iter().all(|curve| curve.is_one(&self.reading))
    }

    /// Returns the free parameters in the order of tables.
    fn parameters(&self) -> Vec<Parameter> {
        let mut parameters = Vec::new();
        for parameter in Parameter::ALL {
            let mut free = self.arguments.free.iter();
            if free.any(|free| free.parameter == parameter) {
                parameters.push(parameter);
            }
        }
        parameters
    }

    fn fit<'a>(&self, case: &'a Case) -> Fit<'a> {
        let mut fit = Fit::of(&case.document);
        if let Some(measured) = &case.in_memory {
            fit = fit.with_measured(Arc::clone(measured));
        }
        for parameter in &self.arguments.free {
            fit = fit.free(*parameter);
        }
        fit
    }
}

/// Fits a scene to measured curves. Each curve is fitted separately or, with random profiles, all
/// curves are fitted together. `words` are options of the command `asperity fit`.
#[pyfunction]
pub fn fit(
    py: Python<'_>,
    call: Call,
    curves: (Vec<Curve>, bool),
    words: Vec<String>,
) -> PyResult<Report> {
    let (curves, is_one) = curves;
    call.computed(py, move |case| {
        let asked = Asked::new(&case, words)?;
        if let Some(profiles) = asked.arguments.ensemble.lines {
            let options = asked
                .arguments
                .ensemble
                .options(&asked.arguments.free, profiles)
                .map_err(|error| error.to_string())?;
            return fit_profiles(&case, &curves, &asked.reading, &options);
        }
        let fit = asked.fit(&case);
        match &curves[..] {
            [curve] if is_one => fit_single(&case, &fit, curve, &asked.reading),
            _ if asked.shares_parameters(&curves) => fit_together(&case, &fit, &curves, &asked),
            _ => {
                let rows = fit_each(&case, &fit, &curves, &asked.reading)?;
                report_of_rows(&case, &asked, &curves, rows)
            }
        }
    })
}

/// Measured curves, and options of the command `asperity fit`.
#[derive(FromPyObject)]
pub struct CurvesToFit(Vec<Curve>, Vec<String>);

/// Fits a scene to some of several curves, for another process that gathers the rows by
/// [`fits_of_parts`]. Returns the rows as text.
#[pyfunction]
pub fn fits_part(py: Python<'_>, call: Call, given: CurvesToFit) -> PyResult<String> {
    let CurvesToFit(curves, words) = given;
    call.computed(py, move |case| {
        let asked = Asked::new(&case, words)?;
        let fit = asked.fit(&case);
        written(&fit_each(&case, &fit, &curves, &asked.reading)?)
    })
}

/// Returns the report on several curves, each of which [`fits_part`] has fitted.
#[pyfunction]
pub fn fits_of_parts(
    py: Python<'_>,
    call: Call,
    given: CurvesToFit,
    parts: Vec<String>,
) -> PyResult<Report> {
    let CurvesToFit(curves, words) = given;
    call.computed(py, move |case| {
        let asked = Asked::new(&case, words)?;
        let mut rows = Vec::with_capacity(curves.len());
        for part in &parts {
            rows.extend(read_again::<Vec<CurveRow>>(part)?);
        }
        report_of_rows(&case, &asked, &curves, rows)
    })
}

/// Returns the number of computed force curves, which is the progress of a fit.
fn computed_curves(computed: &u64) -> Option<u64> {
    Some(*computed)
}

/// Fits a scene with random profiles to all curves together.
fn fit_profiles(
    case: &Case,
    curves: &[Curve],
    reading: &CurveOptions,
    options: &EnsembleOptions,
) -> Result<Report, Failure> {
    let mut measured = Vec::with_capacity(curves.len());
    for source in all_sources(curves, reading)? {
        measured.push((source.name(), source.read(reading)?.curve));
    }
    let document = case.document.clone();
    let simulation = case.simulation();
    let fit = case.watched(0, computed_curves, |control| {
        fit_ensemble(&measured, &document, options, &simulation, control)
    })?;
    let has_roughness_errors = options.height_error.is_some() || options.hurst_error.is_some();
    let in_memory = case.in_memory.clone();
    Ok(Report::new(move |format| {
        let report = EnsembleFitReport {
            title: document.title(),
            fit: &fit,
            has_roughness_errors,
            wording: argument,
        };
        bytes(named(&document, &in_memory), &report, format)
    }))
}

/// Fits a scene to several curves of one specimen together.
fn fit_together(
    case: &Case,
    fit: &Fit,
    curves: &[Curve],
    asked: &Asked,
) -> Result<Report, Failure> {
    let mut measured = Vec::with_capacity(curves.len());
    let mut positions = Vec::with_capacity(curves.len());
    for curve in curves {
        let source = curve.source(&asked.reading)?;
        let placed = source.read(&asked.reading)?;
        measured.push((source.name(), placed.curve));
        positions.push(placed.position);
    }
    let together = case.watched(0, computed_curves, |control| {
        fit.run_together(&measured, control)
    })?;
    let mut rows = Vec::with_capacity(together.len());
    for (((name, curve), found), position) in measured.iter().zip(&together).zip(positions) {
        let report = FitReport {
            title: name,
            curve,
            fit: found,
            wording: argument,
        };
        rows.push(CurveRow::fitted(&report, position));
    }
    Ok(report_of(case, asked.parameters(), rows, together))
}

/// Fits a scene to a single curve.
fn fit_single(
    case: &Case,
    fit: &Fit,
    curve: &Curve,
    reading: &CurveOptions,
) -> Result<Report, Failure> {
    let source = curve.source(reading)?;
    let title = source.name();
    let curve = source.read(reading)?.curve;
    let result = case.watched(0, computed_curves, |control| fit.run(&curve, control))?;
    let in_memory = case.in_memory.clone();
    Ok(Report::new(move |format| {
        let report = FitReport {
            title: &title,
            curve: &curve,
            fit: &result,
            wording: argument,
        };
        bytes(named(&result.document, &in_memory), &report, format)
    }))
}

/// Fits a scene to each of several curves separately.
fn fit_each(
    case: &Case,
    fit: &Fit,
    curves: &[Curve],
    reading: &CurveOptions,
) -> Result<Vec<CurveRow>, Failure> {
    let watch = case.watch;
    let stop = || watch.stop();
    let done = AtomicU64::new(0);
    let sources = all_sources(curves, reading)?;
    let all = sources.len() as u64;
    let fit_number = |number: u64| {
        let row = row_of(&sources[number as usize], fit, reading, &stop);
        watch.report(1 + done.fetch_add(1, Ordering::Relaxed), all);
        if stop() {
            return Err("stopped".to_owned());
        }
        Ok(row)
    };
    Ok(on_threads(all, case.jobs, || fit_number)?)
}

/// Fits a scene to a curve, and returns its row in the table of all curves. If the curve cannot be
/// read or fitted, the row has the reason.
fn row_of(
    source: &Source<'_>,
    fit: &Fit<'_>,
    reading: &CurveOptions,
    stop: &(dyn Fn() -> bool + Sync),
) -> CurveRow {
    let name = source.name();
    let Placed { curve, position } = match source.read(reading) {
        Ok(placed) => placed,
        Err(failure) => return CurveRow::failed(&name, &failure.message()),
    };
    match fit.run(&curve, Control::default().stopped_by(stop)) {
        Ok(found) => {
            let report = FitReport {
                title: &name,
                curve: &curve,
                fit: &found,
                wording: argument,
            };
            CurveRow::fitted(&report, position)
        }
        Err(error) => CurveRow::failed(&name, &error.in_words(argument)),
    }
}

/// Returns the report on several curves, of which at least one must be fitted.
fn report_of_rows(
    case: &Case,
    asked: &Asked,
    curves: &[Curve],
    rows: Vec<CurveRow>,
) -> Result<Report, Failure> {
    check_any_fitted(curves, &rows)?;
    Ok(report_of(case, asked.parameters(), rows, Vec::new()))
}

/// Returns the report on several curves with these free parameters. `together` has the results of
/// curves that were fitted together.
fn report_of(
    case: &Case,
    parameters: Vec<Parameter>,
    rows: Vec<CurveRow>,
    together: Vec<FitResult>,
) -> Report {
    let document = case.document.clone();
    let in_memory = case.in_memory.clone();
    Report::new(move |format| {
        let report = FitsReport {
            scene: document.scene(),
            free: &parameters,
            rows: &rows,
            together: &together,
            wording: argument,
        };
        bytes(named(&document, &in_memory), &report, format)
    })
}
