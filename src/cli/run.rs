//! `asperity run`: computes a scene without a terminal.

use super::scene::simulation_of;
use super::{CliError, OutputArguments, SceneArguments};
use crate::accuracy::{Choice, Estimate, choose, estimate, parse_tolerance};
use crate::export::{
    ensemble_text, summary, write_curve, write_ensemble_csv, write_ensemble_json, write_json,
};
use crate::scene::{Document, Scene};
use crate::simulation::Outcome;
use crate::study;
use clap::{Args, ValueEnum};
use std::io::{self, Write};
use std::thread::available_parallelism;

const EXAMPLES: &str = "\
Examples:
  asperity run pressure-sensitive
  asperity run my-scene.ron --set adhesion.work=0.1 --format json | jq .adhesion_force
  asperity run jkr-sphere --set numerics.points=65536 -o jkr.csv
  asperity run jkr-sphere --tolerance 0.1%
  asperity run pressure-sensitive --lines 32 --format csv

JSON and CSV are in SI units. Compression is positive, indentation counts from first touch.";

/// Arguments of `run`.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct RunArguments {
    /// The scene.
    #[command(flatten)]
    pub scene: SceneArguments,
    /// summary, json or csv; default: by the extension of FILE, else summary
    ///
    /// A summary is text for a person. JSON is one object with scene, profile, figures, curve,
    /// contacts and work. CSV is the curve: leg,indentation,force,contact_length,fragments.
    #[arg(long, value_enum, hide_possible_values = true, verbatim_doc_comment)]
    pub format: Option<RunFormat>,
    /// Choose springs and edges for an adhesion force within T, as 1e-3 or 0.1%
    ///
    /// Doubles the springs until the error is small enough: the error from the closed form of
    /// the scene, else an estimate; without a pull-off, the error of the force curve. Replaces
    /// numerics.points and numerics.edges of the scene.
    #[arg(long, value_name = "T", value_parser = parse_tolerance, verbatim_doc_comment)]
    pub tolerance: Option<f64>,
    /// Compute random profiles from this seed on: mean and spread
    ///
    /// CSV then has one row for each seed. A tolerance applies to the first profile.
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u32).range(2..=MOST_LINES), verbatim_doc_comment)]
    pub lines: Option<u32>,
    /// Threads that share the profiles; default: one for each core
    #[arg(long, value_name = "COUNT", requires = "lines", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub jobs: Option<u16>,
    /// Where it goes.
    #[command(flatten)]
    pub output: OutputArguments,
}

/// Most random lines.
const MOST_LINES: i64 = 1_000_000;

/// What a run prints.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum RunFormat {
    /// Text for a person: line, regime and why, forces, work and time.
    Summary,
    /// One object with everything: scene, line, figures, curve, contacts, work.
    Json,
    /// The force curve.
    Csv,
}

impl RunArguments {
    fn chosen_format(&self) -> RunFormat {
        self.format.unwrap_or_else(|| match self.output.file().and_then(|path| path.extension()?.to_str()) {
            Some("json") => RunFormat::Json,
            Some("csv") => RunFormat::Csv,
            _ => RunFormat::Summary,
        })
    }
}

/// Computes a scene and writes what it gave.
pub(super) fn run(arguments: &RunArguments, stdout: &mut dyn Write) -> Result<(), CliError> {
    let document = arguments.scene.open()?;
    arguments.output.check()?;
    let choice = arguments.tolerance.map(|tolerance| choice(&document, tolerance)).transpose()?;
    let chosen = choice.as_ref().map(|choice| choice.apply(document.scene()));
    let scene = chosen.as_ref().unwrap_or(document.scene());
    if let Some(lines) = arguments.lines {
        return on_lines(arguments, &document, scene, choice.as_ref(), lines, stdout);
    }
    let outcome = simulation_of(&document)
        .run(scene, &|| false, &mut |_, _, _| Ok(()))
        .map_err(|error| CliError::Run { scene: document.name().into(), error })?;
    let (format, choice) = (arguments.chosen_format(), choice.as_ref());
    let estimate = estimate_for(format, &document, scene, &outcome, choice)?;
    arguments.output.write(stdout, |out| match format {
        RunFormat::Summary => {
            out.write_all(summary(scene, &outcome, estimate.as_ref()).as_bytes())?;
            choice.map_or(Ok(()), |choice| writeln!(out, "\n{}", choice.sentence()))
        }
        RunFormat::Json => write_json(out, scene, &outcome, choice, estimate.as_ref()),
        RunFormat::Csv => write_curve(out, &outcome),
    })
}

/// The estimated error of an outcome, for a format that states it: that of the choice where springs were chosen.
fn estimate_for(
    format: RunFormat,
    document: &Document,
    scene: &Scene,
    outcome: &Outcome,
    choice: Option<&Choice>,
) -> Result<Option<Estimate>, CliError> {
    match (format, choice) {
        (RunFormat::Csv, _) => Ok(None),
        (_, Some(choice)) => Ok(Some(choice.estimate())),
        (_, None) => estimate(scene, &document.resolve(""), outcome, &|| false)
            .map_err(|error| CliError::Run { scene: document.name().into(), error }),
    }
}

/// The springs and edges for a tolerance, told on standard error.
fn choice(document: &Document, tolerance: f64) -> Result<Choice, CliError> {
    let choice = choose(document.scene(), &document.resolve(""), tolerance, &|| false, &mut |_| ())
        .map_err(|error| CliError::Choice { scene: document.name().into(), error })?;
    // Who cannot be told does without.
    let _ = writeln!(io::stderr(), "{}", choice.sentence());
    Ok(choice)
}

/// Computes a scene on several lines and writes what they gave.
fn on_lines(
    arguments: &RunArguments,
    document: &Document,
    scene: &Scene,
    choice: Option<&Choice>,
    lines: u32,
    stdout: &mut dyn Write,
) -> Result<(), CliError> {
    let jobs =
        arguments.jobs.map_or_else(|| available_parallelism().map_or(1, std::num::NonZero::get), usize::from);
    let results = study::solve_lines(scene, &document.resolve(""), lines as usize, jobs)
        .map_err(|error| CliError::Lines { scene: document.name().into(), error })?;
    arguments.output.write(stdout, |out| match arguments.chosen_format() {
        RunFormat::Summary => {
            out.write_all(ensemble_text(scene, &results).as_bytes())?;
            choice.map_or(Ok(()), |choice| writeln!(out, "\n{}", choice.sentence()))
        }
        RunFormat::Json => write_ensemble_json(out, scene, choice, &results),
        RunFormat::Csv => write_ensemble_csv(out, &results),
    })
}
