//! The map of adhesion over roughness: which regime a scene would be in under other κ and H, everything else
//! as it says.
//!
//! [`Basis`] is what a map belongs to, [`PhaseMap`] its cells so far, and [`chart()`] computes those that are
//! missing, from coarse to fine. A map shows where the boundaries run; it is computed on fewer springs than
//! the scene may have and is the mean of a few random lines.

mod basis;
mod chart;
mod grid;
mod map;

pub use basis::{Basis, LINES, NoMap};
pub use chart::chart;
pub use grid::{HURSTS, KAPPAS, Level, hurst, kappa, next_beyond};
pub use map::{Cell, PhaseMap};
