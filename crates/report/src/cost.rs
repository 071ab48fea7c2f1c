//! Report on the cost of accuracy as text, JSON, a table and a work–precision diagram.

use crate::reference::model_sentence;
use crate::report::{Json, Report};
use crate::sheet::Sheet;
use crate::work_precision::work_precision;
use asperity_contact::Relaxation;
use asperity_data::{Kind, Table, counted, format_quantity, format_rounded, grouped, per_cent};
use asperity_plot::Figure;
use asperity_scene::Scene;
use asperity_scene::discretisation::{CostTable, ErrorFigure, Knob, Row};
use asperity_study::half_space::Reference;
use serde::Serialize;

/// Headings of the columns with errors, in the order of [`CostTable::QUANTITIES`].
const ERRORS: [&str; 4] = ["F_a", "curve", "energy", "contact"];

/// Report on the cost of accuracy of a scene: computing time and relative errors for many settings,
/// such as numbers of springs.
#[derive(Clone, Debug, Serialize)]
pub struct CostReport<'a> {
    #[serde(skip)]
    pub title: &'a str,
    /// Scene whose computing time was measured.
    pub scene: &'a Scene,
    answer: Vec<String>,
    #[serde(flatten)]
    table: &'a CostTable,
    /// Comparison of the scene with an elastic half-space, which gives the error of the model.
    #[serde(skip_serializing_if = "Option::is_none")]
    reference: Option<&'a Reference>,
}

impl<'a> CostReport<'a> {
    /// Makes a report on the measured times and errors of a scene. `reference` is the comparison of
    /// the scene with an elastic half-space; if it is given, the report also states the error of
    /// the model.
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

    /// Adds tables of the relative errors, with one table for each kind of setting.
    fn add_errors(&self, sheet: &mut Sheet) {
        sheet.heading(
            "Relative errors, with the observed order of convergence since the row before",
        );
        sheet.paragraph(&counted_from(self.table));
        if self.table.is_over_loads(self.scene) {
            sheet.paragraph(
                "The errors of F_a with springs are the largest at half, once and twice the loads of the scene, so \
                 that none is small by chance. At the loads of the scene alone, asperity run estimates the error.",
            );
        }
        if self.scene.relaxes() {
            let error = per_cent(Relaxation::STEP_ERROR);
            sheet.paragraph(&format!(
                "The half-space relaxes: by its steps in time each force has an error of up to {error} of the largest \
                 force, with any number of springs."
            ));
        }
        for knob in Knob::ALL {
            let rows: Vec<&Row> = self.table.rows_of(knob).collect();
            if let Some(first) = rows.first() {
                sheet.heading(&heading(knob, first.springs));
                add_rows(sheet, knob, &rows);
            }
        }
    }

    /// Adds the total computing time of the measurements, and the settings that were left out.
    fn add_times(&self, sheet: &mut Sheet) {
        let table = self.table;
        let transform = format_rounded(table.transform_seconds, 3, "s");
        let spent = format_rounded(table.spent, 3, "s");
        let budget = format_rounded(table.budget, 3, "s");
        sheet.heading(&format!(
            "A time is the shortest of several whole runs from the scene to the curve; an FFT of 2^20 real numbers takes \
             {transform} here. All measurements together took {spent} of {budget}."
        ));
        if table.left_out.is_empty() {
            return;
        }
        sheet.heading(&format!("Left out, as {budget} was too short for them:"));
        for setting in &table.left_out {
            sheet.paragraph(&format!("- {setting}"));
        }
    }
}

impl Report for CostReport<'_> {
    /// Returns text that states, for errors of 1 % and 0.1 %, the necessary number of springs and
    /// the computing time.
    fn text(&self) -> Option<String> {
        let mut sheet = Sheet::default();
        for sentence in &self.answer {
            sheet.paragraph(sentence);
        }
        if let Some(model) = self.reference.and_then(model_sentence) {
            sheet.paragraph(&model);
        }
        self.add_errors(&mut sheet);
        self.add_times(&mut sheet);
        Some(sheet.into_text())
    }

    fn json(&self) -> Option<Box<dyn Json + '_>> {
        Some(Box::new(self))
    }

    /// Returns a table with a row for each setting. A row has computing times in s and relative
    /// errors.
    fn table(&self) -> Option<Table<'_>> {
        let longest_knob = "sub-cell-springs".len();
        let mut table = Table::of(|| self.table.rows.iter())
            .with("knob", Kind::Text(longest_knob), |row| {
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
            table = table
                .with(format!("{name}_error"), Kind::Real, move |row| {
                    row.errors[index].map(|figure| figure.error)
                })
                .with(
                    format!("{name}_resolved"),
                    Kind::Text("false".len()),
                    move |row| is_resolved(row.errors[index]),
                )
                .with(format!("{name}_order"), Kind::Real, move |row| {
                    row.errors[index].and_then(|figure| figure.order)
                });
        }
        Some(table.done())
    }

    fn figure(&self) -> Option<Figure> {
        Some(work_precision(self.title, self.table, self.reference))
    }
}

/// Returns `true` or `false` as text, depending on whether an error is resolved; empty for an
/// unknown error.
fn is_resolved(figure: Option<ErrorFigure>) -> &'static str {
    match figure {
        Some(figure) if figure.resolved => "true",
        Some(_) => "false",
        None => "",
    }
}

/// Returns the heading of the table of errors for one kind of setting. `springs` is the number of
/// springs in the first row.
fn heading(knob: Knob, springs: u64) -> String {
    let name = knob.name();
    if knob != Knob::Step {
        return format!("With {name}");
    }
    let springs = counted(springs, "spring");
    format!("With {name}, compared with the exact solver on the same {springs}, edges Grid")
}

/// Adds a table of the errors for one kind of setting.
fn add_rows(sheet: &mut Sheet, knob: Knob, rows: &[&Row]) {
    let setting = if knob == Knob::Step {
        "step"
    } else {
        "springs"
    };
    let [force, curve, energy, contact] = ERRORS;
    let header = [setting, "time", force, curve, energy, contact];
    let mut table = vec![header.map(String::from)];
    for row in rows {
        table.push(cells(row));
    }
    sheet.table(&table);
}

/// Returns sentences on the reference solution, from which the errors are counted, and on the own
/// errors of this solution.
fn counted_from(table: &CostTable) -> String {
    let reference = &table.reference;
    let springs = counted(reference.springs, "spring");
    let mut solution = format!("the solution with {springs} and edges SubCell");
    if let Some(force) = reference.pull_off_force
        && reference.closed_form
    {
        let force = format_quantity(force, "N");
        solution = format!("the closed form of the pull-off force, {force}, and {solution}");
    }
    let mut own_errors = Vec::new();
    for (error, name) in reference.errors.into_iter().zip(ERRORS) {
        // If the pull-off force of the reference is known in closed form, this force has no error.
        let is_exact = reference.closed_form && name == ERRORS[0];
        if let Some(error) = error
            && !is_exact
        {
            own_errors.push(format!("{name} {error:.0e}"));
        }
    }
    let own_errors = if own_errors.is_empty() {
        "none is known".to_owned()
    } else {
        own_errors.join(", ")
    };
    format!(
        "Counted from {solution}. Its own errors, estimated from the last refinements: {own_errors}. An error below that \
         is shown as < that error."
    )
}

/// Returns the row of a setting in the table of the text report.
fn cells(row: &Row) -> [String; 6] {
    let setting = match row.knob {
        Knob::Step => format_quantity(row.setting, "m"),
        _ => grouped(row.setting as u64),
    };
    let time = match row.seconds {
        Some(time) => format_rounded(time.minimum, 3, "s"),
        None => String::new(),
    };
    let [force, curve, energy, contact] = row.errors.map(error_cell);
    [setting, time, force, curve, energy, contact]
}

/// Returns an error with its order of convergence as text; empty for an unknown error.
fn error_cell(figure: Option<ErrorFigure>) -> String {
    let Some(figure) = figure else {
        return String::new();
    };
    let error = figure.error;
    match figure.order {
        _ if !figure.resolved => format!("<{error:.0e}"),
        None => format!("{error:.1e}"),
        Some(order) => format!("{error:.1e} ({order:.1})"),
    }
}
