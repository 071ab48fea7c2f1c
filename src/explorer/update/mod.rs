//! Effect of each action on the model. Nothing here touches terminal, files or worker: work outside
//! the model is returned.

pub(super) mod accuracy;
pub(super) mod chart;
pub(super) mod compare;
pub(super) mod crosshair;
pub(super) mod dialogue;
pub(super) mod edit;
pub(super) mod files;
mod ghosts;
pub(super) mod library;
pub(super) mod look;
mod mouse;
pub(super) mod movement;
pub(super) mod show;

pub use super::effect::Effect;
pub use accuracy::study_tasks;
pub use dialogue::can_complete;

use super::action::Action;
use super::command::Command;
use super::layout::Layout;
use super::mode::Mode;
use super::model::{Model, Notice};
use super::request::{Place, Request, SnapshotRequest};
use super::snapshot::Report;
use crate::scene::{Document, Scene};
use std::sync::Arc;

/// Applies an action and returns the effects to perform outside.
pub fn update(model: &mut Model, action: Action) -> Vec<Effect> {
    match action {
        Action::Command(command) => return run(model, command),
        Action::Type(character) => return dialogue::insert(model, &character.to_string()),
        Action::Paste(text) => return dialogue::insert(model, &text),
        Action::Resize(columns, rows) => {
            model.size = (columns, rows);
            return vec![Effect::Ask];
        }
        Action::Elapse(time) => return movement::elapse(model, time),
        Action::SetSeed(seed) => match model.document.scene().seed() {
            Some(_) => {
                return edit::change(model, "roughness.seed", &seed.to_string());
            }
            _ => model.set_error("the scene has no random line to draw anew"),
        },
        Action::Report(report) => return reported(model, report),
        Action::Found(found) => return accuracy::found(model, found),
        Action::Written(file, result) => files::written(model, file, result),
        Action::Listed(entries) => library::listed(model, entries),
        Action::Completed(paths) => return dialogue::completed(model, paths),
        Action::Opened(_, Ok(opening)) => return chart::open(model, *opening),
        Action::Opened(path, Err(why)) => return library::refused(model, &path, &why),
        Action::Remembered(Err(why)) => model.set_error(why),
        Action::Remembered(Ok(path)) => {
            model.set_done(format!("colours and markers are kept in {}", path.display()));
        }
        Action::Mouse(mouse) => return mouse::act(model, mouse),
    }
    Vec::new()
}

/// Runs a command.
pub(super) fn run(model: &mut Model, command: Command) -> Vec<Effect> {
    if model.mode == Mode::Explore {
        let moving = model.chart.moving && chart::is_move(command);
        begin(model);
        model.chart.moving = moving;
    }
    command.run(model)
}

/// Begins a command on scene or panes: ends the notice, and the edit of successive moves in the map.
pub(super) fn begin(model: &mut Model) {
    model.chart.moving = false;
    // The reason for a missing curve remains; any other notice ends with the next key.
    if model.is_current() || model.is_computing() {
        model.notice = None;
    }
}

/// Stores a report of the worker, unless the scene or the text has been changed since.
fn reported(model: &mut Model, report: Report) -> Vec<Effect> {
    match report {
        Report::Solved(computed, snapshot) if computed.generation == model.generation => {
            model.progress = None;
            model.player = model.player.within(&computed.outcome.history.legs);
            model.computed = Some(computed);
            if let Some(snapshot) = snapshot {
                movement::shown(model, snapshot);
            }
            if matches!(model.notice, Some(Notice::Error(_))) {
                model.notice = None;
            }
            if let Some(document) = model.opens_beside.take() {
                return compare::open_beside(model, document);
            }
            return vec![Effect::Study];
        }
        Report::Shown(snapshot) if snapshot.generation == model.generation => {
            movement::shown(model, snapshot)
        }
        Report::Progress { generation, legs } if generation == model.generation => {
            model.progress = model.progress.map(|_| legs);
        }
        Report::Failed { generation, error } if generation == model.generation => {
            model.progress = None;
            model.set_error(error);
        }
        Report::Solved(..) | Report::Shown(_) | Report::Progress { .. } | Report::Failed { .. } => {}
        Report::Tried(preview)
            if model.mode.is_typing_value()
                && model.tried.as_ref().is_none_or(|tried| tried.text != preview.text)
                && model.next_ghost.is_none() => {}
        Report::Tried(preview) => return compare::previewed(model, preview),
    }
    Vec::new()
}

/// The state that the screen waits for; takes the manual moves.
pub fn request(model: &mut Model) -> Request {
    Request {
        generation: model.generation,
        scene: scene_of(&model.document),
        moves: std::mem::take(&mut model.moves),
        snapshot: snapshot_request(model),
        tried: model.tried.clone(),
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
pub fn snapshot_request(model: &Model) -> SnapshotRequest {
    let layout = Layout::of(model);
    let dots = model.appearance.marker.columns();
    SnapshotRequest {
        drive: model.drive(),
        place: Place::Share(model.player.done),
        profile_columns: dots * layout.profile_cells(),
        profile: model.profile,
        close_up_columns: dots * layout.close_up_cells(),
        strip_cells: layout.close_up_cells(),
        focus: model.look.focus,
        close_up_springs: model.look.springs,
        large: model.large,
        lower: model.lower,
        crosshair: model.crosshair.map(|crosshair| crosshair.position),
    }
}
