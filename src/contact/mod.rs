//! The rigid line on the elastic foundation: when each spring joins and leaves, and the force.
//!
//! Everything here follows the rules of equilibrium of the method of dimensionality reduction with the
//! rule of Hess:
//!
//! * *touch*: a free spring whose gap is closed, c ≤ d, comes into contact;
//! * *grow*: a free spring beside a fragment of n springs comes into contact when
//!   d ≥ c − Δl_max(n), eq. (10);
//! * *detach*: within a fragment of n springs the most stretched one leaves when d ≤ c − Δl_max(n), but
//!   not while its gap is closed.
//!
//! [`exact`] solves them for any loading history in one pass over a tree for each leg; [`stepwise`]
//! moves by small steps and relaxes, as the paper does; [`Incremental`] holds the body in hand and does, for
//! each small move either way, only the work that changes.

pub mod adhesive;
mod edges;
mod error;
pub mod exact;
mod foundation;
mod fragment_set;
mod fragments;
mod grid;
mod hand;
mod history;
mod incremental;
mod law;
mod leg_contact;
mod nonadhesive;
mod solver;
pub mod stepwise;
pub mod subcell;
mod tally;
mod targets;
mod tournament;
mod tree;

pub use adhesive::{Adhesive, AdhesiveMemory, ContactTree, EdgeModel, GridEdges, SubCellEdges};
pub use edges::{EdgeRule, GridRule, NoAdhesion};
pub use error::ContactError;
pub use exact::Exact;
pub use foundation::{Foundation, HessRule};
pub use hand::{Hand, HandError, HandHeld, Move};
pub use history::{CurvePoint, Direction, History, LegRecord, Work};
pub use incremental::Incremental;
pub use leg_contact::LegContact;
pub use nonadhesive::Nonadhesive;
pub use solver::{Solver, run};
pub use stepwise::Stepwise;
pub use tally::{GapScale, Tally};
pub use tree::SpringTree;

/// An empty vector with room for `count` values, or an error instead of an abort.
pub(crate) fn reserve<T>(count: usize) -> Result<Vec<T>, ContactError> {
    crate::memory::emptied(Vec::new(), count).map_err(|_| ContactError::OutOfMemory { springs: count })
}

/// `count` values in this memory; see [`crate::memory::resized`].
fn resized<T: Clone>(values: Vec<T>, count: usize, fill: T) -> Result<Vec<T>, ContactError> {
    crate::memory::resized(values, count, fill).map_err(|_| ContactError::OutOfMemory { springs: count })
}
