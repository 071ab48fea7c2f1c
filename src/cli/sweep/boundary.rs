//! `asperity sweep boundary`: the boundary of vanishing zero-load adhesion.

use super::{csv, markdown, spread};
use crate::cli::CliError;
use crate::export::sheet::Sheet;
use crate::io::write_json_value;
use crate::scene::RoughnessParameter;
use crate::study::{
    Boundaries, Boundary, Crossing, DEFINITIONS, Quantity, USUAL_LEVELS, boundaries, protocol_name,
};
use clap::Args;
use serde_json::{Map, Value, json};
use std::io::Write;
use std::path::PathBuf;

const EXAMPLES: &str = "\
Examples:
  asperity sweep equation-15 -o edge && asperity sweep boundary edge
  asperity sweep boundary edge --level 0.05 --format csv
  asperity sweep boundary edge --level 0.5 --level 0.1 --format markdown
  asperity sweep boundary edge --over elastic_energy_ratio
  asperity sweep boundary edge --spread --level 0.1

F_a(0) never quite vanishes: it falls about exponentially with κ. So κ* is where its mean over the
lines falls below a share of F_a,max for good; intervals hold 95 % of 1000 resamplings of the lines.
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
    /// Share of F_a,max below which adhesion has vanished, as often as needed
    #[arg(long = "level", value_name = "SHARE", value_parser = level)]
    pub levels: Vec<f64>,
    /// Parameter of boundaries: kappa or elastic_energy_ratio
    #[arg(long, value_name = "PARAMETER", value_parser = over, default_value = "kappa")]
    pub over: RoughnessParameter,
    /// Print the spread of the boundaries, in κ and in e_el/γ
    #[arg(long, conflicts_with = "over")]
    pub spread: bool,
    /// text, json, csv or markdown
    #[arg(long, value_parser = FORMATS, hide_possible_values = true, default_value = "text")]
    pub format: String,
}

/// Formats of boundaries: a table, one object, one row for each boundary, tables for a document.
const FORMATS: [&str; 4] = ["text", "json", "csv", "markdown"];

fn level(text: &str) -> Result<f64, String> {
    let level = text.trim().parse::<f64>().ok().filter(|level| *level > 0.0 && *level < 1.0);
    level.ok_or_else(|| "allowed: a share above 0 and below 1, such as 0.05".to_string())
}

fn over(text: &str) -> Result<RoughnessParameter, String> {
    let parameter = RoughnessParameter::ALL.into_iter().find(|parameter| parameter.name() == text.trim());
    parameter.ok_or_else(|| {
        let names = RoughnessParameter::ALL.map(RoughnessParameter::name);
        format!("allowed: {}", names.join(", "))
    })
}

/// Finds the boundaries of a study and prints them.
pub(super) fn boundary(arguments: &BoundaryArguments, stdout: &mut dyn Write) -> Result<(), CliError> {
    let levels = if arguments.levels.is_empty() { USUAL_LEVELS.to_vec() } else { arguments.levels.clone() };
    if arguments.spread {
        let found = RoughnessParameter::ALL.map(|over| boundaries(&arguments.folder, over, &levels));
        let found = found.into_iter().collect::<Result<Vec<_>, _>>()?;
        return spread::write(stdout, &found, &arguments.format);
    }
    let boundaries = boundaries(&arguments.folder, arguments.over, &levels)?;
    match arguments.format.as_str() {
        "text" => stdout.write_all(text(&boundaries).as_bytes())?,
        "json" => write_json_value(stdout, &object(&boundaries))?,
        "csv" => stdout.write_all(rows(&boundaries).as_bytes())?,
        _ => stdout.write_all(tables(&boundaries, &levels).as_bytes())?,
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
    sheet.paragraph(&format!("{} over {} random lines{paper}.", boundaries.symbol(), boundaries.lines));
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

/// One table for each share: the first axis down, protocols and other axes across.
fn tables(boundaries: &Boundaries, levels: &[f64]) -> String {
    let Boundaries { others, found, .. } = boundaries;
    let down = |boundary: &Boundary| boundary.others.first().copied();
    let (mut rows, mut columns) = (Vec::new(), Vec::new());
    for protocol in Quantity::ADHESION_SHARES {
        for boundary in found.iter().filter(|boundary| boundary.protocol == protocol) {
            let column = (protocol, boundary.others.get(1..).unwrap_or_default());
            if !columns.contains(&column) {
                columns.push(column);
            }
            if !rows.contains(&down(boundary)) {
                rows.push(down(boundary));
            }
        }
    }
    let heading = |(one, values): &(Quantity, &[f64])| {
        let values = others.iter().skip(1).zip(*values).map(|(name, value)| format!(", {name} = {value}"));
        format!("{}{}", protocol_name(*one), values.collect::<String>())
    };
    let name = others.first().cloned().unwrap_or_default();
    let headings: Vec<String> = std::iter::once(name).chain(columns.iter().map(heading)).collect();
    let mut tables = Vec::new();
    for level in levels {
        let boundary = boundaries.symbol();
        let mut table = vec![headings.clone()];
        for row in &rows {
            let mut cells = vec![row.map_or_else(|| boundary.to_string(), |value| value.to_string())];
            for (protocol, values) in &columns {
                let here = found.iter().find(|boundary| {
                    let place = (down(boundary), boundary.others.get(1..).unwrap_or_default());
                    boundary.protocol == *protocol && boundary.level == *level && place == (*row, values)
                });
                let (value, interval) = here.map(|boundary| shown(boundary.crossing)).unwrap_or_default();
                let interval = interval.replace(" to ", "–");
                cells.push(if interval.is_empty() { value } else { format!("{value} ({interval})") });
            }
            table.push(cells);
        }
        let table = markdown(&table);
        tables.push(format!("{boundary} at which F_a(0) falls below {level} F_a,max:\n\n{table}"));
    }
    tables.join("\n").replace('*', "\\*")
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
