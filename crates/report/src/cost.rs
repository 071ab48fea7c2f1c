//! Cost of accuracy as text, JSON, a table and a work–precision diagram.

use crate::reference::model_sentence;
use crate::report::{Json, Report};
use crate::sheet::Sheet;
use crate::work_precision::work_precision;
use asperity_data::{Kind, Table, format_quantity, format_rounded, grouped};
use asperity_plot::Figure;
use asperity_scene::Scene;
use asperity_scene::discretisation::{CostTable, ErrorFigure, Knob, Row};
use asperity_study::half_space::Reference;
use serde::Serialize;

/// Headings of the columns of errors, in the order of [`CostTable::QUANTITIES`].
const ERRORS: [&str; 4] = ["F_a", "curve", "energy", "contact"];

/// Report on the cost of accuracy of a scene: computing time and relative errors for many settings,
/// such as numbers of springs.
#[derive(Clone, Debug, Serialize)]
pub struct CostReport<'a> {
    /// Title of the scene.
    #[serde(skip)]
    pub title: &'a str,
    /// Scene whose computing time was measured.
    pub scene: &'a Scene,
    answer: Vec<String>,
    #[serde(flatten)]
    table: &'a CostTable,
    /// Comparison of the scene with three dimensions, which gives the error of the model.
    #[serde(skip_serializing_if = "Option::is_none")]
    reference: Option<&'a Reference>,
}

impl<'a> CostReport<'a> {
    /// Makes a report on the measured times and errors of a scene. If `reference`, the comparison
    /// with three dimensions, is given, the report also has the error of the model.
    pub fn new(
        title: &'a str,
        scene: &'a Scene,
        table: &'a CostTable,
        reference: Option<&'a Reference>,
    ) -> CostReport<'a> {
        CostReport {
            title,
            scene,
            answer: table.answer(),
            table,
            reference,
        }
    }
}

impl Report for CostReport<'_> {
    /// Returns text on the numbers of springs that give errors of 1 % and 0.1 %, with their
    /// computing times.
    fn text(&self) -> Option<String> {
        let table = self.table;
        let mut sheet = Sheet::default();
        table
            .answer()
            .iter()
            .for_each(|sentence| sheet.paragraph(sentence));
        if let Some(model) = self.reference.and_then(model_sentence) {
            sheet.paragraph(&model);
        }
        sheet.heading(
            "Relative errors, with the observed order of convergence since the row before",
        );
        sheet.paragraph(&counted_from(table));
        if table.is_over_loads(self.scene) {
            sheet.paragraph(
                "The errors of F_a with springs are the largest at half, once and twice the loads of the scene, so \
                 that none is small by chance. At the loads of the scene alone, asperity run estimates the error.",
            );
        }
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
                heading += &format!(
                    ", compared with the exact solver on the same {springs} springs, edges Grid"
                );
            }
            sheet.heading(&heading);
            let [force, curve, energy, contact] = ERRORS;
            let mut lines =
                vec![[setting, "time", force, curve, energy, contact].map(String::from)];
            lines.extend(rows.iter().map(|row| cells(row)));
            sheet.table(&lines);
        }
        let (spent, budget) = (
            format_rounded(table.spent, 3, "s"),
            format_rounded(table.budget, 3, "s"),
        );
        sheet.heading(&format!(
            "A time is the shortest of several whole runs from the scene to the curve; an FFT of 2^20 real numbers takes \
             {} here. All measurements together took {spent} of {budget}.",
            format_rounded(table.transform_seconds, 3, "s")
        ));
        if !table.left_out.is_empty() {
            sheet.heading(&format!("Left out, as {budget} was too short for them:"));
            table
                .left_out
                .iter()
                .for_each(|what| sheet.paragraph(&format!("- {what}")));
        }
        Some(sheet.into_text())
    }

    fn json(&self) -> Option<Box<dyn Json + '_>> {
        Some(Box::new(self))
    }

    /// Returns a table with a row for each setting. A row has computing times in s and relative
    /// errors.
    fn table(&self) -> Option<Table<'_>> {
        let mut table = Table::of(|| self.table.rows.iter())
            .with("knob", Kind::Text("sub-cell-springs".len()), |row| {
                <&str>::from(row.knob)
            })
            .real("setting", |row| row.setting)
            .whole("springs", |row| row.springs)
            .real("minimum_seconds", |row| {
                row.seconds.map(|time| time.minimum)
            })
            .real("median_seconds", |row| row.seconds.map(|time| time.median))
            .real("transforms", |row| row.transforms);
        for (index, name) in CostTable::QUANTITIES.into_iter().enumerate() {
            let error = move |row: &&Row| row.errors[index];
            table = table
                .with(format!("{name}_error"), Kind::Real, move |row| {
                    error(row).map(|one| one.error)
                })
                .with(
                    format!("{name}_resolved"),
                    Kind::Text("false".len()),
                    move |row| {
                        error(row).map_or("", |one| if one.resolved { "true" } else { "false" })
                    },
                )
                .with(format!("{name}_order"), Kind::Real, move |row| {
                    error(row).and_then(|one| one.order)
                });
        }
        Some(table.done())
    }

    fn figure(&self) -> Option<Figure> {
        Some(work_precision(self.title, self.table, self.reference))
    }
}

fn counted_from(table: &CostTable) -> String {
    let reference = &table.reference;
    let finest = format!(
        "the solution with {} springs and edges SubCell",
        grouped(reference.springs)
    );
    let from = match reference.adhesion_force {
        Some(force) if reference.closed_form => {
            format!(
                "the closed form of the adhesion force, {}, and {finest}",
                format_quantity(force, "N")
            )
        }
        _ => finest,
    };
    let own = reference
        .errors
        .into_iter()
        .zip(ERRORS)
        .filter_map(|(error, name)| {
            let error = error.filter(|_| !(reference.closed_form && name == ERRORS[0]))?;
            Some(format!("{name} {error:.0e}"))
        });
    let own: Vec<_> = own.collect();
    let own = if own.is_empty() {
        "none is known".into()
    } else {
        own.join(", ")
    };
    format!(
        "Counted from {from}. Its own errors, estimated from the last refinements: {own}. An error below that \
         is shown as < that error."
    )
}

fn cells(row: &Row) -> [String; 6] {
    let setting = match row.knob {
        Knob::Step => format_quantity(row.setting, "m"),
        _ => grouped(row.setting as u64),
    };
    let time = row
        .seconds
        .map_or_else(String::new, |time| format_rounded(time.minimum, 3, "s"));
    let [force, curve, energy, contact] = row
        .errors
        .map(|error| error.map_or_else(String::new, error_cell));
    [setting, time, force, curve, energy, contact]
}

fn error_cell(figure: ErrorFigure) -> String {
    match (figure.resolved, figure.order) {
        (false, _) => format!("<{:.0e}", figure.error),
        (true, None) => format!("{:.1e}", figure.error),
        (true, Some(order)) => format!("{:.1e} ({order:.1})", figure.error),
    }
}
