//! Cost of accuracy as text, JSON and CSV.

use super::sheet::Sheet;
use crate::accuracy::{CostTable, ErrorFigure, Knob, QUANTITIES, Row};
use crate::io::write_json_value;
use crate::scene::{Scene, format_quantity, format_rounded};
use crate::text::grouped;
use serde::Serialize;
use std::io::{self, Write};

/// Headings of the errors, in the order of [`QUANTITIES`].
const ERRORS: [&str; 4] = ["F_a", "curve", "energy", "contact"];

/// The table in plain text of at most a hundred columns: the answer first, omitted settings last.
#[must_use]
pub fn cost_text(table: &CostTable) -> String {
    let mut sheet = Sheet::default();
    table.answer().iter().for_each(|sentence| sheet.paragraph(sentence));
    sheet.heading("Relative errors, with the observed order of convergence since the row before");
    sheet.paragraph(&counted_from(table));
    for knob in Knob::ALL {
        let rows: Vec<_> = table.rows_of(knob).collect();
        if rows.is_empty() {
            continue;
        }
        let mut setting = "springs";
        let mut heading = format!("With {}", knob.name());
        if knob == Knob::Step {
            setting = "step";
            let springs = grouped(rows.first().map_or(0, |row| row.springs));
            heading += &format!(", from the exact solver on the same {springs} springs, edges Grid");
        }
        sheet.heading(&heading);
        let mut lines = vec![
            [setting, "least", "median", "FFTs", ERRORS[0], ERRORS[1], ERRORS[2], ERRORS[3]]
                .map(String::from),
        ];
        lines.extend(rows.iter().map(|row| cells(row)));
        sheet.table(&lines);
    }
    sheet.heading("Time");
    sheet.paragraph(&format!(
        "Whole runs with everything made anew, of which the least and the median; one FFT is a real \
         one of 2^20 points, {}.",
        format_rounded(table.transform_seconds, 3, "s")
    ));
    let (spent, budget) = (format_rounded(table.spent, 3, "s"), format_rounded(table.budget, 3, "s"));
    sheet.paragraph(&format!("Taken {spent} of {budget}."));
    if table.left_out.is_empty() {
        sheet.paragraph("Everything was affordable.");
    } else {
        sheet.paragraph(&format!("Not affordable within {budget}:"));
        table.left_out.iter().for_each(|what| sheet.paragraph(&format!("- {what}")));
    }
    sheet.into_text()
}

fn counted_from(table: &CostTable) -> String {
    let reference = &table.reference;
    let finest = format!("the solution with {} springs and edges SubCell", grouped(reference.springs));
    let from = match reference.adhesion_force {
        Some(force) if reference.closed_form => {
            format!("the closed form of the adhesion force, {}, and {finest}", format_quantity(force, "N"))
        }
        _ => finest,
    };
    let own = reference.errors.into_iter().zip(ERRORS).filter_map(|(error, name)| {
        let error = error.filter(|_| !(reference.closed_form && name == ERRORS[0]))?;
        Some(format!("{name} {error:.0e}"))
    });
    let own: Vec<_> = own.collect();
    let own = if own.is_empty() { "none is known".into() } else { own.join(", ") };
    format!(
        "Counted from {from}. Its own errors, estimated from the last refinements: {own}. An error below that \
         is given as < it."
    )
}

fn cells(row: &Row) -> [String; 8] {
    let setting = match row.knob {
        Knob::Step => format_quantity(row.setting, "m"),
        _ => grouped(row.setting as u64),
    };
    let [force, curve, energy, contact] = row.errors.map(|error| error.map_or_else(String::new, error_cell));
    let time = |of: fn(crate::accuracy::Timing) -> f64| {
        row.seconds.map(of).map_or_else(String::new, |time| format_rounded(time, 3, "s"))
    };
    let transforms = row.transforms.filter(|count| count.is_finite());
    let transforms = transforms.map_or_else(String::new, |count| match count {
        count if count < 0.1 => format!("{count:.3}"),
        count if count < 10.0 => format!("{count:.2}"),
        count => format!("{count:.0}"),
    });
    [setting, time(|time| time.minimum), time(|time| time.median), transforms, force, curve, energy, contact]
}

fn error_cell(figure: ErrorFigure) -> String {
    match (figure.resolved, figure.order) {
        (false, _) => format!("<{:.0e}", figure.error),
        (true, None) => format!("{:.1e}", figure.error),
        (true, Some(order)) => format!("{:.1e} ({order:.1})", figure.error),
    }
}

/// The JSON object; its keys have the order of these fields.
#[derive(Serialize)]
struct Report<'a> {
    scene: &'a Scene,
    answer: Vec<String>,
    #[serde(flatten)]
    table: &'a CostTable,
}

/// Writes the table as one JSON object, beginning with the scene including its defaults.
///
/// # Errors
/// Errors of `out`.
pub fn write_cost_json(out: &mut (impl Write + ?Sized), scene: &Scene, table: &CostTable) -> io::Result<()> {
    write_json_value(out, &Report { scene, answer: table.answer(), table })
}

/// Writes the rows: times in s, errors relative; unknown values are empty.
///
/// # Errors
/// Errors of `out`.
pub fn write_cost_csv(out: &mut (impl Write + ?Sized), table: &CostTable) -> io::Result<()> {
    write!(out, "knob,setting,springs,minimum_seconds,median_seconds,transforms")?;
    for name in QUANTITIES {
        write!(out, ",{name}_error,{name}_resolved,{name}_order")?;
    }
    writeln!(out)?;
    let number = |value: Option<f64>| {
        value.filter(|value| value.is_finite()).map_or_else(String::new, |value| format!("{value:?}"))
    };
    for row in &table.rows {
        let knob = serde_json::to_value(row.knob)?;
        let (least, median) = (row.seconds.map(|time| time.minimum), row.seconds.map(|time| time.median));
        write!(out, "{},{:?},{}", knob.as_str().unwrap_or_default(), row.setting, row.springs)?;
        write!(out, ",{},{},{}", number(least), number(median), number(row.transforms))?;
        for figure in row.errors {
            let resolved = figure.map_or("", |figure| if figure.resolved { "true" } else { "false" });
            let (error, order) = (figure.map(|figure| figure.error), figure.and_then(|figure| figure.order));
            write!(out, ",{},{resolved},{}", number(error), number(order))?;
        }
        writeln!(out)?;
    }
    Ok(())
}
