//! Errors of a scene, and what smaller errors cost.
//!
//! [`estimate()`](crate::estimate) returns the error of one outcome, [`choose()`](crate::choose) the number of springs for
//! a tolerance. [`measure()`](crate::measure) solves a scene with both edge models and with steps of the stepwise solver,
//! from coarse to fine, and compares errors with times. Errors are relative to a [`CostReference`](crate::CostReference): the
//! adhesion force in closed form if the scene has one, otherwise the finest solution with edges between springs, whose own
//! error is estimated. Runs for times are separate from runs for errors.

pub(crate) mod choice;
pub(crate) mod estimate;
pub(crate) mod ladder;
pub(crate) mod solution;
pub(crate) mod table;
