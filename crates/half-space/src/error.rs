//! Errors of the half-space: the refused value and the allowed range.

use asperity_data::OutOfMemory;
use thiserror::Error;

/// Reason why the solver does not compute a contact.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum HalfSpaceError {
    /// The number of cells along a side is not a power of two from 32 to 8192. The field is this
    /// number.
    #[error("{0} cells along a side; allowed: a power of two from 32 to 8192")]
    Cells(usize),
    /// The number of heights of the square differs from the number of cells of the solver.
    #[error("{found} heights; allowed: {allowed}, one for each cell")]
    Heights {
        /// The number of heights that was given.
        found: usize,
        /// The number of heights that is allowed.
        allowed: usize,
    },
    /// A value of the square, its load, its adhesion or the tolerance is out of its range.
    #[error("{name} = {found:e}; allowed: {allowed}")]
    Value {
        /// Name of the refused value, such as `tolerance`.
        name: &'static str,
        /// The refused value in SI units.
        found: f64,
        /// Allowed range of the value, with its unit.
        allowed: &'static str,
    },
    /// An array of the solver does not fit into memory.
    #[error(transparent)]
    OutOfMemory(#[from] OutOfMemory),
    /// The computation ended because the function `stop` of the caller returned true.
    #[error("the computation was stopped")]
    Stopped,
}
