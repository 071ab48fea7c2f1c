//! Maps of adhesion: the regime of a scene, and forces, under other values of two of its quantities.
//!
//! The live map is a study over H and κ or e_el/γ in memory. [`live_plan()`] is its plan, [`LiveMap`] holds
//! the cells so far, and [`LiveMap::compute`] computes the missing ones, from coarse to fine. The live map shows the
//! course of the boundaries; it is computed on fewer springs than the scene may have and is the mean over a few random
//! profiles.
//!
//! [`StudyMap`] holds the maps of a finished study, over any of its axes. Both kinds are shown as a [`Grid`].
//!
//! [`Grid`]: super::Grid

mod levels;
mod live_map;
mod live_plan;
mod place;
mod study_map;

pub use levels::{COLUMNS, HURSTS, Level, hurst, parameter_value};
pub use live_map::LiveMap;
pub use live_plan::{LINES, NoMap, RECORD, live_plan};
pub use place::moved;
pub use study_map::StudyMap;
