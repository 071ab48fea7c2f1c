//! Commands for ghosts, which are scenes that the user keeps to compare with the present scene.

use super::edit;
use crate::explorer::action::Task;
use crate::explorer::app::App;
use crate::explorer::ghost::Ghost;
use asperity_report::letter;
use asperity_study::half_space::SquareLoops;
use std::sync::Arc;

/// Largest number of ghosts. It is small, because each ghost has a colour of its own.
const MOST_GHOSTS: usize = 4;

pub fn clear(app: &mut App) {
    app.ghosts.clear();
}

/// Shows or hides the force curves of random square surfaces in three dimensions. They are computed
/// on an elastic half-space, for comparison with the profile.
pub fn toggle_squares(app: &mut App) {
    app.view.squares ^= true;
    app.studies.forget::<SquareLoops>();
    app.effects.push(Task::Study);
}

/// Returns the present scene with its outcome as a ghost; `None` before the scene is computed.
fn ghost(app: &App) -> Option<Ghost> {
    let computed = app.current()?;
    Some(Ghost {
        document: app.edit.document.clone(),
        outcome: Arc::new(computed.outcome.clone()),
    })
}

pub fn pin(app: &mut App) {
    let Some(present) = ghost(app) else {
        return app.set_error("there is no curve yet to keep");
    };
    let scene = present.document.scene();
    let mut kept = app.ghosts.iter();
    if kept.any(|kept| kept.document.scene() == scene) {
        return app.set_done("this loop is kept already");
    }
    let is_full = app.ghosts.len() == MOST_GHOSTS;
    if is_full {
        app.ghosts.remove(0);
    }
    app.ghosts.push(present);
    let name = letter(app.ghosts.len() - 1);
    let rest = if is_full {
        "the oldest ghost has been removed"
    } else {
        "x swaps it with the scene"
    };
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
