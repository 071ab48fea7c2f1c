//! The error type of the functions at the root of this crate.

use crate::scene::errors::SceneErrors;
use crate::simulation::outcome::RunError;
use asperity_contact::ContactError;
use thiserror::Error;

/// Error of the functions at the root of this crate.
///
/// ```
/// use asperity_contact::Modulus;
/// use asperity_scene::Error;
///
/// let refused = Error::from(Modulus::effective(-1.0).unwrap_err());
/// assert_eq!(refused.to_string(), "effective modulus = -1; allowed: from 1e-50 to 1e50 Pa");
/// ```
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum Error {
    /// Values of a scene are out of their ranges; each error has field, value and allowed range.
    #[error(transparent)]
    Values(#[from] SceneErrors),
    /// A value of a profile or a contact is out of its range, or a stage of its loading is out of reach.
    #[error(transparent)]
    Contact(#[from] ContactError),
    /// Another reason why a computation failed: a file that cannot be read, or not enough memory.
    #[error(transparent)]
    Run(RunError),
}

/// Values and errors of the contact are variants of their own.
impl From<RunError> for Error {
    fn from(error: RunError) -> Self {
        match error {
            RunError::Values(errors) => Error::Values(errors),
            RunError::Contact(error) => Error::Contact(error),
            error => Error::Run(error),
        }
    }
}
