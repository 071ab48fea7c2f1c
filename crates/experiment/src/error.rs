//! The reasons why a curve cannot be read or fitted.

use asperity_contact::ContactError;
use asperity_scene::RunError;
use asperity_surface::SurfaceError;
use thiserror::Error;

/// Reason why a curve cannot be read or fitted. The caller puts the name of the file or scene before the message.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ExperimentError {
    /// The file cannot be read as a curve.
    #[error(transparent)]
    File(#[from] SurfaceError),
    /// The curve or the scene cannot be fitted.
    #[error("{found}; allowed: {allowed}")]
    Refused {
        /// The curve, option or scene that was found, in words.
        found: String,
        /// What is allowed instead, with the option that helps.
        allowed: String,
    },
    /// A computation failed or was stopped.
    #[error(transparent)]
    Run(#[from] RunError),
}

impl From<ContactError> for ExperimentError {
    fn from(error: ContactError) -> Self {
        ExperimentError::Run(error.into())
    }
}

/// Error of a curve or a scene that cannot be fitted.
pub(crate) fn refused<T>(found: impl Into<String>, allowed: impl Into<String>) -> Result<T, ExperimentError> {
    Err(ExperimentError::Refused { found: found.into(), allowed: allowed.into() })
}
