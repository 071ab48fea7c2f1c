//! The rigid line on the elastic foundation: attachment and detachment of each spring, and the force.
//!
//! Everything here follows the rules of equilibrium of the method of dimensionality reduction with the
//! rule of Hess:
//!
//! * *touch*: a free spring whose gap is closed, c ≤ d, comes into contact;
//! * *grow*: a free spring beside a fragment of n springs comes into contact when
//!   d ≥ c − Δl_max(n), eq. (10);
//! * *detach*: within a fragment of n springs the most stretched one detaches when d ≤ c − Δl_max(n), but
//!   not while its gap is closed.
//!
//! A [`Contact`] is what stays the same while the body moves, a [`Leg`] the contact at all indentations of a motion in
//! one direction, and a [`Body`] a leg and the position on it. [`Leg`] applies these rules in one pass over a tree;
//! [`Stepwise`] moves by small steps and relaxes, as the paper does.

mod adhesive;
mod body;
mod contact_state;
mod error;
mod foundation;
mod goal;
mod grid;
mod history;
mod interval;
mod leg;
mod reversal;
mod springs;
pub mod stepwise;
mod thresholds;
mod totals;

pub use adhesive::ContactTree;
pub use body::{Body, Motion, Solver, run};

pub use error::ContactError;
pub use foundation::{Edges, Foundation, HessRule};
pub use goal::Move;
pub(crate) use grid::CompensatedSum;
pub use history::{CurvePoint, Direction, History, LegRecord, Patch, Work};
pub use leg::{Leg, PatchState};

pub use reversal::Reversal;
pub use springs::{Contact, Springs};
pub use stepwise::Stepwise;
pub use totals::{ContactTotals, GapScale};

/// Number of springs from which a second thread costs less than it saves.
const TWO_THREADS: usize = 1 << 17;
