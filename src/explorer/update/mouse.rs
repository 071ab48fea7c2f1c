//! The mouse: chooses panes and rows, drags the load and scrolls. Keys can do all this too.

use super::{Effect, crosshair, dialogue};
use crate::explorer::action::{Gesture, Mouse};
use crate::explorer::app::App;
use crate::explorer::layout::{Layout, inside};
use crate::explorer::mode::Mode;
use ratatui::layout::Position;

/// Performs a gesture of the mouse.
pub fn act(app: &mut App, mouse: Mouse) -> Vec<Effect> {
    match (&app.mode, mouse.gesture) {
        (Mode::Explore, _) => {}
        (Mode::Help { .. } | Mode::Prompt(_), Gesture::Wheel(turns)) => {
            dialogue::select(app, -turns);
            return Vec::new();
        }
        _ => return Vec::new(),
    }
    let layout = Layout::of(app);
    let here = Position::new(mouse.column, mouse.row);
    let Some((pane, area)) = layout.panes.iter().copied().find(|(_, area)| area.contains(here)) else {
        return Vec::new();
    };
    // A drag stays in the pane in which it began.
    let points = mouse.gesture == Gesture::Press || (mouse.gesture == Gesture::Drag && pane == app.view.pane);
    if let Some(effects) = points.then(|| crosshair::point_at(app, pane, area, here)).flatten() {
        app.view.pane = pane;
        return effects;
    }
    let (row, inner) = (pane.row(), inside(area));
    match mouse.gesture {
        Gesture::Press => {
            app.view.pane = pane;
            (row.press)(app, inner, here)
        }
        Gesture::Drag => (row.drag)(app, inner, here),
        Gesture::Wheel(turns) => {
            if row.section.is_some() {
                app.view.pane = pane;
            }
            (row.wheel)(app, inner, here, turns)
        }
    }
}
