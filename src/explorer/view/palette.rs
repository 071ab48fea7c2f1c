//! The list of all commands, over the panes.

use super::lines::{draw_lines, found};
use crate::explorer::palette::Listed;
use crate::explorer::prompt::Prompt;
use crate::explorer::theme::{Meaning, Theme};
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span};
use ratatui::widgets::{Block, Clear, Paragraph};

/// Widest list: a description and its keys.
const WIDEST: u16 = 100;

/// Draws the list, scrolled so that the selected row shows.
pub fn draw(frame: &mut Frame<'_>, area: Rect, theme: Theme, prompt: &Prompt, entries: &[Listed]) {
    let query = prompt.line.text();
    let width = area.width.min(WIDEST);
    let height = area.height.min(prompt.found.len().max(1) as u16 + 2);
    let area = Rect { x: area.x + (area.width - width) / 2, width, height, ..area };
    let title = format!(" Commands, {} of {} ", prompt.found.len(), entries.len());
    let block = Block::bordered().border_style(theme.style(Meaning::Quiet)).title(title);
    let inner = block.inner(area);
    frame.render_widget(Clear, area);
    frame.render_widget(block, area);
    if prompt.found.is_empty() {
        frame.render_widget(Paragraph::new("no command fits").style(theme.style(Meaning::Quiet)), inner);
    }
    let height = usize::from(inner.height);
    let last = prompt.found.len().saturating_sub(height);
    let first = prompt.selected.saturating_sub(height / 2).min(last);
    for (y, place) in (inner.y..inner.bottom()).zip(first..prompt.found.len()) {
        let Some(entry) = entries.get(prompt.found[place]) else { continue };
        let selected = place == prompt.selected;
        let key = |key: &String| found(key, query, theme.style(Meaning::Key), theme);
        let keys: Vec<_> = entry.keys.iter().map(key).collect();
        let keys = Line::from(keys.join(&Span::raw(" "))).right_aligned();
        let mark = if selected { "›" } else { " " };
        let style = theme.style(if selected { Meaning::Selected } else { Meaning::Text });
        let help = found(&entry.help, query, style, theme);
        let line: Line<'_> = [Span::styled(format!("{mark} "), style)].into_iter().chain(help).collect();
        let room = inner.width.saturating_sub(keys.width() as u16 + 1);
        let row = Rect { y, height: 1, ..inner };
        draw_lines(frame, Rect { width: room, ..row }, [line]);
        frame.render_widget(keys, row);
    }
}
