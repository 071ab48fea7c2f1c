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
use super::model::{Model, Notice, Pane, Player};
use super::request::{Request, SnapshotRequest};
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
            return vec![Effect::Show];
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
        Report::Computed(computed) if computed.generation == model.generation => {
            model.progress = None;
            let last = computed.outcome.history.legs.len().saturating_sub(1);
            model.computed = Some(computed);
            movement::stay_on_legs(model, last);
            if matches!(model.notice, Some(Notice::Error(_))) {
                model.notice = None;
            }
            if let Some(document) = model.opens_beside.take() {
                return compare::open_beside(model, document);
            }
            return vec![Effect::Show, Effect::Study];
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
        Report::Computed(_) | Report::Shown(_) | Report::Progress { .. } | Report::Failed { .. } => {}
        Report::Previewed(preview)
            if model.mode.is_typing_value()
                && model.tried.as_ref() != Some(&preview.text)
                && model.next_ghost.is_none() => {}
        Report::Previewed(preview) => return compare::previewed(model, preview),
    }
    Vec::new()
}

/// Request to the worker for an effect; `None` for an effect for others, or for a snapshot of a scene that is not
/// computed yet.
#[must_use]
pub fn request(model: &Model, effect: &Effect) -> Option<Request> {
    let generation = model.generation;
    match effect {
        Effect::Compute => Some(Request::Compute { generation, scene: scene_of(&model.document) }),
        Effect::Show => moment_request(model).map(Request::Show),
        Effect::Beside => Some(Request::Beside(model.beside().map(|ghost| scene_of(&ghost.document)))),
        Effect::Manual(order) => Some(Request::Manual { generation, order: *order }),
        Effect::Preview(document) => {
            Some(Request::Preview { text: document.text().to_owned(), scene: scene_of(document) })
        }
        _ => None,
    }
}

/// The scene for the worker, with files named from the working folder.
pub(super) fn scene_of(document: &Document) -> Arc<Scene> {
    let mut scene = document.scene().clone();
    scene.rename_measured_files(|file| document.resolve(file).to_string_lossy().into_owned());
    Arc::new(scene)
}

/// Request to the worker for the panes of this model.
#[must_use]
pub fn moment_request(model: &Model) -> Option<SnapshotRequest> {
    if !model.is_current() {
        return None;
    }
    let layout = Layout::of(model);
    let dots = model.appearance.marker.columns();
    Some(SnapshotRequest {
        generation: model.generation,
        drive: model.drive(),
        indentation: model.indentation(),
        profile_columns: dots * layout.profile_cells(),
        profile: model.profile,
        close_up_columns: dots * layout.close_up_cells(),
        strip_cells: layout.close_up_cells(),
        focus: model.look.focus,
        close_up_springs: model.look.springs,
        large: model.large,
        lower: model.lower,
        crosshair: model.crosshair.map(|crosshair| crosshair.position),
        beside: model.beside().filter(|_| layout.pane(Pane::Beside).is_some()).map(|ghost| {
            let legs = &ghost.computed.outcome.history.legs;
            let leg = model.player.leg.min(legs.len().saturating_sub(1));
            (leg, Player { leg, ..model.player }.indentation(legs))
        }),
    })
}
