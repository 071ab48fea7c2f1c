//! `asperity fit`: fits the parameters of a scene to a measured force curve.

use super::advice::option;
use super::ensemble::{EnsembleArguments, ensemble};
use super::error::CliError;
use super::fits::{Curves, fit_all, fit_together, show_curves};
use super::output::{Origin, OutputArguments, check_file};
use super::progress::{Task, watched};
use super::scene::{Overrides, open_scene, threads};
use crate::explorer::recognition::no_curve;
use asperity_data::{path_name, write_new};
use asperity_experiment::{CurveOptions, Fit, Free, MeasuredCurve, SeveralCurves};
use asperity_report::{FitReport, Format, Report, named_from};
use clap::Args;
use std::io;
use std::io::Write;
use std::path::{Path, PathBuf};

const EXAMPLES: &str = "\
Examples:
  asperity fit curve.csv jkr-sphere --free work,offset
  asperity fit curve.txt my-scene.ron --free work,modulus,offset --units nm,nN --tilt remove
  asperity fit curve.csv my-scene.ron --free work,modulus,offset --segments 2
  asperity fit curve.csv my-scene.ron --free work=1mJ/m^2..1J/m^2,offset -o fit.json
  asperity fit places/*.csv rough.ron --free work,modulus --profiles 128 --height-error 5%
  asperity fit curve.csv my-scene.ron --free work,offset --scene found.ron -o fit.svg
  asperity fit map/*.txt my-scene.ron --free work,modulus,offset -o all.csv --curves models
  asperity fit slow.csv fast.csv soft.ron --free work,offset,relaxation_share,relaxation_time

The curve is text, CSV or an array of NumPy: an approach, which begins before contact, and a
retraction, or only a retraction that ends without contact. The scene is the last argument. A
form.radius of two round bodies is R1 R2/(R1 + R2). Several curves, a folder of them, or a text
with several, such as a map, give a row each. A table (-o FILE.csv) that is not complete is
continued by the same command, and -o FILE.svg draws a map if the places are stated. JSON of
one curve is one object with the parameters and their errors; CSV and .npy hold the columns
displacement, force, model, residual and segment. docs/experiment.md lists the parameters.";

/// Arguments of `fit`.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES, override_usage = "asperity fit [OPTIONS] --free <NAME[=A..B]> <CURVE>... <SCENE>")]
pub struct FitArguments {
    /// Files of measured force curves or folders of them, and last the scene
    ///
    /// A scene file or a built-in scene: form, roughness and all values that are known.
    #[arg(value_name = "CURVE... SCENE", required = true)]
    pub files: Vec<PathBuf>,
    /// Changed fields of the scene.
    #[command(flatten)]
    pub overrides: Overrides,
    /// Parameters to be found, with ranges if known: work=1m..1,offset
    ///
    /// The parameters are work, closing_work, modulus, offset, zero, stiffness and radius.
    ///
    /// A probe of several spheres has second_radius and behind of the second one too.
    ///
    /// A half-space that relaxes has relaxation_share and relaxation_time.
    ///
    /// Several files are then curves of one specimen, and share all but offset and zero.
    #[arg(
        long,
        required = true,
        value_name = "NAME[=A..B]",
        value_delimiter = ',',
        num_args = 1
    )]
    pub free: Vec<Free>,
    /// How curves are read.
    #[command(flatten)]
    pub reading: CurveOptions,
    /// Comparison with many random profiles.
    #[command(flatten)]
    pub ensemble: EnsembleArguments,
    /// Threads that share curves or profiles; default: one for each core
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub jobs: Option<u16>,
    /// Write a table of force and model of each curve to FOLDER
    ///
    /// The columns are displacement, force, model, residual and segment, in SI units.
    #[arg(long, value_name = "FOLDER", group = "written")]
    pub curves: Option<PathBuf>,
    /// Write the scene with the values found to FILE
    #[arg(long, value_name = "FILE", group = "written")]
    pub scene: Option<PathBuf>,
    /// Output file.
    #[command(flatten)]
    pub output: OutputArguments,
}

pub(super) fn fit(arguments: &FitArguments, stdout: &mut dyn Write) -> Result<(), CliError> {
    let FitArguments {
        files,
        overrides,
        free,
        reading,
        jobs,
        output,
        ensemble: compared,
        ..
    } = arguments;
    let Some((scene, paths)) = files.split_last().filter(|(_, paths)| !paths.is_empty()) else {
        let only = files
            .first()
            .map(|path| path_name(path))
            .unwrap_or_default();
        return Err(CliError::named(
            only,
            "one file; allowed: a curve or several, and last the scene",
        ));
    };
    let scene = scene.to_string_lossy();
    let curves = Curves {
        paths,
        scene: &scene,
        overrides,
        free,
        reading,
        jobs: *jobs,
        tables: arguments.curves.as_deref(),
        output,
    };
    let has_one = |path: &PathBuf| !path.is_dir() && SeveralCurves::read(path, reading).is_none();
    let is_one = paths.len() == 1 && has_one(&paths[0]);
    if arguments.scene.is_some() && !(is_one && compared.lines.is_none()) {
        let fault =
            "several curves or profiles; allowed: a fit of one curve, whose scene is written";
        return Err(CliError::named("--scene", fault));
    }
    if arguments.curves.is_some() && (is_one || compared.lines.is_some()) {
        let fault = "one curve, or a comparison with random profiles; allowed: separate fits of several curves; -o FILE.csv \
                     has the model of one";
        return Err(CliError::named("--curves", fault));
    }
    if let Some(lines) = compared.lines {
        return ensemble(&curves, compared, lines, stdout);
    }
    let relaxes = free.iter().any(|free| free.parameter.is_of_relaxation());
    match paths {
        [path] if is_one => fit_one(arguments, &curves, path, stdout),
        [_, _, ..] if relaxes && paths.iter().all(has_one) => fit_together(&curves, stdout),
        _ => fit_all(&curves, stdout),
    }
}

/// Fits the scene to a single curve.
fn fit_one(
    arguments: &FitArguments,
    curves: &Curves<'_>,
    path: &Path,
    stdout: &mut dyn Write,
) -> Result<(), CliError> {
    let output = &arguments.output;
    let format = output.format(&Format::ALL, Format::Text)?;
    if let Some(file) = &arguments.scene {
        check_file(file, "ron", output.force)?;
    }
    let document = arguments.overrides.apply(open_scene(curves.scene)?)?;
    let title = path_name(path);
    let reading = curves.reading_for(&document);
    let curve = MeasuredCurve::read(path, &reading)
        .map_err(|error| CliError::named(&title, no_curve(path, &error, option)))?;
    let mut fit = Fit::of(&document);
    for parameter in &arguments.free {
        fit = fit.free(*parameter);
    }
    let task = Task {
        name: Some(document.name()),
        threads: threads(None),
        begins: "0 curves computed".to_owned(),
    };
    let found = watched(task, show_curves, |control| fit.run(&curve, control))?;
    if let Some(file) = &arguments.scene {
        let folder = file.parent().unwrap_or(Path::new(""));
        let fitted = found
            .document
            .moved_to(|measured| named_from(measured, &document.resolve(""), folder))?;
        write_new(file, output.force, |out| {
            out.write_all(fitted.text().as_bytes())
        })?;
    }
    let report = FitReport {
        wording: option,
        title: &title,
        curve: &curve,
        fit: &found,
    };
    let origin = Origin::Scene(&document, found.document.scene());
    output.write(stdout, &report, format, origin)?;
    let leaves_out_words = output.file().is_some() && format != Format::Text;
    if leaves_out_words && let Some(text) = report.text() {
        // An error in writing to standard error is ignored, so that the file is written in any
        // case.
        let _ = io::stderr().write_all(text.as_bytes());
    }
    Ok(())
}
