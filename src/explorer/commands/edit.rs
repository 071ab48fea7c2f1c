//! Edits of the scene. Each edit makes a new document, and the user can undo it.

use crate::explorer::action::Task;
use crate::explorer::app::{App, Message};
use crate::explorer::curve_options;
use crate::explorer::editor::Edited;
use crate::explorer::layout::Layout;
use crate::explorer::pane::Pane;
use crate::explorer::parameters::{Parameter, Setting, replaced_by, text_of};
use crate::explorer::player::Player;
use crate::explorer::prompt::Purpose;
use crate::explorer::request::{CloseUpTarget, LineView};
use crate::explorer::snapshot::Preview;
use crate::explorer::studies::{ensemble_key, profiles_key};
use crate::explorer::text_line::TextLine;
use crate::explorer::typed;
use asperity_contact::Move;
use asperity_data::{exact_quantity, parse_quantity};
use asperity_scene::fields::{Field, Range, Step};
use asperity_scene::loading::{StageKind, loading_text, pressing_force, read_stage};
use asperity_scene::text::ron_float;
use asperity_scene::{Adhesion, Document, RoughnessParameter, SceneErrors, Solver};
use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};
use tui_input::InputRequest;

/// Moves the selection in the list of parameters by a number of rows, downwards if the number is
/// positive. The selection stays between the first and the last row.
pub fn move_selection(app: &mut App, rows: i32) {
    app.edit.move_selection(rows);
    show_parameters(app);
}

/// Selects the first or the last parameter, depending on the pressed key.
pub fn go_to_end(app: &mut App, key: &KeyEvent) {
    let is_last = matches!(key.code, KeyCode::End | KeyCode::Char('G'));
    move_selection(app, if is_last { i32::MAX } else { i32::MIN });
}

/// Opens another scene, and starts its animation at the beginning.
pub fn open(app: &mut App, document: Document) {
    if app.edit.is_unsaved() {
        app.edit.leave(app.edit.document.clone());
        app.set_done("unsaved changes kept; u returns to them");
    }
    app.play = Player::START;
    app.view.close_up = CloseUpTarget::WHOLE;
    app.view.profile = LineView::WHOLE;
    // From now on the live map of the scene is shown. The map of a study stays loaded.
    app.map.of_study = false;
    let opened = Edited {
        document,
        measured: app.edit.measured.clone(),
        path: None,
        profiles: app.edit.profiles,
    };
    adopt_all(app, opened);
    app.play_of_path = None;
    app.edit.set_saved();
    close_other_map(app);
    // The results before the change would be those of another scene.
    app.studies.forget_former();
}

/// Closes a map that the present scene does not have, for example because it lacks the number of an
/// axis.
fn close_other_map(app: &mut App) {
    if app.map.plan(app.edit.document.scene()).is_err() {
        app.map.chosen = None;
        if app.view.large == Some(Pane::Map) {
            app.show_force_curve();
        }
    }
}

/// Opens the editor for the value of the selected parameter. If the user has begun to type with the
/// character `first`, this character replaces the value.
pub fn edit_value(app: &mut App, first: Option<char>) {
    let Some(parameter) = app.edit.parameter() else {
        return;
    };
    let is_no_number = first.is_some() && !parameter.takes_number();
    if is_no_number || parameter.setting == Setting::Heading {
        app.set_done(way_of_changing(parameter));
    } else {
        let text = editable(app, parameter);
        app.ask(Purpose::Value, &text);
        // The preview of an earlier edit is no longer valid.
        app.tried = None;
        app.studies.forget::<Preview>();
        if let Some(first) = first {
            edit_line(app, |line| line.insert(first.encode_utf8(&mut [0; 4])));
        }
    }
    show_parameters(app);
}

/// Opens the editor for the value of the selected parameter. The character of the pressed key
/// replaces the value.
pub fn start_value(app: &mut App, key: &KeyEvent) {
    if let KeyCode::Char(first) = key.code {
        edit_value(app, Some(first));
    }
}

/// Moves the cursor in the typed line, or deletes text in it, depending on the pressed key.
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

/// Changes the line that the user is typing, then updates the preview of its value or the list
/// below it.
pub fn edit_line(app: &mut App, change: impl FnOnce(&mut TextLine)) {
    let Some(prompt) = &mut app.prompt else {
        return;
    };
    let before = prompt.line.text().to_owned();
    change(&mut prompt.line);
    if prompt.line.text() == before && prompt.line.left_out().is_none() {
        return;
    }
    prompt.refused = None;
    prompt.paths.clear();
    prompt.search(&app.edit);
    match prompt.purpose {
        Purpose::Value => preview(app),
        Purpose::Target => app.effects.push(Task::Study),
        _ => {}
    }
}

/// Returns a sentence that explains how the user changes a parameter that is not a number.
pub fn way_of_changing(parameter: &Parameter) -> String {
    let range = parameter.field.range;
    let is_option = matches!(parameter.setting, Setting::CurveOption(_));
    let is_choice =
        parameter.field.step == Step::Choice || is_option && matches!(range, Range::Choice(_));
    let way = if parameter.setting == Setting::Heading {
        "a group: its fields are in the rows below"
    } else if is_choice {
        "a choice: ← → change it"
    } else if matches!(range, Range::Text { .. }) {
        "a text: Enter types it"
    } else if matches!(range, Range::List { .. }) {
        "a list: Enter types it"
    } else {
        "several numbers: Enter types them"
    };
    format!("{} is {way}", parameter.name())
}

/// Shows and selects the list of parameters if a small window hides it. The user then sees which
/// value changes.
pub fn show_parameters(app: &mut App) {
    if Layout::of(app).pane(Pane::Parameters).is_none() {
        app.show(Pane::Parameters);
    }
}

/// Changes the value of the selected parameter by a number of steps, which are large if `coarse` is
/// true. If a step is not possible, a message states the reason.
pub fn step_value(app: &mut App, steps: i32, coarse: bool) {
    show_parameters(app);
    let Some(parameter) = app.edit.parameter() else {
        return;
    };
    if let Some(why) = refusal_of_step(app, parameter) {
        return refuse(app, why);
    }
    let no_step = format!("no further step; allowed: {}", parameter.field.allowed());
    let document = &app.edit.document;
    if parameter.field.step == Step::Choice {
        return match document.with_next_choice(parameter.field, steps > 0) {
            Ok(Some(document)) => apply(app, Ok(document)),
            Ok(None) => refuse(app, no_step),
            Err(errors) => apply(app, Err(errors)),
        };
    }
    let Some(written) = app.written(parameter) else {
        return refuse(app, STILL_COMPUTED.to_owned());
    };
    let length = document.scene().length;
    match parameter.field.stepped_on(length, &written, steps, coarse) {
        Some(next) => set_selected(app, &next),
        None => refuse(app, no_step),
    }
}

/// Returns the reason why the value of a parameter cannot be changed in steps; `None` if it can.
fn refusal_of_step(app: &App, parameter: &Parameter) -> Option<String> {
    let is_text = matches!(parameter.field.range, Range::Text { .. });
    if parameter.setting == Setting::Heading || is_text || parameter.path == "loading" {
        return Some(way_of_changing(parameter));
    }
    if let Setting::RoughnessParameter(roughness_parameter) = parameter.setting
        && let Some(governing) = app.governing()
        && governing.amplitude.is_none()
    {
        return Some(undefined(roughness_parameter));
    }
    let given = parameter.follows_from(app.edit.document.scene())?;
    let name = parameter.name();
    Some(format!(
        "{name} follows from {given}; Enter types a value of its own"
    ))
}

/// Returns the text that the user edits: the value in the unit that the list of parameters shows,
/// with all digits.
pub fn editable(app: &App, parameter: &Parameter) -> String {
    if let Setting::CurveOption(index) = parameter.setting
        && let Some(measured) = &app.edit.measured
    {
        return curve_options::OPTIONS[index].editable(&measured.options);
    }
    if parameter.group == "loading" {
        let loading = &app.edit.document.scene().loading;
        let stages = match parameter.stage {
            Some(index) => loading.get(index..=index),
            None => Some(&loading[..]),
        };
        return loading_text(stages.unwrap_or_default(), exact_quantity);
    }
    let written = app.written(parameter).unwrap_or_default();
    if let Range::Text { .. } = parameter.field.range {
        return text_of(&written);
    }
    let quantities = parameter.field.quantities(&written, exact_quantity);
    quantities.unwrap_or(written)
}

pub fn accept_value(app: &mut App, typed: &str) -> Result<(), String> {
    let Some(parameter) = app.edit.parameter() else {
        return Ok(());
    };
    if typed == editable(app, parameter) {
        return Ok(());
    }
    let document = with_typed(app, typed)?;
    // The preview has computed the scene with this value. If it has failed, the contact cannot
    // follow the loading.
    if app.tried.is_some()
        && let Some(why) = app.studies.failure::<Preview>()
    {
        return Err(why.to_owned());
    }
    app.edit.note_edited_row();
    apply(app, Ok(document));
    Ok(())
}

/// Returns the scene with the typed value of the selected parameter, or the reason why the value is
/// refused. For a loading stage, the user may type a stage of any kind.
fn with_typed(app: &App, typed: &str) -> Result<Document, String> {
    let parameter = app.edit.parameter().ok_or("no parameter is selected")?;
    if let Setting::CurveOption(_) | Setting::Profiles = parameter.setting {
        return Err("this row is no part of the scene".to_owned());
    }
    let typed = &typed::with_unit(app, parameter, typed);
    if let Some(index) = parameter.stage {
        return with_typed_stage(app, index, typed);
    }
    match parameter.field.read_typed(typed) {
        Ok(written) => with_selected(app, &written),
        Err(error) => Err(format!("{error}; allowed: {}", parameter.field.allowed())),
    }
}

/// Returns the scene in which the typed stage replaces the loading stage `stage`. If the user types
/// only a number, the kind of the stage does not change.
fn with_typed_stage(app: &App, index: usize, typed: &str) -> Result<Document, String> {
    let document = &app.edit.document;
    let mut stages = document.stages();
    let (present_kind, _) = StageKind::of(&stages[index].1);
    let stage = read_stage(typed, Some(present_kind)).map_err(|error| error.to_string())?;
    let (kind, number) = StageKind::of(&stage);
    if let Some(number) = number
        && kind == present_kind
    {
        return with_selected(app, &ron_float(number));
    }
    stages[index] = (None, stage);
    let changed = document.with_stages(&stages);
    within_reach(app, changed.map_err(|errors| reasons(&errors))?)
}

/// Returns the changed scene. If the changed scene presses with a larger force than the present
/// scene, and the contact cannot reach this force, returns an error with the reason.
fn within_reach(app: &App, changed: Document) -> Result<Document, String> {
    let force = pressing_force(&changed.scene().loading);
    let present_force = pressing_force(&app.edit.document.scene().loading);
    if force > present_force
        && let Some(solved) = app.current()
        && let Some(why) = solved.reach.refusal(Move::ToForce(force))
    {
        return Err(why);
    }
    Ok(changed)
}

/// Sets the selected parameter to the value `written`, which is in the notation of the scene file.
pub fn set_selected(app: &mut App, written: &str) {
    match with_selected(app, written) {
        Ok(document) => {
            app.edit.note_edited_row();
            apply(app, Ok(document))
        }
        Err(why) => refuse(app, why),
    }
}

/// Returns the scene with another value of the selected parameter, or the reason why the value is
/// refused. The value is written as in the scene file.
fn with_selected(app: &App, written: &str) -> Result<Document, String> {
    let selected = app.edit.parameter().ok_or("no parameter is selected")?;
    let document = &app.edit.document;
    let changed = match selected.setting {
        Setting::Field | Setting::Heading | Setting::CurveOption(_) | Setting::Profiles => {
            with_field(document, &selected.path, written)
        }
        Setting::WorkOfAdhesion => {
            let work = parse_number(selected, written)?;
            let adhesion = match document.scene().adhesion {
                Some(adhesion) => adhesion.with_work(work),
                None => Adhesion::by_work(work),
            };
            document.with_adhesion(adhesion)
        }
        Setting::RoughnessParameter(parameter) => {
            let value = parse_number(selected, written)?;
            check_range(selected.field, value)?;
            document.with_adhesion(with_roughness_parameter(app, parameter, value)?)
        }
    };
    let changed = changed.map_err(|errors| reasons(&errors))?;
    within_reach(app, changed)
}

/// Returns the number in a value that is written as in the scene file.
fn parse_number(parameter: &Parameter, written: &str) -> Result<f64, String> {
    parse_quantity(written, parameter.field.unit).map_err(|error| error.to_string())
}

/// Returns the scene with another value of a field. If this field excludes another one (as rms
/// height and rms gradient exclude each other), the other field loses its value.
fn with_field(document: &Document, path: &str, written: &str) -> Result<Document, SceneErrors> {
    let mut values = Vec::new();
    if let Some(replaced) = replaced_by(path)
        && document
            .value(replaced)
            .is_some_and(|value| value != "None")
    {
        values.push((replaced.to_owned(), "None".to_owned()));
    }
    values.push((path.to_owned(), written.to_owned()));
    document.set_all(&values)
}

/// Returns an error if a number is outside the range of its field.
fn check_range(field: &Field, value: f64) -> Result<(), String> {
    if field.range.contains(value) {
        return Ok(());
    }
    let value = ron_float(value);
    Err(format!(
        "{} = {value}: allowed: {} ({})",
        field.path,
        field.allowed(),
        field.name
    ))
}

/// Returns the adhesion of the scene with another value of κ or e_el/γ (`parameter`). If the scene
/// states γ, the returned adhesion also states γ, computed from the new value.
fn with_roughness_parameter(
    app: &App,
    parameter: RoughnessParameter,
    value: f64,
) -> Result<Adhesion, String> {
    let Some(adhesion) = app.edit.document.scene().adhesion else {
        return Ok(Adhesion::by_parameter(parameter, value));
    };
    if adhesion.work().is_none() {
        return Ok(adhesion.with_parameter(parameter, value));
    }
    let governing = app.governing().ok_or(STILL_COMPUTED)?;
    match governing.work_for(parameter, value) {
        Some(work) => Ok(adhesion.with_work(work)),
        None => Err(undefined(parameter)),
    }
}

/// Reason for refusing a change that depends on the outcome of the present scene.
pub(super) const STILL_COMPUTED: &str = "the scene is still being computed";

fn undefined(parameter: RoughnessParameter) -> String {
    format!("{} is not defined without roughness", parameter.symbol())
}

/// Joins the messages of all errors in values of a scene. The positions of the errors in the file
/// are left out.
pub fn reasons(errors: &SceneErrors) -> String {
    errors
        .iter()
        .map(|error| error.what())
        .collect::<Vec<_>>()
        .join("; ")
}

/// Largest number of springs for which a preview is computed while the user types a value. Each
/// typed character stops the preview of the previous text.
const MOST_SPRINGS_TRIED: u64 = 1 << 20;

/// Returns true if a preview of the scene is computed. This is the case if the scene is small
/// enough and uses the exact solver, because the stepwise solver is too slow.
fn is_previewed(document: &Document) -> bool {
    let numerics = document.scene().numerics;
    numerics.points <= MOST_SPRINGS_TRIED && numerics.solver == Solver::Exact
}

/// Requests a preview of the curve for the value typed so far. If the value is not allowed, the
/// preview is removed.
pub fn preview(app: &mut App) {
    let tried = tried(app);
    if tried.as_ref().map(Document::text) == app.tried.as_ref().map(Document::text) {
        return;
    }
    app.tried = tried;
    app.effects.push(Task::Study);
}

/// Returns the scene with the value typed so far; `None` if the value is not allowed, changes
/// nothing, or gives a scene that is too large for a preview.
fn tried(app: &App) -> Option<Document> {
    if !app.is_typing_value() {
        return None;
    }
    let typed = app.prompt.as_ref()?.line.text();
    let tried = with_typed(app, typed).ok()?;
    let is_new = tried.text() != app.edit.document.text();
    if is_new && is_previewed(&tried) {
        Some(tried)
    } else {
        None
    }
}

/// Switches the part of the scene on or off to which the selected row belongs: the form, the
/// roughness, the adhesion or the loading.
pub fn toggle_effect(app: &mut App) {
    show_parameters(app);
    let Some(effect) = app.edit.parameter().and_then(|parameter| parameter.effect) else {
        let why = "no effect to switch; form, roughness, adhesion, loading have one";
        return refuse(app, why.to_owned());
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

/// Sets a field to a value. If the value is not allowed, the scene stays unchanged and a message
/// states the reason.
pub fn change(app: &mut App, path: &str, value: &str) {
    let changed = app.edit.document.set(path, value);
    apply(app, changed)
}

/// Draws another random profile by changing the seed. The next seed follows from the present one,
/// and no seed returns before all others have been used. Seeds have at most six digits, so that
/// users can easily read them to each other.
pub fn draw_seed(app: &mut App) {
    match app.edit.document.scene().seed() {
        Some(seed) => {
            let next = (seed % 1_000_000 * 7621 + 211_327) % 1_000_000;
            change(app, "roughness.seed", &next.to_string());
        }
        None => app.set_error("the scene has no random profile to draw anew"),
    }
}

/// Makes the changed document the explored scene. If the change is not allowed, a message states
/// the reason.
pub fn apply(app: &mut App, changed: Result<Document, SceneErrors>) {
    let document = match changed {
        Ok(document) => document,
        Err(errors) => return refuse(app, reasons(&errors)),
    };
    let before = app.edit.document.comments();
    let lost = before.saturating_sub(document.comments());
    // The comments of a built-in scene describe the values that the user now changes. Therefore
    // they are dropped without a message.
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

/// Makes a document the explored scene. Undo returns to the previous document.
pub fn adopt(app: &mut App, document: Document) {
    app.edit.adopt(document);
    after_edit(app);
}

/// Makes a document and a measured curve the explored scene and curve, in one edit.
pub fn adopt_all(app: &mut App, edited: Edited) {
    app.edit.adopt_all(edited);
    after_edit(app);
}

/// Extends the last edit, so that it results in `document`. One undo then reverts both changes.
pub fn replace(app: &mut App, document: Document) {
    app.edit.replace(document);
    after_edit(app);
}

/// Undoes the last edit or move if `back` is true; otherwise redoes the one that was undone last. A
/// message states what has changed.
pub fn undo(app: &mut App, back: bool) {
    let name = if back { "undo" } else { "redo" };
    let before = app.edit.generation;
    let name_before = app.edit.document.name().to_owned();
    let Some(what) = app.edit.undo(back) else {
        return app.set_done(format!("nothing to {name}"));
    };
    app.play_of_path = None;
    let is_other_scene = app.edit.generation != before;
    if is_other_scene {
        after_edit(app);
        if app.edit.document.name() != name_before {
            app.studies.forget_former();
        }
    }
    if !matches!(app.message, Some(Message::Done(_))) {
        app.set_done(format!("{name}: {what}"));
    }
}

/// Removes everything that belongs to the scene before the edit.
fn after_edit(app: &mut App) {
    app.message
        .take_if(|message| !matches!(message, Message::Done(_)));
    app.progress = Some(0);
    app.map.moving = false;
    let live_map = app.map.key(&app.edit.scene).unwrap_or_default();
    let squares = profiles_key(&app.edit.scene);
    let profiles = ensemble_key(app.edit.count_profiles(), &app.edit.scene);
    let preview = app.edit.document.text();
    app.studies.keep(&[&live_map, preview, &profiles, &squares]);
}
