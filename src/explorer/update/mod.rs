//! Effect of each action on the state. Nothing here touches terminal, files or worker: work outside
//! the state is returned.

pub(super) mod accuracy;
pub(super) mod chart;
pub(super) mod compare;
pub(super) mod crosshair;
pub(super) mod dialogue;
pub(super) mod edit;
pub(super) mod files;
mod ghosts;
pub(super) mod look;
mod mouse;
pub(super) mod movement;
pub(super) mod show;

pub use super::effect::Effect;
pub use accuracy::study_tasks;

use super::action::Action;
use super::app::{App, Message};
use super::keys::Command;
use super::layout::Layout;
use super::prompt::Purpose;
use super::request::{Place, Request, SnapshotRequest};
use super::snapshot::Report;
use crate::scene::{Document, Scene};
use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};
use std::sync::Arc;

/// Applies an action and returns the effects to perform outside.
pub fn update(app: &mut App, action: Action) -> Vec<Effect> {
    match action {
        Action::Command(command) => return run(app, command),
        Action::Key(key) => return pressed(app, &key),
        Action::Paste(text) => return dialogue::edit_line(app, |line| line.insert(&text)),
        Action::Resize(columns, rows) => {
            app.view.size = (columns, rows);
            return vec![Effect::Ask];
        }
        Action::Elapse(time) => return movement::elapse(app, time),
        Action::SetSeed(seed) => match app.edit.document.scene().seed() {
            Some(_) => {
                return edit::change(app, "roughness.seed", &seed.to_string());
            }
            _ => app.set_error("the scene has no random line to draw anew"),
        },
        Action::Report(report) => return reported(app, report),
        Action::Found(found) => return accuracy::found(app, found),
        Action::Written(file, result) => files::written(app, file, result),
        Action::Listed(entries) => dialogue::listed(app, entries),
        Action::Completed(paths) => return dialogue::completed(app, paths),
        Action::Opened(_, Ok(opening)) => return chart::open(app, *opening),
        Action::Opened(path, Err(why)) => {
            dialogue::ask_again(app, Purpose::Scene(Vec::new()), &path, &why);
            return vec![Effect::List];
        }
        Action::Remembered(Err(why)) => app.set_error(why),
        Action::Remembered(Ok(path)) => {
            app.set_done(format!("colours and markers are kept in {}", path.display()));
        }
        Action::Mouse(mouse) => return mouse::act(app, mouse),
    }
    Vec::new()
}

/// Runs the command of a key, or types its character.
fn pressed(app: &mut App, key: &KeyEvent) -> Vec<Effect> {
    match (app.config.bindings.command(key, app.keys()), key.code) {
        (Some(command), _) => run(app, command),
        (None, KeyCode::Char(typed))
            if !key.modifiers.intersects(KeyModifiers::CONTROL | KeyModifiers::ALT) =>
        {
            dialogue::edit_line(app, |line| line.insert(typed.encode_utf8(&mut [0; 4])))
        }
        _ => Vec::new(),
    }
}

/// Runs a command.
pub(super) fn run(app: &mut App, command: Command) -> Vec<Effect> {
    if app.prompt.is_none() {
        let moving = app.chart.moving && command.row.merges;
        begin(app);
        app.chart.moving = moving;
    }
    command.run(app)
}

/// Begins a command on scene or panes: ends the notice, and the edit of successive moves in the map.
pub(super) fn begin(app: &mut App) {
    app.chart.moving = false;
    // The reason for a missing curve remains; any other notice ends with the next key.
    if app.is_current() || app.is_computing() {
        app.message = None;
    }
}

/// Stores a report of the worker, unless the scene or the text has been changed since.
fn reported(app: &mut App, report: Report) -> Vec<Effect> {
    match report {
        Report::Solved(computed, snapshot) if computed.generation == app.edit.generation => {
            app.progress = None;
            app.play = app.play.within(&computed.outcome.history.legs);
            app.solved = Some(computed);
            if let Some(snapshot) = snapshot {
                movement::shown(app, snapshot);
            }
            if matches!(app.message, Some(Message::Error(_))) {
                app.message = None;
            }
            if let Some(document) = app.opens_beside.take() {
                return compare::open_beside(app, document);
            }
            return vec![Effect::Study];
        }
        Report::Shown(snapshot) if snapshot.generation == app.edit.generation => {
            movement::shown(app, snapshot)
        }
        Report::Progress { generation, legs } if generation == app.edit.generation => {
            app.progress = app.progress.map(|_| legs);
        }
        Report::Failed { generation, error } if generation == app.edit.generation => {
            app.progress = None;
            app.set_error(error);
        }
        Report::Solved(..) | Report::Shown(_) | Report::Progress { .. } | Report::Failed { .. } => {}
        Report::Tried(preview)
            if app.is_typing_value()
                && app.tried.as_ref().is_none_or(|tried| tried.text != preview.text)
                && app.next_ghost.is_none() => {}
        Report::Tried(preview) => return compare::previewed(app, preview),
    }
    Vec::new()
}

/// The state that the screen waits for; takes the manual moves.
pub fn request(app: &mut App) -> Request {
    Request {
        generation: app.edit.generation,
        scene: scene_of(&app.edit.document),
        moves: app.manual.as_mut().map_or_else(Vec::new, |manual| std::mem::take(&mut manual.moves)),
        snapshot: snapshot_request(app),
        tried: app.tried.clone(),
    }
}

/// The scene for the worker, with files named from the working folder.
pub(super) fn scene_of(document: &Document) -> Arc<Scene> {
    let mut scene = document.scene().clone();
    scene.rename_measured_files(|file| document.resolve(file).to_string_lossy().into_owned());
    Arc::new(scene)
}

/// Request for a snapshot in the panes of this model.
#[must_use]
pub fn snapshot_request(app: &App) -> SnapshotRequest {
    let layout = Layout::of(app);
    let dots = app.view.appearance.marker.columns();
    SnapshotRequest {
        drive: app.drive(),
        place: Place::Share(app.play.done),
        profile_columns: dots * layout.profile_cells(),
        profile: app.view.profile,
        close_up_columns: dots * layout.close_up_cells(),
        strip_cells: layout.close_up_cells(),
        focus: app.view.look.focus,
        close_up_springs: app.view.look.springs,
        large: app.view.large,
        lower: app.view.lower,
        crosshair: app.view.crosshair.map(|crosshair| crosshair.position),
    }
}
