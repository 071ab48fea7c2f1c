//! The catalogue of checks: claims about scenes and profiles, each with its evidence and a bound, judged on this machine
//! through the public interface alone.
//!
//! A row returns one number, the error, against a bound that is stated beforehand. Its evidence is a closed form, the
//! stepwise solver, which applies the rules without tree and thresholds, or a law of every body. A row that cannot be
//! computed fails with a sentence about the place.

mod body;
mod closed_forms;
pub mod exhaustive;
mod hard_cases;
mod laws;

use crate::Error;
use crate::scene::{Document, Edges, Scene, open};
use crate::simulation::Outcome;
use body::Body;
use serde::Serialize;
use std::time::Instant;
use strum::IntoStaticStr;
use thiserror::Error as ThisError;

/// Reason why a case returned no number.
#[derive(Debug, ThisError)]
pub enum Fault {
    /// A claim does not hold.
    #[error("{0}")]
    Wrong(String),
    /// A scene or a profile could not be computed.
    #[error(transparent)]
    Failed(Box<Error>),
}

impl<E: Into<Error>> From<E> for Fault {
    fn from(error: E) -> Self {
        Fault::Failed(Box::new(error.into()))
    }
}

/// Returns a fault unless `holds`.
fn ensure(holds: bool, what: impl FnOnce() -> String) -> Result<(), Fault> {
    if holds { Ok(()) } else { Err(Fault::Wrong(what())) }
}

/// Family of cases.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Family {
    /// Bodies with a known loop.
    ClosedForms,
    /// Laws valid for every body.
    Laws,
    /// Input at the limits of numbers and of the rules.
    HardCases,
}

/// Kind of evidence of a case.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, IntoStaticStr)]
#[serde(rename_all = "kebab-case")]
pub enum Evidence {
    /// A closed form of the literature or of this model.
    #[strum(serialize = "closed form")]
    ClosedForm,
    /// The same quantity from another computation.
    #[strum(serialize = "independent computation")]
    IndependentComputation,
    /// A law for the result: mirror, scaling, memory, energy.
    #[strum(serialize = "self-consistency")]
    SelfConsistency,
}

/// Input of a case and measurement of its error.
#[derive(Clone, Copy, Debug)]
enum Subject {
    /// A scene, as text or by the name of a built-in one.
    Scene(&'static str, fn(&Scene) -> Result<f64, Fault>),
    /// Random bodies: self-affine profiles, noise, few levels. The largest error counts.
    Bodies(fn(&Body) -> Result<f64, Fault>),
}

/// A row of the catalogue.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    /// Name: words with hyphens.
    pub name: &'static str,
    /// Family.
    pub family: Family,
    /// Claim, one sentence.
    pub holds: &'static str,
    /// Kinds of evidence, the strongest first.
    pub evidence: &'static [Evidence],
    /// Quantity of the error.
    pub error_of: &'static str,
    /// Bounds of the edge models.
    bounds: &'static [(Edges, f64)],
    /// True for a case that takes seconds and hundreds of megabytes.
    pub large: bool,
    subject: Subject,
}

impl Case {
    /// Creates a row of one of the tables.
    const fn row(
        (family, evidence): (Family, &'static [Evidence]),
        [name, holds, error_of]: [&'static str; 3],
        bounds: &'static [(Edges, f64)],
        subject: Subject,
    ) -> Case {
        Case { name, family, holds, evidence, error_of, bounds, large: false, subject }
    }
}

/// Bounds for edges at the springs and between them.
const fn both(grid: f64, sub_cell: f64) -> [(Edges, f64); 2] {
    [(Edges::Grid, grid), (Edges::SubCell, sub_cell)]
}

/// A case with one edge model.
#[derive(Clone, Copy, Debug)]
pub struct Check {
    /// The case.
    pub case: Case,
    /// Edge model.
    pub edges: Edges,
    /// Largest error allowed.
    pub bound: f64,
}

/// Result of a check.
#[derive(Debug)]
pub struct Verdict {
    /// Check.
    pub check: Check,
    /// The error, or the reason why there is none.
    pub error: Result<f64, Fault>,
    /// Time, s.
    pub seconds: f64,
}

impl Verdict {
    /// Returns true if the case holds.
    #[must_use]
    pub fn passes(&self) -> bool {
        // NaN is not within any bound.
        self.error.as_ref().is_ok_and(|&error| error <= self.check.bound)
    }
}

/// Returns all cases in the order of display.
#[must_use]
pub fn catalogue() -> Vec<Case> {
    [closed_forms::CASES, laws::CASES, hard_cases::CASES].concat()
}

/// Returns all checks of the cases selected by `choose`.
#[must_use]
pub fn checks(choose: impl Fn(&Case) -> bool) -> Vec<Check> {
    let of = |case: Case| case.bounds.iter().map(move |&(edges, bound)| Check { case, edges, bound });
    catalogue().into_iter().filter(|case| choose(case)).flat_map(of).collect()
}

/// Runs a check.
#[must_use]
pub fn judge(check: Check) -> Verdict {
    let clock = Instant::now();
    let edges = check.edges;
    let error = match check.case.subject {
        Subject::Scene(text, measure) => scene(text, edges).and_then(|scene| measure(&scene)),
        Subject::Bodies(measure) => {
            largest((0..body::RANDOM).map(|seed| measure(&Body::random(seed, edges)?)))
        }
    };
    Verdict { check, error, seconds: clock.elapsed().as_secs_f64() }
}

fn scene(text: &str, edges: Edges) -> Result<Scene, Fault> {
    let document = if text.starts_with('(') { Document::parse(text, "check")? } else { open(text)? };
    let mut scene = document.scene().clone();
    scene.numerics.edges = edges;
    Ok(scene)
}

/// Returns the scene with another value of a field.
fn with(scene: &Scene, path: &str, value: f64) -> Result<Scene, Fault> {
    Ok(Document::from_scene(scene, "check")?.set(path, &format!("{value:e}"))?.scene().clone())
}

fn outcome(scene: &Scene) -> Result<Outcome, Fault> {
    Ok(crate::run(scene)?)
}

fn relative_error(found: f64, expected: f64) -> f64 {
    (found / expected - 1.0).abs()
}

/// Returns the largest of errors; NaN counts as infinite.
fn largest(errors: impl IntoIterator<Item = Result<f64, Fault>>) -> Result<f64, Fault> {
    errors.into_iter().try_fold(0.0, |most: f64, error| {
        let error = error?;
        Ok(if error.is_nan() { f64::INFINITY } else { most.max(error) })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cases_have_names_of_their_own_and_sentences() {
        let mut names: Vec<_> = catalogue().iter().map(|case| case.name).collect();
        let count = names.len();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), count);
        for case in catalogue() {
            assert!(case.holds.ends_with('.') && !case.holds.contains("  "), "{}", case.holds);
            assert!(!case.evidence.is_empty() && !case.bounds.is_empty(), "{}", case.name);
        }
        assert!(checks(|_| true).iter().all(|check| check.bound >= 0.0));
    }

    #[test]
    fn an_error_above_the_bound_fails() {
        let check = checks(|case| case.name == "hertz-sphere")[0];
        assert!(judge(check).passes());
        assert!(!judge(Check { bound: 1e-12, ..check }).passes());
        let nothing = Verdict { check, error: Ok(f64::NAN), seconds: 0.0 };
        assert!(!nothing.passes());
    }
}
