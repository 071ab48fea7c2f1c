//! Edits of the loading: of single stages, and by the path of manual loading.

use super::{edit, measured};
use crate::explorer::app::App;
use crate::explorer::parameters::Setting;
use crate::explorer::player::{At, Player};
use asperity_contact::Move;
use asperity_data::round_to;
use asperity_scene::loading::StageKind;
use asperity_scene::{Document, SceneErrors};

/// Loading stages; a stage of the present loading has its index in it.
type Stages = Vec<(Option<usize>, Move)>;

/// Index of the selected stage, or on the row of the whole loading of the last one; states an error
/// if neither is selected.
fn selected(app: &mut App) -> Option<usize> {
    edit::show_parameters(app);
    let last = app.edit.document.scene().loading.len() - 1;
    let parameter = app
        .edit
        .parameter()
        .filter(|parameter| parameter.group == "loading");
    let stage = parameter.map(|parameter| parameter.leg.unwrap_or(last));
    if stage.is_none() {
        app.set_error("no loading stage is selected; select a row of the loading");
    }
    stage
}

/// Changes the stages, given the index of the selected one; `change` returns the index of the stage
/// to select.
fn change(app: &mut App, change: impl FnOnce(&mut Stages, usize) -> usize) {
    let Some(at) = selected(app) else { return };
    let mut stages = app.edit.document.stages();
    let next = change(&mut stages, at);
    if stages != app.edit.document.stages() {
        let changed = app.edit.document.with_stages(&stages);
        adopt(app, changed, next)
    }
}

/// Makes a scene the explored one, if it is allowed, and selects a stage.
fn adopt(app: &mut App, changed: Result<Document, SceneErrors>, stage: usize) {
    let is_allowed = changed.is_ok();
    edit::apply(app, changed);
    let row = app
        .edit
        .parameters
        .iter()
        .position(|one| one.leg == Some(stage));
    if let Some(row) = row.filter(|_| is_allowed) {
        app.edit.select(row);
    }
}

/// Adds a stage after the selected one and opens its editor: after a stage that presses, a stage to
/// zero force, or at the end to separation; otherwise a stage that presses.
pub fn add(app: &mut App) {
    let (force, before) = (pressing_force(app), app.edit.generation);
    change(app, |stages, at| {
        let presses = matches!(stages[at].1, Move::ToForce(to) | Move::ToIndentation(to) | Move::ToDisplacement(to) if to > 0.0);
        let pull = if at + 1 == stages.len() {
            Move::ToSeparation
        } else {
            Move::ToZeroForce
        };
        stages.insert(
            at + 1,
            (None, if presses { pull } else { Move::ToForce(force) }),
        );
        at + 1
    });
    if app.edit.generation != before {
        edit::edit_value(app, None);
    }
}

pub fn delete(app: &mut App) {
    change(app, |stages, at| {
        stages.remove(at);
        at.min(stages.len().saturating_sub(1))
    })
}

/// Exchanges the selected stage with the previous or the next one.
pub fn shift(app: &mut App, way: isize) {
    change(app, |stages, at| {
        let to = at.saturating_add_signed(way).min(stages.len() - 1);
        stages.swap(at, to);
        to
    })
}

/// Changes the selected stage to the next kind, forwards or backwards, that the loading allows,
/// with the value that it reaches now.
pub fn change_kind(app: &mut App, forwards: bool) {
    let Some(at) = selected(app) else { return };
    let legs = app.current().map(|solved| &solved.outcome.history.legs);
    let end = legs.and_then(|legs| legs.get(at)?.curve.last());
    let pressing = pressing_force(app);
    let stiffness = app
        .edit
        .document
        .scene()
        .loading_stiffness
        .unwrap_or(f64::INFINITY);
    let number = |kind: &StageKind| match (kind.unit, end, (kind.stage)(0.0)) {
        ("m", None, _) => 1e-7,
        ("m", Some(end), Move::ToDisplacement(_)) => end.displacement(stiffness),
        ("m", Some(end), _) => end.indentation,
        (_, Some(end), _) if end.force.abs() > 1e-6 * pressing => end.force,
        _ => pressing,
    };
    let (stages, count) = (app.edit.document.stages(), StageKind::ALL.len());
    let here = StageKind::of(&stages[at].1).0;
    let changed = (1..count).map(|distance| {
        let kind =
            &StageKind::ALL[(here + if forwards { distance } else { count - distance }) % count];
        let mut stages = stages.clone();
        stages[at] = (None, (kind.stage)(round_to(number(kind), 4)));
        app.edit.document.with_stages(&stages)
    });
    if let Some(changed) = changed.reduce(|one, other| if one.is_ok() { one } else { other }) {
        adopt(app, changed, at)
    }
}

/// Largest force of the loading or of the loading before the last edits, N; otherwise a force that
/// suits the computed scene.
fn pressing_force(app: &App) -> f64 {
    let name = app.edit.document.name();
    let before = app.edit.past.iter().rev().map(|edited| &edited.document);
    let before = before.filter(|document| document.name() == name);
    let given = [&app.edit.document]
        .into_iter()
        .chain(before)
        .map(|document| asperity_scene::loading::pressing_force(&document.scene().loading));
    let computed = app.current().map_or(0.0, |solved| {
        round_to(
            solved
                .outcome
                .figures
                .preload
                .unwrap_or_default()
                .max(0.01 * solved.reach.full_contact.0),
            2,
        )
    });
    given
        .chain([computed])
        .find(|force| *force > 0.0)
        .unwrap_or(1e-5)
}

/// Steps the selected value; for an option of reading the next choice. A stage without a number,
/// such as a separation, stays, since another kind of stage is another loading.
pub fn step_value(app: &mut App, steps: i32, coarse: bool) {
    let Some(parameter) = app.edit.parameter() else {
        return;
    };
    match parameter.leg {
        None if matches!(parameter.setting, Setting::Reading(_)) => {
            measured::step_option(app, steps, coarse)
        }
        Some(_) if parameter.field.unit.is_empty() => {
            let name = parameter.name();
            edit::refuse(
                app,
                format!("{name} has no number; V changes its kind, Enter types another stage"),
            );
        }
        _ => edit::step_value(app, steps, coarse),
    }
}

/// The stages of a loading that replaces the loading of a scene; an unchanged stage keeps its text.
fn replaced(document: &Document, loading: impl IntoIterator<Item = Move>) -> Stages {
    let present = &document.scene().loading;
    let placed = |(at, stage)| ((present.get(at) == Some(&stage)).then_some(at), stage);
    loading.into_iter().enumerate().map(placed).collect()
}

/// The scene with the path of manual loading as its loading; `None` without manual loading.
pub fn with_path(app: &App) -> Option<Result<Document, SceneErrors>> {
    let loading = &app.manual.as_ref()?.loading;
    Some(
        app.edit
            .document
            .with_stages(&replaced(&app.edit.document, loading.iter().copied())),
    )
}

/// Makes the path of manual loading the loading of the scene, with the body at its end.
pub fn keep_path(app: &mut App) {
    match with_path(app) {
        None => app.set_error("no manual loading; d begins it"),
        Some(Err(errors)) => app.set_error(edit::reasons(&errors)),
        Some(Ok(document)) => {
            let count = document.scene().loading.len();
            edit::adopt(app, document);
            app.play = Player {
                leg: count - 1,
                at: At::End,
                playing: false,
            };
            let stages = if count == 1 {
                "1 stage".to_owned()
            } else {
                format!("{count} stages")
            };
            app.set_done(format!(
                "the path is the loading of the scene, {stages}; u undoes"
            ));
        }
    }
}
