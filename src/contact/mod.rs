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
//! [`exact`] applies these rules to any loading history in one pass over a tree for each leg; [`stepwise`] moves by
//! small steps and relaxes, as the paper does; [`Manual`] loading moves the body by steps of any size, either way, at a
//! cost in proportion to the change.

pub mod adhesive;
mod contact_model;
mod contact_state;
mod crossing;
mod error;
pub mod exact;
mod foundation;
mod fragments;
mod grid;
mod history;
mod interval;
mod leg_contact;
mod leg_plan;
mod manual;
mod nonadhesive;
mod reversal;
mod snapshot;
mod solver;
mod steady;
pub mod stepwise;
mod totals;

pub use adhesive::{AdhesiveMemory, ContactTree, EdgeModel, GridEdges, SubCellEdges};
pub use error::ContactError;
pub use exact::{ContactRule, Exact};
pub use foundation::{Foundation, HessRule};
pub use history::{CurvePoint, Direction, History, LegRecord, Work};
pub use leg_contact::{LegContact, LegView};
pub use leg_plan::Target;
pub use manual::{Manual, ManualError, ManualLoading, Move};
pub use nonadhesive::Nonadhesive;
pub use reversal::{Reversal, Reversals};
pub use snapshot::{FragmentState, Snapshot};
pub use solver::{Solver, run};
pub use stepwise::Stepwise;
pub use totals::{ContactTotals, GapScale};

/// An empty vector with room for `count` values, or an error instead of an abort.
pub(crate) fn reserve<T>(count: usize) -> Result<Vec<T>, ContactError> {
    crate::memory::emptied(Vec::new(), count).map_err(|_| ContactError::OutOfMemory { springs: count })
}

/// Adds a value to an array over this number of springs, or returns an error instead of an abort.
fn push<T>(values: &mut Vec<T>, value: T, springs: usize) -> Result<(), ContactError> {
    values.try_reserve(1).map_err(|_| ContactError::OutOfMemory { springs })?;
    values.push(value);
    Ok(())
}

/// `count` values in this memory; see [`crate::memory::resized`].
fn resized<T: Clone>(values: Vec<T>, count: usize, fill: T) -> Result<Vec<T>, ContactError> {
    crate::memory::resized(values, count, fill).map_err(|_| ContactError::OutOfMemory { springs: count })
}
