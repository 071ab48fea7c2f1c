//! Error type of the functions at the root of this crate.

use crate::scene::errors::SceneErrors;
use crate::simulation::outcome::RunError;
use asperity_contact::ContactError;
use asperity_data::{Remedied, Remedy};
use thiserror::Error;

/// Error of the functions at the root of this crate, such as [`open()`](crate::open) and
/// [`run`](crate::run).
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
    /// Values of a scene are out of their ranges. Each error states the field, the value and the
    /// allowed range.
    #[error(transparent)]
    Values(#[from] SceneErrors),
    /// A value of a profile or a contact is out of its range, or the contact cannot reach the end
    /// of a loading stage.
    #[error(transparent)]
    Contact(#[from] ContactError),
    /// A computation failed for another reason: for example a file cannot be read, or there is not
    /// enough memory.
    #[error(transparent)]
    Run(RunError),
}

impl Remedied for Error {
    fn remedies(&self) -> Vec<Remedy> {
        match self {
            Error::Run(error) => error.remedies(),
            Error::Values(_) | Error::Contact(_) => Vec::new(),
        }
    }
}

impl From<RunError> for Error {
    fn from(error: RunError) -> Self {
        match error {
            RunError::Values(errors) => Error::Values(errors),
            RunError::Contact(error) => Error::Contact(error),
            error => Error::Run(error),
        }
    }
}
