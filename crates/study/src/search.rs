//! The search for the answer to a question on one random profile: at which numbers a quantity
//! crosses a target.

use super::axis::Axis;
use super::bracket::{Passage, passage};
use super::cells::Streak;
use super::coordinates::Coordinates;
use super::plan::Plan;
use super::quantity::Quantity;
use super::question::{Answer, Course, Question, at_touch};
use super::recorder::{Recorded, with_recorder};
use super::scan::{Scan, Tried, side};
use super::stairs::{Stair, ratio_crossings, step_crossings};
use asperity_scene::{RunError, Simulation};
use std::cmp::Ordering;

/// Relative difference up to which a value counts as equal to the target. Energies are constant
/// between two steps of the pull-off force, but have rounding errors.
const ROUNDING: f64 = 1e-12;

impl Question {
    /// Answers the question on one profile. The second value of the result is the reason why the
    /// scene could not be computed with a tried number, if there was such a number.
    ///
    /// # Errors
    /// Returns an error if `stop` returned true or if the memory does not suffice.
    pub(super) fn answer(
        &self,
        simulation: &mut Simulation,
        line: u64,
        stop: &dyn Fn() -> bool,
    ) -> Result<(Answer, Option<String>), RunError> {
        let search = Search {
            question: self,
            simulation,
            line,
            stop,
            known: Vec::new(),
            refused: None,
        };
        search.answer()
    }
}

/// Largest relative distance of two neighbouring numbers between which a quantity steps. It is
/// larger than the error of a crossing.
const NEIGHBOURS: f64 = 1e-8;

/// Smallest change of a quantity that counts as a step, as a share of the target.
const LEAST_STEP: f64 = 1e-2;

/// State of the search on one random profile.
struct Search<'s> {
    question: &'s Question,
    simulation: &'s mut Simulation,
    line: u64,
    stop: &'s dyn Fn() -> bool,
    /// Numbers at which the quantity has been computed, in the order of the computation.
    known: Vec<Tried>,
    /// First reason why the scene could not be computed with a tried number.
    refused: Option<String>,
}

impl Search<'_> {
    /// Searches the crossings by the method that suits the course of the quantity, and adds the
    /// range of the computed values to the answer.
    fn answer(mut self) -> Result<(Answer, Option<String>), RunError> {
        let question = self.question;
        let mut answer = Answer {
            seed: question
                .plan
                .scene
                .seed()
                .map(|_| question.plan.seed_of(self.line)),
            ..Answer::default()
        };
        // A range without an allowed number was refused before the search, so there are always
        // coordinates.
        if let Some(coordinates) = question.coordinates() {
            match question.course() {
                Course::OneWay => self.search_one_way(&coordinates, &mut answer)?,
                Course::Ratio => self.search_ratio(&mut answer)?,
                Course::Steps => self.search_steps(&coordinates, &mut answer)?,
                Course::Unknown => self.scan(&coordinates, &mut answer)?,
            }
        }
        self.known
            .sort_by(|first, second| first.number.total_cmp(&second.number));
        let with_value: Vec<&Tried> = self
            .known
            .iter()
            .filter(|tried| !tried.value.is_nan())
            .collect();
        let is_reached =
            |tried: Option<&&Tried>| tried.is_some_and(|tried| tried.value >= question.target);
        answer.reached = [
            is_reached(with_value.first()),
            is_reached(with_value.last()),
        ];
        let least = with_value.iter().map(|tried| tried.value).reduce(f64::min);
        let most = with_value.iter().map(|tried| tried.value).reduce(f64::max);
        answer.reachable = least.zip(most);
        let first = with_value.first().map(|tried| tried.number);
        let last = with_value.last().map(|tried| tried.number);
        answer.computed = first.zip(last);
        answer.tried = self.known.len() as u64;
        answer.crossings.dedup();
        answer.step = answer
            .crossings
            .first()
            .and_then(|first| self.step_at(*first));
        Ok((answer, self.refused))
    }

    /// Returns the values of the quantity just below a crossing and at it, if the quantity steps
    /// over the target there. The computed numbers are in ascending order.
    fn step_at(&self, crossing: f64) -> Option<[f64; 2]> {
        let place = self.known.partition_point(|tried| tried.number < crossing);
        let below = self.known.get(place.checked_sub(1)?)?;
        let above = self.known.get(place)?;
        let is_close = above.number - below.number <= NEIGHBOURS * crossing.abs();
        let target = self.question.target;
        let least = LEAST_STEP * target.abs();
        let is_step =
            (above.value - target).abs() > least && (above.value - below.value).abs() > least;
        (is_close && is_step).then_some([below.value, above.value])
    }

    /// Searches a quantity that is monotonic in the number. If the ends of the range are on
    /// different sides of the target, there is one crossing between them.
    fn search_one_way(
        &mut self,
        coordinates: &Coordinates,
        answer: &mut Answer,
    ) -> Result<(), RunError> {
        let (numbers, _) = coordinates.spread(1, 1);
        let records = self.compute(&numbers)?;
        answer.is_proven = true;
        let has_touch = at_touch(&self.question.axis, self.question.quantity).is_some();
        let force_at_touch = records.first().and_then(|values| values.get(1));
        answer.at_touch =
            has_touch && force_at_touch.is_some_and(|force| *force >= self.question.target);
        let tried: Vec<Tried> = self.known.clone();
        let values: Vec<f64> = tried.iter().map(|tried| tried.value).collect();
        if values.iter().any(|value| value.is_nan()) && !values.iter().all(|value| value.is_nan()) {
            // The quantity has no value in a part of the range. A scan finds this part.
            return self.scan(coordinates, answer);
        }
        self.add_crossings(coordinates, &tried, answer)
    }

    /// Searches the ratio F_a/F_n. Between two steps of F_a, where F_a is constant, the crossing is
    /// known in closed form.
    fn search_ratio(&mut self, answer: &mut Answer) -> Result<(), RunError> {
        let (from, to) = self.question.searched;
        let target = self.question.target;
        answer.is_proven = true;
        if to <= 0.0 || target <= 0.0 {
            // The ratio exists only for preloads above 0 N. It is zero only where F_a is zero,
            // which is the case below the first step of F_a.
            let stairs = self.climb(&[from.max(0.0), to])?;
            let is_zero = stairs
                .first()
                .is_some_and(|stair| stair.pull_off_force <= 0.0);
            answer
                .crossings
                .extend((to > 0.0 && is_zero).then_some(from.max(0.0)));
            return Ok(());
        }
        let found = ratio_crossings([from.max(0.0), to], target, &mut |numbers| {
            self.climb(numbers)
        })?;
        answer.may_miss = found.may_miss;
        answer.crossings = found.numbers;
        Ok(())
    }

    /// Searches a quantity that is constant between two steps of F_a.
    fn search_steps(
        &mut self,
        coordinates: &Coordinates,
        answer: &mut Answer,
    ) -> Result<(), RunError> {
        let target = self.question.target;
        let (pairs, may_miss) =
            step_crossings(coordinates, target, &mut |numbers| self.climb(numbers))?;
        answer.is_proven = !may_miss;
        answer.may_miss = may_miss;
        let first = self.known.first().filter(|first| first.value == target);
        answer.crossings.extend(first.map(|first| first.number));
        for pair in pairs {
            self.add_crossings(coordinates, &pair, answer)?;
        }
        Ok(())
    }

    /// Searches a quantity that may rise and fall by computing it at many numbers of the range (a
    /// scan).
    fn scan(&mut self, coordinates: &Coordinates, answer: &mut Answer) -> Result<(), RunError> {
        let target = self.question.target;
        let scan = Scan::of(*coordinates, target, &mut |numbers| {
            Ok(self
                .compute(numbers)?
                .iter()
                .map(|values| values[0])
                .collect())
        })?;
        answer.is_proven = scan.is_complete();
        // The number of patches and the indentation at pull-off may jump between any two numbers.
        // Different whole numbers of waves give different profiles, so other quantities jump too.
        let jumps = coordinates.is_discrete()
            || matches!(
                self.question.quantity,
                Quantity::Patches | Quantity::PullOffIndentation
            );
        answer.may_miss = scan.may_miss() || (jumps && !scan.is_complete());
        // The quantity may be equal to the target at the first number.
        let first = scan.tried.first().filter(|first| first.value == target);
        answer.crossings.extend(first.map(|first| first.number));
        self.add_crossings(coordinates, &scan.tried, answer)
    }

    /// Adds the crossings: the numbers at which the quantity crosses the target, or at which it
    /// becomes equal to the target and stays equal. If the quantity has no value at one of two
    /// neighbouring numbers and does not equal the target at the other, no crossing is added
    /// between them.
    fn add_crossings(
        &mut self,
        coordinates: &Coordinates,
        tried: &[Tried],
        answer: &mut Answer,
    ) -> Result<(), RunError> {
        let target = self.question.target;
        for pair in tried.windows(2) {
            let sides = [side(pair[0], target), side(pair[1], target)];
            let is_passed = match sides {
                [Some(Ordering::Less), Some(other)] => other != Ordering::Less,
                [Some(Ordering::Greater), Some(other)] => other != Ordering::Greater,
                [None, Some(Ordering::Equal)] => true,
                _ => false,
            };
            if is_passed {
                let number = self.crossing(coordinates, pair[0], pair[1])?;
                answer.crossings.push(number);
            }
        }
        Ok(())
    }

    /// Returns the number between `from` and `to` at which the quantity crosses the target, or at
    /// which it becomes equal to the target and stays equal.
    fn crossing(
        &mut self,
        coordinates: &Coordinates,
        from: Tried,
        to: Tried,
    ) -> Result<f64, RunError> {
        let target = self.question.target;
        let mut from = from;
        let mut end = to;
        let mut falls_onto = side(from, target) != Some(Ordering::Less) && end.value == target;
        loop {
            let way = Passage { target, falls_onto };
            let number = passage(coordinates, way, [from, end], &mut |number| {
                self.value(number)
            })?;
            if from.value < target || number == from.number {
                return Ok(number);
            }
            let reached = Tried {
                number,
                value: self.value(number)?,
            };
            match side(reached, target) {
                // The quantity equals the target at this number, and is perhaps constant from a
                // smaller number on. The search goes on below this number.
                Some(Ordering::Equal) if !falls_onto => (end, falls_onto) = (reached, true),
                // The quantity falls below the target before it equals the target, so it crosses
                // the target.
                Some(Ordering::Less) if from.value.is_nan() => {
                    (from, falls_onto) = (reached, false)
                }
                Some(Ordering::Less) if falls_onto => (end, falls_onto) = (reached, false),
                _ => return Ok(number),
            }
        }
    }

    /// Computes the quantity at one number; NaN if the quantity has no value at this number.
    fn value(&mut self, number: f64) -> Result<f64, RunError> {
        Ok(self.compute(&[number])?[0][0])
    }

    /// Computes the pull-off force and the quantity at several preloads. The pull-off force is 0 if
    /// the force of the unloading is never negative.
    fn climb(&mut self, preloads: &[f64]) -> Result<Vec<Stair>, RunError> {
        let records = self.compute(preloads)?;
        let mut stairs = Vec::with_capacity(preloads.len());
        for (&preload, values) in preloads.iter().zip(&records) {
            let force = values.last().copied().unwrap_or_default();
            stairs.push(Stair {
                preload,
                pull_off_force: force.max(0.0),
                value: values[0],
            });
        }
        Ok(stairs)
    }

    /// Returns the recorded quantities at each of the numbers; NaN for a quantity without a value.
    fn compute(&mut self, numbers: &[f64]) -> Result<Vec<Vec<f64>>, RunError> {
        let question = self.question;
        let axis = Axis {
            values: numbers.to_vec(),
            ..question.axis.clone()
        };
        let plan = Plan {
            axes: vec![axis],
            ..question.plan.clone()
        };
        // All preloads are computed with a single loading. Other numbers are computed one after
        // another.
        let step = if question.is_of_preload() {
            plan.cells()
        } else {
            1
        };
        let line = self.line;
        let mut records: Vec<Recorded> = Vec::with_capacity(numbers.len());
        with_recorder(&plan, self.simulation, self.stop, |recorder| {
            for first in (0..plan.cells()).step_by(step as usize) {
                records.extend(recorder.record_each(&Streak {
                    cells: first..first + step,
                    line,
                })?);
            }
            Ok(())
        })?;
        let mut all = Vec::with_capacity(numbers.len());
        for (&number, record) in numbers.iter().zip(records) {
            let values = record.unwrap_or_else(|why| {
                self.refused.get_or_insert(why);
                vec![f64::NAN; plan.record.len()]
            });
            let mut values = values;
            if (values[0] - question.target).abs() <= ROUNDING * question.target.abs() {
                values[0] = question.target;
            }
            self.known.push(Tried {
                number,
                value: values[0],
            });
            all.push(values);
        }
        Ok(all)
    }
}
