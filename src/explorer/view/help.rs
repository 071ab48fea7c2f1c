//! The help: the table of keys by section, and what the panes show.

use crate::explorer::keys::{Bindings, names};
use crate::explorer::theme::{Meaning, Theme};
use ratatui::Frame;
use ratatui::layout::{Margin, Rect};
use ratatui::text::{Line, Span};
use ratatui::widgets::{Block, Paragraph};

const PANES: &[(&str, &str)] = &[
    (
        "Curve",
        "F over indentation d: dotted while pressing, solid while pulling; ◇ jump-in, ▲ preload, ▼ pull-off, \
         ◆ now; letters and colours are ghosts, dashes are where the hand has been",
    ),
    (
        "Profile",
        "rigid profile below, elastic surface above; ■ marks contact. Beside it the histogram of heights, and ¦ the \
         normal distribution of the same rms height",
    ),
    (
        "Fragments",
        "close-up of a contact patch; ○ marks its edges. Below it the whole contact, [ ] around the close-up",
    ),
    (
        "Accuracy",
        "A: relative error against the time of a run, one line for each setting that affects accuracy; ◆ is the \
         scene. Below it the cost of 1 % and 0.1 %, and the computing stages",
    ),
    (
        "Preloads",
        "i: adhesion force over preload, of this profile and the mean of random profiles with its 95 % confidence; the \
         line and ◆ are the present preload",
    ),
    (
        "Estimate",
        "~: approximate JKR curve under the loop, from the contact without adhesion (Ciavarella 2018): contact areas as \
         there, patches as circles that never merge, no hysteresis of single patches; exact for one patch",
    ),
    (
        "Map",
        "m: regime under other H and κ (e: e_el/γ), of most of a few random profiles with few springs; █ adhesion at first \
         touch, ▒ after pressing, · hardly any, blank: not computed; ◆ is the scene, moved by the arrows",
    ),
    (
        "Study",
        "map of a merged study, opened by the path of its folder: means over its profiles, ▓ ░ where profiles \
         differ in their regimes; ◆ moves from cell to cell, P selects the next preload, W switches between the \
         study and the live map",
    ),
    (
        "Parameters",
        "fields of the scene by use, in groups; ● marks an effect that is on, ▸ a folded group, = a derived value",
    ),
];

/// Columns for the keys.
const KEYS: usize = 18;

/// Draws the help.
pub fn draw(frame: &mut Frame<'_>, area: Rect, theme: Theme, bindings: &Bindings, scroll: u16) {
    let lines = lines(inside(area).width, theme, bindings);
    let last = end(lines.len(), area);
    let block = Block::bordered().border_style(theme.style(Meaning::Quiet)).title(" Help ");
    frame.render_widget(Paragraph::new(lines).block(block).scroll((scroll.min(last), 0)), area);
}

/// Lines it can be scrolled down in this area.
pub fn last_scroll(area: Rect, bindings: &Bindings) -> u16 {
    end(lines(inside(area).width, Theme::Plain, bindings).len(), area)
}

fn inside(area: Rect) -> Rect {
    area.inner(Margin::new(1, 1))
}

fn end(lines: usize, area: Rect) -> u16 {
    (lines as u16).saturating_sub(inside(area).height)
}

/// All lines, none of them wider than so many columns.
fn lines(width: u16, theme: Theme, bindings: &Bindings) -> Vec<Line<'static>> {
    let title = |text| Line::styled(text, theme.style(Meaning::Title));
    let mut lines = vec![title("What you see")];
    for (name, meaning) in PANES {
        entry(&mut lines, name, meaning, width, theme);
    }
    let mut section = "";
    for row in bindings.rows().filter(|row| !row.help.is_empty()) {
        if row.section != section {
            section = row.section;
            lines.push(Line::default());
            lines.push(title(section));
        }
        entry(&mut lines, &names(&row.keys).join(" "), row.help, width, theme);
    }
    lines
}

/// Adds keys and what they do, in as many lines as it takes.
fn entry(lines: &mut Vec<Line<'static>>, keys: &str, help: &str, width: u16, theme: Theme) {
    let room = usize::from(width).saturating_sub(KEYS + 2);
    let mut texts = vec![String::new()];
    for word in help.split(' ') {
        let text = texts.last_mut().filter(|text| text.chars().count() + 1 + word.chars().count() <= room);
        match text {
            Some(text) if text.is_empty() => text.push_str(word),
            Some(text) => *text += &format!(" {word}"),
            None => texts.push(word.to_owned()),
        }
    }
    for (number, text) in texts.into_iter().enumerate() {
        let keys = if number == 0 { keys } else { "" };
        let keys = Span::styled(format!("  {keys:<KEYS$}"), theme.style(Meaning::Key));
        lines.push(Line::from(vec![keys, Span::raw(text)]));
    }
}
