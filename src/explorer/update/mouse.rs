//! The mouse: chooses panes and rows, drags the load and scrolls. Keys can do all this too.

use super::{Effect, crosshair, dialogue};
use crate::explorer::action::{Gesture, Mouse};
use crate::explorer::layout::{Layout, inside};
use crate::explorer::mode::Mode;
use crate::explorer::model::Model;
use ratatui::layout::Position;

/// Performs a gesture of the mouse.
pub fn act(model: &mut Model, mouse: Mouse) -> Vec<Effect> {
    match (&model.mode, mouse.gesture) {
        (Mode::Explore, _) => {}
        (Mode::Help { .. } | Mode::Prompt(_), Gesture::Wheel(turns)) => {
            dialogue::select(model, -turns);
            return Vec::new();
        }
        _ => return Vec::new(),
    }
    let layout = Layout::of(model);
    let here = Position::new(mouse.column, mouse.row);
    let Some((pane, area)) = layout.panes.iter().copied().find(|(_, area)| area.contains(here)) else {
        return Vec::new();
    };
    // A drag stays in the pane in which it began.
    let points = mouse.gesture == Gesture::Press || (mouse.gesture == Gesture::Drag && pane == model.pane);
    if let Some(effects) = points.then(|| crosshair::point_at(model, pane, area, here)).flatten() {
        model.pane = pane;
        return effects;
    }
    let (row, inner) = (pane.row(), inside(area));
    match mouse.gesture {
        Gesture::Press => {
            model.pane = pane;
            (row.press)(model, inner, here)
        }
        Gesture::Drag => (row.drag)(model, inner, here),
        Gesture::Wheel(turns) => {
            if row.section.is_some() {
                model.pane = pane;
            }
            (row.wheel)(model, inner, here, turns)
        }
    }
}
