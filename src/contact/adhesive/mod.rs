//! Adhesive contact: the exact loop over turning points.
//!
//! The gaps of a line give a [`ContactTree`] of their local maxima. A loading pass closes its nodes from below, an
//! unloading pass opens them from above; both list the *runs* of the leg, fragments whose edges move without a jump.
//! Curves, extremes and energies are sums over these runs. Only the edge model defines the length of a fragment.

mod curve;
mod edge_model;
mod energy;
mod levels;
mod loading;
mod run;
mod span;
mod tree;
mod unloading;

pub(in crate::contact) use curve::Runs;
pub(in crate::contact) use levels::{EdgeCells, EdgeSum, Levels, Slider};
pub(in crate::contact) use loading::Closing;
pub(in crate::contact) use run::{Ground, Held, Run};
pub(in crate::contact) use span::Span;
pub use tree::ContactTree;
pub(in crate::contact) use tree::largest;
