//! The common memory J of all springs, and the history of the approach, from which each spring
//! takes the time at which it attached.

use super::law::Relaxation;

/// Lengths of time relative to the relaxation time, below which (1 − e^(−x))/x is computed as 1.
const AT_ONCE: f64 = 1e-300;

/// A step of the motion in which the indentation changes at a constant speed.
#[derive(Clone, Copy, Debug)]
pub struct Ramp {
    /// Factor e^(−Δt/τ) by which memories decay in the step. Δt is the duration of the step and τ
    /// the relaxation time.
    pub decay: f64,
    /// Mean of the decaying factor e^(−t/τ) over the step, (1 − e^(−Δt/τ)) τ/Δt.
    pub mean_decay: f64,
    /// Mean of the square of this factor over the step.
    pub mean_square: f64,
}

impl Ramp {
    /// Creates a step with the duration `seconds` in s. A step with the duration 0 is a jump.
    pub fn new(relaxation: Relaxation, seconds: f64) -> Self {
        let duration = seconds / relaxation.time();
        Ramp {
            decay: (-duration).exp(),
            mean_decay: mean_decay(duration),
            mean_square: mean_decay(2.0 * duration),
        }
    }

    /// Returns the common memory J in m after the step. `memory` is J before the step, and `way` is
    /// the change of the indentation, both in m.
    pub fn memory(&self, memory: f64, way: f64) -> f64 {
        memory * self.decay + way * self.mean_decay
    }
}

fn mean_decay(duration: f64) -> f64 {
    if duration < AT_ONCE {
        return 1.0;
    }
    -(-duration).exp_m1() / duration
}

/// A moment of the loading at which the body reached an indentation for the first time.
#[derive(Clone, Copy, Debug)]
pub struct Moment {
    /// Indentation in m.
    pub indentation: f64,
    /// Time in s.
    pub seconds: f64,
    /// Common memory J in m.
    pub memory: f64,
}

/// History of the loading: moments with ascending indentations and times. Between two moments the
/// indentation grows at a constant speed.
#[derive(Clone, Debug, Default)]
pub struct History {
    moments: Vec<Moment>,
}

impl History {
    pub fn push(&mut self, moment: Moment) {
        self.moments.push(moment);
    }

    pub fn len(&self) -> usize {
        self.moments.len()
    }

    pub fn truncate(&mut self, len: usize) {
        self.moments.truncate(len);
    }

    /// Returns the time in s of the moment with the index `index`.
    pub fn time_of(&self, index: usize) -> f64 {
        self.moments[index].seconds
    }

    /// Returns the moment at which the body first reached an indentation in m. If the indentation
    /// lies outside the history, returns the first or the last moment of the history.
    pub fn first_at(&self, relaxation: Relaxation, indentation: f64) -> Moment {
        let next = self
            .moments
            .partition_point(|moment| moment.indentation < indentation);
        let Some(after) = self.moments.get(next) else {
            return self.moments.last().copied().unwrap_or(Moment {
                indentation,
                seconds: 0.0,
                memory: 0.0,
            });
        };
        let Some(before) = next.checked_sub(1).map(|index| self.moments[index]) else {
            return *after;
        };
        let way = indentation - before.indentation;
        let share = way / (after.indentation - before.indentation);
        let seconds = share * (after.seconds - before.seconds);
        let duration = seconds / relaxation.time();
        let mean_decay = mean_decay(duration);
        let decay = 1.0 - duration * mean_decay;
        Moment {
            indentation,
            seconds: before.seconds + seconds,
            memory: before.memory * decay + way * mean_decay,
        }
    }
}
