//! `asperity reversals`: unloads a scene from many turning points.

use super::error::CliError;
use super::output::{Origin, OutputArguments, TABLES};
use super::scene::{SceneArguments, simulation_of};
use asperity_data::AxisScale;
use asperity_report::Format;
use asperity_report::ReversalReport;
use asperity_scene::{RunError, TURNING_POINTS};
use asperity_study::{Axis, PRELOADS, Results, Staircase, parse_range};
use clap::Args;
use std::io::Write;

const EXAMPLES: &str = "\
Examples:
  asperity reversals pressure-sensitive
  asperity reversals pressure-sensitive --preloads 1uN..20uN --count 128 -o reversals.svg
  asperity reversals rough-sphere --map -o map.csv

Turning points have equal distances of indentation. The Everett function is half the decrease of the
force since the turning point.";

#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct ReversalsArguments {
    #[command(flatten)]
    pub scene: SceneArguments,
    #[command(flatten)]
    pub options: ReversalOptions,
    #[command(flatten)]
    pub output: OutputArguments,
}

/// Choice of the reversals of a scene.
#[derive(Args, Debug)]
pub struct ReversalOptions {
    /// Number of turning points
    #[arg(long, value_name = "COUNT", default_value_t = 64, value_parser = clap::value_parser!(u16).range(*TURNING_POINTS.start() as i64..=*TURNING_POINTS.end() as i64))]
    pub count: u16,
    /// Turn between the indentations at two forces: 1uN..20uN
    ///
    /// Default: between first touch and the preload of the scene.
    #[arg(long, value_name = "FROM..TO", value_parser = forces)]
    pub preloads: Option<(f64, f64)>,
    /// Write a table of the points of the map instead of turning points
    #[arg(long)]
    pub map: bool,
}

fn forces(text: &str) -> Result<(f64, f64), String> {
    if text.contains(':') {
        return Err("allowed: two forces, such as 1uN..20uN; --count is the number of turning points".into());
    }
    let ends = parse_range(text, "N")?;
    Axis::of_preloads(ends, *PRELOADS.start(), AxisScale::Linear).map(|_| ends)
}

pub(super) fn reversals(arguments: &ReversalsArguments, stdout: &mut dyn Write) -> Result<(), CliError> {
    let ReversalsArguments { options, output, .. } = arguments;
    let (formats, usual) = if options.map { (TABLES, Format::Csv) } else { (&Format::ALL[..], Format::Text) };
    let format = output.format(formats, usual)?;
    let document = arguments.scene.open()?;
    let scene = document.scene();
    let failed = |error: RunError| CliError::named(document.name(), error);
    let mut simulation = simulation_of(&document);
    let (count, never) = (usize::from(options.count), || false);
    let map = simulation.reversal_map(scene, options.preloads, count, &never).map_err(failed)?;
    let (mut preloads, mut staircase) = (None, None);
    // Tables hold the map alone.
    if !format.is_table() {
        let largest = map.reversals.iter().map(|reversal| reversal.turn.force).fold(0.0, f64::max);
        let (from, to) = options.preloads.unwrap_or((0.0, largest));
        if let Ok(asked) = Axis::of_preloads((from, to), count, AxisScale::Linear) {
            let (record, folder) = (&Results::OF_PRELOADS, document.resolve(""));
            let solved = Results::of_scene(scene, &folder, record, 1, Some(&asked), 1);
            preloads = Some(solved.map_err(|error| CliError::named(document.name(), error))?);
            if format.is_picture() {
                staircase = Some(
                    Staircase::find(scene, &asked, &mut simulation, &never, &mut |_| ()).map_err(failed)?,
                );
            }
        }
    }
    let report = ReversalReport {
        title: document.title(),
        scene,
        map: &map,
        preloads: preloads.as_ref(),
        staircase: staircase.as_ref(),
        map_table: options.map,
    };
    output.write(stdout, &report, format, Origin::Scene(&document, scene))
}
