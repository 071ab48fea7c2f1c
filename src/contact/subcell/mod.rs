//! The exact solver of second order: the line runs straight from spring to spring, and the edges of a
//! fragment lie where it crosses the fragment's level.
//!
//! The tree and the two passes over it are those of the solver with whole springs; only the length in the
//! rule of Hess is another, and the force is an integral instead of a sum. Its error falls with the square
//! of the distance between springs.

mod body;
mod edges;
mod hand;
mod level_sets;
mod moment;
mod search;
mod sums;

pub use body::SubCell;
pub use edges::{Fragment, Slider, SubCellEdges};
pub use hand::SubCellHand;
pub use level_sets::LevelSets;
