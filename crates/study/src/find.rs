//! The inverse question: at which value of a number of a scene, or at which preload, a quantity reaches a target.
//!
//! Each profile is searched for itself. The adhesion force over the preload is a staircase that never falls, so two preloads
//! bracket its only crossing; any other quantity is first scanned over the searched range. A bracket is then narrowed until
//! its ends agree to [`WITHIN`]: at a step, one end lies before the step and one behind.

use super::axis::{Axis, Spacing, Target};
use super::cells::Streak;
use super::error::{FIXED_PROFILE, StudyError};
use super::plan::{PRELOAD, Plan};
use super::profiles::{Stop, on_profiles};
use super::quantity::Quantity;
use super::recorder::{Recorded, with_recorder};
use asperity_contact::Move;
use asperity_data::{AxisScale, between, format_quantity, format_range, parse_quantity};
use asperity_scene::{CheckedScene, RunError, Scene, Simulation, Solver};
use std::mem::replace;

/// Relative distance of the ends of a bracket at which its search ends.
pub const WITHIN: f64 = 1e-9;
/// Ratio of the ends of the searched range to the number of the scene.
const FACTOR: f64 = 100.0;
/// Ratio of the largest searched preload to that of full contact, for a loading without a force.
const DEEPER: f64 = 10.0;
/// Number of intervals into which the searched range is divided for a quantity that may fall as well as rise.
const INTERVALS: usize = 32;
/// Ratio of the smallest scanned preload above 0 N to the largest one.
const LEAST_PRELOAD: f64 = 1e-4;
/// Largest width of an allowed range that is searched as a whole, and share of it that is left out at its ends.
const NARROW: f64 = 2.0;
const MARGIN: f64 = 0.01;
/// Path of the work of adhesion.
const WORK: &str = "adhesion.work";
/// Relative change of a quantity over the whole searched range up to which the number does not act on it: the error by the number
/// of springs changes with the scene.
const STILL: f64 = 1e-3;

/// The question at which value of a number of a scene a quantity has a value.
#[derive(Clone, Debug, PartialEq)]
pub struct Question {
    /// The number that is sought, without values; `preload` is in N.
    pub axis: Axis,
    /// The quantity.
    pub quantity: Quantity,
    /// Wanted value of the quantity, in its SI unit.
    pub target: f64,
    /// Smallest and largest searched number, in SI units; NaN for a number below zero until they are given.
    pub searched: (f64, f64),
    /// Scale of the number.
    scale: AxisScale,
    /// The scene with the sought number, on its profiles.
    plan: Plan,
}

/// Answer of one profile.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Answer {
    /// Seed of the profile; `None` for a fixed profile.
    pub seed: Option<u64>,
    /// All numbers at which the quantity crosses the target, ascending; of both ends of a crossing the one at which the
    /// quantity is at least the target.
    pub crossings: Vec<f64>,
    /// True where the quantity is at least the target: at the smallest and at the largest searched number.
    pub reached: [bool; 2],
    /// True if the adhesion force after a turn at first touch, without any preload, is at least the target.
    pub at_touch: bool,
    /// Smallest and largest value of the quantity that the search met; `None` if it met none.
    pub reachable: Option<(f64, f64)>,
}

/// Answers of all profiles.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// The question.
    pub question: Question,
    /// Answers of the profiles, in the order of their seeds.
    pub answers: Vec<Answer>,
    /// Reason why the scene does not allow some number of the range; `None` if all searched numbers are allowed.
    pub refused: Option<String>,
}

/// Reads a condition such as `F_a/F_a,max = 80 %` or `dissipated energy = 2 pJ`: a quantity by its symbol or by its name in
/// tables of studies, and a value with prefix and unit.
///
/// # Errors
/// What is wrong with the condition, and what is allowed.
pub fn parse_condition(text: &str) -> Result<(Quantity, f64), String> {
    // The symbol F_a(F=0) has the sign itself.
    let example = "a quantity and its value, such as \"F_a/F_a,max = 80 %\"";
    let (name, value) = text.rsplit_once('=').ok_or_else(|| format!("{text:?}: allowed: {example}"))?;
    let quantity = Quantity::named(name)?;
    if quantity.is_regime() {
        return Err(format!("{} is not a number; allowed: {example}", quantity.name()));
    }
    let target = parse_quantity(value, quantity.unit())
        .map_err(|error| format!("value of {}: {error}", quantity.symbol_or_name()))?;
    let (least, most) = quantity.bounds();
    if target < least || target > most {
        let [found, least, end] = [target, least, most].map(|one| format_quantity(one, quantity.unit()));
        let allowed =
            if most.is_finite() { format!("from {least} to {end}") } else { format!("at least {least}") };
        return Err(format!("{} = {found}; allowed: {allowed}", quantity.symbol_or_name()));
    }
    Ok((quantity, target))
}

impl Question {
    /// Asks for the number at a path of a checked scene, or for the `preload`, on this number of profiles. The searched range
    /// is from a hundredth to a hundred times the present number, or the whole of a narrow allowed range; preloads are
    /// searched from 0 N up to a hundred times the largest force of the loading.
    ///
    /// # Errors
    /// The scene has no such number, or several profiles are asked of a scene that has one.
    pub fn new(
        scene: &CheckedScene,
        path: &str,
        (quantity, target): (Quantity, f64),
        profiles: u64,
        simulation: &mut Simulation,
    ) -> Result<Question, StudyError> {
        let refused = |why: String| StudyError::Question { place: path.to_owned(), why };
        let failed = |error| StudyError::Run { place: String::new(), error };
        let mut base = Scene::clone(scene);
        let (axis, (scale, usual)) = if path == PRELOAD {
            if scene.numerics.solver != Solver::Exact {
                return Err(failed(RunError::NeedsExactSolver));
            }
            let reach = simulation.reach(scene).map_err(failed)?;
            let force = |stage: &Move| if let Move::ToForce(force) = stage { Some(*force) } else { None };
            let own = scene.loading.iter().filter_map(force).fold(0.0, f64::max);
            let usual = if own > 0.0 { FACTOR * own } else { DEEPER * reach.full_contact.0 };
            // Within reach of every profile, wherever its full contact is.
            let most = usual.min(reach.force - reach.full_contact.0);
            (Axis::of_preload(), (AxisScale::Linear, Some((0.0, most))))
        } else {
            let axis = Axis::new(path, Spacing::List, Vec::new(), scene).map_err(refused)?;
            let (_, _, governing) = simulation.make_line(scene).map_err(failed)?;
            let by_parameter = base.adhesion.filter(|one| path == WORK && one.parameter().is_some());
            if let Some((adhesion, work)) = by_parameter.zip(governing.work_of_adhesion) {
                // The work of adhesion that follows from κ or e_el/γ becomes a number of the scene.
                base.adhesion = Some(adhesion.with_work(work));
            }
            let present = axis.value_in(&base, Some(&governing));
            let present = present.ok_or_else(|| refused("the scene has no such number".into()))?;
            let range = usual_range(&axis, present);
            (axis, range)
        };
        if profiles > 1 && scene.seed().is_none() {
            return Err(FIXED_PROFILE);
        }
        let record: Vec<Quantity> = std::iter::once(quantity).chain(at_touch(&axis, quantity)).collect();
        let plan = Plan::of_scene(&base, profiles, &record);
        // A number below zero has no range around it.
        let searched = usual.unwrap_or((f64::NAN, f64::NAN));
        Ok(Question { axis, quantity, target, searched, scale, plan })
    }

    /// Returns an error for a range without an inside.
    fn check(&self) -> Result<(), StudyError> {
        let (from, to) = self.searched;
        // Also for an end that is no number.
        if from < to && (to - from).is_finite() {
            return Ok(());
        }
        let [first, last] = [from, to].map(|end| format_quantity(end, self.axis.unit));
        let why = if from.is_nan() {
            "there is no usual range around a number that is not above 0; allowed: --range A..B".to_owned()
        } else {
            format!("range {first} to {last}; allowed: two finite numbers, the first below the second")
        };
        Err(StudyError::Question { place: self.axis.path.clone(), why })
    }

    /// Scale on which the range is searched: logarithmic only for fractions of numbers above zero.
    fn scale(&self) -> AxisScale {
        if self.searched.0 > 0.0 && !self.axis.is_whole() { self.scale } else { AxisScale::Linear }
    }

    /// Number of profiles.
    pub fn profiles(&self) -> u64 {
        self.plan.lines
    }

    /// Returns true if a preload is sought.
    pub fn is_of_preload(&self) -> bool {
        self.axis.is_of_preloads()
    }

    /// Returns true if the quantity never falls with the sought number.
    fn only_rises(&self) -> bool {
        at_touch(&self.axis, self.quantity).is_some()
    }

    /// Numbers at which the quantity is computed first.
    fn grid(&self) -> Vec<f64> {
        let (from, to) = self.searched;
        let between = |scale: AxisScale, low: f64| {
            let (first, last) = (scale.coordinate(low), scale.coordinate(to));
            let at = move |index: usize| first + (last - first) * (index as f64 / INTERVALS as f64);
            (0..=INTERVALS).map(move |index| scale.number(at(index)).clamp(low, to)).collect::<Vec<f64>>()
        };
        let mut grid = match self.axis.target {
            _ if self.only_rises() => vec![from, to],
            Target::Preload { .. } if from <= 0.0 => {
                [vec![from], between(AxisScale::Logarithmic, LEAST_PRELOAD * to)].concat()
            }
            Target::Preload { .. } => between(AxisScale::Logarithmic, from),
            _ => between(self.scale(), from),
        };
        if self.axis.is_whole() {
            grid.iter_mut().for_each(|value| *value = value.round());
        }
        grid.dedup();
        grid
    }

    /// Records of a profile at these numbers, with the reasons of numbers that the scene does not allow.
    fn records(
        &self,
        simulation: &mut Simulation,
        line: u64,
        at: &[f64],
        stop: &dyn Fn() -> bool,
    ) -> Result<Vec<Recorded>, RunError> {
        let plan =
            Plan { axes: vec![Axis { values: at.to_vec(), ..self.axis.clone() }], ..self.plan.clone() };
        // One loading serves all preloads.
        let step = if self.is_of_preload() { plan.cells() } else { 1 };
        let starts = (0..plan.cells()).step_by(step as usize);
        let records = with_recorder(&plan, simulation, stop, |recorder| {
            let each = |cell| recorder.record_each(&Streak { cells: cell..cell + step, line });
            starts.map(each).collect::<Result<Vec<_>, _>>()
        });
        Ok(records?.concat())
    }

    fn answer(
        &self,
        simulation: &mut Simulation,
        line: u64,
        stop: &dyn Fn() -> bool,
    ) -> Result<(Answer, Option<String>), RunError> {
        let grid = self.grid();
        let records = self.records(simulation, line, &grid, stop)?;
        let value = |record: &Recorded| record.as_ref().map_or(f64::NAN, |values| values[0]);
        let values: Vec<f64> = records.iter().map(value).collect();
        let mut crossings = Vec::new();
        for (at, ends) in grid.windows(2).zip(values.windows(2)) {
            let is_known = !ends[0].is_nan() && !ends[1].is_nan();
            if is_known && (ends[0] >= self.target) != (ends[1] >= self.target) {
                crossings.push(self.crossing([(at[0], ends[0]), (at[1], ends[1])], &mut |number| {
                    let records = self.records(simulation, line, &[number], stop)?;
                    Ok(records.first().map_or(f64::NAN, value))
                })?);
            }
        }
        let known = || values.iter().copied().filter(|value| !value.is_nan());
        let least = known().reduce(f64::min);
        let touch =
            |record: &Recorded| record.as_ref().is_ok_and(|values| values.get(1) >= Some(&self.target));
        let answer = Answer {
            seed: self.plan.scene.seed().map(|_| self.plan.seed_of(line)),
            crossings,
            reached: [values.first(), values.last()].map(|end| end.is_some_and(|end| *end >= self.target)),
            at_touch: records.first().is_some_and(touch),
            reachable: least.zip(known().reduce(f64::max)),
        };
        Ok((answer, records.into_iter().find_map(Recorded::err)))
    }

    /// Narrows a bracket by the method of Chandrupatla: inverse quadratic interpolation where the quantity is smooth enough
    /// for it, else bisection. Returns the end at which the quantity is at least the target.
    fn crossing(
        &self,
        [(from, at_from), (to, at_to)]: [(f64, f64); 2],
        value: &mut dyn FnMut(f64) -> Result<f64, RunError>,
    ) -> Result<f64, RunError> {
        // A number that the scene does not allow does not reach the target.
        let excess = |value: f64| if value.is_nan() { -1.0 - self.target.abs() } else { value - self.target };
        let (scale, is_whole) = (self.scale(), self.axis.is_whole());
        let [mut last, mut other] =
            [(to, at_to), (from, at_from)].map(|(number, value)| (scale.coordinate(number), excess(value)));
        // A crossing at zero has no digits of its own.
        let floor = f64::EPSILON * (scale.coordinate(self.searched.1) - scale.coordinate(self.searched.0));
        let mut share = 0.5;
        loop {
            let width = (other.0 - last.0).abs();
            let size = if scale == AxisScale::Linear { last.0.abs().max(other.0.abs()) } else { 1.0 };
            let least = if is_whole { 1.0 } else { (WITHIN * size).max(floor) };
            let place = last.0 + share * (other.0 - last.0);
            let place = if is_whole { place.round() } else { place };
            if width <= least || place == last.0 || place == other.0 {
                return Ok(scale.number(if last.1 >= 0.0 { last.0 } else { other.0 }));
            }
            let next = (place, excess(value(scale.number(place))?));
            let before = if (next.1 >= 0.0) == (last.1 >= 0.0) { last } else { replace(&mut other, last) };
            last = next;
            let [x, y] =
                [(last.0 - other.0) / (before.0 - other.0), (last.1 - other.1) / (before.1 - other.1)];
            share = 0.5;
            if !is_whole && y * y < x && (1.0 - y) * (1.0 - y) < 1.0 - x {
                let [far, near] = [before.1 / (other.1 - before.1), other.1 / (before.1 - other.1)];
                let shift = (before.0 - last.0) / (other.0 - last.0);
                share = last.1 / (other.1 - last.1) * far + shift * last.1 / (before.1 - last.1) * near;
                let margin = 0.5 * least / (other.0 - last.0).abs();
                share = share.max(margin).min(1.0 - margin);
            }
        }
    }
}

/// The same quantity after a turn at first touch, for an adhesion force over the preload, which never falls.
fn at_touch(axis: &Axis, quantity: Quantity) -> Option<Quantity> {
    match (axis.target, quantity) {
        (Target::Preload { .. }, Quantity::AdhesionForce) => Some(Quantity::ZeroLoadAdhesionForce),
        (Target::Preload { .. }, Quantity::AdhesionShare) => Some(Quantity::ZeroLoadAdhesionShare),
        _ => None,
    }
}

/// Scale and range on which a number is searched that is `present` in the scene.
fn usual_range(axis: &Axis, present: f64) -> (AxisScale, Option<(f64, f64)>) {
    let ends = if let Target::Number(field) = axis.target { field.range.ends() } else { None };
    let (least, most) = ends.unwrap_or((f64::NEG_INFINITY, f64::INFINITY));
    let inside = MARGIN * (most - least);
    if most - least <= NARROW {
        return (AxisScale::Linear, Some((least + inside, most - inside)));
    }
    let around = ((present / FACTOR).max(least), (present * FACTOR).min(most));
    (AxisScale::Logarithmic, Some(around).filter(|_| present > 0.0))
}

impl Answer {
    /// The number of the profile: the first crossing; for a preload the smallest one that reaches the target.
    fn value(&self, question: &Question) -> Option<f64> {
        let already = question.is_of_preload() && self.reached[0];
        if already { Some(question.searched.0) } else { self.crossings.first().copied() }
    }
}

impl Found {
    /// Finds the numbers on all profiles. `jobs` threads share the profiles, the first with this simulation; no bit depends on
    /// their number. `report` receives the number of profiles done after each.
    ///
    /// # Errors
    /// The scene does not have the quantity, the number does not act on the quantity, a profile fails, or `stop` returned true.
    pub fn of(
        question: Question,
        (simulation, jobs): (Simulation, usize),
        stop: &Stop<'_>,
        report: &mut dyn FnMut(u64),
    ) -> Result<Found, StudyError> {
        question.check()?;
        let plan = &question.plan;
        let lines: Vec<u64> = (0..plan.lines).collect();
        let solve = |simulation: &mut Simulation, line| question.answer(simulation, line, stop);
        let (mut each, mut done) = (vec![(Answer::default(), None); lines.len()], 0);
        on_profiles(plan, &lines, (simulation, jobs), solve, &mut |line, answered| {
            each[line as usize] = answered;
            done += 1;
            report(done);
        })?;
        let (answers, reasons): (Vec<Answer>, Vec<Option<String>>) = each.into_iter().unzip();
        let refused = reasons.into_iter().flatten().next();
        let found = Found { question, answers, refused };
        found.check()?;
        Ok(found)
    }

    /// Returns an error if no profile has the quantity, if a preload is out of reach, or if the number does not change the
    /// quantity.
    fn check(&self) -> Result<(), StudyError> {
        let Question { axis, quantity, searched, .. } = &self.question;
        let name = quantity.symbol_or_name();
        let range = format!("from {}", format_range(*searched, 4, axis.unit));
        let refused = |why| Err(StudyError::Question { place: axis.path.clone(), why });
        if let Some(why) = self.refused.as_ref().filter(|_| self.question.is_of_preload()) {
            return refused(why.clone());
        }
        let Some((least, most)) = self.reachable() else {
            let why = self.refused.as_ref().map_or_else(String::new, |reason| format!(": {reason}"));
            return refused(format!("the scene has no {name}{why}"));
        };
        let is_same = |answer: &Answer| {
            answer.reachable.is_none_or(|(least, most)| most - least <= STILL * most.abs().max(least.abs()))
        };
        if !self.question.is_of_preload() && self.answers.iter().all(is_same) {
            let values = if self.answers.len() > 1 {
                format_range((least, most), 4, quantity.unit())
            } else {
                format_quantity(most, quantity.unit())
            };
            return refused(format!("does not act on {name}, which is {values} {range}"));
        }
        Ok(())
    }

    /// The number of each profile: the first crossing, for a preload the smallest one that reaches the target; `None` for a
    /// profile on which the quantity does not cross the target.
    pub fn values(&self) -> Vec<Option<f64>> {
        self.answers.iter().map(|answer| answer.value(&self.question)).collect()
    }

    /// Smallest and largest value of the quantity that the search met on any profile.
    pub fn reachable(&self) -> Option<(f64, f64)> {
        let all = || self.answers.iter().filter_map(|answer| answer.reachable);
        let least = all().map(|ends| ends.0).reduce(f64::min)?;
        Some((least, all().map(|ends| ends.1).reduce(f64::max)?))
    }

    /// Numbers of the profiles in ascending order. A profile without a crossing is beyond the end of the searched range where
    /// its crossing must lie: where the quantity rises, beyond the largest number if it is below the target.
    fn ascending(&self) -> Vec<f64> {
        let slope = |answer: &Answer| i64::from(answer.reached[1]) - i64::from(answer.reached[0]);
        let rises = self.answers.iter().map(slope).sum::<i64>() >= 0;
        let beyond =
            |answer: &Answer| if answer.reached[1] == rises { f64::NEG_INFINITY } else { f64::INFINITY };
        let place = |answer: &Answer| answer.value(&self.question).unwrap_or_else(|| beyond(answer));
        let mut places: Vec<f64> = self.answers.iter().map(place).collect();
        places.sort_by(f64::total_cmp);
        places
    }

    /// Quantile over all profiles: 0.5 is the median. `None` where it lies beyond the searched range.
    pub fn quantile(&self, share: f64) -> Option<f64> {
        let places = self.ascending();
        let place = share * places.len().checked_sub(1)? as f64;
        let [low, high] = [place.floor(), place.ceil()].map(|index| places[index as usize]);
        // No interpolation towards a number beyond the range.
        let value = if low == high { low } else { between(low, high, place.fract()) };
        Some(value).filter(|value| value.is_finite())
    }

    /// Smallest and largest number of the profiles that have one.
    pub fn range(&self) -> Option<(f64, f64)> {
        let values = || self.values().into_iter().flatten();
        values().reduce(f64::min).zip(values().reduce(f64::max))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use asperity_scene::{Adhesion, open};
    use std::f64::consts::PI;

    fn scene(name: &str, points: u64) -> CheckedScene {
        open(name).unwrap().scene().with(|scene| scene.numerics.points = points).unwrap()
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
        let condition = parse_condition(condition)?;
        let question = Question::new(scene, path, condition, profiles, &mut simulation);
        let mut question = question.map_err(|error| error.to_string())?;
        question.searched = range.unwrap_or(question.searched);
        let found = Found::of(question, (simulation, jobs), &|| false, &mut |_| ());
        found.map_err(|error| error.to_string())
    }

    /// Value of a quantity of a scene with one number set, by a run of its own.
    fn alone(scene: &CheckedScene, seed: u64, loading: Move, quantity: Quantity) -> f64 {
        let loading = vec![loading, Move::ToSeparation];
        let scene = scene.with_seed(seed).with(|scene| scene.loading = loading).unwrap();
        let results = super::super::results::Results::of_scene(
            &scene,
            std::path::Path::new(""),
            &[quantity],
            1,
            None,
            1,
        );
        results.unwrap().value(0, 0, quantity).unwrap()
    }

    #[test]
    fn conditions_name_a_quantity_and_its_value() {
        for (text, quantity, target) in [
            ("F_a/F_a,max = 80 %", Quantity::AdhesionShare, 0.8),
            ("adhesion_share=0.8", Quantity::AdhesionShare, 0.8),
            ("F_a(F=0) = 2 uN", Quantity::ZeroForceAdhesionForce, 2e-6),
            ("dissipated energy = 2.5 pJ", Quantity::DissipatedEnergy, 2.5e-12),
            ("F_a/F_n=1e-2", Quantity::AdhesionCoefficient, 0.01),
        ] {
            assert_eq!(parse_condition(text), Ok((quantity, target)), "{text}");
        }
        for (text, said) in [
            ("F_a", "such as \"F_a/F_a,max = 80 %\""),
            ("F_b = 1 uN", "no quantity"),
            ("adhesion_shar = 1", "did you mean adhesion_share?"),
            ("d = 1 nm", "preload_indentation, pull_off_indentation"),
            ("regime = 1", "regime is not a number"),
            ("F_a/F_a,max = 120 %", "F_a/F_a,max = 1.2; allowed: from 0 to 1"),
            ("F_a = -1 uN", "allowed: at least 0 N"),
            ("F_a = 1 s", "s is not a unit of force"),
        ] {
            let error = parse_condition(text).unwrap_err();
            assert!(error.contains(said), "{text}: {error}");
        }
    }

    /// The pull-off force of a sphere is (3/2)πγR for any preload.
    #[test]
    fn a_sphere_has_the_numbers_of_its_closed_form() {
        let sphere = scene("jkr-sphere", 1 << 12);
        let own = Simulation::default().run(&sphere, &|| false, &mut |_, _, _| Ok(())).unwrap();
        let exact = 1.5 * PI * 0.05 * 1e-4;
        // The error of the discrete sphere.
        let error = own.figures.adhesion_force.unwrap() / exact - 1.0;
        assert!(error.abs() < 1e-4, "{error}");
        for (path, slope) in [("adhesion.work", 1.5 * PI * 1e-4), ("form.radius", 1.5 * PI * 0.05)] {
            let found = asked(&sphere, path, "F_a = 30 uN", 1, None, 1).unwrap();
            let number = found.quantile(0.5).unwrap();
            assert!((number * slope / 30e-6 - 1.0).abs() < 2e-4, "{path}: {number}");
            assert_eq!(found.answers[0].crossings.len(), 1);
        }
        let any = asked(&sphere, "preload", "F_a = 20 uN", 1, None, 1).unwrap();
        assert_eq!((any.answers[0].reached, any.answers[0].at_touch), ([true; 2], true));
        assert_eq!((any.quantile(0.5), any.answers[0].crossings.len()), (Some(0.0), 0));
        let never = asked(&sphere, "preload", "F_a = 30 uN", 1, None, 1).unwrap();
        assert_eq!((never.quantile(0.5), never.answers[0].reached), (None, [false; 2]));
        let (least, most) = never.reachable().unwrap();
        assert!((least / exact - 1.0).abs() < 1e-4 && (most / exact - 1.0).abs() < 1e-4);
        for (path, condition, said) in [
            ("material.youngs_modulus", "F_a = 30 uN", "material.youngs_modulus: does not act on F_a"),
            ("roughness.hurst", "F_a = 30 uN", "the scene has no such number"),
            ("form.radios", "F_a = 30 uN", "did you mean form.radius?"),
            ("form.radius", "κ = 2", "the scene has no κ"),
            ("loading.1.0", "F_a = 30 uN", "the scene has no such number"),
        ] {
            let error = asked(&sphere, path, condition, 1, None, 1).unwrap_err();
            assert!(error.contains(said), "{path}: {error}");
        }
        assert!(asked(&sphere, "form.radius", "F_a = 30 uN", 2, None, 1).is_err());
        let empty = asked(&sphere, "form.radius", "F_a = 30 uN", 1, Some((2e-4, 1e-4)), 1).unwrap_err();
        let far = asked(&sphere, "preload", "F_a = 30 uN", 1, Some((0.0, 1.0)), 1).unwrap_err();
        assert!(far.contains("preload: 1 N is far beyond full contact"), "{far}");
        assert!(empty.contains("range 200 µm to 100 µm; allowed: two finite numbers"), "{empty}");
    }

    /// Each preload is where a run of its own shows the step, to the stated precision; no dense grid shows a smaller one.
    #[test]
    fn preloads_are_at_the_steps_that_runs_show() {
        let rough = scene("pressure-sensitive", 2048);
        let (condition, target) = ("F_a = 10 uN", 10e-6);
        let found = asked(&rough, "preload", condition, 6, None, 2).unwrap();
        assert_eq!(asked(&rough, "preload", condition, 6, None, 1), Ok(found.clone()));
        let mut inside = 0;
        for (answer, value) in found.answers.iter().zip(found.values()) {
            let (seed, value) = (answer.seed.unwrap(), value.unwrap());
            let force = |preload| alone(&rough, seed, Move::ToForce(preload), Quantity::AdhesionForce);
            assert!(force(value) >= target, "{seed}");
            if answer.crossings.is_empty() {
                continue;
            }
            inside += 1;
            assert!(force(value * (1.0 - 4.0 * WITHIN)) < target, "{seed}");
            assert!((1..40).all(|part| force(value * f64::from(part) / 40.0) < target), "{seed}");
        }
        assert!(inside > 3, "{inside}");
        let mut values: Vec<f64> = found.values().into_iter().flatten().collect();
        values.sort_by(f64::total_cmp);
        assert_eq!(found.quantile(0.5), Some(f64::midpoint(values[2], values[3])));
    }

    /// The number of patches rises with the preload, and falls as they grow together: two crossings at least.
    #[test]
    fn a_quantity_that_rises_and_falls_has_all_its_crossings() {
        let rough = scene("pressure-sensitive", 2048).with(|scene| scene.adhesion = None).unwrap();
        let (patches, target) = (Quantity::Fragments, 12.0);
        let found = asked(&rough, "preload", "fragments = 12", 1, None, 1).unwrap();
        let answer = &found.answers[0];
        let value = |preload| alone(&rough, 5, Move::ToForce(preload), patches);
        assert!(answer.crossings.len() >= 2, "{answer:?}");
        for (number, crossing) in answer.crossings.iter().enumerate() {
            let [before, after] = [1.0 - 1e-6, 1.0 + 1e-6].map(|factor| value(crossing * factor) >= target);
            assert_eq!(
                [before, after],
                if number % 2 == 0 { [false, true] } else { [true, false] },
                "{crossing}"
            );
        }
        assert_eq!(found.quantile(0.5), Some(answer.crossings[0]));
    }

    /// A profile without a crossing lies beyond the searched range, and the median is unknown where half of them do.
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
                let scene = rough.with(|scene| scene.adhesion = Some(Adhesion::by_work(work))).unwrap();
                let force = alone(&scene, answer.seed.unwrap(), Move::ToForce(1e-5), Quantity::AdhesionForce);
                force >= 10e-6
            };
            assert_eq!([1.0 - 1e-7, 1.0].map(reached), [false, true], "{answer:?}");
        }
        // F_a rises with the work of adhesion: two profiles cross within this range, and three above.
        let range = (values[0] / 2.0, f64::midpoint(values[1], values[2]));
        let part = asked(&rough, scale, "F_a = 10 uN", 5, Some(range), 1).unwrap();
        assert_eq!((work(&part).iter().flatten().count(), part.quantile(0.5)), (2, None));
        assert!((part.quantile(0.25).unwrap() / values[1] - 1.0).abs() < 1e-8);
        assert_eq!(part.range().map(|ends| (ends.0 / values[0] - 1.0).abs() < 1e-8), Some(true));
    }
}
