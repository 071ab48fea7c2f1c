//! Letters found by a search, in the texts of its list.

use crate::explorer::fuzzy::{Candidate, letters_found};
use crate::explorer::theme::Theme;
use ratatui::style::Style;
use ratatui::text::Span;

/// A text of a candidate with the letters found by the query marked.
pub fn found(
    candidate: &Candidate,
    text: &str,
    query: &str,
    style: Style,
    theme: Theme,
) -> Vec<Span<'static>> {
    marked(text, &letters_found(candidate, text, query), style, theme)
}

/// A text with these of its characters marked; the indices ascend.
pub fn marked(text: &str, letters: &[usize], style: Style, theme: Theme) -> Vec<Span<'static>> {
    let characters: Vec<(bool, char)> = text
        .chars()
        .enumerate()
        .map(|(index, character)| (letters.binary_search(&index).is_ok(), character))
        .collect();
    let spans = characters.chunk_by(|(one, _), (next, _)| one == next).map(|run| {
        let style = if run[0].0 { theme.found(style) } else { style };
        Span::styled(run.iter().map(|(_, character)| character).collect::<String>(), style)
    });
    spans.collect()
}
