//! `asperity profile`: writes the rigid profile of a scene.

use super::error::CliError;
use super::output::{Origin, OutputArguments, TABLES, only_formats};
use super::scene::{SceneArguments, simulation_of, warn};
use asperity_report::Format;
use clap::Args;
use std::io::Write;

const EXAMPLES: &str = "\
Examples:
  asperity profile profile-hurst-025 > profile.csv
  asperity profile profile-hurst-025 --set numerics.points=65536 -o finer.csv
  asperity profile profile-hurst-025 -o profile.npy

The finer profile is the same profile: a wave keeps its phase on every grid.";

#[derive(Args, Debug)]
#[command(after_help = EXAMPLES, mut_args(only_formats(TABLES)))]
pub struct ProfileTableArguments {
    #[command(flatten)]
    pub scene: SceneArguments,
    #[command(flatten)]
    pub output: OutputArguments,
}

pub(super) fn profile(
    arguments: &ProfileTableArguments,
    stdout: &mut dyn Write,
) -> Result<(), CliError> {
    let format = arguments.output.format(TABLES, Format::Csv)?;
    let document = arguments.scene.open()?;
    warn(&document, &document.scene().warnings());
    let mut simulation = simulation_of(&document);
    let made = simulation.make_line(document.scene());
    let (line, ..) = made.map_err(|error| CliError::advised(document.name(), &error))?;
    arguments.output.write(
        stdout,
        line,
        format,
        Origin::Scene(&document, document.scene()),
    )
}
