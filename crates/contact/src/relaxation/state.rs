//! The state of a relaxing contact at one moment.

use super::field::{Field, Sums};
use super::line::Line;
use super::patch::StretchedPatch;
use crate::contact_state::counted;
use crate::foundation::Foundation;
use crate::history::CurvePoint;
use crate::totals::ContactTotals;
use std::sync::Arc;

/// Sums over the springs in contact. Forces are in m: they are divided by the stiffness of one
/// spring.
#[derive(Clone, Copy, Debug, Default)]
pub struct Load {
    /// Length in contact in cells.
    pub length: f64,
    /// ∫ u dx in m, where u is the compression of a spring and x is in cells.
    pub compression: f64,
    /// ∫ v dx in m, where v is that part of the compression of a spring that has not relaxed.
    pub fresh: f64,
    /// ∫ u² dx in m², where u is the compression of a spring and x is in cells.
    pub squares: f64,
    /// ∫ v² dx in m², where v is that part of the compression of a spring that has not relaxed.
    pub fresh_squares: f64,
    pub springs: u64,
    pub patches: u64,
}

impl Load {
    /// Returns the sums for a contact of the elastic loading, in which nothing has relaxed yet. See
    /// [`Load`] for the length, the compression and the squares.
    pub fn of_approach(
        totals: &ContactTotals,
        length: f64,
        compression: f64,
        squares: f64,
    ) -> Self {
        Load {
            length,
            compression,
            fresh: compression,
            squares,
            fresh_squares: squares,
            springs: counted(totals.springs),
            patches: counted(totals.patches),
        }
    }

    /// Returns the sums over the patches of a body that has turned. `field` has the numbers that
    /// are the same for all springs.
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

    /// Returns the force divided by the stiffness of one spring, in m. `remaining` is the share of
    /// the instantaneous modulus that remains after a long time.
    pub fn force(&self, remaining: f64) -> f64 {
        remaining * self.compression + (1.0 - remaining) * self.fresh
    }
}

/// Part of the motion: before first touch, at the largest indentation so far, or after the turn.
#[derive(Clone, Debug)]
pub enum Phase {
    /// The body has touched nothing yet.
    Apart,
    /// The body is at its largest indentation so far. The springs in contact are those of the
    /// elastic loading.
    Deepest,
    /// The body is above its largest indentation.
    Turned(Turned),
}

/// The patches of a body that has turned.
#[derive(Clone, Debug)]
pub struct Turned {
    pub line: Arc<Line>,
    pub patches: Vec<StretchedPatch>,
    /// True if springs have detached since the turn. A spring that has detached does not attach
    /// again.
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
    /// Common memory J in m, the same number for all springs; the module `relaxation` defines it.
    pub memory: f64,
    pub load: Load,
    pub phase: Phase,
    /// Magnitude of the jumps of the force on the step to this state, divided by the stiffness of
    /// one spring, in m. Jumps with opposite signs can leave the force unchanged, so that only this
    /// number shows them.
    pub jump: f64,
    /// Mean growth of the force on the step to this state; `None` after a jump. The force is
    /// divided by the stiffness of one spring, so that the unit is m/s.
    pub growth: Option<f64>,
    /// True if this is the state just before a jump, with the time of the jump. Such a state
    /// belongs to the record of the stage, but no step begins or ends there.
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

    /// Returns the state just before a jump, with the time of the jump. This state is the state
    /// before the step that has the jump, and `after` is the state after the jump.
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

    /// Returns the state at the beginning of a stage, where the motion of the drive changes.
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
