//! The mouse: it selects panes and rows, moves the body and scrolls. Everything can be done with
//! keys too.

use super::action::{Gesture, Mouse};
use super::app::App;
use super::commands::{crosshair, dialogue, edit, manual, map, timeline, view};
use super::pane::Pane;
use super::panel::Under;
use super::panes::force::indentation_at;
use super::panes::under;
use ratatui::layout::Position;

pub fn act(app: &mut App, mouse: Mouse) {
    if app.prompt.is_some() {
        if let Gesture::Wheel(turns) = mouse.gesture {
            dialogue::select(app, -turns);
        }
        return;
    }
    let here = Position::new(mouse.column, mouse.row);
    let Some((pane, under)) = under(app, here) else {
        return;
    };
    match mouse.gesture {
        Gesture::Wheel(turns) => wheel(app, pane, under, turns),
        // If a drag leaves the pane in which it began, it has no effect there.
        Gesture::Drag if pane != app.view.pane => {}
        gesture => {
            app.view.pane = pane;
            point(app, under, gesture == Gesture::Press)
        }
    }
}

fn wheel(app: &mut App, pane: Pane, under: Under, turns: i32) {
    match pane {
        Pane::Parameters => {
            app.begin();
            edit::move_selection(app, -turns)
        }
        Pane::Profile | Pane::CloseUp => {
            app.view.pane = pane;
            let position = match under {
                Under::Data(x, _) => Some(x),
                Under::Row(_) | Under::Column(..) | Under::Frame => None,
            };
            view::zoom_at(app, turns, position);
        }
        Pane::Timeline | Pane::Events => timeline::go_to_event(app, turns < 0),
        _ => {}
    }
}

/// Acts on what is under the mouse in the selected pane. `is_press` is true if the user has pressed
/// the button, and false if the mouse moves with the button pressed.
fn point(app: &mut App, under: Under, is_press: bool) {
    match (app.view.pane, under) {
        (Pane::Map, Under::Data(across, up)) if is_press || app.map.moving => {
            app.map.moving &= !is_press;
            map::move_to(app, (across, Some(up)))
        }
        (Pane::Parameters, Under::Row(row)) if is_press => {
            app.begin();
            app.edit.select(row);
        }
        (Pane::Timeline, Under::Column(column, columns)) => {
            timeline::go_to_column(app, column, columns)
        }
        (Pane::Events, Under::Row(row)) if is_press => timeline::select_row(app, row),
        (_, Under::Data(x, _)) if app.view.crosshair.is_some() => crosshair::point_at(app, x),
        // A click only selects the pane. A drag begins manual loading.
        (Pane::Force, Under::Data(x, _)) if !is_press || app.edit.path.is_some() => drag(app, x),
        _ => {}
    }
}

/// Moves the body to the indentation under the mouse. `x` is the number on the horizontal axis
/// under the mouse.
fn drag(app: &mut App, x: f64) {
    if let Some(indentation) = indentation_at(app, x) {
        manual::move_to_indentation(app, indentation);
    }
}
