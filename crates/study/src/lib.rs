#![forbid(unsafe_code)]
#![warn(missing_docs)]
#![doc = include_str!("../README.md")]

mod axis;
mod boundary;
mod case_outcome;
mod cells;
mod check;
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
mod preload_curve;
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

pub use axis::{Axis, DERIVED, Spacing};
pub use boundary::{Boundaries, Boundary, Crossing, USUAL_LEVELS, boundaries, protocol_name};
pub use check::case::Case;
pub use check::{Check, Verdict, catalogue, checks, judge};
pub use error::StudyError;
pub use grid::{Cell, Grid, Layer, Place};
pub use live_map::{Level, LiveMap};
pub use live_plan::{MAP_LINES, live_plan};
pub use measured_adhesion::{MeasuredAdhesion, ProfileAdhesion};
pub use place::moved;
pub use plan::{MOST_CELLS, Plan, StiffnessRange};
pub use plan_text::{Changes, PLANS, PlanErrors};
pub use preload_curve::PreloadCurve;
pub use preloads::{PRELOADS, Staircase};
pub use quantity::Quantity;
pub use results::{Merged, Results};
pub use run::{Options, Progress, run};
pub use select::{Selected, Selection};
pub use sensitivity::{Influence, OTHER_SEEDS, STEP, Sensitivity, Values};
pub use shard::Shard;
pub use statistics::{Column, RegimeCounts, Spread, Statistics};
pub use status::{Attempt, ShardStatus, Status};
pub use store::{Folder, Header, ShardFile};
pub use study_map::StudyMap;
pub use tables::{RESULTS, SIDECAR, SUMMARY, merge};
