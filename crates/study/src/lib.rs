#![forbid(unsafe_code)]
#![warn(missing_docs)]
#![doc = include_str!("../README.md")]
//!
//! # Names by task
//!
//! * Plans: [`Plan`] with [`Axis`], [`Spacing`], [`StiffnessRange`] and the [`Quantity`] to record; [`Changes`] to a plan.
//! * Computing: [`compute`](compute()) in memory; [`run_study`] with [`StudyProgress`] in a [`Folder`], of which each process computes a
//!   [`Shard`]; [`merge`] afterwards. [`Stop`] ends a computation.
//! * Results: [`Results`] with [`Statistics`], [`Spread`] and [`RegimeCounts`].
//! * One scene on many profiles: [`ensemble`](ensemble()) returns an [`Ensemble`], [`find`](find()) answers a [`Question`] by [`Found`] with an
//!   [`Answer`] for each profile; [`PreloadCurve`] and [`Staircase`] over the preload; [`Sensitivity`] with the [`Influence`]
//!   of each number and what [`Changed`].
//! * What is refused: [`StudyError`].
//!
//! The modules are for programs: [`folders`], [`maps`], [`checks`], [`half_space`] and [`trust`].

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
pub use plan::{Plan, StiffnessRange};
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

/// Files in the folder of a study, for programs that show the progress of shards or read results.
pub mod folders {
    pub use crate::results::Merged;
    pub use crate::status::{Attempt, ShardStatus, Status};
    pub use crate::store::{ShardFile, ShardHeader};
}

/// Maps of results over two axes, from a stored study or computed for display, and boundaries of adhesion.
pub mod maps {
    pub use crate::boundary::{AdhesionBoundary, Boundaries, Crossing};
    pub use crate::grid::{Grid, GridCell, GridLayer, GridPlace};
    pub use crate::live_map::{Level, LiveMap};
    pub use crate::select::{Selected, Selection};
    pub use crate::study_map::StudyMap;
}

/// Cases with known results, which `asperity check` computes.
pub mod checks {
    pub use crate::check::case::Case;
    pub use crate::check::{Check, Verdict};
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
    pub use crate::criterion::Criterion;
    pub use crate::measured_adhesion::{MeasuredAdhesion, ProfileAdhesion};
}
