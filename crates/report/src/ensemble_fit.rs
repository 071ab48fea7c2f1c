//! The work of adhesion of a rough body from many curves, as text, JSON, a table and a figure.

use crate::report::{Json, Report};
use crate::sheet::Sheet;
use asperity_data::{
    AxisScale, Kind, Table, format_quantity, format_range, format_rounded, grouped, per_cent,
};
use asperity_experiment::{CurveOfEnsemble, EnsembleFit, IntervalEstimate, SummaryDeviation};
use asperity_plot::{Chart, ChartAxis, Figure, Ink, Label, Layer, Shape, Sign, Span, Stroke};

/// Changes of the roughness whose effect is reported.
const HEIGHT_CHANGE: f64 = 0.05;
const HURST_CHANGE: f64 = 0.05;
/// Smallest and largest usual ratio of the scatter of the curves to the scatter of the random
/// profiles.
const USUAL_SCATTER: [f64; 2] = [0.8, 1.2];

/// Report on the work of adhesion of a rough body, found by comparing measured force curves with
/// computed curves of random profiles.
#[derive(Clone, Copy, Debug)]
pub struct EnsembleFitReport<'a> {
    /// Title of the scene.
    pub title: &'a str,
    /// Result of [`fit_ensemble`](asperity_experiment::fit_ensemble).
    pub fit: &'a EnsembleFit,
    /// True if the user stated a standard error of the rms height or of the Hurst exponent.
    pub has_roughness_errors: bool,
}

impl Report for EnsembleFitReport<'_> {
    fn text(&self) -> Option<String> {
        let EnsembleFitReport {
            title,
            fit,
            has_roughness_errors,
        } = *self;
        let mut sheet = Sheet::default();
        if let Some(text) = self.not_described() {
            sheet.paragraph(&text);
        }
        if let Some(reason) = &fit.unsuitable_profile {
            sheet.paragraph(&reason.to_string());
        }
        sheet.heading(&format!("Many random profiles of {title}"));
        fit.instrument.iter().for_each(|text| sheet.paragraph(text));
        let number = fit.curves.len();
        let curves = if number == 1 {
            "1 curve".to_owned()
        } else {
            format!("{number} curves")
        };
        let spectrum = if has_roughness_errors {
            "this roughness"
        } else {
            "exactly this roughness"
        };
        let profiles = format!(
            "from {curves} and {} random profiles of {spectrum}",
            grouped(fit.lines)
        );
        sheet.paragraph(&match fit.work_at_most {
            Some(most) => format!(
                "γ is at most {} (95 %), {profiles}: curves without adhesion do not differ from these.",
                format_rounded(most, 2, "J/m²")
            ),
            None => format!("γ = {}, {profiles}.", with_interval(&fit.work, "J/m²")),
        });
        let modulus = if fit.modulus_is_given {
            format!("E* = {}, given.", format_quantity(fit.modulus.value, "Pa"))
        } else {
            format!(
                "E* = {}. Correlation of γ and E*: {:.2}.",
                with_interval(&fit.modulus, "Pa"),
                fit.correlation
            )
        };
        sheet.paragraph(&modulus);
        if (fit.closing_over_opening - 1.0).abs() > 1e-9 {
            let ratio = format_quantity(fit.closing_over_opening, "1");
            sheet.paragraph(&format!(
                "Work of adhesion on closing over that on opening: {ratio}, as in the scene."
            ));
        }
        let share = |share: f64| format!("{:.0} %", 100.0 * share);
        let mut parts = vec![
            format!("{} by the number of curves", share(fit.shares.places)),
            format!("{} by the number of profiles", share(fit.shares.profiles)),
        ];
        if has_roughness_errors {
            parts.push(format!(
                "{} by the errors of the roughness",
                share(fit.shares.roughness)
            ));
        }
        if fit.work_at_most.is_none() {
            sheet.paragraph(&format!(
                "The squared width of the interval of γ: {}.",
                parts.join(", ")
            ));
        }
        let prospects = fit
            .prospects
            .iter()
            .map(|of| format!("{} curves ± {}", of.curves, per_cent(of.half_width)));
        let prospects: Vec<String> = prospects.collect();
        if !prospects.is_empty() {
            let profiles = grouped(fit.lines);
            sheet.paragraph(&format!(
                "With {profiles} profiles γ by {}.",
                prospects.join(", ")
            ));
        }
        if fit.at_end_of_table && fit.work_at_most.is_none() {
            sheet.paragraph(
                "The interval reaches the end of the computed values, and may be wider: more curves, or E* from another \
                 measurement.",
            );
        }
        if let Some(of) = fit.roughness {
            let change = |by: f64, step: f64| format!("{:+.0} %", 100.0 * (by * step).exp_m1());
            sheet.paragraph(&format!(
                "If the rms height h is larger by {}, γ changes by {}; if the Hurst exponent H is larger by {HURST_CHANGE}, \
                 by {}. The curves cannot show it.",
                per_cent(HEIGHT_CHANGE),
                change(of.work_by_height, HEIGHT_CHANGE),
                change(of.work_by_hurst, HURST_CHANGE)
            ));
        }
        if !has_roughness_errors {
            let text = "The interval leaves out errors of the roughness";
            // Those of a measured roughness cannot be stated.
            let options = fit
                .roughness
                .map_or("", |_| ": --height-error, --hurst-error state them");
            sheet.paragraph(&format!("{text}{options}."));
        }
        sheet.heading("Each curve by itself");
        let header = [
            "curve",
            "pull-off",
            "loop area",
            "stiffness",
            "γ",
            "95 % interval",
        ];
        let rows = fit.curves.iter().map(row);
        sheet.table(
            &std::iter::once(header.map(String::from))
                .chain(rows)
                .collect::<Vec<_>>(),
        );
        let ends = fit
            .curves
            .iter()
            .filter(|curve| curve.at_end_of_table)
            .count();
        if ends > 0 {
            let reach = if ends == 1 { "reaches" } else { "reach" };
            sheet.paragraph(&format!(
                "{ends} of these intervals {reach} the end of the computed values, and may be wider."
            ));
        }
        sheet.heading(&self.preloads());
        if let Some(ratio) = fit.scatter_ratio {
            let usual = (USUAL_SCATTER[0]..=USUAL_SCATTER[1]).contains(&ratio);
            let why = if usual {
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
        self.foreign()
            .into_iter()
            .for_each(|text| sheet.paragraph(&text));
        sheet.paragraph(&format!(
            "{} curves were computed. {INDEPENDENT}",
            grouped(fit.computed as u64)
        ));
        Some(sheet.into_text())
    }

    fn json(&self) -> Option<Box<dyn Json + '_>> {
        Some(Box::new(self.fit))
    }

    fn table(&self) -> Option<Table<'_>> {
        let curves = &self.fit.curves;
        let names = curves
            .iter()
            .map(|curve| curve.name.chars().count())
            .max()?;
        let table = Table::of(|| curves.iter())
            .with("curve", Kind::Text(names), |curve| curve.name.clone());
        let table = table.real("preload", |curve| curve.preload);
        let table = table.real("pull_off_force", |curve| {
            curve.pull_off_force.unwrap_or(f64::NAN)
        });
        let table = table
            .real("loop_area", |curve| curve.loop_area)
            .real("stiffness", |curve| curve.stiffness);
        let table = table
            .real("work", |curve| curve.work.value)
            .real("work_low", |curve| curve.work.low);
        let table = table.real("work_high", |curve| curve.work.high);
        Some(
            table
                .whole("foreign", |curve| u64::from(curve.foreign))
                .done(),
        )
    }

    fn figure(&self) -> Option<Figure> {
        let EnsembleFitReport { title, fit, .. } = *self;
        let last = fit.curves.len() as f64;
        let places = || (1..).map(f64::from).zip(&fit.curves);
        let points = |is_foreign: bool| -> Vec<(f64, f64)> {
            let of = places().filter(|(_, curve)| curve.foreign == is_foreign);
            of.map(|(place, curve)| (place, curve.work.value)).collect()
        };
        let IntervalEstimate { value, low, high } = fit.work;
        // The axis is logarithmic: an interval that begins at 0 is drawn from the lowest end of all
        // curves.
        let lowest = fit
            .curves
            .iter()
            .map(|curve| curve.work.low)
            .fold(value, f64::min);
        let low = if low > 0.0 { low } else { lowest };
        let band = Shape::Band([0.5, last + 0.5].map(|place| (place, low, high)).to_vec());
        let bars = places().map(|(place, curve)| {
            let ends = vec![(place, curve.work.low), (place, curve.work.high)];
            Layer::unnamed(Ink::Kept, Shape::line(ends, Stroke::Solid))
        });
        let mut layers = vec![Layer::new("95 % interval of all".into(), Ink::Quiet, band)];
        layers.extend(bars);
        layers.push(Layer::new(
            "all curves".into(),
            Ink::Contact,
            Shape::Level(value),
        ));
        for (name, ink, is_foreign) in [
            ("one curve, 95 % interval", Ink::Text, false),
            ("foreign curve", Ink::Cursor, true),
        ] {
            let points = points(is_foreign);
            if !points.is_empty() {
                layers.push(Layer::new(
                    name.into(),
                    ink,
                    Shape::signs(points, Sign::Dot),
                ));
            }
        }
        let ends = fit
            .curves
            .iter()
            .flat_map(|curve| [curve.work.low, curve.work.high])
            .chain([low, high]);
        let scale = AxisScale::Logarithmic;
        let span = Span::around(ends.map(|work| scale.coordinate(work)), 0.06);
        let x = ChartAxis::new(
            AxisScale::Linear,
            Span {
                low: 0.5,
                high: last + 0.5,
            },
            "number of the curve",
            "",
            "1",
        );
        let y = ChartAxis::new(scale, span, "work of adhesion", "γ", "J/m²");
        let note = match fit.work_at_most {
            Some(most) => format!(
                "all curves: γ is at most {} (95 %)",
                format_rounded(most, 2, "J/m²")
            ),
            None => format!("all curves: γ = {}", with_interval(&fit.work, "J/m²")),
        };
        let charts = vec![Chart::new(x, y, layers)];
        let notes = vec![Label::plain(&note)];
        Some(Figure {
            title: title.to_owned(),
            notes,
            charts,
            size: Figure::SMALL,
            ..Figure::default()
        })
    }
}

const INDEPENDENT: &str = "Each curve counts as a place with a profile of its own: places closer than the contact or the \
    longest wave are fewer than they seem.";

/// Writes `51.6 mJ/m², 38.5 to 71.0 mJ/m² (95 %)`.
fn with_interval(of: &IntervalEstimate, unit: &str) -> String {
    let value = format_rounded(of.value, 3, unit);
    format!(
        "{value}, {} (95 %)",
        format_range((of.low, of.high), 3, unit)
    )
}

fn row(curve: &CurveOfEnsemble) -> [String; 6] {
    let quantity = |value: f64, unit: &str| format_rounded(value, 3, unit);
    let mark = if curve.foreign { ", foreign" } else { "" };
    [
        curve.name.clone(),
        curve
            .pull_off_force
            .map_or("-".to_owned(), |force| quantity(force, "N")),
        quantity(curve.loop_area, "J"),
        quantity(curve.stiffness, "N/m"),
        quantity(curve.work.value, "J/m²"),
        format!(
            "{}{mark}",
            format_range((curve.work.low, curve.work.high), 2, "J/m²")
        ),
    ]
}

impl EnsembleFitReport<'_> {
    fn not_described(&self) -> Option<String> {
        let deviating = self.fit.deviations.iter().filter(|one| one.deviates);
        let words = |one: &SummaryDeviation| {
            let direction = if one.logarithm > 0.0 {
                "larger"
            } else {
                "smaller"
            };
            let factor = 100.0 * one.logarithm.abs().exp_m1();
            format!(
                "{} {direction} by {factor:.0} % ({:.1} standard errors)",
                one.summary,
                one.deviation.abs()
            )
        };
        let all: Vec<String> = deviating.map(words).collect();
        (!all.is_empty()).then(|| {
            format!(
                "Random profiles of this roughness do not describe the curves; in the mean over all curves: {}. Roughness, \
                 form, stiffness of the instrument or model differ, and the interval does not contain it.",
                all.join("; ")
            )
        })
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

    fn foreign(&self) -> Option<String> {
        let foreign = self.fit.curves.iter().filter(|curve| curve.foreign);
        let names: Vec<&str> = foreign.map(|curve| curve.name.as_str()).collect();
        (!names.is_empty()).then(|| {
            format!(
                "Foreign to this ensemble, as one curve in a thousand: {}. They count like the others; a fit without them \
                 shows what they change.",
                names.join(", ")
            )
        })
    }
}
