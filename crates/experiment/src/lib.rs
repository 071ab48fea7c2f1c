#![forbid(unsafe_code)]
#![warn(missing_docs)]
#![doc = include_str!("../README.md")]
//!
//! # Names by task
//!
//! * Reading a curve: [`MeasuredCurve::read`] takes a file and [`CurveOptions`], with a treatment
//!   of drift ([`Drift`]), tilt ([`Tilt`]) and signs ([`Negate`]).
//! * Fitting one curve: [`Fit`] searches the [`Free`] parameters of a scene. Its [`FitResult`] has
//!   a [`FittedParameter`] for each, and a [`Reason`] if the model does not describe the curve.
//!   [`ParameterRow`] has name and unit of a [`Parameter`].
//! * Fitting the curves of one rough specimen: [`fit_ensemble`] takes curves and
//!   [`EnsembleOptions`]. Its [`EnsembleFit`] has [`IntervalEstimate`]s, [`Shares`], [`Prospect`]s,
//!   [`RoughnessShifts`], [`SummaryDeviation`]s and a [`CurveOfEnsemble`] for each curve.
//! * Errors: an [`ExperimentError`] says why a curve cannot be read or fitted.

mod curve;
mod ensemble;
mod error;
mod fit;
mod fit_result;
mod model;
mod parameter;
mod population;
mod read;
mod reason;
mod scene;
mod search;
mod space;
mod start;
mod statistics;

#[cfg(test)]
mod coverage;
#[cfg(test)]
mod made;

pub use curve::MeasuredCurve;
pub use ensemble::find::fit_ensemble;
pub use ensemble::posterior::IntervalEstimate;
pub use ensemble::result::{
    CurveOfEnsemble, EnsembleFit, EnsembleOptions, Prospect, RoughnessShifts, Shares,
    SummaryDeviation,
};
pub use error::ExperimentError;
pub use fit::Fit;
pub use fit_result::{FitResult, FittedParameter};
pub use parameter::{Free, Parameter, ParameterRow};
pub use read::options::{CurveOptions, Drift, Negate, Tilt};
pub use reason::Reason;
