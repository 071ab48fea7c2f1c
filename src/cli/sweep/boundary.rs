//! `asperity sweep boundary`: finds the value of κ or e_el/γ at which adhesion without a preload
//! vanishes.

use crate::cli::error::CliError;
use crate::cli::output::{Origin, OutputArguments, WITHOUT_PICTURE, only_formats};
use asperity_report::Format;
use asperity_scene::RoughnessParameter;
use asperity_study::maps::Boundaries;
use clap::Args;
use std::io::Write;
use std::path::PathBuf;

const EXAMPLES: &str = "\
Examples:
  asperity sweep equation-15 -o edge && asperity sweep boundary edge
  asperity sweep boundary edge --where 0.05 --format csv
  asperity sweep boundary edge --x elastic_energy_ratio

F_a(d=0) never quite vanishes: it falls about exponentially with κ. So κ* is where its mean over
the profiles falls below a share of F_a,max for good; intervals contain 95 % of 1000 resamplings of
the profiles.
--x gives the boundary in e_el/γ: elastic energy to flatten the roughness over work of adhesion.";

#[derive(Args, Debug)]
#[command(after_help = EXAMPLES, mut_args(only_formats(WITHOUT_PICTURE)))]
pub struct BoundaryArguments {
    /// Study after `sweep merge`, with an axis adhesion.kappa or adhesion.elastic_energy_ratio
    #[arg(value_name = "DIR")]
    pub folder: PathBuf,
    /// Where F_a(d=0) falls below this share of F_a,max: 0.05 (repeatable)
    #[arg(long = "where", value_name = "SHARE", value_parser = level)]
    pub levels: Vec<f64>,
    /// Parameter of boundaries: kappa or elastic_energy_ratio
    #[arg(
        long,
        value_enum,
        value_name = "PARAMETER",
        default_value = "kappa",
        hide_possible_values = true
    )]
    pub x: RoughnessParameter,
    #[command(flatten)]
    pub output: OutputArguments,
}

fn level(text: &str) -> Result<f64, String> {
    let level = text
        .trim()
        .parse::<f64>()
        .ok()
        .filter(|level| *level > 0.0 && *level < 1.0);
    level.ok_or_else(|| "allowed: a share above 0 and below 1, such as 0.05".to_string())
}

pub(super) fn boundary(
    arguments: &BoundaryArguments,
    stdout: &mut dyn Write,
) -> Result<(), CliError> {
    let format = arguments.output.format(WITHOUT_PICTURE, Format::Text)?;
    let levels = if arguments.levels.is_empty() {
        Boundaries::USUAL_LEVELS.to_vec()
    } else {
        arguments.levels.clone()
    };
    let boundaries = Boundaries::of(&arguments.folder, arguments.x, &levels)?;
    arguments
        .output
        .write(stdout, &boundaries, format, Origin::Files(&[]))
}
