//! The exact solver of second order: the line runs straight from spring to spring, and the edges of a
//! fragment lie where it crosses the fragment's level.
//!
//! The tree and the two passes over it are those of whole springs; only the length in the rule of Hess is
//! another, and the force is an integral instead of a sum: over the whole cells between springs in contact, and
//! what the two cells at the edges of each fragment add. Its error falls with the square of the distance between springs.
//!
//! A fragment is one from its own threshold to that of its parent, and holds all between its edges. So the passes
//! list the fragments as they find them, and whatever is asked of a leg is a sum over this list: under strong adhesion
//! it is short, and at the most it is as long as the line.

mod adhesive;
mod between;
mod edges;
mod hand;
mod level_sets;
mod moment;
mod search;

pub use edges::{Edges, Slider, SubCellEdges};
pub use hand::SubCellHand;
pub use level_sets::{LevelMemory, LevelSets};
pub use moment::SubCellMoment;
pub(in crate::contact) use search::bisect;

use super::exact::Exact;
use super::springs::AdhesiveSprings;
use super::{BodyMemory, ContactError, Foundation, HessRule};
use between::BetweenSprings;
use std::sync::Arc;

/// A body under adhesion; build one with [`adhesive_in()`].
pub type Adhesive<'a> = Exact<BetweenSprings<AdhesiveSprings<'a, SubCellEdges>>>;

/// A body over the line of `sets`, separated, at d = 0 just before first touch, in the memory that
/// [`Exact::into_memory`] gave back.
///
/// `hess` is the rule of Hess; with `None` nothing is stretched, and [`exact::nonadhesive`](super::exact::nonadhesive) gives the same without a
/// tree.
/// `samples` (at least 2) curve points are taken on each leg.
///
/// # Errors
/// [`ContactError::OutOfMemory`].
pub fn adhesive_in(
    memory: BodyMemory,
    sets: &Arc<LevelSets>,
    hess: Option<HessRule>,
    foundation: Foundation,
    samples: usize,
) -> Result<Adhesive<'_>, ContactError> {
    let edges = SubCellEdges::new(Arc::clone(sets), hess);
    Exact::over_tree(AdhesiveSprings::new(sets.tree(), edges, memory)?, foundation, samples)
}
