//! Report on a fit to one measured curve, as text, JSON, a table and a figure with residuals.

use crate::fit_parameters::ParametersSection;
use crate::report::{Json, Report};
use crate::sheet::Sheet;
use crate::warnings::{sentences_section, warning_texts};
use crate::words::percent;
use asperity_data::{AxisScale, Table, Wording, format_quantity, format_rounded, grouped};
use asperity_experiment::{
    CurveFeatures, DragForce, FitResult, FittedParameter, Grade, MeasuredCurve, Parameter, Reason,
};
use asperity_plot::{Chart, ChartAxis, Figure, Ink, Label, Layer, Shape, Sign, Span, Stroke};
use serde::Serialize;
use std::f64::consts::PI;

const ROUGH: &str = "These errors leave out the error of the model: the pull-off force of rough bodies differs from three \
    dimensions by about 30 % where much of the surface adheres, else by a factor of 2 to 3.";

/// Report on a fit of a scene to one measured force curve. It has the fitted parameters, and a
/// figure with the measured curve, the computed curve and their difference.
#[derive(Clone, Copy, Debug)]
pub struct FitReport<'a> {
    /// Name of the file of the curve, which is the title of the report.
    pub title: &'a str,
    /// Measured force curve to which the scene was fitted.
    pub curve: &'a MeasuredCurve,
    /// Fitted parameters of the scene, and how well the scene with these parameters describes the
    /// curve.
    pub fit: &'a FitResult,
    /// Function that states in words how the user takes a [`Remedy`](asperity_data::Remedy), a step
    /// that removes the cause of an error or a warning. The words name an option of the command
    /// line, a row of the explorer or an argument of Python.
    pub wording: Wording,
}

/// JSON object of a fit in SI units, with features of the measured curve.
#[derive(Serialize)]
struct FitJson<'a> {
    #[serde(flatten)]
    fit: &'a FitResult,
    described: bool,
    noise: f64,
    /// Numbers that follow from the measured curve alone, without the scene.
    curve: CurveFeatures,
    drag: Option<DragForce>,
    /// Work of adhesion in J/m² that the drag during the retraction would add to γ, if the drag had
    /// not been subtracted.
    drag_work: Option<f64>,
    pull_off_force: Option<f64>,
    pull_off_work: Option<f64>,
    points_used: usize,
    points_left_out: usize,
    /// Sentences on the assumptions that were made when the curve was read.
    reading: Vec<String>,
    /// Sentences of [`FitReport::warnings`].
    warnings: Vec<String>,
}

impl Report for FitReport<'_> {
    fn warnings(&self) -> Vec<String> {
        warning_texts(&self.fit.warnings)
    }

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
        let parameters = ParametersSection {
            fit,
            is_shown: |_| true,
            wording: self.wording,
        };
        parameters.add(&mut sheet);
        self.add_residual(&mut sheet);
        self.add_adhesion(&mut sheet);
        self.add_drag(&mut sheet);
        if let Some(number) = fit.tabor {
            let number = format_quantity(number, "1");
            sheet.paragraph(&format!("Tabor number μ = {number}."));
        }
        self.add_correlations(&mut sheet);
        if fit.document.scene().roughness.is_some() {
            sheet.paragraph(ROUGH);
        }
        sentences_section(&mut sheet, &self.warnings());
        Some(sheet.into_text())
    }

    fn json(&self) -> Option<Box<dyn Json + '_>> {
        let pull_off_force = self.curve.pull_off_force();
        Some(Box::new(FitJson {
            described: self.fit.describes(),
            fit: self.fit,
            noise: self.curve.noise,
            curve: self.curve.features,
            drag: self.curve.drag,
            drag_work: self.drag_work(),
            pull_off_force,
            pull_off_work: pull_off_force.and_then(|force| self.pull_off_work(force)),
            points_used: self.curve.points,
            points_left_out: self.curve.missing,
            reading: self.assumptions().collect(),
            warnings: self.warnings(),
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
            Layer::new("model".into(), Ink::Series(1), computed),
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
    /// Returns sentences on the difference between model and curve; `None` if the model describes
    /// the curve within its noise.
    fn not_described(&self) -> Option<String> {
        let fit = self.fit;
        let reason = fit.reason.as_ref()?.note().in_words(self.wording);
        let intervals = if fit.has_other_profile() {
            "are the whole ranges of the search, since each profile gives other values"
        } else {
            "are by the scatter over parts of the curve"
        };
        let agreement = fit.agreement;
        let misfit = if fit.misfit > FitResult::MOST_MISFIT {
            let misfit = format_rounded(fit.misfit, 3, "1");
            let most = FitResult::MOST_MISFIT;
            format!(" It does not within the noise: the misfit is {misfit}, above {most}.")
        } else {
            String::new()
        };
        let described = match fit.grade {
            Grade::Roughly => {
                format!("The model describes the curve roughly, {agreement}.{misfit}")
            }
            Grade::No => {
                format!("The model does not describe the curve: it agrees {agreement}.{misfit}")
            }
            _ => format!("The model describes the curve {agreement}.{misfit}"),
        };
        let is_within_noise = fit.misfit <= FitResult::MOST_MISFIT;
        if is_within_noise && matches!(fit.reason, Some(Reason::StiffnessFarFromStated { .. })) {
            return Some(format!("{described} {reason}"));
        }
        Some(format!("{described} {reason} The intervals {intervals}."))
    }

    /// Returns what a reader of the fitted values has to know, in the words of the text: that the
    /// model does not describe the curve, statements on the curve for which a step helps, and the
    /// premises that the scene with the fitted values does not meet.
    fn warnings(&self) -> Vec<String> {
        let mut warnings: Vec<String> = self.not_described().into_iter().collect();
        let statements = self.curve.statements.iter();
        warnings.extend(
            statements
                .filter(|statement| statement.remedies().next().is_some())
                .map(|statement| statement.in_words(self.wording)),
        );
        warnings.extend(warning_texts(&self.fit.warnings));
        warnings
    }

    /// Returns the assumptions that were made when the curve was read and when the scene was
    /// fitted.
    fn assumptions(&self) -> impl Iterator<Item = String> {
        let notes = self.curve.statements.iter().chain(&self.fit.assumptions);
        notes.map(|note| note.in_words(self.wording))
    }

    /// Adds sentences on the residual and on the misfit. Both are computed from the same points.
    fn add_residual(&self, sheet: &mut Sheet) {
        let fit = self.fit;
        let agreement = fit.agreement;
        let residual = format_quantity(fit.residual, "N");
        let of_force = percent(agreement.residual_over_largest_force, 2);
        let over_noise = format_quantity(fit.residual_over_noise, "1");
        let noise = format_quantity(self.curve.noise, "N");
        let points = grouped(agreement.points as u64);
        let curves = grouped(fit.evaluations as u64);
        sheet.heading(&format!(
            "Residual {residual}, {of_force} of the largest force and {over_noise} times the noise of {noise}, over {points} points \
             in contact. {curves} curves were computed."
        ));
        let beyond = percent(agreement.beyond_one_percent, 2);
        let mut parts =
            format!("{beyond} of these points deviate by more than 1 % of the largest force");
        if let Some(distance) = agreement.off_at_jumps {
            let at_jumps = percent(agreement.at_jumps, 2);
            let distance = format_rounded(distance, 2, "m");
            parts += &format!("; {at_jumps} more, at the jumps, are up to {distance} off");
        }
        sheet.paragraph(&format!("{parts}."));
        let misfit = format_rounded(fit.misfit, 3, "1");
        let most = FitResult::MOST_MISFIT;
        sheet.paragraph(&format!(
            "Misfit {misfit}: residual in contact over the noise, in which points near jumps and outliers count less. Up to \
             {most} the model describes the curve within its noise."
        ));
    }

    /// Adds the upper bound of the work of adhesion, the pull-off force, and the work of adhesion
    /// of a smooth sphere with this pull-off force.
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

    /// Adds how much work of adhesion the drag would have simulated, if it had not been subtracted.
    fn add_drag(&self, sheet: &mut Sheet) {
        let Some(work) = self.drag_work() else {
            return;
        };
        let work = format_quantity(work, "J/m²");
        sheet.paragraph(&format!(
            "The drag on the retraction was taken off. Left in, it would add about {work} to γ."
        ));
    }

    /// Returns the work of adhesion in J/m² that the drag during the retraction would add to γ.
    /// `None` if there is no drag, or if the body is not a smooth sphere.
    fn drag_work(&self) -> Option<f64> {
        self.pull_off_work(-self.curve.drag?.pulled)
    }

    /// Adds the largest correlation between parameters, and the parameters that the curve cannot
    /// determine separately.
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
            // For the work of adhesion, `add_adhesion` already states the upper bound.
            let is_work = first == Parameter::Work && second == Parameter::Work;
            let is_at_end = first == second
                && fit
                    .parameters
                    .iter()
                    .any(|fitted| fitted.parameter == first && fitted.at_end.is_some());
            if !(is_work && fit.work_at_most.is_some() || is_at_end) {
                sheet.paragraph(&separation(first, second));
            }
        }
    }

    /// Returns the work of adhesion in J/m² of a smooth sphere with the pull-off force `force` in
    /// N, by the theory of Johnson, Kendall and Roberts; `None` for another body.
    pub(super) fn pull_off_work(&self, force: f64) -> Option<f64> {
        let scene = self.fit.document.scene();
        let radius = scene.form.as_ref()?.sphere_radius()?;
        if scene.roughness.is_some() {
            return None;
        }
        Some(force / (1.5 * PI * radius))
    }
}

/// Returns a fitted value with the half-width of its interval, such as `γ = 50 ± 2 mJ/m²`, or its
/// bound. The blanks in this text are no-break spaces, so that no line break can divide it.
fn with_half_width(fitted: &FittedParameter) -> String {
    let symbol = fitted.parameter.row().symbol;
    if let Some(bound) = fitted.bound() {
        return format!("{symbol} {bound}").replace(' ', "\u{a0}");
    }
    let (low, high) = fitted.interval;
    let value = fitted.text(fitted.value);
    let half_width = fitted.text(0.5 * (high - low));
    format!("{symbol} = {value} ± {half_width}").replace(' ', "\u{a0}")
}

/// Returns a linear axis that contains the vertical coordinates of these points and a margin.
fn vertical_axis(points: &[(f64, f64)], name: &str, symbol: &str, unit: &str) -> ChartAxis {
    let span = Span::around(points.iter().map(|point| point.1), 0.06);
    ChartAxis::new(AxisScale::Linear, span, name, symbol, unit)
}

/// Returns a sentence on two parameters that the curve does not determine separately. If the two
/// are the same, the sentence states that the curve does not determine this parameter.
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
