//! Errors of commands.

use crate::draw::PngError;
use crate::explorer::OpeningError;
use crate::explorer::config::ConfigError;
use crate::export::MeasuredHashError;
use crate::io::WriteError;
use crate::scene::{SceneErrors, quoted};
use crate::study::slurm::SlurmError;
use crate::study::{FigureError, StudyError};
use std::io;
use thiserror::Error;

/// Error of a command: one message, or one for each wrong line of input.
#[derive(Debug, Error)]
pub enum CliError {
    #[error(transparent)]
    Scene(Box<SceneErrors>),
    /// An argument that is neither a scene nor a command, with its errors as a scene.
    #[error("{errors}\nCommands: {commands} (see asperity --help)")]
    NeitherSceneNorCommand { errors: Box<SceneErrors>, commands: String },
    #[error("{}", .0.join("\n"))]
    Checked(Vec<String>),
    /// An error in a named object: a scene, a file, a word.
    #[error("{name}: {error}")]
    Named { name: String, error: Box<dyn std::error::Error + Send + Sync> },
    #[error("{path}: not an ending of what is written; allowed: {allowed}")]
    Ending { path: String, allowed: String },
    /// Several scenes, or the profile or patches of a scene, in a format that cannot represent them.
    #[error("{what}: only a picture shows {what}; allowed: -o FILE.svg or FILE.png, or --format svg")]
    OnlyInPicture { what: &'static str },
    #[error("--format {format}: not for a terminal; allowed: -o FILE.{format}")]
    BinaryInTerminal { format: &'static str },
    #[error(transparent)]
    Picture(#[from] PngError),
    /// The points of a map in a format that cannot represent them.
    #[error("{what}: only a table of the map; allowed: --format csv or npy")]
    OnlyInTable { what: &'static str },
    /// An option with a format that cannot represent its result.
    #[error("{what}: {allowed}")]
    NotInFormat { what: &'static str, allowed: &'static str },
    #[error(transparent)]
    Measured(#[from] MeasuredHashError),
    #[error(transparent)]
    Config(#[from] ConfigError),
    #[error("--restore: {0}")]
    Restore(String),
    #[error("--quick leaves out all of these cases: they take seconds and hundreds of megabytes")]
    OnlyLargeCases,
    #[error("{failed} of {checks} checks fail")]
    CasesFail { failed: usize, checks: usize },
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
    #[error("the explorer needs a terminal; asperity run {} computes the scene without one", quoted(scene))]
    NoTerminal { scene: String },
    #[error(
        "TERM=dumb: the explorer places characters, this terminal does not; asperity run {} computes the scene without one",
        quoted(scene)
    )]
    DumbTerminal { scene: String },
    #[error(
        "the explorer needs a terminal; asperity sweep plot {} draws the study without one",
        quoted(folder)
    )]
    NoTerminalForStudy { folder: String },
    #[error(transparent)]
    Opening(OpeningError),
    #[error("the explorer failed: {0}")]
    Explorer(String),
}

impl From<SceneErrors> for CliError {
    fn from(errors: SceneErrors) -> CliError {
        CliError::Scene(Box::new(errors))
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
