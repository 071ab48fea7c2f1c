//! The map of adhesion over roughness: which regime a scene would be in under other κ and H, everything else
//! as it says.
//!
//! [`Basis`] is what a map belongs to, [`PhaseMap`] its cells so far, and [`chart()`] computes those that are
//! missing, from coarse to fine. A map shows where the boundaries run; it is computed on fewer springs than
//! the scene may have and is the mean of a few random lines.
//!
//! [`Atlas`] holds the maps of a finished study instead. Either kind is shown as a [`Plane`].

mod atlas;
mod basis;
mod chart;
mod grid;
mod map;
mod plane;

pub use atlas::{Atlas, AtlasError};
pub use basis::{Basis, LINES, NoMap};
pub use chart::chart;
pub use grid::{HURSTS, KAPPAS, Level, hurst, hursts, kappa, kappas, next_beyond};
pub use map::{Cell, PhaseMap};
pub use plane::{Charted, Layer, Place, Plane, Spot};
