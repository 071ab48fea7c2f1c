//! Fits of scenes to measured force curves.

use crate::computing::{Watch, computed};
use crate::failure::Failure;
use crate::report::{Report, of_scene};
use crate::scene::Scene;
use asperity::cli::arguments::{Arguments, Command};
use asperity::data::{Control, on_threads, parallel, path_name};
use asperity::experiment::{CurveOptions, Fit, FitResult, Free, MeasuredCurve, Parameter, fit_ensemble};
use asperity::scene::Document;
use asperity_report::{CurveRow, EnsembleFitReport, FitReport, FitsReport};
use clap::Parser;
use pyo3::prelude::*;
use std::path::PathBuf;
use std::sync::atomic::{AtomicU64, Ordering};

/// A command of the program with its options as words.
///
/// # Errors
/// An option that the command does not have, or one with a wrong value, in the words of the command line.
pub fn command(name: &str, words: Vec<String>) -> Result<Option<Command>, Failure> {
    let line = ["asperity".to_owned(), name.to_owned()].into_iter().chain(words);
    let parsed = Arguments::try_parse_from(line).map_err(|error| {
        let text = error.to_string();
        let lines = text.lines().map(|line| line.trim().trim_start_matches("error: "));
        lines.take_while(|line| !line.is_empty()).collect::<Vec<_>>().join(" ")
    });
    Ok(parsed?.command)
}

/// A measured curve as it is given.
#[derive(FromPyObject)]
pub enum Curve {
    File(PathBuf),
    /// Displacements, m, and forces, N.
    Columns(Vec<f64>, Vec<f64>),
}

impl Curve {
    fn read(&self, options: &CurveOptions) -> Result<MeasuredCurve, Failure> {
        let (displacement, force) = match self {
            Curve::Columns(displacement, force) => (displacement, force),
            Curve::File(path) => {
                let in_words = |error| format!("{}: {error}", path_name(path));
                let curve = MeasuredCurve::read(path, options);
                return curve.map_err(|error| Failure::of_files(std::slice::from_ref(path), in_words(error)));
            }
        };
        Ok(MeasuredCurve::from_columns(displacement, force, options)?)
    }
}

/// A fit of the free parameters to one curve.
fn fitted(
    document: &Document,
    free: &[Free],
    curve: &MeasuredCurve,
    watch: &Watch,
    report: &mut dyn FnMut(u64),
) -> Result<FitResult, Failure> {
    let fit = free.iter().fold(Fit::of(document), |fit, free| fit.free(*free));
    Ok(fit.run(curve, Control::default().stopped_by(&|| watch.stop()).reporting_to(report))?)
}

/// Fits a scene to one curve, to each of several curves, or on random profiles to all curves together. The words are options of
/// `asperity fit`.
#[pyfunction]
pub fn fit(
    py: Python<'_>,
    curves: Vec<(String, Curve)>,
    scene: &Scene,
    words: Vec<String>,
    is_single: bool,
    jobs: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Report> {
    let (document, jobs) = (scene.document.clone(), jobs.unwrap_or_else(parallel::threads));
    computed(py, progress, move |watch| {
        let Some(Command::Fit(arguments)) = command("fit", words)? else {
            return Err("fit: no options of a fit".to_owned().into());
        };
        let instrument = document.scene().loading_stiffness;
        let (reading, free) = (CurveOptions { instrument, ..arguments.reading }, arguments.free);
        if let Some(lines) = arguments.ensemble.lines {
            let options = arguments.ensemble.options(&free, lines).map_err(|error| error.to_string())?;
            let curves = curves.iter().map(|(name, curve)| Ok((name.clone(), curve.read(&reading)?)));
            let curves = curves.collect::<Result<Vec<_>, Failure>>()?;
            let (stop, mut report) = (|| watch.stop(), |done| watch.report(done, 0));
            let control = Control::default().on_threads(jobs).stopped_by(&stop).reporting_to(&mut report);
            let fit = fit_ensemble(&curves, &document, &options, control)?;
            let has_roughness_errors = options.height_error.is_some() || options.hurst_error.is_some();
            return Ok(Report::new(move |format| {
                let (title, fit) = (document.title(), &fit);
                of_scene(&document, &EnsembleFitReport { title, fit, has_roughness_errors }, format)
            }));
        }
        if let ([(title, curve)], true) = (&curves[..], is_single) {
            let (title, curve) = (title.clone(), curve.read(&reading)?);
            let fit = fitted(&document, &free, &curve, watch, &mut |done| watch.report(done, 0))?;
            return Ok(Report::new(move |format| {
                of_scene(&fit.document, &FitReport { title: &title, curve: &curve, fit: &fit }, format)
            }));
        }
        let (done, all) = (AtomicU64::new(0), curves.len() as u64);
        let worker = || {
            |number: u64| {
                let (title, curve) = &curves[number as usize];
                let row = curve.read(&reading).and_then(|curve| {
                    let fit = &fitted(&document, &free, &curve, watch, &mut |_| ())?;
                    Ok(CurveRow::of(title.clone(), &FitReport { title, curve: &curve, fit }))
                });
                watch.report(1 + done.fetch_add(1, Ordering::Relaxed), all);
                // A curve that cannot be fitted has a row with the reason, unless all are stopped.
                row.or_else(|failure| match watch.stop() {
                    true => Err(failure),
                    false => {
                        let (file, error) = (title.clone(), failure.message().to_owned());
                        Ok(CurveRow { file, error, ..CurveRow::default() })
                    }
                })
            }
        };
        let rows = on_threads(all, jobs, worker)?;
        let is_free = |one: &Parameter| free.iter().any(|free| free.parameter == *one);
        let free: Vec<Parameter> = Parameter::ALL.into_iter().filter(is_free).collect();
        Ok(Report::new(move |format| {
            of_scene(&document, &FitsReport { scene: document.scene(), free: &free, rows: &rows }, format)
        }))
    })
}
