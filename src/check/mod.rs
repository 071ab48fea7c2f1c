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

use crate::scene::{Document, Edges, Scene};
use crate::simulation::Outcome;
use body::Body;
use std::error::Error;
use std::time::Instant;

/// Error of a case, or the reason why there is none.
type Measured<T = f64> = Result<T, Box<dyn Error>>;

/// Evidence: a closed form of the literature or of this model.
const CLOSED_FORM: &str = "closed form";
/// Evidence: the same quantity from another computation.
const INDEPENDENT: &str = "independent computation";
/// Evidence: a law for the result, such as mirror, scaling, memory or energy.
const SELF_CONSISTENCY: &str = "self-consistency";

/// Input of a case and measurement of its error.
#[derive(Clone, Copy, Debug)]
enum Subject {
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
    bounds: &'static [(Edges, f64)],
    /// True for a case that takes seconds and hundreds of megabytes.
    pub large: bool,
    subject: Subject,
}

impl Case {
    /// Creates a row of one of the tables.
    const fn row(
        [family, evidence]: [&'static str; 2],
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

#[derive(Clone, Copy, Debug)]
pub struct Check {
    pub case: Case,
    pub edges: Edges,
    pub bound: f64,
}

#[derive(Debug)]
pub struct Verdict {
    pub check: Check,
    /// The error, or the reason why there is none.
    pub error: Result<f64, String>,
    /// Time, s.
    pub seconds: f64,
}

impl Verdict {
    /// Returns true if the case holds.
    pub fn passes(&self) -> bool {
        // NaN is not within any bound.
        self.error.as_ref().is_ok_and(|&error| error <= self.check.bound)
    }
}

/// Returns all cases in the order of display.
pub fn catalogue() -> Vec<Case> {
    [closed_forms::CASES, laws::CASES, hard_cases::CASES].concat()
}

/// Returns all checks of the cases selected by `choose`.
pub fn checks(choose: impl Fn(&Case) -> bool) -> Vec<Check> {
    let of = |case: Case| case.bounds.iter().map(move |&(edges, bound)| Check { case, edges, bound });
    catalogue().into_iter().filter(|case| choose(case)).flat_map(of).collect()
}

pub fn judge(check: Check) -> Verdict {
    let (clock, edges) = (Instant::now(), check.edges);
    let error = match check.case.subject {
        Subject::Scene(text, measure) => scene(text, edges).and_then(|scene| measure(&scene)),
        Subject::Bodies(measure) => {
            largest((0..body::RANDOM).map(|seed| measure(&Body::random(seed, edges)?)))
        }
    };
    Verdict { check, error: error.map_err(|error| error.to_string()), seconds: clock.elapsed().as_secs_f64() }
}

fn scene(text: &str, edges: Edges) -> Measured<Scene> {
    let mut scene = Document::parse(text, "check")?.scene().clone();
    scene.numerics.edges = edges;
    Ok(scene)
}

/// Returns the scene with another value of a field.
fn with(scene: &Scene, path: &str, value: f64) -> Measured<Scene> {
    Ok(Document::from_scene(scene, "check")?.set(path, &format!("{value:e}"))?.scene().clone())
}

fn outcome(scene: &Scene) -> Measured<Outcome> {
    Ok(crate::run(scene)?)
}

/// Returns an error unless `holds`.
fn ensure(holds: bool, what: impl FnOnce() -> String) -> Measured<()> {
    if holds { Ok(()) } else { Err(what().into()) }
}

fn relative_error(found: f64, expected: f64) -> f64 {
    (found / expected - 1.0).abs()
}

/// Returns the largest relative error of values from their expected ones.
fn relative_errors<const N: usize>(pairs: [(f64, f64); N]) -> Measured {
    largest(pairs.map(|(found, expected)| Ok(relative_error(found, expected))))
}

/// Returns the largest of errors; NaN counts as infinite.
fn largest(errors: impl IntoIterator<Item = Measured>) -> Measured {
    errors.into_iter().try_fold(0.0, |most: f64, error| {
        let error = error?;
        Ok(if error.is_nan() { f64::INFINITY } else { most.max(error) })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_check_of_the_catalogue_passes() {
        let mut failed = Vec::new();
        let checks = checks(|case| !case.large);
        assert!(checks.len() >= 30, "{} checks", checks.len());
        for check in checks {
            let verdict = judge(check);
            let error =
                verdict.error.as_ref().map_or_else(ToString::to_string, |error| format!("{error:.1e}"));
            let line = format!("{} {:?}: {error} against {:e}", check.case.name, check.edges, check.bound);
            println!("{line}, {:.1} s", verdict.seconds);
            if !verdict.passes() {
                failed.push(line);
            }
        }
        assert!(failed.is_empty(), "{}", failed.join("\n"));
    }

    #[test]
    fn cases_have_names_of_their_own_and_sentences() {
        let mut names: Vec<_> = catalogue().iter().map(|case| case.name).collect();
        let count = names.len();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), count);
        for case in catalogue() {
            assert!(case.holds.ends_with('.') && !case.holds.contains("  "), "{}", case.holds);
            assert!(!case.bounds.is_empty(), "{}", case.name);
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
