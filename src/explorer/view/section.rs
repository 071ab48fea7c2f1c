//! Part of the profile on its axes: rigid profile, elastic surface and contact, for profile and close-up.

use super::plot;
use crate::draw::{Axis, AxisScale, CellPlot, Chart, Ink, Layer, Shape, Span, legend};
use crate::explorer::snapshot::{Column, Section};
use crate::explorer::theme::{Appearance, Meaning};
use crate::simulation::LineFacts;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span as Text};

/// Chart of a section over the position; heights within `z`.
pub fn chart(section: &Section, line: LineFacts, z: Span) -> Chart {
    let [low, high] =
        [section.first, section.first + section.springs.max(1)].map(|spring| edge(line, spring));
    let layer = |name: &str, ink, ends: &dyn Fn(&Column) -> Option<(f64, f64)>| {
        let columns = section.columns.iter().map(ends).collect();
        Layer::new(name.into(), ink, Shape::Envelope { x: (low, high), columns })
    };
    let layers = vec![
        layer("surface", Ink::Surface, &|column| Some(column.surface)),
        layer("profile", Ink::Profile, &|column| Some(column.line)),
        layer("contact", Ink::Contact, &|column| column.contact),
    ];
    let axis = |span, symbol, unit| Axis::new(AxisScale::Linear, span, "", symbol, unit);
    plot::chart(axis(Span { low, high }, "x", "m"), axis(z, "z", "m"), layers)
}

/// Position of the left edge of a spring, m.
fn edge(line: LineFacts, spring: usize) -> f64 {
    (line.first + spring) as f64 * line.spacing
}

/// Position of the middle of a spring, m.
pub fn position(line: LineFacts, spring: usize) -> f64 {
    edge(line, spring) + 0.5 * line.spacing
}

/// Share of the width of a plot at a column of the screen.
pub fn share_at(area: Rect, chart: &Chart, column: u16) -> f64 {
    chart.x.share(CellPlot::within(area, chart).number_at(&chart.x, column))
}

/// Draws a chart of a section with its scales.
pub fn draw(frame: &mut Frame<'_>, area: Rect, chart: &Chart, appearance: Appearance) -> CellPlot {
    plot::draw_chart(frame, area, chart, appearance)
}

/// Label of the heights, names of the lines and further signs, as far as there is room on the frame.
pub fn names(
    chart: &Chart,
    more: impl IntoIterator<Item = Vec<Text<'static>>>,
    appearance: Appearance,
    width: u16,
) -> Line<'static> {
    let quiet = appearance.theme.style(Meaning::Quiet);
    let mut parts = vec![vec![Text::styled(chart.y.label_with_unit().to_string(), quiet)]];
    parts.extend(plot::in_theme(appearance, |style| legend(std::slice::from_ref(chart), style)));
    parts.extend(more);
    plot::on_frame(parts, width)
}
