//! Errors of a scene, and the cost of smaller errors.
//!
//! [`estimate()`](crate::estimate) estimates the error of one outcome. [`choose()`](crate::choose) finds the number of
//! springs for a tolerance. [`measure()`](crate::measure) solves a scene from coarse to fine, with both edge models and with
//! the stepwise solver, and compares errors with times.
//!
//! Errors are relative to a [`CostReference`](crate::CostReference). It is the adhesion force in closed form if the scene has
//! one, otherwise the finest solution with edges between springs, whose own error is estimated.

pub(crate) mod choice;
pub(crate) mod estimate;
pub(crate) mod ladder;
pub(crate) mod solution;
pub(crate) mod table;
