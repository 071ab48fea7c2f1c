//! Edits of the scene. Each results in a document of its own and can be undone.

use super::ghosts::name_ghosts;
use super::{Effect, scene_of, show};
use crate::explorer::app::{App, Appraisal, CloseUpTarget, Message, Pane, Player};
use crate::explorer::layout::Layout;
use crate::explorer::parameters::{Parameter, Setting, parameters, text_of};
use crate::explorer::prompt::Purpose;
use crate::explorer::request::{Focus, LineView, Tried};
use crate::explorer::text_line::TextLine;
use crate::scene::{
    Computed, Document, Range, SceneErrors, Solver, Step, exact_quantity, parse_quantity, presets,
};

/// Most edits that can be undone.
const UNDO_DEPTH: usize = 1000;

/// Moves the selection in the list of parameters.
pub fn move_selection(app: &mut App, rows: i32) -> Vec<Effect> {
    let listed = app.listed();
    let place = listed.iter().position(|index| *index == app.edit.selected).unwrap_or(0);
    let last = listed.len().saturating_sub(1);
    let next = listed.get(place.saturating_add_signed(rows as isize).min(last));
    select(app, next.copied().unwrap_or(0));
    show_parameters(app)
}

/// Selects the first or last parameter.
pub fn select_end(app: &mut App, last: bool) -> Vec<Effect> {
    let listed = app.listed();
    let end = if last { listed.last() } else { listed.first() };
    select(app, end.copied().unwrap_or(0));
    show_parameters(app)
}

/// Folds the group of the selected parameter, or unfolds it.
pub fn toggle_fold(app: &mut App) -> Vec<Effect> {
    let is_folded = app.parameter().is_some_and(|one| app.edit.folded.contains(one.group));
    fold(app, !is_folded);
    show_parameters(app)
}

/// Opens the built-in scene of a digit.
pub fn open_built_in(app: &mut App, digit: char) -> Vec<Effect> {
    let place = digit.to_digit(10).and_then(|digit| (digit as usize).checked_sub(1));
    let Some(preset) = place.and_then(|place| presets().get(place)) else { return Vec::new() };
    open_read(app, Document::parse(preset.text, preset.name))
}

/// Explores a scene just read, or states the reason why it is not allowed.
pub fn open_read(app: &mut App, read: Result<Document, SceneErrors>) -> Vec<Effect> {
    match read {
        Ok(document) => open(app, document),
        Err(errors) => {
            app.set_error(errors.to_string());
            Vec::new()
        }
    }
}

/// Explores another scene from its beginning.
pub fn open(app: &mut App, document: Document) -> Vec<Effect> {
    if app.is_unsaved() {
        app.edit.left.insert(app.edit.document.name().to_owned(), app.edit.document.clone());
        app.set_done("the changed scene is kept: undo brings it back");
    }
    app.play = Player::START;
    app.view.look = CloseUpTarget { focus: Focus::Summit, springs: CloseUpTarget::springs_shown(&document) };
    app.view.profile = LineView::WHOLE;
    // The shown map is that of the scene; a study stays loaded.
    app.chart.of_study = false;
    let effects = adopt(app, document);
    app.set_saved();
    effects
}

/// Selects a parameter, or the last one, and unfolds its group.
pub fn select(app: &mut App, row: usize) {
    app.edit.selected = row.min(app.edit.parameters.len().saturating_sub(1));
    app.message.take_if(|message| matches!(message, Message::Refused(_)));
    let hidden = app.parameter().filter(|parameter| !parameter.is_head()).map(|parameter| parameter.group);
    if let Some(group) = hidden {
        app.edit.folded.remove(group);
    }
}

/// Folds the group of the selected parameter and selects its first row, or unfolds the group.
fn fold(app: &mut App, folds: bool) {
    let Some(group) = app.parameter().map(|parameter| parameter.group) else { return };
    if folds {
        app.edit.selected = row_of(app, group);
        app.edit.folded.insert(group);
    } else {
        app.edit.folded.remove(group);
    }
}

/// Opens the editor on the selected value, which the first typed character replaces.
pub fn edit_value(app: &mut App, first: Option<char>) -> Vec<Effect> {
    if let Some(parameter) = app.parameter() {
        match parameter.setting {
            _ if first.is_some() && !parameter.takes_number() => {
                let way = way_of_changing(parameter);
                app.set_done(way);
            }
            Setting::Switch(_) => return switch(app),
            Setting::Heading => return toggle_fold(app),
            Setting::Field | Setting::RoughnessParameter(_) | Setting::WorkOfAdhesion => {
                let mut line = TextLine::selected(&editable(app, parameter));
                first.into_iter().for_each(|character| line.insert(&character.to_string()));
                app.ask(Purpose::Value, line);
                // No preview of an earlier edit.
                (app.tried, app.preview) = (None, None);
            }
        }
    }
    let mut effects = show_parameters(app);
    effects.extend(preview(app));
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
pub fn show_parameters(app: &mut App) -> Vec<Effect> {
    if Layout::of(app).pane(Pane::Parameters).is_some() {
        return Vec::new();
    }
    show::choose(app, Pane::Parameters)
}

/// Steps the selected value.
pub fn step_value(app: &mut App, steps: i32, coarse: bool) -> Vec<Effect> {
    [show_parameters(app), stepped(app, steps, coarse)].concat()
}

fn stepped(app: &mut App, steps: i32, coarse: bool) -> Vec<Effect> {
    let Some(parameter) = app.parameter() else { return Vec::new() };
    match parameter.setting {
        Setting::Switch(_) => return switch(app),
        Setting::Heading => {
            fold(app, steps < 0);
            return Vec::new();
        }
        Setting::Field if matches!(parameter.field.range, Range::Text { .. }) => {
            return refuse(app, way_of_changing(parameter));
        }
        Setting::Field | Setting::RoughnessParameter(_) | Setting::WorkOfAdhesion => {}
    }
    let no_step = format!("no further step; allowed: {}", parameter.field.allowed());
    if parameter.field.step == Step::Choice {
        return match app.edit.document.with_next_choice(parameter.field, steps > 0, &computed(app)) {
            Ok(Some(document)) => take_over(app, Ok(document)),
            Ok(None) => refuse(app, no_step),
            Err(errors) => take_over(app, Err(errors)),
        };
    }
    let Some(written) = app.written(parameter) else {
        return refuse(app, "not before the scene is computed".to_owned());
    };
    match parameter.field.stepped(&written, steps, coarse) {
        Some(next) => set_selected(app, &next),
        None => refuse(app, no_step),
    }
}

/// The value of a parameter at the start of the editor: in the shown unit, to the last digit.
fn editable(app: &App, parameter: &Parameter) -> String {
    let written = app.written(parameter).unwrap_or_default();
    match (parameter.field.range, written.parse()) {
        (Range::Real { .. }, Ok(value)) => exact_quantity(value, parameter.field.unit),
        (Range::Text { .. }, _) => text_of(&written),
        _ => written,
    }
}

/// Sets the selected parameter to the typed value.
pub fn accept_value(app: &mut App, typed: &str) -> Result<Vec<Effect>, String> {
    let Some(parameter) = app.parameter() else { return Ok(Vec::new()) };
    if typed == editable(app, parameter) {
        return Ok(Vec::new());
    }
    let allowed = parameter.field.allowed();
    let written =
        parameter.field.read_typed(typed).map_err(|error| format!("{error}; allowed: {allowed}"))?;
    let document = with_selected(app, &written)?;
    Ok(take_over(app, Ok(document)))
}

/// Sets the selected parameter to a value in the notation of the scene.
fn set_selected(app: &mut App, written: &str) -> Vec<Effect> {
    match with_selected(app, written) {
        Ok(document) => take_over(app, Ok(document)),
        Err(why) => refuse(app, why),
    }
}

/// The scene with another value of the selected parameter, in the notation of the scene; or why there is none.
fn with_selected(app: &App, written: &str) -> Result<Document, String> {
    let parameter = app.parameter().ok_or("no parameter is selected")?;
    let document = &app.edit.document;
    let number = || parse_quantity(written, parameter.field.unit).map_err(|error| error.to_string());
    let adhesion = document.scene().adhesion.unwrap_or_default();
    let changed = match parameter.setting {
        Setting::Field | Setting::Switch(_) | Setting::Heading => document.set(&parameter.path, written),
        Setting::WorkOfAdhesion => document.with_adhesion(adhesion.with_work(number()?)),
        Setting::RoughnessParameter(parameter) => {
            let value = number()?;
            match app.governing() {
                _ if adhesion.work.is_none() || adhesion.sets_amplitude() => {
                    document.with_adhesion(adhesion.with_parameter(parameter, value))
                }
                // The scene has γ alone, which follows from the parameter.
                Some(governing) => {
                    let undefined = || format!("{} is not defined without roughness", parameter.symbol());
                    let work = governing.work_for(parameter, value).ok_or_else(undefined)?;
                    document.with_adhesion(adhesion.with_work(work))
                }
                None => return Err("not before the scene is computed".to_owned()),
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
pub fn preview(app: &mut App) -> Vec<Effect> {
    let typed = app.prompt.as_ref().filter(|_| app.is_typing_value()).map(|prompt| prompt.line.text());
    let tried = typed.and_then(|typed| {
        let written = app.parameter()?.field.read_typed(typed).ok()?;
        with_selected(app, &written).ok()
    });
    let tried = tried.filter(|tried| tried.text() != app.edit.document.text() && is_previewed(tried));
    if tried.as_ref().map(Document::text) == app.tried.as_ref().map(|tried| tried.text.as_str()) {
        return Vec::new();
    }
    app.tried = tried.as_ref().map(tried_of);
    vec![Effect::Ask]
}

/// A document whose outcome alone is of interest.
pub fn tried_of(document: &Document) -> Tried {
    Tried { text: document.text().to_owned(), scene: scene_of(document) }
}

/// Switches the effect of the selected row on or off.
pub fn toggle_effect(app: &mut App) -> Vec<Effect> {
    [show_parameters(app), switch(app)].concat()
}

fn switch(app: &mut App) -> Vec<Effect> {
    let Some(effect) = app.parameter().and_then(|parameter| parameter.effect) else {
        return refuse(app, "no effect to switch; form, roughness, adhesion, loading have one".to_owned());
    };
    let document = &app.edit.document;
    let changed = if effect.is_on(document.scene()) {
        document.without(effect, &computed(app))
    } else {
        document.with(effect)
    };
    take_over(app, changed)
}

/// Values of the computed scene, which may replace others in the scene.
fn computed(app: &App) -> Computed {
    let governing = app.governing();
    Computed {
        work_of_adhesion: governing.and_then(|governing| governing.work_of_adhesion),
        kappa: governing.and_then(|governing| governing.kappa),
        elastic_energy_ratio: governing.and_then(|governing| governing.elastic_energy_ratio),
        rms_height: governing.and_then(|governing| governing.amplitude).map(|amplitude| amplitude.rms_height),
    }
}

fn refuse(app: &mut App, why: String) -> Vec<Effect> {
    app.message = Some(Message::Refused(why));
    Vec::new()
}

/// Sets a field; an invalid value leaves the scene unchanged.
pub fn change(app: &mut App, path: &str, value: &str) -> Vec<Effect> {
    let changed = app.edit.document.set(path, value);
    take_over(app, changed)
}

/// Makes a changed document the explored one, or states the reason why it is not allowed.
pub fn take_over(app: &mut App, changed: Result<Document, SceneErrors>) -> Vec<Effect> {
    match changed {
        Ok(document) => {
            let lost = app.edit.document.comments().saturating_sub(document.comments());
            let effects = adopt(app, document);
            if lost > 0 {
                let gone = if lost == 1 { "a comment is" } else { "comments are" };
                app.set_done(format!("{gone} gone with what was replaced: undo brings it all back"));
            }
            effects
        }
        Err(errors) => refuse(app, reasons(&errors)),
    }
}

/// Makes a document the explored one; undo returns to the former one.
pub fn adopt(app: &mut App, document: Document) -> Vec<Effect> {
    let before = std::mem::replace(&mut app.edit.document, document);
    app.edit.past.push(before);
    if app.edit.past.len() > UNDO_DEPTH {
        app.edit.past.remove(0);
    }
    app.edit.future.clear();
    renew(app)
}

/// Continues the last edit: its new result replaces the former one.
pub fn replace(app: &mut App, document: Document) -> Vec<Effect> {
    app.edit.document = document;
    app.edit.future.clear();
    renew(app)
}

/// Undoes the last edit, or redoes it.
pub fn undo(app: &mut App, back: bool) -> Vec<Effect> {
    let (from, to) = if back {
        (&mut app.edit.past, &mut app.edit.future)
    } else {
        (&mut app.edit.future, &mut app.edit.past)
    };
    let Some(document) = from.pop() else { return Vec::new() };
    let before = std::mem::replace(&mut app.edit.document, document);
    to.push(before.clone());
    if before.name() != app.edit.document.name() && app.is_changed(&before) {
        app.edit.left.insert(before.name().to_owned(), before);
    }
    renew(app)
}

/// Row of the field at a path, or of the group around it: the selection stays in place when rows come and go, and the
/// row that switched an effect off can switch the effect on again.
fn row_of(app: &App, path: &str) -> usize {
    let around = std::iter::successors(Some(path), |path| path.rsplit_once('.').map(|(group, _)| group));
    let row = |path: &str| app.edit.parameters.iter().position(|parameter| parameter.path == path);
    around
        .filter_map(row)
        .next()
        .unwrap_or(app.edit.selected)
        .min(app.edit.parameters.len().saturating_sub(1))
}

/// Requests the computation of the changed scene.
fn renew(app: &mut App) -> Vec<Effect> {
    let selected = app.parameter().map(|parameter| parameter.path.clone()).unwrap_or_default();
    // A scene left before is the present one again.
    let document = &app.edit.document;
    app.edit.left.retain(|_, left| left.name() != document.name() || left.scene() != document.scene());
    app.edit.parameters = parameters(&app.edit.document);
    select(app, row_of(app, &selected));
    app.edit.generation += 1;
    app.progress = Some(0);
    app.studies.edited = true;
    app.studies.failures.clear();
    app.studies.appraisal = Appraisal::default();
    for pane in Pane::ALL {
        (pane.row().renew)(app);
    }
    // Manual loading belongs to the former profile and contact.
    if app.manual.take().is_some() {
        app.set_done("the body is back on the scene's loading");
    }
    name_ghosts(app);
    vec![Effect::Ask]
}
