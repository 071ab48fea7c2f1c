//! The reasons why a curve cannot be read or fitted.

use asperity_contact::ContactError;
use asperity_scene::RunError;
use asperity_surface::SurfaceError;
use thiserror::Error;

/// Reason why a measured force curve cannot be read, or why a scene cannot be fitted to it.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ExperimentError {
    /// The file of the curve cannot be read, or its content is no table with columns of
    /// displacement and force.
    #[error(transparent)]
    File(#[from] SurfaceError),
    /// The curve cannot be read or fitted because of a property of the curve, of the scene or of an
    /// option.
    #[error("{found}; allowed: {allowed}")]
    Refused {
        /// What was found in the curve, the scene or the options, in words.
        found: String,
        /// What is allowed instead, in words, with the option of the command line that helps.
        allowed: String,
    },
    /// The computation of force curves for a fit failed, or the [`Control`](asperity_data::Control)
    /// of the fit stopped it.
    #[error(transparent)]
    Run(#[from] RunError),
}

impl From<ContactError> for ExperimentError {
    fn from(error: ContactError) -> Self {
        ExperimentError::Run(error.into())
    }
}

/// Error of a curve or a scene that cannot be fitted.
pub(crate) fn refused<T>(
    found: impl Into<String>,
    allowed: impl Into<String>,
) -> Result<T, ExperimentError> {
    Err(ExperimentError::Refused {
        found: found.into(),
        allowed: allowed.into(),
    })
}
