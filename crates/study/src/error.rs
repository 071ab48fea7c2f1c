//! Errors of studies.

use asperity_data::{Remedied, Remedy, WriteError, memory_size, path_name};
use asperity_half_space::HalfSpaceError;
use asperity_scene::{RunError, Scene};
use asperity_surface::SurfaceError;
use std::io;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Message for a request of several profiles although the profile of the scene is fixed: the first
/// text says what was found, and the second what is allowed.
pub(super) const ONE_PROFILE: (&str, &str) = (
    "more than one profile, and the profile of this scene is fixed",
    "random roughness (SelfAffine, or an equivalent line)",
);

/// Error of a function that computes, writes or reads a study. Results that were written to files
/// before the error are kept.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum StudyError {
    /// A [`Plan`](crate::Plan) has errors. Each text describes one error in one line.
    #[error("{}", .0.join("\n"))]
    Plan(Vec<String>),
    /// The folder of a study, or a file in it, cannot be read or written, is damaged, or does not
    /// belong to the study.
    #[error("{}: {reason}", path_name(path))]
    Folder {
        /// Path of the folder or the file.
        path: PathBuf,
        /// Reason in words why the folder or the file cannot be used.
        reason: String,
    },
    /// A file with a measured surface, which the scene of the study names, cannot be read.
    #[error(transparent)]
    Measured(#[from] SurfaceError),
    /// A file of results, such as a table, could not be written.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// The computation of the scene of a study failed, or a [`Control`](asperity_data::Control)
    /// stopped the computation.
    #[error("{place}{error}")]
    Run {
        /// Values on the axes and seed of the profile, as text that ends with a colon; empty if a
        /// single profile is computed.
        place: String,
        /// Reason why the scene was not computed to the end.
        error: Box<RunError>,
    },
    /// The solver of contacts in three dimensions returned an error.
    #[error(transparent)]
    HalfSpace(#[from] HalfSpaceError),
    /// A value is out of range, an argument of a function is not allowed, or the study or scene
    /// lacks what was requested.
    #[error("{}{found}; allowed: {allowed}", place.as_ref().map_or_else(String::new, |place| format!("{place}: ")))]
    Refused {
        /// What is not allowed: the path of a number in the scene, or the name of an argument.
        /// `None` if the request as a whole is not allowed.
        place: Option<String>,
        /// Value or request that was found, in words.
        found: String,
        /// Values or requests that are allowed, in words.
        allowed: String,
        /// Changes of the request that may help; empty if no single change does.
        remedies: Vec<Remedy>,
    },
    /// Two files have different results for the same values on the axes and the same profile.
    #[error(
        "{place}: two records differ, in {} and {}; remove the one that is wrong",
        path_name(&files[0]),
        path_name(&files[1])
    )]
    Conflict {
        /// Values on the axes and seed of the profile, as text.
        place: String,
        /// The two files whose results differ.
        files: [PathBuf; 2],
    },
    /// The memory does not suffice for this number of records. A record has the recorded quantities
    /// for one combination of values on the axes, on one random profile.
    #[error("there is not enough memory for {0} records")]
    TooManyRecords(u64),
    /// The study needs more memory on the requested number of threads than the system provides.
    #[error(
        "not enough memory: on {} the study takes up to {}; allowed: fewer threads, or fewer springs",
        threads(*jobs),
        memory_size(*bytes)
    )]
    Memory {
        /// Requested number of threads.
        jobs: u64,
        /// Memory that the study needs on these threads, in bytes.
        bytes: u64,
    },
    /// The operating system could not start a thread of the computation. The contained error states
    /// the reason.
    #[error("could not start a worker thread: {0}")]
    NoThread(io::Error),
}

fn threads(count: u64) -> String {
    if count == 1 {
        "1 thread".to_owned()
    } else {
        format!("{count} threads")
    }
}

impl Remedied for StudyError {
    fn remedies(&self) -> Vec<Remedy> {
        match self {
            StudyError::Measured(error) => error.remedies(),
            StudyError::Run { error, .. } => error.remedies(),
            StudyError::Refused { remedies, .. } => remedies.clone(),
            StudyError::Memory { jobs: 2.., .. } => vec![Remedy::FewerThreads],
            _ => Vec::new(),
        }
    }
}

impl From<RunError> for StudyError {
    /// Makes the error of the computation of a single profile.
    fn from(error: RunError) -> StudyError {
        StudyError::at(String::new(), error)
    }
}

impl StudyError {
    /// Makes the error of a failed computation. `place` states the values on the axes and the seed
    /// of the profile.
    pub(super) fn at(place: String, error: RunError) -> StudyError {
        let error = Box::new(error);
        StudyError::Run { place, error }
    }

    /// Makes the error of a value or a request that is not allowed. `place` is the path of the
    /// number in the scene, or the name of the argument.
    pub(super) fn refused(
        place: Option<&str>,
        found: impl Into<String>,
        allowed: impl Into<String>,
    ) -> StudyError {
        StudyError::Refused {
            place: place.map(str::to_owned),
            found: found.into(),
            allowed: allowed.into(),
            remedies: Vec::new(),
        }
    }

    /// Returns the same error with one more change that may help.
    pub(super) fn with(mut self, remedy: Remedy) -> StudyError {
        if let StudyError::Refused { remedies, .. } = &mut self {
            remedies.push(remedy);
        }
        self
    }

    /// Makes the error of a request for several profiles if the profile of the scene is fixed.
    pub(super) fn fixed_profile() -> StudyError {
        StudyError::refused(None, ONE_PROFILE.0, ONE_PROFILE.1)
    }

    /// Checks the number of profiles of a scene.
    ///
    /// # Errors
    /// Returns an error if the number is zero, or above one for a scene with a fixed profile.
    pub(super) fn check_profiles(scene: &Scene, profiles: u64) -> Result<(), StudyError> {
        match profiles {
            0 => Err(StudyError::refused(None, "no profiles", "at least one")),
            2.. if scene.seed().is_none() => Err(StudyError::fixed_profile()),
            _ => Ok(()),
        }
    }

    /// Returns an error for a computation without threads.
    pub(super) fn check_threads(threads: usize) -> Result<(), StudyError> {
        if threads > 0 {
            Ok(())
        } else {
            Err(StudyError::refused(None, "0 threads", "at least one"))
        }
    }

    /// Returns true if the computation ended because its [`Control`](asperity_data::Control)
    /// stopped it.
    pub fn is_interruption(&self) -> bool {
        match self {
            StudyError::Run { error, .. } => error.is_interruption(),
            StudyError::HalfSpace(error) => *error == HalfSpaceError::Stopped,
            _ => false,
        }
    }

    pub(super) fn folder(path: &Path, reason: impl ToString) -> StudyError {
        StudyError::Folder {
            path: path.to_path_buf(),
            reason: reason.to_string(),
        }
    }

    pub(super) fn unreadable(path: &Path) -> impl Fn(io::Error) -> StudyError + '_ {
        move |error| StudyError::folder(path, format!("cannot be read: {error}"))
    }

    pub(super) fn unwritable(path: &Path) -> impl Fn(io::Error) -> StudyError + '_ {
        move |reason| {
            WriteError::Failed {
                path: path.to_path_buf(),
                reason,
            }
            .into()
        }
    }
}
