//! The stepwise solver: move by a small step, relax to equilibrium, repeat, as the paper does.
//!
//! The step Δd is its accuracy; each step costs a few sweeps over the whole line. The solver shares only the rules and
//! the sums with the exact solver; exact thresholds are used only before the first step of a leg, to check its end and
//! number of steps.

use super::contact_state::counted;
use super::leg_plan::{Target, plan};
use super::{
    ContactError, ContactTotals, ContactTree, CurvePoint, Direction, Foundation, GapScale, GridEdges,
    HessRule, LegRecord, LegView, Manual, ManualError, ManualLoading, Solver, Work, fragments, resized,
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
    totals: ContactTotals,
    /// Σ e² over the springs detached, less that over the springs attached, on the present leg, m².
    squared_stretch: f64,
    legs: usize,
    work: Work,
}

impl<'a> Stepwise<'a> {
    /// A separated body over springs of these gaps (m, the smallest 0), moved by steps of `step` m;
    /// without a rule of Hess there is no adhesion. `stop` returns true after a step to end the run.
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
        Ok(Stepwise {
            gaps,
            hess,
            foundation,
            step,
            samples: samples.max(2),
            stop,
            scale: GapScale::for_gaps_up_to(gaps.iter().copied().fold(0.0, f64::max)),
            contact: resized(Vec::new(), gaps.len(), false)?,
            thresholds: resized(Vec::new(), gaps.len(), f64::INFINITY)?,
            indentation: 0.0,
            totals: ContactTotals::default(),
            squared_stretch: 0.0,
            legs: 0,
            work: Work { springs: gaps.len() as u64, ..Work::default() },
        })
    }

    fn largest_stretch(&self, springs: usize, direction: Direction) -> f64 {
        // Without the rule nothing is stretched at all.
        self.hess.map_or(0.0, |hess| hess.on(direction).largest_stretch(springs as u32))
    }

    /// Attaches a spring, or detaches it where it has been held to this indentation, m: the overshoot of a step is no
    /// property of the contact.
    fn change(&mut self, index: usize, attaches: bool, at: f64) {
        self.contact[index] = attaches;
        self.thresholds[index] = at;
        let sign = if attaches { 1 } else { -1 };
        self.totals.springs += i64::from(sign);
        self.totals.quanta += i128::from(sign) * i128::from(self.scale.quanta(self.gaps[index]));
        let stretch = (self.gaps[index] - at).max(0.0);
        self.squared_stretch -= f64::from(sign) * stretch * stretch;
    }

    /// Sweeps until no spring touches and no fragment grows.
    fn relax_loading(&mut self) {
        loop {
            let before = self.totals.springs;
            self.work.relaxation_sweeps += 1;
            self.work.spring_updates += self.gaps.len() as u64;
            for index in 0..self.gaps.len() {
                if !self.contact[index] && self.gaps[index] <= self.indentation {
                    self.change(index, true, self.indentation);
                }
            }
            if self.hess.is_some() {
                self.grow_fragments();
            }
            if self.totals.springs == before {
                return;
            }
        }
    }

    /// Extends each fragment over its neighbours as long as the rule allows.
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
                let stretch = self.largest_stretch(end - start, Direction::Loading);
                self.work.spring_updates += 2;
                let takes = |index: usize| self.gaps[index] - stretch <= self.indentation;
                if end < count && takes(end) {
                    self.change(end, true, self.indentation);
                } else if start > 0 && takes(start - 1) {
                    self.change(start - 1, true, self.indentation);
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
            let held = self.totals.springs;
            self.work.relaxation_sweeps += 1;
            let mut first = 0;
            while first < self.gaps.len() {
                let mut end = first;
                while end < self.gaps.len() && self.contact[end] {
                    end += 1;
                }
                self.work.spring_updates += 2 * (end - first) as u64 + 1;
                let stretch = self.largest_stretch(end - first, Direction::Unloading);
                for index in first..end {
                    let gap = self.gaps[index];
                    // A spring stretched too far here is stretched too far in each part of the fragment as well.
                    if self.indentation <= gap - stretch && self.indentation < gap {
                        self.change(index, false, held_until);
                    }
                }
                first = end + 1;
            }
            if self.totals.springs == held {
                return;
            }
        }
    }

    fn count_fragments(&mut self) {
        let starts =
            (0..self.contact.len()).filter(|&i| self.contact[i] && (i == 0 || !self.contact[i - 1])).count();
        self.totals.fragments = starts as i64;
    }

    fn point(&self) -> CurvePoint {
        let compression = self.totals.compression(self.indentation, &self.scale);
        CurvePoint {
            indentation: self.indentation,
            force: self.foundation.spring_stiffness() * compression,
            contact_length: self.foundation.contact_length(self.totals.springs as f64),
            springs: counted(self.totals.springs),
            fragments: counted(self.totals.fragments),
        }
    }

    /// Sets the thresholds for the beginning of a leg.
    fn begin(&mut self) {
        for (threshold, &contact) in self.thresholds.iter_mut().zip(&self.contact) {
            *threshold = if contact { f64::NEG_INFINITY } else { f64::INFINITY };
        }
        self.squared_stretch = 0.0;
    }

    /// Refuses a leg whose end is out of reach or beyond the limit of steps, before its first step.
    ///
    /// # Errors
    /// [`ContactError::DetachesBefore`], [`ContactError::OutOfReach`], [`ContactError::TooManySteps`].
    fn check_reach(&self, leg: Leg, direction: Direction, target: Target) -> Result<(), ContactError> {
        let end = match target {
            Target::Indentation(end) => end,
            Target::Force(_) | Target::Separation => self.reaches(leg, direction, target)?,
        };
        // From separation the first step is the touch.
        let start = if self.totals.springs == 0 { self.indentation.max(0.0) } else { self.indentation };
        // No end is closer than the exact one, and the last step may be partial.
        if (end - start).abs() / self.step > STEP_LIMIT as f64 {
            let index = self.legs;
            return Err(ContactError::TooManySteps { index, step: self.step, limit: STEP_LIMIT });
        }
        Ok(())
    }

    /// Indentation, m, at which the present contact, pulled, reaches a target, or below which no contact, pressed, carries
    /// a force: adhesion only lessens it.
    fn reaches(&self, leg: Leg, direction: Direction, target: Target) -> Result<f64, ContactError> {
        let tree = Arc::new(ContactTree::build(self.gaps, Edges::Grid)?);
        let body = match direction {
            Direction::Loading => {
                Manual::new(self.gaps, tree, GridEdges::new(HessRule::NO_ADHESION), self.foundation)
                    .map_err(ManualError::Contact)
            }
            Direction::Unloading => {
                let edges = GridEdges::new(self.hess.unwrap_or(HessRule::NO_ADHESION));
                let contacts = fragments::runs(self.contact.iter().copied());
                let at = self.indentation;
                Manual::in_contact(self.gaps, tree, edges, self.foundation, at, &contacts, &[])
            }
        };
        let reached = body.and_then(|mut body| {
            match target {
                Target::Force(force) if direction == Direction::Loading => {
                    body.move_to_force(force.max(0.0))?
                }
                Target::Force(force) => body.move_to_force(force)?,
                Target::Indentation(_) | Target::Separation => body.separate(),
            };
            Ok(body.point().indentation)
        });
        reached.map_err(|error| match error {
            ManualError::Contact(error) => error,
            ManualError::DetachesBefore { smallest, .. } => {
                ContactError::DetachesBefore { index: self.legs, leg, smallest }
            }
            ManualError::NotFinite { .. }
            | ManualError::NothingToPull { .. }
            | ManualError::OutOfReach { .. } => ContactError::OutOfReach { index: self.legs, leg },
        })
    }

    /// Steps to the target.
    fn walk(&mut self, leg: Leg, direction: Direction, target: Target) -> Result<LegRecord, ContactError> {
        self.begin();
        let before = self.totals.springs;
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
            self.indentation = target.clip(wanted, direction);
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
            if target.reached(&point, direction) {
                break;
            }
            if point.springs == 0 && direction == Direction::Unloading && matches!(target, Target::Force(_)) {
                let index = self.legs;
                return Err(ContactError::DetachesBefore { index, leg, smallest: smallest.force });
            }
        }
        let changed = (self.totals.springs - before).unsigned_abs();
        // The sum counts detachments.
        let squared =
            if direction == Direction::Loading { -self.squared_stretch } else { self.squared_stretch };
        let energy = 0.5 * self.foundation.spring_stiffness() * squared;
        let curve = curve.finish(smallest, direction);
        let record = LegRecord::moved((leg, direction), curve, [smallest, largest], changed, energy);
        self.work.count(&record);
        Ok(record)
    }
}

impl Target {
    fn clip(self, indentation: f64, direction: Direction) -> f64 {
        match (self, direction) {
            (Target::Indentation(end), Direction::Loading) => indentation.min(end),
            (Target::Indentation(end), Direction::Unloading) => indentation.max(end),
            _ => indentation,
        }
    }

    fn reached(self, point: &CurvePoint, direction: Direction) -> bool {
        match (self, direction) {
            (Target::Indentation(end), _) => point.indentation == end,
            (Target::Force(force), Direction::Loading) => point.force >= force,
            (Target::Force(force), Direction::Unloading) => point.force <= force && point.springs > 0,
            (Target::Separation, _) => point.springs == 0,
        }
    }
}

/// A curve whose density is halved at twice the wanted length.
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
        if self.seen.is_multiple_of(self.stride) && self.points.len() >= 2 * self.wanted {
            self.points = self.points.iter().copied().step_by(2).collect();
            self.stride *= 2;
        }
        if self.seen.is_multiple_of(self.stride) {
            self.points.push(point);
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
        let here = self.point();
        let record = match plan(leg, here, self.legs)? {
            None => LegRecord::still(leg, here),
            Some((_, Target::Indentation(end))) if here.springs == 0 && end < 0.0 => {
                self.indentation = end;
                LegRecord::free(leg, here.indentation, end)
            }
            Some((direction, target)) => {
                self.check_reach(leg, direction, target)?;
                let (contact, thresholds) = (self.contact.clone(), self.thresholds.clone());
                let totals = self.totals;
                self.walk(leg, direction, target).inspect_err(|_| {
                    (self.contact, self.thresholds) = (contact, thresholds);
                    (self.indentation, self.totals) = (here.indentation, totals);
                })?
            }
        };
        self.legs += 1;
        Ok(record)
    }

    fn leg(&self) -> LegView<'_> {
        LegView::of_thresholds(self.gaps, &self.thresholds)
    }

    fn work(&self) -> Work {
        self.work
    }

    fn curve_seconds(&self) -> f64 {
        // Each step adds its own point to the curve.
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// For any number of points pushed, the curve has from `wanted` to twice as many, evenly spread in the order of
        /// the steps, with both ends; on unloading the smallest force as well.
        #[test]
        fn a_thinned_curve_is_even(wanted in 2_usize..20, steps in 1_usize..500, lowest in 0.0..1.0_f64) {
            let pushed: Vec<_> = (0..steps)
                .map(|k| CurvePoint { indentation: -(k as f64), ..CurvePoint::default() })
                .collect();
            let smallest = pushed[(lowest * steps as f64) as usize];
            for direction in [Direction::Loading, Direction::Unloading] {
                let mut thinned = Thinned::new(wanted);
                pushed.iter().for_each(|&point| thinned.push(point));
                let curve = thinned.finish(smallest, direction);
                let at: Vec<_> = curve.iter().map(|point| -point.indentation as usize).collect();
                let mut stride = 1;
                while (steps - 1) / stride + 1 > 2 * wanted {
                    stride *= 2;
                }
                let mut expected: Vec<_> = (0..steps).step_by(stride).chain([steps - 1]).collect();
                if direction == Direction::Unloading {
                    expected.push(-smallest.indentation as usize);
                }
                expected.sort_unstable();
                expected.dedup();
                prop_assert!(at.len() >= wanted.min(steps));
                prop_assert_eq!(at, expected);
            }
        }
    }
}
