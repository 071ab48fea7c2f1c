//! A line being typed, with its cursor.

use crate::explorer::text_line::TextLine;
use crate::explorer::theme::{Meaning, Theme};
use ratatui::style::Modifier;
use ratatui::text::Span;

/// The part of a line around its cursor, within a number of columns.
pub fn typed(line: &TextLine, columns: usize, theme: Theme) -> Vec<Span<'static>> {
    let reversed = theme.style(Meaning::Text).add_modifier(Modifier::REVERSED);
    if line.is_selected() && !line.text().is_empty() {
        return vec![Span::styled(line.text().to_owned(), reversed)];
    }
    let (before, under, after) = line.parts();
    let under = if under.is_empty() { " ".to_owned() } else { under };
    let mut room = columns.saturating_sub(Span::raw(under.as_str()).width());
    let fits = |character: char| {
        room = room.checked_sub(Span::raw(character.to_string()).width())?;
        Some(character)
    };
    let mut seen: Vec<char> = before.chars().rev().map_while(fits).collect();
    seen.reverse();
    let cursor = Span::styled(under, reversed);
    vec![Span::raw(String::from_iter(seen)), cursor, Span::raw(after)]
}
