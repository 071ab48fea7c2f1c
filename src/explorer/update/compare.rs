//! Loops kept beside the present one.

use super::ghosts::name_ghosts;
use super::{Effect, edit, show};
use crate::explorer::app::{App, Ghost, Pane};
use crate::explorer::panes::newest_letter;
use crate::explorer::snapshot::{Preview, SolvedScene};
use crate::scene::{Document, Roughness};
use std::sync::Arc;

/// Most kept curves; more could not be distinguished.
const MOST_GHOSTS: usize = 8;

/// Removes all ghosts.
pub fn clear(app: &mut App) -> Vec<Effect> {
    app.hide(Pane::Beside);
    app.ghosts.clear();
    vec![Effect::Ask]
}

/// Shows the newest ghost beside the scene, or hides it.
pub fn toggle_side_by_side(app: &mut App) -> Vec<Effect> {
    show::change(app, toggle)
}

/// Shows or hides the newest ghost beside the scene; without a ghost the present scene becomes one.
fn toggle(app: &mut App) {
    if app.is_shown(Pane::Beside) {
        return app.hide(Pane::Beside);
    }
    if app.ghosts.is_empty() {
        pin(app);
    }
    if !app.ghosts.is_empty() {
        app.show(Pane::Beside);
    }
}

/// Keeps the computed scene as a ghost and opens another scene beside it.
pub fn open_beside(app: &mut App, document: Document) -> Vec<Effect> {
    pin(app);
    app.show(Pane::Beside);
    let effects = edit::open(app, document);
    app.message = None;
    // There is no edit to undo: both scenes are as opened.
    app.edit.past.clear();
    effects
}

fn ghost(app: &App) -> Option<Ghost> {
    let computed = app.current()?;
    Some(Ghost {
        document: app.edit.document.clone(),
        computed: Arc::clone(computed),
        snapshot: app.snapshot.clone(),
        differs: String::new(),
        changes: String::new(),
    })
}

/// Keeps the present loop as a ghost.
pub fn pin(app: &mut App) -> Vec<Effect> {
    let Some(ghost) = ghost(app) else {
        app.set_error("there is no curve yet to keep");
        return Vec::new();
    };
    if keep(app, ghost) {
        let name = newest_letter(app);
        app.set_done(format!("kept as ghost {name}; x swaps it with the scene"));
    }
    vec![Effect::Ask]
}

/// Adds a ghost; returns false if it was kept already.
fn keep(app: &mut App, ghost: Ghost) -> bool {
    if app.ghosts.iter().any(|kept| kept.document.scene() == ghost.document.scene()) {
        app.set_done("this loop is kept already");
        return false;
    }
    if app.ghosts.len() == MOST_GHOSTS {
        app.ghosts.remove(0);
    }
    app.ghosts.push(ghost);
    name_ghosts(app);
    true
}

/// Requests the other use of a measured profile, which becomes a ghost once computed.
pub fn pin_other_use(app: &mut App) -> Vec<Effect> {
    let scene = app.edit.document.scene();
    if !matches!(scene.roughness, Some(Roughness::Measured { .. })) {
        app.set_error("the roughness of this scene is not measured");
        return Vec::new();
    }
    let as_line = !scene.measured_as_line();
    match app.edit.document.set("roughness.as_line", &as_line.to_string()) {
        Ok(document) => {
            app.tried = Some(document.clone());
            app.next_ghost = Some(document);
            vec![Effect::Study]
        }
        Err(errors) => {
            app.set_error(errors.to_string());
            Vec::new()
        }
    }
}

/// Keeps the requested ghost once it is computed.
pub fn pin_requested(app: &mut App) -> Vec<Effect> {
    let why = app.studies.failure::<Preview>().map(str::to_owned);
    let preview = app.studies.value::<Preview>();
    let is_ready = |ghost: &mut Document| preview.is_some_and(|known| known.text == ghost.text());
    let Some(document) = app.next_ghost.take_if(|ghost| why.is_some() || is_ready(ghost)) else {
        return Vec::new();
    };
    match (why, preview) {
        (Some(why), _) => app.set_error(why),
        (None, Some(preview)) => {
            let what = if document.scene().measured_as_line() { "profile itself" } else { "equivalent line" };
            let (scene, outcome) = (Arc::new(document.scene().clone()), preview.outcome.clone());
            let computed = Arc::new(SolvedScene { generation: 0, scene, outcome });
            let (differs, changes) = (String::new(), String::new());
            let ghost = Ghost { document, computed, snapshot: None, differs, changes };
            if keep(app, ghost) {
                app.set_done(format!("kept: the {what}; x exchanges the two"));
            }
        }
        (None, None) => {}
    }
    app.tried = None;
    vec![Effect::Ask]
}

/// Exchanges the scene and the newest ghost.
pub fn swap(app: &mut App) -> Vec<Effect> {
    let Some(present) = ghost(app) else { return Vec::new() };
    let Some(last) = app.ghosts.pop() else {
        app.set_error("nothing to exchange with: c keeps a loop");
        return Vec::new();
    };
    app.ghosts.push(present);
    edit::adopt(app, last.document)
}
