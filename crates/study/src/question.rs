//! The question at which value of a number of a scene, or at which preload, a quantity reaches a target, and its answer on one
//! profile.

use super::axis::{Axis, Spacing, Target};
use super::cells::Streak;
use super::error::StudyError;
use super::plan::{PRELOAD, Plan};
use super::quantity::Quantity;
use super::recorder::{Recorded, with_recorder};
use asperity_contact::Move;
use asperity_data::{AxisScale, format_quantity, parse_quantity};
use asperity_scene::{CheckedScene, RunError, Scene, Simulation, Solver};
use std::mem::replace;

/// Relative distance between the ends of the interval with the sought value at which the search for this value ends.
pub const WITHIN: f64 = 1e-9;
/// Ratio of the ends of the searched range to the number of the scene.
const FACTOR: f64 = 100.0;
/// Ratio of the largest searched preload to the preload of full contact, for a loading without a force.
const DEEPER: f64 = 10.0;
/// Number of intervals into which the searched range is divided for a quantity that may rise and fall.
const INTERVALS: usize = 32;
/// Ratio of the smallest computed preload above 0 N to the largest one.
const LEAST_PRELOAD: f64 = 1e-4;
/// Largest width of an allowed range that is searched as a whole, and share of the range that is left out at its ends.
const NARROW: f64 = 2.0;
const MARGIN: f64 = 0.01;
/// Path of the work of adhesion.
const WORK: &str = "adhesion.work";

/// Question: at which value of one number of a scene does a quantity reach a target? It is asked for each of several random
/// profiles.
#[derive(Clone, Debug, PartialEq)]
pub struct Question {
    /// Number of the scene, or preload in N, whose value is sought. It is given as an axis without values.
    pub axis: Axis,
    /// Quantity that must reach [`Question::target`].
    pub quantity: Quantity,
    /// Target value of [`Question::quantity`] in the SI unit of the quantity.
    pub target: f64,
    /// Smallest and largest value of the number that are tried, in SI units. If the number is not above zero in the scene,
    /// [`Question::new`] sets both to NaN, and the caller must set the range before the question is answered.
    pub searched: (f64, f64),
    /// Scale of the searched number.
    scale: AxisScale,
    /// Scene with the sought number, on its profiles.
    pub(super) plan: Plan,
}

/// Answer to a [`Question`] on one random profile.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Answer {
    /// Seed of the profile; `None` if the profile of the scene is fixed.
    pub seed: Option<u64>,
    /// Ascending values of the number at which the quantity crosses the target. Each has a relative error of at most 1e-9, or
    /// is at most 1 from the crossing if the number is whole. The quantity is at least the target at each listed value.
    pub crossings: Vec<f64>,
    /// True if the quantity is at least the target: first for the smallest, then for the largest searched number.
    pub reached: [bool; 2],
    /// True if F_a(d=0) reaches the target already, so that no preload is needed. False if no preload is sought or if the
    /// quantity is not an adhesion force after the preload.
    pub at_touch: bool,
    /// Smallest and largest value of the quantity at several numbers spread over the searched range; `None` if it has no value
    /// at any of these numbers.
    pub reachable: Option<(f64, f64)>,
}

impl Question {
    /// Reads a condition such as `F_a/F_a,max = 80 %` or `dissipated energy = 2 pJ`. The left side is the symbol or the name of
    /// a [`Quantity`]. The right side is a value with a unit, and the unit may have a prefix.
    ///
    /// # Errors
    /// Returns an error if the text has another form, or if the quantity cannot have this value.
    ///
    /// ```
    /// use asperity_study::Quantity;
    /// use asperity_study::Question;
    ///
    /// assert_eq!(Question::parse_condition("F_a/F_a,max = 80 %").ok(), Some((Quantity::AdhesionShare, 0.8)));
    /// assert!(Question::parse_condition("F_a/F_a,max = 120 %").unwrap_err().to_string().contains("allowed: from 0 to 1"));
    /// ```
    pub fn parse_condition(text: &str) -> Result<(Quantity, f64), StudyError> {
        // The symbol F_a(F=0) has the sign itself.
        let example = "a quantity and its value, such as \"F_a/F_a,max = 80 %\"";
        let refused = |found: String| StudyError::refused(None, found, example);
        let (name, value) = text.rsplit_once('=').ok_or_else(|| refused(format!("{text:?}")))?;
        let quantity = Quantity::named(name).map_err(refused)?;
        if quantity.is_regime() {
            return Err(refused(format!("{} is not a number", quantity.name())));
        }
        let target = parse_quantity(value, quantity.unit())
            .map_err(|error| refused(format!("value of {}: {error}", quantity.symbol_or_name())))?;
        let (least, most) = quantity.bounds();
        if target < least || target > most {
            let [found, least, end] = [target, least, most].map(|one| format_quantity(one, quantity.unit()));
            let allowed =
                if most.is_finite() { format!("from {least} to {end}") } else { format!("at least {least}") };
            let found = format!("{} = {found}", quantity.symbol_or_name());
            return Err(StudyError::refused(None, found, allowed));
        }
        Ok((quantity, target))
    }

    /// Makes a question: at which value of the number at `path` does a quantity have a given value? It is asked for `profiles`
    /// random profiles of a checked scene. `path` may be `preload`. Numbers from a hundredth to a hundred times the value in
    /// the scene are searched. For a number with a narrow allowed range, such as the Hurst exponent, nearly this whole range is
    /// searched. Preloads are searched from 0 N to a hundred times the largest force to which the scene is loaded.
    ///
    /// # Errors
    /// Returns an error if the scene lacks the number, or if several profiles are requested and the profile of the scene is
    /// fixed. It is also an error to ask for a preload if the solver of the scene is not [`Solver::Exact`].
    pub fn new(
        scene: &CheckedScene,
        path: &str,
        (quantity, target): (Quantity, f64),
        profiles: u64,
        simulation: &mut Simulation,
    ) -> Result<Question, StudyError> {
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
            let axis = Axis::new(path, Spacing::List, Vec::new(), scene)?;
            let (_, _, governing) = simulation.make_line(scene).map_err(failed)?;
            let by_parameter = base.adhesion.filter(|one| path == WORK && one.parameter().is_some());
            if let Some((adhesion, work)) = by_parameter.zip(governing.work_of_adhesion) {
                // The work of adhesion that follows from κ or e_el/γ becomes a number of the scene.
                base.adhesion = Some(adhesion.with_work(work));
            }
            let present = axis.value_in(&base, Some(&governing));
            let present = present.ok_or_else(|| {
                StudyError::refused(Some(path), "the scene has no such number", "a number that the scene has")
            })?;
            let range = usual_range(&axis, present);
            (axis, range)
        };
        StudyError::check_profiles(scene, profiles)?;
        let record: Vec<Quantity> = std::iter::once(quantity).chain(at_touch(&axis, quantity)).collect();
        let plan = Plan::of_scene(&base, profiles, &record);
        // A number below zero has no range around it.
        let searched = usual.unwrap_or((f64::NAN, f64::NAN));
        Ok(Question { axis, quantity, target, searched, scale, plan })
    }

    /// Returns an error for an empty range.
    pub(super) fn check(&self) -> Result<(), StudyError> {
        let (from, to) = self.searched;
        // Also for an end that is no number.
        if from < to && (to - from).is_finite() {
            return Ok(());
        }
        let [first, last] = [from, to].map(|end| format_quantity(end, self.axis.unit));
        let refused = |found, allowed| Err(StudyError::refused(Some(&self.axis.path), found, allowed));
        if from.is_nan() {
            let found = "there is no usual range around a number that is not above 0".to_owned();
            return refused(found, "a range: --range A..B");
        }
        refused(format!("range {first} to {last}"), "two finite numbers, the first below the second")
    }

    /// Returns the scale on which the range is searched, which is logarithmic only for fractions of numbers above zero.
    fn scale(&self) -> AxisScale {
        if self.searched.0 > 0.0 && !self.axis.is_whole() { self.scale } else { AxisScale::Linear }
    }

    /// Returns the number of random profiles on which the question is answered.
    pub fn profiles(&self) -> u64 {
        self.plan.lines
    }

    /// Returns true if the question asks for a preload.
    pub fn is_of_preload(&self) -> bool {
        self.axis.is_of_preloads()
    }

    /// Returns true if the quantity never falls with the sought number.
    fn only_rises(&self) -> bool {
        at_touch(&self.axis, self.quantity).is_some()
    }

    /// Returns the numbers at which the quantity is computed first.
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

    /// Returns the records of a profile at these numbers, with the reasons of numbers that the scene does not allow.
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

    pub(super) fn answer(
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

    /// Narrows a bracket by the method of Chandrupatla: inverse quadratic interpolation where the quantity is smooth
    /// enough, otherwise bisection. Returns the end at which the quantity is at least the target.
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

/// Returns the same quantity turned at first touch, for an adhesion force over the preload, which never falls.
fn at_touch(axis: &Axis, quantity: Quantity) -> Option<Quantity> {
    match (axis.target, quantity) {
        (Target::Preload { .. }, Quantity::AdhesionForce) => Some(Quantity::FirstTouchAdhesionForce),
        (Target::Preload { .. }, Quantity::AdhesionShare) => Some(Quantity::FirstTouchAdhesionShare),
        _ => None,
    }
}

/// Returns the scale and the range on which a number is searched whose value in the scene is `present`.
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
    /// Returns the number of the profile: the first crossing, or the smallest preload that reaches the target.
    pub(super) fn value(&self, question: &Question) -> Option<f64> {
        let already = question.is_of_preload() && self.reached[0];
        if already { Some(question.searched.0) } else { self.crossings.first().copied() }
    }
}
