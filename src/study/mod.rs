//! Parameter studies: many cells on many random profiles, computed once, stored safely and tabulated.
//!
//! A [`Plan`] names a scene, the [`Axis`]es along which its numbers vary, a number of random profiles, and the
//! recorded quantities. [`run()`] computes the missing records in a [`Folder`], by any number of threads and
//! processes; [`merge()`] writes the tables, and [`Results`] reads them.
//!
//! Profiles have the same seeds in all cells, so a curve over an axis is as smooth as that of a single profile.
//! Shared data of cells are computed once: a profile and its tree serve every κ, γ and load.
//!
//! ```
//! use asperity::study::{Changes, Folder, Options, Plan, Quantity, Results, Shard, merge, run};
//!
//! let text = r#"(
//!     version: 1,
//!     base: "rough-sphere",
//!     set: {"numerics.points": "256", "roughness.modes": "(1, 64)"},
//!     axes: [Linear(path: "adhesion.kappa", from: 1.0, to: 3.0, count: 3)],
//!     preloads: [0.01, 0.1],
//!     lines: 2,
//!     record: [adhesion_force, regime],
//! )"#;
//! let plan = Plan::parse(text, "example", &Changes::default())?;
//! assert_eq!(plan.cells(), 6);
//! let place = tempfile::tempdir()?;
//! let folder = Folder::create(place.path(), &plan)?;
//! run(&folder, Options { jobs: 2, shard: Shard::WHOLE }, &|| false, &mut |_| ())?;
//! merge(&folder, false)?;
//! let results = Results::open(place.path())?;
//! assert!(results.statistics(5, Quantity::AdhesionForce).is_some_and(|force| force.mean > 0.0));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod axis;
mod boundary;
mod case_outcome;
mod cells;
mod error;
mod grid;
mod live_map;
mod live_plan;
mod measured;
mod measured_adhesion;
mod memory;
mod place;
mod plan;
mod plan_text;
mod preloads;
mod quantity;
mod recorder;
mod results;
mod run;
mod select;
mod sensitivity;
mod shard;
mod statistics;
mod status;
mod store;
mod study_map;
mod tables;

pub use axis::{Axis, DERIVED, MOST_VALUES, Spacing};
pub use boundary::{Boundaries, Boundary, Crossing, USUAL_LEVELS, boundaries, protocol_name};
pub use error::StudyError;
pub use grid::{Cell, Grid, Layer, Place};
pub use live_map::{Level, LiveMap};
pub use live_plan::{MAP_LINES, MAP_RECORD, live_plan};
pub use measured_adhesion::{MeasuredAdhesion, ProfileAdhesion};
pub use place::moved;
pub use plan::{MOST_CELLS, MOST_LINES, MOST_RECORDS, Plan, StiffnessRange};
pub use plan_text::{Changes, PLAN_VERSION, PLANS, PlanErrors};
pub use preloads::{PRELOADS, Staircase};
pub use quantity::Quantity;
pub use results::{Merged, Results};
pub use run::{Options, Progress, run};
pub use select::{Selected, Selection};
pub use sensitivity::{Influence, OTHER_SEEDS, STEP, Sensitivity, Values};
pub use shard::Shard;
pub use statistics::{Column, RegimeCounts, Spread, Statistics};
pub use status::{Attempt, ShardStatus, Status};
pub use store::{Folder, Header, STORE_VERSION, ShardFile};
pub use study_map::StudyMap;
pub use tables::{RESULTS, RESULTS_VERSION, SIDECAR, SUMMARY, merge};
