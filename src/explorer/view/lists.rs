//! Lists of a prompt, which are drawn in place of the panes: the help or the commands in sections,
//! or the scenes, with the selected scene on the right.

use crate::explorer::layout::inside;
use crate::explorer::openable::{ListedFile, Openable};
use crate::explorer::panel;
use crate::explorer::panel::{Body, Panel};
use crate::explorer::prompt::{Prompt, Topic};
use crate::explorer::text::{fitted, on_one_line, wrapped};
use crate::explorer::theme::{Appearance, Meaning, Theme};
use asperity_data::printable;
use asperity_scene::library::{Entry, Source};
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span};

/// Width in columns of the names that are beside their texts.
const NAMES: usize = 20;
/// Smallest width in columns of a window in which the names are beside their texts. In a narrower
/// window, each name is above its text.
const BESIDE_FROM: u16 = 56;
/// Indentation in columns of a text below its name.
const INDENT: usize = 4;
/// Smallest width in columns of a window that shows the selected scene on the right of the list.
const WITH_SCENE: u16 = 62;

/// A list that replaces the panes.
struct List<'a> {
    name: &'a str,
    /// Number of all entries, including the entries that are not shown.
    length: usize,
    /// Text that is shown if no entry matches the typed text.
    none: &'a str,
    rows: Vec<Line<'static>>,
    /// Index of the selected row.
    selected: usize,
}

impl List<'_> {
    fn panel(self, prompt: &Prompt) -> Panel {
        let corrected = match &prompt.corrected {
            Some(words) => format!(", for {words}"),
            None => String::new(),
        };
        let found = prompt.found.len();
        let title = format!("{}, {found} of {}{corrected}", self.name, self.length);
        if self.rows.is_empty() {
            return Panel::of_text(title, self.none);
        }
        Panel {
            body: Body::Rows {
                rows: self.rows,
                selected: self.selected,
            },
            ..Panel::of_text(title, "")
        }
    }
}

/// Draws the help or the list of commands. If the user has typed a text, only the topics that match
/// this text are drawn. Otherwise all topics are drawn in sections.
pub fn draw_topics(
    area: Rect,
    look: Appearance,
    prompt: &Prompt,
    name: &str,
    topics: &[Topic],
    buffer: &mut Buffer,
) {
    let width = inside(area).width;
    let mut list = List {
        name,
        length: topics.len(),
        none: "nothing fits",
        rows: Vec::new(),
        selected: 0,
    };
    let mut section = "";
    let found = prompt.found.iter().filter_map(|index| topics.get(*index));
    for (place, topic) in found.enumerate() {
        if topic.section != section && prompt.line.text().is_empty() {
            section = topic.section;
            let heading = Line::styled(section, look.theme.style(Meaning::Title));
            list.rows.push(heading);
        }
        let is_selected = place == prompt.selected;
        if is_selected {
            list.selected = list.rows.len();
        }
        list.rows
            .extend(rows_of_topic(topic, is_selected, width, look.theme));
    }
    panel::draw(&list.panel(prompt), area, false, look, buffer);
}

/// Returns the rows of a topic, with its name and its text. In a wide window, the text is on the
/// right of the name, otherwise below the name.
fn rows_of_topic(topic: &Topic, is_selected: bool, width: u16, theme: Theme) -> Vec<Line<'static>> {
    let mut rows = Vec::new();
    let is_wide = width >= BESIDE_FROM;
    let is_beside = is_wide && topic.name.chars().count() + 2 < NAMES;
    let indent = if is_wide { NAMES } else { INDENT };
    let mark = if is_selected { "›" } else { " " };
    let name = format!("{mark} {}", topic.name);
    let name = fitted(Line::styled(name, theme.style(Meaning::Key)), width);
    // The row that is being filled with lines of the text.
    let mut begun = Line::default();
    if is_beside {
        begun = name;
    } else {
        rows.push(name);
    }
    let meaning = if is_selected {
        Meaning::Selected
    } else {
        Meaning::Text
    };
    let text = Line::styled(topic.text.clone(), theme.style(meaning));
    for line in wrapped(&text, width.saturating_sub(indent as u16)) {
        let mut row = std::mem::take(&mut begun);
        row.push_span(" ".repeat(indent.saturating_sub(row.width())));
        row.spans.extend(line.spans);
        rows.push(row);
    }
    rows
}

/// Draws the list of what the user can open, with the selected entry in detail on the right.
pub fn draw_openables(
    area: Rect,
    look: Appearance,
    prompt: &Prompt,
    entries: &[Openable],
    buffer: &mut Buffer,
) {
    let mut list = List {
        name: "Scenes and files",
        length: entries.len(),
        none: "nothing fits; Enter tries it as a path, such as ./scene.ron, ./study or ./curve.csv",
        rows: Vec::new(),
        selected: prompt.selected,
    };
    for (place, index) in prompt.found.iter().enumerate() {
        if let Some(entry) = entries.get(*index) {
            let is_selected = place == prompt.selected;
            let row = match entry {
                Openable::Scene(entry) => row_of_scene(*index, entry, is_selected, look.theme),
                Openable::File(file) => row_of_file(file, is_selected, look.theme),
            };
            list.rows.push(row);
        }
    }
    let list = list.panel(prompt);
    let beside = prompt.openable().filter(|_| area.width >= WITH_SCENE);
    let Some(entry) = beside else {
        panel::draw(&list, area, false, look, buffer);
        return;
    };
    let width = area.width * 2 / 5;
    let left = Rect { width, ..area };
    let right = Rect {
        x: area.x + width,
        width: area.width - width,
        ..area
    };
    let head = match entry {
        Openable::Scene(entry) => words_of_scene(entry, right.width - 2, look.theme),
        Openable::File(file) => words_of_file(file, right.width - 2, look.theme),
    };
    let selected = Panel {
        head,
        ..Panel::of_text(entry.name().to_owned(), "")
    };
    panel::draw(&list, left, false, look, buffer);
    panel::draw(&selected, right, false, look, buffer);
}

/// Returns the row of a scene in the list: the number by which the user can search for a built-in
/// scene, the name of the scene, and its source.
fn row_of_scene(index: usize, entry: &Entry, is_selected: bool, theme: Theme) -> Line<'static> {
    let mark = if entry.error().is_some() {
        "! "
    } else if is_selected {
        "› "
    } else {
        "  "
    };
    let origin = match entry.origin {
        Source::BuiltIn => "built-in",
        Source::Own => "own",
        Source::Working => "here",
    };
    let number = if entry.origin == Source::BuiltIn {
        (index + 1).to_string()
    } else {
        String::new()
    };
    let name_meaning = if is_selected {
        Meaning::Selected
    } else {
        Meaning::Text
    };
    let quiet = theme.style(Meaning::Quiet);
    let name = format!("{mark}{}", entry.name);
    Line::from_iter([
        Span::styled(format!("{number:>2} "), quiet),
        Span::styled(name, theme.style(name_meaning)),
        Span::styled(format!("  {origin}"), quiet),
    ])
}

/// Returns the row of a file in the list: its name and its kind.
fn row_of_file(file: &ListedFile, is_selected: bool, theme: Theme) -> Line<'static> {
    let (mark, meaning) = if is_selected {
        ("› ", Meaning::Selected)
    } else {
        ("  ", Meaning::Text)
    };
    let quiet = theme.style(Meaning::Quiet);
    Line::from_iter([
        Span::styled("   ", quiet),
        Span::styled(format!("{mark}{}", file.name), theme.style(meaning)),
        Span::styled(format!("  {}", file.kind.word()), quiet),
    ])
}

/// Returns what opening a file does, and the beginning of its text, in lines of this width.
fn words_of_file(file: &ListedFile, width: u16, theme: Theme) -> Vec<Line<'static>> {
    let effect = Line::styled(file.kind.effect(), theme.style(Meaning::Text));
    let mut lines = wrapped(&effect, width);
    for line in file.text.lines() {
        let line = printable(line).into_owned();
        lines.push(Line::styled(line, theme.style(Meaning::Quiet)));
    }
    lines
}

/// Returns the title, the notice, the error and the text of a scene, in lines of this width.
fn words_of_scene(entry: &Entry, width: u16, theme: Theme) -> Vec<Line<'static>> {
    let mut texts = vec![
        (entry.title().to_owned(), Meaning::Title),
        (on_one_line(entry.notice()), Meaning::Text),
    ];
    if let Some(error) = entry.error() {
        texts.push((format!("! {error}"), Meaning::Error));
    }
    let mut lines = Vec::new();
    for (text, meaning) in texts {
        lines.extend(wrapped(&Line::styled(text, theme.style(meaning)), width));
    }
    for line in entry.text.lines() {
        lines.push(Line::styled(line.to_owned(), theme.style(Meaning::Quiet)));
    }
    lines
}
