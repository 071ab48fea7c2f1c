//! Commands of the map, on which the scene is a mark.

use super::edit;
use crate::explorer::action::Task;
use crate::explorer::app::App;
use crate::explorer::keys::key::direction;
use crate::explorer::map::OpenStudy;
use asperity_scene::{Document, SceneErrors};
use asperity_study::maps::GridPlace;
use asperity_study::{Axis, Plan};
use crossterm::event::{KeyCode, KeyEvent};
use std::sync::Arc;

const NO_STUDY: &str = "no study is open; o and the path of its folder open one";

/// Changes between the map of the study and the live map.
pub fn toggle_study(app: &mut App) {
    if app.map.study.is_none() {
        app.set_error(NO_STUDY);
        return;
    }
    app.map.of_study = !app.map.of_study;
    app.effects.push(Task::Study);
}

/// Shows another map of the study. If the scene belongs to the former map, it is moved to the new
/// one.
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
    let goes_with = study
        .study_map
        .is_of(study.slice, app.edit.document.scene());
    let followed = goes_with.then(|| study.study_map.follow(next, &app.edit.document));
    let study_map = Arc::clone(&study.study_map);
    app.map.study = Some(OpenStudy::new(study_map, next));
    if let Some(followed) = followed {
        let was_unsaved = app.edit.is_unsaved();
        edit::apply(app, followed);
        // Browsing is no change that anyone has to save.
        if !was_unsaved && !app.is_refused() {
            app.edit.set_saved();
        }
    }
}

/// Number of columns or rows of a large step: on the live map the double of κ.
const LARGE_STEP: i32 = 4;

/// Moves the mark, and with it the scene, by a column or a row of the map, or by several.
pub fn step(app: &mut App, key: &KeyEvent) {
    let Some(((columns, rows), is_coarse)) = direction(key) else {
        return;
    };
    let [columns, rows] =
        [columns, rows].map(|steps| steps * if is_coarse { LARGE_STEP } else { 1 });
    let Some((at_across, at_up)) = app.place() else {
        let why = match Plan::of_map(app.edit.document.scene()) {
            Err(why) => why.to_string(),
            Ok(_) if app.map.shown_study().is_some() => NO_PLACE.to_owned(),
            Ok(_) => "the scene is still being computed: its κ follows from its profile".to_owned(),
        };
        app.set_error(why);
        return;
    };
    let Some((across, up)) = app.map_axes() else {
        return;
    };
    if rows != 0 && up.is_none() {
        app.set_error(format!(
            "this map has one axis, {}",
            across.symbol_or_name()
        ));
        return;
    }
    let next = |at: f64, steps: i32, axis: &Axis| {
        if steps == 0 {
            Some(at)
        } else {
            axis.next_beyond(at, steps)
        }
    };
    let to_up = match (at_up, &up) {
        (Some(at), Some(axis)) => next(at, rows, axis).map(Some),
        _ => Some(None),
    };
    match (next(at_across, columns, &across), to_up) {
        (Some(across), Some(up)) => move_to(app, (across, up)),
        _ => app.set_done("edge of the map"),
    }
}

/// Message for a scene that lacks a quantity of the map's axes.
const NO_PLACE: &str = "the scene has no place on this map: it lacks a quantity of the axes";

/// Sets the scene to the values at a place on the map. Successive moves count as one edit.
pub fn move_to(app: &mut App, place: GridPlace) {
    let goes_on = app.map.moving;
    match moved_to(app, place) {
        Ok(document) if goes_on => edit::replace(app, document),
        moved => edit::apply(app, moved),
    }
    app.map.moving = !app.is_refused();
}

/// The scene moved to a place on the map. A preload in units of E* h L may change with the place.
fn moved_to(app: &App, (to_across, to_up): GridPlace) -> Result<Document, SceneErrors> {
    let axes = app.map_axes();
    let (across, up) = axes
        .as_ref()
        .map_or((None, None), |(across, up)| (Some(across), up.as_ref()));
    let values: Vec<(&Axis, f64)> = across
        .zip(Some(to_across))
        .into_iter()
        .chain(up.zip(to_up))
        .collect();
    let moved = Axis::set_all(&app.edit.document, &values)?;
    match app.map.shown_study() {
        Some(study)
            if study
                .study_map
                .is_of(study.slice, app.edit.document.scene())
                && !study.study_map.is_of(study.slice, moved.scene()) =>
        {
            study.study_map.follow(study.slice, &moved)
        }
        _ => Ok(moved),
    }
}
