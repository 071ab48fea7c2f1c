//! Solutions of a scene with several settings, and their relative differences.

use crate::reference::{closed_form, smooth_pull_off_force};
use crate::scene::checked::CheckedScene;
use crate::scene::errors::SceneErrors;
use crate::scene::model::FEW_SAMPLES;
use crate::scene::model::{Scene, Solver};
use crate::simulation::outcome::{Outcome, RunError};
use crate::simulation::stages::Simulation;
use asperity_contact::{Branch, ContactError, Direction, Edges, History, Move, StageRecord};
use asperity_surface::SurfaceError;
use serde::Serialize;
use std::f64::consts::PI;
use std::path::Path;

pub(super) const FEWEST: u64 = 16;
/// Factors by which the loads of a scene are multiplied, to compare solutions at smaller and larger
/// loads.
const AROUND: [f64; 2] = [0.5, 2.0];

/// Relative errors or differences of the pull-off force, the force curve, the dissipated energy and
/// the largest contact length ([`crate::accuracy::table::CostTable::QUANTITIES`]). `None` for a
/// missing quantity.
pub(super) type Errors = [Option<f64>; 4];

/// Forces, energy, contact length and force curve of one solution. A value of zero is stored as
/// `None`, because it has no relative error.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Solution {
    pub points: u64,
    pub pull_off_force: Option<f64>,
    /// Pull-off force in N by an exact formula (closed form); `None` if the scene has no such
    /// formula.
    pub closed_form: Option<f64>,
    /// Pull-off forces in N with all target forces and indentations of the scene halved, and with
    /// all of them doubled. An element is `None` without a tensile force. The list is empty if
    /// these forces were not computed.
    pub around: Vec<Option<f64>>,
    pub dissipated_energy: Option<f64>,
    pub contact_length: Option<f64>,
    pub curve: ForceCurve,
}

impl Solution {
    pub(super) fn of(scene: &Scene, outcome: &Outcome) -> Self {
        Solution {
            curve: force_curve(&outcome.history),
            ..Solution::without_curve(scene, outcome)
        }
    }

    /// Returns only the quantities of a result that [`Target::difference`] compares. If the
    /// pull-off force is compared, the force curve is not copied.
    pub(super) fn of_target(scene: &Scene, outcome: &Outcome) -> Self {
        let own = Solution::without_curve(scene, outcome);
        match Target::of(&own) {
            Target::PullOffForce => own,
            Target::Curve => Solution::of(scene, outcome),
        }
    }

    fn without_curve(scene: &Scene, outcome: &Outcome) -> Self {
        let figures = &outcome.figures;
        Solution {
            points: outcome.line.points as u64,
            pull_off_force: figures.pull_off_force.and_then(unless_zero),
            closed_form: closed_form_adhesion(scene, outcome),
            around: Vec::new(),
            dissipated_energy: figures.dissipated_energy.and_then(unless_zero),
            contact_length: unless_zero(longest_contact(outcome)),
            curve: ForceCurve::new(),
        }
    }

    /// Returns a copy of this solution to which the errors of other solutions are relative. If the
    /// scene has a pull-off force in closed form, this force replaces the computed one.
    pub(super) fn reference(&self) -> Solution {
        let mut reference = self.clone();
        if self.closed_form.is_some() {
            reference.pull_off_force = self.closed_form;
            reference.around.clear();
        }
        reference
    }

    /// Returns the relative differences of this solution from a reference. The difference of the
    /// pull-off force is the largest one among all loads at which both solutions have an pull-off
    /// force. An error that changes its sign between two loads therefore does not seem small by
    /// chance.
    pub(super) fn errors(&self, reference: &Solution) -> Errors {
        [
            self.error_of_pull_off_force(reference),
            difference(&self.curve, &reference.curve),
            error_of(self.dissipated_energy, reference.dissipated_energy),
            error_of(self.contact_length, reference.contact_length),
        ]
    }

    fn error_of_pull_off_force(&self, reference: &Solution) -> Option<f64> {
        let mut largest = error_of(self.pull_off_force, reference.pull_off_force)?;
        for (&force, &reference) in self.around.iter().zip(&reference.around) {
            let error = if force.is_some() && reference.is_none() {
                f64::INFINITY
            } else {
                error_of(force, reference).unwrap_or(0.0)
            };
            largest = largest.max(error);
        }
        Some(largest)
    }
}

/// Returns the value if it is finite and not zero, so that a relative error can be divided by it;
/// otherwise `None`.
fn unless_zero(value: f64) -> Option<f64> {
    (value != 0.0 && value.is_finite()).then_some(value)
}

/// Returns the relative error of a value. A missing value counts as zero. Returns `None` if the
/// reference is missing.
fn error_of(value: Option<f64>, reference: Option<f64>) -> Option<f64> {
    Some(relative_error(value.unwrap_or(0.0), reference?))
}

/// Quantity whose error [`estimate`](crate::estimate()) estimates and
/// [`choose`](crate::discretisation::choose) keeps within a tolerance.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Target {
    /// Pull-off force. Its error is used for a scene whose loading has a tensile force.
    PullOffForce,
    /// Force curve of a scene without a tensile force.
    ///
    /// The error of a loading stage is the mean absolute difference between its forces and the
    /// exact forces at the same indentations, divided by the largest absolute force in all stages.
    /// The error of the force curve is the largest error of a stage.
    Curve,
}

impl Target {
    /// Returns the name of this quantity for users: `pull-off force` or `force curve`.
    pub fn name(self) -> &'static str {
        match self {
            Target::PullOffForce => "pull-off force",
            Target::Curve => "force curve",
        }
    }

    pub(super) fn of(solution: &Solution) -> Self {
        if solution.pull_off_force.is_some() {
            Target::PullOffForce
        } else {
            Target::Curve
        }
    }

    /// Returns the scene with only those settings that the computation of this quantity needs.
    pub(super) fn only(self, scene: &CheckedScene) -> Result<CheckedScene, SceneErrors> {
        scene.with(|scene| {
            scene.observe.clear();
            if self == Target::PullOffForce {
                // The pull-off force is an exact extreme, so it does not depend on the number of
                // points of the curve.
                scene.numerics.samples = FEW_SAMPLES;
            }
        })
    }

    /// Returns the relative difference of this quantity, pull-off force or force curve, between a
    /// solution and a reference. Returns `None` if the difference is unknown, for example because a
    /// solution has no pull-off force.
    pub(super) fn difference(self, solution: &Solution, reference: &Solution) -> Option<f64> {
        match self {
            Target::PullOffForce => solution.error_of_pull_off_force(reference),
            Target::Curve => difference(&solution.curve, &reference.curve),
        }
    }
}

pub(super) fn relative_error(value: f64, reference: f64) -> f64 {
    ((value - reference) / reference).abs()
}

/// Returns the scene with other settings: this number of springs, these edges of patches and the
/// exact solver.
pub(super) fn refined(
    scene: &CheckedScene,
    points: u64,
    edges: Edges,
) -> Result<CheckedScene, SceneErrors> {
    scene.with(|scene| {
        scene.numerics.points = points;
        scene.numerics.edges = edges;
        scene.numerics.solver = Solver::Exact;
    })
}

/// Returns the scene with all positive target forces and indentations multiplied by `factor`.
/// Returns `None` if there are no such targets, or if a product is out of range.
pub(super) fn loaded(scene: &CheckedScene, factor: f64) -> Option<CheckedScene> {
    let mut loaded = Scene::clone(scene);
    for stage in &mut loaded.loading {
        if let Move::ToForce(target) | Move::ToIndentation(target) = stage
            && *target > 0.0
        {
            *target *= factor;
        }
    }
    if loaded.loading == scene.loading {
        return None;
    }
    loaded.checked().ok()
}

/// Returns true if a scene has target forces or indentations that [`loaded`] can multiply.
pub(super) fn has_loads(scene: &Scene) -> bool {
    scene.loading.iter().any(|stage| match *stage {
        Move::ToForce(target) | Move::ToIndentation(target) => target > 0.0,
        _ => false,
    })
}

/// Returns all powers of two that the scene allows as its number of springs, in ascending order.
pub(super) fn allowed_points(scene: &CheckedScene) -> impl Iterator<Item = u64> {
    let powers = std::iter::successors(Some(FEWEST), |points| points.checked_mul(2));
    let is_allowed = |points| refined(scene, points, scene.numerics.edges).is_ok();
    // Skips powers that are too small for the modes. Stops at the first power that is too large for
    // the field.
    powers
        .take(40)
        .skip_while(move |&points| !is_allowed(points))
        .take_while(move |&points| is_allowed(points))
}

/// Computes scenes one after the other. If a scene has the same profile as the scene before, the
/// profile is used again.
pub(super) struct Runs<'a> {
    simulation: Simulation,
    stop: &'a dyn Fn() -> bool,
}

impl<'a> Runs<'a> {
    pub(super) fn new(folder: &Path, stop: &'a dyn Fn() -> bool) -> Self {
        Runs {
            simulation: Simulation::new(folder.to_path_buf()),
            stop,
        }
    }

    pub(super) fn solve(&mut self, scene: &CheckedScene) -> Result<Solution, RunError> {
        let outcome = self
            .simulation
            .run(scene, self.stop, &mut |_, _, _| Ok(()))?;
        Ok(Solution::of(scene, &outcome))
    }

    /// Solves a scene. Also computes its pull-off forces at half and at twice the loads.
    pub(super) fn solve_around(&mut self, scene: &CheckedScene) -> Result<Solution, RunError> {
        let mut solution = self.solve(scene)?;
        let scene = Target::of(&solution).only(scene)?;
        if solution.pull_off_force.is_none() {
            return Ok(solution);
        }
        for factor in AROUND {
            let Some(loaded) = loaded(&scene, factor) else {
                continue;
            };
            let pull_off_force = match self.solve(&loaded) {
                Ok(solution) => solution.pull_off_force,
                Err(error) if is_too_coarse(&error) => None,
                Err(error) => return Err(error),
            };
            solution.around.push(pull_off_force);
        }
        Ok(solution)
    }
}

/// Returns true if the error means that the memory or the time was not sufficient.
pub(super) fn is_spent(error: &RunError) -> bool {
    use RunError::{Contact, OutOfMemory, Surface};
    matches!(
        error,
        OutOfMemory { .. }
            | Surface(SurfaceError::OutOfMemory { .. })
            | Contact(ContactError::OutOfMemory(_) | ContactError::Interrupted)
    )
}

/// Returns true if the error means that there are too few springs: either no spring lies under the
/// body, or the contact of the springs does not reach the end of a stage.
pub(super) fn is_too_coarse(error: &RunError) -> bool {
    match error {
        RunError::Contact(error) => error.is_out_of_reach(),
        RunError::Surface(error) => error.field() == Some("form.radius"),
        _ => false,
    }
}

fn longest_contact(outcome: &Outcome) -> f64 {
    let mut longest = 0.0;
    for stage in &outcome.history.stages {
        for point in &stage.curve {
            longest = f64::max(longest, point.contact_length);
        }
    }
    longest
}

/// Returns the pull-off force of a scene by a closed form in N. `outcome` is the solution of the
/// scene. Returns `None` unless three conditions hold:
///
/// * the body is smooth and has a closed form;
/// * the body is pulled beyond the indentation of its smallest force;
/// * the profile is longer than the contact.
fn closed_form_adhesion(scene: &Scene, outcome: &Outcome) -> Option<f64> {
    let work = outcome.governing.adhesive_work()?;
    if scene.roughness.is_some() {
        return None;
    }
    let limits = Limits::of(scene, outcome, work)?;
    let stages = &outcome.history.stages;
    Branch::pull_off(stages)?;
    let pulled = &stages[Branch::last_unloading(stages)?.stages];
    let passes =
        pulled.first()?.start() >= limits.pull_off && pulled.last()?.end_in_contact().is_none();
    // The contact length is a sum with rounding errors, so the comparison has a margin.
    let is_inside = longest_contact(outcome) <= limits.widest * (1.0 + 1e-9);
    if !passes || !is_inside {
        return None;
    }
    smooth_pull_off_force(
        scene.form.as_ref(),
        scene.length,
        outcome.governing.modulus,
        [work; 2],
        f64::INFINITY,
    )
}

/// Limits within which the closed form of a smooth body holds.
struct Limits {
    /// Indentation in m at which the force is smallest.
    pull_off: f64,
    /// Largest contact length in m.
    widest: f64,
}

impl Limits {
    fn of(scene: &Scene, outcome: &Outcome, work: f64) -> Option<Limits> {
        let length = scene.length;
        let modulus = outcome.governing.modulus;
        let flat_width = match &scene.form {
            None => Some(length),
            Some(form) => form
                .flat_end()
                .map(|radius| 2.0 * radius)
                .filter(|width| *width <= length),
        };
        if let Some(width) = flat_width {
            return Some(Limits {
                pull_off: -(PI * width * work / modulus).sqrt(),
                widest: length,
            });
        }
        let body = closed_form(scene.form.as_ref()?, modulus, work)?;
        let (radius, _) = body.force_controlled_pull_off();
        Some(Limits {
            pull_off: body.indentation(radius),
            // If the contact reaches the end of the profile, its edge no longer depends on the form
            // of the body.
            widest: length - 2.0 * outcome.line.spacing,
        })
    }
}

/// Number of indentations at which the forces of a loading stage are compared.
const COMPARED: usize = 2048;

/// Force curve of each loading stage. The points consist of indentation (m) and force (N) and are
/// in ascending order of the indentation.
pub(super) type ForceCurve = Vec<Vec<[f64; 2]>>;

pub(super) fn force_curve(history: &History) -> ForceCurve {
    history.stages.iter().map(ascending_points).collect()
}

fn ascending_points(stage: &StageRecord) -> Vec<[f64; 2]> {
    let mut points: Vec<[f64; 2]> = stage
        .curve
        .iter()
        .map(|point| [point.indentation, point.force])
        .collect();
    if stage.direction == Direction::Unloading {
        points.reverse();
    }
    points
}

/// Returns the difference between a force curve and a reference: the mean absolute difference of
/// the forces at equal indentations, divided by the largest absolute force of the reference. The
/// loading stage with the largest difference counts. A jump that is late by a hundredth of the
/// range of indentations therefore counts as a hundredth of its height. Returns `None` if the
/// reference has no forces, or if the numbers of stages differ.
pub(super) fn difference(curve: &ForceCurve, reference: &ForceCurve) -> Option<f64> {
    let largest = reference
        .iter()
        .flatten()
        .map(|point| point[1].abs())
        .fold(0.0, f64::max);
    if curve.len() != reference.len() || largest == 0.0 || largest.is_nan() {
        return None;
    }
    let mut most = 0.0;
    for (stage, reference) in curve.iter().zip(reference) {
        most = f64::max(most, mean_difference(stage, reference)? / largest);
    }
    Some(most)
}

/// Returns the mean absolute difference in N between the forces of two curves, at indentations of
/// the second curve. Returns `None` if a curve has no points.
fn mean_difference(curve: &[[f64; 2]], reference: &[[f64; 2]]) -> Option<f64> {
    let first = reference.first()?[0];
    let last = reference.last()?[0];
    let mut sum = 0.0;
    for index in 0..COMPARED {
        let indentation = first + (last - first) * (index as f64 + 0.5) / COMPARED as f64;
        sum += (force(curve, indentation)? - force(reference, indentation)?).abs();
    }
    Some(sum / COMPARED as f64)
}

/// Returns the force of a curve at an indentation. Beyond an end of the curve, returns the force at
/// this end. Returns `None` if the curve has no points.
fn force(curve: &[[f64; 2]], indentation: f64) -> Option<f64> {
    let above = curve
        .partition_point(|point| point[0] < indentation)
        .min(curve.len().checked_sub(1)?);
    let [low, before] = curve[above.saturating_sub(1)];
    let [high, after] = curve[above];
    let share = if high > low {
        ((indentation - low) / (high - low)).clamp(0.0, 1.0)
    } else {
        1.0
    };
    Some(before + share * (after - before))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::open::open;

    fn closed_form(scene: &str, overrides: &[(&str, &str)]) -> Option<f64> {
        let overrides: Vec<_> = overrides
            .iter()
            .map(|(path, value)| (path.to_string(), value.to_string()))
            .collect();
        let document = open(scene).unwrap().set_all(&overrides).unwrap();
        Runs::new(&document.resolve(""), &|| false)
            .solve(document.scene())
            .unwrap()
            .closed_form
    }

    #[test]
    fn closed_forms_are_given_where_they_hold() {
        let sphere = closed_form("jkr-sphere", &[]).unwrap();
        assert!(
            (sphere / (1.5 * PI * 0.05 * 1e-4) - 1.0).abs() < 1e-12,
            "{sphere}"
        );
        assert!(closed_form("jkr-sphere", &[("loading", "[ToTouch, ToSeparation]")]).is_some());
        assert!(closed_form("kendall-punch", &[]).is_some());
        // These four scenes have no closed form: one is not pulled off, one has a profile that is
        // too short, one has no adhesion, and one has a rough body.
        let held = "[ToForce(1e-4), ToIndentation(0.0)]";
        assert_eq!(closed_form("jkr-sphere", &[("loading", held)]), None);
        assert_eq!(closed_form("jkr-sphere", &[("length", "2.0e-5")]), None);
        assert_eq!(closed_form("jkr-sphere", &[("adhesion", "None")]), None);
        assert_eq!(closed_form("rough-sphere", &[]), None);
    }

    #[test]
    fn springs_are_powers_of_two_that_the_scene_allows() {
        let fewest = |scene: &str| allowed_points(open(scene).unwrap().scene()).next();
        assert_eq!(fewest("jkr-sphere"), Some(16));
        assert_eq!(fewest("pressure-sensitive"), Some(1024));
        assert_eq!(fewest("million-springs"), Some(1 << 19));
        assert_eq!(
            allowed_points(open("jkr-sphere").unwrap().scene()).last(),
            Some(1 << 28)
        );
    }

    fn curve(points: &[[f64; 2]]) -> ForceCurve {
        vec![points.to_vec()]
    }

    #[test]
    fn a_late_jump_counts_its_share_of_the_indentations() {
        let jump = |at: f64| curve(&[[0.0, 0.0], [at, 0.0], [at, 1.0], [1.0, 1.0]]);
        let late = difference(&jump(0.51), &jump(0.5)).unwrap();
        assert!((late - 0.01).abs() < 1.0 / COMPARED as f64, "{late}");
        assert_eq!(difference(&jump(0.5), &jump(0.5)), Some(0.0));
    }

    #[test]
    fn a_wrong_force_counts_its_share_of_the_largest() {
        let flat = |force: f64| curve(&[[0.0, force], [2.0, force]]);
        let wrong = difference(&flat(-4.1), &flat(-4.0)).unwrap();
        assert!((wrong - 0.025).abs() < 1e-15, "{wrong}");
        // Beyond the end of the shorter curve, its last force counts.
        let short = curve(&[[0.0, 0.0], [1.0, 1.0]]);
        let long = curve(&[[0.0, 0.0], [2.0, 2.0]]);
        let wrong = difference(&short, &long).unwrap();
        assert!((wrong - 0.125).abs() < 1e-3, "{wrong}");
        assert_eq!(difference(&flat(1.0), &flat(0.0)), None);
        assert_eq!(difference(&flat(1.0), &Vec::new()), None);
        assert_eq!(difference(&vec![Vec::new()], &flat(1.0)), None);
    }
}
