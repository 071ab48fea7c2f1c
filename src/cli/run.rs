//! `asperity run`: computation of a scene without a terminal.

use super::error::CliError;
use super::output::{Origin, OutputArguments, PICTURES, WITHOUT_PICTURE};
use super::preloads::{check_reach, parse_preloads};
use super::progress::ProgressLine;
use super::scene::{MOST_LINES, SceneArguments, compute, simulation_of, threads};
use crate::accuracy::{Choice, choose, estimate, parse_tolerance};
use crate::contact::{Leg, LegRecord};
use crate::draw::Figure;
use crate::export::{
    ContactSets, Format, LinesReport, PreloadReport, Report, RunReport, check_measured_files, force_figure,
    force_panels,
};
use crate::scene::{CheckedScene, Document, Scene, open_argument};
use crate::study::{Axis, Quantity, Results, Staircase};
use crate::text::{grouped, wrap};
use clap::Args;
use std::io::{self, Write};

const EXAMPLES: &str = "\
Examples:
  asperity run pressure-sensitive
  asperity run my-scene.ron --set adhesion.work=0.1 --format json | jq .adhesion_force
  asperity run jkr-sphere --set numerics.points=65536 -o jkr.csv
  asperity run jkr.csv --set adhesion.work=0.1 -o other.npy
  asperity run jkr-sphere --tolerance 0.1%
  asperity run pressure-sensitive --lines 32 --format csv
  asperity run pressure-sensitive --preloads 0..20uN --lines 16
  asperity run pressure-sensitive -o loop.svg
  asperity run pressure-sensitive --profile -o profile.svg
  asperity run ideal-adhesion pressure-sensitive non-adhesive -o loops.svg
  asperity run ideal-adhesion pressure-sensitive non-adhesive --panels --width 170mm -o panels.pdf

JSON is one object with scene, profile, figures, curve, contacts and work; CSV and .npy hold the
curve, in SI units. Compression is positive, indentation is zero at first touch. CSV and .npy
contain version, command and scene, and open as that scene.";

#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct RunArguments {
    #[command(flatten)]
    pub scene: SceneArguments,
    /// More scenes in one picture: force curves in one chart, all else in a chart each
    #[arg(value_name = "SCENE")]
    pub more: Vec<String>,
    /// Draw the force curve of each scene over axes of its own
    #[arg(long, requires = "more", conflicts_with_all = ["profile", "fragments", "preloads"])]
    pub panels: bool,
    /// Draw the profile and its contact at the largest force instead of the curve
    #[arg(long, conflicts_with_all = ["fragments", "lines"])]
    pub profile: bool,
    /// Draw the contact patches over the indentation instead of the curve
    #[arg(long, conflicts_with = "lines")]
    pub fragments: bool,
    /// Choose springs and edges for an adhesion force within T, as 1e-3 or 0.1%
    ///
    /// Doubles the springs until the error is small enough. The error is that from the closed
    /// form if there is one, else an estimate; without a pull-off it is that of the force curve.
    /// Replaces numerics.points and numerics.edges of the scene.
    #[arg(long, value_name = "T", value_parser = parse_tolerance, verbatim_doc_comment)]
    pub tolerance: Option<f64>,
    /// Compute COUNT random profiles: mean and spread
    ///
    /// Their seeds begin with that of the scene. CSV has one row for each seed. A tolerance
    /// applies to the first profile.
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u32).range(2..=MOST_LINES), verbatim_doc_comment)]
    pub lines: Option<u32>,
    /// Compute the adhesion force for many preloads instead of the loading
    ///
    /// 64 preloads at equal distances, or the number after a colon: 0..20uN:128; with :log at
    /// equal ratios: 10nN..100uN:64:log. One loading, and one unloading from each preload; with
    /// --lines, median, quartiles, range and mean over the profiles. A preload below 0 N turns
    /// while the bodies are still drawn together, and is at least the force at first touch.
    #[arg(long, value_name = "A..B", allow_hyphen_values = true, conflicts_with_all = ["profile", "fragments"], value_parser = parse_preloads, verbatim_doc_comment)]
    pub preloads: Option<Axis>,
    /// Write a table of the drawn curves instead of all profiles
    #[arg(long, requires = "preloads")]
    pub curves: bool,
    /// Threads that share the profiles; default: one for each core
    #[arg(long, value_name = "COUNT", requires = "lines", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub jobs: Option<u16>,
    #[command(flatten)]
    pub output: OutputArguments,
}

/// Columns of messages.
const WIDTH: usize = 80;

impl RunArguments {
    fn is_drawn(&self) -> bool {
        !self.more.is_empty() || self.profile || self.fragments
    }

    fn format(&self) -> Result<Format, CliError> {
        if !self.more.is_empty() && self.lines.is_some() && self.preloads.is_none() {
            return Err(CliError::named("--lines", "several scenes; allowed: one scene, or --preloads"));
        }
        let (formats, usual) = match self.is_drawn() {
            true => (PICTURES, Format::Svg),
            false if self.lines.is_some() && self.preloads.is_none() => (WITHOUT_PICTURE, Format::Text),
            false => (&Format::ALL[..], Format::Text),
        };
        self.output.format(formats, usual)
    }

    fn solved(
        &self,
        document: &Document,
        scene: &CheckedScene,
        record: &[Quantity],
    ) -> Result<Results, CliError> {
        let (lines, jobs) = (self.lines.map_or(1, u64::from), threads(self.jobs));
        Results::of_scene(scene, &document.resolve(""), record, lines, self.preloads.as_ref(), jobs)
            .map_err(|error| CliError::named(document.name(), error))
    }

    /// Adhesion of a scene against preload, and the staircase where this is shown or judges preloads below zero.
    fn adhesion(
        &self,
        document: &Document,
        scene: &CheckedScene,
        preloads: &Axis,
        is_drawn: bool,
    ) -> Result<(Results, Option<Staircase>), CliError> {
        let mut simulation = simulation_of(document);
        check_reach(document, scene, preloads.values[preloads.values.len() - 1], &mut simulation)?;
        let staircase = (is_drawn || self.curves || preloads.values[0] < 0.0)
            .then(|| Staircase::find(scene, preloads, &mut simulation, &|| false, &mut |_| ()))
            .transpose()
            .map_err(|error| CliError::named(document.name(), error))?;
        Ok((self.solved(document, scene, &Results::OF_PRELOADS)?, staircase))
    }

    /// The scene of a document, with springs and edges for the tolerance if one is given. Text states the choice; with
    /// other formats it is on standard error.
    fn scene_of(
        &self,
        document: &Document,
        format: Format,
    ) -> Result<(CheckedScene, Option<Choice>), CliError> {
        let Some(tolerance) = self.tolerance else { return Ok((document.scene().clone(), None)) };
        let mut progress = ProgressLine::default();
        let mut trying = |points| progress.show(&format!("trying {} springs", grouped(points)), None);
        let choice = choose(document.scene(), &document.resolve(""), tolerance, &|| false, &mut trying);
        progress.clear();
        let choice = choice.map_err(|error| CliError::named(document.name(), error))?;
        if format != Format::Text {
            let _ = writeln!(io::stderr(), "{}", wrap(&choice.sentence(), WIDTH).join("\n"));
        }
        Ok((choice.apply(document.scene())?, Some(choice)))
    }
}

pub(super) fn run(arguments: &RunArguments, stdout: &mut dyn Write) -> Result<(), CliError> {
    let format = arguments.format()?;
    let document = arguments.scene.open()?;
    check_measured_files(&document).map_err(CliError::message)?;
    if arguments.is_drawn() {
        let (figure, scenes) = figure(arguments, document, format)?;
        return arguments.output.write_figure(stdout, &figure, format, &scenes);
    }
    let (scene, choice) = arguments.scene_of(&document, format)?;
    let (title, choice, folder) = (document.title(), choice.as_ref(), document.resolve(""));
    let mut write = |report: &dyn Report| {
        arguments.output.write(stdout, report, format, Origin::Scene(&document, &scene))
    };
    if let Some(preloads) = &arguments.preloads {
        let (results, staircase) = arguments.adhesion(&document, &scene, preloads, format.is_picture())?;
        let (results, staircase, curves) = (&results, staircase.as_ref(), arguments.curves);
        return write(&PreloadReport { title, choice, results, staircase, curves });
    }
    if arguments.lines.is_some() {
        let results = &arguments.solved(&document, &scene, LinesReport::RECORD)?;
        return write(&LinesReport { choice, results });
    }
    let outcome = compute(&document, &scene)?;
    let estimate = match choice {
        Some(choice) => Some(choice.estimate()),
        None if matches!(format, Format::Text | Format::Json) => {
            estimate(&scene, &folder, &outcome, &|| false)
        }
        None => None,
    };
    write(&RunReport { title, scene: &scene, outcome: &outcome, choice, estimate: estimate.as_ref() })
}

fn figure(
    arguments: &RunArguments,
    document: Document,
    format: Format,
) -> Result<(Figure, Vec<(String, Scene)>), CliError> {
    let more = arguments.more.iter().map(|scene| arguments.scene.overrides.apply(open_argument(scene)?));
    let documents = std::iter::once(Ok(document)).chain(more).collect::<Result<Vec<_>, CliError>>()?;
    let (mut scenes, mut figures, mut outcomes) = (Vec::new(), Vec::new(), Vec::new());
    for document in &documents {
        let (scene, _) = arguments.scene_of(document, format)?;
        let title = document.title();
        if let Some(preloads) = &arguments.preloads {
            let (results, staircase) = arguments.adhesion(document, &scene, preloads, true)?;
            let (results, staircase) = (&results, staircase.as_ref());
            let report = PreloadReport { title, choice: None, results, staircase, curves: false };
            figures.extend(report.drawn(false));
        } else if arguments.profile || arguments.fragments {
            figures.push(contact_figure(arguments, document, &scene)?);
        } else {
            outcomes.push((title, compute(document, &scene)?));
        }
        scenes.push((title.to_owned(), Scene::clone(&scene)));
    }
    let outcomes: Vec<_> = outcomes.iter().map(|(title, outcome)| (*title, outcome)).collect();
    let figure = match figures.len() {
        0 if arguments.panels => force_panels(&outcomes),
        0 => force_figure(&outcomes),
        1 => figures.remove(0),
        _ => Figure::of_panels(figures),
    };
    Ok((figure, scenes))
}

fn contact_figure(
    arguments: &RunArguments,
    document: &Document,
    scene: &CheckedScene,
) -> Result<Figure, CliError> {
    let failed = |error| CliError::named(document.name(), error);
    let mut simulation = simulation_of(document);
    let mut sets = ContactSets::new(arguments.fragments);
    let mut observe = |_, record: &LegRecord, leg: &Leg| {
        sets.observe(record, leg);
        Ok(())
    };
    let outcome = simulation.run(scene, &|| false, &mut observe).map_err(failed)?;
    if arguments.fragments {
        return Ok(sets.patches_figure(document.title(), &outcome));
    }
    let (line, ..) = simulation.make_line(scene).map_err(failed)?;
    Ok(sets.profile_figure(document.title(), &outcome, line))
}
