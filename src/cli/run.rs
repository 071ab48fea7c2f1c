//! `asperity run`: computation of a scene without a terminal.

use super::preloads::parse_preloads;
use super::scene::{MOST_LINES, compute, simulation_of, threads};
use super::{CliError, Format, OutputArguments, SceneArguments};
use crate::accuracy::{Choice, choose, estimate, parse_tolerance};
use crate::contact::{Leg, LegRecord};
use crate::draw::Figure;
use crate::export::{
    ContactSets, MeasuredHash, PreloadReport, ensemble_text, force_figure, summary, write_curve,
    write_ensemble_json, write_ensemble_table, write_json,
};
use crate::scene::{Document, Scene, open_argument};
use crate::study::{self, Preloads};
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

JSON, CSV and .npy are in SI units. Compression is positive, indentation counts from first touch.
CSV and .npy hold version, command and scene: such a file is a scene, and opens as one.";

/// Arguments of `run`.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct RunArguments {
    #[command(flatten)]
    pub scene: SceneArguments,
    /// More scenes, whose force curves are drawn into the same picture
    #[arg(value_name = "SCENE")]
    pub more: Vec<String>,
    /// text, json, csv, npy, svg or png; default: by the extension of FILE
    ///
    /// Text is a summary for a person. JSON is one object with scene, profile, figures, curve,
    /// contacts and work. CSV is the curve: leg, indentation, force, contact_length, fragments,
    /// stored_energy. npy is the same as a structured array of NumPy. SVG and PNG are pictures of
    /// the curve.
    #[arg(long, value_parser = Format::parser(FORMATS), hide_possible_values = true, verbatim_doc_comment)]
    pub format: Option<Format>,
    /// Draw the profile and its contact at the largest force instead of the curve
    #[arg(long, conflicts_with_all = ["fragments", "more", "lines"])]
    pub profile: bool,
    /// Draw the contact patches over the indentation instead of the curve
    #[arg(long, conflicts_with_all = ["more", "lines"])]
    pub fragments: bool,
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
    /// Adhesion force for many preloads in place of the loading
    ///
    /// 64 preloads at equal distances, or as many as follow a colon: 0..20uN:128. One loading,
    /// and one unloading from each preload. With --lines the mean over the profiles and its
    /// 95 % confidence.
    #[arg(long, value_name = "A..B", conflicts_with_all = ["more", "profile", "fragments"], value_parser = parse_preloads, verbatim_doc_comment)]
    pub preloads: Option<Preloads>,
    /// Threads that share the profiles; default: one for each core
    #[arg(long, value_name = "COUNT", requires = "lines", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub jobs: Option<u16>,
    #[command(flatten)]
    pub output: OutputArguments,
}

/// Formats of a run: text, one object with all results, the force curve, and pictures of the force curve, the
/// profile or the contact patches.
const FORMATS: &[Format] = &[Format::Text, Format::Json, Format::Csv, Format::Npy, Format::Svg, Format::Png];

impl RunArguments {
    fn chosen_format(&self) -> Result<Format, CliError> {
        let needs_picture = [
            (!self.more.is_empty(), "several scenes"),
            (self.profile, "--profile"),
            (self.fragments, "--fragments"),
        ];
        let needs_picture = needs_picture.into_iter().find(|(is_asked, _)| *is_asked);
        let usual = if needs_picture.is_some() { Format::Svg } else { Format::Text };
        let format = self.output.format(self.format, FORMATS, usual)?;
        let (what, allowed) = match needs_picture {
            Some((_, what)) if format.picture().is_none() => return Err(CliError::OnlyInPicture { what }),
            _ if format.picture().is_some() && self.lines.is_some() && self.preloads.is_none() => {
                ("--lines", "a picture shows one profile; allowed: text, json, csv and npy")
            }
            _ => return Ok(format),
        };
        Err(CliError::NotInFormat { what, allowed })
    }

    /// The scene of a document, with springs and edges for the tolerance if one is given; the choice is reported on
    /// standard error.
    fn scene_of(&self, document: &Document) -> Result<(Scene, Option<Choice>), CliError> {
        let Some(tolerance) = self.tolerance else { return Ok((document.scene().clone(), None)) };
        let choice = choose(document.scene(), &document.resolve(""), tolerance, &|| false, &mut |_| ())
            .map_err(|error| CliError::named(document.name(), error))?;
        let _ = writeln!(io::stderr(), "{}", choice.sentence());
        Ok((choice.apply(document.scene()), Some(choice)))
    }

    /// Writes text, followed by the choice of springs if there is one.
    fn write_text(
        &self,
        stdout: &mut dyn Write,
        text: &str,
        choice: Option<&Choice>,
    ) -> Result<(), CliError> {
        self.output.write(stdout, |out| {
            out.write_all(text.as_bytes())?;
            choice.map_or(Ok(()), |choice| writeln!(out, "\n{}", choice.sentence()))
        })
    }
}

/// Computes a scene and writes its results.
pub(super) fn run(arguments: &RunArguments, stdout: &mut dyn Write) -> Result<(), CliError> {
    let format = arguments.chosen_format()?;
    let document = arguments.scene.open()?;
    MeasuredHash::check_all(&document)?;
    arguments.output.check()?;
    if let Some(preloads) = arguments.preloads {
        return over_preloads(arguments, &document, format, preloads, stdout);
    }
    if format.picture().is_some() {
        return arguments.output.write_figure(stdout, &figure(arguments, document)?, format);
    }
    let (scene, choice) = arguments.scene_of(&document)?;
    if let Some(lines) = arguments.lines {
        return on_lines(arguments, &document, (scene, choice.as_ref()), (format, lines), stdout);
    }
    let outcome = compute(&document, &scene)?;
    if let Some(format) = format.table() {
        return arguments.output.write_table(stdout, (&document, &scene), |out, provenance| {
            write_curve(out, format, provenance, &outcome)
        });
    }
    let choice = choice.as_ref();
    let estimate = match choice {
        Some(choice) => Some(choice.estimate()),
        None => estimate(&scene, &document.resolve(""), &outcome, &|| false),
    };
    if format == Format::Json {
        let write = |out: &mut dyn Write| write_json(out, &scene, &outcome, choice, estimate.as_ref());
        return arguments.output.write(stdout, write);
    }
    arguments.write_text(stdout, &summary(&scene, &outcome, estimate.as_ref()), choice)
}

/// Computes the scenes and draws the requested figure.
fn figure(arguments: &RunArguments, document: Document) -> Result<Figure, CliError> {
    let more = arguments.more.iter().map(|scene| arguments.scene.overrides.apply(open_argument(scene)?));
    let documents = std::iter::once(Ok(document)).chain(more).collect::<Result<Vec<_>, CliError>>()?;
    let mut computed = Vec::new();
    for document in &documents {
        let (scene, _) = arguments.scene_of(document)?;
        if !(arguments.profile || arguments.fragments) {
            computed.push((document.title(), compute(document, &scene)?));
            continue;
        }
        let failed = |error| CliError::named(document.name(), error);
        let mut simulation = simulation_of(document);
        let mut sets = ContactSets::new(arguments.fragments);
        let mut observe = |_, record: &LegRecord, leg: &Leg| sets.observe(record, leg);
        let outcome = simulation.run(&scene, &|| false, &mut observe).map_err(failed)?;
        if arguments.fragments {
            return Ok(sets.patches_figure(document.title(), &outcome));
        }
        let (line, ..) = simulation.make_line(&scene).map_err(failed)?;
        return Ok(sets.profile_figure(document.title(), &outcome, line));
    }
    let scenes: Vec<_> = computed.iter().map(|(title, outcome)| (*title, outcome)).collect();
    Ok(force_figure(&scenes))
}

/// Computes a scene for many preloads, on one or several profiles, and writes the adhesion forces.
fn over_preloads(
    arguments: &RunArguments,
    document: &Document,
    format: Format,
    preloads: Preloads,
    stdout: &mut dyn Write,
) -> Result<(), CliError> {
    let (scene, choice) = arguments.scene_of(document)?;
    let forces = preloads.forces();
    let results = match arguments.lines {
        Some(lines) => {
            let (folder, lines) = (document.resolve(""), lines as usize);
            let solved =
                study::solve_preloads_on_lines(&scene, &folder, &forces, lines, threads(arguments.jobs));
            let solved = solved.map_err(|error| CliError::named(document.name(), error))?;
            solved.into_iter().map(|(seed, line)| (Some(seed), line)).collect()
        }
        None => {
            let mut line = Vec::with_capacity(forces.len());
            let mut simulation = simulation_of(document);
            study::solve_preloads(&mut simulation, &scene, &forces, &|| false, &mut |one| line.push(one))
                .map_err(|error| CliError::named(document.name(), error))?;
            vec![(scene.seed(), line)]
        }
    };
    let report = PreloadReport::new(&scene, results);
    if let Some(format) = format.table() {
        let write = |out: &mut dyn Write, provenance: &_| report.write_table(out, format, provenance);
        return arguments.output.write_table(stdout, (document, &scene), write);
    }
    match format {
        Format::Text => arguments.write_text(stdout, &report.text(), choice.as_ref()),
        Format::Json => arguments.output.write(stdout, |out| report.write_json(out)),
        _ => arguments.output.write_figure(stdout, &report.figure(document.title()), format),
    }
}

/// Computes a scene on several profiles and writes their results.
fn on_lines(
    arguments: &RunArguments,
    document: &Document,
    (scene, choice): (Scene, Option<&Choice>),
    (format, lines): (Format, u32),
    stdout: &mut dyn Write,
) -> Result<(), CliError> {
    let results = study::solve_lines(&scene, &document.resolve(""), lines as usize, threads(arguments.jobs))
        .map_err(|error| CliError::named(document.name(), error))?;
    if let Some(format) = format.table() {
        return arguments.output.write_table(stdout, (document, &scene), |out, provenance| {
            write_ensemble_table(out, format, provenance, &results)
        });
    }
    if format == Format::Json {
        let write = |out: &mut dyn Write| write_ensemble_json(out, &scene, choice, &results);
        return arguments.output.write(stdout, write);
    }
    arguments.write_text(stdout, &ensemble_text(&scene, &results), choice)
}
