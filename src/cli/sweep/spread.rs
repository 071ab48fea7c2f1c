//! `asperity sweep boundary --spread`: the spread of the boundaries of a study.

use super::{csv, markdown};
use crate::cli::CliError;
use crate::export::sheet::Sheet;
use crate::io::write_json_value;
use crate::study::{Boundaries, BoundarySpread, protocol_name};
use serde_json::{Map, Value, json};
use std::io::Write;

/// Writes the spread of the same boundaries in several parameters.
pub(super) fn write(stdout: &mut dyn Write, found: &[Boundaries], format: &str) -> Result<(), CliError> {
    let lines = found.first().map_or(0, |boundaries| boundaries.lines);
    match format {
        "text" => {
            let mut sheet = Sheet::default();
            sheet.table(&table(found));
            sheet.paragraph(&format!(
                "Largest over smallest boundary over {lines} random lines: of all, and of those that differ in one \
                 axis alone."
            ));
            stdout.write_all(sheet.into_text().as_bytes())?;
        }
        "json" => write_json_value(stdout, &objects(found))?,
        "csv" => stdout.write_all(csv(&table(found)).as_bytes())?,
        _ => stdout.write_all(markdown(&table(found)).replace('*', "\\*").as_bytes())?,
    }
    Ok(())
}

/// A heading, and one row for each protocol, share and parameter.
fn table(found: &[Boundaries]) -> Vec<Vec<String>> {
    let others = found.first().map_or(&[][..], |boundaries| &boundaries.others);
    let mut heading =
        ["protocol", "level", "boundary", "smallest", "largest", "ratio"].map(String::from).to_vec();
    heading.extend(others.iter().map(|name| format!("over {name}")));
    let mut rows = vec![heading];
    let spreads: Vec<_> = found.iter().map(Boundaries::spreads).collect();
    for place in 0..spreads.first().map_or(0, Vec::len) {
        for (boundaries, spreads) in found.iter().zip(&spreads) {
            let Some(spread) = spreads.get(place) else { continue };
            let mut row = vec![
                protocol_name(spread.protocol).to_string(),
                spread.level.to_string(),
                boundaries.symbol().to_string(),
            ];
            row.extend(numbers(spread));
            rows.push(row);
        }
    }
    rows
}

/// Ends of the range and ratios to two decimals; bounds if the study does not contain all boundaries.
fn numbers(spread: &BoundarySpread) -> Vec<String> {
    let bound = if spread.outside > 0 { "> " } else { "" };
    let (smallest, largest) = match spread.range {
        Some((smallest, largest)) if spread.outside == 0 => {
            (format!("{smallest:.2}"), format!("{largest:.2}"))
        }
        _ => ("outside".into(), "outside".into()),
    };
    let ratio =
        spread.range.map_or_else(|| "outside".into(), |(low, high)| format!("{bound}{:.2}", high / low));
    let along = spread.along.iter().map(|ratio| format!("{bound}{ratio:.2}"));
    [smallest, largest, ratio].into_iter().chain(along).collect()
}

fn objects(found: &[Boundaries]) -> Value {
    let of = |boundaries: &Boundaries| {
        let object = |spread: BoundarySpread| {
            let along: Map<_, _> = boundaries
                .others
                .iter()
                .cloned()
                .zip(spread.along.iter().map(|ratio| json!(ratio)))
                .collect();
            json!({
                "protocol": protocol_name(spread.protocol),
                "level": spread.level,
                "over": boundaries.over.name(),
                "range": spread.range.map(|(smallest, largest)| [smallest, largest]),
                "ratio": spread.range.map(|(smallest, largest)| largest / smallest),
                "ratio_over": along,
                "outside": spread.outside,
            })
        };
        boundaries.spreads().into_iter().map(object).collect::<Vec<_>>()
    };
    let lines = found.first().map_or(0, |boundaries| boundaries.lines);
    json!({ "lines": lines, "spreads": found.iter().flat_map(of).collect::<Vec<_>>() })
}
