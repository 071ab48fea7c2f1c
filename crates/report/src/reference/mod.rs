//! Comparison of two computations of a scene, with profiles and in three dimensions, as text, JSON,
//! a table and a figure. In three dimensions, rough square surfaces (called squares) touch an
//! elastic half-space.

mod chart;
mod json;
mod progress;
#[cfg(test)]
mod tests;
mod words;

pub use progress::{ReferenceProgress, square_loops_words};
pub use words::{difference_words, model_sentence, model_words, omitted_waves};

use crate::report::{Json, Report};
use crate::sheet::Sheet;
use crate::warnings::{counted_texts, sentences_section};
use crate::words::percent;
use asperity_contact::Move;
use asperity_data::{Note, Remedy, Table, Wording, format_quantity, format_rounded, grouped};
use asperity_plot::Figure;
use asperity_scene::Scene;
use asperity_study::half_space::{Compared, Loaded, Reference};
use chart::figure_of_loading;
use json::ReferenceJson;
use words::{percent_or_unknown, ratio};

/// Report on the comparison of two computations of a rough contact. One computation uses profiles,
/// as in all other reports; the other one uses bodies in three dimensions.
#[derive(Clone, Copy, Debug)]
pub struct ReferenceReport<'a> {
    /// Title of the report, which is its first line.
    pub title: &'a str,
    /// Scene that is computed in both ways.
    pub scene: &'a Scene,
    /// Results of both computations and their ratios.
    pub reference: &'a Reference,
    /// Function that states in words how the user takes a [`Remedy`], a step that removes the cause
    /// of an error or a warning. The words name an option of the command line, a row of the
    /// explorer or an argument of Python.
    pub wording: Wording,
}

/// Returns the headings of a table that compares both models.
fn header() -> [String; 4] {
    ["", "profile", "three dimensions", "ratio"].map(String::from)
}

/// Returns the headings of a table that compares both models and states the error of the grid of
/// the squares.
fn header_with_grid() -> [String; 5] {
    ["", "profile", "three dimensions", "ratio", "grid"].map(String::from)
}

/// Returns the row of a quantity in a table that compares both models and states the error of the
/// grid.
fn compared_row(name: String, compared: &Compared, unit: &str) -> [String; 5] {
    [
        name,
        format_rounded(compared.line.mean, 3, unit),
        format_rounded(compared.half_space.mean, 3, unit),
        ratio(compared),
        percent_or_unknown(compared.grid),
    ]
}

/// Returns the row of a quantity in the table of the roughness of profiles and squares.
fn roughness_row(name: &str, line: f64, half_space: f64, unit: &str) -> [String; 4] {
    [
        name.to_owned(),
        format_rounded(line, 3, unit),
        format_rounded(half_space, 3, unit),
        format!("{:.2}", line / half_space),
    ]
}

impl ReferenceReport<'_> {
    /// Returns sentences that state which bodies and which waves are compared.
    fn compared(&self) -> String {
        let options = &self.reference.options;
        let cells = options.cells;
        let Some((first, last)) = self.reference.waves else {
            return format!(
                "A square surface of {cells} × {cells} cells and a profile, both smooth."
            );
        };
        let surfaces = grouped(options.surfaces);
        let lines = grouped(options.profiles);
        let first = grouped(first);
        let last = grouped(last);
        let mut sentences = format!(
            "Means over {surfaces} random square surfaces of {cells} × {cells} cells and over {lines} random profiles, of {first} to {last} \
             waves over the length."
        );
        if let Some(last_of_scene) = self.reference.omitted {
            let last_of_scene = grouped(last_of_scene);
            sentences += &format!(
                " The squares do not resolve the waves up to {last_of_scene} of the scene, which both models leave out: {}.",
                (self.wording)(&Remedy::FinerGrid)
            );
        }
        sentences
    }

    /// Returns a sentence on the part of the loading that is compared; `None` if the whole loading
    /// of the scene is compared.
    fn compared_loading(&self) -> Option<String> {
        let reference = self.reference;
        if reference.compared_loading[..] == self.scene.loading[..] {
            return None;
        }
        let turn = match reference.compared_loading[0] {
            Move::ToIndentation(indentation) => {
                format!("an indentation of {}", format_rounded(indentation, 3, "m"))
            }
            Move::ToDisplacement(displacement) => {
                format!("a displacement of {}", format_rounded(displacement, 3, "m"))
            }
            _ => format_rounded(reference.preload, 3, "N"),
        };
        Some(format!(
            "The last loop of the loading is compared: from separation to {turn}, and back."
        ))
    }

    /// Adds a table of the roughness of the equivalent lines (profiles) and of the square surfaces
    /// on the half-space.
    fn add_roughness(&self, sheet: &mut Sheet) {
        let Some(roughness) = self.reference.roughness else {
            return;
        };
        let line = roughness.line;
        let square = roughness.half_space;
        let mut rows = vec![
            header(),
            roughness_row("rms height h", line.rms_height, square.rms_height, "m"),
            roughness_row(
                "rms gradient ⟨∇z⟩",
                line.rms_gradient,
                square.rms_gradient,
                "1",
            ),
            roughness_row(
                "elastic energy e_el",
                line.elastic_energy,
                square.elastic_energy,
                "J/m²",
            ),
        ];
        let mut scaled = None;
        let work = self.reference.work_of_adhesion;
        if let (Some(adhesive), Some(work)) = (roughness.adhesive_half_space, work) {
            let of_line = line.elastic_energy / work;
            let of_square = adhesive.elastic_energy / work;
            rows.push(roughness_row(
                "e_el/γ with adhesion",
                of_line,
                of_square,
                "1",
            ));
            let factor = adhesive.rms_height / square.rms_height;
            scaled = Some(format!(
                "With adhesion the heights of the squares are multiplied by {factor:.3}, so that e_el/γ is the same."
            ));
        }
        sheet.heading("Roughness of what is compared");
        sheet.table(&rows);
        if let Some(sentence) = scaled {
            sheet.paragraph(&sentence);
        }
    }

    /// Adds a table of the loading without adhesion, and a sentence on the forces that are not
    /// compared.
    fn add_loading(&self, sheet: &mut Sheet) {
        sheet.heading(
            "Without adhesion, indentations from first touch, ratio of the profile to three dimensions",
        );
        let mut rows = vec![header_with_grid()];
        for loaded in &self.reference.loading {
            let force = format_rounded(loaded.force, 3, "N");
            let indentation = format!("indentation at {force}");
            rows.push(compared_row(indentation, &loaded.indentation, "m"));
            let stiffness = format!("stiffness at {force}");
            rows.push(compared_row(stiffness, &loaded.stiffness, "N/m"));
        }
        if rows.len() > 1 {
            sheet.table(&rows);
        }
        if let Some(sentence) = self.left_out() {
            sheet.paragraph(&sentence);
        }
    }

    /// Adds a table of the adhesion in both models. Adds nothing for a scene without adhesion.
    fn add_adhesion(&self, sheet: &mut Sheet) {
        let reference = self.reference;
        let quantities = [
            ("pull-off force F_a", &reference.pull_off_force, "N"),
            (
                "at first touch F_a(d=0)",
                &reference.first_touch_pull_off_force,
                "N",
            ),
            ("dissipated energy", &reference.dissipated_energy, "J"),
        ];
        let mut rows = vec![header_with_grid()];
        for (name, compared, unit) in quantities {
            if let Some(compared) = compared {
                rows.push(compared_row(name.to_owned(), compared, unit));
            }
        }
        if rows.len() > 1 {
            let preload = format_quantity(reference.preload, "N");
            sheet.heading(&format!(
                "With adhesion, after a preload of {preload}, ratio of the profile to three dimensions"
            ));
            sheet.table(&rows);
        }
    }

    /// Returns a sentence on the forces that are not compared, because too few grid cells are in
    /// contact; `None` if there are no such forces.
    fn left_out(&self) -> Option<String> {
        let left_out = &self.reference.left_out;
        let finer_grid = left_out.first()?.grid;
        let least = Loaded::LEAST_CELLS;
        let mut forces = Vec::new();
        for left_out in left_out {
            let force = format_rounded(left_out.force, 3, "N");
            let cells = format_rounded(left_out.cells, 2, "1");
            forces.push(format!("{force} ({cells})"));
        }
        let forces = forces.join(", ");
        let help = match finer_grid {
            Some(grid) => format!("; {} may add them", (self.wording)(&Remedy::Grid(grid))),
            None => String::new(),
        };
        Some(format!(
            "Left out are forces at which fewer than {least} cells of a square are in contact on the average: {forces}{help}."
        ))
    }

    /// Returns the sources of error of the comparison with their errors in words, and a sentence on
    /// the largest error.
    fn errors(&self) -> (Vec<(&'static str, String)>, String) {
        let reference = self.reference;
        let budget = &reference.budget;
        let sample = if reference.waves.is_some() {
            self.with_waves(budget.sample)
        } else {
            "none: nothing is random".to_owned()
        };
        let difference = difference_words(reference).unwrap_or_else(|| percent_or_unknown(None));
        let rows = vec![
            ("solver", format!("{:.0e} of the rms height", budget.solver)),
            ("grid of the squares", self.with_waves(budget.grid)),
            ("sample", sample),
            ("three dimensions", difference),
            ("model", model_words(reference)),
        ];
        (rows, self.largest_error())
    }

    /// Returns an error as text. If some waves of the scene are not compared, the text also states
    /// the compared waves.
    fn with_waves(&self, error: Option<f64>) -> String {
        let words = percent_or_unknown(error);
        if error.is_none() {
            return words;
        }
        words + &omitted_waves(self.reference)
    }

    /// Returns a sentence that names the largest error.
    fn largest_error(&self) -> String {
        let budget = &self.reference.budget;
        match (budget.largest, budget.model) {
            ("model", Some(model)) => {
                let error = percent(model, 2);
                let waves = omitted_waves(self.reference);
                format!(
                    "The largest is the model, at least {error}{waves}: more springs do not help."
                )
            }
            ("sample", _) => {
                Note::new("The largest is the sample of square surfaces and profiles.")
                    .with(Remedy::Surfaces)
                    .in_words(self.wording)
            }
            ("grid", _) => Note::new("The largest is the grid of the squares.")
                .with(Remedy::FinerGrid)
                .in_words(self.wording),
            _ => "The largest known error is the residual of the solver.".to_owned(),
        }
    }
}

impl Report for ReferenceReport<'_> {
    fn warnings(&self) -> Vec<String> {
        counted_texts(
            &self.reference.warnings,
            self.reference.profiles_for_warnings(),
        )
    }

    fn text(&self) -> Option<String> {
        let reference = self.reference;
        let mut sheet = Sheet::default();
        sheet.paragraph(self.title);
        sheet.heading(&self.compared());
        sentences_section(&mut sheet, &self.warnings());
        if let Some(sentence) = self.compared_loading() {
            sheet.paragraph(&sentence);
        }
        self.add_roughness(&mut sheet);
        self.add_loading(&mut sheet);
        self.add_adhesion(&mut sheet);

        let (rows, largest) = self.errors();
        sheet.heading("Errors of the comparison by their sources");
        for (source, words) in rows {
            sheet.row(source, words);
        }
        sheet.paragraph(&largest);

        let [lines, squares] = reference
            .seconds
            .map(|seconds| format_quantity(seconds, "s"));
        let convolutions = grouped(reference.convolutions);
        sheet.heading(&format!(
            "Time: {lines} for the profiles; {squares} and {convolutions} convolutions for the square surfaces."
        ));
        Some(sheet.into_text())
    }

    fn json(&self) -> Option<Box<dyn Json + '_>> {
        Some(Box::new(ReferenceJson::new(self.scene, self.reference)))
    }

    /// Returns a table of the loading without adhesion, with a row for each force. For the
    /// indentation and the stiffness at this force, a row has the mean over profiles, the mean in
    /// three dimensions, and the ratio of these means.
    fn table(&self) -> Option<Table<'_>> {
        let table = Table::of(|| self.reference.loading.iter())
            .real("force", |loaded| loaded.force)
            .real("indentation_line", |loaded| loaded.indentation.line.mean)
            .real("indentation_half_space", |loaded| {
                loaded.indentation.half_space.mean
            })
            .real("indentation_ratio", |loaded| loaded.indentation.ratio)
            .real("indentation_ratio_error", |loaded| loaded.indentation.error)
            .real("indentation_grid", |loaded| loaded.indentation.grid)
            .real("stiffness_line", |loaded| loaded.stiffness.line.mean)
            .real("stiffness_half_space", |loaded| {
                loaded.stiffness.half_space.mean
            })
            .real("stiffness_ratio", |loaded| loaded.stiffness.ratio)
            .real("stiffness_ratio_error", |loaded| loaded.stiffness.error)
            .real("stiffness_grid", |loaded| loaded.stiffness.grid)
            .real("area_half_space", |loaded| loaded.area);
        Some(table.done())
    }

    fn figure(&self) -> Option<Figure> {
        Some(figure_of_loading(self.title, &self.reference.loading))
    }
}
