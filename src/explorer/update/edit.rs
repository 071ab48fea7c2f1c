//! Edits of the scene. Each results in a document of its own and can be undone.

use super::ghosts::name_ghosts;
use super::{Effect, scene_of, show};
use crate::explorer::layout::Layout;
use crate::explorer::mode::Mode;
use crate::explorer::model::{Appraisal, CloseUpTarget, Model, Pane, Player};
use crate::explorer::panes::first_listed;
use crate::explorer::parameters::{Parameter, Setting, parameters, text_of};
use crate::explorer::prompt::{Prompt, Purpose};
use crate::explorer::request::{Focus, LineView, Tried};
use crate::explorer::text_line::TextLine;
use crate::scene::{Computed, Document, Range, SceneErrors, Solver, Step, exact_quantity, presets};

/// Most edits that can be undone.
const UNDO_DEPTH: usize = 1000;

/// Moves the selection in the list of parameters.
pub fn move_selection(model: &mut Model, rows: i32) -> Vec<Effect> {
    let listed = model.listed();
    let place = listed.iter().position(|index| *index == model.selected).unwrap_or(0);
    let last = listed.len().saturating_sub(1);
    let next = listed.get(place.saturating_add_signed(rows as isize).min(last));
    select(model, next.copied().unwrap_or(0));
    show_parameters(model)
}

/// Selects the first or last parameter.
pub fn select_end(model: &mut Model, last: bool) -> Vec<Effect> {
    let listed = model.listed();
    let end = if last { listed.last() } else { listed.first() };
    select(model, end.copied().unwrap_or(0));
    show_parameters(model)
}

/// Folds the group of the selected parameter, or unfolds it.
pub fn toggle_fold(model: &mut Model) -> Vec<Effect> {
    let is_folded = model.parameter().is_some_and(|one| model.folded.contains(one.group));
    fold(model, !is_folded);
    show_parameters(model)
}

/// Opens the built-in scene of a digit.
pub fn open_built_in(model: &mut Model, digit: char) -> Vec<Effect> {
    let place = digit.to_digit(10).and_then(|digit| (digit as usize).checked_sub(1));
    let Some(preset) = place.and_then(|place| presets().get(place)) else { return Vec::new() };
    open_read(model, Document::parse(preset.text, preset.name))
}

/// Explores a scene just read, or states the reason why it is not allowed.
pub fn open_read(model: &mut Model, read: Result<Document, SceneErrors>) -> Vec<Effect> {
    match read {
        Ok(document) => open(model, document),
        Err(errors) => {
            model.set_error(errors.to_string());
            Vec::new()
        }
    }
}

/// Explores another scene from its beginning.
pub fn open(model: &mut Model, document: Document) -> Vec<Effect> {
    if model.is_unsaved() {
        model.left.insert(model.document.name().to_owned(), model.document.clone());
        model.set_done("the changed scene is kept: undo brings it back");
    }
    model.player = Player::START;
    model.look = CloseUpTarget { focus: Focus::Summit, springs: CloseUpTarget::springs_shown(&document) };
    model.profile = LineView::WHOLE;
    // The shown map is that of the scene; a study stays loaded.
    model.chart.of_study = false;
    let effects = adopt(model, document);
    model.set_saved();
    effects
}

/// Selects a parameter, or the last one, and unfolds its group.
pub fn select(model: &mut Model, row: usize) {
    model.selected = row.min(model.parameters.len().saturating_sub(1));
    model.refused = None;
    let hidden = model.parameter().filter(|parameter| !parameter.is_head()).map(|parameter| parameter.group);
    if let Some(group) = hidden {
        model.folded.remove(group);
    }
    model.first_listed = first_listed(model);
}

/// Folds the group of the selected parameter and selects its first row, or unfolds the group.
fn fold(model: &mut Model, folds: bool) {
    let Some(group) = model.parameter().map(|parameter| parameter.group) else { return };
    if folds {
        model.selected = row_of(model, group);
        model.refused = None;
        model.folded.insert(group);
    } else {
        model.folded.remove(group);
    }
    model.first_listed = first_listed(model);
}

/// Opens the editor on the selected value, which the first typed character replaces.
pub fn edit_value(model: &mut Model, first: Option<char>) -> Vec<Effect> {
    if let Some(parameter) = model.parameter() {
        match parameter.setting {
            _ if first.is_some() && !parameter.takes_number() => {
                let way = way_of_changing(parameter);
                model.set_done(way);
            }
            Setting::Switch(_) => return switch(model),
            Setting::Heading => return toggle_fold(model),
            Setting::Field | Setting::RoughnessParameter(_) | Setting::WorkOfAdhesion => {
                let mut line = TextLine::selected(&editable(model, parameter));
                first.into_iter().for_each(|character| line.insert(&character.to_string()));
                model.ask(Purpose::Value, line);
                model.refused = None;
                // No preview of an earlier edit.
                (model.tried, model.preview) = (None, None);
            }
        }
    }
    let mut effects = show_parameters(model);
    effects.extend(preview(model));
    effects
}

/// The way to change a parameter without a number.
fn way_of_changing(parameter: &Parameter) -> String {
    let way = match (parameter.setting, parameter.field.step) {
        (Setting::Switch(_), _) => "a switch: t changes it",
        (Setting::Heading, _) => "a group: Enter folds it",
        (_, Step::Choice) => "a choice: ← → change it",
        _ => "not a number: Enter types it",
    };
    format!("{} is {way}", parameter.name())
}

/// Chooses the list of parameters where a small window hides it: no value changes unseen.
pub fn show_parameters(model: &mut Model) -> Vec<Effect> {
    if Layout::of(model).pane(Pane::Parameters).is_some() {
        return Vec::new();
    }
    show::choose(model, Pane::Parameters)
}

/// Steps the selected value.
pub fn step_value(model: &mut Model, steps: i32, coarse: bool) -> Vec<Effect> {
    [show_parameters(model), stepped(model, steps, coarse)].concat()
}

fn stepped(model: &mut Model, steps: i32, coarse: bool) -> Vec<Effect> {
    let Some(parameter) = model.parameter() else { return Vec::new() };
    match parameter.setting {
        Setting::Switch(_) => return switch(model),
        Setting::Heading => {
            fold(model, steps < 0);
            return Vec::new();
        }
        Setting::Field if matches!(parameter.field.range, Range::Text { .. }) => {
            return refuse(model, way_of_changing(parameter));
        }
        Setting::Field | Setting::RoughnessParameter(_) | Setting::WorkOfAdhesion => {}
    }
    let no_step = format!("no further step; allowed: {}", parameter.field.allowed());
    if parameter.field.step == Step::Choice {
        return match model.document.with_next_choice(parameter.field, steps > 0, &computed(model)) {
            Ok(Some(document)) => take_over(model, Ok(document)),
            Ok(None) => refuse(model, no_step),
            Err(errors) => take_over(model, Err(errors)),
        };
    }
    let Some(written) = model.written(parameter) else {
        return refuse(model, "not before the scene is computed".to_owned());
    };
    match parameter.field.stepped(&written, steps, coarse) {
        Some(next) => set_selected(model, &next),
        None => refuse(model, no_step),
    }
}

/// The value of a parameter at the start of the editor: in the shown unit, to the last digit.
fn editable(model: &Model, parameter: &Parameter) -> String {
    let written = model.written(parameter).unwrap_or_default();
    match (parameter.field.range, written.parse()) {
        (Range::Real { .. }, Ok(value)) => exact_quantity(value, parameter.field.unit),
        (Range::Text { .. }, _) => text_of(&written),
        _ => written,
    }
}

/// Sets the selected parameter to the typed value.
pub fn accept_value(model: &mut Model, typed: &str) -> Result<Vec<Effect>, String> {
    let Some(parameter) = model.parameter() else { return Ok(Vec::new()) };
    if typed == editable(model, parameter) {
        return Ok(Vec::new());
    }
    let allowed = parameter.field.allowed();
    let written =
        parameter.field.read_typed(typed).map_err(|error| format!("{error}; allowed: {allowed}"))?;
    let document = with_selected(model, &written)?;
    Ok(take_over(model, Ok(document)))
}

/// Sets the selected parameter to a value in the notation of the scene.
fn set_selected(model: &mut Model, written: &str) -> Vec<Effect> {
    match with_selected(model, written) {
        Ok(document) => take_over(model, Ok(document)),
        Err(why) => refuse(model, why),
    }
}

/// The scene with another value of the selected parameter, in the notation of the scene; or why there is none.
fn with_selected(model: &Model, written: &str) -> Result<Document, String> {
    let parameter = model.parameter().ok_or("no parameter is selected")?;
    let document = &model.document;
    let number = || written.parse::<f64>().map_err(|_| format!("{written:?} is not a number"));
    let changed = match parameter.setting {
        Setting::Field | Setting::Switch(_) | Setting::Heading => document.set(&parameter.path, written),
        Setting::WorkOfAdhesion => document.with_work_of_adhesion(number()?),
        Setting::RoughnessParameter(parameter) => {
            let value = number()?;
            let adhesion = document.scene().adhesion.unwrap_or_default();
            match (adhesion.work.filter(|_| adhesion.parameter().is_none()), model.governing()) {
                // The scene has γ alone, which follows from the parameter.
                (Some(_), Some(governing)) => {
                    let undefined = || format!("{} is not defined without roughness", parameter.symbol());
                    let work = governing.work_for(parameter, value).ok_or_else(undefined)?;
                    document.with_work_of_adhesion(work)
                }
                (Some(_), None) => return Err("not before the scene is computed".to_owned()),
                (None, _) => document.with_parameter(parameter, value),
            }
        }
    };
    changed.map_err(|errors| reasons(&errors))
}

/// Errors of values, without their places.
fn reasons(errors: &SceneErrors) -> String {
    errors.iter().map(|error| error.what()).collect::<Vec<_>>().join("; ")
}

/// Most springs for a preview while a value is typed: the next character stops the computation.
const MOST_SPRINGS_TRIED: u64 = 1 << 20;

/// Returns true if a scene is small enough for a preview; the number of steps of the stepwise solver has no limit.
fn is_previewed(document: &Document) -> bool {
    let numerics = document.scene().numerics;
    numerics.points <= MOST_SPRINGS_TRIED && numerics.solver == Solver::Exact
}

/// Requests the curve with the value typed so far, or none where that is not an allowed value.
pub fn preview(model: &mut Model) -> Vec<Effect> {
    let tried = match &model.mode {
        Mode::Prompt(Prompt { purpose: Purpose::Value, line, .. }) => {
            let written = model.parameter().and_then(|one| one.field.read_typed(&line.text()).ok());
            written.and_then(|written| with_selected(model, &written).ok())
        }
        _ => None,
    };
    let tried = tried.filter(|tried| tried.text() != model.document.text() && is_previewed(tried));
    if tried.as_ref().map(Document::text) == model.tried.as_ref().map(|tried| tried.text.as_str()) {
        return Vec::new();
    }
    model.tried = tried.as_ref().map(tried_of);
    vec![Effect::Ask]
}

/// A document whose outcome alone is of interest.
pub fn tried_of(document: &Document) -> Tried {
    Tried { text: document.text().to_owned(), scene: scene_of(document) }
}

/// Switches the effect of the selected row on or off.
pub fn toggle_effect(model: &mut Model) -> Vec<Effect> {
    [show_parameters(model), switch(model)].concat()
}

fn switch(model: &mut Model) -> Vec<Effect> {
    let Some(effect) = model.parameter().and_then(|parameter| parameter.effect) else {
        return refuse(model, "no effect to switch; form, roughness, adhesion, loading have one".to_owned());
    };
    let document = &model.document;
    let changed = if effect.is_on(document.scene()) {
        document.without(effect, &computed(model))
    } else {
        document.with(effect)
    };
    take_over(model, changed)
}

/// Values of the computed scene, which may replace others in the scene.
fn computed(model: &Model) -> Computed {
    let governing = model.governing();
    Computed {
        work_of_adhesion: governing.and_then(|governing| governing.work_of_adhesion),
        kappa: governing.and_then(|governing| governing.kappa),
        elastic_energy_ratio: governing.and_then(|governing| governing.elastic_energy_ratio),
        rms_height: governing.and_then(|governing| governing.amplitude).map(|amplitude| amplitude.rms_height),
    }
}

fn refuse(model: &mut Model, why: String) -> Vec<Effect> {
    model.refused = Some((model.selected, why));
    Vec::new()
}

/// Sets a field; an invalid value leaves the scene unchanged.
pub fn change(model: &mut Model, path: &str, value: &str) -> Vec<Effect> {
    let changed = model.document.set(path, value);
    take_over(model, changed)
}

/// Makes a changed document the explored one, or states the reason why it is not allowed.
pub fn take_over(model: &mut Model, changed: Result<Document, SceneErrors>) -> Vec<Effect> {
    match changed {
        Ok(document) => {
            let lost = model.document.comments().saturating_sub(document.comments());
            let effects = adopt(model, document);
            if lost > 0 {
                let gone = if lost == 1 { "a comment is" } else { "comments are" };
                model.set_done(format!("{gone} gone with what was replaced: undo brings it all back"));
            }
            effects
        }
        Err(errors) => refuse(model, reasons(&errors)),
    }
}

/// Makes a document the explored one; undo returns to the former one.
pub fn adopt(model: &mut Model, document: Document) -> Vec<Effect> {
    let before = std::mem::replace(&mut model.document, document);
    model.undo.push(before);
    if model.undo.len() > UNDO_DEPTH {
        model.undo.remove(0);
    }
    model.redo.clear();
    renew(model)
}

/// Continues the last edit: its new result replaces the former one.
pub fn replace(model: &mut Model, document: Document) -> Vec<Effect> {
    model.document = document;
    model.redo.clear();
    renew(model)
}

/// Undoes the last edit, or redoes it.
pub fn undo(model: &mut Model, back: bool) -> Vec<Effect> {
    let (from, to) =
        if back { (&mut model.undo, &mut model.redo) } else { (&mut model.redo, &mut model.undo) };
    let Some(document) = from.pop() else { return Vec::new() };
    let before = std::mem::replace(&mut model.document, document);
    to.push(before.clone());
    if before.name() != model.document.name() && model.is_changed(&before) {
        model.left.insert(before.name().to_owned(), before);
    }
    renew(model)
}

/// Row of the field at a path, or of the group around it: the selection stays in place when rows come and go, and the
/// row that switched an effect off can switch the effect on again.
fn row_of(model: &Model, path: &str) -> usize {
    let around = std::iter::successors(Some(path), |path| path.rsplit_once('.').map(|(group, _)| group));
    let row = |path: &str| model.parameters.iter().position(|parameter| parameter.path == path);
    around.filter_map(row).next().unwrap_or(model.selected).min(model.parameters.len().saturating_sub(1))
}

/// Requests the computation of the changed scene.
fn renew(model: &mut Model) -> Vec<Effect> {
    let selected = model.parameter().map(|parameter| parameter.path.clone()).unwrap_or_default();
    // A scene left before is the present one again.
    let document = &model.document;
    model.left.retain(|_, left| left.name() != document.name() || left.scene() != document.scene());
    model.parameters = parameters(&model.document);
    select(model, row_of(model, &selected));
    model.generation += 1;
    model.progress = Some(0);
    model.edited = true;
    model.failures.clear();
    model.appraisal = Appraisal::default();
    for pane in Pane::ALL {
        (pane.row().renew)(model);
    }
    // Manual loading belongs to the former profile and contact.
    if model.manual.take().is_some() {
        model.set_done("the body is back on the scene's loading");
    }
    name_ghosts(model);
    model.moves.clear();
    vec![Effect::Ask]
}
