//! Commands of manual loading, under which the user moves the body. The moves form a path, which is
//! part of the undo history.

use super::{edit, stages};
use crate::explorer::app::App;
use crate::explorer::editor::Edited;
use crate::explorer::keys::key::direction;
use crate::explorer::manual_body::NEEDS_TIMES;
use crate::explorer::manual_path::{MOST_MOVES, ManualPath};
use crate::explorer::pane::Pane;
use crate::explorer::player::{At, Player};
use crate::explorer::prompt::Purpose;
use crate::explorer::snapshot::ContactSnapshot;
use crate::explorer::text_line::TextLine;
use crate::explorer::typed;
use asperity_contact::{Direction, Move};
use asperity_data::round_to;
use asperity_scene::{Document, SceneErrors};
use crossterm::event::{KeyCode, KeyEvent};
use std::sync::Arc;

/// Number of small steps from the lowest to the highest indentation.
const SMALL_STEPS: f64 = 400.0;
/// Number of large steps from the lowest to the highest indentation.
const LARGE_STEPS: f64 = 40.0;
/// Number of digits of an indentation to which keys or the mouse move the body. It is small,
/// because the path may become the loading of the scene.
const DIGITS: usize = 10;

/// Begins manual loading or, if the body has been moved, makes the path the loading of the scene.
pub fn toggle(app: &mut App) {
    let Some(path) = &app.edit.path else {
        match new_path(app) {
            Some(path) => {
                adopt(app, path);
                select_force_curve(app);
            }
            None => state_why_not(app),
        }
        return;
    };
    if path.moves.is_empty() {
        end(app, "the body is back on the loading of the scene");
    } else {
        become_loading(app);
    }
}

/// Ends manual loading and drops the path.
pub fn drop_path(app: &mut App) {
    end(app, "the path by hand is dropped; u brings it back");
}

fn end(app: &mut App, message: &str) {
    if app.edit.path.is_some() {
        app.edit.adopt_path(None);
        app.play_of_path = None;
        app.set_done(message);
    }
}

/// Returns a path that starts at the state that the animation shows; `None` while the scene is not
/// computed.
fn new_path(app: &App) -> Option<ManualPath> {
    if !app.is_current() || app.stages().is_empty() || relaxes(app) {
        return None;
    }
    Some(ManualPath::starting_at(app.play))
}

fn relaxes(app: &App) -> bool {
    app.edit.scene.material.relaxation.is_some()
}

/// States that the scene is still being computed, or that its body relaxes. If its computation has
/// failed, the message with the reason stays.
fn state_why_not(app: &mut App) {
    if relaxes(app) {
        app.set_error(NEEDS_TIMES);
    } else if app.is_computing() {
        app.set_error(edit::STILL_COMPUTED);
    }
}

/// Returns the path that ends at the shown state, from which the next move continues: the present
/// path, its part before the position of the animation, or without manual loading a path that
/// starts at the present state. `None` while this state is being computed.
fn present_path(app: &App) -> Option<ManualPath> {
    let Some(path) = &app.edit.path else {
        return new_path(app);
    };
    match app.play_of_path {
        Some(player) => {
            let followed = app.followed()?;
            Some(path.until(player, &followed.stages, followed.before))
        }
        None => Some(ManualPath::clone(path)),
    }
}

fn adopt(app: &mut App, path: ManualPath) {
    app.play.playing = false;
    app.play_of_path = None;
    app.edit.adopt_path(Some(path));
}

/// Selects the force curve, because the arrow keys move the body while it is selected.
fn select_force_curve(app: &mut App) {
    if app.is_shown(Pane::Force) {
        app.view.pane = Pane::Force;
    } else {
        app.show_force_curve();
    }
}

/// Returns the indentation in m of the body at the end of a path. `None` if the solver has not
/// answered yet and the indentation does not follow from the last move.
fn end_of(app: &App, path: &ManualPath) -> Option<f64> {
    if let Some(player) = app.play_of_path {
        return Some(player.indentation(app.played_stages()));
    }
    if app.edit.path.is_some()
        && let Some(followed) = app.followed()
        && let Some(last) = followed.stages.last()
    {
        return Some(last.end());
    }
    match path.moves.last() {
        Some(Move::ToIndentation(indentation)) => Some(*indentation),
        Some(_) => None,
        None => Some(path.start.indentation(app.stages())),
    }
}

/// Presses or pulls the body by a small or a large step, depending on the pressed key.
pub fn push(app: &mut App, key: &KeyEvent) {
    let Some(direction) = direction(key) else {
        return;
    };
    let (low, high) = app.indentations().unwrap_or_default();
    let steps = if direction.is_coarse {
        LARGE_STEPS
    } else {
        SMALL_STEPS
    };
    let step = f64::from(direction.columns) * (high - low) / steps;
    let Some(path) = present_path(app) else {
        return state_why_not(app);
    };
    match end_of(app, &path) {
        Some(end) => step_to(app, &path, end, end + step),
        None => app.set_error("the end of the last move is still being computed"),
    }
}

/// Moves the body to an indentation in m.
pub fn move_to_indentation(app: &mut App, indentation: f64) {
    let Some(path) = present_path(app) else {
        return;
    };
    if let Some(end) = end_of(app, &path) {
        step_to(app, &path, end, indentation);
    }
}

/// Adds a move from the indentation `from` to the indentation `to` in m to a path.
fn step_to(app: &mut App, path: &ManualPath, from: f64, to: f64) {
    let to = round_to(to, DIGITS);
    if to == from || !to.is_finite() {
        return;
    }
    let target = Move::ToIndentation(to);
    if let Some(why) = refusal(app, target) {
        return app.set_error(why);
    }
    let direction = if to > from {
        Direction::Loading
    } else {
        Direction::Unloading
    };
    let Some(next) = with_move(app, path, target) else {
        return;
    };
    app.play.playing = false;
    if app.play_of_path.take().is_some() {
        // The rest of the path is dropped, which is an edit of its own.
        app.edit.end_series();
    }
    app.edit.adopt_step(next, direction);
}

/// Returns a path with one more move. If the contact cannot follow some moves of the path, the new
/// move takes their place.
fn with_move(app: &mut App, path: &ManualPath, target: Move) -> Option<ManualPath> {
    let present = app.edit.path.as_ref();
    let count = present.map_or(0, |present| present.moves.len());
    let mut followed = path.moves.len();
    if present.is_some()
        && let Some(path) = app.followed()
    {
        followed = followed.min(path.count());
    }
    if followed >= MOST_MOVES {
        app.set_error(format!(
            "the path has {MOST_MOVES} moves, the most; d makes it the loading of the scene"
        ));
        return None;
    }
    if followed < count {
        let moves = counted(count - followed, "move");
        app.set_done(format!(
            "the path goes on from here, without {moves}; u brings back"
        ));
    }
    Some(path.continued(followed, target))
}

/// Returns the reason if a move ends far beyond full contact.
fn refusal(app: &App, target: Move) -> Option<String> {
    app.current()?.reach.refusal(target)
}

/// Pulls the body to separation.
pub fn separate(app: &mut App) {
    let is_apart = app.present().is_some_and(|shown| shown.point.springs == 0);
    if is_apart && app.play_of_path.is_none() {
        return app.set_done("nothing is in contact");
    }
    let Some(path) = present_path(app) else {
        return state_why_not(app);
    };
    if let Some(next) = with_move(app, &path, Move::ToSeparation) {
        adopt(app, next);
    }
}

/// Opens a prompt for the target of the next move. If the user has begun to type it, the prompt
/// contains the first character.
pub fn type_target(app: &mut App, key: &KeyEvent) {
    app.ask(Purpose::Move, "");
    if let (KeyCode::Char(first), Some(prompt)) = (key.code, &mut app.prompt) {
        prompt.line = TextLine::new(&first.to_string());
    }
}

/// Moves the body to the typed target: a force, an indentation or another kind of loading stage.
pub fn accept_target(app: &mut App, text: &str) -> Result<(), String> {
    let Some(target) = typed::target(app, text) else {
        let examples = "for example 10 µN, 430 nm, separation, or -2 µN to pull";
        return Err(if text.trim().is_empty() {
            format!("type a target, {examples}")
        } else {
            format!("{text:?} is no target; {examples}")
        });
    };
    if let Some(why) = refusal(app, target) {
        return Err(why);
    }
    let path = present_path(app).ok_or(edit::STILL_COMPUTED)?;
    if let Some(next) = with_move(app, &path, target) {
        app.play.playing = false;
        app.play_of_path = None;
        app.edit.try_move(next, text);
    }
    Ok(())
}

/// Takes note of a new snapshot, which may be the answer of the solver to the present path.
/// `before` is the snapshot before.
pub fn take_note(app: &mut App, before: Option<&ContactSnapshot>) {
    let Some(followed) = app.followed() else {
        return;
    };
    let is_known = before.is_some_and(|before| {
        let mut known = before.followed.iter();
        known.any(|known| Arc::ptr_eq(known, followed))
    });
    if is_known {
        return;
    }
    let moves = followed.path.moves.len();
    let reached = followed.count();
    let leads_to_start = followed.stages.len() >= followed.before;
    let stopped = followed.stopped.clone();
    let player = app
        .play_of_path
        .map(|player| player.within(&followed.stages));
    app.play_of_path = player;
    let Some(why) = stopped else {
        app.edit.accept_move();
        return;
    };
    if reached + 1 == moves
        && let Some(typed) = app.edit.take_back_move()
    {
        if app.prompt.is_some() {
            app.set_error(why);
        } else {
            app.ask_again(Purpose::Move, &typed, &why);
        }
    } else if leads_to_start {
        let number = reached + 1;
        app.set_error(format!("move {number} of {moves}: {why}; the moves stay"));
    } else {
        app.set_error(format!("start of the path: {why}; the moves stay"));
    }
}

/// Returns the scene with the path of manual loading as its loading. `None` without manual loading,
/// or if the path is not computed.
pub fn with_path(app: &App) -> Option<Result<Document, SceneErrors>> {
    let followed = app.followed()?;
    Some(stages::with_loading(
        &app.edit.document,
        &followed.loading(),
    ))
}

/// Makes the path the loading of the scene, in one edit. The body stays where it is.
fn become_loading(app: &mut App) {
    let Some(followed) = app.followed() else {
        return state_why_not(app);
    };
    let left_out = followed.path.moves.len() - followed.count();
    if followed.moves().is_empty() {
        return app.set_error("the contact follows no move of the path; Esc drops it");
    }
    let loading = followed.loading();
    let document = match stages::with_loading(&app.edit.document, &loading) {
        Ok(document) => document,
        Err(errors) => return app.set_error(edit::reasons(&errors)),
    };
    edit::adopt_all(
        app,
        Edited {
            document,
            path: None,
            ..app.edit.edited()
        },
    );
    app.play_of_path = None;
    app.play = Player {
        stage: loading.len() - 1,
        at: At::End,
        playing: false,
    };
    let stages = counted(loading.len(), "stage");
    let rest = match left_out {
        0 => String::new(),
        count => format!(", without {}", counted(count, "move")),
    };
    app.set_done(format!("the path is the loading, {stages}{rest}; u undoes"));
}

/// Returns a number of things in words, such as `1 stage` or `2 stages`.
fn counted(count: usize, name: &str) -> String {
    asperity_data::counted(count as u64, name)
}
