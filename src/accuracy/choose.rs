//! The fewest springs that reach a tolerance.

use super::convergence::{error_of_finest, first_within};
use super::estimate::{Estimate, Evidence};
use super::solution::{
    Solution, Solved, Target, allowed_points, closed_form_adhesion, refined, relative_error, solve,
};
use crate::scene::{Edges, Scene, Solver};
use crate::simulation::{RunError, Simulation};
use crate::text::grouped;
use serde::Serialize;
use std::path::Path;
use thiserror::Error;

/// Most springs tried, unless the modes of the scene need more: then four times that number.
const MOST_SPRINGS: u64 = 1 << 21;
/// Fewest solutions for a reliable estimate.
const FEWEST_SOLUTIONS: usize = 3;
/// Differences in the error of the finest solution, as in the estimate for one scene.
const LAST_DIFFERENCES: usize = 3;

/// Parses a tolerance: `1e-3` or `0.1 %`.
///
/// # Errors
/// Allowed values, for text that is no tolerance.
pub fn parse_tolerance(text: &str) -> Result<f64, String> {
    let allowed = || "allowed: a relative error above 0 and below 1, such as 1e-3 or 0.1%".to_owned();
    let text = text.trim();
    let (number, hundredths) = match text.strip_suffix('%') {
        Some(number) => (number.trim_end(), true),
        None => (text, false),
    };
    let number: f64 = number.parse().map_err(|_| allowed())?;
    let tolerance = if hundredths { number / 100.0 } else { number };
    if tolerance > 0.0 && tolerance < 1.0 { Ok(tolerance) } else { Err(allowed()) }
}

/// Springs and edges that reach a tolerance.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Choice {
    /// Allowed relative error.
    pub tolerance: f64,
    /// Quantity of the error.
    pub target: Target,
    /// Springs N.
    pub points: u64,
    /// Edge model.
    pub edges: Edges,
    /// Reached relative error: with a closed form the error itself, else an estimate that includes the estimated
    /// error of the finest solution.
    pub error: f64,
    /// True if the error is relative to a closed form.
    pub closed_form: bool,
    /// Springs of the finest solution tried for the choice.
    pub finest: u64,
}

impl Choice {
    /// The scene with these springs and edges.
    #[must_use]
    pub fn apply(&self, scene: &Scene) -> Scene {
        refined(scene, self.points, self.edges)
    }

    /// The error of the scene with these springs and edges.
    #[must_use]
    pub fn estimate(&self) -> Estimate {
        let evidence =
            if self.closed_form { Evidence::ClosedForm } else { Evidence::Solutions(vec![self.finest]) };
        Estimate { target: self.target, error: self.error, evidence }
    }

    /// Choice and reason in one sentence.
    #[must_use]
    pub fn sentence(&self) -> String {
        let edges = self.edges.name();
        let from = if self.closed_form {
            "by the closed form".to_owned()
        } else {
            format!("estimated from solutions with up to {} springs", grouped(self.finest))
        };
        format!(
            "{} springs with edges {edges}: the fewest found to keep the {} within {:e}; its error is {:.1e}, {from}.",
            grouped(self.points),
            self.target.name(),
            self.tolerance,
            self.error
        )
    }
}

/// Reason why no springs were chosen.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ChoiceError {
    /// The scene could not be computed.
    #[error(transparent)]
    Run(#[from] RunError),
    /// The stepwise solver has an error of its own that is independent of the springs.
    #[error(
        "a tolerance goes with numerics.solver: Exact; the step of the stepwise solver is an error of its own"
    )]
    Stepwise,
    /// The search was stopped.
    #[error("the search for springs was stopped")]
    Stopped,
    /// Not reached with the largest number of tried springs.
    #[error("{}", unreached(.tolerance, .best))]
    Unreached {
        /// Requested relative error.
        tolerance: f64,
        /// The best choice, with a tolerance that it reaches; `None` if nothing is known.
        best: Option<Box<Choice>>,
    },
}

fn unreached(tolerance: &f64, best: &Option<Box<Choice>>) -> String {
    match best {
        None => {
            format!("a tolerance of {tolerance:e} cannot be checked: too few numbers of springs are allowed")
        }
        Some(best) => format!(
            "a tolerance of {tolerance:e} is not reached with at most {} springs; what is reached is {:.1e} of \
             the {}, with {} springs and edges {}",
            grouped(best.finest),
            best.error,
            best.target.name(),
            grouped(best.points),
            best.edges.name()
        ),
    }
}

/// Springs and edges with which a checked scene, with files in `folder`, reaches a relative error of at most
/// `tolerance` in its adhesion force, or in its force curve without a tensile force.
///
/// Doubles the springs until the estimate of the error, including that of the finest solution, is below the
/// tolerance, and once more, since a finer solution is a better reference for the others; then the choice is the
/// fewest springs from which on the error stays there. With equal springs both kinds of edges take about the same
/// time, and edges between springs are preferred, whose error falls faster if the estimate was too optimistic. The
/// choice depends on the scene alone, not on times. `stop` is polled now and then; `trying` receives the next
/// number of springs.
///
/// # Errors
/// [`ChoiceError`].
pub fn choose(
    scene: &Scene,
    folder: &Path,
    tolerance: f64,
    stop: &dyn Fn() -> bool,
    trying: &mut dyn FnMut(u64),
) -> Result<Choice, ChoiceError> {
    if scene.numerics.solver != Solver::Exact {
        return Err(ChoiceError::Stepwise);
    }
    let most = allowed_points(scene).next().map_or(0, |fewest| MOST_SPRINGS.max(4 * fewest));
    let mut tried: [Vec<Solution>; 2] = [Vec::new(), Vec::new()];
    let mut best: Option<Box<Choice>> = None;
    let mut simulation = Simulation::new(folder.to_path_buf());
    let mut found = None;
    for points in allowed_points(scene).take_while(|&points| points <= most) {
        let mut closed_form = None;
        let mut solved = 0;
        trying(points);
        for (edges, solutions) in EDGES.into_iter().zip(&mut tried) {
            if let Solved::Outcome(outcome) = solve(&mut simulation, &refined(scene, points, edges), stop)? {
                closed_form = closed_form_adhesion(scene, &outcome);
                solutions.push(Solution::of(&outcome));
                solved += 1;
            }
        }
        if stop() {
            return Err(ChoiceError::Stopped);
        }
        if solved < EDGES.len() {
            continue;
        }
        if let Some(choice) = judge(&tried, closed_form, tolerance) {
            if choice.error <= tolerance {
                if found.is_some() {
                    return Ok(choice);
                }
                found = Some(choice);
                continue;
            }
            found = None;
            if best.as_ref().is_none_or(|best| choice.error < best.error) {
                best = Some(Box::new(choice.clone()));
            }
        }
        if let (Some(best), Some(finest)) = (&mut best, tried[0].last()) {
            best.finest = finest.points;
        }
    }
    found.ok_or(ChoiceError::Unreached { tolerance, best })
}

/// In the order of preference at the same number of springs.
const EDGES: [Edges; 2] = [Edges::SubCell, Edges::Grid];

/// The choice among solutions with edges at and between springs, with equal springs each; if none is good enough,
/// the best of them. `None` for too few solutions.
fn judge([sub_cell, grid]: &[Vec<Solution>; 2], closed_form: Option<f64>, tolerance: f64) -> Option<Choice> {
    let finest = sub_cell.last()?;
    let target = Target::of(finest);
    let of_finest = match (closed_form, sub_cell.as_slice()) {
        (Some(_), _) => 0.0,
        (None, solutions) if solutions.len() >= FEWEST_SOLUTIONS => {
            let last = solutions.windows(2).rev().take(LAST_DIFFERENCES);
            let mut differences: Vec<f64> =
                last.map_while(|pair| target.difference(&pair[0], &pair[1])).collect();
            differences.reverse();
            if differences.is_empty() {
                return None;
            }
            error_of_finest(&differences)
        }
        (None, _) => return None,
    };
    let error = |solution: &Solution| match closed_form {
        Some(force) => Some(relative_error(solution.adhesion_force.unwrap_or(0.0), force)),
        None => Some(target.difference(solution, finest)? + of_finest),
    };
    let candidates = EDGES.into_iter().zip([sub_cell, grid]).filter_map(|(edges, solutions)| {
        let errors: Vec<_> = solutions.iter().map(error).collect();
        // If none is good enough, the finest.
        let index = first_within(errors.iter().copied(), tolerance).unwrap_or(errors.len() - 1);
        let (error, points) = ((*errors.get(index)?)?, solutions.get(index)?.points);
        Some(Choice {
            tolerance,
            target,
            points,
            edges,
            error,
            closed_form: closed_form.is_some(),
            finest: finest.points,
        })
    });
    let (good, others): (Vec<_>, Vec<_>) = candidates.partition(|choice| choice.error <= tolerance);
    // The first of equal choices: edges between springs.
    let fewest = good.into_iter().min_by_key(|choice| choice.points);
    fewest.or_else(|| others.into_iter().min_by(|one, other| one.error.total_cmp(&other.error)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Solutions whose adhesion force converges to 1 with a given order.
    fn solutions(count: u32, error: f64, order: i32) -> Vec<Solution> {
        let solution = |k: u32| Solution {
            points: 16 << k,
            adhesion_force: Some(1.0 + error * f64::from(1 << k).powi(-order)),
            dissipated_energy: None,
            contact_length: None,
            curve: crate::accuracy::ForceCurve::default(),
        };
        (0..count).map(solution).collect()
    }

    #[test]
    fn tolerances_are_numbers_or_per_cent() {
        for (text, expected) in [("1e-3", 1e-3), ("0.1%", 1e-3), (" 10 % ", 0.1), ("0.5", 0.5)] {
            assert!((parse_tolerance(text).unwrap() / expected - 1.0).abs() < 1e-15, "{text}");
        }
        for wrong in ["0", "-1", "1", "100%", "nan", "inf", "", "%", "1e-3 %%", "abc"] {
            assert!(parse_tolerance(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn the_fewest_springs_are_chosen() {
        // Grid: 0.5, 0.25, …; SubCell: 0.1, 0.025, 0.00625, …
        let tried = |count| [solutions(count, 0.1, 2), solutions(count, 0.5, 1)];
        let choice = judge(&tried(5), Some(1.0), 0.01).unwrap();
        assert_eq!((choice.points, choice.edges), (64, Edges::SubCell));
        assert!((choice.error - 0.00625).abs() < 1e-12);
        // The estimate includes the true error of 128 springs, 0.0016.
        let choice = judge(&tried(5), None, 0.01).unwrap();
        assert_eq!((choice.points, choice.edges), (128, Edges::SubCell));
        assert!((0.0016..0.01).contains(&choice.error), "{choice:?}");
        assert_eq!(judge(&tried(2), None, 0.01), None);
        // Edges at the springs only if fewer springs suffice.
        let choice = judge(&[solutions(5, 0.1, 2), solutions(5, 0.1, 2)], Some(1.0), 0.01).unwrap();
        assert_eq!((choice.points, choice.edges), (64, Edges::SubCell));
        let choice = judge(&[solutions(5, 0.5, 1), solutions(5, 0.1, 2)], Some(1.0), 0.01).unwrap();
        assert_eq!((choice.points, choice.edges), (64, Edges::Grid));
        // The best choice if none suffices.
        let choice = judge(&tried(3), Some(1.0), 1e-6).unwrap();
        assert_eq!((choice.points, choice.edges), (64, Edges::SubCell));
        assert!(choice.error > 1e-6);
    }

    #[test]
    fn a_tolerance_is_kept_or_refused() {
        let document = crate::scene::open("jkr-sphere").unwrap();
        let (scene, folder) = (document.scene(), document.resolve(""));
        let choice = choose(scene, &folder, 1e-3, &|| false, &mut |_| ()).unwrap();
        assert_eq!(
            (choice.target, choice.edges, choice.closed_form),
            (Target::AdhesionForce, Edges::SubCell, true)
        );
        let chosen = choice.apply(scene);
        let Solved::Outcome(outcome) =
            solve(&mut Simulation::new(folder.clone()), &chosen, &|| false).unwrap()
        else {
            panic!("no solution")
        };
        let exact = 1.5 * std::f64::consts::PI * 0.05 * 1e-4;
        assert!((outcome.figures.adhesion_force.unwrap() / exact - 1.0).abs() <= 1e-3);
        let mut stepwise = scene.clone();
        stepwise.numerics.solver = Solver::Stepwise { step: 1e-9 };
        let chosen = |scene: &Scene, stop: &dyn Fn() -> bool| choose(scene, &folder, 1e-3, stop, &mut |_| ());
        assert_eq!(chosen(&stepwise, &|| false), Err(ChoiceError::Stepwise));
        assert_eq!(chosen(scene, &|| true), Err(ChoiceError::Stopped));
    }
}
