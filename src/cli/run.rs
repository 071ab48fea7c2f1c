//! `asperity run`: computes a scene without a terminal.

use super::preloads::parse_preloads;
use super::scene::{MOST_LINES, simulation_of};
use super::{
    Arguments, CliError, Command, OutputArguments, SceneArguments, SurfaceArguments, SurfaceFormat, surface,
};
use crate::accuracy::{Choice, Estimate, choose, estimate, parse_tolerance};
use crate::contact::{LegRecord, Solver};
use crate::draw::{Figure, figure_png, figure_svg};
use crate::export::{
    ContactSets, PreloadReport, TableFormat, ensemble_text, force_figure, summary, write_curve,
    write_ensemble_json, write_ensemble_table, write_json, write_line,
};
use crate::scene::{Document, Scene, SpectraTable, TableContent, open_argument};
use crate::simulation::Outcome;
use crate::study::{self, Preloads};
use crate::text::path_name;
use clap::{Args, Parser, ValueEnum};
use std::io::{self, Write};
use std::path::Path;
use std::thread::available_parallelism;

const EXAMPLES: &str = "\
Examples:
  asperity run pressure-sensitive
  asperity run my-scene.ron --set adhesion.work=0.1 --format json | jq .adhesion_force
  asperity run jkr-sphere --set numerics.points=65536 -o jkr.csv
  asperity run jkr.csv -o again.npy
  asperity run jkr-sphere --tolerance 0.1%
  asperity run pressure-sensitive --lines 32 --format csv
  asperity run pressure-sensitive --preloads 0..20uN --lines 16
  asperity run pressure-sensitive -o loop.svg
  asperity run pressure-sensitive --profile -o profile.svg
  asperity run ideal-adhesion pressure-sensitive non-adhesive -o loops.svg

JSON, CSV and .npy are in SI units. Compression is positive, indentation counts from first touch.
CSV and .npy hold version, scene and seed: such a file is a scene, and run computes its table again.";

/// Arguments of `run`.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct RunArguments {
    /// The scene.
    #[command(flatten)]
    pub scene: SceneArguments,
    /// More scenes, whose force curves are drawn into the same picture
    #[arg(value_name = "SCENE")]
    pub more: Vec<String>,
    /// summary, json, csv, npy, svg or png; default: by the extension of FILE
    ///
    /// A summary is text for a person. JSON is one object with scene, profile, figures, curve,
    /// contacts and work. CSV is the curve: leg,indentation,force,contact_length,fragments.
    /// npy is the same as a structured array of NumPy. SVG and PNG are pictures of the curve.
    #[arg(long, value_enum, hide_possible_values = true, verbatim_doc_comment)]
    pub format: Option<RunFormat>,
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
    /// Destination.
    #[command(flatten)]
    pub output: OutputArguments,
}

/// Formats of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum RunFormat {
    /// Text for a person: line, regime and why, forces, work and time.
    Summary,
    /// One object with everything: scene, line, figures, curve, contacts, work.
    Json,
    /// The force curve.
    Csv,
    /// The force curve as an array of NumPy.
    Npy,
    /// A picture of the force curve, the profile or the contact patches, as lines.
    Svg,
    /// The same picture as pixels.
    Png,
}

/// Endings of files in each format.
const ENDINGS: [(&str, RunFormat); 5] = [
    ("json", RunFormat::Json),
    ("csv", RunFormat::Csv),
    ("npy", RunFormat::Npy),
    ("svg", RunFormat::Svg),
    ("png", RunFormat::Png),
];

impl RunFormat {
    fn is_picture(self) -> bool {
        matches!(self, RunFormat::Svg | RunFormat::Png)
    }

    /// Format of a table.
    fn of_table(self) -> Option<TableFormat> {
        match self {
            RunFormat::Csv => Some(TableFormat::Csv),
            RunFormat::Npy => Some(TableFormat::Npy),
            RunFormat::Summary | RunFormat::Json | RunFormat::Svg | RunFormat::Png => None,
        }
    }
}

impl RunArguments {
    /// Threads that share the profiles.
    fn threads(&self) -> usize {
        self.jobs.map_or_else(|| available_parallelism().map_or(1, std::num::NonZero::get), usize::from)
    }

    fn chosen_format(&self) -> Result<RunFormat, CliError> {
        let needs_picture = [
            (!self.more.is_empty(), "several scenes"),
            (self.profile, "--profile"),
            (self.fragments, "--fragments"),
        ];
        let needs_picture = needs_picture.into_iter().find(|(is_asked, _)| *is_asked);
        self.output.check_binary(self.format == Some(RunFormat::Png))?;
        let usual = if needs_picture.is_some() { RunFormat::Svg } else { RunFormat::Summary };
        let format = self.output.format(self.format, &ENDINGS, usual)?;
        match needs_picture {
            Some((_, what)) if !format.is_picture() => Err(CliError::OnlyInPicture { what }),
            _ if format == RunFormat::Npy && self.preloads.is_some() => Err(CliError::NoPicture {
                what: "--preloads",
                allowed: "allowed: summary, json, csv, svg and png",
            }),
            _ if format.is_picture() && self.lines.is_some() && self.preloads.is_none() => {
                Err(CliError::NoPicture {
                    what: "--lines",
                    allowed: "a picture shows one profile; allowed: summary, json, csv and npy",
                })
            }
            _ => Ok(format),
        }
    }
}

/// Computes a scene and writes what it gave.
pub(super) fn run(arguments: &RunArguments, stdout: &mut dyn Write) -> Result<(), CliError> {
    let format = arguments.chosen_format()?;
    if let Some(again) = surface_again(arguments, format)? {
        return surface::surface(&again, stdout);
    }
    let document = arguments.scene.open()?;
    document.check_measured_files()?;
    arguments.output.check()?;
    if let Some(preloads) = arguments.preloads {
        return over_preloads(arguments, &document, (format, preloads), stdout);
    }
    if format.is_picture() {
        let figure = figure(arguments, document)?;
        let picture = match format {
            RunFormat::Png => figure_png(&figure)?,
            _ => figure_svg(&figure).into_bytes(),
        };
        return arguments.output.write(stdout, |out| out.write_all(&picture));
    }
    let choice = arguments.tolerance.map(|tolerance| choice(&document, tolerance)).transpose()?;
    let chosen = choice.as_ref().map(|choice| choice.apply(document.scene()));
    let scene = chosen.as_ref().unwrap_or(document.scene());
    let of_table = match document.table_content() {
        Some(TableContent::RandomProfiles(count)) => Some(count),
        _ => None,
    };
    if let Some(lines) = arguments.lines.or(of_table) {
        return on_lines(arguments, &document, scene, (format, choice.as_ref()), lines, stdout);
    }
    let failed = |error| CliError::Run { scene: document.name().into(), error };
    if let (Some(format), Some(TableContent::Profile)) = (format.of_table(), document.table_content()) {
        let mut simulation = simulation_of(&document);
        let (line, ..) = simulation.make_line(scene).map_err(failed)?;
        let provenance = arguments.output.provenance(&document, scene, TableContent::Profile)?;
        return arguments.output.write(stdout, |out| write_line(out, format, &provenance, line));
    }
    let outcome = simulation_of(&document).run(scene, &|| false, &mut |_, _, _| Ok(())).map_err(failed)?;
    let choice = choice.as_ref();
    let estimate = estimate_for(format, &document, scene, &outcome, choice)?;
    if let Some(format) = format.of_table() {
        let provenance = arguments.output.provenance(&document, scene, TableContent::ForceCurve)?;
        return arguments.output.write(stdout, |out| write_curve(out, format, &provenance, &outcome));
    }
    arguments.output.write(stdout, |out| match format {
        RunFormat::Json => write_json(out, scene, &outcome, choice, estimate.as_ref()),
        _ => {
            out.write_all(summary(scene, &outcome, estimate.as_ref()).as_bytes())?;
            choice.map_or(Ok(()), |choice| writeln!(out, "\n{}", choice.sentence()))
        }
    })
}

/// Arguments of `surface` where the scene is a table of spectra.
fn surface_again(arguments: &RunArguments, format: RunFormat) -> Result<Option<SurfaceArguments>, CliError> {
    let path = Path::new(&arguments.scene.scene);
    let Some(SpectraTable { arguments: deciding, measured }) = SpectraTable::open(path) else {
        return Ok(None);
    };
    let refused = |reason: String| CliError::Spectra { file: path_name(path), reason };
    let named = ["asperity", "surface"].map(str::to_owned).into_iter().chain(deciding);
    let parsed = Arguments::try_parse_from(named).map_err(|error| refused(error.kind().to_string()))?;
    let Some(Command::Surface(surface)) = parsed.command else { return Ok(None) };
    let others = [
        (!arguments.scene.overrides.set.is_empty(), "--set"),
        (!arguments.more.is_empty(), "several scenes"),
        (arguments.profile, "--profile"),
        (arguments.fragments, "--fragments"),
        (arguments.tolerance.is_some(), "--tolerance"),
        (arguments.lines.is_some(), "--lines"),
    ];
    if let Some((_, what)) = others.into_iter().find(|(is_given, _)| *is_given) {
        return Err(refused(format!("spectra have no {what}; allowed: --format and -o")));
    }
    let format = match format {
        RunFormat::Summary => SurfaceFormat::Summary,
        RunFormat::Json => SurfaceFormat::Json,
        RunFormat::Csv => SurfaceFormat::Csv,
        RunFormat::Npy => SurfaceFormat::Npy,
        RunFormat::Svg => SurfaceFormat::Svg,
        RunFormat::Png => {
            return Err(refused(
                "spectra are not drawn as PNG; allowed: summary, json, csv, npy and svg".to_owned(),
            ));
        }
    };
    let folder = path.parent().unwrap_or(Path::new("")).to_path_buf();
    measured.iter().try_for_each(|hash| hash.check(&folder, &path_name(path)))?;
    Ok(Some(SurfaceArguments { format: Some(format), output: arguments.output.clone(), folder, ..surface }))
}

/// Computes the scenes and draws what is asked for.
fn figure(arguments: &RunArguments, document: Document) -> Result<Figure, CliError> {
    let more = arguments.more.iter().map(|scene| arguments.scene.overrides.apply(open_argument(scene)?));
    let documents = std::iter::once(Ok(document)).chain(more).collect::<Result<Vec<_>, CliError>>()?;
    let mut computed = Vec::new();
    for document in &documents {
        let choice = arguments.tolerance.map(|tolerance| choice(document, tolerance)).transpose()?;
        let chosen = choice.as_ref().map(|choice| choice.apply(document.scene()));
        let scene = chosen.as_ref().unwrap_or(document.scene());
        let failed = |error| CliError::Run { scene: document.name().into(), error };
        let title = if scene.title.is_empty() { document.name() } else { scene.title.as_str() }.to_owned();
        let mut simulation = simulation_of(document);
        if !(arguments.profile || arguments.fragments) {
            let outcome = simulation.run(scene, &|| false, &mut |_, _, _| Ok(())).map_err(failed)?;
            computed.push((title, outcome));
            continue;
        }
        let mut sets = ContactSets::new(arguments.fragments);
        let mut observe = |_, record: &LegRecord, solver: &dyn Solver| sets.observe(record, solver);
        let outcome = simulation.run(scene, &|| false, &mut observe).map_err(failed)?;
        if arguments.fragments {
            return Ok(sets.patches_figure(&title, &outcome));
        }
        let (line, ..) = simulation.make_line(scene).map_err(failed)?;
        return Ok(sets.profile_figure(&title, &outcome, line));
    }
    let scenes: Vec<_> = computed.iter().map(|(title, outcome)| (title.as_str(), outcome)).collect();
    Ok(force_figure(&scenes))
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
        (RunFormat::Csv | RunFormat::Npy | RunFormat::Svg | RunFormat::Png, _) => Ok(None),
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

/// Computes a scene for many preloads, on one or several profiles, and writes the adhesion forces.
fn over_preloads(
    arguments: &RunArguments,
    document: &Document,
    (format, preloads): (RunFormat, Preloads),
    stdout: &mut dyn Write,
) -> Result<(), CliError> {
    let choice = arguments.tolerance.map(|tolerance| choice(document, tolerance)).transpose()?;
    let chosen = choice.as_ref().map(|choice| choice.apply(document.scene()));
    let scene = chosen.as_ref().unwrap_or(document.scene());
    let (forces, name) = (preloads.forces(), || document.name().into());
    let results = match arguments.lines {
        Some(lines) => {
            let (folder, lines) = (document.resolve(""), lines as usize);
            let solved = study::solve_preloads_on_lines(scene, &folder, &forces, lines, arguments.threads());
            let solved = solved.map_err(|error| CliError::Lines { scene: name(), error })?;
            solved.into_iter().map(|(seed, line)| (Some(seed), line)).collect()
        }
        None => {
            let mut line = Vec::with_capacity(forces.len());
            let mut simulation = simulation_of(document);
            study::solve_preloads(&mut simulation, scene, &forces, &|| false, &mut |one| line.push(one))
                .map_err(|error| CliError::Run { scene: name(), error })?;
            vec![(scene.seed(), line)]
        }
    };
    let report = PreloadReport::new(scene, results);
    let title = if scene.title.is_empty() { document.name() } else { &scene.title };
    arguments.output.write(stdout, |out| match format {
        RunFormat::Summary => {
            out.write_all(report.text().as_bytes())?;
            choice.as_ref().map_or(Ok(()), |choice| writeln!(out, "\n{}", choice.sentence()))
        }
        RunFormat::Json => report.write_json(out),
        RunFormat::Csv | RunFormat::Npy => report.write_csv(out),
        RunFormat::Svg => out.write_all(figure_svg(&report.figure(title)).as_bytes()),
        RunFormat::Png => out.write_all(&figure_png(&report.figure(title)).map_err(io::Error::other)?),
    })
}

/// Computes a scene on several lines and writes what they gave.
fn on_lines(
    arguments: &RunArguments,
    document: &Document,
    scene: &Scene,
    (format, choice): (RunFormat, Option<&Choice>),
    lines: u32,
    stdout: &mut dyn Write,
) -> Result<(), CliError> {
    let results = study::solve_lines(scene, &document.resolve(""), lines as usize, arguments.threads())
        .map_err(|error| CliError::Lines { scene: document.name().into(), error })?;
    if let Some(format) = format.of_table() {
        let provenance = arguments.output.provenance(document, scene, TableContent::RandomProfiles(lines))?;
        return arguments
            .output
            .write(stdout, |out| write_ensemble_table(out, format, &provenance, &results));
    }
    arguments.output.write(stdout, |out| match format {
        RunFormat::Json => write_ensemble_json(out, scene, choice, &results),
        _ => {
            out.write_all(ensemble_text(scene, &results).as_bytes())?;
            choice.map_or(Ok(()), |choice| writeln!(out, "\n{}", choice.sentence()))
        }
    })
}
