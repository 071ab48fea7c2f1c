//! `asperity reversals`: computes the unloadings of a scene that begin at many turning points.

use super::error::CliError;
use super::output::{Origin, OutputArguments};
use super::progress::{Task, show_nothing, watched};
use super::scene::{SceneArguments, holds_warnings, simulation_of, staircase_of, warn};
use asperity_data::AxisScale;
use asperity_report::{Format, ReversalReport};
use asperity_scene::theory::ReversalMap;
use asperity_scene::{Document, Simulation};
use asperity_study::trust::warnings_of_reversals;
use asperity_study::{Axis, Results};
use clap::Args;
use std::io::Write;

const EXAMPLES: &str = "\
Examples:
  asperity reversals pressure-sensitive
  asperity reversals pressure-sensitive --preloads 1uN..20uN:128 -o reversals.svg
  asperity reversals rough-sphere --format json -o map.json

Turning points have equal distances of indentation. The Everett function is half the decrease of the
force since the turning point.";

#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct ReversalsArguments {
    #[command(flatten)]
    pub scene: SceneArguments,
    /// Turn between the indentations at two forces: 1uN..20uN
    ///
    /// Default: between first touch and the preload of the scene. There are 64 turning points, or
    /// the number after a colon: 1uN..20uN:128, or :128 with the usual forces.
    #[arg(long, value_name = "A..B", value_parser = turns, verbatim_doc_comment)]
    pub preloads: Option<(Option<(f64, f64)>, usize)>,
    #[command(flatten)]
    pub output: OutputArguments,
}

/// Number of turning points if the user gives none.
const USUAL: usize = 64;

/// Parses two forces and, after a colon, the number of turning points. If the forces are missing,
/// the range of turning points follows from the scene.
fn turns(text: &str) -> Result<(Option<(f64, f64)>, usize), String> {
    let (forces, count) = text
        .split_once(':')
        .map_or((text, None), |(forces, count)| (forces, Some(count)));
    let least = ReversalMap::TURNING_POINTS.start();
    let most = ReversalMap::TURNING_POINTS.end();
    let allowed =
        || format!("allowed: after the colon a number of turning points from {least} to {most}");
    let count = count.map_or(Ok(USUAL), |count| {
        count.trim().parse().map_err(|_| allowed())
    })?;
    if !ReversalMap::TURNING_POINTS.contains(&count) {
        return Err(allowed());
    }
    if forces.is_empty() && text.starts_with(':') {
        return Ok((None, count));
    }
    let ends = Axis::parse_range(forces, "N");
    let checked = ends.and_then(|ends| {
        Axis::of_preloads(ends, *Axis::PRELOADS.start(), AxisScale::Linear)?;
        Ok((Some(ends), count))
    });
    checked.map_err(|error| error.to_string())
}

pub(super) fn reversals(
    arguments: &ReversalsArguments,
    stdout: &mut dyn Write,
) -> Result<(), CliError> {
    let output = &arguments.output;
    let format = output.format(&Format::ALL, Format::Text)?;
    let document = arguments.scene.open()?;
    let scene = document.scene();
    let mut simulation = simulation_of(&document);
    let (ends, count) = arguments.preloads.unwrap_or((None, USUAL));
    let map = map_of(&document, ends, count, &mut simulation)?;
    let warnings = warnings_of_reversals(&map, scene, &mut simulation)
        .map_err(|error| CliError::advised(document.name(), &error))?;
    if !holds_warnings(format) {
        warn(&document, &warnings);
    }
    let mut preloads = None;
    let mut staircase = None;
    // Tables contain only the turning points and no pull-off forces, so that these need not be
    // computed.
    if !format.is_table() {
        let largest = map
            .reversals
            .iter()
            .map(|reversal| reversal.turn.force)
            .fold(0.0, f64::max);
        let ends = ends.unwrap_or((0.0, largest));
        if let Ok(axis) = Axis::of_preloads(ends, count, AxisScale::Linear) {
            preloads = Some(adhesion_at(&document, &axis)?);
            if format.is_picture() {
                staircase = Some(staircase_of(&document, scene, &axis, &mut simulation)?);
            }
        }
    }
    let report = ReversalReport {
        title: document.title(),
        scene,
        map: &map,
        warnings: &warnings,
        preloads: preloads.as_ref(),
        staircase: staircase.as_ref(),
    };
    output.write(stdout, &report, format, Origin::Scene(&document, scene))
}

/// Computes the unloadings from the turning points of a scene.
fn map_of(
    document: &Document,
    ends: Option<(f64, f64)>,
    count: usize,
    simulation: &mut Simulation,
) -> Result<ReversalMap, CliError> {
    let task = Task {
        name: Some(document.name()),
        threads: 1,
        begins: format!("{count} turning points"),
    };
    watched(task, show_nothing::<()>, |control| {
        simulation.reversal_map(document.scene(), ends, count, &|| control.is_stopped())
    })
}

/// Computes the pull-off force of a scene after each of the given preloads.
fn adhesion_at(document: &Document, preloads: &Axis) -> Result<Results, CliError> {
    let task = Task {
        name: Some(document.name()),
        threads: 1,
        begins: format!("{} preloads", preloads.count()),
    };
    let mut simulation = simulation_of(document);
    watched(task, show_nothing, |control| {
        let record = &Results::OF_PRELOADS;
        let preloads = Some(preloads);
        Results::of_scene(
            document.scene(),
            record,
            1,
            preloads,
            &mut simulation,
            control,
        )
    })
}
