//! Errors of commands.

use crate::explorer::config::ConfigError;
use crate::io::WriteError;
use crate::scene::SceneErrors;
use crate::study::slurm::SlurmError;
use crate::study::{FigureError, StudyError};
use std::io;
use thiserror::Error;

/// Error of a command: one message, or one for each wrong line of input.
#[derive(Debug, Error)]
pub enum CliError {
    #[error(transparent)]
    Scene(Box<SceneErrors>),
    /// An error in a named object: a scene, a file, a word.
    #[error("{name}: {error}")]
    Named { name: String, error: Box<dyn std::error::Error + Send + Sync> },
    #[error("{0}")]
    Message(String),
    #[error(transparent)]
    Config(#[from] ConfigError),
    #[error(transparent)]
    Sweep(#[from] StudyError),
    #[error(transparent)]
    Slurm(#[from] SlurmError),
    #[error(transparent)]
    Figure(#[from] FigureError),
    /// A signal stopped a study.
    #[error("stopped: {done} of {total} records are complete; the same command continues the study")]
    Stopped { signal: usize, done: u64, total: u64 },
    #[error("--memory {most}: this plan takes {least} with one thread; allowed: at least that")]
    TooLittleMemory { most: String, least: String },
    #[error(
        "--parquet: this program was built without it; cargo install --path . --features parquet builds it in"
    )]
    NoParquet,
    #[error("{0}{hint}", hint = hint(.0))]
    Write(#[from] WriteError),
    #[error("standard output: cannot be written: {0}")]
    StandardOutput(#[from] io::Error),
}

impl From<SceneErrors> for CliError {
    fn from(errors: SceneErrors) -> CliError {
        CliError::Scene(Box::new(errors))
    }
}

impl From<String> for CliError {
    fn from(message: String) -> CliError {
        CliError::Message(message)
    }
}

/// Exit code of a failed run or wrong input.
const FAILED: u8 = 1;

/// Exit code of a process ended by a signal, minus the number of the signal, as in shells.
const BY_SIGNAL: usize = 128;

impl CliError {
    /// An error, or a message, after the name of its cause.
    pub fn named(
        name: impl Into<String>,
        error: impl Into<Box<dyn std::error::Error + Send + Sync>>,
    ) -> CliError {
        CliError::Named { name: name.into(), error: error.into() }
    }

    /// Exit code of the process: 128 plus the number of the signal if a signal ended the run, otherwise 1.
    pub fn exit_code(&self) -> u8 {
        match self {
            CliError::Stopped { signal, .. } => u8::try_from(BY_SIGNAL + signal).unwrap_or(FAILED),
            _ => FAILED,
        }
    }

    /// Returns true if the reader of the results has closed its end.
    pub fn is_closed_pipe(&self) -> bool {
        match self {
            CliError::StandardOutput(error) | CliError::Write(WriteError::Failed { reason: error, .. }) => {
                error.kind() == io::ErrorKind::BrokenPipe
            }
            _ => false,
        }
    }
}

fn hint(error: &WriteError) -> &'static str {
    if matches!(error, WriteError::Exists { .. }) { "; --force overwrites it" } else { "" }
}
