//! `asperity sensitivity`: computes how the results of a scene change if its numbers are changed.

use super::error::CliError;
use super::output::{Origin, OutputArguments, WITHOUT_PICTURE, only_formats};
use super::progress::{ProgressLine, Task, watched};
use super::scene::{SceneArguments, threads, warn_beside};
use asperity_data::counted;
use asperity_report::{Format, SensitivityReport};
use asperity_scene::Simulation;
use asperity_study::Sensitivity;
use clap::Args;
use std::io::Write;

const EXAMPLES: &str = "\
Examples:
  asperity sensitivity pressure-sensitive
  asperity sensitivity my-scene.ron --set numerics.points=16384 -o sensitivity.csv

Each number of the scene is made 10 % smaller and larger while all others stay, on the same 16
random profiles: the change of the median, and the range of the changes of the profiles.";

#[derive(Args, Debug)]
#[command(after_help = EXAMPLES, mut_args(only_formats(WITHOUT_PICTURE)))]
pub struct SensitivityArguments {
    #[command(flatten)]
    pub scene: SceneArguments,
    /// Threads that share the profiles; default: one for each core
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub jobs: Option<u16>,
    #[command(flatten)]
    pub output: OutputArguments,
}

pub(super) fn sensitivity(
    arguments: &SensitivityArguments,
    stdout: &mut dyn Write,
) -> Result<(), CliError> {
    let format = arguments.output.format(WITHOUT_PICTURE, Format::Text)?;
    let document = arguments.scene.open()?;
    let scene = document.scene();
    let task = Task {
        name: Some(document.name()),
        threads: threads(arguments.jobs),
        begins: "0 profiles".to_owned(),
    };
    let mut simulation = Simulation::new(document.resolve(""));
    let found = watched(
        task,
        |found: &Sensitivity, line: &mut ProgressLine| {
            line.show(&counted(found.profiles, "profile"), None)
        },
        |control| Sensitivity::of(scene, &mut simulation, control),
    )?;
    let report = SensitivityReport {
        title: document.title(),
        scene,
        sensitivity: &found,
    };
    warn_beside(&document, &report, format);
    arguments
        .output
        .write(stdout, &report, format, Origin::Scene(&document, scene))
}
