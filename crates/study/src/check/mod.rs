//! The catalogue of checks: scenes and profiles with known results, which are computed with the
//! public functions of the library.
//!
//! A check computes one number, the error of a result, and compares it with a fixed bound. The
//! correct result is known from a closed form, from a law that holds for every body, or from the
//! stepwise solver. The stepwise solver applies the rules of contact directly, without the contact
//! tree.

pub(crate) mod case;
pub(crate) mod closed_forms;
pub(crate) mod hard_cases;
pub(crate) mod laws;

use asperity_contact::Edges;
use asperity_scene::{CheckedScene, Document};
use case::Case;
use case::{Body, Measured, Subject, largest};
use std::time::Instant;

/// Test of the program on a [`Case`], which has a known result. The case is computed with one rule
/// for the edges of patches of contact. The check passes if the error of the result is at most
/// [`Check::bound`].
#[derive(Clone, Copy, Debug)]
pub struct Check {
    /// Case that the check computes.
    pub case: Case,
    /// Rule for the edges of patches of contact: an edge lies at a spring, or may lie between two
    /// springs.
    pub edges: Edges,
    /// Largest error with which the check passes. It is an error of the quantity
    /// [`Case::error_of`].
    pub bound: f64,
}

impl Check {
    /// Returns the checks of all cases for which `choose` returns true.
    ///
    /// ```
    /// use asperity_study::checks::Check;
    ///
    /// let verdicts: Vec<_> = Check::of(|case| case.name == "jkr")
    ///     .into_iter()
    ///     .map(Check::judge)
    ///     .collect();
    /// assert!(verdicts.iter().all(|verdict| verdict.passes()));
    /// ```
    pub fn of(choose: impl Fn(&Case) -> bool) -> Vec<Check> {
        let mut checks = Vec::new();
        for case in Case::all() {
            if !choose(&case) {
                continue;
            }
            for &(edges, bound) in case.bounds {
                checks.push(Check { case, edges, bound });
            }
        }
        checks
    }

    /// Computes the case and measures the error of its result, in the quantity [`Case::error_of`].
    pub fn judge(self) -> Verdict {
        let clock = Instant::now();
        let edges = self.edges;
        let error = match self.case.subject {
            Subject::Scene(text, measure) => scene(text, edges).and_then(|scene| measure(&scene)),
            Subject::Bodies(measure) => {
                largest((0..case::RANDOM).map(|seed| measure(&Body::random(seed, edges)?)))
            }
        };
        Verdict {
            check: self,
            error: error.map_err(|error| error.to_string()),
            seconds: clock.elapsed().as_secs_f64(),
        }
    }
}

impl Case {
    /// Returns all cases in the order in which `asperity check` shows them.
    pub fn all() -> Vec<Case> {
        [closed_forms::CASES, laws::CASES, hard_cases::CASES].concat()
    }
}

/// Result of a [`Check`]: the measured error of the case and the computing time.
#[derive(Debug)]
pub struct Verdict {
    /// Check to which this result belongs.
    pub check: Check,
    /// Measured error of the result, in the quantity [`Case::error_of`], or the reason why the
    /// error could not be measured.
    pub error: Result<f64, String>,
    /// Computing time of the check, s.
    pub seconds: f64,
}

impl Verdict {
    /// Returns true if the error was measured and is at most [`Check::bound`].
    pub fn passes(&self) -> bool {
        // A comparison with NaN is false, so NaN does not pass.
        self.error
            .as_ref()
            .is_ok_and(|&error| error <= self.check.bound)
    }
}

fn scene(text: &str, edges: Edges) -> Measured<CheckedScene> {
    Ok(Document::parse(text, "check")?
        .scene()
        .with(|scene| scene.numerics.edges = edges)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cases_have_names_of_their_own_and_sentences() {
        let mut names: Vec<_> = Case::all().iter().map(|case| case.name).collect();
        let count = names.len();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), count);
        for case in Case::all() {
            assert!(
                case.holds.ends_with('.') && !case.holds.contains("  "),
                "{}",
                case.holds
            );
            assert!(!case.bounds.is_empty(), "{}", case.name);
        }
        assert!(Check::of(|_| true).iter().all(|check| check.bound >= 0.0));
    }

    #[test]
    fn an_error_above_the_bound_fails() {
        let check = Check::of(|case| case.name == "hertz-sphere")[0];
        assert!(Check::judge(check).passes());
        assert!(
            !Check::judge(Check {
                bound: 1e-12,
                ..check
            })
            .passes()
        );
        let nothing = Verdict {
            check,
            error: Ok(f64::NAN),
            seconds: 0.0,
        };
        assert!(!nothing.passes());
    }
}
