//! The views, which draw the state of the explorer. They never change the state.

mod chrome;
mod lists;

use crate::explorer::app::App;
use crate::explorer::layout::{Layout, inside};
use crate::explorer::panel;
use crate::explorer::panes;
use crate::explorer::prompt::Purpose;
use crate::explorer::theme::Marker;
use asperity_plot::to_ascii;
use ratatui::Frame;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

pub fn draw(frame: &mut Frame<'_>, app: &App) {
    // The layout uses the size of the frame. The size in the state may be older than the last
    // change of the window.
    let area = frame.area();
    let layout = Layout::within(app, (area.width, area.height));
    let look = app.view.appearance;
    let buffer = frame.buffer_mut();
    if let Some(area) = layout.title {
        panel::draw_lines(&chrome::title(app, area.width, area.height), area, buffer);
    }
    draw_body(app, &layout, buffer);
    // A long status text also takes the row of the footer.
    let rows = 1 + u16::from(layout.footer.is_some());
    let status = chrome::status(app, area.width, rows);
    let status_area = Rect {
        height: rows,
        ..layout.status
    };
    panel::draw_lines(&status, status_area.intersection(area), buffer);
    if let Some(area) = layout.footer
        && status.len() == 1
    {
        panel::draw_lines(&[chrome::footer(app, area.width)], area, buffer);
    }
    if look.marker == Marker::Ascii {
        to_ascii(buffer);
    }
}

/// Draws the panes or, if a prompt has a list, this list.
fn draw_body(app: &App, layout: &Layout, buffer: &mut Buffer) {
    let look = app.view.appearance;
    if let Some(prompt) = &app.prompt {
        match &prompt.purpose {
            Purpose::Topics { name, topics, .. } => {
                return lists::draw_topics(layout.body(), look, prompt, name, topics, buffer);
            }
            Purpose::Open(entries) => {
                return lists::draw_openables(layout.body(), look, prompt, entries, buffer);
            }
            _ => {}
        }
    }
    for &(pane, area) in &layout.panes {
        let panel = panes::panel(app, pane, inside(area).as_size());
        panel::draw(&panel, area, app.view.pane == pane, look, buffer);
    }
}
