//! Results of scenes: the functions of the libraries, and the reports of the program as their answers.

use crate::computing::{Watch, computed};
use crate::failure::Failure;
use crate::force_loop::Loop;
use crate::profile::{Profile, Shape};
use crate::report::{Report, bytes};
use crate::scene::Scene;
use asperity::data::parallel;
use asperity::scene::{Document, Simulation, estimate};
use asperity::study::{
    Ensemble, Found, MeasuredAdhesion, Question, Reference, ReferenceOptions, Results, Staircase,
    parse_condition, parse_preloads, parse_range,
};
use asperity_report::{
    FindReport, Format, PreloadReport, ReferenceReport, ReversalReport, RunReport, scene_provenance,
};
use pyo3::prelude::*;
use std::io;
use std::path::Path;
use std::sync::Arc;

/// Largest number of springs for which the error by the spectrum of a measured surface is computed unasked.
const MOST_SPRINGS: u64 = 1 << 17;

/// Number of threads: the given number, or one for each core.
fn threads(jobs: Option<usize>) -> usize {
    jobs.map_or_else(parallel::threads, |jobs| jobs.clamp(1, 1024))
}

/// A report of a scene as bytes; tables and figures state the scene.
fn of_scene(
    document: &Document,
    report: &impl asperity_report::Report,
    format: Format,
) -> io::Result<Vec<u8>> {
    let has_scene = matches!(format, Format::Csv | Format::Svg);
    let provenance = has_scene
        .then(|| scene_provenance("import asperity", document.scene(), &document.resolve(""), Path::new("")));
    let provenance = provenance.transpose().map_err(io::Error::other)?.unwrap_or_default();
    bytes(report, format, &provenance)
}

/// The results of a scene on its random profiles.
fn on_profiles(
    document: &Document,
    profiles: u64,
    is_asked: bool,
    jobs: usize,
    watch: &Watch,
) -> Result<Ensemble, Failure> {
    let further = if is_asked { &Ensemble::FURTHER[..] } else { &[] };
    let simulation = Simulation::new(document.resolve(""));
    let mut report = |so_far: &Ensemble| watch.report(so_far.computed(), profiles);
    Ok(Ensemble::of(document.scene(), further, profiles, (simulation, jobs), &|| watch.stop(), &mut report)?)
}

/// Computes a scene: its report, its profile and its loop.
#[pyfunction]
#[pyo3(signature = (scene, profiles=None, jobs=None, progress=None))]
pub fn run(
    py: Python<'_>,
    scene: &Scene,
    profiles: Option<u64>,
    jobs: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<(Report, Profile, Loop)> {
    let (document, jobs) = (scene.document.clone(), threads(jobs));
    computed(py, progress, move |watch| {
        let mut simulation = Simulation::new(document.resolve("")).for_one_scene();
        let stop = || watch.stop();
        let outcome = Arc::new(simulation.run(document.scene(), &stop, &mut |_, _, _| Ok(()))?);
        let line = simulation.make_line(document.scene())?.0.clone();
        drop(simulation);
        let count = profiles.unwrap_or_else(|| Ensemble::profiles_of(document.scene()));
        let ensemble = (count > 1)
            .then(|| on_profiles(&document, count, profiles.is_some(), jobs, watch))
            .transpose()?;
        let estimate = estimate(document.scene(), &document.resolve(""), &outcome, &stop);
        let is_measured =
            document.scene().measured().is_some() && document.scene().numerics.points <= MOST_SPRINGS;
        let deviation = ensemble
            .as_ref()
            .filter(|_| is_measured)
            .and_then(|_| MeasuredAdhesion::of(&document, count as u32, jobs).ok()?.fit_deviation());
        let (kept, computed) = (document.clone(), Arc::clone(&outcome));
        let report = Report::new(move |format| {
            let report = RunReport {
                title: kept.title(),
                scene: kept.scene(),
                outcome: &computed,
                choice: None,
                estimate: estimate.as_ref(),
                ensemble: ensemble.as_ref(),
                deviation,
            };
            of_scene(&kept, &report, format)
        });
        let profile = Profile { shape: Shape::Scene(line, document.clone()) };
        Ok((report, profile, Loop::of_scene(document, outcome)))
    })
}

/// Computes a scene on random profiles.
#[pyfunction]
#[pyo3(signature = (scene, profiles=None, jobs=None, progress=None))]
pub fn ensemble(
    py: Python<'_>,
    scene: &Scene,
    profiles: Option<u64>,
    jobs: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Report> {
    let (document, jobs) = (scene.document.clone(), threads(jobs));
    computed(py, progress, move |watch| {
        let count = profiles.unwrap_or_else(|| Ensemble::profiles_of(document.scene()));
        let ensemble = on_profiles(&document, count, true, jobs, watch)?;
        Ok(Report::new(move |format| of_scene(&document, &ensemble, format)))
    })
}

/// Finds the number of a scene at which a quantity has a value.
#[pyfunction]
#[pyo3(signature = (scene, field, condition, range=None, profiles=None, jobs=None, progress=None))]
#[expect(clippy::too_many_arguments, reason = "arguments of a function of Python, which has names for them")]
pub fn find(
    py: Python<'_>,
    scene: &Scene,
    field: &str,
    condition: &str,
    range: Option<&str>,
    profiles: Option<u64>,
    jobs: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Report> {
    let (document, jobs) = (scene.document.clone(), threads(jobs));
    computed(py, progress, move |watch| {
        let condition = parse_condition(condition).map_err(Failure::Value)?;
        let count = profiles.unwrap_or_else(|| Ensemble::profiles_of(document.scene()));
        let mut simulation = Simulation::new(document.resolve(""));
        let mut question = Question::new(document.scene(), field, condition, count, &mut simulation)?;
        if let Some(range) = range {
            question.searched = parse_range(range, question.axis.unit).map_err(Failure::Value)?;
        }
        let stop = || watch.stop();
        let found = Found::of(question, (simulation, jobs), &stop, &mut |done| watch.report(done, count))?;
        Ok(Report::new(move |format| {
            let report = FindReport { title: document.title(), scene: document.scene(), found: &found };
            of_scene(&document, &report, format)
        }))
    })
}

/// Computes the adhesion force of a scene over the preload: `0..20uN:64`, with `:log` at equal ratios.
#[pyfunction]
#[pyo3(signature = (scene, preloads, profiles=1, jobs=None, progress=None))]
pub fn preloads(
    py: Python<'_>,
    scene: &Scene,
    preloads: &str,
    profiles: u64,
    jobs: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Report> {
    let (document, jobs) = (scene.document.clone(), threads(jobs));
    computed(py, progress, move |watch| {
        let axis = parse_preloads(preloads).map_err(Failure::Value)?;
        let stop = || watch.stop();
        let mut simulation = Simulation::new(document.resolve(""));
        let staircase = Staircase::find(document.scene(), &axis, &mut simulation, &stop, &mut |_| ())?;
        let mut results = Results::begin(document.scene(), &Results::OF_PRELOADS, profiles, Some(&axis))?;
        results.extend((simulation, jobs), &stop, &mut |_| ())?;
        Ok(Report::new(move |format| {
            let (title, results, staircase) = (document.title(), &results, Some(&staircase));
            let report = PreloadReport { title, choice: None, results, staircase, curves: false };
            of_scene(&document, &report, format)
        }))
    })
}

/// Computes the unloading of a scene from each of many turning points.
#[pyfunction]
#[pyo3(signature = (scene, range=None, count=64, progress=None))]
pub fn reversals(
    py: Python<'_>,
    scene: &Scene,
    range: Option<&str>,
    count: usize,
    progress: Option<Py<PyAny>>,
) -> PyResult<Report> {
    let document = scene.document.clone();
    computed(py, progress, move |watch| {
        let ends = range.map(|range| parse_range(range, "N")).transpose().map_err(Failure::Value)?;
        let mut simulation = Simulation::new(document.resolve("")).for_one_scene();
        let map = simulation.reversal_map(document.scene(), ends, count, &|| watch.stop())?;
        Ok(Report::new(move |format| {
            let (title, scene) = (document.title(), document.scene());
            let report = ReversalReport { title, scene, map: &map, preloads: None, staircase: None };
            of_scene(&document, &report, format)
        }))
    })
}

/// Computes a scene as a line and in three dimensions.
#[pyfunction]
#[pyo3(signature = (scene, grid=64, maps=24, profiles=None, jobs=None, progress=None))]
pub fn reference(
    py: Python<'_>,
    scene: &Scene,
    grid: usize,
    maps: u64,
    profiles: Option<u64>,
    jobs: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Report> {
    let (document, jobs) = (scene.document.clone(), threads(jobs));
    computed(py, progress, move |watch| {
        let lines = profiles.unwrap_or(16 * maps);
        let done = std::sync::atomic::AtomicU64::new(0);
        let report = || watch.report(1 + done.fetch_add(1, std::sync::atomic::Ordering::Relaxed), maps);
        let options = ReferenceOptions { cells: grid, maps, lines };
        let found = Reference::of(document.scene(), options, jobs, &|| watch.stop(), &report)?;
        Ok(Report::new(move |format| {
            let report =
                ReferenceReport { title: document.title(), scene: document.scene(), reference: &found };
            of_scene(&document, &report, format)
        }))
    })
}
