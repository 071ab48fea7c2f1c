//! Fits of scenes to measured force curves.

use crate::computing::Call;
use crate::failure::Failure;
use crate::results::{Report, bytes};
use crate::words::command;
use asperity::cli::arguments::Command;
use asperity::data::{Control, on_threads, path_name};
use asperity::experiment::{CurveOptions, Fit, Free, MeasuredCurve, Parameter, fit_ensemble};
use asperity_report::{CurveRow, EnsembleFitReport, FitReport, FitsReport};
use pyo3::prelude::*;
use std::path::PathBuf;
use std::sync::atomic::{AtomicU64, Ordering};

/// A measured curve: its name, and displacements, m, and forces, N, unless the name is that of a
/// file.
#[derive(FromPyObject)]
pub struct Curve(String, Option<(Vec<f64>, Vec<f64>)>);

impl Curve {
    fn read(&self, options: &CurveOptions) -> Result<MeasuredCurve, Failure> {
        if let Some((displacement, force)) = &self.1 {
            return Ok(MeasuredCurve::from_columns(displacement, force, options)?);
        }
        let path = PathBuf::from(&self.0);
        MeasuredCurve::read(&path, options).map_err(|error| {
            let message = format!("{}: {error}", path_name(&path));
            Failure::of_files(&[path], message)
        })
    }
}

/// Returns an error if no curve was fitted, with the reason of the first one.
fn check_any_fitted(curves: &[Curve], rows: &[CurveRow]) -> Result<(), Failure> {
    if rows.iter().any(|row| row.error.is_empty()) {
        return Ok(());
    }
    let reason = rows
        .first()
        .map(|row| row.error.as_str())
        .unwrap_or_default();
    let message = format!(
        "none of {} curves is fitted; the first one: {reason}",
        rows.len()
    );
    let files = curves
        .iter()
        .filter(|curve| curve.1.is_none())
        .map(|curve| PathBuf::from(&curve.0));
    Err(Failure::of_files(&files.collect::<Vec<_>>(), message))
}

/// Fits a scene to one curve, to each of several, or on random profiles to all together; the words
/// are options of `asperity fit`.
#[pyfunction]
pub fn fit(
    py: Python<'_>,
    call: Call,
    curves: (Vec<Curve>, bool),
    words: Vec<String>,
) -> PyResult<Report> {
    let (curves, is_one) = curves;
    call.computed(py, |case| {
        case.check_files()?;
        let Some(Command::Fit(arguments)) = command("fit", words)? else {
            return Err("fit: no options of a fit".to_owned().into());
        };
        let document = case.document.clone();
        let free = arguments.free;
        let reading = CurveOptions {
            instrument: document.scene().loading_stiffness,
            ..arguments.reading
        };
        let computed_curves = |computed: &u64| Some(*computed);
        if let Some(lines) = arguments.ensemble.lines {
            let options = arguments
                .ensemble
                .options(&free, lines)
                .map_err(|error| error.to_string())?;
            let curves = curves
                .iter()
                .map(|curve| Ok((curve.0.clone(), curve.read(&reading)?)));
            let curves = curves.collect::<Result<Vec<_>, Failure>>()?;
            let fit = case.watched(0, computed_curves, |control| {
                fit_ensemble(&curves, &document, &options, control)
            })?;
            let has_roughness_errors =
                options.height_error.is_some() || options.hurst_error.is_some();
            return Ok(Report::new(move |format| {
                let (title, fit) = (document.title(), &fit);
                bytes(
                    Some(&document),
                    &EnsembleFitReport {
                        title,
                        fit,
                        has_roughness_errors,
                    },
                    format,
                )
            }));
        }
        let fit = free.iter().copied().fold(Fit::of(&document), Fit::free);
        if let ([curve], true) = (&curves[..], is_one) {
            let (title, curve) = (curve.0.clone(), curve.read(&reading)?);
            let fit = case.watched(0, computed_curves, |control| fit.run(&curve, control))?;
            return Ok(Report::new(move |format| {
                bytes(
                    Some(&fit.document),
                    &FitReport {
                        title: &title,
                        curve: &curve,
                        fit: &fit,
                    },
                    format,
                )
            }));
        }
        let watch = case.watch;
        let stop = || watch.stop();
        let (done, all) = (AtomicU64::new(0), curves.len() as u64);
        let worker = || {
            |number: u64| {
                let (given, control) = (
                    &curves[number as usize],
                    Control::default().stopped_by(&stop),
                );
                let row = CurveRow::of(
                    &given.0,
                    given.read(&reading).map_err(|failure| failure.message()),
                    &fit,
                    control,
                );
                watch.report(1 + done.fetch_add(1, Ordering::Relaxed), all);
                if stop() {
                    Err("stopped".to_owned())
                } else {
                    Ok(row)
                }
            }
        };
        let rows = on_threads(all, case.jobs, worker)?;
        check_any_fitted(&curves, &rows)?;
        let is_free = |one: &Parameter| free.iter().any(|free: &Free| free.parameter == *one);
        let free: Vec<Parameter> = Parameter::ALL.into_iter().filter(is_free).collect();
        Ok(Report::new(move |format| {
            bytes(
                Some(&document),
                &FitsReport {
                    scene: document.scene(),
                    free: &free,
                    rows: &rows,
                },
                format,
            )
        }))
    })
}
