//! A chart of curves with its legend.

use crate::draw::{Chart, legend};
use crate::explorer::app::App;
use crate::explorer::theme::Meaning;
use crate::explorer::view::lines::draw_around;
use crate::explorer::view::plot;
use crate::explorer::view::wrap::filled;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::Span as Text;

/// Fewest rows of a useful plot.
const FEWEST_ROWS: u16 = 5;

/// Draws a chart with its legend, which begins with the heading of the chart.
pub(super) fn draw_chart(frame: &mut Frame<'_>, area: Rect, app: &App, chart: &Chart) {
    let heading =
        vec![Text::styled(chart.heading.to_string(), app.view.appearance.theme.style(Meaning::Title))];
    let entries = plot::in_theme(app.view.appearance, |style| legend(std::slice::from_ref(chart), style));
    let parts =
        std::iter::once(heading).filter(|heading| !heading[0].content.is_empty()).chain(entries).collect();
    let legend = filled(parts, "  ", usize::from(area.width));
    let plot = draw_around(frame, area, (legend, Vec::new()), FEWEST_ROWS);
    plot::draw_chart(frame, plot, chart, app.view.appearance);
}
