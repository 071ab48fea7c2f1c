//! Lists of a prompt: commands with their keys, over the panes; scenes, with the selected one on the right.

use super::text::{fitted, wrapped};
use crate::explorer::keys::Binding;
use crate::explorer::panel::{self, Body, Panel};
use crate::explorer::prompt::Prompt;
use crate::explorer::theme::{Appearance, Meaning, Theme};
use crate::scene::{Entry, Source};
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span};
use ratatui::widgets::{Clear, Widget};

/// Widest list of commands: a description and its keys.
const WIDEST: u16 = 100;
/// Least columns with the selected scene beside the list.
const WITH_SCENE: u16 = 62;

/// The rows that fit what is typed, of a list of this name and length.
fn list(
    prompt: &Prompt,
    (name, length, none): (&str, usize, &str),
    row: impl Fn(usize, bool) -> Option<Line<'static>>,
) -> Panel {
    let title = format!("{name}, {} of {length}", prompt.found.len());
    if prompt.found.is_empty() {
        return Panel::of_text(title, none);
    }
    let rows = prompt.found.iter().enumerate();
    let rows = rows.filter_map(|(place, index)| row(*index, place == prompt.selected)).collect();
    Panel { body: Body::Rows { rows, selected: prompt.selected }, ..Panel::of_text(title, "") }
}

pub fn draw_commands(
    area: Rect,
    look: Appearance,
    prompt: &Prompt,
    entries: &[Binding],
    buffer: &mut Buffer,
) {
    let width = area.width.min(WIDEST);
    // Enough rows for a frame with the title.
    let height = area.height.min(prompt.found.len().max(4) as u16 + 2);
    let area = Rect { x: area.x + (area.width - width) / 2, width, height, ..area };
    let list = list(prompt, ("Commands", entries.len(), "no command fits"), |index, is_selected| {
        Some(command(entries.get(index)?, is_selected, width.saturating_sub(2), look.theme))
    });
    Clear.render(area, buffer);
    panel::draw(&list, area, false, look, buffer);
}

/// A command, and its keys at the right end.
fn command(entry: &Binding, is_selected: bool, width: u16, theme: Theme) -> Line<'static> {
    let keys = Span::styled(entry.names(), theme.style(Meaning::Key));
    let style = theme.style(if is_selected { Meaning::Selected } else { Meaning::Text });
    let mark = if is_selected { "›" } else { " " };
    let room = width.saturating_sub(keys.width() as u16 + 1);
    let mut line = fitted(Line::from(Span::styled(format!("{mark} {}", entry.row.help), style)), room);
    line.push_span(" ".repeat(usize::from(width).saturating_sub(line.width() + keys.width())));
    line.push_span(keys);
    line
}

pub fn draw_scenes(area: Rect, look: Appearance, prompt: &Prompt, entries: &[Entry], buffer: &mut Buffer) {
    let none = "no scene fits; Enter tries it as a path, such as ./scene.ron or that of a study's folder";
    let list = list(prompt, ("Scenes", entries.len(), none), |index, is_selected| {
        Some(scene((index, entries.get(index)?), is_selected, look.theme))
    });
    let beside = prompt.scene().filter(|_| area.width >= WITH_SCENE);
    let width = if beside.is_some() { area.width * 2 / 5 } else { area.width };
    panel::draw(&list, Rect { width, ..area }, false, look, buffer);
    if let Some(entry) = beside {
        let right = Rect { x: area.x + width, width: area.width - width, ..area };
        let head = text(entry, right.width - 2, look.theme);
        let scene = Panel { head, ..Panel::of_text(entry.name.clone(), "") };
        panel::draw(&scene, right, false, look, buffer);
    }
}

fn scene((place, entry): (usize, &Entry), is_selected: bool, theme: Theme) -> Line<'static> {
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
    // The number finds a built-in scene.
    let number = if entry.origin == Source::BuiltIn { (place + 1).to_string() } else { String::new() };
    let number = Span::styled(format!("{number:>2} "), theme.style(Meaning::Quiet));
    let name = Span::styled(format!("{mark}{}", entry.name), style);
    Line::from_iter([number, name, Span::styled(format!("  {origin}"), theme.style(Meaning::Quiet))])
}

fn text(entry: &Entry, width: u16, theme: Theme) -> Vec<Line<'static>> {
    let notice = entry.notice().split_whitespace().collect::<Vec<_>>().join(" ");
    let error = entry.error().map(|error| (format!("! {error}"), Meaning::Error));
    let words =
        [(entry.title().to_owned(), Meaning::Title), (notice, Meaning::Text)].into_iter().chain(error);
    let mut lines: Vec<_> =
        words.flat_map(|(text, meaning)| wrapped(&Line::styled(text, theme.style(meaning)), width)).collect();
    lines.extend(entry.text.lines().map(|line| Line::styled(line.to_owned(), theme.style(Meaning::Quiet))));
    lines
}
