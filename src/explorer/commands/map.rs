//! Commands of the map. A mark on the map shows the position of the present scene.

use super::edit;
use crate::explorer::action::Task;
use crate::explorer::app::App;
use crate::explorer::keys::key::direction;
use crate::explorer::map_state::{Live, OpenStudy};
use asperity_scene::{Document, SceneErrors};
use asperity_study::Axis;
use asperity_study::maps::GridPlace;
use crossterm::event::{KeyCode, KeyEvent};
use std::sync::Arc;

const NO_STUDY: &str = "no study is open; o and the path of its folder open one";

/// Returns from chosen axes of the live map to H and κ. If the live map has these axes, switches
/// between it and the map of the opened study.
pub fn toggle_study(app: &mut App) {
    if app.map.chosen.is_some() && app.map.shown_study().is_none() {
        app.map.chosen = None;
        app.map.plan_file = None;
        app.studies.forget::<Live>();
        app.effects.push(Task::Study);
        return;
    }
    if app.map.study.is_none() {
        app.set_error(NO_STUDY);
        return;
    }
    app.map.of_study = !app.map.of_study;
    app.effects.push(Task::Study);
}

/// Shows the next quantity of the map, with the scale of colours that suits it.
pub fn next_quantity(app: &mut App) {
    app.map.quantity = app.next_mapped();
    app.map.scale = None;
}

/// Shows the next or the previous map of the study, depending on the pressed key. If the present
/// scene is a cell of the map that was shown before, the scene becomes the corresponding cell of
/// the new map.
pub fn step_slice(app: &mut App, key: &KeyEvent) {
    let steps = if key.code == KeyCode::PageUp { -1 } else { 1 };
    let Some(study) = app.map.shown_study() else {
        let why = if app.map.study.is_some() {
            "this is the map that is computed here; W shows the study's"
        } else {
            NO_STUDY
        };
        app.set_error(why);
        return;
    };
    if study.study_map.slices() == 1 {
        app.set_done("this study has one map");
        return;
    }
    let next = study.stepped(steps);
    let study_map = Arc::clone(&study.study_map);
    let followed = if study.is_of(app.edit.document.scene()) {
        Some(study_map.follow(next, &app.edit.document))
    } else {
        None
    };
    app.map.study = Some(OpenStudy::new(study_map, next));
    let Some(followed) = followed else {
        return;
    };
    let was_unsaved = app.edit.is_unsaved();
    edit::apply(app, followed);
    // The user has changed only the map and not the scene, so the new scene does not count as
    // unsaved.
    if !was_unsaved && !app.is_refused() {
        app.edit.set_saved();
    }
}

/// Number of columns or rows in a large step. On the live map, κ doubles every four rows.
const LARGE_STEP: i32 = 4;

/// Moves the mark on the map by one or several columns or rows, depending on the pressed key. The
/// mark shows the position of the present scene, which gets the values at the new position.
pub fn step(app: &mut App, key: &KeyEvent) {
    let Some(direction) = direction(key) else {
        return;
    };
    let steps = if direction.is_coarse { LARGE_STEP } else { 1 };
    let columns = direction.columns * steps;
    let rows = direction.rows * steps;
    let Some((place_across, place_up)) = app.place() else {
        return app.set_error(why_no_place(app));
    };
    let Some((across, up)) = app.map_axes() else {
        return;
    };
    if rows != 0 && up.is_none() {
        let axis = across.symbol_or_name();
        return app.set_error(format!("this map has one axis, {axis}"));
    }
    let Some(next_across) = next_on(&across, place_across, columns) else {
        return app.set_done(EDGE);
    };
    let next_up = match (&up, place_up) {
        (Some(axis), Some(place)) => match next_on(axis, place, rows) {
            Some(next) => Some(next),
            None => return app.set_done(EDGE),
        },
        _ => None,
    };
    move_to(app, (next_across, next_up));
}

/// Message if a step would leave the map.
const EDGE: &str = "edge of the map";

/// Returns the reason why the scene has no position on the map.
fn why_no_place(app: &App) -> String {
    if let Err(why) = app.map.plan(app.edit.document.scene()) {
        return why.to_string();
    }
    if app.map.shown_study().is_some() {
        return NO_PLACE.to_owned();
    }
    "the scene is still being computed: a number of the axes follows from its profile".to_owned()
}

/// Returns the value on an axis that lies a number of steps after `value`; `None` if it would lie
/// beyond the end of the axis.
fn next_on(axis: &Axis, value: f64, steps: i32) -> Option<f64> {
    if steps == 0 {
        Some(value)
    } else {
        axis.next_beyond(value, steps)
    }
}

/// Message if the scene lacks the quantity of an axis of the map.
const NO_PLACE: &str = "the scene has no place on this map: it lacks a quantity of the axes";

/// Gives the scene the values at a position on the map. Successive moves are one edit, so that one
/// undo reverts all of them.
pub fn move_to(app: &mut App, place: GridPlace) {
    match moved_to(app, place) {
        Ok(document) if app.map.moving => edit::replace(app, document),
        moved => edit::apply(app, moved),
    }
    app.map.moving = !app.is_refused();
}

/// Returns the scene with the values at a position on the map. If the preload is given in units of
/// E* h L, the preload in N may change with the position.
fn moved_to(app: &App, place: GridPlace) -> Result<Document, SceneErrors> {
    let (value_across, value_up) = place;
    let axes = app.map_axes();
    let mut values: Vec<(&Axis, f64)> = Vec::new();
    if let Some((across, up)) = &axes {
        values.push((across, value_across));
        if let (Some(axis), Some(value)) = (up, value_up) {
            values.push((axis, value));
        }
    }
    let moved = Axis::set_all(&app.edit.document, &values)?;
    let Some(study) = app.map.shown_study() else {
        return Ok(moved);
    };
    let was_of_study = study.is_of(app.edit.document.scene());
    if was_of_study && !study.is_of(moved.scene()) {
        return study.study_map.follow(study.slice, &moved);
    }
    Ok(moved)
}
