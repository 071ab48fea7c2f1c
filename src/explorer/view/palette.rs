//! The list of all commands, over the panes.

use super::text::{fitted, found};
use crate::explorer::keys::{Binding, Key};
use crate::explorer::panel::{self, Body, Panel};
use crate::explorer::prompt::Prompt;
use crate::explorer::theme::{Appearance, Meaning, Theme};
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span};
use ratatui::widgets::{Clear, Widget};

/// Widest list: a description and its keys.
const WIDEST: u16 = 100;

/// Draws the list.
pub fn draw(area: Rect, look: Appearance, prompt: &Prompt, entries: &[Binding], buffer: &mut Buffer) {
    let title = format!("Commands, {} of {}", prompt.found.len(), entries.len());
    let width = area.width.min(WIDEST);
    let height = area.height.min(prompt.found.len().max(1) as u16 + 2);
    let area = Rect { x: area.x + (area.width - width) / 2, width, height, ..area };
    let (query, columns) = (prompt.line.text(), width.saturating_sub(2));
    let rows = prompt.found.iter().enumerate().filter_map(|(place, index)| {
        Some(row(entries.get(*index)?, place == prompt.selected, query, columns, look.theme))
    });
    let mut list = Panel::of_text(title, "no command fits");
    if !prompt.found.is_empty() {
        list.body = Body::Rows { rows: rows.collect(), selected: prompt.selected };
    }
    Clear.render(area, buffer);
    panel::draw(&list, area, false, look, buffer);
}

/// A command, and its keys at the right end.
fn row(entry: &Binding, is_selected: bool, query: &str, width: u16, theme: Theme) -> Line<'static> {
    let key = |key: &Key| found(&key.name, query, theme.style(Meaning::Key), theme);
    let keys: Vec<_> = entry.keys.iter().map(key).collect();
    let keys = Line::from(keys.join(&Span::raw(" ")));
    let style = theme.style(if is_selected { Meaning::Selected } else { Meaning::Text });
    let help = found(entry.row.help, query, style, theme);
    let mark = Span::styled(if is_selected { "› " } else { "  " }, style);
    let room = width.saturating_sub(keys.width() as u16 + 1);
    let mut line = fitted([mark].into_iter().chain(help).collect(), room);
    line.push_span(" ".repeat(usize::from(width).saturating_sub(line.width() + keys.width())));
    line.extend(keys);
    line
}
