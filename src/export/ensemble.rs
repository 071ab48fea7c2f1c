//! Results of many random profiles as text, JSON and CSV.

use super::report::{Json, Report};
use super::sheet::Sheet;
use super::summary::tabor_number;
use super::table::{Kind, Table};
use crate::accuracy::Choice;
use crate::analysis::Regime;
use crate::scene::{Scene, format_quantity, format_rounded};
use crate::study::{LineResult, LinesSummary, Statistics, quartiles};
use crate::text::grouped;
use serde::Serialize;

/// Results of a scene on random profiles; JSON has its fields in this order.
#[derive(Clone, Debug, Serialize)]
pub struct LinesReport<'a> {
    scene: &'a Scene,
    #[serde(skip_serializing_if = "Option::is_none")]
    choice: Option<&'a Choice>,
    #[serde(flatten)]
    summary: LinesSummary,
    lines: &'a [LineResult],
}

impl<'a> LinesReport<'a> {
    /// The results, with the choice of springs for a tolerance if there is one.
    #[must_use]
    pub fn new(scene: &'a Scene, choice: Option<&'a Choice>, lines: &'a [LineResult]) -> LinesReport<'a> {
        LinesReport { scene, choice, summary: LinesSummary::of(lines), lines }
    }
}

impl Report for LinesReport<'_> {
    fn text(&self) -> Option<String> {
        Some(text(self))
    }

    fn json(&self) -> Option<Box<dyn Json + '_>> {
        Some(Box::new(self))
    }

    fn table(&self) -> Option<Table<'_>> {
        let table = Table::of(|| self.lines.iter())
            .whole("seed", |line| line.seed)
            .real("adhesion_force", |line| line.adhesion_force)
            .real("preload_indentation", |line| line.preload_indentation)
            .real("dissipated_energy", |line| line.dissipated_energy)
            .real("contact_fraction", |line| line.contact_fraction)
            .with("regime", Kind::Text("pressure-insensitive".len()), |line| {
                line.regime.map_or("", Regime::name)
            })
            .real("skewness", |line| line.heights.map(|shape| shape.skewness))
            .real("excess_kurtosis", |line| line.heights.map(|shape| shape.excess_kurtosis))
            .real("tabor_number", |line| line.tabor_number);
        Some(table.done())
    }
}

/// Statistics over the profiles.
fn text(report: &LinesReport<'_>) -> String {
    let LinesReport { scene, choice, ref summary, lines } = *report;
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
    if let Some(choice) = choice {
        sheet.heading(&choice.sentence());
    }
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
