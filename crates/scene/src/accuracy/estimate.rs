//! Estimated error of one outcome, by comparison with two further solutions.

use super::solution::{Errors, FEWEST, Runs, Solution, Target, loaded, refined, relative_error};
use crate::scene::checked::CheckedScene;
use crate::simulation::outcome::Outcome;
use asperity_contact::Edges;
use asperity_data::{Warning, per_cent};
use serde::Serialize;
use std::array;
use std::path::Path;

/// Largest number of springs of a further solution that serves only for an estimate.
const MOST_SPRINGS: u64 = 1 << 23;
/// Number of springs above which the Fourier transform takes most of the computing time.
const MANY_SPRINGS: u64 = 1 << 16;
/// Numbers of springs of the two further solutions, as fractions of the number of springs of the
/// scene. The second pair is used if the waves of the scene need more springs than the first pair
/// has.
const OTHERS: [[Ratio; 2]; 2] = [[ratio(7, 8), ratio(2, 3)], [ratio(3, 2), ratio(2, 1)]];
/// Ratio of the estimated error to the larger of the two differences from the further solutions.
///
/// The further solutions always have edges between springs, for two reasons. First, solutions with
/// whole springs on several grids may agree by chance. Second, if the scene itself has whole
/// springs, its solution differs from the further solutions by its whole error, which is of first
/// order in the spacing.
///
/// An error that falls with the square of the spacing is smaller than the difference from the
/// solution with 2/3 of the springs. On rough profiles, however, errors change sign by chance. With
/// this factor, on random scenes at least 95 of 100 true errors are within the estimate, and the
/// median of the ratio of the estimate to the true error is at most ten
/// (`tests/program/estimates.rs`).
const FACTOR: f64 = 4.0;
/// Relative difference of two pull-off forces above which F_a(F_n), the pull-off force as a
/// function of the preload, may have a step between them.
const STEP: f64 = 0.05;
/// Factors by which the loads of a scene are multiplied, to find out whether a step is nearby.
const NEAR: [f64; 2] = [0.95, 1.05];

/// Ratio between two numbers of springs.
#[derive(Clone, Copy)]
struct Ratio {
    numerator: u64,
    denominator: u64,
}

const fn ratio(numerator: u64, denominator: u64) -> Ratio {
    Ratio {
        numerator,
        denominator,
    }
}

/// Estimated relative error that the finite number of springs causes in an [`Outcome`]. The error
/// is that of the pull-off force or of the force curve.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Estimate {
    /// Quantity whose error is estimated: pull-off force or force curve.
    pub target: Target,
    /// Estimated relative error of `target`.
    pub error: f64,
    /// True if the pull-off force F_a, as a function of the preload, has a step near the preload of
    /// the scene. The estimate compares the outcome with two further solutions. A step is assumed
    /// if two conditions hold:
    ///
    /// * F_a of one of the two solutions differs from F_a of the outcome by more than 5 %.
    /// * The difference is at least three times smaller if the loads of this solution are 5 %
    ///   smaller or larger.
    pub near_step: bool,
    /// How the error was found: by an exact formula, or by solutions with other numbers of springs.
    pub evidence: Evidence,
}

impl Estimate {
    /// Returns the estimated absolute error of the pull-off force of `outcome` in N. Returns `None`
    /// if the estimate is for the force curve ([`Target::Curve`]).
    pub fn of_pull_off_force(&self, outcome: &Outcome) -> Option<f64> {
        if self.target != Target::PullOffForce {
            return None;
        }
        let error = self.error * outcome.figures.pull_off_force?.abs();
        error.is_finite().then_some(error)
    }

    /// Returns the estimated relative error of the force curve; [`Target::Curve`] defines this
    /// error. Returns `None` if the estimate is for the pull-off force.
    pub fn of_curve(&self) -> Option<f64> {
        let is_known = self.target == Target::Curve && self.error.is_finite();
        is_known.then_some(self.error)
    }

    /// Returns the text that follows the pull-off force in summaries, such as `grid ± 0.1 %`. If
    /// [`near_step`](Self::near_step) is true, the text is `near a step of F_a(F_n)`, where F_a is
    /// the pull-off force and F_n the preload.
    pub fn words(&self) -> String {
        match self.target {
            Target::PullOffForce if self.near_step => "near a step of F_a(F_n)".to_owned(),
            Target::PullOffForce => format!("grid ± {}", per_cent(self.error)),
            Target::Curve => format!("grid ± {} of the curve", per_cent(self.error)),
        }
    }
}

/// How the error of an [`Estimate`] was found.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Evidence {
    /// By an exact formula for the pull-off force. The estimate is then the true error.
    ClosedForm,
    /// By comparison with two further solutions of the same scene. The list has their numbers of
    /// springs. The edges of their contact patches lie between springs ([`Edges::SubCell`]).
    Solutions(Vec<u64>),
}

/// Estimates the relative error that the finite number of springs causes in `outcome`, the result
/// of `scene`. The error is that of the pull-off force or, if the loading has no tensile force,
/// that of the force curve. Names of measured files are relative to `folder`.
///
/// If the pull-off force has a closed form, the estimate is the true error. Otherwise the estimate
/// follows from two further solutions with other numbers of springs, and the true error exceeds the
/// estimate in about 5 of 100 cases.
///
/// Returns `None` in these cases:
///
/// * there is neither a pull-off force nor a force curve;
/// * `stop` returns true;
/// * one of the two further solutions fails;
/// * the contact reaches the ends of the profile of a curved body, because more springs would then
///   not lead to the forces of this body.
///
/// ```
/// use asperity_contact::{Modulus, Move};
/// use asperity_scene::{Adhesion, ProfileBuilder, Simulation, estimate};
/// use std::path::Path;
///
/// let rough = ProfileBuilder::new(1.0e-4, 1024).self_affine(0.7).rms_height(1.0e-7).modes(1, 64);
/// let (modulus, adhesion) = (Modulus::effective(2.0e6)?, Some(Adhesion::by_work(0.02)));
/// let scene = rough.scene(modulus, adhesion, &[Move::ToForce(1.0e-4), Move::ToSeparation])?;
/// let outcome = Simulation::default().compute(&scene)?;
/// let estimated = estimate(&scene, Path::new(""), &outcome, &|| false).unwrap();
/// assert!(estimated.of_pull_off_force(&outcome) < outcome.figures.pull_off_force);
/// # Ok::<(), asperity_scene::Error>(())
/// ```
pub fn estimate(
    scene: &CheckedScene,
    folder: &Path,
    outcome: &Outcome,
    stop: &dyn Fn() -> bool,
) -> Option<Estimate> {
    if outcome.warnings.iter().any(Warning::leaves_errors_unknown) {
        return None;
    }
    let own = Solution::of_target(scene, outcome);
    let target = Target::of(&own);
    if let (Some(exact), Some(force)) = (own.closed_form, own.pull_off_force) {
        let error = relative_error(force, exact);
        return Some(Estimate {
            target,
            error,
            near_step: false,
            evidence: Evidence::ClosedForm,
        });
    }
    // If 7/8 or 2/3 of the springs of the scene are too few for the shortest wave, the further
    // solutions have about 3/2 and about 2 times as many springs as the scene.
    let mut runs = Runs::new(folder, stop);
    let further = further_solutions(&target.only(scene).ok()?, &mut |scene| {
        runs.solve(scene).ok()
    })?;
    let differences = further
        .each_ref()
        .map(|further| difference(target, &further.solution, &own));
    let mut near_step = false;
    if target == Target::PullOffForce {
        for (further, difference) in further.iter().zip(differences) {
            near_step = near_step || is_near_step(&further.scene, difference, &own, &mut runs);
        }
    }
    let [first, second] = differences;
    Some(Estimate {
        target,
        error: FACTOR * first?.max(second?),
        near_step,
        evidence: Evidence::Solutions(
            further
                .iter()
                .map(|further| further.solution.points)
                .collect(),
        ),
    })
}

/// Returns the relative difference between two solutions. Each solution serves as the reference
/// once, and the larger of the two differences is returned.
fn difference(target: Target, solution: &Solution, own: &Solution) -> Option<f64> {
    let from_own = target.difference(solution, own)?;
    Some(from_own.max(target.difference(own, solution)?))
}

/// Returns true if the pull-off force of a further solution differs because of a step of F_a(F_n).
/// `step` is the relative difference. The difference is due to a step if it is much smaller at
/// loads near the loads of the scene.
fn is_near_step(
    scene: &CheckedScene,
    step: Option<f64>,
    own: &Solution,
    runs: &mut Runs<'_>,
) -> bool {
    let Some(step) = step.filter(|step| *step > STEP) else {
        return false;
    };
    NEAR.into_iter().any(|factor| {
        difference_under_load(scene, factor, own, runs)
            .is_some_and(|difference| difference < step / 3.0)
    })
}

/// Returns the relative difference of the pull-off force after all loads of the scene are
/// multiplied by `factor`. Returns `None` if the scene with these loads has no solution.
fn difference_under_load(
    scene: &CheckedScene,
    factor: f64,
    own: &Solution,
    runs: &mut Runs<'_>,
) -> Option<f64> {
    let solution = runs.solve(&loaded(scene, factor)?).ok()?;
    difference(Target::PullOffForce, &solution, own)
}

/// Estimates the relative errors of a solution whose patches have their edges between springs: the
/// errors of the pull-off force, the force curve, the dissipated energy and the largest contact
/// length. The pull-off force is compared at the loads of the scene and at half and twice these
/// loads. Returns `None` if the further solutions that this needs cannot be computed.
pub(super) fn own_errors(
    scene: &CheckedScene,
    finest: &Solution,
    runs: &mut Runs<'_>,
) -> Option<Errors> {
    let scene = refined(scene, finest.points, Edges::SubCell).ok()?;
    let [first, second] = further_solutions(&scene, &mut |scene| runs.solve_around(scene).ok())?;
    let first = first.solution.errors(finest);
    let second = second.solution.errors(finest);
    Some(array::from_fn(|index| {
        Some(FACTOR * first[index]?.max(second[index]?))
    }))
}

/// A scene with another number of springs, and its solution.
struct Further {
    scene: CheckedScene,
    solution: Solution,
}

/// Solves a scene with two other numbers of springs, and with edges between springs. Returns `None`
/// if these numbers are not allowed or if there is no solution.
fn further_solutions(
    scene: &CheckedScene,
    solve: &mut dyn FnMut(&CheckedScene) -> Option<Solution>,
) -> Option<[Further; 2]> {
    for [first, second] in OTHERS {
        if let Some(first) = with_springs(scene, first)
            && let Some(second) = with_springs(scene, second)
        {
            let first = Further {
                solution: solve(&first)?,
                scene: first,
            };
            let second = Further {
                solution: solve(&second)?,
                scene: second,
            };
            return Some([first, second]);
        }
    }
    None
}

/// Returns the scene with edges between springs and with about `ratio` times as many springs.
/// Returns `None` if this number of springs is not allowed.
fn with_springs(scene: &CheckedScene, ratio: Ratio) -> Option<CheckedScene> {
    let own = scene.numerics.points;
    let points = apart_from(own.saturating_mul(ratio.numerator) / ratio.denominator);
    let is_other = points != own && (points < own) == (ratio.numerator < ratio.denominator);
    if !is_other || !(FEWEST..=MOST_SPRINGS).contains(&points) {
        return None;
    }
    refined(scene, points, Edges::SubCell).ok()
}

/// Returns the smallest suitable number of springs that is at least `least`. A suitable number has
/// no prime factor above 13, so that a Fourier transform is fast. For few springs the number is
/// odd. For many springs it is twice an odd number, because the transform takes most of the time
/// and would take twice as long with an odd number.
///
/// The positions of the springs then hardly coincide with those of the scene, wherever the axis of
/// a form is. An even and an odd number have no position in common, and a power of two and twice an
/// odd number have two. Equal heights therefore never result from equal positions.
fn apart_from(least: u64) -> u64 {
    let factor = if least < MANY_SPRINGS { 1 } else { 2 };
    let first_odd = least.div_ceil(factor) | 1;
    (first_odd..)
        .step_by(2)
        .find(|odd| has_small_factors(*odd))
        .map_or(least, |odd| factor * odd)
}

/// Returns true if an odd number has no prime factor above 13.
fn has_small_factors(odd: u64) -> bool {
    let mut quotient = odd;
    for prime in [3, 5, 7, 11, 13] {
        while quotient.is_multiple_of(prime) {
            quotient /= prime;
        }
    }
    quotient == 1
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::document::Document;
    use crate::scene::open::open;
    use crate::simulation::stages::Simulation;

    fn run(document: &Document) -> Outcome {
        Simulation::default().compute(document.scene()).unwrap()
    }

    fn estimated(document: &Document) -> Option<Estimate> {
        estimate(document.scene(), Path::new(""), &run(document), &|| false)
    }

    fn with(scene: &str, fields: &[(&str, &str)]) -> Document {
        let fields: Vec<_> = fields
            .iter()
            .map(|(path, value)| (path.to_string(), value.to_string()))
            .collect();
        open(scene).unwrap().set_all(&fields).unwrap()
    }

    #[test]
    fn errors_have_one_digit_and_two_after_a_one() {
        let words = |target, error| {
            Estimate {
                target,
                error,
                near_step: false,
                evidence: Evidence::ClosedForm,
            }
            .words()
        };
        let errors = [0.0042, 0.0104, 0.0148, 0.0096, 0.123, 1.5, 2.3e-5, 9e-6];
        let texts = [
            "0.4 %",
            "1 %",
            "1.5 %",
            "1 %",
            "12 %",
            "> 100 %",
            "0.002 %",
            "< 0.001 %",
        ];
        for (error, text) in errors.into_iter().zip(texts) {
            assert_eq!(
                words(Target::PullOffForce, error),
                format!("grid ± {text}"),
                "{error}"
            );
        }
        assert_eq!(words(Target::Curve, 0.9), "grid ± 90 % of the curve");
    }

    #[test]
    fn a_closed_form_gives_the_error_itself() {
        let document = with(
            "jkr-sphere",
            &[("numerics.points", "1024"), ("numerics.edges", "Grid")],
        );
        let Estimate {
            error, evidence, ..
        } = estimated(&document).unwrap();
        let force = run(&document).figures.pull_off_force.unwrap();
        let expected = (force / (1.5 * std::f64::consts::PI * 0.05 * 1e-4) - 1.0).abs();
        assert!(
            evidence == Evidence::ClosedForm && (error / expected - 1.0).abs() < 1e-9,
            "{error}"
        );
    }

    #[test]
    fn the_evidence_is_what_the_scene_allows() {
        let evidence = |fields: &[(&str, &str)]| {
            estimated(&with("pressure-sensitive", fields)).map(|one| one.evidence)
        };
        let solutions = |springs: &[u64]| Some(Evidence::Solutions(springs.to_vec()));
        assert_eq!(
            evidence(&[("numerics.points", "8192")]),
            solutions(&[7203, 5577])
        );
        // 512 modes need 1024 springs, so both further solutions must have more springs than the
        // scene.
        assert_eq!(
            evidence(&[("numerics.points", "1024")]),
            solutions(&[1573, 2079])
        );
        assert_eq!(
            evidence(&[("numerics.points", "1025")]),
            solutions(&[1573, 2079])
        );
        // The first odd number from 7/8 of 33 upwards that suits a transform is 33 itself. The
        // further solutions therefore have more springs than the scene.
        let few = [("roughness.modes", "(1, 4)"), ("numerics.points", "33")];
        assert_eq!(evidence(&few), solutions(&[49, 75]));
        // The estimate also covers the errors of whole springs and of the steps of the stepwise
        // solver.
        let few = [("roughness.modes", "(1, 64)"), ("numerics.edges", "Grid")];
        let on = |points, solver| {
            let numerics = [("numerics.points", points), ("numerics.solver", solver)];
            with("pressure-sensitive", &[&few[..], &numerics].concat())
        };
        let force = |document: &Document| run(document).figures.pull_off_force.unwrap();
        let truth = force(&on("131072", "Exact"));
        for solver in ["Exact", "Stepwise(step: 2e-9)", "Stepwise(step: 2e-8)"] {
            let document = on("512", solver);
            let (stated, error) = (
                estimated(&document).unwrap().error,
                relative_error(force(&document), truth),
            );
            assert!(
                (1.0..10.0).contains(&(stated / error)),
                "{solver}: {stated} for {error}"
            );
        }
        // Without a tensile force the error refers to the curve. Without a contact there is no
        // estimate.
        let bare = with(
            "pressure-sensitive",
            &[("adhesion", "None"), ("numerics.points", "4096")],
        );
        assert_eq!(estimated(&bare).unwrap().target, Target::Curve);
        assert_eq!(estimated(&bare.set("loading", "[ToTouch]").unwrap()), None);
        assert_eq!(
            estimate(bare.scene(), Path::new(""), &run(&bare), &|| true),
            None
        );
    }
}
