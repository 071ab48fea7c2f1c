//! The inverse question: at which value of a number of a scene, or at which preload, does a
//! quantity reach a target?
//!
//! Each profile is searched separately. The pull-off force never falls with the preload. It
//! therefore crosses the target only once, and bisection finds this crossing between two preloads.
//! Any other quantity is first computed at several numbers over the searched range.

use super::axis::Axis;
use super::error::StudyError;
use super::plan::Plan;
use super::premises::warnings_on_profiles;
use super::profiles::on_profiles;
use super::question::{Answer, Question};
use asperity_contact::Move;
use asperity_data::{Control, CountedWarning, Remedy, format_quantity, format_range, quantile};
use asperity_scene::{CheckedScene, Simulation};

/// Largest relative change of a quantity over the searched range with which the number counts as
/// having no influence on it. A small change may have another cause: the error due to the finite
/// number of springs changes with the scene.
const STILL: f64 = 1e-3;

/// Answers to a [`Question`]: for each random profile, the values of one number of the scene, such
/// as the work of adhesion, at which a quantity reaches a target.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// Question that is answered on each profile.
    pub question: Question,
    /// Answers, one for each profile, sorted by the seeds of the profiles.
    pub answers: Vec<Answer>,
    /// Reason why the scene could not be computed with one of the values that the search tried.
    /// `None` if the scene could be computed with all tried values.
    pub refused: Option<String>,
    /// Premises of the model that the profiles do not meet, each with the number of profiles that
    /// do not meet it. The premises are checked on the scene with the median answer, or on the
    /// scene of the question if there is no median answer.
    pub warnings: Vec<CountedWarning>,
}

/// Returns the smallest range that contains all given ranges; `None` if no range is given.
fn enclosing(ranges: impl Iterator<Item = Option<(f64, f64)>>) -> Option<(f64, f64)> {
    ranges
        .flatten()
        .reduce(|all, next| (all.0.min(next.0), all.1.max(next.1)))
}

impl Found {
    /// Answers a question on all its random profiles. `control` reports the number of finished
    /// profiles.
    ///
    /// # Errors
    /// Returns an error if zero threads are requested, if [`Question::searched`] is not a finite
    /// range, if the scene does not have the quantity, or if the number does not change the
    /// quantity. It is also an error if a profile cannot be computed, or if `control` stops the
    /// computation.
    ///
    /// ```
    /// use asperity_data::Control;
    /// use asperity_scene::Simulation;
    /// use asperity_study::{Found, Quantity, Question};
    ///
    /// // The pull-off force of a sphere is (3/2)πγR.
    /// let scene = asperity_scene::open("jkr-sphere")?.set("numerics.points", "1024")?;
    /// let simulation = &mut Simulation::default();
    /// let condition = (Quantity::PullOffForce, 1e-5);
    /// let question = Question::new(scene.scene(), "adhesion.work", condition, 1, simulation)?;
    /// let found = Found::of(question, simulation, Control::default())?;
    /// let work = found.quantile(0.5).expect("the force is within reach");
    /// assert!((work / (1e-5 / (1.5 * std::f64::consts::PI * 1e-4)) - 1.0).abs() < 1e-3);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn of(
        question: Question,
        simulation: &mut Simulation,
        mut control: Control<'_>,
    ) -> Result<Found, StudyError> {
        StudyError::check_threads(control.threads())?;
        question.check()?;
        let plan = &question.plan;
        let lines: Vec<u64> = (0..plan.lines).collect();
        let stop = control.stop();
        let mut answers = vec![Answer::default(); lines.len()];
        let mut reasons = vec![None; lines.len()];
        let mut finished = 0;
        on_profiles(
            plan,
            &lines,
            simulation,
            control.threads(),
            |simulation: &mut Simulation, line| question.answer(simulation, line, stop),
            &mut |line, (answer, reason)| {
                answers[line as usize] = answer;
                reasons[line as usize] = reason;
                finished += 1;
                control.report(finished);
            },
        )?;
        let refused = reasons.into_iter().flatten().next();
        let mut found = Found {
            question,
            answers,
            refused,
            warnings: Vec::new(),
        };
        found.check()?;
        if let Some(scene) = found.answered_scene() {
            let profiles = found.question.profiles();
            let control = control.of_part();
            found.warnings = warnings_on_profiles(&scene, profiles, simulation, control)?;
        }
        Ok(found)
    }

    /// Returns the scene of the question with the median answer as the value of the number. If
    /// there is no median answer, or if a scene cannot have this value, returns the scene of the
    /// question itself. Returns `None` if this scene is not allowed either.
    fn answered_scene(&self) -> Option<CheckedScene> {
        let plan = &self.question.plan;
        let asked = plan.scene.clone().checked().ok()?;
        let Some(value) = self.quantile(0.5) else {
            return Some(asked);
        };
        let answered = if self.question.is_of_preload() {
            let loading = vec![Move::ToForce(value), Move::ToSeparation];
            asked.with(|scene| scene.loading = loading)
        } else {
            let axis = Axis {
                values: vec![value],
                ..self.question.axis.clone()
            };
            let plan_of_answer = Plan {
                axes: vec![axis],
                ..plan.clone()
            };
            plan_of_answer.scene_of(0)
        };
        Some(answered.unwrap_or(asked))
    }

    /// Returns an error if the quantity has no value on any profile, if no loading can reach a
    /// preload, or if the number has no influence on the quantity.
    fn check(&self) -> Result<(), StudyError> {
        let question = &self.question;
        let is_of_preload = question.is_of_preload();
        if let Some(reason) = &self.refused
            && is_of_preload
        {
            return Err(match reason.split_once("; allowed: ") {
                Some((found, allowed)) => question.refused(found, allowed),
                None => {
                    let error = question.refused(reason, "a smaller range");
                    error.with(Remedy::Range)
                }
            });
        }
        let name = question.quantity.symbol_or_name();
        let Some(reachable) = self.reachable() else {
            let mut found = format!("the scene has no {name}");
            if let Some(reason) = &self.refused {
                found += &format!(": {reason}");
            }
            return Err(question.refused(&found, "a quantity that the scene has"));
        };
        if is_of_preload || !self.answers.iter().all(is_still) {
            return Ok(());
        }
        let unit = question.quantity.unit();
        let values = if self.answers.len() > 1 {
            format_range(reachable, 4, unit)
        } else {
            format_quantity(reachable.1, unit)
        };
        let range = format_range(question.searched, 4, question.axis.unit);
        let found = format!("does not act on {name}, which is {values} from {range}");
        Err(question.refused(&found, "a number that changes the quantity"))
    }

    /// Returns for each profile the smallest value of the sought number, in SI units, at which the
    /// quantity of the question crosses its target; `None` for a profile without a crossing in the
    /// searched range. If a preload is sought and the smallest searched preload already reaches the
    /// target, this preload is returned.
    pub fn values(&self) -> Vec<Option<f64>> {
        self.answers
            .iter()
            .map(|answer| answer.value(&self.question))
            .collect()
    }

    /// Returns the number of profiles on which the quantity of the question does not cross its
    /// target in the searched range.
    pub fn unreached(&self) -> usize {
        self.values().iter().filter(|value| value.is_none()).count()
    }

    /// Returns the smallest and the largest value of the quantity that the search computed, over
    /// all profiles and all tried values of the sought number. `None` if the quantity has no value
    /// on any profile.
    pub fn reachable(&self) -> Option<(f64, f64)> {
        enclosing(self.answers.iter().map(|answer| answer.reachable))
    }

    /// Returns the range of values of the number for which the answers hold. It is the searched
    /// range, or only its computed part where the scene does not allow all searched values.
    pub fn answered_range(&self) -> (f64, f64) {
        let computed = enclosing(self.answers.iter().map(|answer| answer.computed));
        match computed {
            Some(range) if self.refused.is_some() => range,
            _ => self.question.searched,
        }
    }

    /// Returns the value of the number on each profile, in ascending order. A profile without a
    /// crossing has the value ∞ or −∞, depending on the end of the searched range beyond which its
    /// crossing must lie. For example, it is ∞ if the quantity rises with the number and is below
    /// the target.
    fn ascending(&self) -> Vec<f64> {
        let slopes = self
            .answers
            .iter()
            .map(|answer| i64::from(answer.reached[1]) - i64::from(answer.reached[0]));
        let rises = slopes.sum::<i64>() >= 0;
        let mut places = Vec::with_capacity(self.answers.len());
        for answer in &self.answers {
            let beyond = if answer.reached[1] == rises {
                f64::NEG_INFINITY
            } else {
                f64::INFINITY
            };
            places.push(answer.value(&self.question).unwrap_or(beyond));
        }
        places.sort_by(f64::total_cmp);
        places
    }

    /// Returns a quantile of the answers over all profiles, such as the median if `share` is 0.5.
    /// The answer of a profile is the value of the sought number, in SI units, at which the
    /// quantity of the question crosses its target. A profile without a crossing counts as beyond
    /// the searched range. Returns `None` if the quantile lies beyond this range.
    ///
    /// If only some values of the number are allowed, such as whole numbers or lengths with a whole
    /// number of waves, the allowed value nearest to the quantile is returned.
    pub fn quantile(&self, share: f64) -> Option<f64> {
        // A quantile interpolated between a finite and an infinite value is not finite.
        let value = quantile(&self.ascending(), share).filter(|value| value.is_finite())?;
        // A quantile between two values need not be allowed, such as 2.5 for a whole number.
        Some(self.question.allowed().nearest(value))
    }

    /// Returns the smallest and the largest answer over the profiles. The answer of a profile is
    /// the value of the sought number, in SI units, at which the quantity of the question crosses
    /// its target. `None` if no profile has an answer.
    pub fn range(&self) -> Option<(f64, f64)> {
        let values: Vec<f64> = self.values().into_iter().flatten().collect();
        let least = values.iter().copied().reduce(f64::min)?;
        let most = values.iter().copied().reduce(f64::max)?;
        Some((least, most))
    }
}

/// Returns true if the quantity is nearly constant over all searched numbers, or has no value.
fn is_still(answer: &Answer) -> bool {
    match answer.reachable {
        Some((least, most)) => most - least <= STILL * most.abs().max(least.abs()),
        None => true,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bracket::WITHIN;
    use crate::quantity::Quantity;
    use crate::results::Results;
    use asperity_scene::{Adhesion, open};
    use std::f64::consts::PI;

    fn scene(name: &str, points: u64) -> CheckedScene {
        open(name)
            .unwrap()
            .scene()
            .with(|scene| scene.numerics.points = points)
            .unwrap()
    }

    fn asked(
        scene: &CheckedScene,
        path: &str,
        condition: &str,
        profiles: u64,
        range: Option<(f64, f64)>,
        jobs: usize,
    ) -> Result<Found, String> {
        let mut simulation = Simulation::default();
        let condition = Question::parse_condition(condition).map_err(|error| error.to_string())?;
        let question = Question::new(scene, path, condition, profiles, &mut simulation);
        let mut question = question.map_err(|error| error.to_string())?;
        question.searched = range.unwrap_or(question.searched);
        let control = Control::default().on_threads(jobs);
        let found = Found::of(question, &mut simulation, control);
        found.map_err(|error| error.to_string())
    }

    /// Returns the quantity after a loading of a scene on one profile, computed without a search.
    fn alone(scene: &CheckedScene, seed: u64, loading: Move, quantity: Quantity) -> f64 {
        let loading = vec![loading, Move::ToSeparation];
        let scene = scene
            .with_seed(seed)
            .with(|scene| scene.loading = loading)
            .unwrap();
        let results = Results::of_scene(
            &scene,
            &[quantity],
            1,
            None,
            &mut Simulation::default(),
            Control::default(),
        );
        results.unwrap().value(0, 0, quantity).unwrap()
    }

    #[test]
    fn conditions_name_a_quantity_and_its_value() {
        for (text, quantity, target) in [
            ("F_a/F_a,max = 80 %", Quantity::AdhesionShare, 0.8),
            ("adhesion_share=0.8", Quantity::AdhesionShare, 0.8),
            ("F_a(F=0) = 2 uN", Quantity::ZeroForcePullOffForce, 2e-6),
            (
                "dissipated energy = 2.5 pJ",
                Quantity::DissipatedEnergy,
                2.5e-12,
            ),
            ("F_a/F_n=1e-2", Quantity::AdhesionCoefficient, 0.01),
        ] {
            assert_eq!(
                Question::parse_condition(text).ok(),
                Some((quantity, target)),
                "{text}"
            );
        }
        for (text, said) in [
            ("F_a", "such as \"F_a/F_a,max = 80 %\""),
            ("F_b = 1 uN", "no quantity"),
            ("adhesion_shar = 1", "did you mean adhesion_share?"),
            ("d = 1 nm", "preload_indentation, pull_off_indentation"),
            ("regime = 1", "regime is not a number"),
            (
                "F_a/F_a,max = 120 %",
                "F_a/F_a,max = 1.2; allowed: from 0 to 1",
            ),
            ("F_a = -1 uN", "allowed: at least 0 N"),
            ("F_a = 1 s", "s is not a unit of force"),
        ] {
            let error = Question::parse_condition(text).unwrap_err().to_string();
            assert!(error.contains(said), "{text}: {error}");
        }
    }

    /// For any preload the pull-off force of a sphere is (3/2)πγR.
    #[test]
    fn a_sphere_has_the_numbers_of_its_closed_form() {
        let sphere = scene("jkr-sphere", 1 << 12);
        let own = Simulation::default()
            .run(&sphere, &|| false, &mut |_, _, _| Ok(()))
            .unwrap();
        let exact = 1.5 * PI * 0.05 * 1e-4;
        // Relative error of the force due to the finite number of springs.
        let error = own.figures.pull_off_force.unwrap() / exact - 1.0;
        assert!(error.abs() < 1e-4, "{error}");
        for (path, slope) in [
            ("adhesion.work", 1.5 * PI * 1e-4),
            ("form.radius", 1.5 * PI * 0.05),
        ] {
            let found = asked(&sphere, path, "F_a = 30 uN", 1, None, 1).unwrap();
            let number = found.quantile(0.5).unwrap();
            assert!(
                (number * slope / 30e-6 - 1.0).abs() < 2e-4,
                "{path}: {number}"
            );
            assert_eq!(found.answers[0].crossings.len(), 1);
        }
        let any = asked(&sphere, "preload", "F_a = 20 uN", 1, None, 1).unwrap();
        assert_eq!(
            (any.answers[0].reached, any.answers[0].at_touch),
            ([true; 2], true)
        );
        assert_eq!(
            (any.quantile(0.5), any.answers[0].crossings.len()),
            (Some(0.0), 0)
        );
        let never = asked(&sphere, "preload", "F_a = 30 uN", 1, None, 1).unwrap();
        assert_eq!(
            (never.quantile(0.5), never.answers[0].reached),
            (None, [false; 2])
        );
        let (least, most) = never.reachable().unwrap();
        assert!((least / exact - 1.0).abs() < 1e-4 && (most / exact - 1.0).abs() < 1e-4);
        for (path, condition, said) in [
            (
                "material.youngs_modulus",
                "F_a = 30 uN",
                "material.youngs_modulus: does not act on F_a",
            ),
            (
                "roughness.hurst",
                "F_a = 30 uN",
                "the scene has no such number",
            ),
            ("form.radios", "F_a = 30 uN", "did you mean form.radius?"),
            ("form.radius", "κ = 2", "the scene has no κ"),
            ("loading.1.0", "F_a = 30 uN", "the scene has no such number"),
        ] {
            let error = asked(&sphere, path, condition, 1, None, 1).unwrap_err();
            assert!(error.contains(said), "{path}: {error}");
        }
        assert!(asked(&sphere, "form.radius", "F_a = 30 uN", 2, None, 1).is_err());
        let empty = asked(
            &sphere,
            "form.radius",
            "F_a = 30 uN",
            1,
            Some((2e-4, 1e-4)),
            1,
        )
        .unwrap_err();
        let far = asked(&sphere, "preload", "F_a = 30 uN", 1, Some((0.0, 1.0)), 1).unwrap_err();
        assert!(
            far.contains("preload: 1 N is far beyond full contact"),
            "{far}"
        );
        assert!(
            empty.contains("range 200 µm to 100 µm; allowed: two finite numbers"),
            "{empty}"
        );
    }

    /// At each preload that the search finds, the pull-off force jumps, to the stated precision. On
    /// a fine grid of preloads, no smaller preload reaches the target.
    #[test]
    fn preloads_are_at_the_steps_that_runs_show() {
        let rough = scene("pressure-sensitive", 2048);
        let (condition, target) = ("F_a = 10 uN", 10e-6);
        let found = asked(&rough, "preload", condition, 6, None, 2).unwrap();
        assert_eq!(
            asked(&rough, "preload", condition, 6, None, 1),
            Ok(found.clone())
        );
        let (mut inside, mut steps) = (0, 0);
        for (answer, value) in found.answers.iter().zip(found.values()) {
            let (seed, value) = (answer.seed.unwrap(), value.unwrap());
            let force =
                |preload| alone(&rough, seed, Move::ToForce(preload), Quantity::PullOffForce);
            assert!(force(value) >= target, "{seed}");
            if answer.crossings.is_empty() {
                assert_eq!(answer.step, None);
                continue;
            }
            // At most crossings the pull-off force jumps from below the target to above it.
            if let Some([below, at]) = answer.step {
                assert!(below < target, "{seed}");
                assert!((at / force(value) - 1.0).abs() < 1e-9, "{seed}");
                steps += 1;
            }
            inside += 1;
            assert!(force(value * (1.0 - 4.0 * WITHIN)) < target, "{seed}");
            assert!(
                (1..40).all(|part| force(value * f64::from(part) / 40.0) < target),
                "{seed}"
            );
        }
        assert!(inside > 3 && steps > 1, "{inside} {steps}");
        let mut values: Vec<f64> = found.values().into_iter().flatten().collect();
        values.sort_by(f64::total_cmp);
        assert_eq!(
            found.quantile(0.5),
            Some(f64::midpoint(values[2], values[3]))
        );
    }

    /// The number of patches of contact first rises with the preload, and then falls as patches
    /// merge. It therefore crosses the target at least twice.
    #[test]
    fn a_quantity_that_rises_and_falls_has_all_its_crossings() {
        let rough = scene("pressure-sensitive", 2048)
            .with(|scene| scene.adhesion = None)
            .unwrap();
        let (patches, target) = (Quantity::Patches, 12.0);
        let found = asked(&rough, "preload", "patches = 12", 1, None, 1).unwrap();
        let answer = &found.answers[0];
        let value = |preload| alone(&rough, 5, Move::ToForce(preload), patches);
        assert!(answer.crossings.len() >= 2, "{answer:?}");
        for crossing in &answer.crossings {
            let [before, after] = [1.0 - 1e-6, 1.0 + 1e-6].map(|factor| value(crossing * factor));
            assert!(
                before != target && after == target,
                "{crossing}: {before} {after}"
            );
        }
        assert_eq!(found.quantile(0.5), Some(answer.crossings[0]));
    }

    /// A profile without a crossing counts as beyond the searched range. If half of the profiles
    /// have no crossing, the median is unknown.
    #[test]
    fn medians_count_the_profiles_beyond_the_range() {
        let rough = scene("pressure-sensitive", 2048);
        let (scale, work) = ("adhesion.work", |found: &Found| found.values());
        let all = asked(&rough, scale, "F_a = 10 uN", 5, None, 2).unwrap();
        let mut values: Vec<f64> = work(&all).into_iter().flatten().collect();
        values.sort_by(f64::total_cmp);
        assert_eq!((values.len(), all.quantile(0.5)), (5, Some(values[2])));
        for (answer, value) in all.answers.iter().zip(work(&all)) {
            let reached = |factor: f64| {
                let work = factor * value.unwrap();
                let scene = rough
                    .with(|scene| scene.adhesion = Some(Adhesion::by_work(work)))
                    .unwrap();
                let force = alone(
                    &scene,
                    answer.seed.unwrap(),
                    Move::ToForce(1e-5),
                    Quantity::PullOffForce,
                );
                force >= 10e-6
            };
            assert_eq!([1.0 - 1e-7, 1.0].map(reached), [false, true], "{answer:?}");
        }
        // F_a rises with the work of adhesion. Two of the five profiles cross the target within
        // this range, and three above it.
        let range = (values[0] / 2.0, f64::midpoint(values[1], values[2]));
        let part = asked(&rough, scale, "F_a = 10 uN", 5, Some(range), 1).unwrap();
        assert_eq!(
            (work(&part).iter().flatten().count(), part.quantile(0.5)),
            (2, None)
        );
        assert!((part.quantile(0.25).unwrap() / values[1] - 1.0).abs() < 1e-8);
        assert_eq!(
            part.range()
                .map(|ends| (ends.0 / values[0] - 1.0).abs() < 1e-8),
            Some(true)
        );
    }

    /// F_a of a sphere does not depend on the preload F_n. F_a/F_n therefore equals the target at
    /// exactly one preload: F_a divided by the target.
    #[test]
    fn ratios_are_found_from_no_preload_upwards() {
        let sphere = scene("jkr-sphere", 1 << 10);
        let force = alone(&sphere, 0, Move::ToForce(1e-6), Quantity::PullOffForce);
        for ratio in [1e-2, 1.0, 100.0, 1e6] {
            let found = asked(
                &sphere,
                "preload",
                &format!("F_a/F_n = {ratio}"),
                1,
                None,
                1,
            )
            .unwrap();
            let answer = &found.answers[0];
            assert_eq!(
                (answer.crossings.len(), answer.is_proven, answer.may_miss),
                (1, true, false)
            );
            let preload = found.values()[0].unwrap();
            assert!(
                (preload * ratio / force - 1.0).abs() < 1e-12,
                "{ratio}: {preload}"
            );
            let there = alone(
                &sphere,
                0,
                Move::ToForce(preload),
                Quantity::AdhesionCoefficient,
            );
            assert!((there / ratio - 1.0).abs() < WITHIN, "{there}");
        }
        // A range that lies entirely below or above the answer contains no crossing.
        let range = |ends| asked(&sphere, "preload", "F_a/F_n = 100", 1, Some(ends), 1).unwrap();
        for (ends, reached) in [
            ((1e-6, 1e-3), [false; 2]),
            ((0.0, 1e-7), [true; 2]),
            ((1e-9, 1e-7), [true; 2]),
        ] {
            let found = range(ends);
            assert_eq!(
                (found.values(), found.unreached()),
                (vec![None], 1),
                "{ends:?}"
            );
            assert_eq!(found.answers[0].reached[1], reached[1], "{ends:?}");
            assert!(found.answers[0].is_proven);
        }
        // F_a/F_n has no value for a negative preload, so the answer is a positive preload.
        assert!((range((-1e-6, 1e-3)).values()[0].unwrap() * 100.0 / force - 1.0).abs() < 1e-12);
        let pulled = asked(
            &sphere,
            "preload",
            "F_a/F_n = 100",
            1,
            Some((-1e-6, -1e-7)),
            1,
        )
        .unwrap_err();
        assert!(pulled.contains("the scene has no F_a/F_n"), "{pulled}");
    }

    /// The target may equal the quantity at an end of the range, or along a constant part between
    /// two steps of F_a. The answer is then the first number at which the quantity has this value.
    #[test]
    fn targets_at_the_ends_and_on_stairs_are_reached_where_they_begin() {
        let sphere = scene("jkr-sphere", 1 << 10);
        let with_radius = |radius| {
            let scene = sphere
                .with(|scene| scene.form = Some(asperity_surface::Form::Paraboloid { radius }));
            alone(
                &scene.unwrap(),
                0,
                Move::ToForce(1e-4),
                Quantity::PullOffForce,
            )
        };
        let condition = format!("F_a = {:e} N", with_radius(2e-4));
        for ends in [(1e-4, 2e-4), (2e-4, 4e-4)] {
            let found = asked(&sphere, "form.radius", &condition, 1, Some(ends), 1).unwrap();
            assert_eq!(found.values(), [Some(2e-4)], "{ends:?}");
        }
        let rough = scene("pressure-sensitive", 2048);
        let stair = alone(&rough, 5, Move::ToForce(1e-5), Quantity::PullOffForce);
        let ask = |range| {
            asked(
                &rough,
                "preload",
                &format!("F_a = {stair:e} N"),
                1,
                range,
                1,
            )
            .unwrap()
        };
        let preload = ask(None).values()[0].unwrap();
        let force = |preload| alone(&rough, 5, Move::ToForce(preload), Quantity::PullOffForce);
        assert!(
            preload < 1e-5
                && force(preload) == stair
                && force(preload * (1.0 - 4.0 * WITHIN)) < stair
        );
        // The answer depends on the searched range. In a range below the step of F_a, there is no
        // answer. In a range from the step on, or above it, the answer is the smallest searched
        // preload, because F_a reaches the target there.
        assert_eq!(ask(Some((0.0, 0.9 * preload))).values(), [None]);
        assert_eq!(ask(Some((preload, 1e-5))).values(), [Some(preload)]);
        let above = ask(Some((1e-3, 2e-3)));
        assert_eq!(
            (above.values(), above.answers[0].crossings.len()),
            (vec![Some(1e-3)], 0)
        );
        // A range with equal ends is refused.
        let one = asked(&rough, "preload", "F_a = 1 uN", 1, Some((1e-5, 1e-5)), 1).unwrap_err();
        assert!(
            one.contains("allowed: two finite numbers, the first below the second"),
            "{one}"
        );
    }

    #[test]
    fn zero_and_negative_targets_are_found() {
        let sphere = scene("jkr-sphere", 1 << 10);
        let bare = sphere.with(|scene| scene.adhesion = None).unwrap();
        for condition in ["F_a = 0 N", "F_a/F_n = 0", "dissipated energy = 0 J"] {
            let free = asked(&bare, "preload", condition, 1, None, 1).unwrap();
            assert_eq!(free.values(), [Some(0.0)], "{condition}");
            let adhesive = asked(&sphere, "preload", condition, 1, None, 1).unwrap();
            assert_eq!(adhesive.answers[0].crossings, [0.0; 0], "{condition}");
        }
        // The indentation at pull-off of a sphere falls as the work of adhesion rises.
        let found = asked(
            &sphere,
            "adhesion.work",
            "pull_off_indentation = -200 nm",
            1,
            None,
            1,
        )
        .unwrap();
        let work = found.values()[0].unwrap();
        let with_work = sphere
            .with(|scene| scene.adhesion = Some(Adhesion::by_work(work)))
            .unwrap();
        let at = alone(
            &with_work,
            0,
            Move::ToForce(1e-4),
            Quantity::PullOffIndentation,
        );
        assert!((at / -200e-9 - 1.0).abs() < 1e-6, "{at}");
        // The indentation at pull-off of a sphere does not depend on the preload.
        let never = asked(
            &sphere,
            "preload",
            "pull_off_indentation = -200 nm",
            1,
            None,
            1,
        )
        .unwrap();
        assert_eq!(
            (never.values(), never.answers[0].may_miss),
            (vec![None], false)
        );
    }

    /// Only lengths with a whole number of waves are answers, because any other wavelength would be
    /// rounded to one of these lengths.
    #[test]
    fn wavelengths_and_lengths_are_found_in_whole_waves() {
        let document = open("pressure-sensitive").unwrap();
        let waves = [
            ("roughness.modes", "None"),
            ("roughness.wavelengths", "(2.5e-5, 1e-6)"),
        ];
        let waves = waves.map(|(path, value)| (path.to_owned(), value.to_owned()));
        let rough = document
            .set_all(&waves)
            .unwrap()
            .set("numerics.points", "1024")
            .unwrap();
        for (path, count) in [
            (
                "roughness.wavelengths.0",
                (|number: f64| 1e-4 / number) as fn(f64) -> f64,
            ),
            ("roughness.wavelengths.1", |number| 1e-4 / number),
            ("length", |number| number / 2.5e-5),
        ] {
            let value = |number: f64| {
                let set = rough.set(path, &format!("{number:?}")).unwrap();
                alone(set.scene(), 5, Move::ToForce(2e-5), Quantity::PullOffForce)
            };
            let scene = rough
                .scene()
                .with(|scene| scene.loading = vec![Move::ToForce(2e-5), Move::ToSeparation]);
            let target = 0.9
                * alone(
                    rough.scene(),
                    5,
                    Move::ToForce(2e-5),
                    Quantity::PullOffForce,
                );
            let found = asked(
                &scene.unwrap(),
                path,
                &format!("F_a = {target:e} N"),
                1,
                None,
                1,
            )
            .unwrap();
            assert!(found.question.is_of_whole_waves());
            assert!(!found.answers[0].crossings.is_empty(), "{path}");
            for &crossing in &found.answers[0].crossings {
                let waves = count(crossing).round();
                assert!(
                    (count(crossing) / waves - 1.0).abs() < 1e-9,
                    "{path}: {crossing}"
                );
                let per_wave = if path == "length" {
                    crossing / waves
                } else {
                    crossing * waves
                };
                let of_waves = |waves: f64| {
                    if path == "length" {
                        per_wave * waves
                    } else {
                        per_wave / waves
                    }
                };
                let is_below = |waves: f64| waves >= 1.0 && value(of_waves(waves)) < target;
                assert!(value(crossing) >= target, "{path}: {crossing}");
                assert!(
                    is_below(waves - 1.0) || is_below(waves + 1.0),
                    "{path}: {crossing}"
                );
            }
        }
        let none = asked(
            rough.scene(),
            "roughness.wavelengths.0",
            "F_a = 1 uN",
            1,
            Some((6e-5, 9e-5)),
            1,
        );
        assert!(
            none.unwrap_err()
                .contains("a number for which whole waves fit on the length")
        );
    }
}
