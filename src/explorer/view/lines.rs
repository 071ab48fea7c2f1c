//! Lines of text in panes: alone, around a plot, and in place of a missing plot.

use super::wrap::{fitted, wrapped};
use crate::explorer::search::letters_found;
use crate::explorer::theme::{Meaning, Theme};
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::style::Style;
use ratatui::text::{Line, Span};
use ratatui::widgets::Paragraph;

/// Draws lines from the top of an area on, as far as there is room; too wide a line ends in `…`.
pub fn draw_lines(frame: &mut Frame<'_>, area: Rect, lines: impl IntoIterator<Item = Line<'static>>) {
    for (y, line) in (area.y..area.bottom()).zip(lines) {
        frame.render_widget(Paragraph::new(fitted(line, area.width)), Rect { y, height: 1, ..area });
    }
}

/// Draws lines above and below a plot, the upper ones first where there is no room for all, and returns the area of the
/// plot: at least so many rows, as far as there are any.
pub fn draw_around(
    frame: &mut Frame<'_>,
    area: Rect,
    (above, below): (Vec<Line<'static>>, Vec<Line<'static>>),
    plot_rows: u16,
) -> Rect {
    let room = area.height.saturating_sub(plot_rows);
    let rows_above = (above.len() as u16).min(room);
    let rows_below = (below.len() as u16).min(room - rows_above);
    let plot = Rect { y: area.y + rows_above, height: area.height - rows_above - rows_below, ..area };
    draw_lines(frame, Rect { height: rows_above, ..area }, above);
    draw_lines(frame, Rect { y: plot.bottom(), height: rows_below, ..area }, below);
    plot
}

/// A text with the letters found by a query marked.
pub fn found(text: &str, query: &str, style: Style, theme: Theme) -> Vec<Span<'static>> {
    marked(text, &letters_found(text, query), style, theme)
}

/// A text with these of its characters marked; the indices ascend.
pub fn marked(text: &str, letters: &[usize], style: Style, theme: Theme) -> Vec<Span<'static>> {
    let is_found = |(index, character)| (letters.binary_search(&index).is_ok(), character);
    let characters: Vec<(bool, char)> = text.chars().enumerate().map(is_found).collect();
    let spans = characters.chunk_by(|(one, _), (next, _)| one == next).map(|run| {
        let style = if run[0].0 { theme.found(style) } else { style };
        Span::styled(run.iter().map(|(_, character)| character).collect::<String>(), style)
    });
    spans.collect()
}

/// Draws the reason for a missing plot.
pub fn draw_reason(frame: &mut Frame<'_>, area: Rect, reason: &str, theme: Theme) {
    draw_lines(
        frame,
        area,
        wrapped(&Line::styled(reason.to_owned(), theme.style(Meaning::Quiet)), area.width),
    );
}
