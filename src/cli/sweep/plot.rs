//! `asperity sweep plot`: draws figures of a merged study.

use crate::cli::advice;
use crate::cli::error::CliError;
use crate::cli::output::{OutputArguments, only_formats};
use asperity_report::{Format, study_curves, study_figure, study_map};
use asperity_scene::Scene;
use asperity_study::Results;
use asperity_study::maps::{Selected, Selection};
use clap::Args;
use std::io;
use std::io::Write;
use std::path::PathBuf;

const EXAMPLES: &str = "\
Examples:
  asperity sweep plot study                          A figure for the terminal
  asperity sweep plot study --width 85mm -o map.pdf  ... and one for a paper
  asperity sweep plot study --at roughness.hurst=0.3 A curve over the axis that is left
  asperity sweep plot study --quantity pull_off_force --x adhesion.kappa --y roughness.hurst

Two free axes make a map: colours are means, signs are regimes, and the line is where adhesion
without a load vanishes. One free axis makes a curve: the mean with its 95 % confidence, and a
second chart on a logarithmic scale where it spans decades. A second axis of up to five values
makes several curves, unless --y names it.";

#[derive(Args, Debug)]
#[command(after_help = EXAMPLES, mut_args(only_formats(FORMATS)))]
pub struct PlotArguments {
    /// Folder of the study
    #[arg(value_name = "DIR")]
    pub folder: PathBuf,
    #[command(flatten)]
    pub selection: Selection,
    #[command(flatten)]
    pub output: OutputArguments,
}

const FORMATS: &[Format] = &[Format::Svg, Format::Png, Format::Pdf, Format::Text];

pub(super) fn plot(arguments: &PlotArguments, stdout: &mut dyn Write) -> Result<(), CliError> {
    // With `-o -`, an SVG document is written into a pipe.
    let usual = if arguments.output.output.is_none() {
        Format::Text
    } else {
        Format::Svg
    };
    let format = arguments.output.format(FORMATS, usual)?;
    let study = Results::open(&arguments.folder)?;
    let selected = arguments.selection.of(&study).map_err(CliError::from)?;
    let Selected {
        grid,
        quantities,
        curves,
        note,
    } = selected;
    // An error in writing to standard error is ignored, so that the figure is drawn in any case.
    let _ = note.map(|note| writeln!(io::stderr(), "{}", advice::note(&note)));
    // If the user has chosen a scale, the second chart, which has the other scale, is left out.
    let scales = if arguments.selection.scale.is_some() {
        1
    } else {
        2
    };
    let mut charts = Vec::new();
    for quantity in quantities {
        match study_map(&grid, quantity, false, None) {
            Some(map) if !curves => charts.push(map),
            _ => charts.extend(study_curves(&grid, quantity).into_iter().take(scales)),
        }
    }
    let figure = study_figure(&study.plan().title, &grid, charts);
    // Only parameters that are equal in these two scenes are shown as common. A number that varies
    // in the study differs between the first and the last cell.
    let cells = [0, study.plan().cells() - 1].map(|cell| study.plan().scene_of(cell));
    let scenes: Vec<_> = cells
        .into_iter()
        .flatten()
        .map(|scene| (String::new(), Scene::clone(&scene)))
        .collect();
    arguments
        .output
        .write_figure(stdout, &figure, format, &scenes)
}
