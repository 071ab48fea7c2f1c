//! Lists of a prompt in place of the panes: help and commands in sections, or scenes with the
//! selected one on the right.

use crate::explorer::layout::inside;
use crate::explorer::panel;
use crate::explorer::panel::{Body, Panel};
use crate::explorer::prompt::{Prompt, Topic};
use crate::explorer::text::{fitted, wrapped};
use crate::explorer::theme::{Appearance, Meaning, Theme};
use asperity_scene::library::{Entry, Source};
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span};

/// Width of the names beside their texts, columns, and the width of a window from which on names
/// are beside and not above.
const NAMES: usize = 20;
const BESIDE_FROM: u16 = 56;
/// Indentation of a text below its name, columns.
const INDENT: usize = 4;
/// Smallest width with the selected scene beside the list, columns.
const WITH_SCENE: u16 = 62;

/// Panel of a list of this name and length with these rows; `none` is its text without rows.
fn list(
    prompt: &Prompt,
    (name, length, none): (&str, usize, &str),
    (rows, selected): Rows,
) -> Panel {
    let corrected = prompt
        .corrected
        .as_ref()
        .map_or_else(String::new, |other| format!(", for {other}"));
    let title = format!("{name}, {} of {length}{corrected}", prompt.found.len());
    if rows.is_empty() {
        return Panel::of_text(title, none);
    }
    Panel {
        body: Body::Rows { rows, selected },
        ..Panel::of_text(title, "")
    }
}

/// Lines of a list, and the index of the selected line.
type Rows = (Vec<Line<'static>>, usize);

/// Draws the help or the list of commands: the topics that match what is typed, in sections while
/// nothing is typed.
pub fn draw_topics(
    area: Rect,
    look: Appearance,
    prompt: &Prompt,
    name: &str,
    topics: &[Topic],
    buffer: &mut Buffer,
) {
    let (theme, width) = (look.theme, inside(area).width);
    let (mut rows, mut selected, mut section) = (Vec::new(), 0, "");
    for (place, topic) in prompt
        .found
        .iter()
        .filter_map(|index| topics.get(*index))
        .enumerate()
    {
        if topic.section != section && prompt.line.text().is_empty() {
            section = topic.section;
            rows.push(Line::styled(section, theme.style(Meaning::Title)));
        }
        let is_selected = place == prompt.selected;
        if is_selected {
            selected = rows.len();
        }
        entry(&mut rows, topic, is_selected, width, theme);
    }
    panel::draw(
        &list(
            prompt,
            (name, topics.len(), "nothing fits"),
            (rows, selected),
        ),
        area,
        false,
        look,
        buffer,
    );
}

/// Adds the name and the text of a topic, in as many lines as needed.
fn entry(
    rows: &mut Vec<Line<'static>>,
    topic: &Topic,
    is_selected: bool,
    width: u16,
    theme: Theme,
) {
    let is_beside = width >= BESIDE_FROM && topic.name.chars().count() + 2 < NAMES;
    let indent = if width >= BESIDE_FROM { NAMES } else { INDENT };
    let name = Line::styled(
        format!("{} {}", if is_selected { "›" } else { " " }, topic.name),
        theme.style(Meaning::Key),
    );
    let mut name = Some(fitted(name, width));
    if !is_beside {
        rows.extend(name.take());
    }
    let style = theme.style(if is_selected {
        Meaning::Selected
    } else {
        Meaning::Text
    });
    for text in wrapped(
        &Line::styled(topic.text.clone(), style),
        width.saturating_sub(indent as u16),
    ) {
        let mut line = name.take().unwrap_or_default();
        line.push_span(" ".repeat(indent.saturating_sub(line.width())));
        line.spans.extend(text.spans);
        rows.push(line);
    }
}

pub fn draw_scenes(
    area: Rect,
    look: Appearance,
    prompt: &Prompt,
    entries: &[Entry],
    buffer: &mut Buffer,
) {
    let none = "no scene fits; Enter tries it as a path, such as ./scene.ron or ./study";
    let row = |(place, index): (usize, &usize)| {
        Some(scene(
            (*index, entries.get(*index)?),
            place == prompt.selected,
            look.theme,
        ))
    };
    let rows = prompt.found.iter().enumerate().filter_map(row).collect();
    let list = list(
        prompt,
        ("Scenes", entries.len(), none),
        (rows, prompt.selected),
    );
    let beside = prompt.scene().filter(|_| area.width >= WITH_SCENE);
    let width = if beside.is_some() {
        area.width * 2 / 5
    } else {
        area.width
    };
    panel::draw(&list, Rect { width, ..area }, false, look, buffer);
    if let Some(entry) = beside {
        let right = Rect {
            x: area.x + width,
            width: area.width - width,
            ..area
        };
        let head = text(entry, right.width - 2, look.theme);
        let scene = Panel {
            head,
            ..Panel::of_text(entry.name.clone(), "")
        };
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
    let style = theme.style(if is_selected {
        Meaning::Selected
    } else {
        Meaning::Text
    });
    // The number finds a built-in scene.
    let number = if entry.origin == Source::BuiltIn {
        (place + 1).to_string()
    } else {
        String::new()
    };
    let number = Span::styled(format!("{number:>2} "), theme.style(Meaning::Quiet));
    let name = Span::styled(format!("{mark}{}", entry.name), style);
    Line::from_iter([
        number,
        name,
        Span::styled(format!("  {origin}"), theme.style(Meaning::Quiet)),
    ])
}

fn text(entry: &Entry, width: u16, theme: Theme) -> Vec<Line<'static>> {
    let notice = entry
        .notice()
        .split_whitespace()
        .collect::<Vec<_>>()
        .join(" ");
    let error = entry
        .error()
        .map(|error| (format!("! {error}"), Meaning::Error));
    let words = [
        (entry.title().to_owned(), Meaning::Title),
        (notice, Meaning::Text),
    ]
    .into_iter()
    .chain(error);
    let mut lines: Vec<_> = words
        .flat_map(|(text, meaning)| wrapped(&Line::styled(text, theme.style(meaning)), width))
        .collect();
    lines.extend(
        entry
            .text
            .lines()
            .map(|line| Line::styled(line.to_owned(), theme.style(Meaning::Quiet))),
    );
    lines
}
