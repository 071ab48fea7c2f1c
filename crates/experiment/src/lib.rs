#![forbid(unsafe_code)]
#![warn(missing_docs)]
#![doc = include_str!("../README.md")]
//!
//! # Names by task
//!
//! * Reading: [`MeasuredCurve`] with [`CurveOptions`]: [`Drift`], [`Tilt`], [`Negate`].
//! * Fitting one curve: [`Fit`] of [`Free`] [`Parameter`]s, each described by a [`ParameterRow`], returns a [`FitResult`] with
//!   its [`FittedParameter`]s, or the [`Reason`] why the model does not describe the curve.
//! * Fitting the curves of one specimen: [`fit_ensemble`] of [`CurveOfEnsemble`]s with [`EnsembleOptions`] returns an
//!   [`EnsembleFit`] with [`IntervalEstimate`], [`Prospect`], [`RoughnessShifts`], [`Shares`] and [`SummaryDeviation`].
//! * What is refused: [`ExperimentError`].

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
