//! Errors of a scene, and the cost of smaller ones.
//!
//! [`estimate()`](crate::estimate) is the error of one outcome, [`choose()`](crate::choose) the springs for a tolerance. [`measure()`](crate::measure) tries springs with
//! both kinds of edges and steps of the stepwise solver, from coarse to fine, and compares errors with times. Errors are
//! relative to a [`Reference`](crate::Reference): the adhesion force in closed form if the scene has one, otherwise the finest solution with
//! edges between springs, whose own error is estimated. Timed runs are separate from compared ones.

pub(crate) mod choice;
pub(crate) mod estimate;
pub(crate) mod ladder;
pub(crate) mod solution;
pub(crate) mod table;
