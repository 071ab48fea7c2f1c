//! Errors of studies.

use super::plan::{ONE_PROFILE, Plan};
use super::plan_text::PlanErrors;
use asperity_data::WriteError;
use asperity_data::{memory_size, path_name};
use asperity_half_space::HalfSpaceError;
use asperity_scene::RunError;
use asperity_surface::SurfaceError;
use std::io;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Error that ends the work on a study; records written before are kept.
#[derive(Debug, Error)]
pub enum StudyError {
    /// The plan has errors.
    #[error(transparent)]
    Plan(#[from] PlanErrors),
    /// A folder or file of the study cannot be used.
    #[error("{}: {reason}", path_name(path))]
    Folder {
        /// Path of the folder or file.
        path: PathBuf,
        /// Reason, in words.
        reason: String,
    },
    /// The measured file of the study cannot be read.
    #[error(transparent)]
    Measured(#[from] SurfaceError),
    /// A file could not be written.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// A cell or a profile could not be computed.
    #[error("{place}{error}")]
    Run {
        /// Cell with its coordinates and seed of the profile, followed by a colon; empty for a single profile.
        place: String,
        /// Reason of the failure.
        error: RunError,
    },
    /// A body in three dimensions is refused.
    #[error(transparent)]
    HalfSpace(#[from] HalfSpaceError),
    /// The request for a study is not allowed.
    #[error("{found}; allowed: {allowed}")]
    NotAllowed {
        /// The request that is refused, in words.
        found: &'static str,
        /// The requests that are allowed, in words.
        allowed: &'static str,
    },
    /// A question cannot be answered.
    #[error("{place}: {why}")]
    Question {
        /// Path of the number that is sought.
        place: String,
        /// Reason, and what is allowed, in words.
        why: String,
    },
    /// Two records of the same cell and profile differ.
    #[error(
        "{place}: two records differ, in {} and {}; remove the one that is wrong",
        path_name(&files[0]),
        path_name(&files[1])
    )]
    Conflict {
        /// Cell with its coordinates and seed of the profile.
        place: String,
        /// The two files that hold the records.
        files: [PathBuf; 2],
    },
    /// A table with this number of records does not fit into the memory.
    #[error("there is not enough memory for {0} records")]
    TooManyRecords(u64),
    /// The study needs more memory on this number of threads than the system has.
    #[error(
        "not enough memory: with --jobs {jobs} the study takes up to {}; allowed: fewer jobs, or fewer springs",
        memory_size(*bytes)
    )]
    Memory {
        /// Number of threads.
        jobs: u64,
        /// Memory that the study needs, bytes.
        bytes: u64,
    },
    /// The system starts no thread, for this reason.
    #[error("could not start a worker thread: {0}")]
    NoThread(io::Error),
}

/// Error of a request for a study without profiles.
pub(super) const NO_PROFILES: StudyError =
    StudyError::NotAllowed { found: "no profiles", allowed: "at least one" };
/// Error of a request for several profiles of a scene that has a single one.
pub(super) const FIXED_PROFILE: StudyError =
    StudyError::NotAllowed { found: ONE_PROFILE.0, allowed: ONE_PROFILE.1 };

impl StudyError {
    /// Error of one profile of a study that has a single cell, or one cell for each preload.
    pub(super) fn of_profile(plan: &Plan, line: u64, error: RunError) -> StudyError {
        let place = if plan.lines > 1 { format!("seed {}: ", plan.seed_of(line)) } else { String::new() };
        StudyError::Run { place, error }
    }

    pub(super) fn folder(path: &Path, reason: impl ToString) -> StudyError {
        StudyError::Folder { path: path.to_path_buf(), reason: reason.to_string() }
    }

    pub(super) fn unreadable(path: &Path) -> impl Fn(io::Error) -> StudyError + '_ {
        move |error| StudyError::folder(path, format!("cannot be read: {error}"))
    }

    pub(super) fn unwritable(path: &Path) -> impl Fn(io::Error) -> StudyError + '_ {
        move |reason| WriteError::Failed { path: path.to_path_buf(), reason }.into()
    }
}
