//! The help: the table of keys by section, and what the panes show.

use crate::explorer::keys::BINDINGS;
use crate::explorer::theme::{Meaning, Theme};
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span};
use ratatui::widgets::{Block, Paragraph};

const PANES: &[(&str, &str)] = &[
    (
        "Force",
        "F over indentation d: dotted while pressing, solid while pulling; ▲ preload, ▼ pull-off, ◆ now",
    ),
    (
        "Profile",
        "rigid line below, elastic surface above it, ■ below where they touch; beside it the heights",
    ),
    ("Fragments", "close-up; ○ are the boundary points of contact fragments"),
    ("Parameters", "everything the scene says; the curve follows each change"),
];

/// Draws the help.
pub fn draw(frame: &mut Frame<'_>, area: Rect, theme: Theme, scroll: u16) {
    let mut lines = vec![Line::styled("What you see", theme.style(Meaning::Title))];
    for (name, meaning) in PANES {
        lines.push(Line::from(vec![
            Span::styled(format!("  {name:<14}"), theme.style(Meaning::Key)),
            Span::raw(*meaning),
        ]));
    }
    let mut section = "";
    for row in BINDINGS.iter().filter(|row| !row.help.is_empty()) {
        if row.section != section {
            section = row.section;
            lines.push(Line::default());
            lines.push(Line::styled(section, theme.style(Meaning::Title)));
        }
        let keys: Vec<String> = row.keys.iter().map(super::super::keys::Key::name).collect();
        lines.push(Line::from(vec![
            Span::styled(format!("  {:<14}", keys.join(" ")), theme.style(Meaning::Key)),
            Span::raw(row.help),
        ]));
    }
    let last = (lines.len() as u16).saturating_sub(area.height.saturating_sub(2));
    let block = Block::bordered().border_style(theme.style(Meaning::Quiet)).title(" Help ");
    frame.render_widget(Paragraph::new(lines).block(block).scroll((scroll.min(last), 0)), area);
}
