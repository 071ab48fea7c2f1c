//! Work of adhesion of a rough body from many measured curves, as text, JSON, a table and a figure.

use crate::report::{Json, Report};
use crate::sheet::Sheet;
use crate::warnings::{counted_texts, sentences_section};
use crate::words::whole_percent;
use asperity_data::{
    AxisScale, Kind, Note, Remedy, Table, Wording, format_quantity, format_range, format_rounded,
    grouped, per_cent, plural,
};
use asperity_experiment::{CurveOfEnsemble, EnsembleFit, IntervalEstimate, SummaryDeviation};
use asperity_plot::{Chart, ChartAxis, Figure, Ink, Label, Layer, Shape, Sign, Span, Stroke};
use serde::Serialize;

/// Relative change of the rms height. The report states by how much this change would alter the
/// work of adhesion.
const HEIGHT_CHANGE: f64 = 0.05;

/// Change of the Hurst exponent. The report states by how much this change would alter the work of
/// adhesion.
const HURST_CHANGE: f64 = 0.05;

/// Usual range of a ratio: the scatter of the measured curves divided by the scatter of the
/// computed curves of random profiles.
const USUAL_SCATTER: [f64; 2] = [0.8, 1.2];

const INDEPENDENT: &str = "Each curve counts as a place with a profile of its own: places closer than the contact or the \
    longest wave are fewer than they seem.";

/// Report on the work of adhesion of a rough body, found by comparing measured force curves with
/// computed curves of random profiles.
#[derive(Clone, Copy, Debug)]
pub struct EnsembleFitReport<'a> {
    pub title: &'a str,
    /// Work of adhesion that follows from the curves, and its interval, as
    /// [`fit_ensemble`](asperity_experiment::fit_ensemble) returns them.
    pub fit: &'a EnsembleFit,
    /// True if the user stated a standard error of the rms height or of the Hurst exponent.
    pub has_roughness_errors: bool,
    /// Function that states in words how the user takes a [`Remedy`], a step that removes the cause
    /// of an error or a warning. The words name an option of the command line, a row of the
    /// explorer or an argument of Python.
    pub wording: Wording,
}

impl Report for EnsembleFitReport<'_> {
    /// Returns the premises of the model that random profiles with the fitted values do not meet.
    /// There is one text for each premise.
    fn warnings(&self) -> Vec<String> {
        counted_texts(&self.fit.warnings, EnsembleFit::EXAMINED)
    }

    fn text(&self) -> Option<String> {
        let fit = self.fit;
        let mut sheet = Sheet::default();
        if let Some(sentence) = self.not_described() {
            sheet.paragraph(&sentence);
        }
        sheet.heading(&format!("Many random profiles of {}", self.title));
        if let Some(sentence) = &fit.instrument {
            sheet.paragraph(sentence);
        }
        self.add_values(&mut sheet);
        self.add_causes_of_width(&mut sheet);
        self.add_effect_of_roughness(&mut sheet);
        sheet.heading("Each curve by itself");
        self.add_curves(&mut sheet);
        sheet.heading(&self.preloads());
        self.add_scatter(&mut sheet);
        if let Some(sentence) = self.foreign() {
            sheet.paragraph(&sentence);
        }
        let computed = grouped(fit.computed as u64);
        sheet.paragraph(&format!("{computed} curves were computed. {INDEPENDENT}"));
        sentences_section(&mut sheet, &self.warnings());
        Some(sheet.into_text())
    }

    fn json(&self) -> Option<Box<dyn Json + '_>> {
        Some(Box::new(EnsembleFitJson {
            fit: self.fit,
            warnings: self.warnings(),
        }))
    }

    fn table(&self) -> Option<Table<'_>> {
        let curves = &self.fit.curves;
        let longest_name = curves
            .iter()
            .map(|curve| curve.name.chars().count())
            .max()?;
        let table = Table::of(|| curves.iter())
            .with("curve", Kind::Text(longest_name), |curve| {
                curve.name.clone()
            })
            .real("preload", |curve| curve.preload)
            .real("pull_off_force", |curve| {
                curve.pull_off_force.unwrap_or(f64::NAN)
            })
            .real("loop_area", |curve| curve.loop_area)
            .real("stiffness", |curve| curve.stiffness)
            .real("work", |curve| curve.work.value)
            .real("work_low", |curve| curve.work.low)
            .real("work_high", |curve| curve.work.high)
            .whole("foreign", |curve| u64::from(curve.foreign));
        Some(table.done())
    }

    /// Returns a chart of the work of adhesion of each curve, with its interval. A band behind the
    /// curves shows the interval that follows from all curves together.
    fn figure(&self) -> Option<Figure> {
        let low = self.lowest_drawn();
        let note = match self.fit.work_at_most {
            Some(most) => {
                let most = format_rounded(most, 2, "J/m²");
                format!("all curves: γ is at most {most} (95 %)")
            }
            None => format!("all curves: γ = {}", with_interval(&self.fit.work, "J/m²")),
        };
        let chart = Chart::new(self.curve_axis(), self.work_axis(low), self.layers(low));
        Some(Figure {
            title: self.title.to_owned(),
            notes: vec![Label::plain(&note)],
            charts: vec![chart],
            size: Figure::SMALL,
            ..Figure::default()
        })
    }
}

/// JSON object of an [`EnsembleFit`] in SI units.
#[derive(Serialize)]
struct EnsembleFitJson<'a> {
    #[serde(flatten)]
    fit: &'a EnsembleFit,
    /// Premises of the model that random profiles with the fitted values do not meet.
    warnings: Vec<String>,
}

impl EnsembleFitReport<'_> {
    /// Adds the work of adhesion and the modulus, and the numbers of curves and profiles from which
    /// they follow.
    fn add_values(&self, sheet: &mut Sheet) {
        let fit = self.fit;
        let count = fit.curves.len();
        let curves = plural("curve", count as u64);
        let profiles = grouped(fit.profiles);
        let spectrum = if self.has_roughness_errors {
            "this roughness"
        } else {
            "exactly this roughness"
        };
        let origin = format!("from {count} {curves} and {profiles} random profiles of {spectrum}");
        match fit.work_at_most {
            Some(most) => {
                let most = format_rounded(most, 2, "J/m²");
                sheet.paragraph(&format!(
                    "γ is at most {most} (95 %), {origin}: curves without adhesion do not differ from these."
                ));
            }
            None => {
                let work = with_interval(&fit.work, "J/m²");
                sheet.paragraph(&format!("γ = {work}, {origin}."));
            }
        }
        if fit.modulus_is_given {
            let modulus = format_quantity(fit.modulus.value, "Pa");
            sheet.paragraph(&format!("E* = {modulus}, given."));
        } else {
            let modulus = with_interval(&fit.modulus, "Pa");
            let correlation = fit.correlation;
            sheet.paragraph(&format!(
                "E* = {modulus}. Correlation of γ and E*: {correlation:.2}."
            ));
        }
        if (fit.closing_over_opening - 1.0).abs() > 1e-9 {
            let ratio = format_quantity(fit.closing_over_opening, "1");
            sheet.paragraph(&format!(
                "Work of adhesion on closing over that on opening: {ratio}, as in the scene."
            ));
        }
    }

    /// Adds the reasons why the interval is wide, and how much more curves would narrow it.
    fn add_causes_of_width(&self, sheet: &mut Sheet) {
        let fit = self.fit;
        if fit.work_at_most.is_none() {
            let curves = whole_percent(fit.shares.places);
            let profiles = whole_percent(fit.shares.profiles);
            let mut causes =
                format!("{curves} by the number of curves, {profiles} by the number of profiles");
            if self.has_roughness_errors {
                let roughness = whole_percent(fit.shares.roughness);
                causes += &format!(", {roughness} by the errors of the roughness");
            }
            sheet.paragraph(&format!(
                "The squared width of the interval of γ: {causes}."
            ));
        }
        let mut prospects = Vec::with_capacity(fit.prospects.len());
        for prospect in &fit.prospects {
            let half_width = per_cent(prospect.half_width);
            prospects.push(format!("{} curves ± {half_width}", prospect.curves));
        }
        if !prospects.is_empty() {
            let profiles = grouped(fit.profiles);
            let prospects = prospects.join(", ");
            sheet.paragraph(&format!("With {profiles} profiles γ by {prospects}."));
        }
        if fit.at_end_of_table && fit.work_at_most.is_none() {
            sheet.paragraph(
                "The interval reaches the end of the computed values, and may be wider: more curves, or E* from another \
                 measurement.",
            );
        }
    }

    /// Adds the effect of errors of the roughness. The curves themselves cannot show such errors.
    fn add_effect_of_roughness(&self, sheet: &mut Sheet) {
        let mut errors = Note::new("The interval leaves out errors of the roughness.");
        if let Some(shifts) = self.fit.roughness {
            // The user can state errors only of a self-affine roughness, not of a measured
            // roughness.
            errors = errors.with(Remedy::RoughnessErrors);
            let step = per_cent(HEIGHT_CHANGE);
            let by_height = relative_change(shifts.work_by_height * HEIGHT_CHANGE);
            let by_hurst = relative_change(shifts.work_by_hurst * HURST_CHANGE);
            sheet.paragraph(&format!(
                "If the rms height h is larger by {step}, γ changes by {by_height}; if the Hurst exponent H is larger by \
                 {HURST_CHANGE}, by {by_hurst}. The curves cannot show it."
            ));
        }
        if !self.has_roughness_errors {
            sheet.paragraph(&errors.in_words(self.wording));
        }
    }

    /// Adds a table with the results that follow from each curve alone.
    fn add_curves(&self, sheet: &mut Sheet) {
        let header = [
            "curve",
            "pull-off",
            "loop area",
            "stiffness",
            "γ",
            "95 % interval",
        ];
        let mut rows = vec![header.map(String::from)];
        rows.extend(self.fit.curves.iter().map(row));
        sheet.table(&rows);

        let curves = self.fit.curves.iter();
        let at_end = curves.filter(|curve| curve.at_end_of_table).count();
        if at_end > 0 {
            let reach = if at_end == 1 { "reaches" } else { "reach" };
            sheet.paragraph(&format!(
                "{at_end} of these intervals {reach} the end of the computed values, and may be wider."
            ));
        }
    }

    /// Adds the scatter of the curves, and the reason if the scatter is unusual.
    fn add_scatter(&self, sheet: &mut Sheet) {
        let Some(ratio) = self.fit.scatter_ratio else {
            return;
        };
        let [smallest_usual, largest_usual] = USUAL_SCATTER;
        let why = if (smallest_usual..=largest_usual).contains(&ratio) {
            ""
        } else if ratio < 1.0 {
            ": the places may share parts of their profiles, or the roughness differs"
        } else {
            ": the work of adhesion or the roughness may vary from place to place"
        };
        sheet.paragraph(&format!(
            "Scatter of the curves over scatter of the profiles: {ratio:.2}{why}."
        ));
    }

    /// Returns sentences on the summaries (numbers that describe a curve) in which the measured
    /// curves differ from the computed curves; `None` if the random profiles describe the measured
    /// curves.
    fn not_described(&self) -> Option<String> {
        let deviations = self.fit.deviations.iter();
        let deviating: Vec<String> = deviations
            .filter(|deviation| deviation.deviates)
            .map(deviation_in_words)
            .collect();
        if deviating.is_empty() {
            return None;
        }
        Some(format!(
            "Random profiles of this roughness do not describe the curves; in the mean over all curves: {}. Roughness, \
             form, stiffness of the instrument or model differ, and the interval does not contain it.",
            deviating.join("; ")
        ))
    }

    fn preloads(&self) -> String {
        let preload = format_rounded(self.fit.preload, 3, "N");
        match self.fit.preload_scatter {
            Some(scatter) => format!(
                "Preloads of {preload} with a scatter of {}; the computed curves have the same.",
                per_cent(scatter)
            ),
            None => format!("Preload {preload}."),
        }
    }

    /// Returns sentences on foreign curves, which are farther from the random profiles than all but
    /// about one in a thousand computed curves; `None` if there is no such curve.
    fn foreign(&self) -> Option<String> {
        let foreign = self.fit.curves.iter().filter(|curve| curve.foreign);
        let names: Vec<&str> = foreign.map(|curve| curve.name.as_str()).collect();
        if names.is_empty() {
            return None;
        }
        Some(format!(
            "Foreign to this ensemble, as one curve in a thousand: {}. They count like the others; a fit without them \
             shows what they change.",
            names.join(", ")
        ))
    }

    /// Returns the lower end in J/m² of the interval of all curves, as the chart shows it. The axis
    /// is logarithmic and cannot show 0. Therefore an interval that begins at 0 is drawn from the
    /// lowest end of the intervals of single curves.
    fn lowest_drawn(&self) -> f64 {
        let work = self.fit.work;
        if work.low > 0.0 {
            return work.low;
        }
        let lows = self.fit.curves.iter().map(|curve| curve.work.low);
        lows.fold(work.value, f64::min)
    }

    fn curve_axis(&self) -> ChartAxis {
        let span = Span {
            low: 0.5,
            high: self.fit.curves.len() as f64 + 0.5,
        };
        ChartAxis::new(AxisScale::Linear, span, "number of the curve", "", "1")
    }

    /// Returns the axis of the work of adhesion. `low` is the lower end in J/m² at which the
    /// interval of all curves is drawn.
    fn work_axis(&self, low: f64) -> ChartAxis {
        let mut ends = Vec::with_capacity(2 * self.fit.curves.len() + 2);
        for curve in &self.fit.curves {
            ends.extend([curve.work.low, curve.work.high]);
        }
        ends.extend([low, self.fit.work.high]);
        let scale = AxisScale::Logarithmic;
        let coordinates = ends.into_iter().map(|work| scale.coordinate(work));
        let span = Span::around(coordinates, 0.06);
        ChartAxis::new(scale, span, "work of adhesion", "γ", "J/m²")
    }

    /// Returns the layers of the chart: the interval and the value that follow from all curves, and
    /// those of each single curve. `low` is the lower end in J/m² at which the interval of all
    /// curves is drawn.
    fn layers(&self, low: f64) -> Vec<Layer> {
        let IntervalEstimate { value, high, .. } = self.fit.work;
        let left = 0.5;
        let right = self.fit.curves.len() as f64 + 0.5;
        let band = Shape::Band(vec![(left, low, high), (right, low, high)]);
        let mut layers = vec![Layer::new("95 % interval of all".into(), Ink::Quiet, band)];

        let mut usual = Vec::new();
        let mut foreign = Vec::new();
        for (number, curve) in (1..).map(f64::from).zip(&self.fit.curves) {
            let ends = vec![(number, curve.work.low), (number, curve.work.high)];
            layers.push(Layer::unnamed(Ink::Kept, Shape::line(ends, Stroke::Solid)));
            let points = if curve.foreign {
                &mut foreign
            } else {
                &mut usual
            };
            points.push((number, curve.work.value));
        }
        let level = Shape::Level(value);
        layers.push(Layer::new("all curves".into(), Ink::Series(1), level));
        if !usual.is_empty() {
            let name = "one curve, 95 % interval".into();
            layers.push(Layer::new(name, Ink::Text, Shape::signs(usual, Sign::Dot)));
        }
        if !foreign.is_empty() {
            let signs = Shape::signs(foreign, Sign::Dot);
            layers.push(Layer::new("foreign curve".into(), Ink::Cursor, signs));
        }
        layers
    }
}

/// Returns as text the relative change of a quantity whose natural logarithm changes by `change`.
fn relative_change(change: f64) -> String {
    format!("{:+.0} %", 100.0 * change.exp_m1())
}

/// Returns an estimate with its interval as text: `51.6 mJ/m², 38.5 to 71.0 mJ/m² (95 %)`.
fn with_interval(estimate: &IntervalEstimate, unit: &str) -> String {
    let value = format_rounded(estimate.value, 3, unit);
    let interval = format_range((estimate.low, estimate.high), 3, unit);
    format!("{value}, {interval} (95 %)")
}

/// Returns the row of a curve in the table of the text report.
fn row(curve: &CurveOfEnsemble) -> [String; 6] {
    let pull_off_force = curve
        .pull_off_force
        .map_or("-".to_owned(), |force| format_rounded(force, 3, "N"));
    let interval = format_range((curve.work.low, curve.work.high), 2, "J/m²");
    let mark = if curve.foreign { ", foreign" } else { "" };
    [
        curve.name.clone(),
        pull_off_force,
        format_rounded(curve.loop_area, 3, "J"),
        format_rounded(curve.stiffness, 3, "N/m"),
        format_rounded(curve.work.value, 3, "J/m²"),
        format!("{interval}{mark}"),
    ]
}

/// Returns a deviation as text: `pull-off force larger by 12 % (3.1 standard errors)`.
fn deviation_in_words(deviation: &SummaryDeviation) -> String {
    let direction = if deviation.logarithm > 0.0 {
        "larger"
    } else {
        "smaller"
    };
    let change = whole_percent(deviation.logarithm.abs().exp_m1());
    format!(
        "{} {direction} by {change} ({:.1} standard errors)",
        deviation.summary,
        deviation.deviation.abs()
    )
}
