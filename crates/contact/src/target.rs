//! Targets of a motion.

#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// Target of a body: one loading stage.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub enum Move {
    /// Until the force first reaches this value, N (compression positive).
    ToForce(f64),
    /// To this indentation, m (0 at first touch).
    ToIndentation(f64),
    /// Until the displacement of the instrument D = d + F/k first reaches this value, m, where k is the loading stiffness
    /// of the contact. For a rigid instrument D is the indentation.
    ToDisplacement(f64),
    /// To the indentation of first touch, d = 0.
    ToTouch,
    /// Until the force is zero; from separation, past first touch until the force is back at zero.
    ToZeroForce,
    /// To separation.
    ToSeparation,
}
