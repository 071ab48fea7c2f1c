//! Fits to many curves: a row for each curve as text, JSON and a table, and the distribution of the
//! results as a figure.

use crate::fit::FitReport;
use crate::report::{Json, Report};
use crate::sheet::Sheet;
use asperity_data::{AxisScale, Control, Kind, Table};
use asperity_data::{
    format_quantity, format_range, format_within, grouped, object, one_unit, printable, quartiles,
};
use asperity_experiment::{Fit, MeasuredCurve, Parameter};
use asperity_plot::{Chart, ChartAxis, Figure, Ink, Label, Layer, Shape, Span};
use asperity_scene::Scene;
use std::fmt::Display;

/// Smallest and largest number of bars of a histogram.
const BARS: (usize, usize) = (5, 40);
/// Largest number of curves that a sentence names.
const MOST_NAMES: usize = 4;

/// One measured curve of many, with the result of its fit or with the reason why it was not fitted.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CurveRow {
    /// Path of the file of the curve, as the user gave it.
    pub file: String,
    /// For each free parameter its value and both ends of its 95 % interval, in SI units; empty if
    /// the curve was not fitted.
    pub parameters: Vec<[f64; 3]>,
    /// Pull-off force in N, work of adhesion in J/m² of a smooth sphere with this pull-off force,
    /// rms residual divided by the noise of the force,
    /// [misfit](asperity_experiment::FitResult::misfit), and this noise in N; `None` for an unknown
    /// number.
    pub facts: [Option<f64>; 5],
    /// Number of points of the curve that are used; `None` if the curve was not fitted.
    pub points: Option<u64>,
    /// True if the model describes the curve, with a
    /// [misfit](asperity_experiment::FitResult::misfit) of at most 1.5; `None` if the curve was not
    /// fitted.
    pub described: Option<bool>,
    /// Reason why the model does not describe the curve; empty if there is none.
    pub reason: String,
    /// Reason why the curve was not read or not fitted; empty if the curve was fitted.
    pub error: String,
}

/// Names of the columns after the parameters.
const FACTS: [&str; 5] = [
    "pull_off_force",
    "pull_off_work",
    "residual_over_noise",
    "misfit",
    "noise",
];

impl CurveRow {
    /// Runs `fit` on a curve and makes its row. If the curve was not read or the fit fails,
    /// [`Self::error`] has the reason.
    pub fn of(
        title: &str,
        curve: Result<MeasuredCurve, impl Display>,
        fit: &Fit<'_>,
        control: Control<'_>,
    ) -> Self {
        let curve = curve.map_err(|error| error.to_string());
        let fitted = curve.and_then(|curve| match fit.run(&curve, control) {
            Ok(fit) => Ok(CurveRow::fitted(&FitReport {
                title,
                curve: &curve,
                fit: &fit,
            })),
            Err(error) => Err(error.to_string()),
        });
        fitted.unwrap_or_else(|error| {
            let (file, error) = (title.to_owned(), printable(&error).into_owned());
            CurveRow {
                file,
                error,
                ..CurveRow::default()
            }
        })
    }

    /// Makes the row of a curve that was fitted.
    fn fitted(report: &FitReport<'_>) -> Self {
        let FitReport { title, curve, fit } = *report;
        let force = curve.pull_off_force();
        let work = force.and_then(|force| report.pull_off_work(force));
        let values = fit
            .parameters
            .iter()
            .map(|one| [one.value, one.interval.0, one.interval.1]);
        CurveRow {
            file: title.to_owned(),
            parameters: values.collect(),
            facts: [
                force,
                work,
                Some(fit.residual_over_noise),
                Some(fit.misfit),
                Some(curve.noise),
            ],
            points: Some(curve.points as u64),
            described: Some(fit.describes()),
            reason: fit
                .reason
                .map_or_else(String::new, |reason| reason.to_string()),
            error: String::new(),
        }
    }

    /// Reads a row from a line of a CSV table that [`FitsReport`] wrote; `None` for any other line.
    /// `parameters` is the number of free parameters.
    pub fn from_line(line: &str, parameters: usize) -> Option<Self> {
        let cells = cells_of(line)?;
        let (file, rest) = cells.split_first()?;
        if rest.len() != 3 * parameters + FACTS.len() + 4 {
            return None;
        }
        let number = |cell: &String| {
            if cell.is_empty() {
                Some(None)
            } else {
                cell.parse().ok().map(Some)
            }
        };
        let (values, rest) = rest.split_at(3 * parameters);
        let values = values
            .iter()
            .map(number)
            .collect::<Option<Vec<Option<f64>>>>()?;
        let values: Vec<f64> = values.into_iter().flatten().collect();
        let facts = rest[..FACTS.len()]
            .iter()
            .map(number)
            .collect::<Option<Vec<Option<f64>>>>()?;
        let [points, described, reason, error] = &rest[FACTS.len()..] else {
            return None;
        };
        Some(CurveRow {
            file: file.clone(),
            parameters: values
                .chunks_exact(3)
                .map(|one| [one[0], one[1], one[2]])
                .collect(),
            facts: facts.try_into().ok()?,
            points: points.parse().ok(),
            described: described.parse().ok(),
            reason: reason.clone(),
            error: error.clone(),
        })
    }
}

/// Returns the cells of a CSV line by RFC 4180; `None` if a quotation mark is open at the end.
fn cells_of(line: &str) -> Option<Vec<String>> {
    let (mut cells, mut cell, mut is_quoted) = (Vec::new(), String::new(), false);
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

/// Report on fits of one scene to many measured curves, each fitted on its own.
#[derive(Clone, Copy, Debug)]
pub struct FitsReport<'a> {
    /// Scene that is fitted to the curves.
    pub scene: &'a Scene,
    /// Free parameters of the fits, in the order of [`CurveRow::parameters`].
    pub free: &'a [Parameter],
    /// A row for each curve.
    pub rows: &'a [CurveRow],
}

/// Median and quartiles of a parameter over curves, and the number of these curves.
struct Distribution {
    quartiles: [f64; 3],
    count: usize,
}

impl FitsReport<'_> {
    /// Returns the rows of the curves that were not read or not fitted. [`CurveRow::error`] of each
    /// has the reason.
    pub fn failures(&self) -> impl Iterator<Item = &CurveRow> {
        self.rows.iter().filter(|row| !row.error.is_empty())
    }

    /// Returns an error message if no curve was fitted: each file with its reason. Returns `None`
    /// if at least one curve was fitted, whether the model describes it or not.
    pub fn failure(&self) -> Option<String> {
        let reasons: Vec<String> = self
            .failures()
            .map(|row| format!("{}: {}", row.file, row.error))
            .collect();
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

    /// Returns a sentence for each reason why the model does not describe a curve, with the files
    /// of these curves.
    fn reasons(&self) -> Vec<String> {
        let mut found: Vec<(&str, Vec<&str>)> = Vec::new();
        for row in self.rows.iter().filter(|row| row.described == Some(false)) {
            match found.iter_mut().find(|(reason, _)| *reason == row.reason) {
                Some((_, files)) => files.push(&row.file),
                None => found.push((&row.reason, vec![&row.file])),
            }
        }
        let sentence = |(reason, files): (&str, Vec<&str>)| {
            let curves = match files.len() {
                0..=MOST_NAMES => files.join(", "),
                count => format!("{} curves", grouped(count as u64)),
            };
            format!("The model does not describe {curves}. {reason}")
                .trim_end()
                .to_owned()
        };
        found.into_iter().map(sentence).collect()
    }

    /// Returns the values of the first free parameter, from curves that are described or from the
    /// others.
    fn values(&self, is_described: bool) -> Vec<f64> {
        let of = self
            .rows
            .iter()
            .filter(|row| row.described == Some(is_described));
        of.filter_map(|row| Some(row.parameters.first()?[0]))
            .collect()
    }

    fn distribution(mut values: Vec<f64>) -> Option<Distribution> {
        values.sort_by(f64::total_cmp);
        Some(Distribution {
            quartiles: quartiles(&values)?,
            count: values.len(),
        })
    }

    /// Returns sentences on the first parameter over the described curves and over all curves, and
    /// on curves without a fit.
    fn summary(&self) -> Vec<String> {
        let Some(row) = self.free.first().map(|one| one.row()) else {
            return Vec::new();
        };
        let sentence = |found: Distribution, of: &str| {
            let [lower, median, upper] = found.quartiles;
            let median = format_quantity(median, row.unit);
            let quartiles = format_range((lower, upper), 4, row.unit);
            let curves = if found.count == 1 { "curve" } else { "curves" };
            let count = grouped(found.count as u64);
            let name = format!(
                "{}{} {}",
                row.term[..1].to_uppercase(),
                &row.term[1..],
                row.symbol
            );
            format!("{name}: median {median}, quartiles {quartiles}, over {count} {curves} {of}.")
        };
        let (described, others) = (self.values(true), self.values(false));
        let mut text = Vec::new();
        let has_others = !others.is_empty();
        let all = Self::distribution([described.clone(), others].concat());
        text.extend(
            Self::distribution(described).map(|found| sentence(found, "that the model describes")),
        );
        text.extend(
            all.filter(|_| has_others)
                .map(|found| sentence(found, "in all, described or not")),
        );
        let without = self.failures().count();
        if without > 0 {
            text.push(format!(
                "Not read or not fitted: {} of {} curves.",
                grouped(without as u64),
                grouped(self.rows.len() as u64)
            ));
        }
        if !self.free.contains(&Parameter::Offset) && without < self.rows.len() {
            text.push(format!(
                "The offset was not fitted, so the intervals leave out that first touch is known to the distance of two points \
                 only: --free {} fits it.",
                Parameter::Offset.name()
            ));
        }
        text
    }
}

impl Report for FitsReport<'_> {
    fn text(&self) -> Option<String> {
        let mut sheet = Sheet::default();
        let first = self.free.first();
        let symbol = first.map_or(String::new(), |one| one.row().symbol.to_owned());
        let mut rows = vec![[
            "".to_owned(),
            symbol,
            "95 % interval".to_owned(),
            "described".to_owned(),
        ]];
        rows.extend(self.rows.iter().map(|row| {
            let text = |of: usize| {
                let found = first.zip(row.parameters.first());
                found.map_or_else(String::new, |(one, values)| {
                    format_within(values[of], 0.5 * (values[2] - values[1]), one.row().unit)
                })
            };
            let state = match row.described {
                Some(true) => "yes",
                Some(false) => "no",
                None => "-",
            };
            let interval = if row.parameters.is_empty() {
                String::new()
            } else {
                one_unit([text(1), text(2)])
            };
            [row.file.clone(), text(0), interval, state.to_owned()]
        }));
        sheet.table(&rows);
        let failures = self
            .failures()
            .map(|row| format!("{}: {}", row.file, row.error))
            .collect();
        for part in [failures, self.reasons(), self.summary()] {
            if let Some((first, others)) = part.split_first() {
                sheet.heading(first);
                others.iter().for_each(|sentence| sheet.paragraph(sentence));
            }
        }
        Some(sheet.into_text())
    }

    fn json(&self) -> Option<Box<dyn Json + '_>> {
        let distribution = |values: Vec<f64>| {
            let found = Self::distribution(values)?;
            let [lower, median, upper] = found.quartiles;
            Some(object! { "median": median, "quartiles": [lower, upper], "curves": found.count })
        };
        let (described, others) = (self.values(true), self.values(false));
        Some(Box::new(object! {
            "parameter": self.free.first().map(|one| one.name()),
            "described": distribution(described.clone()),
            "all": distribution([described, others].concat()),
            "curves": self.table(),
            "scene": self.scene,
        }))
    }

    fn table(&self) -> Option<Table<'_>> {
        let mut table =
            Table::of(|| self.rows.iter()).with("file", Kind::Text(0), |row| row.file.clone());
        for (index, one) in self.free.iter().enumerate() {
            for (of, end) in ["", "_low", "_high"].into_iter().enumerate() {
                let value =
                    move |row: &&CurveRow| row.parameters.get(index).map(|values| values[of]);
                table = table.with(format!("{}{end}", one.name()), Kind::Real, value);
            }
        }
        for (index, name) in FACTS.into_iter().enumerate() {
            table = table.real(name, move |row| row.facts[index]);
        }
        let table = table.with("points_used", Kind::Whole, |row| row.points);
        let table = table.with("described", Kind::Text(0), |row| row.described);
        let table = table.with("reason", Kind::Text(0), |row| row.reason.clone());
        Some(
            table
                .with("error", Kind::Text(0), |row| row.error.clone())
                .done(),
        )
    }

    fn figure(&self) -> Option<Figure> {
        let row = self.free.first()?.row();
        let (described, others) = (self.values(true), self.values(false));
        let all: Vec<f64> = described.iter().chain(&others).copied().collect();
        if all.is_empty() {
            return None;
        }
        // Equal values are in the middle of a range around them.
        let Span { low, high } = Span::around(all.iter().copied(), 0.0);
        let bars = ((all.len() as f64).sqrt().ceil() as usize).clamp(BARS.0, BARS.1);
        let width = (high - low) / bars as f64;
        let count = |values: &[f64], bar: usize| {
            let of =
                |value: &&f64| ((**value - low) / width).min(bars as f64 - 1.0) as usize == bar;
            values.iter().filter(of).count() as f64
        };
        let edges = |bar: usize| (low + width * bar as f64, low + width * (bar + 1) as f64);
        let (mut lower, mut upper, mut most) = (Vec::new(), Vec::new(), 1.0_f64);
        for bar in 0..bars {
            let (one, other) = (count(&described, bar), count(&others, bar));
            lower.extend((one > 0.0).then_some((edges(bar), (0.0, one))));
            upper.extend((other > 0.0).then_some((edges(bar), (one, one + other))));
            most = most.max(one + other);
        }
        let x = ChartAxis::new(
            AxisScale::Linear,
            Span::around(all.iter().copied(), 0.06),
            row.term,
            row.symbol,
            row.unit,
        );
        let y = ChartAxis::new(
            AxisScale::Linear,
            Span::around([0.0, most].into_iter(), 0.06),
            "curves",
            "",
            "1",
        );
        let mut layers = Vec::new();
        let named = [
            ("described", Ink::Contact, lower),
            ("not described", Ink::Quiet, upper),
        ];
        layers.extend(
            named
                .into_iter()
                .filter(|(.., boxes)| !boxes.is_empty())
                .map(|(name, ink, boxes)| Layer::new(name.into(), ink, Shape::Boxes(boxes))),
        );
        let notes = self
            .summary()
            .iter()
            .map(|sentence| Label::plain(sentence))
            .collect();
        let title = format!("{} curves", grouped(self.rows.len() as u64));
        Some(Figure {
            title,
            notes,
            charts: vec![Chart::new(x, y, layers)],
            size: Figure::SMALL,
            ..Figure::default()
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
            parameters: vec![[work, 0.9 * work, 1.1 * work], [2e6, 1e6, 3e6]],
            facts: [Some(1e-6), None, Some(0.5), Some(0.75), Some(1e-9)],
            points: Some(400),
            described: Some(described),
            reason: if described {
                String::new()
            } else {
                "The force, \"drifts\".".to_owned()
            },
            error: String::new(),
        }
    }

    /// The whole table in every format.
    fn written(report: &FitsReport<'_>) -> [Option<Vec<u8>>; 6] {
        use crate::report::Format::{Csv, Json, Pdf, Png, Svg, Text};
        [Text, Json, Csv, Svg, Png, Pdf].map(|format| {
            let mut bytes = Vec::new();
            crate::report::write(&mut bytes, report, format, "")
                .ok()
                .map(|()| bytes)
        })
    }

    /// Every mixture of curves that are described, not described and not fitted has all forms;
    /// without a fitted curve there are no pictures, and the failure names the files.
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
            scene: document.scene(),
            free: &[Parameter::Work],
            rows: &rows,
        };
        let expected =
            "no curve was fitted: 0.csv: no; 1.csv: no; 2.csv: no; 3.csv: no; and 36 others";
        assert_eq!(report.failure().as_deref(), Some(expected));
    }

    /// A row comes back from its line of the table; torn lines do not.
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
