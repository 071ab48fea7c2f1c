//! Reports on fits to many curves. Text, JSON and the table have a row for each curve, and the
//! figure shows the distribution of the fitted values.

use crate::fit::FitReport;
use crate::report::{Json, Report};
use crate::sheet::Sheet;
use crate::spread::Spread;
use crate::warnings::{sentences_section, with_share};
use crate::words::counted;
use asperity_data::{AxisScale, Control, Kind, Note, Remedied, Remedy, Table, Warning, Wording};
use asperity_data::{
    format_quantity, format_range, format_rounded, format_within, grouped, one_unit, printable,
    quartiles,
};
use asperity_experiment::{Fit, MeasuredCurve, Parameter, RangeEnd};
use asperity_plot::{Chart, ChartAxis, Figure, Ink, Label, Layer, Shape, Span};
use asperity_scene::Scene;
use serde::Serialize;
use std::fmt::Display;

/// Smallest and largest number of bars of a histogram.
const BARS: (usize, usize) = (5, 40);

/// Largest number of curves that a sentence lists by name.
const MOST_NAMES: usize = 4;

/// Row of one of many measured curves: the result of its fit, or the reason why it was not fitted.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CurveRow {
    /// Path of the file of the curve, as the user gave it.
    pub file: String,
    /// For each free parameter its value and the lower and upper end of its 95 % interval, in SI
    /// units; empty if the curve was not fitted. A fit may find only a bound of the parameter, at
    /// an end of the searched range. This bound is then the lower or the upper end, and the other
    /// two numbers are `None`.
    pub parameters: Vec<[Option<f64>; 3]>,
    /// Numbers of the curve and of its fit, such as the pull-off force, in SI units and in the
    /// order of `FACTS`; `None` for an unknown number.
    pub facts: [Option<f64>; FACTS.len()],
    /// Number of points of the curve that are used; `None` if the curve was not fitted.
    pub points: Option<u64>,
    /// True if the model describes the curve within its noise; `None` if the curve was not fitted.
    pub described: Option<bool>,
    /// [Grade](asperity_experiment::Grade) of the fit in words; empty if the curve was not fitted.
    pub description: String,
    /// Reason why the model does not describe the curve within its noise; empty if the model
    /// describes the curve.
    pub reason: String,
    /// Premises of the model that the scene with the fitted values does not meet.
    pub warnings: Vec<RowWarning>,
    /// Reason why the curve was not read or not fitted; empty if the curve was fitted.
    pub error: String,
}

/// A premise of the model that the scene fitted to one curve does not meet.
#[derive(Clone, Debug, PartialEq)]
pub struct RowWarning {
    /// [Name](asperity_data::Warning::name) of the premise.
    pub name: String,
    /// [`asperity_data::Warning`] as text.
    pub text: String,
}

impl RowWarning {
    /// Text between two warnings in one cell of a table.
    const SEPARATOR: &'static str = " | ";

    fn of(warning: &Warning) -> Self {
        RowWarning {
            name: warning.name().to_owned(),
            text: warning.to_string(),
        }
    }

    /// Returns these warnings as the text of one cell of a table: `name: text | name: text`.
    fn cell(warnings: &[RowWarning]) -> String {
        let texts: Vec<String> = warnings
            .iter()
            .map(|warning| format!("{}: {}", warning.name, warning.text))
            .collect();
        texts.join(Self::SEPARATOR)
    }

    /// Reads the warnings that [`Self::cell`] wrote into a cell; `None` if the cell has another
    /// form.
    fn in_cell(cell: &str) -> Option<Vec<RowWarning>> {
        let mut warnings = Vec::new();
        if cell.is_empty() {
            return Some(warnings);
        }
        for warning in cell.split(Self::SEPARATOR) {
            let (name, text) = warning.split_once(": ")?;
            warnings.push(RowWarning {
                name: name.to_owned(),
                text: text.to_owned(),
            });
        }
        Some(warnings)
    }
}

/// Names of the columns after the parameters: pull-off force, work of adhesion of a smooth sphere
/// with this pull-off force, residual in contact divided by the noise and by the largest force,
/// misfit, noise, numbers that follow from the curve without the scene, and the coordinates of the
/// place on the specimen.
pub const FACTS: [&str; 11] = [
    "pull_off_force",
    "pull_off_work",
    "residual_over_noise",
    "residual_over_largest_force",
    "misfit",
    "noise",
    "jumps",
    "hysteresis",
    "fall_in_pause",
    "position_x",
    "position_y",
];

/// Endings of the names of the columns of a parameter: the first for its value, the others for the
/// ends of its interval.
const ENDINGS: [&str; 3] = ["", "_low", "_high"];

impl CurveRow {
    /// Fits the scene to one curve and makes the row of this curve. If the curve was not read or
    /// its fit fails, [`Self::error`] states the reason.
    pub fn of(
        title: &str,
        curve: Result<MeasuredCurve, impl Display>,
        fit: &Fit<'_>,
        control: Control<'_>,
        wording: Wording,
    ) -> Self {
        let curve = match curve {
            Ok(curve) => curve,
            Err(error) => return CurveRow::failed(title, &error.to_string()),
        };
        match fit.run(&curve, control) {
            Ok(fit) => CurveRow::fitted(
                &FitReport {
                    title,
                    curve: &curve,
                    fit: &fit,
                    wording,
                },
                None,
            ),
            Err(error) => CurveRow::failed(title, &error.in_words(wording)),
        }
    }

    /// Makes the row of a curve that was not read or not fitted.
    pub fn failed(title: &str, error: &str) -> Self {
        CurveRow {
            file: title.to_owned(),
            error: printable(error).into_owned(),
            ..CurveRow::default()
        }
    }

    /// Makes the row of a curve that was fitted. `position` are the coordinates, in m, of the place
    /// on the specimen at which it was measured, if they are known.
    pub fn fitted(report: &FitReport<'_>, position: Option<[f64; 2]>) -> Self {
        let FitReport {
            title,
            curve,
            fit,
            wording,
        } = *report;
        let force = curve.pull_off_force();
        let work = force.and_then(|force| report.pull_off_work(force));
        let mut parameters = Vec::with_capacity(fit.parameters.len());
        for fitted in &fit.parameters {
            let (low, high) = fitted.interval;
            parameters.push(match fitted.at_end {
                Some(RangeEnd::Low) => [None, None, Some(fitted.value)],
                Some(RangeEnd::High) => [None, Some(fitted.value), None],
                None => [Some(fitted.value), Some(low), Some(high)],
            });
        }
        let reason = match &fit.reason {
            Some(reason) => reason.note().in_words(wording),
            None => String::new(),
        };
        CurveRow {
            file: title.to_owned(),
            parameters,
            facts: [
                force,
                work,
                Some(fit.residual_over_noise),
                Some(fit.agreement.residual_over_largest_force),
                Some(fit.misfit),
                Some(curve.noise),
                Some(curve.features.jumps as f64),
                curve.features.hysteresis,
                curve.features.fall_in_pause,
                position.map(|[x, _]| x),
                position.map(|[_, y]| y),
            ],
            points: Some(curve.points as u64),
            described: Some(fit.describes()),
            description: fit.grade.to_string(),
            reason,
            warnings: fit.warnings.iter().map(RowWarning::of).collect(),
            error: String::new(),
        }
    }

    /// Reads a row from a line of a CSV table that [`FitsReport`] wrote; `None` for any other line.
    /// `parameters` is the number of free parameters.
    pub fn from_line(line: &str, parameters: usize) -> Option<Self> {
        let cells = cells_of(line)?;
        let (file, cells) = cells.split_first()?;
        if cells.len() != ENDINGS.len() * parameters + FACTS.len() + 6 {
            return None;
        }
        let (values, cells) = cells.split_at(ENDINGS.len() * parameters);
        let (facts, cells) = cells.split_at(FACTS.len());
        let [points, described, description, reason, warnings, error] = cells else {
            return None;
        };
        let mut parameters = Vec::new();
        // The cells of a curve that was not fitted are empty, so the list of its parameters stays
        // empty.
        if error.is_empty() {
            for parameter in numbers_of(values)?.chunks_exact(ENDINGS.len()) {
                parameters.push([parameter[0], parameter[1], parameter[2]]);
            }
        }
        Some(CurveRow {
            file: file.clone(),
            parameters,
            facts: numbers_of(facts)?.try_into().ok()?,
            points: points.parse().ok(),
            described: described.parse().ok(),
            description: description.clone(),
            reason: reason.clone(),
            warnings: RowWarning::in_cell(warnings)?,
            error: error.clone(),
        })
    }
}

/// Returns the numbers in the cells of a CSV line, with `None` for each empty cell. If a cell is
/// neither a number nor empty, the whole result is `None`.
fn numbers_of(cells: &[String]) -> Option<Vec<Option<f64>>> {
    let mut numbers = Vec::with_capacity(cells.len());
    for cell in cells {
        if cell.is_empty() {
            numbers.push(None);
        } else {
            numbers.push(Some(cell.parse().ok()?));
        }
    }
    Some(numbers)
}

/// Returns the cells of a CSV line, as RFC 4180 defines them; `None` if a quotation mark is not
/// closed.
fn cells_of(line: &str) -> Option<Vec<String>> {
    let mut cells = Vec::new();
    let mut cell = String::new();
    let mut is_quoted = false;
    let mut characters = line.chars().peekable();
    while let Some(character) = characters.next() {
        match character {
            '"' if is_quoted && characters.peek() == Some(&'"') => {
                characters.next();
                cell.push('"');
            }
            '"' => is_quoted = !is_quoted,
            ',' if !is_quoted => cells.push(std::mem::take(&mut cell)),
            other => cell.push(other),
        }
    }
    cells.push(cell);
    (!is_quoted).then_some(cells)
}

/// Report on fits of one scene to many measured curves. Each curve is fitted separately.
#[derive(Clone, Copy, Debug)]
pub struct FitsReport<'a> {
    /// Scene that is fitted to the curves.
    pub scene: &'a Scene,
    /// Free parameters of the fits, in the order of [`CurveRow::parameters`].
    pub free: &'a [Parameter],
    /// A row for each curve.
    pub rows: &'a [CurveRow],
    /// Function that states in words how the user takes a [`Remedy`], a step that removes the cause
    /// of an error or a warning. The words name an option of the command line, a row of the
    /// explorer or an argument of Python.
    pub wording: Wording,
}

/// Median and quartiles of a parameter over curves, and the number of these curves.
struct Distribution {
    quartiles: [f64; 3],
    count: usize,
}

impl Distribution {
    /// Returns the distribution of some values; `None` if there are no values.
    fn new(mut values: Vec<f64>) -> Option<Self> {
        values.sort_by(f64::total_cmp);
        Some(Distribution {
            quartiles: quartiles(&values)?,
            count: values.len(),
        })
    }

    /// Returns a sentence on the distribution of a parameter. `curves` states in words over which
    /// curves.
    fn sentence(&self, parameter: Parameter, curves: &str) -> String {
        let row = parameter.row();
        let [lower, median, upper] = self.quartiles;
        let first_letter = row.term[..1].to_uppercase();
        let other_letters = &row.term[1..];
        let symbol = row.symbol;
        let median = format_quantity(median, row.unit);
        let quartiles = format_range((lower, upper), 4, row.unit);
        let count = counted(self.count as u64, "curve");
        format!(
            "{first_letter}{other_letters} {symbol}: median {median}, quartiles {quartiles}, over {count} {curves}."
        )
    }
}

/// Values of the first free parameter on the curves that the model describes, and on the other
/// curves.
struct FirstParameter {
    described: Vec<f64>,
    others: Vec<f64>,
}

impl FirstParameter {
    /// Returns the values on all curves, beginning with the curves that the model describes.
    fn all(&self) -> Vec<f64> {
        [self.described.as_slice(), &self.others].concat()
    }
}

impl FitsReport<'_> {
    /// Returns the rows of the curves that were not read or not fitted. The field
    /// [`CurveRow::error`] of such a row states the reason.
    pub fn failures(&self) -> impl Iterator<Item = &CurveRow> {
        self.rows.iter().filter(|row| !row.error.is_empty())
    }

    /// Returns for each of the [`Self::failures`] a text with the file and the reason.
    fn failures_in_words(&self) -> Vec<String> {
        self.failures()
            .map(|row| format!("{}: {}", row.file, row.error))
            .collect()
    }

    /// Returns an error message if no curve was fitted. The message states each file with its
    /// reason. Returns `None` if at least one curve was fitted, whether the model describes it or
    /// not.
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
    /// names the files of the curves to which the reason applies.
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

    /// Returns the premises of the model that some of the fitted scenes do not meet, with one text
    /// for each premise. The text states the number of curves with such a scene, and the values for
    /// the first of these curves.
    pub fn warning_texts(&self) -> Vec<String> {
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
    fn text(&self) -> Option<String> {
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
        sentences_section(&mut sheet, &self.warning_texts());
        Some(sheet.into_text())
    }

    fn json(&self) -> Option<Box<dyn Json + '_>> {
        let values = self.first_parameter();
        Some(Box::new(FitsJson {
            parameter: self.free.first().map(|parameter| parameter.name()),
            all: DistributionJson::new(values.all()),
            described: DistributionJson::new(values.described),
            spreads: self.spreads(),
            warnings: self.warning_texts(),
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

/// Range of a bar of a histogram along the horizontal axis, and range along the vertical axis.
type Bar = ((f64, f64), (f64, f64));

/// Histogram of the first parameter over the curves.
struct Histogram {
    described: Vec<Bar>,
    /// Bars of the curves that the model does not describe. They are stacked on the bars of the
    /// described curves.
    others: Vec<Bar>,
    /// Largest number of curves in a bar, at least 1.
    most: f64,
}

impl Histogram {
    fn new(values: &FirstParameter) -> Self {
        let all = values.all();
        // If all values are equal, `Span::around` returns a range with these values in its middle.
        let Span { low, high } = Span::around(all.iter().copied(), 0.0);
        let (fewest, most) = BARS;
        let bars = ((all.len() as f64).sqrt().ceil() as usize).clamp(fewest, most);
        let width = (high - low) / bars as f64;

        let mut histogram = Histogram {
            described: Vec::new(),
            others: Vec::new(),
            most: 1.0,
        };
        let described_counts = counts(&values.described, bars, low, width);
        let other_counts = counts(&values.others, bars, low, width);
        for bar in 0..bars {
            let described = described_counts[bar];
            let others = other_counts[bar];
            let edges = (low + width * bar as f64, low + width * (bar + 1) as f64);
            if described > 0.0 {
                histogram.described.push((edges, (0.0, described)));
            }
            if others > 0.0 {
                histogram
                    .others
                    .push((edges, (described, described + others)));
            }
            histogram.most = histogram.most.max(described + others);
        }
        histogram
    }
}

/// Returns the number of values in each of `bars` bars of equal width. The first bar begins at
/// `low`. A value at the upper end belongs to the last bar.
fn counts(values: &[f64], bars: usize, low: f64, width: f64) -> Vec<f64> {
    let mut counts = vec![0.0; bars];
    for value in values {
        let bar = ((value - low) / width).min(bars as f64 - 1.0) as usize;
        counts[bar] += 1.0;
    }
    counts
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
    /// Premises of the model that some of the fitted scenes do not meet.
    warnings: Vec<String>,
    curves: Option<Table<'a>>,
    scene: &'a Scene,
}

#[derive(Serialize)]
struct DistributionJson {
    median: f64,
    quartiles: [f64; 2],
    curves: usize,
}

impl DistributionJson {
    fn new(values: Vec<f64>) -> Option<Self> {
        let distribution = Distribution::new(values)?;
        let [lower, median, upper] = distribution.quartiles;
        Some(DistributionJson {
            median,
            quartiles: [lower, upper],
            curves: distribution.count,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use asperity_scene::open;

    fn row(file: &str, work: f64, described: bool) -> CurveRow {
        CurveRow {
            file: file.to_owned(),
            parameters: vec![
                [work, 0.9 * work, 1.1 * work].map(Some),
                [None, Some(2e6), None],
            ],
            facts: [
                1e-6, 0.05, 0.5, 0.01, 0.75, 1e-9, 2.0, 0.04, 0.0, 1e-6, 2e-6,
            ]
            .map(Some),
            points: Some(400),
            described: Some(described),
            description: if described { "within the noise" } else { "no" }.to_owned(),
            reason: if described {
                String::new()
            } else {
                "The force, \"drifts\".".to_owned()
            },
            warnings: if described {
                Vec::new()
            } else {
                let springs = (1e6 * work) as u64 % 20;
                [
                    Warning::ContactAtEnds { length: work },
                    Warning::FewSpringsInContact { springs },
                ]
                .iter()
                .map(RowWarning::of)
                .collect()
            },
            error: String::new(),
        }
    }

    /// Returns a report written in each of six formats; `None` for a format that this report does
    /// not have.
    fn written(report: &FitsReport<'_>) -> [Option<Vec<u8>>; 6] {
        use crate::report::Format::{Csv, Json, Pdf, Png, Svg, Text};
        [Text, Json, Csv, Svg, Png, Pdf].map(|format| {
            let mut bytes = Vec::new();
            crate::report::write(&mut bytes, report, format, "")
                .ok()
                .map(|()| bytes)
        })
    }

    /// Every mixture of curves that are described, not described or not fitted can be written in
    /// all formats. If no curve is fitted, there are no pictures, and the error message names the
    /// files.
    #[test]
    fn tables_have_all_forms_for_every_mixture_of_curves() {
        let document = open("jkr-sphere").unwrap();
        for number in 0..64 {
            let counts = [number % 4, number / 4 % 4, number / 16];
            let described = (0..counts[0])
                .map(|index| row(&format!("d{index}"), 0.05 + 0.01 * f64::from(index), true));
            let others = (0..counts[1]).map(|index| row(&format!("n{index}"), 0.2, false));
            let failed = (0..counts[2]).map(|index| CurveRow {
                file: format!("f{index}"),
                error: format!("reason {index}"),
                ..CurveRow::default()
            });
            let rows: Vec<CurveRow> = described.chain(others).chain(failed).collect();
            let free = [Parameter::Work, Parameter::Modulus];
            let report = FitsReport {
                wording: |remedy| format!("{remedy:?}"),
                scene: document.scene(),
                free: &free,
                rows: &rows,
            };
            let [text, json, csv, pictures @ ..] = written(&report);
            let fitted = counts[0] + counts[1];
            assert!(
                pictures
                    .iter()
                    .all(|picture| picture.is_some() == (fitted > 0)),
                "{counts:?}"
            );
            let text = String::from_utf8(text.unwrap()).unwrap();
            let json: serde_json::Value = serde_json::from_slice(&json.unwrap()).unwrap();
            assert_eq!(
                csv.unwrap().split(|byte| *byte == b'\n').count(),
                rows.len() + 2
            );
            assert_eq!(json["curves"].as_array().unwrap().len(), rows.len());
            for (name, count) in [("described", counts[0]), ("all", fitted)] {
                let found = json[name]["curves"].as_i64().unwrap_or_default();
                assert_eq!(
                    (found, json[name].is_null()),
                    (count.into(), count == 0),
                    "{counts:?}"
                );
            }
            let [median, only] = [
                json["all"]["median"].as_f64(),
                json["described"]["median"].as_f64(),
            ];
            assert_eq!(median.is_some(), fitted > 0);
            let expected = (counts[0] > 0).then_some(0.05 + 0.005 * f64::from(counts[0] - 1));
            assert_eq!(only.is_some(), expected.is_some());
            assert!(
                (only.unwrap_or(0.0) - expected.unwrap_or(0.0)).abs() < 1e-12,
                "{only:?} {expected:?}"
            );
            assert!(!text.contains("NaN") && !text.contains("inf"), "{text}");
            assert!(
                rows.iter()
                    .all(|row| text.contains(&row.file) && text.contains(&row.error)),
                "{text}"
            );
            assert_eq!(text.contains("drifts"), counts[1] > 0, "{text}");
            assert_eq!(report.failures().count(), counts[2] as usize);
            let failure = report.failure().unwrap_or_default();
            assert_eq!(failure.is_empty(), fitted > 0, "{counts:?} {failure}");
            let is_named =
                |row: &CurveRow| failure.contains(&format!("{}: {}", row.file, row.error));
            assert!(fitted > 0 || rows.iter().all(is_named), "{failure}");
        }
    }

    /// Each premise is stated only once, with the number of fitted curves for which it is not met,
    /// and with the values of the first of these curves.
    #[test]
    fn premises_are_counted_over_the_fitted_curves() {
        let failed = CurveRow {
            error: "no".into(),
            ..CurveRow::default()
        };
        let all = [
            row("a", 0.05, true),
            row("b", 0.2, false),
            row("c", 0.1, false),
            failed,
        ];
        let document = open("jkr-sphere").unwrap();
        let texts = |rows: &[CurveRow]| {
            let report = FitsReport {
                wording: |remedy| format!("{remedy:?}"),
                scene: document.scene(),
                free: &[Parameter::Work],
                rows,
            };
            let warnings = report.warning_texts();
            let text = report.text().unwrap().replace('\n', " ");
            let mut bytes = Vec::new();
            report.json().unwrap().write_json(&mut bytes, &[]).unwrap();
            let json: serde_json::Value = serde_json::from_slice(&bytes).unwrap();
            assert_eq!(text.contains("Warnings"), !warnings.is_empty());
            assert_eq!(json["warnings"], serde_json::json!(warnings));
            warnings
        };
        let of_all = texts(&all);
        let ends = Warning::ContactAtEnds { length: 0.2 };
        assert_eq!(of_all.len(), 2);
        assert_eq!(of_all[0], format!("On 2 of 3 curves: {ends}"));
        assert_eq!(texts(&all[1..2])[0], ends.to_string());
        assert_eq!(texts(&all[..1]), [""; 0]);
        assert_eq!(texts(&all[3..]), [""; 0]);
        assert_eq!(texts(&[]), [""; 0]);
    }

    #[test]
    fn the_title_of_a_figure_counts_its_curves() {
        let document = open("jkr-sphere").unwrap();
        let rows = [row("a", 0.05, true), row("b", 0.06, true)];
        for (count, title) in [(1, "1 curve"), (2, "2 curves")] {
            let report = FitsReport {
                wording: |remedy| format!("{remedy:?}"),
                scene: document.scene(),
                free: &[Parameter::Work, Parameter::Modulus],
                rows: &rows[..count],
            };
            assert_eq!(report.figure().unwrap().title, title);
        }
    }

    #[test]
    fn a_message_names_a_few_of_many_files() {
        let rows: Vec<CurveRow> = (0..40)
            .map(|index| CurveRow {
                file: format!("{index}.csv"),
                error: "no".into(),
                ..CurveRow::default()
            })
            .collect();
        let document = open("jkr-sphere").unwrap();
        let report = FitsReport {
            wording: |remedy| format!("{remedy:?}"),
            scene: document.scene(),
            free: &[Parameter::Work],
            rows: &rows,
        };
        let expected =
            "no curve was fitted: 0.csv: no; 1.csv: no; 2.csv: no; 3.csv: no; and 36 others";
        assert_eq!(report.failure().as_deref(), Some(expected));
    }

    /// A row can be read from its line in the CSV table. A damaged line is refused.
    #[test]
    fn rows_come_back_from_the_table() {
        let failed = CurveRow {
            file: "a, b.csv".into(),
            error: "no contact; allowed: one".into(),
            ..CurveRow::default()
        };
        let rows = [
            row("a.csv", 0.05, true),
            row("b \"x\".csv", 0.06, false),
            failed,
        ];
        let (document, free) = (
            open("jkr-sphere").unwrap(),
            [Parameter::Work, Parameter::Modulus],
        );
        let report = FitsReport {
            wording: |remedy| format!("{remedy:?}"),
            scene: document.scene(),
            free: &free,
            rows: &rows,
        };
        let mut text = Vec::new();
        report.table().unwrap().write_csv(&mut text, "").unwrap();
        let text = String::from_utf8(text).unwrap();
        let read: Vec<_> = text
            .lines()
            .skip(1)
            .map(|line| CurveRow::from_line(line, 2))
            .collect();
        assert_eq!(read, rows.map(Some));
        let line = text.lines().nth(2).unwrap();
        assert!((0..line.len()).all(|end| CurveRow::from_line(&line[..end], 2).is_none()));
        assert_eq!(CurveRow::from_line(line, 1), None);
    }
}
