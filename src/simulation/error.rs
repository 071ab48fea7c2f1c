//! Why a scene could not be computed.

use crate::contact::ContactError;
use crate::surface::SurfaceError;
use thiserror::Error;

/// Why a checked scene could not be computed.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum RunError {
    /// The line could not be made.
    #[error(transparent)]
    Surface(#[from] SurfaceError),
    /// The contact could not be computed.
    #[error(transparent)]
    Contact(#[from] ContactError),
}

impl RunError {
    /// Whether the computation was told to stop, rather than failed.
    #[must_use]
    pub fn is_interruption(&self) -> bool {
        *self == RunError::Contact(ContactError::Interrupted)
    }
}
