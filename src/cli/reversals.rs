//! `asperity reversals`: the unloadings of a scene from many turning points.

use super::preloads::parse_preloads;
use super::scene::simulation_of;
use super::{CliError, Format, OutputArguments, SceneArguments};
use crate::export::{
    ReversalReport, reversals_figure, reversals_text, write_reversal_map_csv, write_reversals_csv,
    write_reversals_json,
};
use crate::scene::Preloads;
use crate::simulation::{RunError, TURNING_POINTS, TurningPoints};
use crate::study::solve_preloads;
use clap::Args;
use std::io::Write;

const EXAMPLES: &str = "\
Examples:
  asperity reversals pressure-sensitive
  asperity reversals pressure-sensitive --preloads 1uN..20uN --count 128 -o reversals.svg
  asperity reversals rough-sphere --map --format csv -o map.csv

Turning points are at equal indentations. The Everett function is half of what the force falls by
from the turning point on; the density is -1/2 of the mixed second derivative of the force.";

/// Most steps on either side of the fit of the density.
const MOST_SMOOTHING: i64 = 16;
/// Most upper, and lower, indentations of the minor loops.
const MOST_LEVELS: i64 = 64;

/// Arguments of `reversals`.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct ReversalsArguments {
    #[command(flatten)]
    pub scene: SceneArguments,
    /// Turning points
    #[arg(long, value_name = "COUNT", default_value_t = 64, value_parser = clap::value_parser!(u16).range(*TURNING_POINTS.start() as i64..=*TURNING_POINTS.end() as i64))]
    pub count: u16,
    /// Turn between the indentations of two forces: 1uN..20uN
    ///
    /// Default: between first touch and the preload of the scene.
    #[arg(long, value_name = "FROM..TO", value_parser = forces)]
    pub preloads: Option<(f64, f64)>,
    /// Steps on either side of the quadratic fit of the density
    #[arg(long, value_name = "STEPS", default_value_t = 3, value_parser = clap::value_parser!(u8).range(1..=MOST_SMOOTHING))]
    pub smoothing: u8,
    /// Upper, and lower, ends of the minor loops; 0: no loops
    #[arg(long, value_name = "LEVELS", default_value_t = 12, value_parser = clap::value_parser!(u8).range(0..=MOST_LEVELS))]
    pub loops: u8,
    /// CSV with a row for each point of the map, not each turning point
    #[arg(long)]
    pub map: bool,
    /// text, json, csv, svg or png; default: by the extension of FILE
    #[arg(long, value_parser = Format::parser(FORMATS), hide_possible_values = true)]
    pub format: Option<Format>,
    #[command(flatten)]
    pub output: OutputArguments,
}

/// Formats of reversals: a table, one object, a row for each turning point or point of the map, and a picture of the
/// adhesion force over the preload and of both maps.
const FORMATS: &[Format] = &[Format::Text, Format::Json, Format::Csv, Format::Svg, Format::Png];

fn forces(text: &str) -> Result<(f64, f64), String> {
    if text.contains(':') {
        return Err("allowed: two forces, such as 1uN..20uN; --count is the number of turning points".into());
    }
    parse_preloads(text).map(|preloads| preloads.ends())
}

/// Unloads a scene from many turning points and writes the result.
pub(super) fn reversals(arguments: &ReversalsArguments, stdout: &mut dyn Write) -> Result<(), CliError> {
    let usual = if arguments.map { Format::Csv } else { Format::Text };
    let formats = if arguments.map { &[Format::Csv] } else { FORMATS };
    let format = arguments.output.format(arguments.format, formats, usual)?;
    if arguments.map && format != Format::Csv {
        return Err(CliError::OnlyInTable { what: "--map" });
    }
    let document = arguments.scene.open()?;
    arguments.output.check()?;
    let scene = document.scene();
    let failed = |error: RunError| CliError::named(document.name(), error);
    let mut simulation = simulation_of(&document);
    let turning =
        arguments.preloads.map_or(TurningPoints::OfScene, |(from, to)| TurningPoints::Preloads(from, to));
    let never = || false;
    let map =
        simulation.reversal_map(scene, turning, usize::from(arguments.count), &never).map_err(failed)?;
    let smoothing = usize::from(arguments.smoothing);
    let levels = if format == Format::Csv { 0 } else { usize::from(arguments.loops) };
    let loops = match levels {
        0 => None,
        _ => Some(simulation.minor_loops(scene, &map, levels, &never).map_err(failed)?),
    };
    let largest = map.reversals.iter().map(|reversal| reversal.turn.force).fold(0.0, f64::max);
    let (from, to) = arguments.preloads.unwrap_or((0.0, largest));
    let mut preloads = Vec::new();
    let asked = Preloads::new(from, to, usize::from(arguments.count));
    if let Some(asked) = asked.filter(|_| format != Format::Csv) {
        solve_preloads(&mut simulation, scene, &asked.forces(), &never, &mut |one| preloads.push(one))
            .map_err(failed)?;
    }
    let report = ReversalReport { scene, map: &map, preloads: &preloads, loops, smoothing };
    if format.picture().is_some() {
        let figure = reversals_figure(&report, document.title());
        return arguments.output.write_figure(stdout, &figure, format);
    }
    arguments.output.write(stdout, |out| match format {
        Format::Json => write_reversals_json(out, &report),
        Format::Csv if arguments.map => write_reversal_map_csv(out, &map, smoothing),
        Format::Csv => write_reversals_csv(out, &map),
        _ => out.write_all(reversals_text(&report).as_bytes()),
    })
}
