//! Search for the smallest number of springs that reaches a tolerance. The edges of patches lie
//! either between springs or so that patches consist of whole springs.

use super::estimate::{Estimate, Evidence, own_errors};
use super::solution::{Runs, Solution, Target, allowed_points, is_spent, is_too_coarse, refined};
use super::table::{REFINEMENTS, first_within};
use crate::scene::checked::CheckedScene;
use crate::scene::errors::SceneErrors;
use crate::scene::model::Solver;
use crate::simulation::outcome::RunError;
use asperity_contact::Edges;
use asperity_data::{counted, grouped, parse_quantity};
use serde::Serialize;
use std::path::Path;
use thiserror::Error;

/// Edge models that the search compares. If both need the same number of springs, the search
/// chooses the first one.
const EDGES: [Edges; 2] = [Edges::SubCell, Edges::Grid];
/// Largest number of springs that is tried. If the modes of the scene need more than a quarter of
/// this number, the limit is four times the needed number.
const MOST_TRIED: u64 = 1 << 21;

/// Parses a tolerance: the largest relative error that a result may have, such as `1e-3` or `0.1
/// %`.
///
/// # Errors
/// Returns an error message unless the tolerance is above 0 and below 1.
///
/// ```
/// use asperity_scene::discretisation::parse_tolerance;
///
/// assert_eq!(parse_tolerance("0.1%"), Ok(0.001));
/// assert!(parse_tolerance("2").is_err());
/// ```
pub fn parse_tolerance(text: &str) -> Result<f64, String> {
    match parse_quantity(text, "1") {
        Ok(tolerance) if tolerance > 0.0 && tolerance < 1.0 => Ok(tolerance),
        _ => Err("allowed: a relative error above 0 and below 1, such as 1e-3 or 0.1%".to_owned()),
    }
}

/// Settings with which the error of a scene is within a tolerance: the number of springs, and where
/// the edges of contact patches may lie ([`Edges`]). [`choose`] returns a value of this type.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Choice {
    /// Largest allowed relative error of the quantity `target`.
    pub tolerance: f64,
    /// Quantity whose error the tolerance limits: pull-off force or force curve.
    pub target: Target,
    /// Chosen number of springs N.
    pub points: u64,
    /// Where an edge of a contact patch may lie: anywhere between two springs, or only where the
    /// patch then consists of whole springs.
    pub edges: Edges,
    /// Relative error of `target` with the chosen settings: the true error if a closed form exists,
    /// otherwise an estimate.
    pub error: f64,
    /// True if `error` is the difference from a closed form, an exact formula for the pull-off
    /// force.
    pub closed_form: bool,
    /// Largest number of springs that [`choose`] tried.
    pub finest: u64,
}

impl Choice {
    /// Returns `scene` with the chosen number of springs, the chosen edges of patches and the exact
    /// solver.
    ///
    /// # Errors
    /// Returns an error for each value of `scene` that is invalid with the chosen settings.
    pub fn apply(&self, scene: &CheckedScene) -> Result<CheckedScene, SceneErrors> {
        refined(scene, self.points, self.edges)
    }

    /// Returns the error of the chosen settings as an [`Estimate`].
    pub fn estimate(&self) -> Estimate {
        let evidence = if self.closed_form {
            Evidence::ClosedForm
        } else {
            Evidence::Solutions(vec![self.finest])
        };
        Estimate {
            target: self.target,
            error: self.error,
            near_step: false,
            evidence,
        }
    }

    /// Returns a sentence that states the chosen settings, their error and how the error was found.
    pub fn sentence(&self) -> String {
        let Choice {
            tolerance,
            target,
            points,
            edges,
            error,
            closed_form,
            finest,
        } = *self;
        let points = grouped(points);
        let target = target.name();
        let edges = edges.name();
        let from = if closed_form {
            "by the closed form".to_owned()
        } else {
            let finest = counted(finest, "spring");
            format!("estimated from solutions with up to {finest}")
        };
        format!(
            "{points} springs with edges {edges}: the fewest found to keep the {target} within {tolerance:e}; its \
             error is {error:.1e}, {from}."
        )
    }
}

/// Reason why [`choose`] found no number of springs.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ChoiceError {
    /// The scene could not be computed.
    #[error(transparent)]
    Run(#[from] RunError),
    /// The tolerance is not above 0 and below 1.
    #[error("a tolerance of {0:e}; allowed: a relative error above 0 and below 1")]
    Range(f64),
    /// The scene uses the stepwise [`Solver`], whose finite steps cause a further error.
    #[error(
        "a tolerance needs numerics.solver: Exact; the step of the stepwise solver is an error of its own"
    )]
    Stepwise,
    /// The caller stopped the search.
    #[error("the search for springs was stopped")]
    Stopped,
    /// The error exceeds the tolerance even with the largest number of springs that was tried.
    #[error("{}", unreached(.tolerance, .best))]
    Unreached {
        /// Requested tolerance, a relative error.
        tolerance: f64,
        /// Settings with the smallest error; `None` if no error is known.
        best: Option<Box<Choice>>,
    },
}

fn unreached(tolerance: &f64, best: &Option<Box<Choice>>) -> String {
    let Some(best) = best else {
        return format!(
            "a tolerance of {tolerance:e} cannot be checked: too few numbers of springs are allowed"
        );
    };
    let finest = grouped(best.finest);
    let error = best.error;
    let target = best.target.name();
    let points = grouped(best.points);
    let edges = best.edges.name();
    format!(
        "a tolerance of {tolerance:e} is not reached with at most {finest} springs; what is reached is {error:.1e} of \
         the {target}, with {points} springs and edges {edges}"
    )
}

/// Finds the smallest number of springs, a power of two, with which the relative error of a scene
/// is at most `tolerance`. Also finds where the edges of contact patches should lie ([`Edges`]).
///
/// The error is that of the pull-off force or, for a scene without a tensile force, that of the
/// force curve ([`Target::Curve`]). Names of measured files are relative to `folder`. `trying`
/// receives each number of springs before it is tried. The search ends if `stop` returns true.
///
/// # Errors
/// Returns an error if the tolerance is not above 0 and below 1, if it is not reached, if the scene
/// has the stepwise solver, if `stop` returned true, or if the scene cannot be computed.
///
/// ```
/// use asperity_scene::discretisation::choose;
/// use asperity_scene::open;
/// use std::path::Path;
///
/// let sphere = open("jkr-sphere")?;
/// let choice = choose(sphere.scene(), Path::new(""), 0.01, &|| false, &mut |_| ()).unwrap();
/// assert!(choice.closed_form && choice.error <= 0.01);
/// # Ok::<(), asperity_scene::Error>(())
/// ```
pub fn choose(
    scene: &CheckedScene,
    folder: &Path,
    tolerance: f64,
    stop: &dyn Fn() -> bool,
    trying: &mut dyn FnMut(u64),
) -> Result<Choice, ChoiceError> {
    if !(tolerance > 0.0 && tolerance < 1.0) {
        return Err(ChoiceError::Range(tolerance));
    }
    if scene.numerics.solver != Solver::Exact {
        return Err(ChoiceError::Stepwise);
    }
    // The number of springs is doubled until the error is within the tolerance and stays so for at
    // least two further doublings. Without a closed form, pull-off forces are also compared at half
    // and at twice the loads, and the estimated error of the finest solution is added.
    let most = allowed_points(scene)
        .next()
        .map_or(0, |fewest| MOST_TRIED.max(4 * fewest));
    let mut tried: Vec<[Solution; 2]> = Vec::new();
    let mut runs = Runs::new(folder, stop);
    let mut refused = None;
    let mut error_of_finest = None;
    for points in allowed_points(scene).take_while(|&points| points <= most) {
        trying(points);
        let solved = solve_with_both_edges(scene, points, &mut runs, &mut refused)?;
        if stop() {
            return Err(ChoiceError::Stopped);
        }
        let Some(solved) = solved else {
            continue;
        };
        tried.push(solved);
        error_of_finest = None;
        // The estimate of the error of the finest solution needs two more solutions, so it is made
        // last.
        if choice_within(&tried, 0.0, tolerance).is_none() {
            continue;
        }
        error_of_finest = estimated_error(scene, &mut runs, &tried);
        if let Some(error) = error_of_finest
            && let Some(choice) = choice_within(&tried, error, tolerance)
        {
            return Ok(choice);
        }
    }
    if let Some(error) = refused
        && tried.is_empty()
    {
        return Err(error.into());
    }
    let error_of_finest = error_of_finest.or_else(|| estimated_error(scene, &mut runs, &tried));
    let best = error_of_finest
        .and_then(|error| judge(&tried, error, tolerance))
        .map(Box::new);
    Err(ChoiceError::Unreached { tolerance, best })
}

/// Solves a scene with `points` springs and each edge model. Returns `None` if an edge model has no
/// solution with so few springs, or if the memory or the time is not sufficient. In these cases the
/// error is stored in `refused`.
fn solve_with_both_edges(
    scene: &CheckedScene,
    points: u64,
    runs: &mut Runs<'_>,
    refused: &mut Option<RunError>,
) -> Result<Option<[Solution; 2]>, RunError> {
    let mut solutions = Vec::new();
    for edges in EDGES {
        match runs.solve_around(&refined(scene, points, edges)?) {
            Ok(solution) => solutions.push(solution),
            Err(error) if is_too_coarse(&error) => *refused = Some(error),
            Err(error) if is_spent(&error) => {}
            Err(error) => return Err(error),
        }
    }
    Ok(solutions.try_into().ok())
}

/// Returns the best choice among the solutions if its error is within the tolerance; otherwise
/// `None`. `error_of_finest` is the error of the finest solution.
fn choice_within(tried: &[[Solution; 2]], error_of_finest: f64, tolerance: f64) -> Option<Choice> {
    judge(tried, error_of_finest, tolerance).filter(|choice| choice.error <= tolerance)
}

/// Estimates the relative error of the finest solution with edges between springs, at the loads of
/// the scene and at half and twice these loads. Returns 0 if the scene has a closed form, and
/// `None` if the error is unknown.
fn estimated_error(
    scene: &CheckedScene,
    runs: &mut Runs<'_>,
    tried: &[[Solution; 2]],
) -> Option<f64> {
    let [finest, _] = tried.last()?;
    if finest.closed_form.is_some() {
        return Some(0.0);
    }
    own_errors(scene, finest, runs)?[Target::of(finest) as usize]
}

/// Returns the choice among the solutions with both edge models. `error_of_finest` is the error of
/// the finest solution. If no choice reaches the tolerance, returns the choice with the smallest
/// error that finer solutions confirm. Returns `None` if there are too few solutions.
fn judge(tried: &[[Solution; 2]], error_of_finest: f64, tolerance: f64) -> Option<Choice> {
    let mut candidates = Vec::new();
    for index in 0..EDGES.len() {
        candidates.extend(candidate(tried, index, error_of_finest, tolerance));
    }
    // If both edge models need the same number of springs, the first one is chosen, with edges
    // between springs.
    let fewest = candidates
        .iter()
        .filter(|choice| choice.error <= tolerance)
        .min_by_key(|choice| choice.points);
    let best = candidates
        .iter()
        .min_by(|one, other| one.error.total_cmp(&other.error));
    fewest.or(best).cloned()
}

/// Returns the choice among the solutions with one edge model, which has the index `index` in
/// [`EDGES`].
fn candidate(
    tried: &[[Solution; 2]],
    index: usize,
    error_of_finest: f64,
    tolerance: f64,
) -> Option<Choice> {
    let [finest, _] = tried.last()?;
    let target = Target::of(finest);
    let reference = finest.reference();
    let mut errors = Vec::new();
    for solutions in tried {
        errors.push(target.difference(&solutions[index], &reference)? + error_of_finest);
    }
    let last_confirmed = errors.len().checked_sub(1 + REFINEMENTS)?;
    let within = first_within(errors.iter().copied().map(Some), tolerance);
    let place = within.unwrap_or(last_confirmed);
    let error = if within.is_some() {
        errors[place]
    } else {
        errors[place..].iter().copied().fold(0.0, f64::max)
    };
    Some(Choice {
        tolerance,
        target,
        points: tried[place][index].points,
        edges: EDGES[index],
        error,
        closed_form: finest.closed_form.is_some(),
        finest: finest.points,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Creates solutions whose pull-off force converges to 1 N. `edges` has the error of the first
    /// solution and the order of convergence, for each edge model.
    fn solutions(count: u32, edges: [(f64, i32); 2]) -> Vec<[Solution; 2]> {
        let solution = |k: u32, (error, order): (f64, i32)| Solution {
            points: 16 << k,
            pull_off_force: Some(1.0 + error * f64::from(1 << k).powi(-order)),
            ..Solution::default()
        };
        (0..count)
            .map(|k| edges.map(|edges| solution(k, edges)))
            .collect()
    }

    /// Adds to each solution a closed form with the pull-off force 1 N.
    fn known(solutions: Vec<[Solution; 2]>) -> Vec<[Solution; 2]> {
        let known = |solution| Solution {
            closed_form: Some(1.0),
            ..solution
        };
        solutions.into_iter().map(|pair| pair.map(known)).collect()
    }

    #[test]
    fn tolerances_are_numbers_or_per_cent() {
        for (text, expected) in [
            ("1e-3", 1e-3),
            ("0.1%", 1e-3),
            (" 10 % ", 0.1),
            ("0.5", 0.5),
        ] {
            assert!(
                (parse_tolerance(text).unwrap() / expected - 1.0).abs() < 1e-15,
                "{text}"
            );
        }
        for wrong in [
            "0", "-1", "1", "100%", "nan", "inf", "", "%", "1e-3 %%", "abc",
        ] {
            assert!(parse_tolerance(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn the_fewest_springs_that_two_refinements_confirm_are_chosen() {
        // The errors in N are 0.1, 0.025, 0.00625, … with edges between springs, and 0.5, 0.25, …
        // with whole springs.
        let tried = |count| solutions(count, [(0.1, 2), (0.5, 1)]);
        let choice = judge(&known(tried(5)), 0.0, 0.01).unwrap();
        assert_eq!((choice.points, choice.edges), (64, Edges::SubCell));
        assert!((choice.error - 0.00625).abs() < 1e-12);
        // Without a closed form, the error 0.005 of the finest solution is added to the difference
        // from this solution.
        let choice = judge(&tried(6), 0.005, 0.01).unwrap();
        assert_eq!((choice.points, choice.edges), (128, Edges::SubCell));
        assert!((0.006..0.01).contains(&choice.error), "{choice:?}");
        assert_eq!(judge(&tried(2), 0.0, 0.01), None);
        // Whole springs are chosen only if they need fewer springs.
        let choice = judge(&known(solutions(5, [(0.1, 2), (0.1, 2)])), 0.0, 0.01).unwrap();
        assert_eq!((choice.points, choice.edges), (64, Edges::SubCell));
        let choice = judge(&known(solutions(5, [(0.5, 1), (0.1, 2)])), 0.0, 0.01).unwrap();
        assert_eq!((choice.points, choice.edges), (64, Edges::Grid));
        // If no choice reaches the tolerance, the choice with the smallest error that finer
        // solutions confirm is returned.
        let choice = judge(&known(tried(4)), 0.0, 1e-6).unwrap();
        assert_eq!((choice.points, choice.edges), (32, Edges::SubCell));
        assert!((choice.error - 0.025).abs() < 1e-12);
    }

    #[test]
    fn an_error_that_is_small_under_one_load_is_not_small() {
        let mut tried = solutions(5, [(0.1, 2), (1e-4, 1)]);
        for solution in tried.iter_mut().flatten() {
            solution.around = vec![Some(1.0)];
        }
        let chosen = |tried: &[[Solution; 2]]| {
            judge(tried, 0.0, 0.01)
                .map(|choice| (choice.points, choice.edges))
                .unwrap()
        };
        assert_eq!(chosen(&tried), (16, Edges::Grid));
        tried[0][1].around = vec![Some(1.07)];
        assert_eq!(chosen(&tried), (32, Edges::Grid));
        tried[2][1].around = vec![None];
        assert_eq!(chosen(&tried), (64, Edges::SubCell));
    }
}
