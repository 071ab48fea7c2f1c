//! The map of adhesion over roughness: which regime a scene would be in under other κ and H, everything else
//! as it says.
//!
//! [`Template`] is what a map belongs to, [`LiveMap`] its cells so far, and [`compute()`] computes those that are
//! missing, from coarse to fine. A map shows where the boundaries run; it is computed on fewer springs than
//! the scene may have and is the mean of a few random lines.
//!
//! [`StudyMap`] holds the maps of a finished study instead. Either kind is shown as a [`MapModel`].

mod compute;
mod grid;
mod live_map;
mod model;
mod study_map;
mod template;

pub use compute::compute;
pub use grid::{HURSTS, KAPPAS, Level, hurst, hursts, kappa, kappas, next_beyond};
pub use live_map::LiveMap;
pub use model::{Charted, Layer, MapCell, MapModel, Place};
pub use study_map::{StudyMap, StudyMapError};
pub(super) use template::governing;
pub use template::{LINES, NoMap, RECORD, Template};
