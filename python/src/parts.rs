//! Parts of ensembles and studies, which several processes compute, for calls from Python. A part
//! has some of the random profiles. It is sent as text from which the same bits are read again.

use crate::computing::{Call, Case};
use crate::failure::Failure;
use crate::results::{Report, StudyDesign, bytes, named, plan_of_study};
use crate::scene::{Scene, read_again, written};
use asperity::data::Control;
use asperity::study::{Ensemble, Plan, Results, StudyPart, compute_part};
use pyo3::prelude::*;
use std::ops::Range;

fn plan_of_ensemble(case: &Case<'_>) -> Result<Plan, Failure> {
    case.check_profiles()?;
    // The plan has no folder, to which the names of measured files could be relative.
    let document = &case.document;
    let moved = document.moved_to(|file| document.resolve(file).display().to_string())?;
    Ok(Ensemble::plan(
        moved.scene(),
        &Ensemble::FURTHER,
        case.profiles,
    )?)
}

fn computed_part(case: &Case<'_>, plan: &Plan, lines: Range<u64>) -> Result<String, Failure> {
    let stop = || case.watch.stop();
    let control = Control::default().on_threads(case.jobs).stopped_by(&stop);
    let part = compute_part(plan, case.in_memory.clone(), lines, control)?;
    written(&part)
}

fn read_parts(parts: &[String]) -> Result<Vec<StudyPart>, Failure> {
    parts.iter().map(|part| read_again(part)).collect()
}

/// Returns the number of random profiles of an ensemble of a scene, if the caller states none.
#[pyfunction]
pub fn profiles_of(scene: &Scene) -> u64 {
    Ensemble::profiles_of(scene.document.scene())
}

/// Computes the random profiles of an ensemble from the index `first` up to `end`.
#[pyfunction]
pub fn ensemble_part(py: Python<'_>, call: Call, first: u64, end: u64) -> PyResult<String> {
    call.computed(py, move |case| {
        computed_part(&case, &plan_of_ensemble(&case)?, first..end)
    })
}

/// Gathers an ensemble from its parts.
#[pyfunction]
pub fn ensemble_of_parts(py: Python<'_>, call: Call, parts: Vec<String>) -> PyResult<Report> {
    call.computed(py, move |case| {
        let ensemble = Ensemble::of_parts(&plan_of_ensemble(&case)?, read_parts(&parts)?)?;
        Ok(Report::new(move |format| {
            bytes(named(&case.document, &case.in_memory), &ensemble, format)
        }))
    })
}

/// Computes the random profiles of a study from the index `first` up to `end`, in all its cells.
#[pyfunction]
pub fn study_part(
    py: Python<'_>,
    call: Call,
    design: StudyDesign,
    first: u64,
    end: u64,
) -> PyResult<String> {
    call.computed(py, move |case| {
        let plan = plan_of_study(&case, &design)?;
        computed_part(&case, &plan, first..end)
    })
}

/// Gathers a study from its parts.
#[pyfunction]
pub fn study_of_parts(
    py: Python<'_>,
    call: Call,
    design: StudyDesign,
    parts: Vec<String>,
) -> PyResult<Report> {
    call.computed(py, move |case| {
        let plan = plan_of_study(&case, &design)?;
        let results = Results::of_parts(&plan, read_parts(&parts)?)?;
        Ok(Report::new(move |format| {
            bytes(named(&case.document, &case.in_memory), &results, format)
        }))
    })
}
