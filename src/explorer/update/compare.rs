//! Loops kept beside the present one.

use super::ghosts::name_ghosts;
use super::{Effect, edit};
use crate::explorer::action::Command;
use crate::explorer::model::{Ghost, Model, Notice};
use std::sync::Arc;

/// Ghosts that are kept; more could not be told apart.
const MOST_GHOSTS: usize = 8;

/// Obeys a command on ghosts.
pub fn obey(model: &mut Model, command: Command) -> Vec<Effect> {
    match command {
        Command::Pin => pin(model),
        Command::Swap => return swap(model),
        _ => model.ghosts.clear(),
    }
    Vec::new()
}

fn ghost(model: &Model) -> Option<Ghost> {
    let computed = model.computed.as_ref().filter(|_| model.is_current())?;
    Some(Ghost { document: model.document.clone(), computed: Arc::clone(computed), differs: String::new() })
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
