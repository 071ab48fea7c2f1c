//! `asperity sweep boundary`: the boundary of vanishing zero-load adhesion.

use super::csv;
use crate::cli::CliError;
use crate::export::sheet::Sheet;
use crate::io::write_json_value;
use crate::scene::RoughnessParameter;
use crate::study::{Boundaries, Boundary, Crossing, DEFINITIONS, USUAL_LEVELS, boundaries, protocol_name};
use clap::Args;
use serde_json::{Map, Value, json};
use std::io::Write;
use std::path::PathBuf;

const EXAMPLES: &str = "\
Examples:
  asperity sweep equation-15 -o edge && asperity sweep boundary edge
  asperity sweep boundary edge --level 0.05 --format csv
  asperity sweep boundary edge --over elastic_energy_ratio

F_a(0) never quite vanishes: it falls about exponentially with κ. So κ* is where its mean over the
profiles falls below a share of F_a,max for good; intervals contain 95 % of 1000 resamplings of
the profiles.
With wave numbers in 1/m instead of rad/m the same κ* is √(2π) times smaller (kappa_cycles), with
amplitudes instead of root mean squares √2 times larger (kappa_amplitude).
A boundary in κ is one in e_el/γ as well, elastic energy of conformity over work of adhesion.";

/// Arguments of `sweep boundary`.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct BoundaryArguments {
    /// Folder of a merged study with an axis `kappa` or `elastic_energy_ratio`
    #[arg(value_name = "DIR")]
    pub folder: PathBuf,
    /// Threshold, as a share of F_a,max (repeatable)
    #[arg(long = "level", value_name = "SHARE", value_parser = level)]
    pub levels: Vec<f64>,
    /// Parameter of boundaries: kappa or elastic_energy_ratio
    #[arg(long, value_name = "PARAMETER", value_parser = over, default_value = "kappa")]
    pub over: RoughnessParameter,
    /// text, json or csv
    #[arg(long, value_parser = FORMATS, hide_possible_values = true, default_value = "text")]
    pub format: String,
}

/// Formats of boundaries: a table, one object, one row for each boundary.
const FORMATS: [&str; 3] = ["text", "json", "csv"];

fn level(text: &str) -> Result<f64, String> {
    let level = text.trim().parse::<f64>().ok().filter(|level| *level > 0.0 && *level < 1.0);
    level.ok_or_else(|| "allowed: a share above 0 and below 1, such as 0.05".to_string())
}

fn over(text: &str) -> Result<RoughnessParameter, String> {
    let parameter = RoughnessParameter::named(text.trim()).filter(|one| one.name() == text.trim());
    parameter.ok_or_else(|| {
        let names = RoughnessParameter::ALL.map(RoughnessParameter::name);
        format!("allowed: {}", names.join(", "))
    })
}

/// Finds the boundaries of a study and prints them.
pub(super) fn boundary(arguments: &BoundaryArguments, stdout: &mut dyn Write) -> Result<(), CliError> {
    let levels = if arguments.levels.is_empty() { USUAL_LEVELS.to_vec() } else { arguments.levels.clone() };
    let boundaries = boundaries(&arguments.folder, arguments.over, &levels)?;
    match arguments.format.as_str() {
        "json" => write_json_value(stdout, &object(&boundaries))?,
        "csv" => stdout.write_all(rows(&boundaries).as_bytes())?,
        _ => stdout.write_all(text(&boundaries).as_bytes())?,
    }
    Ok(())
}

/// Columns of a boundary in a parameter, each with its factor.
fn columns(over: RoughnessParameter) -> Vec<(&'static str, f64)> {
    match over {
        RoughnessParameter::Kappa => DEFINITIONS.to_vec(),
        RoughnessParameter::ElasticEnergyRatio => vec![(over.name(), 1.0)],
    }
}

/// A boundary, and its interval if there is one.
fn shown(crossing: Crossing) -> (String, String) {
    match crossing {
        Crossing::At(value, interval) => {
            let interval = interval.map_or_else(String::new, |(low, high)| format!("{low:.2} to {high:.2}"));
            (format!("{value:.2}"), interval)
        }
        Crossing::Below(smallest) => (format!("< {smallest:.2}"), String::new()),
        Crossing::Above(largest) => (format!("> {largest:.2}"), String::new()),
    }
}

fn text(boundaries: &Boundaries) -> String {
    let is_kappa = boundaries.over == RoughnessParameter::Kappa;
    let mut heading = boundaries.others.clone();
    heading.extend(["protocol", "level", boundaries.symbol(), "95 %"].map(String::from));
    heading.extend(is_kappa.then(|| "q in 1/m".into()));
    let mut rows = vec![heading];
    for Boundary { others, protocol: quantity, level, crossing } in &boundaries.found {
        let mut row: Vec<String> = others.iter().map(ToString::to_string).collect();
        let (value, interval) = shown(*crossing);
        let cycles = match *crossing {
            Crossing::At(kappa, _) => format!("{:.2}", DEFINITIONS[1].1 * kappa),
            _ => String::new(),
        };
        row.extend([protocol_name(*quantity).to_string(), level.to_string(), value, interval]);
        row.extend(is_kappa.then_some(cycles));
        rows.push(row);
    }
    let mut sheet = Sheet::default();
    sheet.table(&rows);
    let paper = if is_kappa { "; the paper gives 0.6" } else { "" };
    sheet.paragraph(&format!("{} over {} random profiles{paper}.", boundaries.symbol(), boundaries.lines));
    sheet.into_text()
}

fn object(boundaries: &Boundaries) -> Value {
    let found = boundaries.found.iter().map(|boundary| {
        let mut object = Map::new();
        for (name, value) in boundaries.others.iter().zip(&boundary.others) {
            object.insert(name.clone(), json!(value));
        }
        object.insert("protocol".into(), json!(protocol_name(boundary.protocol)));
        object.insert("level".into(), json!(boundary.level));
        match boundary.crossing {
            Crossing::At(value, interval) => {
                for (name, factor) in columns(boundaries.over) {
                    object.insert(name.into(), json!(factor * value));
                }
                let interval = interval.map(|(low, high)| [low, high]);
                object.insert("confidence_interval".into(), json!(interval));
            }
            Crossing::Below(smallest) => {
                object.insert("below".into(), json!(smallest));
            }
            Crossing::Above(largest) => {
                object.insert("above".into(), json!(largest));
            }
        }
        Value::Object(object)
    });
    json!({ "lines": boundaries.lines, "boundaries": found.collect::<Vec<_>>() })
}

fn rows(boundaries: &Boundaries) -> String {
    let of_parameter = columns(boundaries.over);
    let mut heading = boundaries.others.clone();
    heading.extend(["protocol", "level"].map(String::from));
    heading.extend(of_parameter.iter().map(|(name, _)| (*name).to_string()));
    heading.extend(["low", "high", "below", "above"].map(String::from));
    let mut rows = vec![heading];
    for Boundary { others, protocol: quantity, level, crossing } in &boundaries.found {
        let mut row: Vec<String> = others.iter().map(ToString::to_string).collect();
        row.extend([protocol_name(*quantity).to_string(), level.to_string()]);
        let (at, interval, below, above) = match *crossing {
            Crossing::At(value, interval) => (Some(value), interval, None, None),
            Crossing::Below(smallest) => (None, None, Some(smallest), None),
            Crossing::Above(largest) => (None, None, None, Some(largest)),
        };
        let mut numbers: Vec<_> =
            of_parameter.iter().map(|(_, factor)| at.map(|value| factor * value)).collect();
        numbers.extend([interval.map(|(low, _)| low), interval.map(|(_, high)| high), below, above]);
        row.extend(numbers.into_iter().map(|number| number.map_or_else(String::new, |n| n.to_string())));
        rows.push(row);
    }
    csv(&rows)
}
