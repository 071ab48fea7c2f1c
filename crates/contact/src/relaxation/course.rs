//! The course of a stage: the drive moves in steps until the goal of the stage is reached.

use super::drive::Drive;
use super::loading::Step;
use super::recorder::Recorder;
use super::state::State;
use crate::detachment::DetachmentRule;
use crate::error::ContactError;
use crate::history::{Direction, Goal, Work};

/// Number of equal steps with which a stage is planned. A step that is not accurate enough is
/// halved later.
pub const STEPS: usize = 48;
/// Largest number of steps of one stage. The length of steps is doubled again and again, so that no
/// target within reach needs as many.
const MOST_STEPS: usize = 1 << 12;

/// A motion of the drive of the instrument in small steps, until the goal of a loading stage is
/// reached.
pub struct Course<'a> {
    drive: &'a mut Drive,
    direction: Direction,
    goal: Goal,
    /// Displacement in m by which the drive moves in a step; negative on unloading.
    step: f64,
    /// Speed of the drive in m/s.
    pub speed: f64,
    /// Largest error that the steps may cause in the force, as a share of the largest force.
    pub tolerance: f64,
    /// Function that returns true if the motion has to be interrupted.
    pub stop: &'a dyn Fn() -> bool,
}

impl<'a> Course<'a> {
    /// Plans the motion from the state `from` to `goal`, and chooses the length of its steps.
    ///
    /// # Errors
    /// Returns an error if no indentation has the target force, or if the memory does not suffice.
    pub fn new(
        drive: &'a mut Drive,
        from: &State,
        direction: Direction,
        goal: Goal,
        work: &mut Work,
    ) -> Result<Self, ContactError> {
        let step = Self::step_of(drive, from, direction, goal, work)?;
        Ok(Course {
            drive,
            direction,
            goal,
            step,
            speed: 1.0,
            tolerance: 0.0,
            stop: &|| false,
        })
    }

    /// Returns the distance in m by which the drive moves in one step, and prepares the elastic
    /// loading for this motion.
    fn step_of(
        drive: &mut Drive,
        from: &State,
        direction: Direction,
        goal: Goal,
        work: &mut Work,
    ) -> Result<f64, ContactError> {
        let contact = &drive.contact;
        let spring = contact.foundation.spring_stiffness();
        if direction == Direction::Unloading {
            let rule = contact.rules().rule(direction);
            let load = &from.load;
            let pulled = rule.largest_stretch(load.length);
            let tension = load.length * pulled / drive.instrument;
            let bent = from.drive - from.indentation;
            let lowest = match goal {
                // A body that is pulled farther has separated before.
                Goal::Indentation(end) => end.max(-pulled),
                Goal::Displacement(end) => (end - bent.max(0.0)).max(-pulled),
                Goal::Force(_) | Goal::Separation(_) => -pulled,
            };
            let way = (from.indentation - lowest) + bent.max(0.0) + tension;
            return Ok(-way / STEPS as f64);
        }
        let low = from.indentation.max(0.0);
        let goal_of_elastic = match goal {
            Goal::Displacement(end) if drive.instrument.is_infinite() => Goal::Indentation(end),
            goal => goal,
        };
        let approach = &drive.approach.stage;
        let (end, _) = approach.reach(goal_of_elastic, low.min(approach.end()), work)?;
        let elastic = approach.state(end)?;
        drive.approach.prepare(end)?;
        let force = elastic.compression.abs();
        drive.largest_force = drive.largest_force.max(match goal {
            Goal::Force(force) => force.abs() / spring,
            _ => drive.remaining() * force,
        });
        let drive_end = match goal {
            Goal::Displacement(end) => end,
            _ => end + elastic.compression / drive.instrument,
        };
        let way = (drive_end - from.drive).max(end - from.indentation);
        if way > 0.0 {
            return Ok(way / STEPS as f64);
        }
        // The elastic contact is already at the goal, which the relaxed one has yet to reach.
        let scale = from.drive.abs().max(from.indentation.abs());
        let small = scale.max(contact.profile.deepest()).max(f64::MIN_POSITIVE);
        Ok(small * 1e-3 / STEPS as f64)
    }

    /// Moves the drive until the goal is reached. The computed states are added to `states` and to
    /// `recorder`.
    ///
    /// # Errors
    /// Returns [`ContactError::DetachesBefore`] or [`ContactError::OutOfReach`] if the body cannot
    /// reach the goal, [`ContactError::Interrupted`] if the motion was interrupted, and
    /// [`ContactError::OutOfMemory`] if an array does not fit into memory.
    pub fn run(
        &mut self,
        states: &mut Vec<State>,
        recorder: &mut Recorder<'_>,
    ) -> Result<(), ContactError> {
        let remaining = self.drive.remaining();
        let spring = self.drive.contact.foundation.spring_stiffness();
        let sign = match self.direction {
            Direction::Loading => 1.0,
            Direction::Unloading => -1.0,
        };
        let goal = self.goal;
        let separates = matches!(goal, Goal::Separation(_));
        let goal_value = move |state: &State| match goal {
            Goal::Force(force) => sign * (state.load.force(remaining) - force / spring),
            Goal::Indentation(end) => sign * (state.indentation - end),
            Goal::Displacement(end) => sign * (state.drive - end),
            Goal::Separation(_) => {
                if state.is_separated() {
                    0.0
                } else {
                    -1.0
                }
            }
        };
        let end_of_drive = self.end_of_drive();
        let mut step = self.step;
        let mut steps = 0;
        if states.last().is_some_and(|state| goal_value(state) >= 0.0) {
            return Ok(());
        }
        loop {
            let Some(from) = states.last() else {
                return Ok(());
            };
            if (self.stop)() {
                return Err(ContactError::Interrupted);
            }
            let mut drive = from.drive + step;
            if let Some(end) = end_of_drive
                && (end - drive) * sign <= 0.25 * step.abs()
            {
                drive = end;
            }
            let seconds = (drive - from.drive).abs() / self.speed;
            let first_new = states.len();
            let tolerance = self.tolerance * self.drive.largest_force;
            let moments = self.drive.history.len();
            self.drive
                .step(states, Step { drive, seconds }, tolerance)?;
            let reached = (first_new..states.len()).find(|&index| {
                let state = &states[index];
                let is_at_end = goal_value(state) >= 0.0 || (state.is_separated() && !separates);
                is_at_end && !state.precedes_jump
            });
            if let Some(index) = reached {
                return self.stop_at(states, index, moments, &goal_value, recorder);
            }
            recorder.add_all_but_last(states);
            steps += 1;
            if steps > MOST_STEPS {
                return Err(ContactError::OutOfReach);
            }
            if steps % (STEPS / 2) == 0 && end_of_drive.is_none() {
                step *= 2.0;
            }
        }
    }

    /// Returns the displacement of the drive in m at which the motion certainly ends.
    fn end_of_drive(&self) -> Option<f64> {
        match self.goal {
            Goal::Displacement(end) => Some(end),
            Goal::Indentation(end) if self.drive.instrument.is_infinite() => Some(end),
            _ => None,
        }
    }

    /// Ends a motion at the goal, which the state with the index `index` is the first to pass.
    fn stop_at(
        &mut self,
        states: &mut Vec<State>,
        index: usize,
        moments: usize,
        goal_value: &dyn Fn(&State) -> f64,
        recorder: &Recorder<'_>,
    ) -> Result<(), ContactError> {
        let reached = states[index].clone();
        states.truncate(index);
        let jumps = states[index - 1].precedes_jump;
        let from = states[index - 1 - usize::from(jumps)].clone();
        if reached.is_separated() && goal_value(&reached) < 0.0 || self.is_lost(&reached) {
            if matches!(self.goal, Goal::Force(_)) {
                let remaining = self.drive.remaining();
                let forces = states.iter().map(|state| state.load.force(remaining));
                let smallest = forces.fold(f64::INFINITY, f64::min);
                let spring = self.drive.contact.foundation.spring_stiffness();
                return Err(ContactError::DetachesBefore {
                    smallest: recorder.smallest_force().min(spring * smallest),
                });
            }
            let end = self.moved_freely(&reached);
            states.push(reached);
            states.extend(end);
            return Ok(());
        }
        // The moments after the goal are no part of the motion.
        let seconds = from.seconds;
        let mut kept = self.drive.history.len();
        while kept > moments && self.drive.history.time_of(kept - 1) > seconds {
            kept -= 1;
        }
        self.drive.forget(kept);
        let state = if matches!(self.goal, Goal::Separation(_)) || goal_value(&reached) == 0.0 {
            reached
        } else {
            if jumps {
                states.pop();
            }
            let rounding = match self.goal {
                Goal::Force(_) => self.drive.accuracy(),
                _ => 0.0,
            };
            self.drive.reach(&from, reached, goal_value, rounding)?
        };
        let state = match self.goal {
            // The search ends at the indentation to rounding.
            Goal::Indentation(indentation) => State {
                indentation,
                ..state
            },
            _ => state,
        };
        self.drive.remember(&from, &state);
        states.push(state);
        Ok(())
    }

    /// Returns the state at the target of an unloading if the body has separated before it reaches
    /// this target. The body then moves on without contact. Returns `None` if the target is a force
    /// or the separation itself.
    fn moved_freely(&self, separated: &State) -> Option<State> {
        let (Goal::Indentation(end) | Goal::Displacement(end)) = self.goal else {
            return None;
        };
        let way = (separated.drive - end).max(0.0);
        (self.direction == Direction::Unloading).then(|| State {
            seconds: separated.seconds + way / self.speed,
            drive: end,
            indentation: end,
            ..separated.clone()
        })
    }

    /// Returns true if a motion to a force ends because the contact is lost.
    fn is_lost(&self, reached: &State) -> bool {
        matches!(self.goal, Goal::Force(_))
            && self.direction == Direction::Unloading
            && reached.is_separated()
    }
}
