//! Results of many random profiles as text, JSON and CSV.

use super::Provenance;
use super::sheet::Sheet;
use super::summary::tabor_number;
use super::table::{Column, TableFormat, Value, write_table};
use crate::accuracy::Choice;
use crate::analysis::Regime;
use crate::io::write_json_value;
use crate::scene::{Scene, format_quantity, format_rounded};
use crate::study::{LineResult, LinesSummary, Statistics, quartiles};
use crate::text::grouped;
use serde::Serialize;
use std::io::{self, Write};

/// Statistics over the profiles in plain text of at most a hundred columns.
#[must_use]
pub fn ensemble_text(scene: &Scene, lines: &[LineResult]) -> String {
    let summary = LinesSummary::of(lines);
    let mut sheet = Sheet::default();
    sheet.paragraph(&scene.title);
    let seeds = lines.first().zip(lines.last());
    let seeds =
        seeds.map_or_else(String::new, |(first, last)| format!(", seeds {} to {}", first.seed, last.seed));
    let (count, springs) = (grouped(lines.len() as u64), grouped(scene.numerics.points));
    sheet.heading(&format!("{count} random lines of {springs} springs{seeds}"));
    let mut rows = vec![
        ["", "mean", "standard deviation", "standard error", "95 % confidence", "lines"].map(String::from),
    ];
    for (name, unit, statistics) in [
        ("adhesion force F_a", "N", summary.adhesion_force),
        ("preload indentation", "m", summary.preload_indentation),
        ("dissipated energy", "J", summary.dissipated_energy),
        ("contact fraction", "1", summary.contact_fraction),
    ] {
        rows.extend(statistics.map(|statistics| cells(name, unit, &statistics)));
    }
    sheet.table(&rows);
    let forces = lines.iter().filter_map(|line| line.adhesion_force).collect();
    sheet.row_of("F_a", profiles_text(forces));
    // Profiles of one spectrum have one Tabor number.
    let number =
        lines.iter().filter(|line| line.dissipated_energy.is_some()).find_map(|line| line.tabor_number);
    sheet.row_of("Tabor number μ", number.map(tabor_number));
    sheet.heading("Regimes");
    for (name, count) in summary.regimes.present() {
        sheet.row(name, grouped(count as u64));
    }
    sheet.heading("Heights of single lines; both would be 0 if they averaged themselves");
    sheet.quantity("rms skewness", summary.rms_skewness, "1");
    sheet.quantity("rms excess kurtosis", summary.rms_excess_kurtosis, "1");
    sheet.into_text()
}

/// Median and quartiles of the adhesion forces of several profiles, N; `None` for fewer than two.
pub(super) fn profiles_text(forces: Vec<f64>) -> Option<String> {
    let count = Some(forces.len()).filter(|&count| count >= 2)?;
    let [lower, median, upper] = quartiles(forces)?.map(|force| format_rounded(force, 2, "N"));
    Some(format!("{count} profiles: median {median} (quartiles {lower} to {upper})"))
}

fn cells(name: &str, unit: &str, statistics: &Statistics) -> [String; 6] {
    let quantity = |value| format_quantity(value, unit);
    let Statistics { count, mean, standard_deviation, standard_error, confidence_interval: (low, high) } =
        *statistics;
    [
        name.into(),
        quantity(mean),
        quantity(standard_deviation),
        quantity(standard_error),
        format!("{} to {}", quantity(low), quantity(high)),
        grouped(count as u64),
    ]
}

/// The JSON object; its keys have the order of these fields.
#[derive(Serialize)]
struct Report<'a> {
    scene: &'a Scene,
    #[serde(skip_serializing_if = "Option::is_none")]
    choice: Option<&'a Choice>,
    #[serde(flatten)]
    summary: LinesSummary,
    lines: &'a [LineResult],
}

/// Writes statistics and profiles as one JSON object, beginning with the scene including its defaults, with the
/// choice for a tolerance if there is one.
///
/// # Errors
/// Errors of `out`.
pub fn write_ensemble_json(
    out: &mut (impl Write + ?Sized),
    scene: &Scene,
    choice: Option<&Choice>,
    lines: &[LineResult],
) -> io::Result<()> {
    write_json_value(out, &Report { scene, choice, summary: LinesSummary::of(lines), lines })
}

/// Writes one row for each profile, in SI units; missing values are empty.
///
/// # Errors
/// Errors of `out`.
pub fn write_ensemble_table(
    out: &mut (impl Write + ?Sized),
    format: TableFormat,
    provenance: &Provenance,
    lines: &[LineResult],
) -> io::Result<()> {
    write_table(out, format, provenance, COLUMNS, lines.len(), lines.iter())
}

/// Characters of the longest name of a regime.
const LONGEST_REGIME: usize = "pressure-insensitive".len();

const COLUMNS: &[Column<LineResult>] = &[
    Column("seed", Value::Whole(|line| line.seed)),
    Column("adhesion_force", Value::Optional(|line| line.adhesion_force)),
    Column("preload_indentation", Value::Optional(|line| line.preload_indentation)),
    Column("dissipated_energy", Value::Optional(|line| line.dissipated_energy)),
    Column("contact_fraction", Value::Real(|line| line.contact_fraction)),
    Column("regime", Value::Word(LONGEST_REGIME, |line| line.regime.map_or("", Regime::name))),
    Column("skewness", Value::Optional(|line| line.heights.map(|shape| shape.skewness))),
    Column("excess_kurtosis", Value::Optional(|line| line.heights.map(|shape| shape.excess_kurtosis))),
    Column("tabor_number", Value::Optional(|line| line.tabor_number)),
];
