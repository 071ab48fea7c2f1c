//! Errors of the half-space: the refused value and the allowed range.

use asperity_data::OutOfMemory;
use thiserror::Error;

/// Reason why a contact is not computed.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum HalfSpaceError {
    /// The number of cells along a side is not allowed; the field has this number.
    #[error("{0} cells along a side; allowed: a power of two from 32 to 8192")]
    Cells(usize),
    /// The number of heights is not the number of cells of the square.
    #[error("{found} heights; allowed: {allowed}, one for each cell")]
    Heights {
        /// The given number of heights.
        found: usize,
        /// The number of heights that is allowed.
        allowed: usize,
    },
    /// A value of a body, a load or an option is out of its range.
    #[error("{name} = {found:e}; allowed: {allowed}")]
    Value {
        /// Name of the value.
        name: &'static str,
        /// The given value in SI units.
        found: f64,
        /// Allowed range of the value, with its unit.
        allowed: &'static str,
    },
    /// An array does not fit into memory.
    #[error(transparent)]
    OutOfMemory(#[from] OutOfMemory),
    /// The caller stopped the computation.
    #[error("the computation was stopped")]
    Stopped,
}
