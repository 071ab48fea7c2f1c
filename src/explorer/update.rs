//! Effect of each action on the state of the explorer. This file does not use the terminal, files
//! or the solver. Work that needs one of these is returned as a task.

use super::action::Action;
use super::action::Task;
use super::app::{App, Awaited};
use super::commands::{accuracy, dialogue, edit, files, measured, movement, opening, table};
use super::keys::bindings::KeyCommand;
use super::layout::Layout;
use super::mouse;
use super::prompt::Purpose;
use super::request::{Request, SnapshotRequest};
use super::snapshot::Reply;
use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};
use std::sync::Arc;

/// Applies an action and returns the tasks that follow from it. If the screen now waits for another
/// state of the contact, a request to the solver is one of these tasks.
pub fn update(app: &mut App, action: Action) -> Vec<Task> {
    apply(app, action);
    if app.asked.is_some() && app.asked != Some(awaited(app)) {
        app.effects.push(Task::Ask);
    }
    std::mem::take(&mut app.effects)
}

fn apply(app: &mut App, action: Action) {
    let rows = app.edit.parameters.len();
    match action {
        Action::Command(command) => run(app, command),
        Action::Key(key) => pressed(app, &key),
        Action::Paste(text) => edit::edit_line(app, |line| line.insert(&text)),
        Action::Resize(columns, rows) => app.view.size = (columns, rows),
        Action::Elapse(time) => movement::elapse(app, time),
        Action::Reply(reply) => replied(app, reply),
        Action::Found(found) => {
            app.studies.take_in(found);
            accuracy::found(app);
            measured::found(app);
        }
        Action::Written(file, result) => files::written(app, file, result),
        Action::Listed(entries) => dialogue::listed(app, entries),
        Action::Completed(paths) => dialogue::completed(app, paths),
        Action::Opened(_, Ok(opened)) => opening::open(app, opened),
        Action::Opened(path, Err(why)) => {
            app.ask_again(Purpose::Open(Vec::new()), &path, &why);
            app.effects.push(Task::List);
        }
        Action::CurveRead(wanted, read) => measured::show_read(app, &wanted, read),
        Action::Mouse(mouse) => mouse::act(app, mouse),
    }
    // The list of parameters has changed while the user searches in it. Therefore the search is
    // repeated in the new list.
    let has_other_rows = app.edit.parameters.len() != rows;
    if has_other_rows && let Some(prompt) = &mut app.prompt {
        prompt.search(&app.edit);
    }
}

/// Runs the command for a key. If there is no such command, types the character of the key.
fn pressed(app: &mut App, key: &KeyEvent) {
    if let Some(command) = app.config.bindings.command(key, app.keys()) {
        return run(app, command);
    }
    let is_control = key
        .modifiers
        .intersects(KeyModifiers::CONTROL | KeyModifiers::ALT);
    if let KeyCode::Char(typed) = key.code
        && !is_control
    {
        edit::edit_line(app, |line| line.insert(typed.encode_utf8(&mut [0; 4])));
    }
}

fn run(app: &mut App, command: KeyCommand) {
    if app.prompt.is_none() {
        let goes_on = app.map.moving && command.row.merges;
        app.begin();
        app.map.moving = goes_on;
    }
    table::run(command, app);
    if let Some(chosen) = app.chosen.take() {
        run(app, chosen);
    }
}

/// Stores a reply of the solver. The reply is ignored if the scene has changed since the request.
fn replied(app: &mut App, reply: Reply) {
    if reply.generation() != app.edit.generation {
        return;
    }
    match reply {
        Reply::Solved(computed, snapshot) => {
            app.progress = None;
            app.play = app.play.within(&computed.outcome.history.stages);
            app.solved = Some(computed);
            if let Some(snapshot) = snapshot {
                movement::shown(app, snapshot);
            }
            app.effects.push(Task::Study);
        }
        Reply::Shown(snapshot) => movement::shown(app, snapshot),
        Reply::Listed(events) => app.events = Some(events),
        Reply::Progress { stages, .. } => app.progress = app.progress.map(|_| stages),
        Reply::Failed { error, .. } => {
            app.progress = None;
            app.set_error(error);
        }
    }
}

/// Returns the request for the state for which the screen waits.
pub fn request(app: &mut App) -> Request {
    let wanted = awaited(app);
    app.asked = Some(wanted.clone());
    Request {
        generation: wanted.generation,
        scene: Arc::clone(&app.edit.scene),
        path: wanted.path,
        least_share: wanted.least_share,
        snapshot: wanted.snapshot,
    }
}

/// Returns the state for which the screen waits.
fn awaited(app: &App) -> Awaited {
    Awaited {
        generation: app.edit.generation,
        snapshot: snapshot_request(app),
        path: app.edit.path.clone(),
        least_share: app.view.least_share,
    }
}

/// Number of columns of dots in a cell.
const DOTS: usize = 2;

pub fn snapshot_request(app: &App) -> SnapshotRequest {
    let layout = Layout::of(app);
    SnapshotRequest {
        drive: app.drive(),
        at: app.playhead().at,
        profile_columns: DOTS * layout.profile_cells(),
        profile: app.view.profile,
        close_up_columns: DOTS * layout.close_up_cells(),
        focus: app.view.close_up.focus,
        close_up_springs: app.view.close_up.springs,
        crosshair: app.view.crosshair.filter(|_| app.section().is_some()),
    }
}
