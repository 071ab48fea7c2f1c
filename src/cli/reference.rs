//! `asperity reference`: a scene as a line and in three dimensions.

use super::error::CliError;
use super::output::{Origin, OutputArguments};
use super::progress::ProgressLine;
use super::scene::{ProfileArguments, SceneArguments};
use asperity_report::{Format, ReferenceReport};
use asperity_study::{Reference, ReferenceOptions};
use clap::Args;
use std::io::Write;
use std::sync::Mutex;
use std::sync::PoisonError;

const EXAMPLES: &str = "\
Examples:
  asperity reference jkr-sphere --grid 128
  asperity reference rough-sphere --maps 12
  asperity reference my-scene.ron --format json | jq .reference.budget

Random squares with the spectrum of the scene are pressed on an elastic half-space and pulled off,
beside random lines. Their means are compared; the area of contact of a line means nothing.";

/// Lines for each square: a line takes a thousandth of the time.
const LINES_PER_MAP: u64 = 16;

#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct ReferenceArguments {
    #[command(flatten)]
    pub scene: SceneArguments,
    /// Cells along the side of a square, a power of two from 32
    #[arg(long, value_name = "COUNT", default_value_t = 64)]
    pub grid: usize,
    /// Number of random squares
    #[arg(long, value_name = "COUNT", default_value_t = 24, value_parser = clap::value_parser!(u64).range(1..=10_000))]
    pub maps: u64,
    #[command(flatten)]
    pub profiles: ProfileArguments,
    #[command(flatten)]
    pub output: OutputArguments,
}

pub(super) fn reference(arguments: &ReferenceArguments, stdout: &mut dyn Write) -> Result<(), CliError> {
    let format = arguments.output.format(&Format::ALL, Format::Text)?;
    let document = arguments.scene.open()?;
    let maps = arguments.maps;
    let lines = arguments.profiles.lines.map_or(LINES_PER_MAP * maps, u64::from);
    let options = ReferenceOptions { cells: arguments.grid, maps, lines };
    let progress = Mutex::new((ProgressLine::default(), 0_u64));
    let report = || {
        let (line, done) = &mut *progress.lock().unwrap_or_else(PoisonError::into_inner);
        *done += 1;
        line.show(&format!("{done} of {maps} squares"), None);
    };
    let found = Reference::of(document.scene(), options, arguments.profiles.threads(), &|| false, &report);
    progress.into_inner().unwrap_or_else(PoisonError::into_inner).0.clear();
    let found = found.map_err(|error| CliError::named(document.name(), error))?;
    let report = ReferenceReport { title: document.title(), scene: document.scene(), reference: &found };
    arguments.output.write(stdout, &report, format, Origin::Scene(&document, document.scene()))
}
