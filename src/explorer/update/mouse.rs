//! The mouse: it chooses panes and rows, drags the load and scrolls. Everything it does a key does too.

use super::{Effect, chart, crosshair, edit, explore, look, movement};
use crate::explorer::action::{Command, Gesture, Mouse};
use crate::explorer::layout::{Layout, inside};
use crate::explorer::mode::Mode;
use crate::explorer::model::{Model, Pane};
use crate::explorer::panes::{indentation_at, parameter_at, place_at, share_at};
use crate::explorer::request::ManualMove;
use ratatui::layout::Position;

/// Does what the mouse asks for.
pub fn act(model: &mut Model, mouse: Mouse) -> Vec<Effect> {
    match (&model.mode, mouse.gesture) {
        (Mode::Explore, _) => {}
        (Mode::Help { .. } | Mode::Library(_) | Mode::Find(_) | Mode::Palette(_), Gesture::Wheel(turns)) => {
            return super::obey(model, Command::Select(-turns));
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
    match (mouse.gesture, pane) {
        (Gesture::Press, _) => {
            model.pane = pane;
            match pane {
                Pane::Parameters => {
                    if let Some(row) = parameter_at(model, inside(area), mouse.row) {
                        // A second press on the first row of a group folds the group.
                        let again = row == model.selected && model.parameters[row].is_head();
                        edit::select(model, row);
                        if again {
                            return edit::obey(model, Command::ToggleFold);
                        }
                    }
                    vec![Effect::Show]
                }
                Pane::Force => drag(model, inside(area), mouse.column),
                Pane::Chart => {
                    model.chart.moving = false;
                    put(model, inside(area), here)
                }
                Pane::Profile | Pane::CloseUp | Pane::Accuracy | Pane::Spectrum | Pane::Preloads => {
                    vec![Effect::Show]
                }
            }
        }
        (Gesture::Drag, Pane::Chart) if model.chart.moving => put(model, inside(area), here),
        (Gesture::Drag, Pane::Force) => drag(model, inside(area), mouse.column),
        (Gesture::Wheel(turns), Pane::Parameters) => explore(model, Command::Select(-turns)),
        (Gesture::Wheel(turns), Pane::Profile | Pane::CloseUp) => {
            model.pane = pane;
            match share_at(model, pane, inside(area), mouse.column) {
                Some(pointer) => look::zoom_at(model, turns, pointer),
                None => look::zoom(model, turns),
            }
            vec![Effect::Show]
        }
        (Gesture::Drag | Gesture::Wheel(_), _) => Vec::new(),
    }
}

/// Puts the mark of the map under the mouse.
fn put(model: &mut Model, area: ratatui::layout::Rect, here: Position) -> Vec<Effect> {
    match place_at(model, area, here) {
        Some(place) => chart::move_to(model, place),
        None => vec![Effect::Show],
    }
}

/// Drags the body to the indentation under the mouse.
fn drag(model: &mut Model, area: ratatui::layout::Rect, column: u16) -> Vec<Effect> {
    if indentation_at(model, area, column).is_none() {
        return vec![Effect::Show];
    }
    // Taken first: its axis may reach further than that of the loading, and the body is to come to stand
    // under the mouse.
    let mut effects = if model.hand.is_none() { movement::take(model, None) } else { Vec::new() };
    effects.retain(|effect| *effect != Effect::Show);
    if let Some(indentation) = indentation_at(model, area, column) {
        effects.extend(movement::take(model, Some(ManualMove::To(indentation))));
    }
    effects
}
