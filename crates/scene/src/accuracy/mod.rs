//! Errors of a scene, and the computing time that smaller errors need.
//!
//! * [`estimate()`](estimate::estimate) estimates the error of one outcome.
//! * [`choose()`](choice::choose) finds the number of springs for a tolerance.
//! * [`measure()`](ladder::measure) solves a scene from coarse to fine and compares errors with
//!   times. It uses the exact solver, with contact patches that end anywhere between springs and
//!   with patches of whole springs, and the stepwise solver.
//!
//! Errors are relative to a [`CostReference`](table::CostReference). If the scene has a closed
//! form, the reference is the pull-off force by this formula. Otherwise it is the finest solution
//! with edges between springs, whose own error is estimated.

pub(crate) mod choice;
pub(crate) mod estimate;
pub(crate) mod ladder;
pub(crate) mod solution;
pub(crate) mod table;
