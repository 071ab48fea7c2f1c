//! The library: scenes to choose from on the left, the selected one on the right.

use super::text::{found, wrapped};
use crate::explorer::panel::{self, Body, Panel};
use crate::explorer::prompt::Prompt;
use crate::explorer::theme::{Appearance, Meaning, Theme};
use crate::scene::{Entry, Source};
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span};

/// Least columns with the selected scene beside the list.
const WITH_SCENE: u16 = 62;

/// Draws the scenes that fit, and the selected one.
pub fn draw(area: Rect, look: Appearance, prompt: &Prompt, entries: &[Entry], buffer: &mut Buffer) {
    let title = format!("Scenes, {} of {}", prompt.found.len(), entries.len());
    let beside = prompt.scene().filter(|_| area.width >= WITH_SCENE);
    let width = if beside.is_some() { area.width * 2 / 5 } else { area.width };
    let query = prompt.line.text();
    let rows = prompt.found.iter().enumerate().filter_map(|(place, index)| {
        Some(row(entries.get(*index)?, place == prompt.selected, query, look.theme))
    });
    let none = "no scene fits; Enter tries it as a path, such as ./scene.ron or that of a study's folder";
    let list = match prompt.found.is_empty() {
        true => Panel::of_text(title, none),
        false => {
            let body = Body::Rows { rows: rows.collect(), selected: prompt.selected };
            Panel { body, ..Panel::of_text(title, "") }
        }
    };
    panel::draw(&list, Rect { width, ..area }, false, look, buffer);
    if let Some(entry) = beside {
        let right = Rect { x: area.x + width, width: area.width - width, ..area };
        let head = text(entry, query, right.width - 2, look.theme);
        let scene = Panel { head, ..Panel::of_text(entry.name.clone(), "") };
        panel::draw(&scene, right, false, look, buffer);
    }
}

fn row(entry: &Entry, is_selected: bool, query: &str, theme: Theme) -> Line<'static> {
    let mark = match (entry.error(), is_selected) {
        (Some(_), _) => "! ",
        (None, true) => "› ",
        (None, false) => "  ",
    };
    let origin = match entry.origin {
        Source::BuiltIn => "built-in",
        Source::Own => "own",
        Source::Working => "here",
    };
    let style = theme.style(if is_selected { Meaning::Selected } else { Meaning::Text });
    let mut line = Line::from(Span::styled(mark, style));
    line.extend(found(&entry.name, query, style, theme));
    line.push_span(Span::styled(format!("  {origin}"), theme.style(Meaning::Quiet)));
    line
}

/// Title, notice, and text of a scene.
fn text(entry: &Entry, query: &str, width: u16, theme: Theme) -> Vec<Line<'static>> {
    let mark = |text: &str, meaning| Line::from(found(text, query, theme.style(meaning), theme));
    let mut lines = wrapped(&mark(entry.title(), Meaning::Title), width);
    let notice = entry.notice().split_whitespace().collect::<Vec<_>>().join(" ");
    lines.extend(wrapped(&mark(&notice, Meaning::Text), width));
    if let Some(error) = entry.error() {
        lines.extend(wrapped(&Line::styled(format!("! {error}"), theme.style(Meaning::Error)), width));
    }
    lines.extend(entry.text.lines().map(|line| Line::styled(line.to_owned(), theme.style(Meaning::Quiet))));
    lines
}
