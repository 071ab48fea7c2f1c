//! The list of cases, and the verdict on each.

use super::Fault;
use super::case::{Case, Family, Scope};
use super::cases::{adhesion, closed_forms, laws, lines, scales};
use crate::scene::Edges;
use std::time::Instant;

/// A case with one kind of edges, or none.
#[derive(Clone, Copy, Debug)]
pub struct Check {
    /// The case.
    pub case: Case,
    /// Kind of edges, where it matters.
    pub edges: Option<Edges>,
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
        // NaN is no error within the bound.
        self.error.as_ref().is_ok_and(|&error| error <= self.check.bound)
    }
}

/// All cases, in the order of display.
#[must_use]
pub fn catalogue() -> Vec<Case> {
    let families = [
        (Family::Adhesion, adhesion::CASES),
        (Family::Scales, scales::CASES),
        (Family::Lines, lines::CASES),
        (Family::ClosedForms, closed_forms::CASES),
        (Family::Laws, laws::CASES),
    ];
    let of = |(family, cases): (Family, &[Case])| -> Vec<Case> {
        cases.iter().map(|case| Case { family, ..*case }).collect()
    };
    families.into_iter().flat_map(of).collect()
}

/// All checks of the cases selected by `choose`.
#[must_use]
pub fn checks(choose: impl Fn(&Case) -> bool) -> Vec<Check> {
    let of = |case: Case| -> Vec<Check> {
        let check = |edges, bound| Check { case, edges, bound };
        match case.scope {
            Scope::BothEdges(grid, sub_cell) => {
                vec![check(Some(Edges::Grid), grid), check(Some(Edges::SubCell), sub_cell)]
            }
            Scope::OneKind(edges, bound) => vec![check(Some(edges), bound)],
            Scope::Line(bound) => vec![check(None, bound)],
        }
    };
    catalogue().into_iter().filter(|case| choose(case)).flat_map(of).collect()
}

/// Runs a check.
#[must_use]
pub fn judge(check: Check) -> Verdict {
    let clock = Instant::now();
    let error = (check.case.measure)(check.edges.unwrap_or(Edges::Grid));
    Verdict { check, error, seconds: clock.elapsed().as_secs_f64() }
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
            assert!(!case.evidence.is_empty(), "{}", case.name);
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
