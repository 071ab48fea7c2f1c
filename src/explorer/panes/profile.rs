//! The profile: the rigid profile, the elastic surface above it, their contact, and the
//! distribution of heights.

use super::row::PaneRow;
use super::section;
use crate::explorer::app::App;
use crate::explorer::layout::Layout;
use crate::explorer::pane::Pane;
use crate::explorer::panel::{Body, Panel};
use crate::explorer::snapshot::ContactSnapshot;
use crate::explorer::theme::Appearance;
use asperity_data::{AxisScale, format_quantity};
use asperity_plot::{Chart, ChartAxis, Ink, Layer, Shape, Span, Stroke, prefixed};
use asperity_report::Part as LinePart;
use asperity_surface::lines::Histogram;
use std::f64::consts::TAU;

pub static ROW: PaneRow = PaneRow {
    panel: |app, size| {
        let Some(snapshot) = app.snapshot.as_deref() else {
            return Panel::of_text(title(app), "…");
        };
        let histogram = app
            .solved
            .as_ref()
            .and_then(|computed| computed.outcome.histogram.as_ref());
        let z = section::heights(app, snapshot);
        let mut panel = of_scene(
            &title(app),
            snapshot,
            histogram,
            z,
            (app.view.appearance, size.width),
        );
        let is_marked = Layout::of(app).pane(Pane::CloseUp).is_some();
        if let (Body::Chart(plot), true) = (&mut panel.body, is_marked) {
            let (part, shown) = (&snapshot.close_up.section, &snapshot.profile);
            let share = |spring: usize| (spring as f64 - shown.first as f64) / shown.springs as f64;
            plot.contact.marked = Some((share(part.first), share(part.first + part.springs)));
        }
        panel
    },
    figure: |app, _| {
        let chart = of_springs(app, LinePart::drawn)?;
        Some(section::figure(app, app.snapshot.as_deref()?, chart))
    },
    report: |app| section::table(app, of_springs(app, LinePart::listed)?),
    help: &[(
        "Profile",
        "rigid profile below, elastic surface above; ■ contact, [ ] the part in the pane Patch. On the right the \
         distribution of heights, and dotted a normal distribution",
    )],
    ..PaneRow::EMPTY
};

/// Chart of the springs in the pane, for a file.
fn of_springs(app: &App, part: fn(usize, usize) -> LinePart) -> Option<Chart> {
    let snapshot = app.snapshot.as_deref()?;
    section::of_springs(
        snapshot,
        &snapshot.profile,
        section::heights(app, snapshot),
        part,
    )
}

fn title(app: &App) -> String {
    let Some(snapshot) = app
        .snapshot
        .as_ref()
        .filter(|_| app.view.profile.share < 1.0)
    else {
        return "Profile".to_owned();
    };
    let length = |springs: f64| format_quantity(springs * snapshot.line.spacing, "m");
    let share = format!(
        "{} of {}",
        length(snapshot.profile.springs as f64),
        length(snapshot.line.points as f64)
    );
    format!("Profile, {share},")
}

/// Panel of the profile and the distribution of heights of a scene in one state; `z` is the range
/// of heights, m.
fn of_scene(
    title: &str,
    snapshot: &ContactSnapshot,
    histogram: Option<&Histogram>,
    z: Span,
    look: (Appearance, u16),
) -> Panel {
    let mut panel = section::panel(title, snapshot, &snapshot.profile, z, look);
    if let Body::Chart(plot) = &mut panel.body {
        plot.beside = Some(distribution(histogram, plot.chart.y.clone()));
        plot.contact.springs = snapshot
            .profile
            .columns
            .iter()
            .map(|column| column.contact.is_some())
            .collect();
    }
    panel
}

const POINTS: usize = 65;

/// Density of heights in the bins of a histogram, and the normal distribution with the same mean
/// and rms height.
fn distribution(histogram: Option<&Histogram>, z: ChartAxis) -> Chart {
    let Some(histogram) = histogram.filter(|histogram| histogram.high > histogram.low) else {
        return Chart::new(
            ChartAxis::new(
                AxisScale::Linear,
                Span {
                    low: 0.0,
                    high: 1.0,
                },
                "",
                "",
                "1",
            ),
            z,
            Vec::new(),
        );
    };
    let count: u64 = histogram.counts.iter().sum();
    let width = (histogram.high - histogram.low) / histogram.counts.len() as f64;
    let bins = histogram.counts.iter().enumerate().map(|(index, &bin)| {
        let low = histogram.low + width * index as f64;
        (low, bin as f64 / count as f64)
    });
    let bins: Vec<(f64, f64)> = bins.collect();
    let mean: f64 = bins
        .iter()
        .map(|(low, share)| (low + 0.5 * width) * share)
        .sum();
    let square = |(low, share): &(f64, f64)| (low + 0.5 * width - mean).powi(2) * share;
    let rms = bins.iter().map(square).sum::<f64>().sqrt();
    let normal = |at: f64| (-0.5 * ((at - mean) / rms).powi(2)).exp() / (rms * TAU.sqrt());
    let most = bins
        .iter()
        .map(|(_, share)| share / width)
        .chain([normal(mean)])
        .fold(0.0, f64::max);
    // A unit of length that makes the largest density a number of few digits.
    let (divisor, unit) = prefixed("m", 1e3 / most);
    let boxes = bins
        .iter()
        .map(|(low, share)| ((0.0, divisor * share / width), (*low, low + width)));
    let step = z.span.width() / (POINTS - 1) as f64;
    let heights = (0..POINTS).map(|index| z.span.low + step * index as f64);
    let points = heights.map(|at| (divisor * normal(at), at)).collect();
    let layers = vec![
        Layer::new(
            "normal".into(),
            Ink::Surface,
            Shape::line(points, Stroke::Dotted),
        ),
        Layer::unnamed(Ink::Profile, Shape::Boxes(boxes.collect())),
    ];
    let span = Span {
        low: 0.0,
        high: 1.05 * divisor * most,
    };
    Chart::new(
        ChartAxis::new(AxisScale::Linear, span, &format!("1/{unit}"), "", "1"),
        z,
        layers,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn densities_have_an_area_of_one_and_the_normal_distribution_their_moments() {
        let histogram = Histogram {
            low: -2e-6,
            high: 2e-6,
            counts: vec![10, 30, 30, 10],
        };
        let z = ChartAxis::new(
            AxisScale::Linear,
            Span {
                low: -8e-6,
                high: 8e-6,
            },
            "",
            "z",
            "m",
        );
        let chart = distribution(Some(&histogram), z.clone());
        let [Shape::Curve { points, .. }, Shape::Boxes(boxes)] =
            [&chart.layers[0].shape, &chart.layers[1].shape]
        else {
            panic!("{chart:?}")
        };
        // Heights in mm and densities per mm.
        let area: f64 = boxes
            .iter()
            .map(|((_, density), (low, high))| density * (high - low) * 1e3)
            .sum();
        assert!((area - 1.0).abs() < 1e-12 && chart.x.name == "1/mm");
        let moment = |power: i32| -> f64 {
            points
                .iter()
                .map(|(density, at)| density * (at * 1e6).powi(power))
                .sum::<f64>()
                * 0.25e-3
        };
        assert!((moment(0) - 1.0).abs() < 1e-9 && moment(1).abs() < 1e-9);
        // (20 · 1.5² + 60 · 0.5²) / 80
        assert!((moment(2) - 0.75).abs() < 1e-4, "{}", moment(2));
        let flat = Histogram {
            low: 1.0,
            high: 1.0,
            counts: vec![3],
        };
        assert!(distribution(Some(&flat), z).layers.is_empty());
    }
}
