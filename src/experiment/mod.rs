//! The experiment beside the model: measured force curves, and the parameters of a scene that describe them.

mod baseline;
mod curve;
mod error;
mod fit;
mod model;
mod parameter;
mod read;
mod scene;
mod search;
mod statistics;

pub use curve::MeasuredCurve;
pub use error::ExperimentError;
pub use fit::{Fit, FitOptions, FittedParameter, fit};
pub use parameter::{Free, Parameter};
pub use read::{CurveOptions, Drift};
