//! How long the contact fragments are: their number over their length, both logarithmic.

use super::axes::{Axis, Places};
use super::plot::{Polyline, Span, Stroke};
use crate::explorer::model::Model;
use crate::explorer::snapshot::LengthBin;
use crate::explorer::theme::Meaning;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::Line;
use ratatui::widgets::Paragraph;
use ratatui::widgets::canvas::Canvas;

/// Title of the pane.
pub const TITLE: &str = " Fragments by length, log–log ";

/// Draws the distribution: one point for each bin that is not empty.
pub fn draw(frame: &mut Frame<'_>, area: Rect, model: &Model) {
    let theme = model.appearance.theme;
    let shown = model.moment.as_ref().and_then(|moment| moment.lengths.as_ref()).zip(model.computed.as_ref());
    let Some((bins, computed)) = shown else { return };
    let spacing = computed.outcome.line.spacing;
    let filled: Vec<&LengthBin> = bins.iter().filter(|bin| bin.fragments > 0).collect();
    if filled.is_empty() {
        frame.render_widget(Paragraph::new("nothing is in contact").style(theme.style(Meaning::Quiet)), area);
        return;
    }
    let points: Vec<(f64, f64)> = filled
        .iter()
        // Lengths from `from` to `to` − 1: their geometric mean.
        .map(|bin| ((bin.from as f64 * (bin.to - 1) as f64).sqrt() * spacing, bin.fragments as f64))
        .collect();
    let logarithms: Vec<(f64, f64)> = points.iter().map(|(x, y)| (x.log10(), y.log10())).collect();
    let decades = |values: &mut dyn Iterator<Item = f64>| {
        let (low, high) = values
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
        Span { low: low.floor(), high: high.ceil().max(low.floor() + 1.0) }
    };
    let x = decades(&mut logarithms.iter().map(|point| point.0));
    let y = decades(&mut logarithms.iter().map(|point| point.1));
    let text_rows = u16::from(area.height >= 6);
    let places = Places::within(Rect { height: area.height - text_rows, ..area }, 0);
    let canvas = Canvas::default()
        .marker(model.appearance.marker.symbols())
        // Without room at the ends: the values beside them stand for the first and last row.
        .x_bounds(x.bounds())
        .y_bounds(y.bounds())
        .paint(|ctx| {
            let colour = theme.colour(Meaning::Contact);
            ctx.draw(&Polyline { points: &logarithms, colour, stroke: Stroke::Dotted });
            for &(x, y) in &logarithms {
                ctx.print(x, y, Line::styled("○", theme.style(Meaning::Contact)));
            }
        });
    frame.render_widget(canvas, places.plot);
    // The axes count in decades; their ends are told as lengths and numbers.
    let ends = |span: Span| Span { low: 10_f64.powf(span.low), high: 10_f64.powf(span.high) };
    places.draw(
        frame,
        Axis { span: ends(x), unit: "m", symbol: "δx" },
        Axis { span: ends(y), unit: "1", symbol: "n" },
        theme,
    );
    if text_rows > 0 {
        let count: u64 = bins.iter().map(|bin| bin.fragments).sum();
        let text = format!("○ number of fragments in each step of length by √2; {count} in all");
        let row = Rect { y: area.bottom() - 1, height: 1, ..area };
        frame.render_widget(Paragraph::new(text).style(theme.style(Meaning::Quiet)), row);
    }
}
