//! A row of the catalogue of checks, and what its measurements share.

use super::body::{Body, Measured};
use crate::scene::{Document, Edges, Scene};
use crate::simulation::Outcome;

/// Evidence: a closed form of the literature or of this model.
pub(super) const CLOSED_FORM: &str = "closed form";
/// Evidence: the same quantity from another computation.
pub(super) const INDEPENDENT: &str = "independent computation";
/// Evidence: a law for the result, such as mirror, scaling, memory or energy.
pub(super) const SELF_CONSISTENCY: &str = "self-consistency";

/// Input of a case and measurement of its error.
#[derive(Clone, Copy, Debug)]
pub(super) enum Subject {
    /// The text of a scene.
    Scene(&'static str, fn(&Scene) -> Measured),
    /// Random bodies: self-affine profiles, noise, few levels. The largest error counts.
    Bodies(fn(&Body) -> Measured),
}

#[derive(Clone, Copy, Debug)]
pub struct Case {
    /// Name: words with hyphens.
    pub name: &'static str,
    /// Family: bodies with a known loop, laws valid for every body, or input at the limits of numbers and of the rules.
    pub family: &'static str,
    pub holds: &'static str,
    pub evidence: &'static str,
    pub error_of: &'static str,
    pub(super) bounds: &'static [(Edges, f64)],
    /// True for a case that takes seconds and hundreds of megabytes.
    pub large: bool,
    pub(super) subject: Subject,
}

impl Case {
    /// Creates a row of one of the tables.
    pub(super) const fn row(
        [family, evidence]: [&'static str; 2],
        [name, holds, error_of]: [&'static str; 3],
        bounds: &'static [(Edges, f64)],
        subject: Subject,
    ) -> Case {
        Case { name, family, holds, evidence, error_of, bounds, large: false, subject }
    }
}

/// Bounds for edges at the springs and between them.
pub(super) const fn both(grid: f64, sub_cell: f64) -> [(Edges, f64); 2] {
    [(Edges::Grid, grid), (Edges::SubCell, sub_cell)]
}

/// Returns the scene with another value of a field.
pub(super) fn with(scene: &Scene, path: &str, value: f64) -> Measured<Scene> {
    Ok(Document::from_scene(scene, "check")?.set(path, &format!("{value:e}"))?.scene().clone())
}

pub(super) fn outcome(scene: &Scene) -> Measured<Outcome> {
    Ok(crate::run(scene)?)
}

/// Returns an error unless `holds`.
pub(super) fn ensure(holds: bool, what: impl FnOnce() -> String) -> Measured<()> {
    if holds { Ok(()) } else { Err(what().into()) }
}

pub(super) fn relative_error(found: f64, expected: f64) -> f64 {
    (found / expected - 1.0).abs()
}

/// Returns the largest relative error of values from their expected ones.
pub(super) fn relative_errors<const N: usize>(pairs: [(f64, f64); N]) -> Measured {
    largest(pairs.map(|(found, expected)| Ok(relative_error(found, expected))))
}

/// Returns the largest of errors; NaN counts as infinite.
pub(super) fn largest(errors: impl IntoIterator<Item = Measured>) -> Measured {
    errors.into_iter().try_fold(0.0, |most: f64, error| {
        let error = error?;
        Ok(if error.is_nan() { f64::INFINITY } else { most.max(error) })
    })
}
