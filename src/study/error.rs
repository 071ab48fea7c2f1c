//! Errors of studies.

use super::plan::Plan;
use super::plan_text::PlanErrors;
use crate::io::WriteError;
use crate::simulation::RunError;
use crate::surface::SurfaceError;
use crate::text::{memory_size, path_name};
use std::io;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Error that ends work on a study; earlier records are kept.
#[derive(Debug, Error)]
pub enum StudyError {
    /// The plan is wrong.
    #[error(transparent)]
    Plan(#[from] PlanErrors),
    /// A folder or file of the study cannot be used.
    #[error("{}: {reason}", path_name(path))]
    Folder {
        /// The folder or file.
        path: PathBuf,
        /// Reason.
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
        /// Cell with its coordinates and seed of the profile, before a colon; empty for a single profile.
        place: String,
        /// Error of the run.
        error: RunError,
    },
    /// Records are missing, or two records of one cell and profile differ.
    #[error("{0}")]
    Records(String),
    /// The system has too little memory for so many threads.
    #[error(
        "not enough memory: with --jobs {jobs} the study takes up to {}; allowed: fewer jobs, or fewer springs",
        memory_size(*bytes)
    )]
    Memory {
        /// Number of threads.
        jobs: u64,
        /// Memory of the study, bytes.
        bytes: u64,
    },
    /// The system starts no thread.
    #[error("could not start a worker thread: {0}")]
    NoThread(io::Error),
}

impl StudyError {
    /// Error of a profile of a study of one cell, or one at each preload.
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
