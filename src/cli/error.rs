//! Errors of commands.

use crate::accuracy::{ChoiceError, CostError};
use crate::draw::PngError;
use crate::explorer::OpeningError;
use crate::explorer::config::ConfigError;
use crate::io::WriteError;
use crate::scene::{MeasuredHashError, SceneErrors, quoted};
use crate::simulation::RunError;
use crate::spectrum::SpectrumError;
use crate::study::LinesError;
use crate::study::slurm::SlurmError;
use crate::study::{FigureError, StudyError};
use crate::topography::TopographyError;
use std::io;
use thiserror::Error;

/// Error of a command: one message, or one for each wrong line of input.
#[derive(Debug, Error)]
pub enum CliError {
    /// A scene cannot be opened or is not allowed.
    #[error(transparent)]
    Scene(Box<SceneErrors>),
    /// An argument that is neither a scene nor a command.
    #[error("{errors}\nCommands: {commands} (see asperity --help)")]
    NeitherSceneNorCommand {
        /// Errors of the argument as a scene.
        errors: Box<SceneErrors>,
        /// The commands there are.
        commands: String,
    },
    /// Scenes that were checked are wrong.
    #[error("{}", .0.join("\n"))]
    Checked(Vec<String>),
    /// A file would hold something else than its ending says.
    #[error("{path}: not an ending of what is written; allowed: {allowed}")]
    Ending {
        /// The file.
        path: String,
        /// Endings of what is written.
        allowed: String,
    },
    /// Several scenes, or the profile or patches of a scene, in a format that cannot hold them.
    #[error("{what}: only a picture shows {what}; allowed: -o FILE.svg or FILE.png, or --format svg")]
    OnlyInPicture {
        /// Content that the format cannot hold.
        what: &'static str,
    },
    /// A picture would be printed to a terminal.
    #[error("--format png: a terminal shows no picture; allowed: -o FILE.png")]
    BinaryInTerminal,
    /// A picture cannot be made.
    #[error(transparent)]
    Picture(#[from] PngError),
    /// The points of a map in a format that cannot hold them, or that holds them anyway.
    #[error("{what}: only a table of the map; allowed: --format csv")]
    OnlyInTable {
        /// Option that chooses the content.
        what: &'static str,
    },
    /// A picture of something that no picture shows.
    #[error("{what}: {allowed}")]
    NoPicture {
        /// Content that no picture shows.
        what: &'static str,
        /// Allowed input.
        allowed: &'static str,
    },
    /// A measured surface cannot be read.
    #[error("{file}: {error}")]
    Surface {
        /// Its file.
        file: String,
        /// Reason.
        error: TopographyError,
    },
    /// A scene cannot hold how its surface is to be read.
    #[error(
        "--scene: a scene does not hold {option}; allowed: one file, --unit, --detrend, --periodic, --continue-to"
    )]
    LostInScene {
        /// Option that would be lost.
        option: &'static str,
    },
    /// A measured file cannot be read, or is not the one behind a table.
    #[error(transparent)]
    Measured(#[from] MeasuredHashError),
    /// Measured surfaces cannot be analysed.
    #[error("{file}: {error}")]
    Spectrum {
        /// File of the first surface, or of the one that is refused.
        file: String,
        /// Reason.
        error: SpectrumError,
    },
    /// The configuration is refused.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// Unsaved changes of another session cannot be opened.
    #[error("--restore: {0}")]
    Restore(String),
    /// A table of spectra is not computed again.
    #[error("{file}: {reason}")]
    Spectra {
        /// The table.
        file: String,
        /// Reason, and the allowed input.
        reason: String,
    },
    /// There is no built-in scene of this name.
    #[error("{name}: there is no such built-in scene; allowed: {allowed}")]
    NoPreset {
        /// The name.
        name: String,
        /// Those there are.
        allowed: String,
    },
    /// A scene could not be computed.
    #[error("{scene}: {error}")]
    Run {
        /// Name of the scene.
        scene: String,
        /// Reason.
        error: RunError,
    },
    /// The cost of accuracy could not be measured.
    #[error("{scene}: {error}")]
    Cost {
        /// Name of the scene.
        scene: String,
        /// Reason.
        error: CostError,
    },
    /// No number of springs was chosen for a tolerance.
    #[error("{scene}: {error}")]
    Choice {
        /// Name of the scene.
        scene: String,
        /// Reason.
        error: ChoiceError,
    },
    /// The scene could not be computed on several lines.
    #[error("{scene}: {error}")]
    Lines {
        /// Name of the scene.
        scene: String,
        /// Reason.
        error: LinesError,
    },
    /// No hard case has this word in its name.
    #[error("{word}: no case has this in its name; allowed: parts of {allowed}")]
    NoCase {
        /// The word.
        word: String,
        /// The names there are.
        allowed: String,
    },
    /// Only cases were named that a quick check leaves out.
    #[error("--quick leaves out all of these cases: they take seconds and hundreds of megabytes")]
    OnlyLargeCases,
    /// Hard cases fail.
    #[error("{failed} of {checks} checks fail")]
    CasesFail {
        /// Number.
        failed: usize,
        /// Of how many.
        checks: usize,
    },
    /// A study could not go on.
    #[error(transparent)]
    Sweep(#[from] StudyError),
    /// A study was not submitted to a cluster.
    #[error(transparent)]
    Slurm(#[from] SlurmError),
    /// A figure of a study cannot be drawn.
    #[error(transparent)]
    Figure(#[from] FigureError),
    /// A signal stopped a study.
    #[error("stopped: {done} of {total} records are complete; the same command continues the study")]
    Stopped {
        /// Number of the signal.
        signal: usize,
        /// Records that are there.
        done: u64,
        /// Records there are to be.
        total: u64,
    },
    /// Not even one thread has enough memory.
    #[error("--memory {most}: this plan takes {least} with one thread; allowed: at least that")]
    TooLittleMemory {
        /// Largest allowed value.
        most: String,
        /// Least value required.
        least: String,
    },
    /// The program has no Parquet in it.
    #[error(
        "--parquet: this program was built without it; cargo install --path . --features parquet builds it in"
    )]
    NoParquet,
    /// A file could not be written.
    #[error("{0}{hint}", hint = hint(.0))]
    Write(#[from] WriteError),
    /// Standard output could not be written to.
    #[error("standard output: cannot be written: {0}")]
    StandardOutput(#[from] io::Error),
    /// The explorer cannot draw.
    #[error("the explorer needs a terminal; asperity run {scene} computes the scene without one")]
    NoTerminal {
        /// Name of the scene.
        scene: String,
    },
    /// The terminal cannot place the cursor.
    #[error(
        "TERM=dumb: the explorer places characters, this terminal does not; asperity run {scene} computes the scene without one"
    )]
    DumbTerminal {
        /// Name of the scene.
        scene: String,
    },
    /// The explorer cannot draw the map of a study.
    #[error(
        "the explorer needs a terminal; asperity sweep plot {} draws the study without one",
        quoted(folder)
    )]
    NoTerminalForStudy {
        /// Folder of the study.
        folder: String,
    },
    /// An argument that cannot be explored.
    #[error(transparent)]
    Opening(OpeningError),
    /// The explorer failed.
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

/// Exit code of a process ended by a signal, less the number of the signal, as shells count.
const BY_SIGNAL: usize = 128;

impl CliError {
    /// Exit code of the process: 128 and the number of the signal where a signal ended the run, otherwise 1.
    #[must_use]
    pub fn exit_code(&self) -> u8 {
        match self {
            CliError::Stopped { signal, .. } => u8::try_from(BY_SIGNAL + signal).unwrap_or(FAILED),
            _ => FAILED,
        }
    }

    /// Returns true where the reader of the results has closed its end.
    #[must_use]
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
