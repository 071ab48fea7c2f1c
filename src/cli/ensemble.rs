//! `asperity fit … --profiles`: finds the work of adhesion of a rough body by comparing its
//! measured curves with computed curves of random profiles.

use super::advice::option;
use super::error::CliError;
use super::fits::{Curves, show_curves};
use super::output::Origin;
use super::progress::{Task, watched};
use super::scene::{open_scene, threads, warn_beside};
use crate::explorer::recognition::no_curve;
use asperity_data::{Remedied, parse_quantity, printable};
use asperity_experiment::{CurveSource, EnsembleOptions, Free, Parameter, fit_ensemble};
use asperity_report::{EnsembleFitReport, Format};
use asperity_scene::Simulation;
use clap::Args;
use std::io::Write;

/// Number of random profiles if the user gives `--profiles` without a number.
const LINES: &str = "128";

/// Arguments of a comparison with random profiles.
#[derive(Args, Debug)]
pub struct EnsembleArguments {
    /// Compare the curves with COUNT random profiles; default: 128
    ///
    /// One work of adhesion for all curves of a rough body of unknown profile, each at a place of
    /// its own. --free work, or work,modulus; the displacement at first touch does not matter.
    #[arg(
        long = "profiles",
        verbatim_doc_comment,
        value_name = "COUNT",
        num_args = 0..=1,
        default_missing_value = LINES,
        value_parser = clap::value_parser!(u32).range(16..=4096)
    )]
    pub lines: Option<u32>,
    /// Standard error of the rms height, as a share: 0.05, 5%
    #[arg(long, value_name = "SHARE", requires = "lines", value_parser = share)]
    pub height_error: Option<f64>,
    /// Standard error of the Hurst exponent: 0.03
    #[arg(long, value_name = "ERROR", requires = "lines", value_parser = share)]
    pub hurst_error: Option<f64>,
}

fn share(text: &str) -> Result<f64, String> {
    parse_quantity(text, "1")
        .ok()
        .filter(|value| (0.0..=0.5).contains(value))
        .ok_or_else(|| "allowed: from 0 to 0.5, such as 0.05 or 5%".to_owned())
}

impl EnsembleArguments {
    /// Returns the options for a comparison with `lines` random profiles.
    ///
    /// # Errors
    /// Returns an error for a free parameter that a comparison with random profiles cannot
    /// determine.
    pub fn options(&self, free: &[Free], lines: u32) -> Result<EnsembleOptions, CliError> {
        use Parameter::{Modulus, Offset, Work};
        let allowed = "allowed with --profiles: work, modulus, offset, each without a range";
        for one in free {
            if ![Work, Modulus, Offset].contains(&one.parameter) || one.range().is_some() {
                return Err(CliError::named(
                    "--free",
                    format!("{}; {allowed}", one.parameter.name()),
                ));
            }
        }
        if !free.iter().any(|one| one.parameter == Work) {
            return Err(CliError::named(
                "--free",
                format!("work is missing; {allowed}"),
            ));
        }
        let EnsembleArguments {
            height_error,
            hurst_error,
            ..
        } = *self;
        let is_modulus_free = free.iter().any(|one| one.parameter == Modulus);
        Ok(EnsembleOptions {
            profiles: u64::from(lines),
            is_modulus_free,
            height_error,
            hurst_error,
        })
    }
}

/// Compares measured curves with computed curves of `lines` random profiles, and writes the result
/// to the destination that the user has chosen.
pub(super) fn ensemble(
    arguments: &Curves<'_>,
    compared: &EnsembleArguments,
    lines: u32,
    stdout: &mut dyn Write,
) -> Result<(), CliError> {
    let format = arguments.output.format(&Format::ALL, Format::Text)?;
    let options = compared.options(arguments.free, lines)?;
    if arguments.reading.noise.is_some() {
        let refused = "not with --profiles, whose computed curves have the noise before contact; allowed: without it";
        return Err(CliError::named("--noise", refused));
    }
    let document = arguments.overrides.apply(open_scene(arguments.scene)?)?;
    let reading = arguments.reading_for(&document);
    let mut curves = Vec::new();
    let skipped = arguments.output.file();
    let sources = CurveSource::all(arguments.paths, skipped, &reading)
        .map_err(|error| CliError::message(error.in_words(option)))?;
    for source in sources {
        let name = printable(&source.name()).into_owned();
        match source.read(&reading) {
            Ok(placed) => curves.push((name, placed.curve)),
            Err(error) => {
                return Err(CliError::named(
                    &name,
                    no_curve(source.path(), &error, option),
                ));
            }
        }
    }
    let task = Task {
        name: Some(document.name()),
        threads: threads(arguments.jobs),
        begins: "0 curves computed".to_owned(),
    };
    let simulation = Simulation::new(document.resolve(""));
    let found = watched(task, show_curves, |control| {
        fit_ensemble(&curves, &document, &options, &simulation, control)
    })?;
    let report = EnsembleFitReport {
        wording: option,
        title: document.title(),
        fit: &found,
        has_roughness_errors: options.height_error.is_some() || options.hurst_error.is_some(),
    };
    arguments.output.write(
        stdout,
        &report,
        format,
        Origin::Scene(&document, document.scene()),
    )?;
    warn_beside(&document, &report, format);
    Ok(())
}
