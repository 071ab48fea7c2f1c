//! Draws the state of the explorer. Nothing here changes the state.

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
use ratatui::layout::Rect;

pub fn draw(frame: &mut Frame<'_>, app: &App) {
    // The window may have another size than the state by now.
    let area = frame.area();
    let layout = Layout::within(app, (area.width, area.height));
    let (panes, look, buffer) = (layout.body(), app.view.appearance, frame.buffer_mut());
    if let Some(area) = layout.title {
        panel::draw_lines(&chrome::title(app, area.width, area.height), area, buffer);
    }
    let list = app.prompt.as_ref().map(|prompt| (prompt, &prompt.purpose));
    match list {
        Some((prompt, Purpose::Topics { name, topics, .. })) => {
            lists::draw_topics(panes, look, prompt, name, topics, buffer);
        }
        Some((prompt, Purpose::Scene(entries))) => {
            lists::draw_scenes(panes, look, prompt, entries, buffer)
        }
        _ => {
            for &(pane, area) in &layout.panes {
                let panel = panes::panel(app, pane, inside(area).as_size());
                panel::draw(&panel, area, app.view.pane == pane, look, buffer);
            }
        }
    }
    // A long text also takes the place of the keys.
    let rows = 1 + u16::from(layout.footer.is_some());
    let status = chrome::status(app, area.width, rows);
    panel::draw_lines(
        &status,
        Rect {
            height: rows,
            ..layout.status
        }
        .intersection(area),
        buffer,
    );
    if let Some(area) = layout.footer.filter(|_| status.len() == 1) {
        panel::draw_lines(&[chrome::footer(app, area.width)], area, buffer);
    }
    if look.marker == Marker::Ascii {
        to_ascii(buffer);
    }
}
