//! `asperity run`: computes a scene without a terminal.

use super::scene::simulation_of;
use super::{CliError, OutputArguments, SceneArguments};
use crate::export::{summary, write_curve, write_json};
use clap::{Args, ValueEnum};
use std::io::Write;

const EXAMPLES: &str = "\
Examples:
  asperity run pressure-sensitive
  asperity run my-scene.ron --set adhesion.work=0.1 --format json | jq .adhesion_force
  asperity run jkr-sphere --set numerics.points=65536 -o jkr.csv

JSON and CSV are in SI units. Compression is positive, indentation counts from first touch.";

/// Arguments of `run`.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct RunArguments {
    /// The scene.
    #[command(flatten)]
    pub scene: SceneArguments,
    /// summary, json or csv; left out: by the ending of FILE, else summary
    ///
    /// A summary is text for a person. JSON is one object with everything: scene, line, figures,
    /// curve, contacts, work. CSV is the curve: leg,indentation,force,contact_length,fragments.
    #[arg(long, value_enum, hide_possible_values = true, verbatim_doc_comment)]
    pub format: Option<RunFormat>,
    /// Where it goes.
    #[command(flatten)]
    pub output: OutputArguments,
}

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
    let scene = document.scene();
    arguments.output.check()?;
    let outcome = simulation_of(&document)
        .run(scene, &|| false, &mut |_, _, _| Ok(()))
        .map_err(|error| CliError::Run { scene: document.name().into(), error })?;
    arguments.output.write(stdout, |out| match arguments.chosen_format() {
        RunFormat::Summary => out.write_all(summary(scene, &outcome).as_bytes()),
        RunFormat::Json => write_json(out, scene, &outcome),
        RunFormat::Csv => write_curve(out, &outcome),
    })
}
