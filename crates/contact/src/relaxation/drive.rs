//! Steps of the motion: the body moves by a step of the indentation, or the drive of an instrument
//! moves by a step of its displacement.

use super::approach::Approach;
use super::field::Field;
use super::law::Relaxation;
use super::line::Line;
use super::memory::{History, Moment, Ramp};
use super::patch::{Settling, StretchedPatch};
use super::state::{Load, Phase, State, Turned};
use super::turn::Turn;
use crate::contact::Contact;
use crate::detachment::{ContactRule, DetachmentRule};
use crate::error::ContactError;
use crate::history::Direction;
use std::sync::Arc;

/// Largest number of guesses of the indentation at which instrument and contact are in equilibrium.
const GUESSES: usize = 160;
/// Number of guesses after which the steps between guesses are doubled.
const SHORT_GUESSES: usize = 8;
/// Share of the largest force up to which instrument and contact may be out of equilibrium.
pub const BALANCE: f64 = 1e-11;

/// Distance above the largest indentation, as a share of this indentation, up to which the body
/// still counts as being at the largest indentation.
const SAME_DEPTH: f64 = 1e-9;

/// A contact with relaxation and the history of its loading. From these follows the state of the
/// contact after a step of the motion.
pub struct Drive {
    pub contact: Contact,
    pub relaxation: Relaxation,
    pub approach: Approach,
    /// History of the loading up to the state from which the next step begins.
    pub history: History,
    /// Rule of detachment.
    rule: ContactRule,
    /// Stiffness of the instrument divided by the stiffness of one spring; infinite if the
    /// instrument is rigid.
    pub instrument: f64,
    /// Memories and patches at the last turn of the body; `None` if the history has grown since
    /// this turn.
    turned: Option<KnownTurn>,
    /// Largest magnitude of the force so far, divided by the stiffness of one spring, in m.
    pub largest_force: f64,
    /// Number of computed steps of the indentation.
    pub steps: u64,
}

/// Memories and patches at a turn of the body, for a history with the stated number of moments.
struct KnownTurn {
    moments: usize,
    line: Arc<Line>,
    patches: Vec<StretchedPatch>,
}

impl Drive {
    pub fn new(contact: &Contact, relaxation: Relaxation) -> Result<Self, ContactError> {
        Ok(Drive {
            contact: contact.clone(),
            relaxation,
            approach: Approach::new(contact)?,
            history: History::default(),
            rule: contact.rules().rule(Direction::Unloading),
            instrument: contact.loading_stiffness / contact.foundation.spring_stiffness(),
            turned: None,
            largest_force: 0.0,
            steps: 0,
        })
    }

    pub fn remaining(&self) -> f64 {
        self.relaxation.remaining_share()
    }

    /// Returns the force of a state, divided by the stiffness of one spring, in m.
    pub fn force(&self, state: &State) -> f64 {
        state.load.force(self.remaining())
    }

    /// Adds a state to the history of the loading, if the body has never been deeper than in this
    /// state. `before` is the state one step earlier.
    pub fn remember(&mut self, before: &State, state: &State) {
        if !matches!(state.phase, Phase::Deepest) {
            return;
        }
        if matches!(before.phase, Phase::Turned(_)) {
            // The body has returned to its largest indentation within this step.
            self.history.push(Moment {
                indentation: before.deepest,
                seconds: before.seconds,
                memory: before.memory + (before.deepest - before.indentation),
            });
        }
        self.history.push(Moment {
            indentation: state.deepest,
            seconds: state.seconds,
            memory: state.memory,
        });
    }

    /// Removes all moments of the history of the loading except the first `moments` ones.
    pub fn forget(&mut self, moments: usize) {
        if moments < self.history.len() {
            self.history.truncate(moments);
            self.turned = None;
        }
    }

    /// Returns the state after the drive has moved at a constant speed to the displacement `drive`
    /// in m. `seconds` is the duration of this motion in s.
    ///
    /// # Errors
    /// Returns [`ContactError::OutOfMemory`] if an array does not fit into memory.
    pub fn driven(
        &mut self,
        from: &State,
        drive: f64,
        seconds: f64,
    ) -> Result<State, ContactError> {
        let mut state = if self.instrument.is_infinite() {
            self.moved(from, drive, seconds)?
        } else {
            self.balanced(from, drive, seconds)?
        };
        state.drive = drive;
        Ok(state)
    }

    /// Finds the state in which the instrument, with its drive at `drive` in m, and the contact are
    /// in equilibrium. The search begins at the present indentation and does not pass the first
    /// equilibrium, because the force grows at most with the length in contact.
    fn balanced(&mut self, from: &State, drive: f64, seconds: f64) -> Result<State, ContactError> {
        let ramp = Ramp::new(self.relaxation, seconds);
        let remaining = self.remaining();
        let stiffness_of_cell = remaining + (1.0 - remaining) * ramp.mean_decay;
        let mut indentation = from.indentation;
        let mut state = self.moved(from, indentation, seconds)?;
        let mut excess = self.excess(&state, drive);
        // Guesses on the other side of the equilibrium than the first guess.
        let mut beyond: Option<(f64, f64)> = None;
        let begins_above = excess > 0.0;
        let mut before: Option<(f64, f64)> = None;
        for guess_number in 0..GUESSES {
            let scale = self.balance_scale(drive).max(self.force(&state).abs());
            if excess.abs() <= BALANCE * scale || excess == 0.0 {
                break;
            }
            let steepest = self.instrument + stiffness_of_cell * state.load.length;
            let shortest = -excess / steepest;
            let mut next = indentation + shortest;
            if let Some((other, other_excess)) = before
                && other_excess != excess
            {
                // The secant leads further, but not so far that it passes a jump.
                let secant = -excess * (indentation - other) / (excess - other_excess);
                next = indentation + longer(shortest, secant, 8.0);
            }
            if beyond.is_none() {
                // Where the contact is about to jump, the force hardly changes, and short steps
                // lead nowhere.
                let lengthened = guess_number.saturating_sub(SHORT_GUESSES).min(30);
                next = indentation + (next - indentation) * f64::from(1_u32 << lengthened);
            }
            if let Some((limit, _)) = beyond {
                let low = indentation.min(limit);
                let high = indentation.max(limit);
                // Interpolation alone may approach the equilibrium from one side only.
                if guess_number % 3 == 2 || !(low < next && next < high) {
                    next = 0.5 * (low + high);
                }
                if !(low < next && next < high) {
                    break;
                }
            }
            let guess = self.moved(from, next, seconds)?;
            let excess_of_guess = self.excess(&guess, drive);
            if (excess_of_guess > 0.0) == begins_above {
                before = Some((indentation, excess));
                indentation = next;
                excess = excess_of_guess;
                state = guess;
            } else {
                if excess_of_guess.abs() <= BALANCE * scale {
                    return Ok(guess);
                }
                beyond = Some((next, excess_of_guess));
                before = Some((next, excess_of_guess));
            }
        }
        // Where the contact jumps, no equilibrium is between the two last guesses. The body is then
        // beyond the jump.
        let scale = self.balance_scale(drive).max(self.force(&state).abs());
        match beyond {
            Some((limit, _)) if excess.abs() > BALANCE * scale => self.moved(from, limit, seconds),
            _ => Ok(state),
        }
    }

    /// Returns the largest force in m, against which a force out of equilibrium is compared.
    fn balance_scale(&self, drive: f64) -> f64 {
        self.largest_force.max(self.instrument * drive.abs())
    }

    /// Returns the force of the contact minus the force of the instrument, in m.
    fn excess(&self, state: &State, drive: f64) -> f64 {
        self.force(state) + self.instrument * (state.indentation - drive)
    }

    /// Returns the state after the body has moved at a constant speed to the indentation `to` in m.
    /// `seconds` is the duration of this motion in s. The drive stays in place.
    ///
    /// # Errors
    /// Returns [`ContactError::OutOfMemory`] if an array does not fit into memory.
    pub fn moved(&mut self, from: &State, to: f64, seconds: f64) -> Result<State, ContactError> {
        self.steps += 1;
        let ramp = Ramp::new(self.relaxation, seconds);
        let mut state = State {
            seconds: from.seconds + seconds,
            indentation: to,
            deepest: from.deepest.max(to),
            memory: ramp.memory(from.memory, to - from.indentation),
            ..State::apart()
        };
        state.drive = from.drive;
        match &from.phase {
            Phase::Apart if to < 0.0 => {
                state.memory = 0.0;
                state.seconds = 0.0;
            }
            Phase::Apart => self.approach(from, &ramp, &mut state)?,
            Phase::Deepest if to >= from.deepest - self.same_depth(from) => {
                self.approach(from, &ramp, &mut state)?;
            }
            Phase::Deepest => self.turn(from, &mut state)?,
            Phase::Turned(turned) if !turned.detached && to >= from.deepest => {
                self.approach(from, &ramp, &mut state)?;
            }
            Phase::Turned(turned) => self.settle(turned, &mut state),
        }
        Ok(state)
    }

    /// Returns the distance in m above the largest indentation up to which the body still counts as
    /// being there. The equilibrium with the instrument is known only up to rounding errors.
    fn same_depth(&self, state: &State) -> f64 {
        SAME_DEPTH * (state.deepest + self.rule.largest_stretch(state.load.length))
    }

    /// Computes the load of a body that is at its largest indentation so far.
    fn approach(&self, from: &State, ramp: &Ramp, state: &mut State) -> Result<(), ContactError> {
        let before = &from.load;
        let mut load = self.approach.load(state.deepest)?;
        load.compression -= load.length * (state.deepest - state.indentation);
        state.jump = self.approach.bend(from.deepest, state.deepest);
        // While springs attach, the fresh part v of all compressions grows as the compressions do,
        // and decays.
        let growth = load.compression - before.compression;
        load.fresh = before.fresh * ramp.decay + growth * ramp.mean_decay;
        // d(∫v²)/dt = −(2/τ) ∫v² + 2 ḋ (∫v − ∫u) + d(∫u²)/dt.
        let way = state.indentation - from.indentation;
        let relaxed = (load.compression - load.fresh) + (before.compression - before.fresh);
        let growth = load.squares - before.squares - way * relaxed;
        let decayed = before.fresh_squares * ramp.decay * ramp.decay;
        load.fresh_squares = (decayed + growth * ramp.mean_square).max(0.0);
        state.load = load;
        state.phase = Phase::Deepest;
        Ok(())
    }

    /// Turns the body at the state `from`, and lets springs detach.
    fn turn(&mut self, from: &State, state: &mut State) -> Result<(), ContactError> {
        let moments = self.history.len();
        let known = match self.turned.take() {
            Some(known) if known.moments == moments => known,
            _ => {
                let (line, patches) = Turn {
                    stage: &self.approach.stage,
                    relaxation: self.relaxation,
                    history: &self.history,
                    deepest: from.deepest,
                    seconds: from.seconds,
                }
                .memories()?;
                KnownTurn {
                    moments,
                    line: Arc::new(line),
                    patches,
                }
            }
        };
        let turned = Turned {
            line: Arc::clone(&known.line),
            patches: known.patches.clone(),
            detached: false,
        };
        self.turned = Some(known);
        self.settle(&turned, state);
        Ok(())
    }

    /// Returns those numbers of a state that are the same for all springs: the indentation, the
    /// common memory, and the factor by which the memories of springs have decayed.
    pub fn field(&self, line: &Line, state: &State) -> Field {
        let age = (state.seconds - line.turned_at) / self.relaxation.time();
        Field {
            remaining: line.remaining,
            decay: (-age).exp(),
            indentation: state.indentation,
            memory: state.memory,
        }
    }

    /// Lets springs of a body that has turned detach, and computes the load.
    fn settle(&self, turned: &Turned, state: &mut State) {
        let line = &turned.line;
        let field = self.field(line, state);
        let mut detached = turned.detached;
        let mut patches = Vec::with_capacity(turned.patches.len() + 1);
        for patch in &turned.patches {
            let before = patches.len();
            match patch.settle(line, &field, self.rule, &mut patches) {
                Settling::Holds => {}
                Settling::Slides => detached = true,
                Settling::Jumps => {
                    detached = true;
                    state.jump += patch.lost_force(&patches[before..], &field).abs();
                }
            }
        }
        state.load = Load::of_patches(&patches, &field);
        state.phase = Phase::Turned(Turned {
            line: Arc::clone(line),
            patches,
            detached,
        });
    }
}

/// Returns the longer one of two steps in the same direction, limited to `most` times the first.
fn longer(step: f64, other: f64, most: f64) -> f64 {
    if other / step > 1.0 {
        step * (other / step).min(most)
    } else {
        step
    }
}
