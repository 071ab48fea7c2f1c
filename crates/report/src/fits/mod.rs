//! Reports on fits to many curves. Text, JSON and the table have a row for each curve, and the
//! figure shows the distribution of the fitted values.

mod distribution;
mod row;
#[cfg(test)]
mod tests;
mod together;

pub use row::{CurveRow, RowWarning};

use crate::report::{Json, Report};
use crate::sheet::Sheet;
use crate::spread::Spread;
use crate::warnings::{sentences_section, with_share};
use asperity_data::{AxisScale, Kind, Note, Remedy, Table, Wording, counted};
use asperity_data::{format_rounded, format_within, grouped, one_unit};
use asperity_experiment::{FitResult, Parameter};
use asperity_plot::{Chart, ChartAxis, Figure, Ink, Label, Layer, Shape, Span};
use asperity_scene::Scene;
use distribution::{Distribution, DistributionJson, FirstParameter, Histogram};
use row::ENDINGS;
pub(crate) use row::FACTS;
use serde::Serialize;

/// Largest number of curves that a sentence lists by name.
const MOST_NAMES: usize = 4;

/// Report on fits of one scene to many measured curves. Each curve is fitted separately, or a few
/// curves of one specimen are fitted together.
#[derive(Clone, Copy, Debug)]
pub struct FitsReport<'a> {
    /// Scene that is fitted to the curves.
    pub scene: &'a Scene,
    /// Free parameters of the fits, in the order of [`CurveRow::parameters`].
    pub free: &'a [Parameter],
    /// A row for each curve.
    pub rows: &'a [CurveRow],
    /// Result for each curve if all curves were fitted together; empty if each curve was fitted
    /// separately.
    pub together: &'a [FitResult],
    /// Function that states in words how the user takes a [`Remedy`], a step that removes the cause
    /// of an error or a warning. The words name an option of the command line, a row of the
    /// explorer or an argument of Python.
    pub wording: Wording,
}

impl FitsReport<'_> {
    /// Returns the rows of the curves that were not read or not fitted. The field
    /// [`CurveRow::error`] of such a row states the reason.
    pub fn failures(&self) -> impl Iterator<Item = &CurveRow> {
        self.rows.iter().filter(|row| !row.error.is_empty())
    }

    /// Returns a text with file and reason for each curve that was not read or not fitted.
    fn failures_in_words(&self) -> Vec<String> {
        self.failures()
            .map(|row| format!("{}: {}", row.file, row.error))
            .collect()
    }

    /// Returns an error message if no curve was fitted. The message names the first few files with
    /// their reasons, and the number of the others. Returns `None` if at least one curve was
    /// fitted, whether the model describes this curve or not.
    pub fn failure(&self) -> Option<String> {
        let reasons = self.failures_in_words();
        if reasons.len() < self.rows.len() {
            return None;
        }
        let (named, others) = reasons.split_at(reasons.len().min(MOST_NAMES));
        let mut message = named.join("; ");
        if !others.is_empty() {
            message += &format!("; and {} others", grouped(others.len() as u64));
        }
        Some(format!("no curve was fitted: {message}"))
    }

    /// Returns a sentence for each reason why the model does not describe curves. The sentence
    /// names the files of the curves with this reason, or states their number if they are many.
    fn reasons(&self) -> Vec<String> {
        let mut files_by_reason: Vec<(&str, Vec<&str>)> = Vec::new();
        for row in self.rows {
            if row.described != Some(false) {
                continue;
            }
            let known = files_by_reason
                .iter_mut()
                .find(|(reason, _)| *reason == row.reason);
            match known {
                Some((_, files)) => files.push(&row.file),
                None => files_by_reason.push((&row.reason, vec![&row.file])),
            }
        }
        let mut sentences = Vec::with_capacity(files_by_reason.len());
        for (reason, files) in files_by_reason {
            let curves = if files.len() <= MOST_NAMES {
                files.join(", ")
            } else {
                counted(files.len() as u64, "curve")
            };
            let sentence =
                format!("The model does not describe {curves} within the noise. {reason}");
            sentences.push(sentence.trim_end().to_owned());
        }
        sentences
    }

    fn first_parameter(&self) -> FirstParameter {
        let mut values = FirstParameter {
            described: Vec::new(),
            others: Vec::new(),
        };
        for row in self.rows {
            let Some([Some(value), ..]) = row.parameters.first() else {
                continue;
            };
            match row.described {
                Some(true) => values.described.push(*value),
                Some(false) => values.others.push(*value),
                None => {}
            }
        }
        values
    }

    /// Returns sentences on the first free parameter (its distribution over the curves that the
    /// model describes, and over all fitted curves) and on the curves that were not fitted.
    fn summary(&self) -> Vec<String> {
        let Some(&parameter) = self.free.first() else {
            return Vec::new();
        };
        let values = self.first_parameter();
        let mut sentences = Vec::new();
        if let Some(described) = Distribution::new(values.described.clone()) {
            sentences.push(described.sentence(parameter, "that the model describes"));
        }
        if !values.others.is_empty()
            && let Some(all) = Distribution::new(values.all())
        {
            sentences.push(all.sentence(parameter, "in all, described or not"));
        }
        let without_fit = self.failures().count();
        if without_fit > 0 {
            sentences.push(format!(
                "Not read or not fitted: {} of {} curves.",
                grouped(without_fit as u64),
                grouped(self.rows.len() as u64)
            ));
        }
        if !self.free.contains(&Parameter::Offset) && without_fit < self.rows.len() {
            let note = Note::new(
                "The offset was not fitted, so the intervals leave out that first touch is known to the distance of two points \
                 only.",
            );
            let offset = Remedy::Free(Parameter::Offset.name().to_owned());
            sentences.push(note.with(offset).in_words(self.wording));
        }
        sentences
    }

    /// Returns the row of a curve in the table of the text report. Of the parameters, the table has
    /// only the first.
    fn text_row(&self, row: &CurveRow) -> [String; 4] {
        let mut value = String::new();
        let mut interval = String::new();
        if let Some(parameter) = self.free.first()
            && let Some(found) = row.parameters.first()
        {
            let unit = parameter.row().unit;
            match *found {
                [Some(fitted), Some(low), Some(high)] => {
                    let uncertainty = 0.5 * (high - low);
                    let ends = [low, high].map(|end| format_within(end, uncertainty, unit));
                    value = format_within(fitted, uncertainty, unit);
                    interval = one_unit(ends);
                }
                [_, Some(least), _] => value = format!("≥ {}", format_rounded(least, 2, unit)),
                [_, _, Some(most)] => value = format!("≤ {}", format_rounded(most, 2, unit)),
                _ => {}
            }
        }
        let described = match row.description.as_str() {
            "" => "-".to_owned(),
            description => description.to_owned(),
        };
        [row.file.clone(), value, interval, described]
    }
}

impl Report for FitsReport<'_> {
    /// Returns a text for each premise of the model that some of the fitted scenes do not meet. The
    /// text states the number of curves whose scene does not meet the premise, and the values for
    /// the first of these curves.
    fn warnings(&self) -> Vec<String> {
        let mut first_of_kind: Vec<&RowWarning> = Vec::new();
        let mut counts: Vec<u64> = Vec::new();
        let mut fitted = 0;
        for row in self.rows {
            if !row.error.is_empty() {
                continue;
            }
            fitted += 1;
            for warning in &row.warnings {
                let known = first_of_kind
                    .iter()
                    .position(|known| known.name == warning.name);
                match known {
                    Some(kind) => counts[kind] += 1,
                    None => {
                        first_of_kind.push(warning);
                        counts.push(1);
                    }
                }
            }
        }
        let mut texts = Vec::with_capacity(counts.len());
        for (warning, count) in first_of_kind.iter().zip(counts) {
            texts.push(with_share(&warning.text, count, fitted, "curves"));
        }
        texts
    }

    fn text(&self) -> Option<String> {
        if !self.together.is_empty() {
            return Some(self.text_together());
        }
        let mut sheet = Sheet::default();
        let symbol = self
            .free
            .first()
            .map_or("", |parameter| parameter.row().symbol);
        let mut rows = vec![["", symbol, "95 % interval", "described"].map(String::from)];
        for row in self.rows {
            rows.push(self.text_row(row));
        }
        sheet.table(&rows);
        for part in [self.failures_in_words(), self.reasons(), self.summary()] {
            let Some((first, others)) = part.split_first() else {
                continue;
            };
            sheet.heading(first);
            for sentence in others {
                sheet.paragraph(sentence);
            }
        }
        self.add_spreads(&mut sheet);
        sentences_section(&mut sheet, &self.warnings());
        Some(sheet.into_text())
    }

    fn json(&self) -> Option<Box<dyn Json + '_>> {
        let values = self.first_parameter();
        Some(Box::new(FitsJson {
            parameter: self.free.first().map(|parameter| parameter.name()),
            all: DistributionJson::new(values.all()),
            described: DistributionJson::new(values.described),
            spreads: self.spreads(),
            together: !self.together.is_empty(),
            warnings: self.warnings(),
            curves: self.table(),
            scene: self.scene,
        }))
    }

    fn table(&self) -> Option<Table<'_>> {
        let mut table =
            Table::of(|| self.rows.iter()).with("file", Kind::Text(0), |row| row.file.clone());
        for (index, parameter) in self.free.iter().enumerate() {
            for (place, ending) in ENDINGS.into_iter().enumerate() {
                let name = format!("{}{ending}", parameter.name());
                table = table.with(name, Kind::Real, move |row: &&CurveRow| {
                    row.parameters.get(index).and_then(|values| values[place])
                });
            }
        }
        for (index, name) in FACTS.into_iter().enumerate() {
            table = table.real(name, move |row| row.facts[index]);
        }
        let table = table
            .with("points_used", Kind::Whole, |row| row.points)
            .with("described", Kind::Text(0), |row| row.described)
            .with("description", Kind::Text(0), |row| row.description.clone())
            .with("reason", Kind::Text(0), |row| row.reason.clone())
            .with("warnings", Kind::Text(0), |row| {
                RowWarning::cell(&row.warnings)
            })
            .with("error", Kind::Text(0), |row| row.error.clone());
        Some(table.done())
    }

    /// Returns a histogram of the first free parameter. For the curves that the model does not
    /// describe, further bars are stacked on the bars of the described curves.
    fn figure(&self) -> Option<Figure> {
        let row = self.free.first()?.row();
        let values = self.first_parameter();
        let all = values.all();
        if all.is_empty() {
            return None;
        }
        let histogram = Histogram::new(&values);
        let span = Span::around(all.iter().copied(), 0.06);
        let x = ChartAxis::new(AxisScale::Linear, span, row.term, row.symbol, row.unit);
        let span = Span::around([0.0, histogram.most].into_iter(), 0.06);
        let y = ChartAxis::new(AxisScale::Linear, span, "curves", "", "1");
        let mut layers = Vec::new();
        if !histogram.described.is_empty() {
            let boxes = Shape::Boxes(histogram.described);
            layers.push(Layer::new("described".into(), Ink::Contact, boxes));
        }
        if !histogram.others.is_empty() {
            let boxes = Shape::Boxes(histogram.others);
            layers.push(Layer::new("not described".into(), Ink::Quiet, boxes));
        }
        let notes = self.summary();
        Some(Figure {
            title: counted(self.rows.len() as u64, "curve"),
            notes: notes
                .iter()
                .map(|sentence| Label::plain(sentence))
                .collect(),
            charts: self
                .map_chart()
                .into_iter()
                .chain([Chart::new(x, y, layers)])
                .collect(),
            size: Figure::SMALL,
            ..Figure::default()
        })
    }
}

/// JSON object of fits to many curves, in SI units.
#[derive(Serialize)]
struct FitsJson<'a> {
    parameter: Option<&'static str>,
    /// Distribution over the curves that the model describes.
    described: Option<DistributionJson>,
    all: Option<DistributionJson>,
    /// Median and scatter of each quantity over all fitted curves.
    spreads: Vec<Spread>,
    /// True if all curves were fitted together.
    together: bool,
    /// Premises of the model that some of the fitted scenes do not meet.
    warnings: Vec<String>,
    curves: Option<Table<'a>>,
    scene: &'a Scene,
}
