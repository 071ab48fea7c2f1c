//! The stepwise solver: move by a small step, relax to equilibrium, repeat, as the paper does.
//!
//! The step Δd is its accuracy; each step costs a few sweeps over the whole line. It shares nothing
//! with the exact solver but the rules and the sums; only whether a leg can end, and within how many steps,
//! is asked of the exact thresholds before the first step.

use super::{
    ContactError, ContactTree, CurvePoint, Direction, Foundation, GapScale, GridEdges, HessRule, LegContact,
    LegRecord, Manual, ManualError, ManualLoading, Solver, Tally, Work, exact, fragments, reserve,
};
use crate::scene::{Edges, Leg};
use std::sync::Arc;

/// Most steps on one leg.
pub const STEP_LIMIT: u64 = 10_000_000;

/// A body moved by small steps and relaxed after each.
pub struct Stepwise<'a> {
    gaps: &'a [f64],
    hess: Option<HessRule>,
    foundation: Foundation,
    step: f64,
    samples: usize,
    stop: &'a dyn Fn() -> bool,
    scale: GapScale,
    contact: Vec<bool>,
    thresholds: Vec<f64>,
    indentation: f64,
    tally: Tally,
    /// Σ of the squared stretches of what left, less that of what joined, on the present leg, m².
    squared_stretch: f64,
    legs: usize,
    work: Work,
}

impl<'a> Stepwise<'a> {
    /// A separated body over springs of these gaps (m, the smallest 0), moved by steps of `step` m;
    /// without a rule of Hess there is no adhesion. `stop` is asked after each step whether to give up.
    ///
    /// # Errors
    /// [`ContactError::OutOfMemory`].
    pub fn new(
        gaps: &'a [f64],
        hess: Option<HessRule>,
        foundation: Foundation,
        step: f64,
        samples: usize,
        stop: &'a dyn Fn() -> bool,
    ) -> Result<Self, ContactError> {
        let mut contact = reserve(gaps.len())?;
        contact.resize(gaps.len(), false);
        let mut thresholds = reserve(gaps.len())?;
        thresholds.resize(gaps.len(), f64::INFINITY);
        Ok(Stepwise {
            gaps,
            hess,
            foundation,
            step,
            samples: samples.max(2),
            stop,
            scale: GapScale::for_gaps_up_to(gaps.iter().copied().fold(0.0, f64::max)),
            contact,
            thresholds,
            indentation: 0.0,
            tally: Tally::default(),
            squared_stretch: 0.0,
            legs: 0,
            work: Work { springs: gaps.len() as u64, ..Work::default() },
        })
    }

    fn largest_stretch(&self, springs: usize) -> f64 {
        // Without the rule nothing is stretched at all.
        self.hess.map_or(0.0, |hess| hess.largest_stretch(springs as u32))
    }

    fn join(&mut self, index: usize) {
        self.contact[index] = true;
        self.thresholds[index] = self.indentation;
        self.tally.springs += 1;
        self.tally.quanta += i128::from(self.scale.quanta(self.gaps[index]));
        let stretch = (self.gaps[index] - self.indentation).max(0.0);
        self.squared_stretch -= stretch * stretch;
    }

    fn leave(&mut self, index: usize, held_until: f64) {
        self.contact[index] = false;
        self.thresholds[index] = held_until;
        self.tally.springs -= 1;
        self.tally.quanta -= i128::from(self.scale.quanta(self.gaps[index]));
        // As far as it was held: how far the step went beyond is no property of the contact.
        let stretch = (self.gaps[index] - held_until).max(0.0);
        self.squared_stretch += stretch * stretch;
    }

    /// Sweeps until no spring touches and no fragment grows.
    fn relax_loading(&mut self) {
        loop {
            let joined = self.tally.springs;
            self.work.relaxation_sweeps += 1;
            self.work.spring_updates += self.gaps.len() as u64;
            for index in 0..self.gaps.len() {
                if !self.contact[index] && self.gaps[index] <= self.indentation {
                    self.join(index);
                }
            }
            if self.hess.is_some() {
                self.grow_fragments();
            }
            if self.tally.springs == joined {
                return;
            }
        }
    }

    /// Lets each fragment take in its neighbours for as long as the rule allows.
    fn grow_fragments(&mut self) {
        let count = self.gaps.len();
        let mut first = 0;
        while first < count {
            if !self.contact[first] {
                first += 1;
                continue;
            }
            let mut start = first;
            let mut end = first + 1;
            loop {
                while end < count && self.contact[end] {
                    end += 1;
                }
                while start > 0 && self.contact[start - 1] {
                    start -= 1;
                }
                let stretch = self.largest_stretch(end - start);
                self.work.spring_updates += 2;
                let takes = |index: usize| self.gaps[index] - stretch <= self.indentation;
                if end < count && takes(end) {
                    self.join(end);
                } else if start > 0 && takes(start - 1) {
                    self.join(start - 1);
                } else {
                    break;
                }
            }
            first = end;
        }
    }

    /// Sweeps until every fragment holds its most stretched spring.
    fn relax_unloading(&mut self, held_until: f64) {
        loop {
            let held = self.tally.springs;
            self.work.relaxation_sweeps += 1;
            let mut first = 0;
            while first < self.gaps.len() {
                let mut end = first;
                while end < self.gaps.len() && self.contact[end] {
                    end += 1;
                }
                self.work.spring_updates += 2 * (end - first) as u64 + 1;
                let stretch = self.largest_stretch(end - first);
                for index in first..end {
                    let gap = self.gaps[index];
                    // Whatever is stretched too far here is so in each part of the fragment as well.
                    if self.indentation <= gap - stretch && self.indentation < gap {
                        self.leave(index, held_until);
                    }
                }
                first = end + 1;
            }
            if self.tally.springs == held {
                return;
            }
        }
    }

    fn count_fragments(&mut self) {
        let starts =
            (0..self.contact.len()).filter(|&i| self.contact[i] && (i == 0 || !self.contact[i - 1])).count();
        self.tally.fragments = starts as i64;
    }

    fn point(&self) -> CurvePoint {
        let compression = self.tally.compression(self.indentation, &self.scale);
        CurvePoint {
            indentation: self.indentation,
            force: self.foundation.spring_stiffness() * compression,
            contact_length: self.foundation.contact_length(self.tally.springs as f64),
            springs: self.tally.springs.unsigned_abs(),
            fragments: self.tally.fragments.unsigned_abs(),
        }
    }

    /// Sets the thresholds to what is known when a leg begins.
    fn begin(&mut self) {
        for (threshold, &contact) in self.thresholds.iter_mut().zip(&self.contact) {
            *threshold = if contact { f64::NEG_INFINITY } else { f64::INFINITY };
        }
        self.squared_stretch = 0.0;
    }

    /// Refuses a leg whose end lies out of reach or beyond the limit of steps, before its first step.
    ///
    /// # Errors
    /// [`ContactError::LetsGoBefore`], [`ContactError::OutOfReach`], [`ContactError::TooManySteps`].
    fn check_reach(&self, leg: Leg, direction: Direction, goal: Goal) -> Result<(), ContactError> {
        let end = match (goal, direction) {
            (Goal::Indentation(end), _) => end,
            (Goal::Force(force), Direction::Loading) => self.least_indentation(force.max(0.0))?,
            (Goal::Force(_) | Goal::Separation, _) => self.pulled(leg, goal)?,
        };
        // From separation the first step is the touch.
        let start = if self.tally.springs == 0 { self.indentation.max(0.0) } else { self.indentation };
        // No end is closer than the exact one, and the last step may be a part of one.
        if (end - start).abs() / self.step > STEP_LIMIT as f64 {
            let index = self.legs;
            return Err(ContactError::TooManySteps { index, step: self.step, limit: STEP_LIMIT });
        }
        Ok(())
    }

    /// Indentation, m, below which no contact carries a force (N, at least zero): adhesion only lessens it.
    fn least_indentation(&self, force: f64) -> Result<f64, ContactError> {
        let mut body = exact::nonadhesive(self.gaps, Edges::Grid, self.foundation, 2);
        let leg = Leg::ToForce(force);
        let reached = body.advance(leg).map_err(|error| match error {
            ContactError::OutOfReach { .. } => ContactError::OutOfReach { index: self.legs, leg },
            other => other,
        })?;
        Ok(reached.end())
    }

    /// Indentation, m, at which the present contact reaches a goal when it is pulled.
    fn pulled(&self, leg: Leg, goal: Goal) -> Result<f64, ContactError> {
        let tree = Arc::new(ContactTree::build(self.gaps, Edges::Grid)?);
        let edges = GridEdges::new(self.hess.unwrap_or(HessRule::NO_ADHESION));
        let contacts = fragments::runs(self.contact.iter().copied());
        let body = Manual::in_contact(self.gaps, tree, edges, self.foundation, self.indentation, &contacts);
        let pulled = body.and_then(|mut body| {
            match goal {
                Goal::Force(force) => body.move_to_force(force)?,
                Goal::Indentation(_) | Goal::Separation => body.separate(),
            };
            Ok(body.point().indentation)
        });
        pulled.map_err(|error| match error {
            ManualError::Contact(error) => error,
            ManualError::DetachesBefore { smallest, .. } => {
                ContactError::LetsGoBefore { index: self.legs, leg, smallest }
            }
            ManualError::NotFinite { .. }
            | ManualError::NothingToPull { .. }
            | ManualError::OutOfReach { .. } => ContactError::OutOfReach { index: self.legs, leg },
        })
    }

    /// Steps on until `goal` says the leg is done.
    fn walk(&mut self, leg: Leg, direction: Direction, goal: Goal) -> Result<LegRecord, ContactError> {
        self.begin();
        let before = self.tally.springs;
        let mut curve = Thinned::new(self.samples);
        let here = self.point();
        curve.push(here);
        let (mut largest, mut smallest) = (here, here);
        let mut origin = self.indentation;
        let mut steps: u64 = 0;
        // From separation the first step is the touch.
        let mut touch = before == 0 && direction == Direction::Loading;
        if touch {
            origin = origin.max(0.0);
        }
        loop {
            if (self.stop)() {
                return Err(ContactError::Interrupted);
            }
            if steps >= STEP_LIMIT {
                let index = self.legs;
                return Err(ContactError::TooManySteps { index, step: self.step, limit: STEP_LIMIT });
            }
            let held_until = self.indentation;
            steps += u64::from(!touch);
            touch = false;
            let moved = steps as f64 * self.step;
            let wanted = match direction {
                Direction::Loading => origin + moved,
                Direction::Unloading => origin - moved,
            };
            self.indentation = goal.clip(wanted, direction);
            self.work.steps += 1;
            match direction {
                Direction::Loading => self.relax_loading(),
                Direction::Unloading => self.relax_unloading(held_until),
            }
            self.count_fragments();
            let point = self.point();
            curve.push(point);
            if point.force > largest.force {
                largest = point;
            }
            if point.force < smallest.force {
                smallest = point;
            }
            if goal.reached(&point, direction) {
                break;
            }
            if point.springs == 0 && direction == Direction::Unloading && matches!(goal, Goal::Force(_)) {
                let index = self.legs;
                return Err(ContactError::LetsGoBefore { index, leg, smallest: smallest.force });
            }
        }
        let (joins, leaves) = match direction {
            Direction::Loading => ((self.tally.springs - before).unsigned_abs(), 0),
            Direction::Unloading => (0, (before - self.tally.springs).unsigned_abs()),
        };
        self.work.joins += joins;
        self.work.leaves += leaves;
        Ok(LegRecord {
            leg,
            direction,
            curve: curve.finish(smallest, direction),
            largest,
            smallest,
            joins,
            leaves,
            dissipated_energy: 0.5 * self.foundation.spring_stiffness() * self.squared_stretch,
        })
    }
}

/// When a leg is done.
#[derive(Clone, Copy, Debug)]
enum Goal {
    Indentation(f64),
    Force(f64),
    Separation,
}

impl Goal {
    fn clip(self, indentation: f64, direction: Direction) -> f64 {
        match (self, direction) {
            (Goal::Indentation(end), Direction::Loading) => indentation.min(end),
            (Goal::Indentation(end), Direction::Unloading) => indentation.max(end),
            _ => indentation,
        }
    }

    fn reached(self, point: &CurvePoint, direction: Direction) -> bool {
        match (self, direction) {
            (Goal::Indentation(end), _) => point.indentation == end,
            (Goal::Force(force), Direction::Loading) => point.force >= force,
            (Goal::Force(force), Direction::Unloading) => point.force <= force && point.springs > 0,
            (Goal::Separation, _) => point.springs == 0,
        }
    }
}

/// A curve that halves its density whenever it has become twice as long as asked for.
struct Thinned {
    wanted: usize,
    stride: u64,
    seen: u64,
    points: Vec<CurvePoint>,
    last: Option<CurvePoint>,
}

impl Thinned {
    fn new(wanted: usize) -> Self {
        Thinned { wanted, stride: 1, seen: 0, points: Vec::new(), last: None }
    }

    fn push(&mut self, point: CurvePoint) {
        if self.seen.is_multiple_of(self.stride) {
            if self.points.len() >= 2 * self.wanted {
                let mut index = 0;
                self.points.retain(|_| {
                    index += 1;
                    index % 2 == 1
                });
                self.stride *= 2;
            }
            if self.seen.is_multiple_of(self.stride) {
                self.points.push(point);
            }
        }
        self.seen += 1;
        self.last = Some(point);
    }

    /// The curve with its last point and the point of its smallest force.
    fn finish(mut self, smallest: CurvePoint, direction: Direction) -> Vec<CurvePoint> {
        if let Some(last) = self.last.filter(|last| self.points.last() != Some(last)) {
            self.points.push(last);
        }
        if direction == Direction::Unloading && !self.points.contains(&smallest) {
            let place = self.points.partition_point(|point| point.indentation > smallest.indentation);
            self.points.insert(place, smallest);
        }
        self.points
    }
}

impl Solver for Stepwise<'_> {
    fn advance(&mut self, leg: Leg) -> Result<LegRecord, ContactError> {
        let separated = self.tally.springs == 0;
        let here = self.point();
        let (direction, goal) = match leg {
            Leg::ToIndentation(_) | Leg::ToTouch => {
                let end = if let Leg::ToIndentation(end) = leg { end } else { 0.0 };
                let loads = end > self.indentation || (separated && end >= 0.0);
                (if loads { Direction::Loading } else { Direction::Unloading }, Goal::Indentation(end))
            }
            Leg::ToForce(_) | Leg::ToZeroForce => {
                let force = if let Leg::ToForce(force) = leg { force } else { 0.0 };
                if separated && force < 0.0 {
                    return Err(ContactError::NothingToPull { index: self.legs, force });
                }
                let loads = separated || force > here.force;
                (if loads { Direction::Loading } else { Direction::Unloading }, Goal::Force(force))
            }
            Leg::ToSeparation => (Direction::Unloading, Goal::Separation),
        };
        let done = !(separated && direction == Direction::Loading) && goal.reached(&here, direction);
        let free_to = match goal {
            Goal::Indentation(end) if separated && end < 0.0 => Some(end),
            _ => None,
        };
        let record = match free_to {
            _ if done => LegRecord::still(leg, here),
            Some(end) => {
                self.indentation = end;
                LegRecord::free(leg, here.indentation, end)
            }
            None => {
                self.check_reach(leg, direction, goal)?;
                let (contact, thresholds) = (self.contact.clone(), self.thresholds.clone());
                let tally = self.tally;
                self.walk(leg, direction, goal).inspect_err(|_| {
                    (self.contact, self.thresholds) = (contact, thresholds);
                    (self.indentation, self.tally) = (here.indentation, tally);
                })?
            }
        };
        self.legs += 1;
        Ok(record)
    }

    fn fragments(&self, indentation: f64) -> Vec<(usize, usize)> {
        super::fragments::runs(self.thresholds.iter().map(|&threshold| threshold <= indentation))
    }

    fn thresholds_along_line(&self, out: &mut Vec<f64>) {
        out.clear();
        out.extend_from_slice(&self.thresholds);
    }

    fn copy_leg(&self, copy: &mut LegContact) -> Result<(), ContactError> {
        copy.keep_line_order(&self.thresholds)
    }

    fn work(&self) -> Work {
        self.work
    }

    fn curve_seconds(&self) -> f64 {
        // Each step gives its point of the curve by itself.
        0.0
    }
}
