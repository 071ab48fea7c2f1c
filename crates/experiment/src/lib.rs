#![forbid(unsafe_code)]
#![warn(missing_docs)]
#![doc = include_str!("../README.md")]
//!
//! # Names by task
//!
//! * Reading a curve: [`MeasuredCurve::read`] reads a file. [`CurveOptions`] state how to treat
//!   drift ([`Drift`]), tilt ([`Tilt`]) and signs ([`Negate`]).
//! * Reading several curves: [`CurveSource::all`] finds the curves in folders and in files with
//!   several curves ([`SeveralCurves`]). [`CurveSource::read`] reads each of them with its place
//!   ([`PlacedCurve`]).
//! * Fitting one curve: [`Fit`] searches the [`Free`] parameters of a scene. A [`FitResult`] has a
//!   [`FittedParameter`] for each free parameter, a [`RelaxedModulus`] if the half-space relaxes,
//!   and a [`Reason`] if the model does not describe the curve. [`ParameterRow`] has name and unit
//!   of a [`Parameter`].
//! * Fitting a few curves of one specimen together, such as curves at several speeds:
//!   [`Fit::run_together`].
//! * Fitting the curves of one rough specimen: [`fit_ensemble`] fits several curves together, with
//!   [`EnsembleOptions`]. The result is an [`EnsembleFit`], which has [`IntervalEstimate`]s,
//!   [`Shares`], [`Prospect`]s, [`RoughnessShifts`], [`SummaryDeviation`]s and a
//!   [`CurveOfEnsemble`] for each curve.
//! * Errors: an [`ExperimentError`] says why a curve cannot be read or fitted.

mod curve;
mod error;
mod fit;
mod read;

// Fixtures that the unit tests of this crate share with its integration tests.
#[cfg(test)]
extern crate self as asperity_experiment;
#[cfg(test)]
#[path = "../tests/common/mod.rs"]
mod common;

pub use curve::MeasuredCurve;
pub use curve::drag::DragForce;
pub use curve::features::CurveFeatures;
pub use curve::sources::{CurveSource, PlacedCurve};
pub use error::{CountedPart, ExperimentError};
pub use fit::Fit;
pub use fit::agreement::{Agreement, Grade};
pub use fit::ensemble::deviation::{RoughnessShifts, SummaryDeviation};
pub use fit::ensemble::estimate::IntervalEstimate;
pub use fit::ensemble::predictions::CurveOfEnsemble;
pub use fit::ensemble::{EnsembleFit, EnsembleOptions, Prospect, Shares, fit_ensemble};
pub use fit::parameter::{Free, Parameter, ParameterRow};
pub use fit::reason::Reason;
pub use fit::result::{FitResult, FittedParameter, RangeEnd, RelaxedModulus};
pub use read::options::{CurveOptions, Drift, Negate, Tilt};
pub use read::several::SeveralCurves;
