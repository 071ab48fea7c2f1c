//! Loops kept for comparison.

use super::edit;
use crate::explorer::app::{App, Ghost, Pane};
use crate::scene::Document;
use std::sync::Arc;

/// Most kept curves: each has a colour of its own.
const MOST_GHOSTS: usize = 4;

pub fn clear(app: &mut App) {
    app.hide(Pane::Beside);
    app.ghosts.clear();
}

/// Shows the newest ghost beside the scene, or hides it; without a ghost the present scene becomes one.
pub fn toggle_side_by_side(app: &mut App) {
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
pub fn open_beside(app: &mut App, document: Document) {
    pin(app);
    app.show(Pane::Beside);
    edit::open(app, document);
    app.message = None;
    // There is no edit to undo: both scenes are as opened.
    app.edit.past.clear();
}

fn ghost(app: &App) -> Option<Ghost> {
    Some(Ghost {
        document: app.edit.document.clone(),
        computed: Arc::clone(app.current()?),
        snapshot: app.snapshot.clone(),
    })
}

pub fn pin(app: &mut App) {
    let Some(ghost) = ghost(app) else { return app.set_error("there is no curve yet to keep") };
    if app.ghosts.iter().any(|kept| kept.document.scene() == ghost.document.scene()) {
        return app.set_done("this loop is kept already");
    }
    let is_full = app.ghosts.len() == MOST_GHOSTS;
    if is_full {
        app.ghosts.remove(0);
    }
    app.ghosts.push(ghost);
    let name = app.newest_letter();
    let rest = if is_full { "the oldest ghost has been removed" } else { "x swaps it with the scene" };
    app.set_done(format!("kept as ghost {name}; {rest}"));
}

pub fn swap(app: &mut App) {
    let Some(present) = ghost(app) else { return };
    let Some(last) = app.ghosts.pop() else {
        return app.set_error("there is no ghost to swap with; c keeps the present loop as one");
    };
    app.ghosts.push(present);
    edit::adopt(app, last.document);
}
