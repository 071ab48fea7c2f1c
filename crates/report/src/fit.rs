//! A fit as text, JSON, a table and a figure with residuals.

use crate::report::{Json, Report};
use crate::sheet::Sheet;
use crate::warnings::warnings_section;
use asperity_data::{AxisScale, Table, format_quantity, format_rounded, grouped};
use asperity_experiment::{FitResult, FittedParameter, MeasuredCurve, Parameter};
use asperity_plot::{Chart, ChartAxis, Figure, Ink, Label, Layer, Shape, Sign, Span, Stroke};
use serde::Serialize;
use std::f64::consts::PI;

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
    reading: Vec<&'a String>,
}

impl Report for FitReport<'_> {
    fn text(&self) -> Option<String> {
        let FitReport { title, curve, fit } = *self;
        let mut sheet = Sheet::default();
        if let Some(reason) = &fit.reason {
            let intervals = if fit.has_other_profile() {
                "are the whole ranges of the search, since each profile gives other values"
            } else {
                "are by the scatter over parts of the curve"
            };
            sheet.paragraph(&format!(
                "The model does not describe the curve: the misfit is {}, above {}. {reason} The intervals {intervals}.",
                format_rounded(fit.misfit, 3, "1"),
                FitResult::MOST_MISFIT,
            ));
        }
        sheet.heading(&format!("Curve {title}"));
        curve
            .statements
            .iter()
            .chain(&fit.assumptions)
            .for_each(|sentence| sheet.paragraph(sentence));
        sheet.heading(&format!("Fit of {}", fit.document.title()));
        let quantity =
            |one: &FittedParameter, value: f64| format_quantity(value, one.parameter.row().unit);
        let header = ["", "value", "95 % interval", "standard error", "start"];
        let row = |one: &FittedParameter| {
            [
                format!(
                    "{} {}",
                    one.parameter.row().term,
                    one.parameter.row().symbol
                ),
                one.text(one.value),
                format!(
                    "{} to {}",
                    one.text(one.interval.0),
                    one.text(one.interval.1)
                ),
                quantity(one, one.noise_error),
                quantity(one, one.start),
            ]
        };
        let rows = fit.parameters.iter().map(row);
        sheet.table(
            &std::iter::once(header.map(String::from))
                .chain(rows)
                .collect::<Vec<_>>(),
        );
        let [residual, noise] =
            [fit.residual, curve.noise].map(|force| format_quantity(force, "N"));
        sheet.heading(&format!(
            "Residual {residual}, {} times the noise of {noise}; {} of the points deviate by more than 5 times the noise. {} \
             curves were computed.",
            format_quantity(fit.residual_over_noise, "1"),
            format_args!("{} %", format_rounded(100.0 * fit.beyond_five_sigma, 2, "1")),
            grouped(fit.evaluations as u64)
        ));
        sheet.paragraph(&format!(
            "Misfit {}: residual in contact over the noise, in which points near jumps and outliers count less. Up to {} the \
             model describes the curve.",
            format_rounded(fit.misfit, 3, "1"),
            FitResult::MOST_MISFIT,
        ));
        if let Some(work) = fit.work_at_most {
            let work = format_rounded(work, 2, "J/m²");
            sheet.paragraph(&format!(
                "γ is at most {work}: a model without adhesion describes the curve equally well."
            ));
        }
        if let Some(force) = curve.pull_off_force() {
            let work = self.pull_off_work(force).map_or_else(String::new, |work| {
                let work = format_quantity(work, "J/m²");
                format!("; by itself, for any E* and k, it gives γ = F/(1.5πR) = {work}")
            });
            sheet.paragraph(&format!(
                "Pull-off force of the curve {}{work}.",
                format_quantity(force, "N")
            ));
        }
        if let Some(number) = fit.tabor {
            sheet.paragraph(&format!(
                "Tabor number μ = {}.",
                format_quantity(number, "1")
            ));
        }
        let strongest = fit
            .correlations
            .iter()
            .max_by(|one, other| one.2.abs().total_cmp(&other.2.abs()));
        if let Some((one, other, value)) = strongest {
            let (one, other) = (one.row().symbol, other.row().symbol);
            sheet.paragraph(&format!(
                "Largest correlation: {one} and {other}, {value:.2}."
            ));
        }
        let is_bound = |pair: &&(Parameter, Parameter)| {
            fit.work_at_most.is_some() && **pair == (Parameter::Work, Parameter::Work)
        };
        let named = fit.not_distinguished.iter().filter(|pair| !is_bound(pair));
        named.for_each(|&(one, other)| sheet.paragraph(&separation(one, other)));
        if fit.document.scene().roughness.is_some() {
            sheet.paragraph(ROUGH);
        }
        warnings_section(&mut sheet, &fit.warnings);
        Some(sheet.into_text())
    }

    fn json(&self) -> Option<Box<dyn Json + '_>> {
        let FitReport { curve, fit, .. } = *self;
        let pull_off_force = curve.pull_off_force();
        Some(Box::new(FitJson {
            described: fit.describes(),
            fit,
            noise: curve.noise,
            pull_off_force,
            pull_off_work: pull_off_force.and_then(|force| self.pull_off_work(force)),
            points_used: curve.points,
            points_left_out: curve.missing,
            reading: curve.statements.iter().chain(&fit.assumptions).collect(),
        }))
    }

    fn table(&self) -> Option<Table<'_>> {
        let FitReport { curve, fit, .. } = *self;
        let (force, model) = (&curve.force, &fit.model);
        let table =
            Table::of(|| 0..force.len()).real("displacement", |&point| curve.displacement[point]);
        let table = table
            .real("force", |&point| force[point])
            .real("model", |&point| model[point]);
        let table = table.real("residual", |&point| force[point] - model[point]);
        Some(
            table
                .whole("segment", |&point| curve.segment[point] as u64)
                .done(),
        )
    }

    fn figure(&self) -> Option<Figure> {
        let FitReport { title, curve, fit } = *self;
        let points = |force: &dyn Fn(usize) -> f64| -> Vec<(f64, f64)> {
            curve
                .displacement
                .iter()
                .enumerate()
                .map(|(index, at)| (*at, force(index)))
                .collect()
        };
        let measured = points(&|index| curve.force[index]);
        let residuals = points(&|index| (curve.force[index] - fit.model[index]) / curve.noise);
        let model = points(&|index| fit.model[index]);
        let span = |points: &[(f64, f64)]| Span::around(points.iter().map(|point| point.1), 0.06);
        let x = Span::around(measured.iter().map(|point| point.0), 0.03);
        let x = || ChartAxis::new(AxisScale::Linear, x, "displacement", "D", "m");
        let force = ChartAxis::new(AxisScale::Linear, span(&measured), "force", "F", "N");
        let rest = ChartAxis::new(
            AxisScale::Linear,
            span(&residuals),
            "residual over noise",
            "",
            "1",
        );
        let layers = vec![
            Layer::new(
                "measured".into(),
                Ink::Kept,
                Shape::signs(measured, Sign::Dot),
            ),
            Layer::new(
                "model".into(),
                Ink::Contact,
                Shape::line(model, Stroke::Solid),
            ),
        ];
        let rests = vec![
            Layer::unnamed(Ink::Quiet, Shape::Level(0.0)),
            Layer::new(
                "measured".into(),
                Ink::Kept,
                Shape::signs(residuals, Sign::Dot),
            ),
        ];
        let found = fit.parameters.iter().map(|one| {
            let [value, half] =
                [one.value, 0.5 * (one.interval.1 - one.interval.0)].map(|value| one.text(value));
            format!("{} = {value} ± {half}", one.parameter.row().symbol).replace(' ', "\u{a0}")
        });
        let notes = vec![Label::plain(&format!(
            "95 % intervals: {}",
            found.collect::<Vec<_>>().join(", ")
        ))];
        let charts = vec![Chart::new(x(), force, layers), Chart::new(x(), rest, rests)];
        Some(Figure {
            title: title.to_owned(),
            notes,
            charts,
            size: Figure::SMALL,
            ..Figure::default()
        })
    }
}

impl FitReport<'_> {
    /// Returns the work of adhesion in J/m² of a smooth sphere with this pull-off force in N
    /// (Johnson, Kendall and Roberts); `None` for another body.
    pub(super) fn pull_off_work(&self, force: f64) -> Option<f64> {
        let scene = self.fit.document.scene();
        let radius = scene.form.as_ref()?.sphere_radius()?;
        scene
            .roughness
            .is_none()
            .then_some(force / (1.5 * PI * radius))
    }
}

const ROUGH: &str = "These errors leave out the error of the model: the adhesion force of rough bodies differs from three \
    dimensions by about 30 % where much of the surface adheres, else by a factor of 2 to 3.";

fn separation(one: Parameter, other: Parameter) -> String {
    let remedy = Parameter::remedy(one, other);
    let (one, other) = (one.row().symbol, other.row().symbol);
    if one == other {
        return format!("The curve does not determine {one} within its range. It needs {remedy}.");
    }
    format!("The curve does not separate {one} and {other}. That needs {remedy}.")
}
