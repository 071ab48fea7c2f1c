//! The library: scenes to choose from on the left, the selected one on the right.

use super::lines::{draw_lines, draw_reason, found};
use super::wrap::wrapped;
use crate::explorer::prompt::Prompt;
use crate::explorer::theme::{Meaning, Theme};
use crate::scene::{Entry, Source};
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span as Text};
use ratatui::widgets::Block;

/// Draws the scenes that fit, and the selected one.
pub fn draw(frame: &mut Frame<'_>, area: Rect, theme: Theme, prompt: &Prompt, entries: &[Entry]) {
    let block = Block::bordered().border_style(theme.style(Meaning::Quiet)).title(format!(
        " Scenes, {} of {} ",
        prompt.found.len(),
        entries.len()
    ));
    let inner = block.inner(area);
    frame.render_widget(block, area);
    let beside = inner.width >= 60;
    let list = Rect { width: if beside { inner.width * 2 / 5 } else { inner.width }, ..inner };
    draw_list(frame, list, theme, prompt, entries);
    if beside && let Some(entry) = prompt.scene() {
        let right = Rect { x: list.right() + 2, width: inner.width - list.width - 2, ..inner };
        draw_entry(frame, right, theme, entry, prompt.line.text());
    }
}

fn draw_list(frame: &mut Frame<'_>, area: Rect, theme: Theme, prompt: &Prompt, entries: &[Entry]) {
    if prompt.found.is_empty() {
        let reason =
            "no scene fits; Enter tries it as a path, such as ./scene.ron or that of a study's folder";
        return draw_reason(frame, area, reason, theme);
    }
    let first = (prompt.selected + 1).saturating_sub(usize::from(area.height));
    for (row, place) in (area.y..area.bottom()).zip(first..prompt.found.len()) {
        let Some(entry) = entries.get(prompt.found[place]) else { continue };
        let selected = place == prompt.selected;
        let mark = match (entry.error(), selected) {
            (Some(_), _) => "!",
            (None, true) => "›",
            (None, false) => " ",
        };
        let style = theme.style(if selected { Meaning::Selected } else { Meaning::Text });
        let mut line = Line::from(Text::styled(format!("{mark} "), style));
        line.extend(found(&entry.name, prompt.line.text(), style, theme));
        line.push_span(Text::styled(format!("  {}", place_of(entry.origin)), theme.style(Meaning::Quiet)));
        draw_lines(frame, Rect { y: row, height: 1, ..area }, [line]);
    }
}

/// Origin of a scene, in words.
fn place_of(source: Source) -> &'static str {
    match source {
        Source::BuiltIn => "built-in",
        Source::Own => "own",
        Source::Working => "here",
    }
}

/// Title, notice, and text of a scene.
fn draw_entry(frame: &mut Frame<'_>, area: Rect, theme: Theme, entry: &Entry, query: &str) {
    let mark = |text: &str, meaning| Line::from(found(text, query, theme.style(meaning), theme));
    let mut lines = wrapped(&mark(entry.title(), Meaning::Title), area.width);
    let notice = entry.notice().split_whitespace().collect::<Vec<_>>().join(" ");
    lines.extend(wrapped(&mark(&notice, Meaning::Text), area.width));
    if let Some(error) = entry.error() {
        lines.extend(wrapped(&Line::styled(format!("! {error}"), theme.style(Meaning::Error)), area.width));
    }
    let text = entry.text.lines().map(|line| Line::styled(line.to_owned(), theme.style(Meaning::Quiet)));
    draw_lines(frame, area, lines.into_iter().chain(text));
}
