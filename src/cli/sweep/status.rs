//! `asperity sweep status`: shows the progress of a study.

use crate::cli::error::CliError;
use crate::cli::output::AnswerFormat;
use asperity_report::status_text;
use asperity_study::Folder;
use asperity_study::folders::Status;
use clap::Args;
use std::io::Write;
use std::path::PathBuf;

const EXAMPLES: &str = "\
Examples:
  asperity sweep status study
  asperity sweep status study --format json";

#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct StatusArguments {
    /// Folder of the study
    #[arg(value_name = "DIR")]
    pub folder: PathBuf,
    /// A table, or one object.
    #[command(flatten)]
    pub format: AnswerFormat,
}

pub(super) fn status(arguments: &StatusArguments, stdout: &mut dyn Write) -> Result<(), CliError> {
    let folder = Folder::open(&arguments.folder)?;
    let status = Status::of(&folder)?;
    arguments
        .format
        .write(stdout, || status_text(folder.plan(), &status), &status)
}
