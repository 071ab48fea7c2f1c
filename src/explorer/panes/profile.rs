//! The pane of the profile: the rigid profile, the elastic surface above it, the springs in
//! contact, and the distribution of heights.

use super::row::PaneRow;
use super::section;
use crate::explorer::app::App;
use crate::explorer::layout::Layout;
use crate::explorer::pane::Pane;
use crate::explorer::panel::{Body, Panel};
use crate::explorer::snapshot::ContactSnapshot;
use crate::explorer::text::Part as TextPart;

use asperity_data::{AxisScale, format_quantity};
use asperity_plot::{
    Chart, ChartAxis, Colours, Ink, Layer, Shape, Span, Stroke, contact_signs, prefixed,
};
use asperity_report::{Part as LinePart, Section};
use asperity_surface::lines::Histogram;
use ratatui::text::Span as Text;
use std::f64::consts::TAU;

pub static ROW: PaneRow = PaneRow {
    panel: |app, size| {
        let Some(snapshot) = app.snapshot.as_deref() else {
            return Panel::of_text(title(app), "…");
        };
        with_profile(app, snapshot, size.width)
    },
    figure: |app, _| {
        let chart = of_springs(app, LinePart::drawn)?;
        Some(section::figure(app, app.snapshot.as_deref()?, chart))
    },
    report: |app| section::table(app, of_springs(app, LinePart::listed)?),
    help: &[(
        "Profile",
        "rigid profile below, elastic surface above. Springs in contact are filled: amber and above the dotted level \
         of the free surface they are pressed, blue and below it they are pulled, as lines above the profile; the filled area is the force. In \
         the row below, █ is in contact, ▪ in part, · free; without colours ▒ and ▫ are pulled. [ ] is the part in \
         the pane Patch. On the right the histogram of heights, and dotted a normal distribution",
    )],
    ..PaneRow::EMPTY
};

/// Returns the chart of the visible springs for an exported file.
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
    let is_whole = app.view.profile.share >= 1.0;
    let Some(snapshot) = app.snapshot.as_ref().filter(|_| !is_whole) else {
        return "Profile".to_owned();
    };
    let spacing = snapshot.line.spacing;
    let shown = format_quantity(snapshot.profile.springs as f64 * spacing, "m");
    let whole = format_quantity(snapshot.line.points as f64 * spacing, "m");
    format!("Profile, {shown} of {whole},")
}

/// Returns the panel of the profile at the shown state, with the distribution of heights on its
/// right. `width` is the width of the pane in columns.
fn with_profile(app: &App, snapshot: &ContactSnapshot, width: u16) -> Panel {
    let z = section::heights(app, snapshot);
    let look = app.view.appearance;
    let mut panel = section::panel(&title(app), snapshot, &snapshot.profile, z, look, width);
    let Body::Chart(plot) = &mut panel.body else {
        return panel;
    };
    let histogram = app.outcome().and_then(|outcome| outcome.histogram.as_ref());
    plot.beside = Some(distribution(histogram, plot.chart.y.clone()));
    let largest_stress = section::largest_stress(snapshot, &snapshot.profile);
    for column in &snapshot.profile.columns {
        let stress = column.contact.map(|(low, high)| {
            (f64::midpoint(low, high) - snapshot.profile.level) / largest_stress
        });
        plot.contact.springs.push(stress);
    }
    if snapshot.probe.is_none() {
        panel.edge.push(words_of_stress(app));
    }
    let has_close_up = Layout::of(app).pane(Pane::CloseUp).is_some();
    if has_close_up {
        let part = &snapshot.close_up.section;
        let from = share_of_section(&snapshot.profile, part.first);
        let to = share_of_section(&snapshot.profile, part.first + part.springs);
        plot.contact.marked = Some((from, to));
    }
    panel
}

/// Returns the words `pressed` and `pulled` in the colours of the springs. Without colours, each
/// word follows the sign of its springs.
fn words_of_stress(app: &App) -> TextPart {
    let palette = app.view.appearance.palette();
    let mut words = Vec::new();
    for (word, ink, stress) in [("pressed", Ink::Press, 1.0), ("pulled", Ink::Pull, -1.0)] {
        let word = if palette.colours == Colours::Plain {
            format!("{} {word}", contact_signs(palette, stress).all)
        } else {
            word.to_owned()
        };
        if !words.is_empty() {
            words.push(Text::raw(" "));
        }
        words.push(Text::styled(word, palette.ink(ink)));
    }
    words
}

/// Returns the position of a spring in a part of the profile, from 0 at its left end to 1 at its
/// right end. Outside this part, the position is below 0 or above 1.
fn share_of_section(section: &Section, spring: usize) -> f64 {
    (spring as f64 - section.first as f64) / section.springs as f64
}

/// Number of points on the curve of the normal distribution.
const POINTS: usize = 65;

/// Returns the chart of the distribution of heights: the density in each bin of the histogram, and
/// the normal distribution with the same mean and rms height.
fn distribution(histogram: Option<&Histogram>, z: ChartAxis) -> Chart {
    let Some(histogram) = histogram.filter(|histogram| histogram.high > histogram.low) else {
        let span = Span {
            low: 0.0,
            high: 1.0,
        };
        let density = ChartAxis::new(AxisScale::Linear, span, "", "", "1");
        return Chart::new(density, z, Vec::new());
    };
    let bins = Bins::new(histogram);
    let densities = bins.shares.iter().map(|share| share / bins.width);
    let most = densities
        .chain([bins.normal_density(bins.mean)])
        .fold(0.0, f64::max);
    // The unit of length is chosen such that the largest density has few digits.
    let (divisor, unit) = prefixed("m", 1e3 / most);
    let mut boxes = Vec::new();
    for (index, share) in bins.shares.iter().enumerate() {
        let low = bins.low(index);
        let density = divisor * share / bins.width;
        boxes.push(((0.0, density), (low, low + bins.width)));
    }
    let step = z.span.width() / (POINTS - 1) as f64;
    let mut points = Vec::new();
    for index in 0..POINTS {
        let height = z.span.low + step * index as f64;
        points.push((divisor * bins.normal_density(height), height));
    }
    let layers = vec![
        Layer::new(
            "normal".into(),
            Ink::Surface,
            Shape::line(points, Stroke::Dotted),
        ),
        Layer::unnamed(Ink::Profile, Shape::Boxes(boxes)),
    ];
    let span = Span {
        low: 0.0,
        high: 1.05 * divisor * most,
    };
    let density = ChartAxis::new(AxisScale::Linear, span, &format!("1/{unit}"), "", "1");
    Chart::new(density, z, layers)
}

/// Bins of a histogram of heights. Mean and rms height are computed from the middles of the bins.
struct Bins {
    /// Lower end of the first bin in m.
    lowest: f64,
    /// Width of a bin in m.
    width: f64,
    /// Share of the springs in each bin.
    shares: Vec<f64>,
    /// Mean height in m.
    mean: f64,
    /// Rms deviation of the heights from the mean in m.
    rms: f64,
}

impl Bins {
    fn new(histogram: &Histogram) -> Self {
        let count: u64 = histogram.counts.iter().sum();
        let mut bins = Bins {
            lowest: histogram.low,
            width: (histogram.high - histogram.low) / histogram.counts.len() as f64,
            shares: Vec::new(),
            mean: 0.0,
            rms: 0.0,
        };
        for bin in &histogram.counts {
            bins.shares.push(*bin as f64 / count as f64);
        }
        let heights = (0..bins.shares.len()).map(|index| bins.low(index) + 0.5 * bins.width);
        let heights: Vec<f64> = heights.collect();
        let moments = heights.iter().zip(&bins.shares);
        bins.mean = moments.map(|(height, share)| height * share).sum();
        let moments = heights.iter().zip(&bins.shares);
        let square: f64 = moments
            .map(|(height, share)| (height - bins.mean).powi(2) * share)
            .sum();
        bins.rms = square.sqrt();
        bins
    }

    /// Returns the lower end of a bin in m.
    fn low(&self, index: usize) -> f64 {
        self.lowest + self.width * index as f64
    }

    /// Returns the density of the normal distribution at a height, in 1/m.
    fn normal_density(&self, height: f64) -> f64 {
        let deviation = (height - self.mean) / self.rms;
        (-0.5 * deviation.powi(2)).exp() / (self.rms * TAU.sqrt())
    }
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
        // The densities are in 1/mm and the heights in m, hence the factor 1e3.
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
        // Mean squared height in µm²: (20 · 1.5² + 60 · 0.5²) / 80 = 0.75.
        assert!((moment(2) - 0.75).abs() < 1e-4, "{}", moment(2));
        let flat = Histogram {
            low: 1.0,
            high: 1.0,
            counts: vec![3],
        };
        assert!(distribution(Some(&flat), z).layers.is_empty());
    }
}
