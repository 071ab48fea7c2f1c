//! The list of all commands, over the panes.

use super::found::found;
use super::lines::draw_lines;
use crate::explorer::finder::Finder;
use crate::explorer::keys::Bindings;
use crate::explorer::palette::entries;
use crate::explorer::theme::{Meaning, Theme};
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span};
use ratatui::widgets::{Block, Clear, Paragraph};

/// Widest list: a description and its keys.
const WIDEST: u16 = 100;

/// Draws the list, scrolled so that the selected row shows.
pub fn draw(frame: &mut Frame<'_>, area: Rect, theme: Theme, bindings: &Bindings, finder: &Finder) {
    let entries = entries(bindings);
    let width = area.width.min(WIDEST);
    let height = area.height.min(finder.found.len().max(1) as u16 + 2);
    let area = Rect { x: area.x + (area.width - width) / 2, width, height, ..area };
    let title = format!(" Commands, {} of {} ", finder.found.len(), entries.len());
    let block = Block::bordered().border_style(theme.style(Meaning::Quiet)).title(title);
    let inner = block.inner(area);
    frame.render_widget(Clear, area);
    frame.render_widget(block, area);
    if finder.found.is_empty() {
        frame.render_widget(Paragraph::new("no command fits").style(theme.style(Meaning::Quiet)), inner);
    }
    let height = usize::from(inner.height);
    let last = finder.found.len().saturating_sub(height);
    let first = finder.selected.saturating_sub(height / 2).min(last);
    for (y, place) in (inner.y..inner.bottom()).zip(first..finder.found.len()) {
        let Some(entry) = entries.get(finder.found[place]) else { continue };
        let selected = place == finder.selected;
        let (candidate, query) = (entry.candidate(), finder.query.text());
        let key = |key: &String| found(&candidate, key, &query, theme.style(Meaning::Key), theme);
        let keys: Vec<_> = entry.keys.iter().map(key).collect();
        let keys = Line::from(keys.join(&Span::raw(" "))).right_aligned();
        let mark = if selected { "›" } else { " " };
        let style = theme.style(if selected { Meaning::Selected } else { Meaning::Text });
        let help = found(&candidate, &entry.help, &query, style, theme);
        let line: Line<'_> = [Span::styled(format!("{mark} "), style)].into_iter().chain(help).collect();
        let room = inner.width.saturating_sub(keys.width() as u16 + 1);
        let row = Rect { y, height: 1, ..inner };
        draw_lines(frame, Rect { width: room, ..row }, [line]);
        frame.render_widget(keys, row);
    }
}
