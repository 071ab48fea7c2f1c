//! Maps of adhesion: the regime of a scene, and forces, under other values of two of its quantities.
//!
//! The live map is over H and κ or e_el/γ. [`Template`] is the scene but for these, [`LiveMap`] holds the cells so
//! far, and [`compute()`] computes the missing ones, from coarse to fine. The live map shows the course of the
//! boundaries; it is computed on fewer springs than the scene may have and is the mean over a few random profiles.
//!
//! [`StudyMap`] holds the maps of a finished study, over any of its axes. Both kinds are shown as a [`MapModel`].

mod axis;
mod compute;
mod grid;
mod live_map;
mod model;
mod study_map;
mod template;

pub use axis::{MapAxis, moved};
pub use compute::compute;
pub use grid::{COLUMNS, HURSTS, Level, hurst, hursts, next_beyond, parameter_value, parameter_values};
pub use live_map::LiveMap;
pub use model::{Charted, Layer, MapCell, MapModel, Place, ShownCell};
pub use study_map::{StudyMap, StudyMapError};
pub use template::{LINES, NoMap, RECORD, Template};
