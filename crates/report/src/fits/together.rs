//! Text of a report on curves of one specimen that were fitted together.

use crate::fit_parameters::ParametersSection;
use crate::fits::FitsReport;
use crate::report::Report;
use crate::sheet::Sheet;
use crate::warnings::sentences_section;
use crate::words::percent;
use asperity_data::{format_rounded, one_unit};
use asperity_experiment::{FitResult, Parameter};

/// Returns true for a parameter of which each curve has a value of its own.
fn is_own(parameter: Parameter) -> bool {
    matches!(parameter, Parameter::Offset | Parameter::Zero)
}

impl FitsReport<'_> {
    /// Returns the text: the parameters that all curves share, and a row for each curve.
    pub(super) fn text_together(&self) -> String {
        let mut sheet = Sheet::default();
        for sentence in self.assumptions() {
            sheet.paragraph(&sentence);
        }
        if let Some(fit) = self.together.first() {
            sheet.heading(&format!("Fit of {}", fit.document.title()));
            let section = ParametersSection {
                fit,
                is_shown: |parameter| !is_own(parameter),
                wording: self.wording,
            };
            section.add(&mut sheet);
        }
        sheet.heading("Curves");
        sheet.table(&self.rows_together());
        for sentence in self.reasons() {
            sheet.paragraph(&sentence);
        }
        sentences_section(&mut sheet, &self.warnings());
        sheet.into_text()
    }

    /// Returns the sentences on what the fit assumes. A sentence that does not hold for all curves
    /// begins with the file of its curve.
    fn assumptions(&self) -> Vec<String> {
        let of_curves: Vec<Vec<String>> = self
            .together
            .iter()
            .map(|fit| {
                let notes = fit.assumptions.iter();
                notes.map(|note| note.in_words(self.wording)).collect()
            })
            .collect();
        let mut sentences = Vec::new();
        for (row, own) in self.rows.iter().zip(&of_curves) {
            for sentence in own {
                let is_common = of_curves.iter().all(|other| other.contains(sentence));
                if !is_common {
                    sentences.push(format!("{}: {sentence}", row.file));
                } else if !sentences.contains(sentence) {
                    sentences.push(sentence.clone());
                }
            }
        }
        sentences
    }

    /// Returns a table with the speed, the parameters of its own and the residual of each curve.
    fn rows_together(&self) -> Vec<Vec<String>> {
        let own: Vec<usize> = (0..self.free.len())
            .filter(|index| is_own(self.free[*index]))
            .collect();
        let mut header = vec![String::new(), "speed".to_owned()];
        for index in &own {
            header.push(self.free[*index].row().symbol.to_owned());
            header.push("95 % interval".to_owned());
        }
        header.extend(["residual", "described"].map(String::from));
        let mut rows = vec![header];
        for (row, fit) in self.rows.iter().zip(self.together) {
            let mut cells = vec![row.file.clone(), speed_of(fit)];
            for index in &own {
                let fitted = fit.parameters[*index];
                let (low, high) = fitted.interval;
                cells.push(fitted.text(fitted.value));
                cells.push(one_unit([low, high].map(|end| fitted.text(end))));
            }
            cells.push(percent(fit.agreement.residual_over_largest_force, 2));
            cells.push(row.description.clone());
            rows.push(cells);
        }
        rows
    }
}

/// Returns the speed of the approach in words.
fn speed_of(fit: &FitResult) -> String {
    match fit.document.scene().loading_speed {
        Some(speed) => format_rounded(speed, 3, "m/s"),
        None => "-".to_owned(),
    }
}
