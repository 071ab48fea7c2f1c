//! The experiment beside the model: measured force curves, and the parameters of a scene that describe them.

mod baseline;
mod columns;
#[cfg(test)]
mod coverage;
mod curve;
mod fit;
mod free;
#[cfg(test)]
mod made;
mod model;
mod options;
mod parameter;
mod points;
mod population;
mod read;
mod reason;
mod scene;
mod search;
mod segment;
mod space;
mod statistics;
mod zero;

pub use curve::MeasuredCurve;
pub use fit::{Fit, FitOptions, FittedParameter, fit};
pub use options::{CurveOptions, Drift, Negate, Tilt};
pub use parameter::{Free, Parameter, Row};
pub use reason::Reason;

use crate::contact::ContactError;
use crate::simulation::RunError;
use crate::topography::TopographyError;
use thiserror::Error;

/// Reason why a curve is not read or not fitted. The caller puts the name of the file or scene in front.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ExperimentError {
    /// A file that cannot be read as a curve.
    #[error(transparent)]
    File(#[from] TopographyError),
    /// A curve or a scene that cannot be fitted.
    #[error("{found}; allowed: {allowed}")]
    Refused {
        /// What is wrong.
        found: String,
        /// What is allowed.
        allowed: String,
    },
    /// A failure of the computation, or a stop.
    #[error(transparent)]
    Run(#[from] RunError),
}

impl From<ContactError> for ExperimentError {
    fn from(error: ContactError) -> Self {
        ExperimentError::Run(error.into())
    }
}

/// Error of a curve or a scene that cannot be fitted.
fn refused<T>(found: impl Into<String>, allowed: impl Into<String>) -> Result<T, ExperimentError> {
    Err(ExperimentError::Refused { found: found.into(), allowed: allowed.into() })
}
