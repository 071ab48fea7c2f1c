//! A fit as text, JSON, a table and a figure with residuals.

use crate::report::{Json, Report};
use crate::sheet::Sheet;
use crate::warnings::warnings_section;
use crate::words::percent;
use asperity_data::{AxisScale, Table, Wording, format_quantity, format_rounded, grouped};
use asperity_experiment::{FitResult, FittedParameter, MeasuredCurve, Parameter};
use asperity_plot::{Chart, ChartAxis, Figure, Ink, Label, Layer, Shape, Sign, Span, Stroke};
use serde::Serialize;
use std::f64::consts::PI;

const ROUGH: &str = "These errors leave out the error of the model: the adhesion force of rough bodies differs from three \
    dimensions by about 30 % where much of the surface adheres, else by a factor of 2 to 3.";

/// Report on a fit of a scene to one measured force curve. It has the fitted parameters, and a
/// figure with the measured curve, the computed curve and their difference.
#[derive(Clone, Copy, Debug)]
pub struct FitReport<'a> {
    /// Name of the file of the curve, which is the title of the report.
    pub title: &'a str,
    /// Measured force curve to which the scene was fitted.
    pub curve: &'a MeasuredCurve,
    /// Fitted parameters of the scene, and how well it describes the curve.
    pub fit: &'a FitResult,
    /// Words for the steps that help.
    pub wording: Wording,
}

/// Fit in SI units, with facts about its curve.
#[derive(Serialize)]
struct FitJson<'a> {
    #[serde(flatten)]
    fit: &'a FitResult,
    described: bool,
    noise: f64,
    pull_off_force: Option<f64>,
    pull_off_work: Option<f64>,
    points_used: usize,
    points_left_out: usize,
    /// Sentences on what was assumed when the curve was read.
    reading: Vec<String>,
}

impl Report for FitReport<'_> {
    fn text(&self) -> Option<String> {
        let fit = self.fit;
        let mut sheet = Sheet::default();
        if let Some(sentences) = self.not_described() {
            sheet.paragraph(&sentences);
        }
        sheet.heading(&format!("Curve {}", self.title));
        for sentence in self.assumptions() {
            sheet.paragraph(&sentence);
        }
        sheet.heading(&format!("Fit of {}", fit.document.title()));
        self.add_parameters(&mut sheet);
        self.add_residual(&mut sheet);
        self.add_adhesion(&mut sheet);
        if let Some(number) = fit.tabor {
            let number = format_quantity(number, "1");
            sheet.paragraph(&format!("Tabor number μ = {number}."));
        }
        self.add_correlations(&mut sheet);
        if fit.document.scene().roughness.is_some() {
            sheet.paragraph(ROUGH);
        }
        warnings_section(&mut sheet, &fit.warnings);
        Some(sheet.into_text())
    }

    fn json(&self) -> Option<Box<dyn Json + '_>> {
        let pull_off_force = self.curve.pull_off_force();
        Some(Box::new(FitJson {
            described: self.fit.describes(),
            fit: self.fit,
            noise: self.curve.noise,
            pull_off_force,
            pull_off_work: pull_off_force.and_then(|force| self.pull_off_work(force)),
            points_used: self.curve.points,
            points_left_out: self.curve.missing,
            reading: self.assumptions().collect(),
        }))
    }

    fn table(&self) -> Option<Table<'_>> {
        let curve = self.curve;
        let model = &self.fit.model;
        let table = Table::of(|| 0..curve.force.len())
            .real("displacement", |&point| curve.displacement[point])
            .real("force", |&point| curve.force[point])
            .real("model", |&point| model[point])
            .real("residual", |&point| curve.force[point] - model[point])
            .whole("segment", |&point| curve.segment[point] as u64);
        Some(table.done())
    }

    fn figure(&self) -> Option<Figure> {
        let curve = self.curve;
        let model = &self.fit.model;
        let points = curve.displacement.len();
        let mut measured = Vec::with_capacity(points);
        let mut computed = Vec::with_capacity(points);
        let mut residuals = Vec::with_capacity(points);
        for (index, &displacement) in curve.displacement.iter().enumerate() {
            let residual = curve.force[index] - model[index];
            measured.push((displacement, curve.force[index]));
            computed.push((displacement, model[index]));
            residuals.push((displacement, residual / curve.noise));
        }

        let span = Span::around(curve.displacement.iter().copied(), 0.03);
        let x = ChartAxis::new(AxisScale::Linear, span, "displacement", "D", "m");
        let force = vertical_axis(&measured, "force", "F", "N");
        let residual = vertical_axis(&residuals, "residual over noise", "", "1");
        let measured = Shape::signs(measured, Sign::Dot);
        let computed = Shape::line(computed, Stroke::Solid);
        let forces = vec![
            Layer::new("measured".into(), Ink::Kept, measured),
            Layer::new("model".into(), Ink::Contact, computed),
        ];
        let residuals = Shape::signs(residuals, Sign::Dot);
        let residuals = vec![
            Layer::unnamed(Ink::Quiet, Shape::Level(0.0)),
            Layer::new("measured".into(), Ink::Kept, residuals),
        ];

        let parameters: Vec<String> = self.fit.parameters.iter().map(with_half_width).collect();
        let note = format!("95 % intervals: {}", parameters.join(", "));
        Some(Figure {
            title: self.title.to_owned(),
            notes: vec![Label::plain(&note)],
            charts: vec![
                Chart::new(x.clone(), force, forces),
                Chart::new(x, residual, residuals),
            ],
            size: Figure::SMALL,
            ..Figure::default()
        })
    }
}

impl FitReport<'_> {
    /// Returns sentences on a curve that the model does not describe; `None` if it describes the
    /// curve.
    fn not_described(&self) -> Option<String> {
        let reason = self.fit.reason.as_ref()?.note().in_words(self.wording);
        let intervals = if self.fit.has_other_profile() {
            "are the whole ranges of the search, since each profile gives other values"
        } else {
            "are by the scatter over parts of the curve"
        };
        let misfit = format_rounded(self.fit.misfit, 3, "1");
        let most = FitResult::MOST_MISFIT;
        Some(format!(
            "The model does not describe the curve: the misfit is {misfit}, above {most}. {reason} The intervals {intervals}."
        ))
    }

    /// Returns what was assumed when the curve was read, and when it was fitted.
    fn assumptions(&self) -> impl Iterator<Item = String> {
        let notes = self.curve.statements.iter().chain(&self.fit.assumptions);
        notes.map(|note| note.in_words(self.wording))
    }

    /// Adds a table of the fitted parameters.
    fn add_parameters(&self, sheet: &mut Sheet) {
        let header = ["", "value", "95 % interval", "standard error", "start"];
        let mut rows = vec![header.map(String::from)];
        for fitted in &self.fit.parameters {
            let parameter = fitted.parameter.row();
            let (low, high) = fitted.interval;
            rows.push([
                format!("{} {}", parameter.term, parameter.symbol),
                fitted.text(fitted.value),
                format!("{} to {}", fitted.text(low), fitted.text(high)),
                format_quantity(fitted.noise_error, parameter.unit),
                format_quantity(fitted.start, parameter.unit),
            ]);
        }
        sheet.table(&rows);
    }

    /// Adds sentences on the residual and on the misfit.
    fn add_residual(&self, sheet: &mut Sheet) {
        let fit = self.fit;
        let residual = format_quantity(fit.residual, "N");
        let over_noise = format_quantity(fit.residual_over_noise, "1");
        let noise = format_quantity(self.curve.noise, "N");
        let beyond = percent(fit.beyond_five_sigma, 2);
        let curves = grouped(fit.evaluations as u64);
        sheet.heading(&format!(
            "Residual {residual}, {over_noise} times the noise of {noise}; {beyond} of the points deviate by more than 5 times \
             the noise. {curves} curves were computed."
        ));
        let misfit = format_rounded(fit.misfit, 3, "1");
        let most = FitResult::MOST_MISFIT;
        sheet.paragraph(&format!(
            "Misfit {misfit}: residual in contact over the noise, in which points near jumps and outliers count less. Up to \
             {most} the model describes the curve."
        ));
    }

    /// Adds the upper bound of the work of adhesion, and the pull-off force with the work of
    /// adhesion that follows from it.
    fn add_adhesion(&self, sheet: &mut Sheet) {
        if let Some(work) = self.fit.work_at_most {
            let work = format_rounded(work, 2, "J/m²");
            sheet.paragraph(&format!(
                "γ is at most {work}: a model without adhesion describes the curve equally well."
            ));
        }
        let Some(force) = self.curve.pull_off_force() else {
            return;
        };
        let work = match self.pull_off_work(force) {
            Some(work) => {
                let work = format_quantity(work, "J/m²");
                format!("; by itself, for any E* and k, it gives γ = F/(1.5πR) = {work}")
            }
            None => String::new(),
        };
        let force = format_quantity(force, "N");
        sheet.paragraph(&format!("Pull-off force of the curve {force}{work}."));
    }

    /// Adds the largest correlation, and the parameters that the curve does not separate.
    fn add_correlations(&self, sheet: &mut Sheet) {
        let fit = self.fit;
        let strongest = fit
            .correlations
            .iter()
            .max_by(|first, second| first.2.abs().total_cmp(&second.2.abs()));
        if let Some((first, second, correlation)) = strongest {
            let first = first.row().symbol;
            let second = second.row().symbol;
            sheet.paragraph(&format!(
                "Largest correlation: {first} and {second}, {correlation:.2}."
            ));
        }
        for &(first, second) in &fit.not_distinguished {
            // The upper bound of the work of adhesion has a sentence of its own.
            let is_work = first == Parameter::Work && second == Parameter::Work;
            if !(is_work && fit.work_at_most.is_some()) {
                sheet.paragraph(&separation(first, second));
            }
        }
    }

    /// Returns the work of adhesion in J/m² of a smooth sphere with this pull-off force in N
    /// (Johnson, Kendall and Roberts); `None` for another body.
    pub(super) fn pull_off_work(&self, force: f64) -> Option<f64> {
        let scene = self.fit.document.scene();
        let radius = scene.form.as_ref()?.sphere_radius()?;
        if scene.roughness.is_some() {
            return None;
        }
        Some(force / (1.5 * PI * radius))
    }
}

/// Writes a fitted value with half the width of its interval: `γ = 50 ± 2 mJ/m²`. No line breaks
/// inside.
fn with_half_width(fitted: &FittedParameter) -> String {
    let symbol = fitted.parameter.row().symbol;
    let (low, high) = fitted.interval;
    let value = fitted.text(fitted.value);
    let half_width = fitted.text(0.5 * (high - low));
    format!("{symbol} = {value} ± {half_width}").replace(' ', "\u{a0}")
}

/// Returns a linear axis with a margin around the second numbers of these points.
fn vertical_axis(points: &[(f64, f64)], name: &str, symbol: &str, unit: &str) -> ChartAxis {
    let span = Span::around(points.iter().map(|point| point.1), 0.06);
    ChartAxis::new(AxisScale::Linear, span, name, symbol, unit)
}

/// Returns a sentence on two parameters that the curve does not separate, or on one parameter that
/// it does not determine.
fn separation(first: Parameter, second: Parameter) -> String {
    let remedy = Parameter::remedy(first, second);
    let first = first.row().symbol;
    let second = second.row().symbol;
    if first == second {
        return format!(
            "The curve does not determine {first} within its range. It needs {remedy}."
        );
    }
    format!("The curve does not separate {first} and {second}. That needs {remedy}.")
}
