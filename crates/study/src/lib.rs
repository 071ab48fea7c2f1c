#![forbid(unsafe_code)]
#![warn(missing_docs)]
#![doc = include_str!("../README.md")]
//!
//! # Names by task
//!
//! * Plans: a [`Plan`] has several [`Axis`] with their [`Spacing`], each [`Quantity`] to record,
//!   and a [`StiffnessRange`]. [`Changes`] are made to a plan when it is read.
//! * Computing: [`compute`](compute()) computes a plan in memory. [`run_study`] computes a part of
//!   a plan, a [`Shard`], in a [`Folder`] and reports its [`StudyProgress`]. [`merge`] then makes
//!   the tables from all parts. [`compute_part`] computes some profiles without a folder, as a
//!   [`StudyPart`] that other processes can send.
//! * Results: [`Results`] has all values, their [`Statistics`] with the [`Spread`], and
//!   [`RegimeCounts`].
//! * One scene on many profiles: an [`Ensemble`]. [`Found`] answers a [`Question`], with an
//!   [`Answer`] for each profile. [`PreloadCurve`] and [`Staircase`] have the pull-off force as a
//!   function of the preload. [`Sensitivity`] has an [`Influence`] for each number of the scene:
//!   the [`Changed`] results for a smaller and a larger value of this number.
//! * Functions that may take long have three arguments in common. The first states what is to be
//!   computed. The second is a [`Simulation`](asperity_scene::Simulation), whose profile and
//!   contact may be used again. The third is a [`Control`](asperity_data::Control), with the number
//!   of threads, a test whether to stop, and a receiver of the progress or of the results so far.
//! * Errors of all these functions: [`StudyError`].
//!
//! Programs with figures and tables use further names in the modules [`folders`], [`maps`],
//! [`checks`], [`half_space`] and [`trust`].

mod axis;
mod boundary;
mod bracket;
mod budget;
mod case_outcome;
mod cells;
mod check;
mod compared;
mod comparison;
mod compute;
mod coordinates;
mod criteria;
mod criterion;
#[cfg(test)]
mod dense_scans;
#[cfg(test)]
#[path = "../../../tests/common/effort.rs"]
mod effort;
mod ensemble;
mod error;
mod find;
mod grid;
mod live_map;
mod live_plan;
mod measured;
mod measured_adhesion;
mod memory;
mod missing_profiles;
mod part;
mod place;
mod plan;
mod plan_text;
mod preload_curve;
mod preloads;
mod premises;
mod profiles;
mod quantity;
mod question;
mod recorder;
mod reference;
mod reference_budget;
mod reference_time;
mod resolved;
mod results;
mod rough_contact;
mod run;
mod scan;
mod search;
mod select;
mod sensitivity;
mod shard;
mod shells;
mod spatial;
mod square_loops;
mod stairs;
mod statistics;
mod status;
mod store;
mod study_map;
mod tables;

pub use axis::{Axis, Spacing};
pub use compute::{compute, compute_part, compute_with_measured};
pub use ensemble::Ensemble;
pub use error::StudyError;
pub use find::Found;
pub use part::StudyPart;
pub use plan::{Plan, StiffnessRange};
pub use plan_text::Changes;
pub use preload_curve::PreloadCurve;
pub use preloads::Staircase;
pub use quantity::Quantity;
pub use question::{Answer, Question};
pub use results::Results;
pub use run::{StudyProgress, StudyRun, run_study};
pub use sensitivity::{Changed, Influence, Sensitivity};
pub use shard::Shard;
pub use statistics::{RegimeCounts, Spread, Statistics};
pub use store::Folder;
pub use tables::merge;

/// Files of a study in a folder, and the progress of the study according to these files.
pub mod folders {
    pub use crate::results::Merged;
    pub use crate::status::{Attempt, ShardStatus, Status};
    pub use crate::store::{ShardFile, ShardHeader};
}

/// Maps of results over two axes of a study, and the values of a roughness parameter (κ or e_el/γ)
/// at which adhesion without a preload vanishes.
pub mod maps {
    pub use crate::boundary::{AdhesionBoundary, Boundaries, Crossing};
    pub use crate::grid::{Grid, GridCell, GridLayer, GridPlace};
    pub use crate::live_map::{Level, LiveMap};
    pub use crate::select::{Selected, Selection};
    pub use crate::study_map::StudyMap;
}

/// Cases with known results. `asperity check` computes each case and compares the computed with the
/// known result.
pub mod checks {
    pub use crate::check::case::Case;
    pub use crate::check::{Check, Verdict};
}

/// Comparison of a scene computed on one-dimensional profiles with the same scene computed in three
/// dimensions.
pub mod half_space {
    pub use crate::compared::Compared;
    pub use crate::reference::{
        LeftOut, Loaded, Reference, ReferenceEvent, ReferenceOptions, RoughnessOfBoth,
    };
    pub use crate::reference_budget::ReferenceBudget;
    pub use crate::shells::ComparedRoughness;
    pub use crate::square_loops::SquareLoops;
}

/// Errors of a pull-off force, one for each source, and criteria by which other theories decide
/// whether bodies adhere.
pub mod trust {
    pub use crate::budget::Budget;
    pub use crate::criteria::criteria;
    pub use crate::criterion::Criterion;
    pub use crate::measured_adhesion::{MeasuredAdhesion, ProfileAdhesion};
    pub use crate::premises::{warnings_of_reversals, warnings_on_profiles};
    pub use asperity_data::CountedWarning;
}
