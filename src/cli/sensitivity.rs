//! `asperity sensitivity`: computes how the results of a scene change with its numbers.

use super::error::CliError;
use super::output::{Origin, OutputArguments, WITHOUT_PICTURE, without_look};
use super::removed;
use super::scene::{SceneArguments, simulation_of};
use asperity_report::Format;
use asperity_report::SensitivityReport;
use asperity_study::Sensitivity;
use clap::Args;
use std::io::Write;

const EXAMPLES: &str = "\
Examples:
  asperity sensitivity pressure-sensitive
  asperity sensitivity my-scene.ron --set numerics.points=16384 -o sensitivity.csv

Each number of the scene is made 10 % smaller and larger while all others stay; the last row is the
range over other random profiles.";

#[derive(Args, Debug)]
#[command(after_help = EXAMPLES, mut_args(without_look))]
pub struct SensitivityArguments {
    #[command(flatten)]
    pub scene: SceneArguments,
    #[command(flatten)]
    pub output: OutputArguments,
}

pub(super) fn sensitivity(arguments: &SensitivityArguments, stdout: &mut dyn Write) -> Result<(), CliError> {
    if arguments.output.asks_for_picture()
        && let Some(why) = removed::instead([removed::FIGURE_OF_SENSITIVITY])
    {
        return Err(CliError::message(why));
    }
    let format = arguments.output.format(WITHOUT_PICTURE, Format::Text)?;
    let document = arguments.scene.open()?;
    let scene = document.scene();
    let found = Sensitivity::of(scene, &mut simulation_of(&document), &|| false, &mut |_| ());
    let found = found.map_err(|error| CliError::named(document.name(), error))?;
    let report = SensitivityReport { title: document.title(), scene, sensitivity: &found };
    arguments.output.write(stdout, &report, format, Origin::Scene(&document, scene))
}
