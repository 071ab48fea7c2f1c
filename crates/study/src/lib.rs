#![forbid(unsafe_code)]
#![warn(missing_docs)]
#![doc = include_str!("../README.md")]

mod axis;
mod boundary;
mod budget;
mod case_outcome;
mod cells;
mod check;
mod compute;
mod criteria;
mod criterion;
mod ensemble;
mod error;
mod find;
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
mod profiles;
mod quantity;
mod question;
mod recorder;
mod reference;
mod resolved;
mod results;
mod rough_contact;
mod run;
mod select;
mod sensitivity;
mod shard;
mod spatial;
mod square_loops;
mod statistics;
mod status;
mod store;
mod study_map;
mod tables;

pub use axis::{Axis, Spacing};
pub use compute::compute;
pub use ensemble::{Ensemble, ensemble};
pub use error::StudyError;
pub use find::{Found, find};
pub use plan::Plan;
pub use plan_text::Changes;
pub use preload_curve::PreloadCurve;
pub use preloads::Staircase;
pub use profiles::Stop;
pub use quantity::Quantity;
pub use question::{Answer, Question};
pub use results::Results;
pub use run::{StudyProgress, run_study};
pub use sensitivity::{Changed, Influence, Sensitivity};
pub use shard::Shard;
pub use statistics::{RegimeCounts, Spread, Statistics};
pub use store::Folder;
pub use tables::merge;

/// Built-in plans, and readers of the numbers of a plan from text, which the command line uses.
pub mod plans {
    pub use crate::axis::DERIVED;
    pub use crate::plan::{MOST_CELLS, StiffnessRange};
    pub use crate::plan_text::PLANS;
    pub use crate::preloads::{PRELOADS, parse_preloads, parse_range};
    pub use crate::question::parse_condition;
}

/// Files in the folder of a study, for programs that show the progress of shards or read results.
pub mod folders {
    pub use crate::results::Merged;
    pub use crate::status::{Attempt, ShardStatus, Status};
    pub use crate::store::{ShardFile, ShardHeader};
    pub use crate::tables::{RESULTS, SIDECAR, SUMMARY};
}

/// Maps of results over two axes, from a stored study or computed for display, and boundaries of adhesion.
pub mod maps {
    pub use crate::boundary::{
        AdhesionBoundary, Boundaries, Crossing, USUAL_LEVELS, boundaries, protocol_name,
    };
    pub use crate::grid::{Grid, GridCell, GridLayer, GridPlace};
    pub use crate::live_map::{Level, LiveMap};
    pub use crate::live_plan::{MAP_LINES, live_plan};
    pub use crate::place::moved;
    pub use crate::select::{Selected, Selection};
    pub use crate::study_map::StudyMap;
}

/// Cases with known results, which `asperity check` computes.
pub mod checks {
    pub use crate::check::case::Case;
    pub use crate::check::{Check, Verdict, catalogue, checks, judge_case};
}

/// Comparisons of a scene with its contact in three dimensions, which show the error of the model.
pub mod half_space {
    pub use crate::reference::{
        Compared, Loaded, Reference, ReferenceBudget, ReferenceEvent, ReferenceOptions,
    };
    pub use crate::square_loops::SquareLoops;
}

/// Errors of a result by their sources, and criteria of other theories, which show how far to trust the result.
pub mod trust {
    pub use crate::budget::Budget;
    pub use crate::criteria::criteria;
    pub use crate::criterion::{Criterion, LEAST_TABOR_NUMBER_OF_JKR};
    pub use crate::measured_adhesion::{MeasuredAdhesion, ProfileAdhesion};
}
