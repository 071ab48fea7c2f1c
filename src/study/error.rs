//! Errors of studies.

use super::plan_text::PlanErrors;
use super::record::Key;
use crate::io::WriteError;
use crate::simulation::RunError;
use crate::surface::SurfaceError;
use crate::text::path_name;
use std::io;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Error that ends work on a study; earlier records are kept.
#[derive(Debug, Error)]
pub enum StudyError {
    /// The plan is wrong.
    #[error(transparent)]
    Plan(#[from] PlanErrors),
    /// A folder or file of the study cannot be read, or is not one.
    #[error("{}: {reason}", path_name(path))]
    Folder {
        /// The folder or file.
        path: PathBuf,
        /// Reason.
        reason: String,
    },
    /// The folder holds a study of another plan.
    #[error(
        "{}: this folder holds a study of another plan; choose another folder, or the plan it began with\n{difference}",
        path_name(path)
    )]
    OtherPlan {
        /// The folder.
        path: PathBuf,
        /// The first lines that differ.
        difference: String,
    },
    /// The measured file of the study cannot be read.
    #[error(transparent)]
    Measured(#[from] SurfaceError),
    /// The content of the measured file differs from that at the beginning of the study.
    #[error(
        "{}: the content of this measured file has changed: its SHA-256 is {found}, {plan} has {expected}; bring \
         back the file the study began with, or begin another study in another folder",
        path_name(file)
    )]
    MeasuredChanged {
        /// The measured file.
        file: PathBuf,
        /// Hash of its content now.
        found: String,
        /// Name of the plan that expects another hash.
        plan: String,
        /// Expected hash.
        expected: String,
    },
    /// A file could not be written.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// A cell could not be computed.
    #[error("cell {cell} ({coordinates}), seed {seed}: {error}")]
    Run {
        /// Index of the cell.
        cell: u64,
        /// Coordinates of the cell.
        coordinates: String,
        /// Seed of the profile.
        seed: u64,
        /// Error of the run.
        error: RunError,
    },
    /// Two processes computed different results for the same cell and profile.
    #[error(
        "{key} ({coordinates}): two records differ, in {} and {}; remove the one that is wrong",
        path_name(one),
        path_name(other)
    )]
    Disagree {
        /// Cell and seed.
        key: Key,
        /// The cell's coordinates.
        coordinates: String,
        /// A file.
        one: PathBuf,
        /// The other.
        other: PathBuf,
    },
    /// Records are missing.
    #[error(
        "{records} of {total} records are missing, in {cells} cells: {}{}; run the study to its end, or merge with \
         --partial",
        named.join(", "),
        if *cells > named.len() as u64 { ", …" } else { "" }
    )]
    Missing {
        /// Number of records.
        records: u64,
        /// Number of records of the study.
        total: u64,
        /// Number of cells with missing profiles.
        cells: u64,
        /// The first of these cells.
        named: Vec<String>,
    },
    /// The memory does not hold the table of records.
    #[error("there is not enough memory for {records} records")]
    OutOfMemory {
        /// Number of records.
        records: u64,
    },
    /// The system starts no thread.
    #[error("could not start a worker thread: {0}")]
    NoThread(io::Error),
}

impl StudyError {
    /// Error of a folder or file that cannot be used, with the reason.
    pub(super) fn folder(path: &Path, reason: impl ToString) -> StudyError {
        StudyError::Folder { path: path.to_path_buf(), reason: reason.to_string() }
    }

    /// Errors of reading a folder or file.
    pub(super) fn unreadable(path: &Path) -> impl Fn(io::Error) -> StudyError + '_ {
        move |error| StudyError::folder(path, format!("cannot be read: {error}"))
    }

    /// Errors of writing a folder or file.
    pub(super) fn unwritable(path: &Path) -> impl Fn(io::Error) -> StudyError + '_ {
        move |reason| WriteError::Failed { path: path.to_path_buf(), reason }.into()
    }
}
