//! `asperity reference`: compares the results of a scene on profiles (lines) with the results in
//! three dimensions.

use super::advice::option;
use super::error::CliError;
use super::output::{Origin, OutputArguments};
use super::progress::{ProgressLine, Task, watched};
use super::scene::{ProfileArguments, SceneArguments, warn_beside};
use asperity_report::{Format, ReferenceProgress, ReferenceReport};
use asperity_scene::{Document, Simulation};
use asperity_study::half_space::{Reference, ReferenceEvent, ReferenceOptions};
use clap::Args;
use std::io::Write;

const EXAMPLES: &str = "\
Examples:
  asperity reference jkr-sphere --grid 128
  asperity reference rough-sphere --surfaces 12
  asperity reference my-scene.ron --format json | jq .budget

Random squares with the spectrum of the scene are pressed on an elastic half-space and pulled off,
beside random profiles. Their means are compared; the area of contact of a profile means nothing.";

#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct ReferenceArguments {
    #[command(flatten)]
    pub scene: SceneArguments,
    /// Cells along the side of a square, a power of two from 32
    #[arg(long, value_name = "COUNT", default_value_t = 64)]
    pub grid: usize,
    /// Number of random squares; default: 24 without adhesion, 12 with
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u64).range(1..=10_000))]
    pub surfaces: Option<u64>,
    #[command(flatten)]
    pub profiles: ProfileArguments,
    #[command(flatten)]
    pub output: OutputArguments,
}

pub(super) fn reference(
    arguments: &ReferenceArguments,
    stdout: &mut dyn Write,
) -> Result<(), CliError> {
    let format = arguments.output.format(&Format::ALL, Format::Text)?;
    let document = arguments.scene.open()?;
    let usual = ReferenceOptions::of(document.scene(), arguments.surfaces);
    let profiles = arguments.profiles.lines.map_or(usual.profiles, u64::from);
    let options = ReferenceOptions {
        cells: arguments.grid,
        profiles,
        ..usual
    };
    let found = compared(&document, options, arguments.profiles.threads())?;
    let scene = document.scene();
    let report = ReferenceReport {
        wording: option,
        title: document.title(),
        scene,
        reference: &found,
    };
    warn_beside(&document, &report, format);
    arguments.output.write(
        stdout,
        &report,
        format,
        Origin::Scene(&document, document.scene()),
    )
}

/// Compares the results of a scene on profiles with the results in three dimensions. The progress
/// is shown on standard error.
pub(super) fn compared(
    document: &Document,
    options: ReferenceOptions,
    threads: usize,
) -> Result<Reference, CliError> {
    let task = Task {
        name: Some(document.name()),
        threads,
        begins: "estimating the computing time".to_owned(),
    };
    let mut progress = ReferenceProgress::default();
    let show = |event: &ReferenceEvent, line: &mut ProgressLine| {
        let (text, is_long) = progress.words(event);
        line.show(&text, is_long.then_some(&text));
        if is_long {
            line.keep();
        }
    };
    let mut simulation = Simulation::new(document.resolve(""));
    let found = watched(task, show, |control| {
        Reference::of(document.scene(), options, &mut simulation, control)
    });
    found.map_err(|error| {
        if error.is_interruption() {
            return CliError {
                message: progress.lost(),
                ..error
            };
        }
        error
    })
}
