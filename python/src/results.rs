//! Results of scenes: the functions of the libraries, and the reports of the program as their answers.

use crate::computing::{Watch, computed};
use crate::failure::Failure;
use crate::force_loop::Loop;
use crate::profile::Profile;
use crate::report::{Report, of_scene};
use crate::scene::Scene;
use asperity::data::{Control, parallel};
use asperity::scene::{Document, Simulation, estimate};
use asperity::study::half_space::{Reference, ReferenceEvent, ReferenceOptions};
use asperity::study::plans::{parse_condition, parse_preloads, parse_range};
use asperity::study::trust::MeasuredAdhesion;
use asperity::study::{Ensemble, Found, Plan, Quantity, Question, Results, Staircase, compute};
use asperity_report::{FindReport, PreloadReport, ReferenceReport, ReversalReport, RunReport};
use pyo3::prelude::*;
use std::sync::Arc;

/// Largest number of springs for which the error by the spectrum of a measured surface is computed unasked.
const MOST_SPRINGS: u64 = 1 << 17;

/// Number of profiles, number of threads, and the callback of the progress; each may be left to the program.
#[derive(FromPyObject)]
pub struct Call(Option<u64>, Option<usize>, Option<Py<PyAny>>);

impl Call {
    /// The number of profiles of a scene, the number of threads, and the callback.
    fn of(self, scene: &Scene) -> (u64, usize, Option<Py<PyAny>>) {
        let profiles = self.0.unwrap_or_else(|| Ensemble::profiles_of(scene.document.scene()));
        (profiles, self.1.unwrap_or_else(parallel::threads), self.2)
    }
}

/// Computes a report of a scene on a number of profiles and threads.
fn reported(
    py: Python<'_>,
    scene: &Scene,
    call: Call,
    work: impl FnOnce(Document, (u64, usize), &Watch) -> Result<Report, Failure> + Send,
) -> PyResult<Report> {
    let (document, (profiles, jobs, progress)) = (scene.document.clone(), call.of(scene));
    computed(py, progress, move |watch| work(document, (profiles, jobs), watch))
}

/// The results of a scene on its random profiles.
fn on_profiles(
    document: &Document,
    (profiles, is_asked): (u64, bool),
    jobs: usize,
    watch: &Watch,
) -> Result<Ensemble, Failure> {
    let further = if is_asked { &Ensemble::FURTHER[..] } else { &[] };
    let simulation = Simulation::new(document.resolve(""));
    let mut report = |computed: u64, _: &dyn Fn() -> Ensemble| watch.report(computed, profiles);
    Ok(Ensemble::of(document.scene(), further, profiles, (simulation, jobs), &|| watch.stop(), &mut report)?)
}

/// Computes a scene: its report, its profile and its loop.
#[pyfunction]
pub fn run(py: Python<'_>, scene: &Scene, call: Call) -> PyResult<(Report, Profile, Loop)> {
    let (document, is_asked) = (scene.document.clone(), call.0.is_some());
    let (profiles, jobs, progress) = call.of(scene);
    computed(py, progress, move |watch| {
        let (stop, scene) = (|| watch.stop(), document.scene());
        let mut simulation = Simulation::new(document.resolve("")).for_one_scene();
        let outcome = Arc::new(simulation.run(scene, &stop, &mut |_, _, _| Ok(()))?);
        let profile = simulation.profile(scene)?;
        let on_profiles = || on_profiles(&document, (profiles, is_asked), jobs, watch);
        let ensemble = (profiles > 1).then(on_profiles).transpose()?;
        let estimate = estimate(scene, &document.resolve(""), &outcome, &stop);
        let is_measured = scene.measured().is_some() && scene.numerics.points <= MOST_SPRINGS;
        let deviation = ensemble
            .as_ref()
            .filter(|_| is_measured)
            .and_then(|_| MeasuredAdhesion::of(&document, profiles as u32, jobs).ok()?.fit_deviation());
        let (kept, computed) = (document.clone(), Arc::clone(&outcome));
        let report = Report::new(move |format| {
            let (title, scene, outcome) = (kept.title(), kept.scene(), &*computed);
            let (estimate, ensemble) = (estimate.as_ref(), ensemble.as_ref());
            let report = RunReport { title, scene, outcome, choice: None, estimate, ensemble, deviation };
            of_scene(&kept, &report, format)
        });
        Ok((report, Profile { profile }, Loop::of_scene(document, outcome)))
    })
}

/// Computes a scene on random profiles.
#[pyfunction]
pub fn ensemble(py: Python<'_>, scene: &Scene, call: Call) -> PyResult<Report> {
    reported(py, scene, call, move |document, (profiles, jobs), watch| {
        let ensemble = on_profiles(&document, (profiles, true), jobs, watch)?;
        Ok(Report::new(move |format| of_scene(&document, &ensemble, format)))
    })
}

/// Finds the number of a scene at which a quantity has a value.
#[pyfunction]
pub fn find(
    py: Python<'_>,
    scene: &Scene,
    field: &str,
    condition: &str,
    range: Option<&str>,
    call: Call,
) -> PyResult<Report> {
    reported(py, scene, call, move |document, (profiles, jobs), watch| {
        let (scene, condition) = (document.scene(), parse_condition(condition)?);
        let mut simulation = Simulation::new(document.resolve(""));
        let mut question = Question::new(scene, field, condition, profiles, &mut simulation)?;
        if let Some(range) = range {
            question.searched = parse_range(range, question.axis.unit)?;
        }
        let mut report = |done| watch.report(done, profiles);
        let found = Found::of(question, (simulation, jobs), &|| watch.stop(), &mut report)?;
        Ok(Report::new(move |format| {
            let (title, scene, found) = (document.title(), document.scene(), &found);
            of_scene(&document, &FindReport { title, scene, found }, format)
        }))
    })
}

/// Computes the adhesion force of a scene over preloads, as `asperity run --preloads` takes them.
#[pyfunction]
pub fn preloads(py: Python<'_>, scene: &Scene, preloads: &str, call: Call) -> PyResult<Report> {
    reported(py, scene, call, move |document, (profiles, jobs), watch| {
        let (stop, axis) = (|| watch.stop(), parse_preloads(preloads)?);
        let mut simulation = Simulation::new(document.resolve(""));
        let staircase = Staircase::find(document.scene(), &axis, &mut simulation, &stop, &mut |_| ())?;
        let mut results = Results::begin(document.scene(), &Results::OF_PRELOADS, profiles, Some(&axis))?;
        let mut done = 0;
        results.extend((simulation, jobs), &stop, &mut |_| {
            done += 1;
            watch.report(done, profiles);
        })?;
        Ok(Report::new(move |format| {
            let (title, results, staircase) = (document.title(), &results, Some(&staircase));
            let report = PreloadReport { title, choice: None, results, staircase, curves: false };
            of_scene(&document, &report, format)
        }))
    })
}

/// Computes the unloading of a scene from each of many turning points.
#[pyfunction]
pub fn reversals(
    py: Python<'_>,
    scene: &Scene,
    range: Option<&str>,
    count: usize,
    call: Call,
) -> PyResult<Report> {
    reported(py, scene, call, move |document, _, watch| {
        let ends = range.map(|range| parse_range(range, "N")).transpose()?;
        let mut simulation = Simulation::new(document.resolve("")).for_one_scene();
        let map = simulation.reversal_map(document.scene(), ends, count, &|| watch.stop())?;
        Ok(Report::new(move |format| {
            let (title, scene) = (document.title(), document.scene());
            let report = ReversalReport { title, scene, map: &map, preloads: None, staircase: None };
            of_scene(&document, &report, format)
        }))
    })
}

/// Computes a scene as a line and in three dimensions, on squares of `cells` along a side.
#[pyfunction]
pub fn reference(py: Python<'_>, scene: &Scene, cells: usize, maps: u64, call: Call) -> PyResult<Report> {
    let lines = call.0.unwrap_or(16 * maps);
    reported(py, scene, call, move |document, (_, jobs), watch| {
        let (options, mut done) = (ReferenceOptions { cells, maps, lines }, 0);
        let mut report = |event| {
            if let ReferenceEvent::Square { .. } = event {
                done += 1;
                watch.report(done, maps);
            }
        };
        let simulation = (Simulation::new(document.resolve("")), jobs);
        let found = Reference::of(document.scene(), options, simulation, &|| watch.stop(), &mut report)?;
        Ok(Report::new(move |format| {
            let (title, scene, reference) = (document.title(), document.scene(), &found);
            of_scene(&document, &ReferenceReport { title, scene, reference }, format)
        }))
    })
}

/// Computes a scene for all combinations of values on axes, on random profiles of each.
#[pyfunction]
pub fn study(
    py: Python<'_>,
    scene: &Scene,
    axes: Vec<(String, Vec<f64>)>,
    record: Vec<String>,
    call: Call,
) -> PyResult<Report> {
    reported(py, scene, call, move |document, (profiles, jobs), watch| {
        let record = record.iter().map(|name| Quantity::named(name)).collect::<Result<Vec<_>, _>>()?;
        let axes: Vec<_> = axes.iter().map(|(path, values)| (path.as_str(), values.as_slice())).collect();
        let plan = Plan::new(&document, &axes, profiles, &record)?;
        let (stop, all) = (|| watch.stop(), plan.records_in_all());
        let mut report = |done| watch.report(done, all);
        let control = Control::default().on_threads(jobs).stopped_by(&stop).reporting_to(&mut report);
        let results = compute(&plan, control)?;
        Ok(Report::new(move |format| of_scene(&document, &results, format)))
    })
}
