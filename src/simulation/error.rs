//! Reasons why a scene could not be computed.

use super::reach::{out_of_reach, rounded_up};
use crate::contact::ContactError;
use crate::scene::{Move, format_quantity};
use crate::surface::SurfaceError;
use thiserror::Error;

/// Reason why a checked scene could not be computed.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum RunError {
    /// The scene does not fit into memory.
    #[error(
        "not enough memory: this scene takes about {} MiB; fewer numerics.points and numerics.samples take less",
        bytes.div_ceil(1 << 20)
    )]
    OutOfMemory {
        /// Required bytes.
        bytes: u64,
    },
    /// The profile could not be made.
    #[error(transparent)]
    Surface(#[from] SurfaceError),
    /// Reversals with the stepwise solver.
    #[error("numerics.solver = Stepwise: reversals need the exact solver; allowed: numerics.solver = Exact")]
    NeedsExactSolver,
    /// Turning points of a loading that does not press.
    #[error(
        "loading: no indentation above 0 m at the preload; allowed: a stage that presses the bodies together"
    )]
    NeverPressed,
    /// A preload that no loading reaches, since the first touch already pulls less.
    #[error(
        "preload {}: allowed: at least the force at first touch, {}",
        format_quantity(*preload, "N"),
        format_quantity(rounded_up(*touch), "N")
    )]
    BelowTouch {
        /// The preload, N.
        preload: f64,
        /// Force at first touch, N.
        touch: f64,
    },
    /// The contact could not be computed.
    #[error("{}", out_of_reach(.0, Move::ToTouch))]
    Contact(#[from] ContactError),
}

impl RunError {
    /// Returns true if the computation was stopped rather than failed.
    pub fn is_interruption(&self) -> bool {
        *self == RunError::Contact(ContactError::Interrupted)
    }
}
