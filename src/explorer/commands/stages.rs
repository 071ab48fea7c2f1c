//! Edits of the loading of the scene.

use super::{edit, measured, profiles};
use crate::explorer::app::App;
use crate::explorer::parameters::Setting;

use asperity_contact::Move;
use asperity_data::round_to;
use asperity_scene::loading::StageKind;
use asperity_scene::{Document, SceneErrors};

/// Loading stages. A stage taken from the present loading has its index in this loading; a new
/// stage has `None`.
type Stages = Vec<(Option<usize>, Move)>;

/// Returns the index of the selected stage. If the row of the whole loading is selected, returns
/// the index of the last stage. If any other row is selected, shows an error message.
fn selected(app: &mut App) -> Option<usize> {
    edit::show_parameters(app);
    let last = app.edit.document.scene().loading.len() - 1;
    match app.edit.parameter() {
        Some(parameter) if parameter.group == "loading" => Some(parameter.stage.unwrap_or(last)),
        _ => {
            app.set_error("no loading stage is selected; select a row of the loading");
            None
        }
    }
}

/// Changes the stages with the function `change`. The function receives the stages and the index of
/// the selected stage, and returns the index of the stage to select afterwards.
fn change(app: &mut App, change: impl FnOnce(&mut Stages, usize) -> usize) {
    let Some(selected) = selected(app) else {
        return;
    };
    let mut stages = app.edit.document.stages();
    let next = change(&mut stages, selected);
    if stages != app.edit.document.stages() {
        let changed = app.edit.document.with_stages(&stages);
        adopt(app, changed, next)
    }
}

/// If the change is allowed, makes the changed scene the explored scene and selects a stage.
fn adopt(app: &mut App, changed: Result<Document, SceneErrors>, stage: usize) {
    let is_allowed = changed.is_ok();
    edit::apply(app, changed);
    if is_allowed {
        app.edit.select_stage(stage);
    }
}

/// Adds a stage to the loading after the selected stage, and opens the editor of the new stage. If
/// the selected stage does not press the body, the new stage presses it. If the selected stage
/// presses the body, the new stage goes to zero force or, at the end of the loading, to separation.
pub fn add(app: &mut App) {
    let force = pressing_force(app);
    let before = app.edit.generation;
    change(app, |stages, selected| {
        let next = selected + 1;
        let added = if !presses(stages[selected].1) {
            Move::ToForce(force)
        } else if next == stages.len() {
            Move::ToSeparation
        } else {
            Move::ToZeroForce
        };
        stages.insert(next, (None, added));
        next
    });
    if app.edit.generation != before {
        edit::edit_value(app, None);
    }
}

/// Returns true for a stage to a force, an indentation or a displacement above zero.
fn presses(stage: Move) -> bool {
    match stage {
        Move::ToForce(target) | Move::ToIndentation(target) | Move::ToDisplacement(target) => {
            target > 0.0
        }
        _ => false,
    }
}

pub fn delete(app: &mut App) {
    change(app, |stages, selected| {
        stages.remove(selected);
        selected.min(stages.len().saturating_sub(1))
    })
}

/// Exchanges the selected stage with the stage that is `distance` places after it.
pub fn shift(app: &mut App, distance: isize) {
    change(app, |stages, selected| {
        let place = selected.saturating_add_signed(distance);
        let place = place.min(stages.len() - 1);
        stages.swap(selected, place);
        place
    })
}

/// Changes the kind of the selected stage to the next kind that the loading allows, or to the
/// previous kind if `forwards` is false. The target value of the new kind, such as an indentation,
/// is the value at which the stage ends now. If no other kind is allowed, a message states why the
/// last kind was refused.
pub fn change_kind(app: &mut App, forwards: bool) {
    let Some(selected) = selected(app) else {
        return;
    };
    let stages = app.edit.document.stages();
    let (present, _) = StageKind::of(&stages[selected].1);
    let count = StageKind::ALL.len();
    // On an elastic half-space a rest changes nothing.
    let relaxes = app.edit.document.scene().material.relaxation.is_some();
    let mut refused = None;
    for distance in 1..count {
        let step = if forwards { distance } else { count - distance };
        let kind = &StageKind::ALL[(present + step) % count];
        if kind.unit == "s" && !relaxes {
            continue;
        }
        let number = round_to(number_of_kind(app, selected, kind), 4);
        let mut stages = stages.clone();
        stages[selected] = (None, (kind.stage)(number));
        let changed = app.edit.document.with_stages(&stages);
        if changed.is_ok() {
            return adopt(app, changed, selected);
        }
        refused = Some(changed);
    }
    if let Some(refused) = refused {
        adopt(app, refused, selected);
    }
}

/// Returns the number with which a stage of another kind would end where the stage ends now, in the
/// unit of this kind. If the end of the stage is not known, returns a usual value.
fn number_of_kind(app: &App, stage: usize, kind: &StageKind) -> f64 {
    /// Indentation in m for a stage that is not computed.
    const USUAL_INDENTATION: f64 = 1e-7;
    /// Time in s of a rest.
    const USUAL_REST: f64 = 10.0;
    if kind.unit == "s" {
        return USUAL_REST;
    }
    let end = app.current().and_then(|solved| {
        let record = solved.outcome.history.stages.get(stage)?;
        record.curve.last()
    });
    if kind.unit == "m" {
        let Some(end) = end else {
            return USUAL_INDENTATION;
        };
        return match (kind.stage)(0.0) {
            Move::ToDisplacement(_) => {
                let stiffness = app.edit.document.scene().loading_stiffness;
                end.displacement(stiffness.unwrap_or(f64::INFINITY))
            }
            _ => end.indentation,
        };
    }
    let pressing = pressing_force(app);
    match end {
        Some(end) if end.force.abs() > 1e-6 * pressing => end.force,
        _ => pressing,
    }
}

/// Returns a force in N for a stage that presses: the largest force of the present loading. If the
/// present loading does not press, the largest force of the most recent earlier version of the
/// scene that presses. If there is none, a force that suits the computed scene.
fn pressing_force(app: &App) -> f64 {
    let present = &app.edit.document;
    let earlier = app.edit.past.iter().rev().map(|edited| &edited.document);
    let earlier = earlier.filter(|document| document.name() == present.name());
    for document in std::iter::once(present).chain(earlier) {
        let force = asperity_scene::loading::pressing_force(&document.scene().loading);
        if force > 0.0 {
            return force;
        }
    }
    let suitable = app.current().map_or(0.0, |solved| {
        let preload = solved.outcome.figures.preload.unwrap_or_default();
        let (full_contact, _) = solved.reach.full_contact;
        round_to(preload.max(0.01 * full_contact), 2)
    });
    if suitable > 0.0 {
        suitable
    } else {
        USUAL_FORCE
    }
}

/// Force in N of a stage that presses, if neither the scene nor its outcome suggests a force.
const USUAL_FORCE: f64 = 1e-5;

/// Changes the value in the selected row by a number of steps. If the row is an option for reading
/// the measured curve, the option changes as in [`measured::step_option`]. A stage without a target
/// value, such as a separation, does not change, because a target value would make it another kind
/// of stage.
pub fn step_value(app: &mut App, steps: i32, coarse: bool) {
    let Some(parameter) = app.edit.parameter() else {
        return;
    };
    match parameter.stage {
        None if matches!(parameter.setting, Setting::CurveOption(_)) => {
            measured::step_option(app, steps, coarse)
        }
        None if parameter.setting == Setting::Profiles => profiles::step(app, steps, coarse),
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

/// Returns the stages for a new loading of the scene. A stage that is the same as before refers to
/// its text in the file, so that this text is kept.
fn replaced(document: &Document, loading: &[Move]) -> Stages {
    let present = &document.scene().loading;
    let mut stages = Stages::new();
    for (index, stage) in loading.iter().enumerate() {
        let is_unchanged = present.get(index) == Some(stage);
        let kept = if is_unchanged { Some(index) } else { None };
        stages.push((kept, *stage));
    }
    stages
}

/// Returns the scene with another loading.
pub fn with_loading(document: &Document, loading: &[Move]) -> Result<Document, SceneErrors> {
    document.with_stages(&replaced(document, loading))
}
