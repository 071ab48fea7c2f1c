//! Errors of a scene, and the cost of smaller ones.
//!
//! [`measure()`] tries every setting that affects accuracy, from coarse to fine, and compares errors with times.
//! Errors are relative to a [`Reference`]: the adhesion force in closed form if the scene has one, otherwise the
//! finest solution with edges between springs, whose own error follows from the last refinements. Timed runs are
//! separate from compared ones.

mod answer;
mod bench;
mod choose;
mod clock;
mod convergence;
mod distance;
mod estimate;
mod measure;
mod others;
mod solution;
mod table;

pub use bench::{CostError, Progress};
pub use choose::{Choice, ChoiceError, choose, parse_tolerance};
pub use convergence::{error_of_finest, first_within, observed_order};
pub use distance::ForceCurve;
pub use estimate::{Estimate, Evidence, estimate};
pub use measure::measure;
pub use solution::{Measures, Solution, Target, closed_form_adhesion};
pub use table::{CostTable, ErrorFigure, Knob, Reference, Row, Timing};
