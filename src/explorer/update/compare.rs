//! Loops kept beside the present one.

use super::ghosts::name_ghosts;
use super::{Effect, edit, show};
use crate::explorer::action::Command;
use crate::explorer::model::{Ghost, Model, Notice, Pane};
use crate::scene::Document;
use std::sync::Arc;

/// Most kept curves; more could not be distinguished.
const MOST_GHOSTS: usize = 8;

/// Obeys a command on ghosts.
pub fn obey(model: &mut Model, command: Command) -> Vec<Effect> {
    let mut effects = Vec::new();
    let was_beside = model.beside().is_some();
    match command {
        Command::Pin => pin(model),
        Command::Swap => effects = swap(model),
        Command::ToggleSideBySide => return show::change(model, toggle),
        _ => {
            model.hide(Pane::Beside);
            model.ghosts.clear();
        }
    }
    // Another ghost may be the newest, or none.
    if was_beside {
        effects.insert(0, Effect::Beside);
    }
    effects.push(Effect::Show);
    effects
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

/// Keeps the scene that has been computed as a ghost and opens another one beside it.
pub fn open_beside(model: &mut Model, document: Document) -> Vec<Effect> {
    pin(model);
    model.show(Pane::Beside);
    let effects = edit::open(model, document);
    model.notice = None;
    // There is no edit to undo: both scenes are as they were opened.
    model.undo.clear();
    [vec![Effect::Beside], effects].concat()
}

fn ghost(model: &Model) -> Option<Ghost> {
    let computed = model.current()?;
    Some(Ghost {
        document: model.document.clone(),
        computed: Arc::clone(computed),
        differs: String::new(),
        changes: String::new(),
    })
}

fn pin(model: &mut Model) {
    let Some(ghost) = ghost(model) else {
        model.notice = Some(Notice::Error("there is no curve yet to keep".to_owned()));
        return;
    };
    if model.ghosts.iter().any(|kept| kept.document.scene() == ghost.document.scene()) {
        model.notice = Some(Notice::Done("this loop is kept already".to_owned()));
        return;
    }
    if model.ghosts.len() == MOST_GHOSTS {
        model.ghosts.remove(0);
    }
    model.ghosts.push(ghost);
    name_ghosts(model);
    model.notice = Some(Notice::Done("kept; now change something, x exchanges the two".to_owned()));
}

/// The scene and the newest ghost change places.
fn swap(model: &mut Model) -> Vec<Effect> {
    let Some(present) = ghost(model) else { return Vec::new() };
    let Some(last) = model.ghosts.pop() else {
        model.notice = Some(Notice::Error("nothing to exchange with: c keeps a loop".to_owned()));
        return Vec::new();
    };
    model.ghosts.push(present);
    edit::adopt(model, last.document)
}
