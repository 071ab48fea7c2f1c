#![forbid(unsafe_code)]
#![warn(missing_docs)]
#![doc = include_str!("../README.md")]

mod baseline;
mod columns;
mod curve;
mod ensemble;
mod error;
mod fit;
mod fit_result;
mod foreign;
mod free;
mod metadata;
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
mod start;
mod statistics;
mod text;
mod zero;

#[cfg(test)]
mod coverage;
#[cfg(test)]
mod made;

pub use curve::MeasuredCurve;
pub use ensemble::find::fit_ensemble;
pub use ensemble::posterior::IntervalEstimate;
pub use ensemble::result::{
    CurveOfEnsemble, EnsembleFit, EnsembleOptions, Prospect, RoughnessShifts, Shares, SummaryDeviation,
};
pub use error::ExperimentError;
pub use fit::Fit;
pub use fit_result::{FitResult, FittedParameter};
pub use options::{CurveOptions, Drift, Negate, Tilt};
pub use parameter::{Free, Parameter, ParameterRow};
pub use reason::Reason;
