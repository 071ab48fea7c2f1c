//! The help: the notice of the scene, the contents of the panes, and the table of keys by section.

use crate::explorer::app::App;
use crate::explorer::layout::{Layout, inside};
use crate::explorer::pane::Pane;
use crate::explorer::panel::{self, Panel};
use crate::explorer::theme::{Meaning, Theme};
use crate::explorer::view::text::wrapped;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span};

/// Columns for the keys beside their help in windows from a width on; in narrower ones the keys are above the help.
const KEYS: usize = 18;
const BESIDE_FROM: u16 = 56;
/// Columns before a help text below its keys.
const INDENT: usize = 4;

pub fn draw(area: Rect, app: &App, scroll: u16, buffer: &mut Buffer) {
    let mut head = lines(inside(area).width, app);
    head.drain(..usize::from(scroll.min(end(head.len(), area))));
    let panel = Panel { head, ..Panel::of_text("Help".to_owned(), "") };
    panel::draw(&panel, area, false, app.view.appearance, buffer);
}

pub fn help_end(app: &App) -> u16 {
    let area = Layout::of(app).body();
    end(lines(inside(area).width, app).len(), area)
}

fn end(lines: usize, area: Rect) -> u16 {
    (lines as u16).saturating_sub(inside(area).height)
}

/// All lines of the help, each within a number of columns.
fn lines(width: u16, app: &App) -> Vec<Line<'static>> {
    let theme = app.view.appearance.theme;
    let title = |text| Line::styled(text, theme.style(Meaning::Title));
    let mut lines = vec![title("What you see")];
    // A small window has no room for the notice above the panes.
    let notice = app.edit.document.scene().notice.split_whitespace().collect::<Vec<_>>().join(" ");
    if !notice.is_empty() {
        entry(&mut lines, "This scene", &notice, width, theme);
    }
    for (name, meaning) in Pane::ALL.iter().flat_map(|pane| pane.row().help) {
        entry(&mut lines, name, meaning, width, theme);
    }
    let mut section = "";
    for binding in app.config.bindings.rows() {
        let row = binding.row;
        if row.section != section {
            section = row.section;
            lines.push(Line::default());
            lines.push(title(section));
        }
        entry(&mut lines, &binding.names(), row.help, width, theme);
    }
    lines
}

/// Adds keys and their function, in as many lines as needed.
fn entry(lines: &mut Vec<Line<'static>>, keys: &str, help: &str, width: u16, theme: Theme) {
    let is_beside = width >= BESIDE_FROM;
    let indent = if is_beside { KEYS + 2 } else { INDENT };
    let room = usize::from(width).saturating_sub(indent);
    let key_style = theme.style(Meaning::Key);
    if !is_beside {
        lines.push(Line::styled(format!("  {keys}"), key_style));
    }
    let texts = wrapped(&Line::raw(help.to_owned()), room as u16);
    for (number, text) in texts.into_iter().enumerate() {
        let keys = if number == 0 && is_beside { format!("  {keys}") } else { String::new() };
        let keys = Span::styled(format!("{keys:<indent$}"), key_style);
        lines.push([keys].into_iter().chain(text.spans).collect());
    }
}
