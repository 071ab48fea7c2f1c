//! Loops kept beside the present one.

use super::ghosts::name_ghosts;
use super::{Effect, edit, show};
use crate::explorer::model::{Ghost, Model, Pane};
use crate::explorer::snapshot::{Preview, SolvedScene};
use crate::scene::{Document, Roughness};
use std::sync::Arc;

/// Most kept curves; more could not be distinguished.
const MOST_GHOSTS: usize = 8;

/// Removes all ghosts.
pub fn clear(model: &mut Model) -> Vec<Effect> {
    model.hide(Pane::Beside);
    model.ghosts.clear();
    vec![Effect::Ask]
}

/// Shows the newest ghost beside the scene, or hides it.
pub fn toggle_side_by_side(model: &mut Model) -> Vec<Effect> {
    show::change(model, toggle)
}

/// Shows or hides the newest ghost beside the scene; without a ghost the present scene becomes one.
fn toggle(model: &mut Model) {
    if model.is_shown(Pane::Beside) {
        return model.hide(Pane::Beside);
    }
    if model.ghosts.is_empty() {
        pin(model);
    }
    if !model.ghosts.is_empty() {
        model.show(Pane::Beside);
    }
}

/// Keeps the computed scene as a ghost and opens another scene beside it.
pub fn open_beside(model: &mut Model, document: Document) -> Vec<Effect> {
    pin(model);
    model.show(Pane::Beside);
    let effects = edit::open(model, document);
    model.notice = None;
    // There is no edit to undo: both scenes are as opened.
    model.undo.clear();
    effects
}

fn ghost(model: &Model) -> Option<Ghost> {
    let computed = model.current()?;
    Some(Ghost {
        document: model.document.clone(),
        computed: Arc::clone(computed),
        snapshot: model.snapshot.clone(),
        differs: String::new(),
        changes: String::new(),
    })
}

/// Keeps the present loop as a ghost.
pub fn pin(model: &mut Model) -> Vec<Effect> {
    let Some(ghost) = ghost(model) else {
        model.set_error("there is no curve yet to keep");
        return Vec::new();
    };
    if keep(model, ghost) {
        model.set_done("kept; now change something, x exchanges the two");
    }
    vec![Effect::Ask]
}

/// Adds a ghost; returns false if it was kept already.
fn keep(model: &mut Model, ghost: Ghost) -> bool {
    if model.ghosts.iter().any(|kept| kept.document.scene() == ghost.document.scene()) {
        model.set_done("this loop is kept already");
        return false;
    }
    if model.ghosts.len() == MOST_GHOSTS {
        model.ghosts.remove(0);
    }
    model.ghosts.push(ghost);
    name_ghosts(model);
    true
}

/// Requests the other use of a measured profile, which becomes a ghost once computed.
pub fn pin_other_use(model: &mut Model) -> Vec<Effect> {
    let scene = model.document.scene();
    if !matches!(scene.roughness, Some(Roughness::Measured { .. })) {
        model.set_error("the roughness of this scene is not measured");
        return Vec::new();
    }
    let as_line = !scene.measured_as_line();
    match model.document.set("roughness.as_line", &as_line.to_string()) {
        Ok(document) => {
            model.tried = Some(edit::tried_of(&document));
            model.next_ghost = Some(document);
            vec![Effect::Ask]
        }
        Err(errors) => {
            model.set_error(errors.to_string());
            Vec::new()
        }
    }
}

/// Stores a computed preview, or keeps it as the requested ghost.
pub fn previewed(model: &mut Model, preview: Arc<Preview>) -> Vec<Effect> {
    let Some(document) = model.next_ghost.take_if(|document| document.text() == preview.text) else {
        model.preview = Some(preview);
        return Vec::new();
    };
    match &preview.outcome {
        Ok(outcome) => {
            let what = if document.scene().measured_as_line() { "profile itself" } else { "equivalent line" };
            let scene = Arc::new(document.scene().clone());
            let computed = Arc::new(SolvedScene { generation: 0, scene, outcome: outcome.clone() });
            let (differs, changes) = (String::new(), String::new());
            let ghost = Ghost { document, computed, snapshot: None, differs, changes };
            if keep(model, ghost) {
                model.set_done(format!("kept: the {what}; x exchanges the two"));
            }
        }
        Err(why) => model.set_error(why.clone()),
    }
    model.tried = None;
    vec![Effect::Ask]
}

/// Exchanges the scene and the newest ghost.
pub fn swap(model: &mut Model) -> Vec<Effect> {
    let Some(present) = ghost(model) else { return Vec::new() };
    let Some(last) = model.ghosts.pop() else {
        model.set_error("nothing to exchange with: c keeps a loop");
        return Vec::new();
    };
    model.ghosts.push(present);
    edit::adopt(model, last.document)
}
