//! Lengths of the contact fragments: their number over their length, both logarithmic.

use super::{PaneRow, Place};
use crate::draw::{Axis, AxisScale, Chart, Figure, Ink, Layer, Shape, Sign, Span, Stroke};
use crate::explorer::app::App;
use crate::explorer::layout::inside;
use crate::explorer::theme::Meaning;
use crate::explorer::view::lines::{draw_lines, draw_reason};
use crate::explorer::view::plot;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::Line;

/// Row of the pane.
pub static ROW: PaneRow = PaneRow {
    place: Place::CloseUp,
    title: |_| " Fragments by length, log–log ".to_owned(),
    draw,
    figure: |app| Some(Figure::of_chart(app.edit.document.title(), chart(app)?)),
    help: &[(
        "Lengths",
        "D: number n of contact patches over their length δx, both logarithmic; ○ is the patches in a step of length by √2 \
         at the indentation shown, steps without patches are left out",
    )],
    ..PaneRow::EMPTY
};

/// Draws the distribution: one point for each bin with fragments.
fn draw(frame: &mut Frame<'_>, area: Rect, app: &App) {
    let area = inside(area);
    let theme = app.view.appearance.theme;
    let Some(bins) = app.snapshot.as_ref().map(|snapshot| &snapshot.lengths) else { return };
    let Some(chart) = chart(app) else {
        return draw_reason(frame, area, "nothing is in contact", theme);
    };
    let text_rows = u16::from(area.height >= 6);
    let plot = Rect { height: area.height - text_rows, ..area };
    plot::draw_chart(frame, plot, &chart, app.view.appearance);
    if text_rows > 0 {
        let count: u64 = bins.values().sum();
        let text = format!("○ n, {count} in all, in steps of δx by √2");
        let row = Rect { y: area.bottom() - 1, height: 1, ..area };
        draw_lines(frame, row, [Line::styled(text, theme.style(Meaning::Quiet))]);
    }
}

/// The distribution; `None` without contact.
fn chart(app: &App) -> Option<Chart> {
    let bins = Some(&app.snapshot.as_ref()?.lengths).filter(|bins| !bins.is_empty())?;
    let spacing = app.solved.as_ref()?.outcome.line.spacing;
    // The fewest springs whose square has this binary logarithm.
    let least = |square: u32| 2_f64.powf(f64::from(square) / 2.0).ceil();
    let points = bins.iter().map(|(&square, &count)| {
        let mean = (least(square) * (least(square + 1) - 1.0)).sqrt();
        (mean * spacing, count as f64)
    });
    let points: Vec<(f64, f64)> = points.collect();
    let axis = |numbers: &mut dyn Iterator<Item = f64>, symbol: &str, unit: &str| {
        let span = Span::decades(numbers.map(f64::log10));
        Axis::new(AxisScale::Logarithmic, span, "", symbol, unit)
    };
    let x = axis(&mut points.iter().map(|point| point.0), "δx", "m");
    let y = axis(&mut points.iter().map(|point| point.1), "n", "1");
    let shape = Shape::Curve { points, stroke: Some(Stroke::Dotted), sign: Some(Sign::Ring) };
    Some(Chart::new(x, y, vec![Layer::unnamed(Ink::Contact, shape)]))
}
