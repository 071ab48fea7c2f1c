//! Estimated error of one outcome, from a few more solutions.

use super::convergence::error_of_finest;
use super::solution::{Solution, Solved, Target, closed_form_adhesion, refined, relative_error, solve};
use crate::scene::{Edges, Scene, Solver, check};
use crate::simulation::{Outcome, RunError, Simulation};
use crate::text::per_cent;
use serde::Serialize;
use std::collections::VecDeque;
use std::path::Path;

/// Most springs of a finer solution for an estimate only, and of a coarser one.
const MOST_FINER: u64 = 1 << 20;
const MOST_COARSER: u64 = 1 << 22;
/// Fewest springs from which the error with more springs can be estimated.
const FEWEST_SPRINGS: u64 = 16;
/// Wanted solutions of an estimate, including the outcome: one difference may be small by chance, three in a row
/// seldom are.
const WANTED: usize = 4;
/// Fewest sufficient solutions, for which no finer ones are computed.
const ENOUGH: usize = 3;

/// The estimated relative error of an outcome.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Estimate {
    /// Quantity of the error.
    pub target: Target,
    /// The relative error.
    pub error: f64,
    /// Basis of the estimate.
    pub evidence: Evidence,
}

impl Estimate {
    /// Absolute error of the adhesion force of an outcome, N; `None` for an estimate of the curve.
    #[must_use]
    pub fn of_adhesion_force(&self, outcome: &Outcome) -> Option<f64> {
        let force = outcome.figures.adhesion_force.filter(|_| self.target == Target::AdhesionForce)?;
        Some(self.error * force.abs()).filter(|error| error.is_finite())
    }

    /// The error in per cent, with one digit, or two after a leading one, according to the accuracy of an estimate.
    #[must_use]
    pub fn per_cent(&self) -> String {
        per_cent(self.error)
    }
}

/// Basis of an estimate.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Evidence {
    /// A closed form: the value is the error itself.
    ClosedForm,
    /// Solutions of the same profile with these numbers of springs, by the same rule of edges.
    Solutions(Vec<u64>),
}

/// Estimates the error of the adhesion force of an outcome, or of its force curve without a tensile force.
///
/// A closed form yields the error itself. Otherwise the same profile is solved with half, a quarter and an eighth
/// of the springs by the same rule of edges, and [`error_of_finest`] returns the error from the differences. A
/// profile whose modes need too many springs for that is solved with twice and four times as many instead. The
/// error of the step of the stepwise solver is its distance from the exact solver on the same springs.
///
/// `None` if the error is unknown: there is no figure, no other number of springs is allowed, too many would be
/// needed, or `stop` ended the computation.
///
/// # Errors
/// A failure of one of these solutions.
pub fn estimate(
    scene: &Scene,
    folder: &Path,
    outcome: &Outcome,
    stop: &dyn Fn() -> bool,
) -> Result<Option<Estimate>, RunError> {
    let own = Solution::of(outcome);
    let target = Target::of(&own);
    if let (Some(exact), Some(force)) = (closed_form_adhesion(scene, outcome), own.adhesion_force) {
        let error = relative_error(force, exact);
        return Ok(Some(Estimate { target, error, evidence: Evidence::ClosedForm }));
    }
    let points = scene.numerics.points;
    let mut simulation = Simulation::new(folder.to_path_buf());
    let mut solved = |points: u64, most: u64| -> Result<Option<Solution>, RunError> {
        let other = on_springs(scene, points);
        let allowed = (FEWEST_SPRINGS..=most).contains(&points) && check(&other).is_empty();
        if !allowed || stop() {
            return Ok(None);
        }
        Ok(match solve(&mut simulation, &other, stop)? {
            Solved::Outcome(outcome) => Some(Solution::of(&outcome)),
            Solved::TooCoarse | Solved::TooMuch => None,
        })
    };
    // The stepwise solver converges to the exact one with its step.
    let (exact, of_step) = if scene.numerics.solver == Solver::Exact {
        (own, 0.0)
    } else {
        let Some(exact) = solved(points, MOST_FINER)? else { return Ok(None) };
        let Some(of_step) = target.difference(&own, &exact) else { return Ok(None) };
        (exact, of_step)
    };
    // From coarse to fine, including the exact solution on the scene's own springs.
    let mut solutions = VecDeque::from([exact]);
    let mut coarser = points;
    while solutions.len() < WANTED && coarser.is_multiple_of(2) {
        coarser /= 2;
        let Some(solution) = solved(coarser, MOST_COARSER)? else { break };
        solutions.push_front(solution);
    }
    let place = solutions.len() - 1;
    let mut finer = points;
    while solutions.len() < ENOUGH {
        finer = finer.saturating_mul(2);
        let Some(solution) = solved(finer, MOST_FINER)? else { break };
        solutions.push_back(solution);
    }
    if stop() {
        return Ok(None);
    }
    let pairs = solutions.iter().zip(solutions.iter().skip(1));
    let differences: Option<Vec<f64>> = pairs.map(|(coarse, fine)| target.difference(coarse, fine)).collect();
    let Some(differences) = differences.filter(|differences| !differences.is_empty()) else {
        return Ok(None);
    };
    let to_finest: f64 = differences.iter().skip(place).sum();
    let error = of_step + to_finest + error_of_finest(&differences);
    let others = solutions.iter().map(|solution| solution.points).filter(|&others| others != points);
    Ok(Some(Estimate { target, error, evidence: Evidence::Solutions(others.collect()) }))
}

/// This scene on so many springs, solved exactly with its own rule of edges.
fn on_springs(scene: &Scene, points: u64) -> Scene {
    // The stepwise solver has edges at the springs.
    let edges = if scene.numerics.solver == Solver::Exact { scene.numerics.edges } else { Edges::Grid };
    refined(scene, points, edges)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Document, open};
    use crate::simulation::Simulation;

    fn run(document: &Document) -> Outcome {
        Simulation::default().run(document.scene(), &|| false, &mut |_, _, _| Ok(())).unwrap()
    }

    fn estimated(document: &Document) -> Option<Estimate> {
        estimate(document.scene(), Path::new(""), &run(document), &|| false).unwrap()
    }

    fn with(scene: &str, fields: &[(&str, &str)]) -> Document {
        let fields: Vec<_> =
            fields.iter().map(|(path, value)| (path.to_string(), value.to_string())).collect();
        open(scene).unwrap().set_all(&fields).unwrap()
    }

    #[test]
    fn errors_have_one_digit_and_two_after_a_one() {
        for (error, text) in [
            (0.0042, "0.4 %"),
            (0.0104, "1 %"),
            (0.0148, "1.5 %"),
            (0.0096, "1 %"),
            (0.123, "12 %"),
            (0.9, "90 %"),
            (1.5, "> 100 %"),
            (2.3e-5, "0.002 %"),
            (9e-6, "< 0.001 %"),
            (0.0, "< 0.001 %"),
        ] {
            let estimate = Estimate { target: Target::Curve, error, evidence: Evidence::ClosedForm };
            assert_eq!(estimate.per_cent(), text, "{error}");
        }
    }

    #[test]
    fn a_closed_form_gives_the_error_itself() {
        let document = with("jkr-sphere", &[("numerics.points", "1024"), ("numerics.edges", "Grid")]);
        let estimate = estimated(&document).unwrap();
        let exact = 1.5 * std::f64::consts::PI * 0.05 * 1e-4;
        let error = (run(&document).figures.adhesion_force.unwrap() / exact - 1.0).abs();
        assert_eq!((estimate.target, &estimate.evidence), (Target::AdhesionForce, &Evidence::ClosedForm));
        assert!((estimate.error / error - 1.0).abs() < 1e-9);
    }

    #[test]
    fn estimates_seldom_promise_more_than_there_is() {
        let (mut kept, mut all) = (0, 0);
        for edges in ["Grid", "SubCell"] {
            for scene in ["pressure-sensitive", "rough-sphere"] {
                for seed in ["1", "2", "3", "4"] {
                    let on = |points: &str, edges: &str| {
                        with(
                            scene,
                            &[
                                ("numerics.points", points),
                                ("numerics.edges", edges),
                                ("roughness.seed", seed),
                            ],
                        )
                    };
                    let truth = run(&on("131072", "SubCell")).figures.adhesion_force.unwrap();
                    for points in ["1024", "2048", "4096", "8192"] {
                        let document = on(points, edges);
                        let error = relative_error(run(&document).figures.adhesion_force.unwrap(), truth);
                        let estimate = estimated(&document).unwrap().error;
                        all += 1;
                        kept += i32::from(error < 2.0 * estimate);
                        assert!(
                            error < 10.0 * estimate,
                            "{scene} {seed} {points} {edges}: {estimate} for {error}"
                        );
                        // The estimates are not too large to be useful either.
                        assert!(estimate < 0.2, "{scene} {seed} {points} {edges}: {estimate}");
                    }
                }
            }
        }
        assert!(10 * kept >= 9 * all, "{kept} of {all} within twice the estimate");
    }

    #[test]
    fn the_evidence_is_what_the_scene_allows() {
        let evidence =
            |fields: &[(&str, &str)]| estimated(&with("pressure-sensitive", fields)).map(|one| one.evidence);
        let solutions = |springs: &[u64]| Some(Evidence::Solutions(springs.to_vec()));
        assert_eq!(evidence(&[("numerics.points", "8192")]), solutions(&[1024, 2048, 4096]));
        // 512 modes need 1024 springs.
        assert_eq!(evidence(&[("numerics.points", "2048")]), solutions(&[1024, 4096]));
        assert_eq!(evidence(&[("numerics.points", "1024")]), solutions(&[2048, 4096]));
        assert_eq!(evidence(&[("numerics.points", "1025")]), solutions(&[2050, 4100]));
        let few = [("roughness.modes", "(1, 64)"), ("numerics.points", "512"), ("numerics.edges", "Grid")];
        let exact = estimated(&with("pressure-sensitive", &few)).unwrap();
        let stepwise = estimated(&with(
            "pressure-sensitive",
            &[&few[..], &[("numerics.solver", "Stepwise(step: 2e-9)")]].concat(),
        ));
        assert!(stepwise.unwrap().error > exact.error);
        // No tensile force: the curve.
        let bare = with("pressure-sensitive", &[("adhesion", "None"), ("numerics.points", "4096")]);
        assert_eq!(estimated(&bare).unwrap().target, Target::Curve);
        // No contact at all.
        let still = with(
            "pressure-sensitive",
            &[("loading", "[ToTouch]"), ("adhesion", "None"), ("numerics.points", "4096")],
        );
        assert_eq!(estimated(&still), None);
        assert_eq!(estimate(bare.scene(), Path::new(""), &run(&bare), &|| true), Ok(None));
    }
}
