//! Edits of the scene. Each gives a new document and can be undone.

use crate::explorer::action::Task;
use crate::explorer::app::{App, Message};
use crate::explorer::editor::Edited;
use crate::explorer::layout::Layout;
use crate::explorer::pane::Pane;
use crate::explorer::parameters::{Parameter, Setting, replaced_by, text_of};
use crate::explorer::player::Player;
use crate::explorer::prompt::Purpose;
use crate::explorer::reading;
use crate::explorer::request::{CloseUpTarget, LineView};
use crate::explorer::snapshot::Preview;
use crate::explorer::studies::ensemble_key;
use crate::explorer::text_line::TextLine;
use crate::explorer::typed;
use asperity_contact::Move;
use asperity_data::{exact_quantity, parse_quantity};
use asperity_scene::fields::{Range, Step};
use asperity_scene::loading::{StageKind, loading_text, pressing_force, read_stage};
use asperity_scene::text::ron_float;
use asperity_scene::{Adhesion, Document, RoughnessParameter, SceneErrors, Solver};
use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};
use tui_input::InputRequest;

/// Moves the selection in the list of parameters by a number of rows, up to its ends.
pub fn move_selection(app: &mut App, rows: i32) {
    app.edit.move_selection(rows);
    show_parameters(app);
}

/// Selects the first or the last parameter.
pub fn go_to_end(app: &mut App, key: &KeyEvent) {
    let is_last = matches!(key.code, KeyCode::End | KeyCode::Char('G'));
    move_selection(app, if is_last { i32::MAX } else { i32::MIN });
}

/// Explores another scene from its beginning.
pub fn open(app: &mut App, document: Document) {
    if app.edit.is_unsaved() {
        app.edit.leave(app.edit.document.clone());
        app.set_done("unsaved changes kept; u returns to them");
    }
    app.play = Player::START;
    app.view.close_up = CloseUpTarget::WHOLE;
    app.view.profile = LineView::WHOLE;
    // The map of the scene is shown; a study stays loaded.
    app.map.of_study = false;
    adopt(app, document);
    app.edit.set_saved();
}

/// Opens the editor of the selected value; `first` is a first typed character, which replaces the
/// value.
pub fn edit_value(app: &mut App, first: Option<char>) {
    let Some(parameter) = app.edit.parameter() else {
        return;
    };
    match parameter.setting {
        _ if first.is_some() && !parameter.takes_number() => {
            let way = way_of_changing(parameter);
            app.set_done(way);
        }
        Setting::Heading => app.set_done(way_of_changing(parameter)),
        Setting::Field
        | Setting::RoughnessParameter(_)
        | Setting::WorkOfAdhesion
        | Setting::Reading(_) => {
            let text = editable(app, parameter);
            app.ask(Purpose::Value, &text);
            // No preview of an earlier edit.
            app.tried = None;
            app.studies.forget::<Preview>();
            if let Some(first) = first {
                edit_line(app, |line| line.insert(first.encode_utf8(&mut [0; 4])));
            }
        }
    }
    show_parameters(app);
}

/// Opens the editor of the selected value with the character of a key, which replaces the value.
pub fn start_value(app: &mut App, key: &KeyEvent) {
    if let KeyCode::Char(first) = key.code {
        edit_value(app, Some(first));
    }
}

/// Moves the cursor in the typed line, or deletes a part of it.
pub fn edit_by(app: &mut App, key: &KeyEvent) {
    let is_control = key.modifiers.contains(KeyModifiers::CONTROL);
    let request = match (key.code, is_control) {
        (KeyCode::Left, false) | (KeyCode::Char('b'), _) => InputRequest::GoToPrevChar,
        (KeyCode::Right, false) | (KeyCode::Char('f'), _) => InputRequest::GoToNextChar,
        (KeyCode::Left, true) => InputRequest::GoToPrevWord,
        (KeyCode::Right, true) => InputRequest::GoToNextWord,
        (KeyCode::Home, _) | (KeyCode::Char('a'), _) => InputRequest::GoToStart,
        (KeyCode::End, _) | (KeyCode::Char('e'), _) => InputRequest::GoToEnd,
        (KeyCode::Backspace, _) | (KeyCode::Char('h'), _) => InputRequest::DeletePrevChar,
        (KeyCode::Delete, _) | (KeyCode::Char('d'), _) => InputRequest::DeleteNextChar,
        (KeyCode::Char('w'), _) => InputRequest::DeletePrevWord,
        _ => return,
    };
    edit_line(app, |line| line.edit(request));
}

pub fn clear_line(app: &mut App) {
    edit_line(app, |line| line.edit(InputRequest::DeleteLine));
}

/// Edits the typed line and updates its preview or its list.
pub fn edit_line(app: &mut App, change: impl FnOnce(&mut TextLine)) {
    let Some(prompt) = &mut app.prompt else {
        return;
    };
    let before = prompt.line.text().to_owned();
    change(&mut prompt.line);
    if prompt.line.text() == before && prompt.line.left_out().is_none() {
        return;
    }
    (prompt.refused, prompt.paths) = (None, Vec::new());
    prompt.search(&app.edit.parameters);
    match prompt.purpose {
        Purpose::Value => preview(app),
        Purpose::Target => app.effects.push(Task::Study),
        _ => {}
    }
}

/// States how a parameter without a number is changed.
pub fn way_of_changing(parameter: &Parameter) -> String {
    let way = match (
        parameter.setting,
        parameter.field.step,
        parameter.field.range,
    ) {
        (Setting::Heading, ..) => "a group: its fields are in the rows below",
        (Setting::Reading(_), _, Range::Choice(_)) => "a choice: ← → change it",
        (_, Step::Choice, _) => "a choice: ← → change it",
        (.., Range::Text { .. }) => "a text: Enter types it",
        (.., Range::List { .. }) => "a list: Enter types it",
        _ => "several numbers: Enter types them",
    };
    format!("{} is {way}", parameter.name())
}

/// Selects the list of parameters if a small window hides it, so that no value changes unseen.
pub fn show_parameters(app: &mut App) {
    if Layout::of(app).pane(Pane::Parameters).is_none() {
        app.show(Pane::Parameters);
    }
}

pub fn step_value(app: &mut App, steps: i32, coarse: bool) {
    show_parameters(app);
    let Some(parameter) = app.edit.parameter() else {
        return;
    };
    let is_text =
        matches!(parameter.field.range, Range::Text { .. }) || parameter.path == "loading";
    if parameter.setting == Setting::Heading || is_text {
        return refuse(app, way_of_changing(parameter));
    }
    if let Setting::RoughnessParameter(of) = parameter.setting
        && app
            .governing()
            .is_some_and(|governing| governing.amplitude.is_none())
    {
        return refuse(app, undefined(of));
    }
    if let Some(given) = parameter.follows_from(app.edit.document.scene()) {
        let name = parameter.name();
        return refuse(
            app,
            format!("{name} follows from {given}; Enter types a value of its own"),
        );
    }
    let no_step = format!("no further step; allowed: {}", parameter.field.allowed());
    if parameter.field.step == Step::Choice {
        return match app
            .edit
            .document
            .with_next_choice(parameter.field, steps > 0)
        {
            Ok(Some(document)) => apply(app, Ok(document)),
            Ok(None) => refuse(app, no_step),
            Err(errors) => apply(app, Err(errors)),
        };
    }
    let Some(written) = app.written(parameter) else {
        return refuse(app, "the scene is still being computed".to_owned());
    };
    let length = app.edit.document.scene().length;
    match parameter.field.stepped_on(length, &written, steps, coarse) {
        Some(next) => set_selected(app, &next),
        None => refuse(app, no_step),
    }
}

/// The value of a parameter when its editor opens: in the shown unit, with all digits.
pub fn editable(app: &App, parameter: &Parameter) -> String {
    if let (Setting::Reading(index), Some(measured)) = (parameter.setting, &app.edit.measured) {
        return reading::OPTIONS[index].editable(&measured.options);
    }
    let written = app.written(parameter).unwrap_or_default();
    match parameter.field.range {
        _ if parameter.group == "loading" => {
            let loading = &app.edit.document.scene().loading;
            let stages = parameter
                .leg
                .map_or(loading.get(..), |leg| loading.get(leg..=leg));
            loading_text(stages.unwrap_or_default(), exact_quantity)
        }
        Range::Text { .. } => text_of(&written),
        _ => parameter
            .field
            .quantities(&written, exact_quantity)
            .unwrap_or(written),
    }
}

pub fn accept_value(app: &mut App, typed: &str) -> Result<(), String> {
    let Some(parameter) = app.edit.parameter() else {
        return Ok(());
    };
    if typed == editable(app, parameter) {
        return Ok(());
    }
    let document = with_typed(app, typed)?;
    // A loading that the contact does not follow is known once its preview has been computed.
    if let Some(why) = app
        .studies
        .failure::<Preview>()
        .filter(|_| app.tried.is_some())
    {
        return Err(why.to_owned());
    }
    apply(app, Ok(document));
    Ok(())
}

/// The scene with a typed value of the selected parameter, or the reason why it is refused. A stage
/// may be typed as any kind.
fn with_typed(app: &App, typed: &str) -> Result<Document, String> {
    let parameter = app.edit.parameter().ok_or("no parameter is selected")?;
    if let Setting::Reading(_) = parameter.setting {
        return Err("an option of reading is no part of the scene".to_owned());
    }
    let document = &app.edit.document;
    let typed = &typed::with_unit(app, parameter, typed);
    let Some(leg) = parameter.leg else {
        let written = parameter.field.read_typed(typed);
        let allowed = || parameter.field.allowed();
        return with_selected(
            app,
            &written.map_err(|error| format!("{error}; allowed: {}", allowed()))?,
        );
    };
    let mut stages = document.stages();
    let (kind, _) = StageKind::of(&stages[leg].1);
    let stage = read_stage(typed, Some(kind)).map_err(|error| error.to_string())?;
    match StageKind::of(&stage) {
        (same, Some(number)) if same == kind => with_selected(app, &ron_float(number)),
        _ => {
            stages[leg] = (None, stage);
            let changed = document
                .with_stages(&stages)
                .map_err(|errors| reasons(&errors))?;
            within_reach(app, changed)
        }
    }
}

/// Returns the scene unless it presses more than the present one and out of reach; otherwise the
/// reason.
fn within_reach(app: &App, changed: Document) -> Result<Document, String> {
    let force = pressing_force(&changed.scene().loading);
    let is_more = force > pressing_force(&app.edit.document.scene().loading);
    let solved = app.current().filter(|_| is_more);
    solved
        .and_then(|solved| solved.reach.refusal(Move::ToForce(force)))
        .map_or(Ok(changed), Err)
}

/// Sets the selected parameter to a value in the notation of the scene.
pub fn set_selected(app: &mut App, written: &str) {
    match with_selected(app, written) {
        Ok(document) => apply(app, Ok(document)),
        Err(why) => refuse(app, why),
    }
}

/// The scene with another value of the selected parameter, in the notation of the scene; or the
/// reason why it is refused.
fn with_selected(app: &App, written: &str) -> Result<Document, String> {
    let selected = app.edit.parameter().ok_or("no parameter is selected")?;
    let document = &app.edit.document;
    let number = || parse_quantity(written, selected.field.unit).map_err(|error| error.to_string());
    let adhesion = document.scene().adhesion;
    let changed = match selected.setting {
        Setting::Field | Setting::Heading | Setting::Reading(_) => {
            let other = replaced_by(&selected.path);
            let other =
                other.filter(|path| document.value(path).is_some_and(|value| value != "None"));
            let pair = |path: &str, value: &str| (path.to_owned(), value.to_owned());
            let replaced = other.map(|path| pair(path, "None"));
            document.set_all(
                &replaced
                    .into_iter()
                    .chain([pair(&selected.path, written)])
                    .collect::<Vec<_>>(),
            )
        }
        Setting::WorkOfAdhesion => {
            let work = number()?;
            document
                .with_adhesion(adhesion.map_or(Adhesion::by_work(work), |of| of.with_work(work)))
        }
        Setting::RoughnessParameter(parameter) => {
            let value = number()?;
            if !selected.field.range.contains(value) {
                let (field, allowed) = (selected.field, selected.field.allowed());
                return Err(format!(
                    "{} = {}: allowed: {allowed} ({})",
                    field.path,
                    ron_float(value),
                    field.name
                ));
            }
            match (
                adhesion.filter(|adhesion| adhesion.work().is_some()),
                app.governing(),
            ) {
                // The scene has γ, which follows from the parameter.
                (Some(adhesion), Some(governing)) => {
                    let work = governing
                        .work_for(parameter, value)
                        .ok_or_else(|| undefined(parameter))?;
                    document.with_adhesion(adhesion.with_work(work))
                }
                (Some(_), None) => return Err("the scene is still being computed".to_owned()),
                (None, _) => {
                    let by_parameter = Adhesion::by_parameter(parameter, value);
                    let changed =
                        adhesion.map_or(by_parameter, |of| of.with_parameter(parameter, value));
                    document.with_adhesion(changed)
                }
            }
        }
    };
    changed
        .map_err(|errors| reasons(&errors))
        .and_then(|changed| within_reach(app, changed))
}

fn undefined(parameter: RoughnessParameter) -> String {
    format!("{} is not defined without roughness", parameter.symbol())
}

/// Errors of values, without their places.
pub fn reasons(errors: &SceneErrors) -> String {
    errors
        .iter()
        .map(|error| error.what())
        .collect::<Vec<_>>()
        .join("; ")
}

/// Largest number of springs for a preview while a value is typed; the next character stops the
/// computation.
const MOST_SPRINGS_TRIED: u64 = 1 << 20;

/// Returns true if a scene is small enough for a preview, which the stepwise solver never is.
fn is_previewed(document: &Document) -> bool {
    let numerics = document.scene().numerics;
    numerics.points <= MOST_SPRINGS_TRIED && numerics.solver == Solver::Exact
}

/// Requests the curve for the value typed so far; no curve if the value is not allowed.
pub fn preview(app: &mut App) {
    let typed = app
        .prompt
        .as_ref()
        .filter(|_| app.is_typing_value())
        .map(|prompt| prompt.line.text());
    let tried = typed.and_then(|typed| with_typed(app, typed).ok());
    let tried =
        tried.filter(|tried| tried.text() != app.edit.document.text() && is_previewed(tried));
    if tried.as_ref().map(Document::text) == app.tried.as_ref().map(Document::text) {
        return;
    }
    app.tried = tried;
    app.effects.push(Task::Study);
}

/// Switches the effect of the selected row on or off.
pub fn toggle_effect(app: &mut App) {
    show_parameters(app);
    let Some(effect) = app.edit.parameter().and_then(|parameter| parameter.effect) else {
        return refuse(
            app,
            "no effect to switch; form, roughness, adhesion, loading have one".to_owned(),
        );
    };
    let document = &app.edit.document;
    let changed = if effect.is_on(document.scene()) {
        document.without(effect)
    } else {
        document.with(effect)
    };
    apply(app, changed)
}

pub fn refuse(app: &mut App, why: String) {
    app.message = Some(Message::Refused(why));
}

/// Sets a field; for an invalid value the scene stays unchanged and the reason is stated.
pub fn change(app: &mut App, path: &str, value: &str) {
    let changed = app.edit.document.set(path, value);
    apply(app, changed)
}

/// Draws another random profile with a seed of at most six digits, which can be read out to a
/// colleague. The seeds follow each other in a sequence that repeats none.
pub fn draw_seed(app: &mut App) {
    match app.edit.document.scene().seed() {
        Some(seed) => {
            let next = (seed % 1_000_000 * 7621 + 211_327) % 1_000_000;
            change(app, "roughness.seed", &next.to_string());
        }
        None => app.set_error("the scene has no random profile to draw anew"),
    }
}

/// Makes a changed document the explored one, or states why it is not allowed.
pub fn apply(app: &mut App, changed: Result<Document, SceneErrors>) {
    match changed {
        Ok(document) => {
            let lost = app
                .edit
                .document
                .comments()
                .saturating_sub(document.comments());
            // The words of a built-in scene go with the values that they describe.
            let are_own = !document.is_changed_built_in();
            adopt(app, document);
            if lost > 0 && are_own {
                let (comments, them) = if lost == 1 {
                    ("comment", "it")
                } else {
                    ("comments", "them")
                };
                app.set_done(format!(
                    "{lost} {comments} removed with the replaced value; u restores {them}"
                ));
            }
        }
        Err(errors) => refuse(app, reasons(&errors)),
    }
}

/// Makes a document the explored one; an undo returns to the former document.
pub fn adopt(app: &mut App, document: Document) {
    app.edit.adopt(document);
    after_edit(app);
}

/// Makes a document and a measured curve the explored ones, in one edit.
pub fn adopt_all(app: &mut App, edited: Edited) {
    app.edit.adopt_all(edited);
    after_edit(app);
}

/// Continues the last edit: its new result replaces the former one.
pub fn replace(app: &mut App, document: Document) {
    app.edit.replace(document);
    after_edit(app);
}

/// Undoes the last edit or, unless `back`, redoes the last undone edit; states the change.
pub fn undo(app: &mut App, back: bool) {
    let name = if back { "undo" } else { "redo" };
    let Some(what) = app.edit.undo(back) else {
        return app.set_done(format!("nothing to {name}"));
    };
    after_edit(app);
    if !matches!(app.message, Some(Message::Done(_))) {
        app.set_done(format!("{name}: {what}"));
    }
}

/// Drops what belongs to the former scene.
fn after_edit(app: &mut App) {
    app.message
        .take_if(|message| !matches!(message, Message::Done(_)));
    app.progress = Some(0);
    app.map.moving = false;
    let map = app.map.key(&app.edit.scene).unwrap_or_default();
    app.studies.keep(&[
        &map,
        app.edit.document.text(),
        &ensemble_key(&app.edit.scene),
    ]);
    // Manual loading belongs to the former profile and contact.
    if app.manual.take().is_some() {
        app.set_done("the body is back on the scene's loading");
    }
}
