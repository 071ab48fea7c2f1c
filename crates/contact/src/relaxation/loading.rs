//! A motion of the drive in steps that are divided until the force is accurate.

use super::drive::{BALANCE, Drive};
use super::state::State;
use crate::error::ContactError;

/// Largest number of times that a step is halved. Where the contact jumps, the jump is located to
/// this share of a step.
const MOST_HALVINGS: u32 = 20;
/// Change of the force on a step, as a share of the tolerance, up to which a step with a jump is
/// not divided further.
const LOCATED: f64 = 0.25;
/// Growth of the force on a step, divided by the growth on the step before, above which the force
/// has jumped.
const FASTER: f64 = 4.0;
/// Largest number of guesses of the moment at which a motion reaches its goal.
const GUESSES: usize = 60;
/// Allowed difference between the reached force and the force of a goal, as a share of the largest
/// force.
const SAME: f64 = 1e-13;

/// A step of the drive: a motion at a constant speed to a displacement.
#[derive(Clone, Copy)]
pub struct Step {
    /// Displacement D of the drive at the end of the step in m.
    pub drive: f64,
    /// Duration of the step in s.
    pub seconds: f64,
}

impl Step {
    /// Returns the first part of a step that begins at the displacement `from` in m.
    fn part(self, from: f64, share: f64) -> Step {
        Step {
            drive: from + share * (self.drive - from),
            seconds: share * self.seconds,
        }
    }
}

/// Condition that ends a motion, as a function of the state: the motion ends where it is at least
/// zero.
pub type Goal<'a> = &'a dyn Fn(&State) -> f64;

impl Drive {
    /// Moves the drive by a step, and adds the states on the way to `states`, which must begin with
    /// the state before the step. The step is halved until two halves lead to the same force as one
    /// step, and the force in the middle lies between, up to `tolerance` in m.
    ///
    /// # Errors
    /// Returns [`ContactError::OutOfMemory`] if an array does not fit into memory.
    pub fn step(
        &mut self,
        states: &mut Vec<State>,
        step: Step,
        tolerance: f64,
    ) -> Result<(), ContactError> {
        let Some(from) = states.last().cloned() else {
            return Ok(());
        };
        let whole = self.driven(&from, step.drive, step.seconds)?;
        self.divide(states, &from, step, whole, tolerance, MOST_HALVINGS)
    }

    /// Adds the states on a step to `states`. `whole` is the state after the step, computed in one
    /// piece. If two half steps do not lead to the same force, the halves are divided further.
    fn divide(
        &mut self,
        states: &mut Vec<State>,
        from: &State,
        step: Step,
        whole: State,
        tolerance: f64,
        halvings: u32,
    ) -> Result<(), ContactError> {
        let moments = self.history.len();
        let half = step.part(from.drive, 0.5);
        let mut middle = self.driven(from, half.drive, half.seconds)?;
        self.remember(from, &middle);
        let mut end = self.driven(&middle, step.drive, step.seconds - half.seconds)?;
        let force = self.force(&end);
        let difference = (force - self.force(&whole)).abs();
        let mean = 0.5 * (self.force(from) + force);
        let bend = (self.force(&middle) - mean).abs();
        let growths = [(from, &middle), (&middle, &end)].map(|(from, to)| self.growth(from, to));
        // A force that falls and rises in turn may agree in the middle of a step by chance.
        let mut kink = 0.0;
        if let [Some(growth), _] = growths
            && let Some(growth_before) = from.growth
        {
            kink = 0.5 * half.seconds * (growth - growth_before).abs();
        }
        let is_lost = !from.is_separated() && end.is_separated();
        let jump = middle.jump.max(end.jump);
        let is_straight =
            difference.max(bend).max(kink).max(jump) <= tolerance.max(self.rounding());
        let is_accurate = is_straight && !is_lost
            || self.largest_change(from, &middle, &end) <= LOCATED * tolerance;
        if is_accurate || halvings == 0 {
            self.remember(&middle, &end);
            if is_straight {
                [middle.growth, end.growth] = growths;
            }
            self.largest_force = self.largest_force.max(force.abs());
            let continuous = if is_straight {
                f64::INFINITY
            } else {
                LOCATED * tolerance
            };
            self.push(states, middle, continuous);
            self.push(states, end, continuous);
            return Ok(());
        }
        self.forget(moments);
        let force_of_middle = self.force(&middle);
        self.divide(states, from, half, middle, tolerance, halvings - 1)?;
        let Some(middle) = states.last().cloned() else {
            return Ok(());
        };
        let rest = Step {
            drive: step.drive,
            seconds: step.seconds - half.seconds,
        };
        let deviation = (self.force(&middle) - force_of_middle).abs();
        let is_same = deviation <= LOCATED * tolerance;
        let whole = if is_same {
            end
        } else {
            self.driven(&middle, rest.drive, rest.seconds)?
        };
        self.divide(states, &middle, rest, whole, tolerance, halvings - 1)
    }

    /// Adds a state. If the force has jumped on the step to it, the state before the jump is put at
    /// the same moment, so that the record has both sides. Changes of the force up to `continuous`
    /// in m are no jumps.
    fn push(&self, states: &mut Vec<State>, state: State, continuous: f64) {
        if let Some(before) = states.last()
            && self.has_jumped(states, &state, continuous)
        {
            states.push(before.before_jump(&state, self.instrument.is_infinite()));
        }
        states.push(state);
    }

    /// Returns true if the force has jumped on the step from the last one of `states` to `state`. A
    /// force that changes as fast as on the step before has not jumped, unless patches have. On the
    /// first step the change is compared with that of a fixed contact.
    fn has_jumped(&self, states: &[State], state: &State, continuous: f64) -> bool {
        let Some(before) = states.last() else {
            return false;
        };
        let change = (self.force(state) - self.force(before)).abs();
        if change <= continuous {
            return false;
        }
        let growth = match states {
            [.., earlier, _] => self.growth(earlier, before),
            _ => None,
        };
        let usual = match growth {
            Some(growth) => growth.abs() * (state.seconds - before.seconds),
            None => self.largest_change(before, state, state),
        };
        state.jump > continuous || change > FASTER * usual
    }

    /// Returns the mean growth of the force in m/s from one state to another one.
    fn growth(&self, from: &State, to: &State) -> Option<f64> {
        let seconds = to.seconds - from.seconds;
        let growth = (self.force(to) - self.force(from)) / seconds;
        growth.is_finite().then_some(growth)
    }

    /// Returns the largest change of the force in m on the way from `from` over `middle` to `end`,
    /// apart from a jump.
    fn largest_change(&self, from: &State, middle: &State, end: &State) -> f64 {
        let loads = [&from.load, &middle.load, &end.load];
        let length = loads
            .map(|load| load.length)
            .into_iter()
            .fold(0.0, f64::max);
        let fresh = loads
            .map(|load| load.fresh.abs())
            .into_iter()
            .fold(0.0, f64::max);
        let way = (end.drive - from.drive).abs();
        let duration = (end.seconds - from.seconds) / self.relaxation.time();
        way * length.min(self.instrument) + self.relaxation.share() * fresh * duration.min(1.0)
    }

    /// Returns the error in m of a force that is computed for a displacement of the drive.
    pub fn accuracy(&self) -> f64 {
        let share = if self.instrument.is_infinite() {
            SAME
        } else {
            BALANCE
        };
        share * self.largest_force
    }

    fn rounding(&self) -> f64 {
        SAME * self.largest_force
    }

    /// Finds the state at which a motion reaches its goal, within the step from the state `from` to
    /// the state `to`. The goal is not reached at `from`, and is reached at `to`. A state also
    /// counts as the goal if its value of `goal` differs from zero by at most `rounding`.
    ///
    /// # Errors
    /// Returns [`ContactError::OutOfMemory`] if an array does not fit into memory.
    pub fn reach(
        &mut self,
        from: &State,
        to: State,
        goal: Goal<'_>,
        rounding: f64,
    ) -> Result<State, ContactError> {
        let step = Step {
            drive: to.drive,
            seconds: to.seconds - from.seconds,
        };
        let mut reached = to;
        let mut low = 0.0;
        let mut high = 1.0;
        let mut value_at_low = goal(from);
        let mut value_at_high = goal(&reached);
        for guess in 0..GUESSES {
            let between = high - value_at_high * ((high - low) / (value_at_high - value_at_low));
            let mut share = 0.5 * (low + high);
            if guess % 3 != 2 && low < between && between < high {
                share = between;
            }
            if share <= low || share >= high {
                break;
            }
            let part = step.part(from.drive, share);
            let state = self.driven(from, part.drive, part.seconds)?;
            let value = goal(&state);
            if value.abs() <= rounding {
                return Ok(state);
            }
            if value >= 0.0 {
                high = share;
                value_at_high = value;
                reached = state;
            } else {
                low = share;
                value_at_low = value;
            }
        }
        Ok(reached)
    }
}
