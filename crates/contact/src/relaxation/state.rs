//! The state of a relaxing contact at one moment.

use super::field::{Field, Sums};
use super::line::Line;
use super::patch::StretchedPatch;
use crate::contact_state::{ContactState, counted};
use crate::foundation::Foundation;
use crate::history::CurvePoint;
use std::sync::Arc;

/// Sums over the springs in contact. Forces are in m: they are divided by the stiffness of one
/// spring.
#[derive(Clone, Copy, Debug, Default)]
pub struct Load {
    /// Length in contact in cells.
    pub length: f64,
    /// ∫ u dx in m, where u is the compression of a spring and x is in cells.
    pub compression: f64,
    /// ∫ v dx in m, where v is that part of the compression which has not relaxed.
    pub fresh: f64,
    /// ∫ u² dx in m².
    pub squares: f64,
    /// ∫ v² dx in m².
    pub fresh_squares: f64,
    pub springs: u64,
    pub patches: u64,
}

impl Load {
    /// Returns the elastic part of the load on the approach; nothing of it has relaxed.
    pub fn of_approach(state: &ContactState) -> Self {
        Load {
            length: state.length,
            compression: state.compression,
            fresh: state.compression,
            squares: state.squares,
            fresh_squares: state.squares,
            springs: counted(state.totals.springs),
            patches: counted(state.totals.patches),
        }
    }

    /// Sums up the patches of a body that has turned.
    pub fn of_patches(patches: &[StretchedPatch], field: &Field) -> Self {
        let mut sums = Sums::default();
        let mut springs = 0;
        for patch in patches {
            sums = sums.plus(patch.sums);
            springs += patch.springs() as u64;
        }
        let Field {
            decay,
            indentation,
            memory,
            ..
        } = *field;
        let Sums { length, .. } = sums;
        let whole = indentation * length;
        let squares = indentation * (whole - 2.0 * sums.gap) + sums.gap_square;
        let own = decay * sums.memory;
        let fresh_squares =
            memory * (memory * length + 2.0 * own) + decay * decay * sums.memory_square;
        Load {
            length,
            compression: whole - sums.gap,
            fresh: memory * length + own,
            squares: squares.max(0.0),
            fresh_squares: fresh_squares.max(0.0),
            springs,
            patches: patches.len() as u64,
        }
    }

    /// Returns the force in m. `remaining` is the share of the modulus that remains.
    pub fn force(&self, remaining: f64) -> f64 {
        remaining * self.compression + (1.0 - remaining) * self.fresh
    }
}

/// Part of the motion: separated, at the largest indentation, or after the turn.
#[derive(Clone, Debug)]
pub enum Phase {
    /// The body has touched nothing yet.
    Apart,
    /// The body is at its largest indentation so far: the contact is that of the approach.
    Deepest,
    /// The body is above its largest indentation.
    Turned(Turned),
}

/// The patches of a body that has turned.
#[derive(Clone, Debug)]
pub struct Turned {
    pub line: Arc<Line>,
    pub patches: Vec<StretchedPatch>,
    /// True if springs have detached, which do not attach again.
    pub detached: bool,
}

/// The state of the body and of its instrument at one moment.
#[derive(Clone, Debug)]
pub struct State {
    /// Time in s since first touch.
    pub seconds: f64,
    /// Displacement D of the drive of the instrument in m.
    pub drive: f64,
    /// Indentation d in m.
    pub indentation: f64,
    /// Largest indentation so far in m.
    pub deepest: f64,
    /// Common memory J of all springs in m.
    pub memory: f64,
    pub load: Load,
    pub phase: Phase,
    /// Change of the force in m by jumps on the step to this state. Jumps that cancel leave no
    /// other trace.
    pub jump: f64,
    /// Mean growth of the force in m/s on the step to this state; `None` after a jump.
    pub growth: Option<f64>,
    /// True if this is the state before a jump, put at the moment of the jump. It belongs to the
    /// record, and no step begins or ends there.
    pub precedes_jump: bool,
}

impl State {
    /// Returns a separated body just before first touch.
    pub fn apart() -> Self {
        State {
            seconds: 0.0,
            drive: 0.0,
            indentation: 0.0,
            deepest: 0.0,
            memory: 0.0,
            load: Load::default(),
            phase: Phase::Apart,
            jump: 0.0,
            growth: None,
            precedes_jump: false,
        }
    }

    /// Returns this state at the moment of a jump that leads to the state `after`.
    pub fn before_jump(&self, after: &State, is_rigid: bool) -> Self {
        let indentation = if is_rigid {
            after.drive
        } else {
            self.indentation + (after.drive - self.drive)
        };
        State {
            seconds: after.seconds,
            drive: after.drive,
            indentation,
            precedes_jump: true,
            ..self.clone()
        }
    }

    /// Returns the state at the begin of a stage, where the motion of the drive changes.
    pub fn at_rest(&self) -> Self {
        State {
            growth: None,
            ..self.clone()
        }
    }

    pub fn is_separated(&self) -> bool {
        self.load.patches == 0
    }

    pub fn has_detached(&self) -> bool {
        matches!(self.phase, Phase::Turned(Turned { detached: true, .. }))
    }

    pub fn point(&self, foundation: Foundation, remaining: f64) -> CurvePoint {
        let stiffness = foundation.spring_stiffness();
        let load = &self.load;
        let squares = remaining * load.squares + (1.0 - remaining) * load.fresh_squares;
        CurvePoint {
            indentation: self.indentation,
            force: stiffness * load.force(remaining),
            contact_length: foundation.contact_length(load.length),
            springs: load.springs,
            patches: load.patches,
            stored_energy: 0.5 * stiffness * squares,
        }
    }
}
