//! Draws the model. Nothing here changes the model or computes anything.

mod chrome;
mod help;
mod library;
pub mod lines;
mod palette;
pub mod plot;
pub mod stages;
pub mod typed;
pub mod wrap;

use self::wrap::fitted;
use super::app::{App, Mode};
use super::layout::{Layout, is_framed};
use super::panes::Pane;
use super::picture::to_ascii;
use super::prompt::Purpose;
use super::theme::{Marker, Meaning, Theme};
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::style::Modifier;
use ratatui::text::Line;
use ratatui::widgets::Block;

/// Draws the whole screen.
pub fn draw(frame: &mut Frame<'_>, app: &App) {
    // The window may have another size than the model by now.
    let area = frame.area();
    let layout = Layout::within(app, (area.width, area.height));
    if let Some(area) = layout.title {
        chrome::title(frame, area, app);
    }
    let (panes, theme) = (body(&layout), app.view.appearance.theme);
    let list = app.mode.prompt().map(|prompt| (prompt, &prompt.purpose));
    match (&app.mode, list) {
        (Mode::Help { scroll }, _) => help::draw(frame, panes, app, *scroll),
        (_, Some((prompt, Purpose::Scene(entries)))) => library::draw(frame, panes, theme, prompt, entries),
        _ => layout.panes.iter().for_each(|&(pane, area)| draw_pane(frame, area, app, pane)),
    }
    if let Some((prompt, Purpose::Command(entries))) = list {
        palette::draw(frame, panes, theme, prompt, entries);
    }
    crate::draw::dry(frame.buffer_mut());
    chrome::status(frame, layout.status, app);
    if let Some(area) = layout.footer {
        chrome::footer(frame, area, app);
    }
    if app.view.appearance.theme == Theme::HighContrast {
        frame.buffer_mut().set_style(area, Modifier::BOLD);
    }
    if app.view.appearance.marker == Marker::Ascii {
        to_ascii(frame.buffer_mut());
    }
}

/// Area of the panes.
fn body(layout: &Layout) -> Rect {
    layout.panes.iter().map(|(_, area)| *area).reduce(Rect::union).unwrap_or_default()
}

/// Lines the help can be scrolled down.
#[must_use]
pub fn help_end(app: &App) -> u16 {
    help::last_scroll(body(&Layout::of(app)), app)
}

fn draw_pane(frame: &mut Frame<'_>, area: Rect, app: &App, pane: Pane) {
    let row = pane.row();
    if is_framed(area) {
        let chosen = app.view.pane == pane;
        let name = (row.title)(app);
        let style = app.view.appearance.theme.style(if chosen { Meaning::Title } else { Meaning::Quiet });
        let mark = if chosen { "▸" } else { "" };
        let room = area.width - 2;
        let mut name = format!("{mark}{name}");
        if name.chars().count() > usize::from(room) {
            name.truncate(name.trim_end().len());
        }
        let title = fitted(Line::styled(name, style), room);
        let block =
            Block::bordered().border_style(app.view.appearance.theme.style(Meaning::Quiet)).title(title);
        let names = (row.edge)(app, area);
        frame.render_widget(names.into_iter().fold(block, Block::title_bottom), area);
    }
    (row.draw)(frame, area, app);
}
