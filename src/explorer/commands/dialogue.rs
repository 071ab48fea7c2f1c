//! Commands of prompts, which open, edit, accept and cancel a prompt.

use super::{accuracy, edit, files, manual, map_over, measured, profiles, target};
use crate::explorer::action::{OutputFile, Task};
use crate::explorer::app::App;
use crate::explorer::completion::common_start;
use crate::explorer::keys::bindings::{Context, KeyCommand, Row};
use crate::explorer::layout::{Layout, inside};
use crate::explorer::openable::Openable;
use crate::explorer::opening::CurveQuestion;
use crate::explorer::pane::Pane;
use crate::explorer::panes;
use crate::explorer::panes::row;
use crate::explorer::prompt::{Aim, COMMANDS, Prompt, Purpose, Topic};
use crate::explorer::text::on_one_line;
use asperity_scene::library::typed_path;
use asperity_scene::presets;
use crossterm::event::{KeyCode, KeyEvent};
use tui_input::InputRequest;

/// Name of the help. Its entries do nothing if the user chooses them.
const HELP: &str = "Help";

/// Shows the list of parameters, and begins a search in this list.
pub fn find_parameter(app: &mut App) {
    let before = app.view.pane;
    app.ask(Purpose::Parameter { before }, "");
    edit::show_parameters(app)
}

pub fn open_library(app: &mut App) {
    app.ask(Purpose::Open(Vec::new()), "");
    app.effects.push(Task::List);
}

pub fn listed(app: &mut App, entries: Vec<Openable>) {
    if let Some(prompt) = &mut app.prompt {
        prompt.purpose = Purpose::Open(entries);
        prompt.search(&app.edit);
    }
}

/// Opens the help. The help contains a description of the panes, all keys, and the notice of the
/// scene, for which a small window has no room.
pub fn open_help(app: &mut App) {
    let mut topics = Vec::new();
    let notice = on_one_line(&app.edit.document.scene().notice);
    if !notice.is_empty() {
        topics.push(Topic::read_only("This scene", &notice));
    }
    for pane in Pane::ALL {
        for (name, text) in panes::row(*pane).help {
            topics.push(Topic::read_only(name, text));
        }
    }
    topics.extend(app.config.bindings.rows().map(Topic::of));
    let help = Purpose::Topics {
        name: HELP,
        topics,
        is_typed: false,
    };
    app.ask(help, "");
}

/// Opens a list of all commands, of the parameters of the scene, and of the built-in scenes.
pub fn open_commands(app: &mut App) {
    let mut topics: Vec<Topic> = app.config.bindings.listed().map(Topic::of).collect();
    for (row, parameter) in app.edit.searchable().enumerate() {
        topics.push(Topic::of_parameter(row, parameter));
    }
    for pane in Pane::ALL.iter().filter(|pane| !pane.is_large()) {
        for (name, text) in panes::row(*pane).help {
            topics.push(Topic::of_pane(*pane, name, text));
        }
    }
    topics.extend(presets().iter().map(Topic::of_preset));
    topics.push(Topic::about());
    let commands = Purpose::Topics {
        name: COMMANDS,
        topics,
        is_typed: true,
    };
    app.ask(commands, "");
}

/// Begins a search in the help. The text that the user types next is the searched text.
pub fn search_help(app: &mut App) {
    if let Some(prompt) = &mut app.prompt
        && let Purpose::Topics { is_typed, .. } = &mut prompt.purpose
    {
        *is_typed = true;
    }
}

/// Moves the selection in the list of a prompt by a number of rows, downwards if the number is
/// positive.
pub fn select(app: &mut App, rows: i32) {
    if let Some(prompt) = &mut app.prompt {
        let last = prompt.found.len().saturating_sub(1);
        let row = prompt.selected.saturating_add_signed(rows as isize);
        prompt.selected = row.min(last);
    }
}

/// Moves the selection in the list of a prompt in the direction of the pressed key.
pub fn select_by(app: &mut App, key: &KeyEvent) {
    let rows = match key.code {
        KeyCode::Home | KeyCode::Char('g') => i32::MIN,
        KeyCode::End | KeyCode::Char('G') => i32::MAX,
        KeyCode::Up | KeyCode::Char('k' | 'p') => -1,
        _ => 1,
    };
    select(app, rows);
}

/// Moves the selection by a page, in the list of a prompt or in the list of parameters, or shows
/// the next or previous page of the selected pane. A page of a list has half as many entries as the
/// window has rows, because an entry may take two rows.
pub fn page(app: &mut App, key: &KeyEvent) {
    let rows = i32::from(Layout::of(app).body().height / 2).max(1);
    let rows = if key.code == KeyCode::PageUp {
        -rows
    } else {
        rows
    };
    if app.prompt.is_some() {
        select(app, rows)
    } else if is_paged(app.view.pane) {
        turn_page(app, rows > 0)
    } else {
        edit::move_selection(app, rows)
    }
}

/// Returns true if a list is open, or if the selected pane has several pages.
pub fn has_pages(app: &App) -> bool {
    app.prompt.is_some() || is_paged(app.view.pane)
}

/// Returns true for a pane whose content may be divided into pages.
fn is_paged(pane: Pane) -> bool {
    matches!(pane, Pane::Trust | Pane::Sensitivity)
}

/// Shows the next or the previous page of the selected pane.
fn turn_page(app: &mut App, is_next: bool) {
    let pane = app.view.pane;
    let Some(area) = Layout::of(app).pane(pane) else {
        return;
    };
    let last = (row(pane).pages)(app, inside(area).as_size()) - 1;
    let page = app.view.page.min(last);
    app.view.page = if is_next {
        (page + 1).min(last)
    } else {
        page.saturating_sub(1)
    };
}

/// Accepts the typed line or the selected row, or answers a question with yes. If a line is
/// refused, the prompt stays open with this line and the reason.
pub fn accept(app: &mut App) {
    let Some(mut prompt) = app.prompt.take() else {
        return;
    };
    if let Purpose::Topics {
        name: HELP,
        is_typed: is_typed @ true,
        ..
    } = &mut prompt.purpose
    {
        // The search of the help ends here, but its results stay visible.
        *is_typed = false;
        app.prompt = Some(prompt);
        return;
    }
    if let Err(why) = accept_prompt(app, &prompt) {
        app.prompt = Some(Prompt {
            refused: Some(why),
            ..prompt
        });
    }
}

/// Performs the purpose of the prompt. Returns the reason if this is not possible.
fn accept_prompt(app: &mut App, prompt: &Prompt) -> Result<(), String> {
    let typed = prompt.line.text();
    match &prompt.purpose {
        Purpose::Value if measured::is_option(app) => measured::accept_option(app, typed),
        Purpose::Value if profiles::is_selected(app) => profiles::accept(app, typed),
        Purpose::Value => edit::accept_value(app, typed),
        Purpose::Target => target::accept(app, typed),
        Purpose::Map => map_over::accept(app, typed),
        Purpose::SavePlan => files::save_plan(app, typed_path(typed)),
        Purpose::Move => manual::accept_target(app, typed),
        Purpose::Tolerance => accuracy::accept_tolerance(app, typed),
        Purpose::Fit => measured::accept_fit(app, typed),
        Purpose::Save { then_quit } => files::save(app, typed_path(typed), *then_quit),
        Purpose::Export => files::export(app, typed),
        Purpose::Open(_) => accept_openable(app, prompt),
        Purpose::Curve(question) => accept_curve_option(app, question, typed),
        Purpose::Parameter { .. } => {
            let row = prompt.choice().ok_or(NOTHING_FITS)?;
            show_parameter(app, row);
            Ok(())
        }
        Purpose::Topics { topics, .. } => {
            let index = prompt.choice().ok_or(NOTHING_FITS)?;
            let topic = topics.get(index).ok_or(NOTHING_FITS)?;
            accept_topic(app, topic);
            Ok(())
        }
        Purpose::Overwrite { file, .. } => {
            app.effects.push(Task::Write(OutputFile {
                overwrite: true,
                ..file.clone()
            }));
            Ok(())
        }
        Purpose::Leave => Ok(()),
    }
}

const NOTHING_FITS: &str = "nothing in the list fits";

/// Opens the selected entry of the list. If no entry matches the typed text, the text is taken as a
/// path, which is then opened.
fn accept_openable(app: &mut App, prompt: &Prompt) -> Result<(), String> {
    match prompt.openable() {
        Some(Openable::Scene(entry)) => {
            let document = entry.document.clone();
            edit::open(app, document.map_err(|errors| errors.to_string())?);
            return Ok(());
        }
        Some(Openable::File(file)) => {
            let path = file.path.to_string_lossy().into_owned();
            app.effects.push(Task::Open(path));
            return Ok(());
        }
        None => {}
    }
    let typed = prompt.line.text().trim();
    if typed.is_empty() {
        return Err("type a name or a path".to_owned());
    }
    let path = typed_path(typed).to_string_lossy().into_owned();
    app.effects.push(Task::Open(path));
    Ok(())
}

/// Opens a measured curve with the typed value of the option that was missing.
fn accept_curve_option(app: &mut App, question: &CurveQuestion, typed: &str) -> Result<(), String> {
    if typed.trim().is_empty() {
        return Err(format!("type {}", question.option().field.meaning));
    }
    let options = question.option().with(&question.options, typed)?;
    app.effects.push(Task::OpenCurve(CurveQuestion {
        options,
        ..question.clone()
    }));
    Ok(())
}

/// Selects the parameter with this index among the parameters that a search can find.
fn show_parameter(app: &mut App, row: usize) {
    app.edit.reveal(row);
    app.show(Pane::Parameters);
}

fn accept_topic(app: &mut App, topic: &Topic) {
    match &topic.aim {
        Aim::Nothing => {}
        Aim::Command(row) => choose(app, KeyCommand { row, key: None }),
        Aim::Parameter(row) => show_parameter(app, *row),
        Aim::Show(pane) => app.show(*pane),
        Aim::Open(name) => app.effects.push(Task::Open(name.clone())),
    }
}

pub fn cancel(app: &mut App) {
    match app.prompt.take().map(|prompt| prompt.purpose) {
        Some(Purpose::Value) => edit::preview(app),
        Some(Purpose::Target) => app.effects.push(Task::Study),
        Some(Purpose::Parameter { before }) => app.view.pane = before,
        _ => {}
    }
}

/// Chooses a command from the list. If its key is not valid in the selected pane, a pane in which
/// the key is valid is shown first.
fn choose(app: &mut App, command: KeyCommand) {
    let is_valid_here = command.row.contexts.contains(&app.keys());
    if !is_valid_here {
        app.show(pane_of(command.row));
    }
    app.chosen = Some(command);
}

/// Returns a pane in which the key of a command is valid.
fn pane_of(row: &Row) -> Pane {
    if row.contexts.contains(&Context::Parameters) {
        Pane::Parameters
    } else if row.contexts.contains(&Context::Explore) {
        Pane::Force
    } else {
        Pane::Map
    }
}

/// Paths of the parameters whose values contain names of files.
const WITH_FILES: [&str; 4] = [
    "roughness",
    "roughness.file",
    "roughness.further_files",
    "roughness.opposite",
];

/// Returns the path that the user is typing: the whole line or, if the line is the value of a
/// parameter, the text after its last quotation mark. In such a value, the path is relative to the
/// folder of the scene.
fn typed_in_line(app: &App) -> Option<String> {
    let prompt = app.prompt.as_ref()?;
    let text = prompt.line.text().trim_start();
    match prompt.purpose {
        Purpose::Save { .. } | Purpose::SavePlan | Purpose::Export | Purpose::Open(_) => {
            Some(text.to_owned())
        }
        Purpose::Value if WITH_FILES.contains(&app.edit.parameter()?.path.as_str()) => {
            let path = text.rsplit('"').next().unwrap_or(text);
            let path = app.edit.document.resolve(path);
            Some(path.to_string_lossy().into_owned())
        }
        _ => None,
    }
}

pub fn can_complete(app: &App) -> bool {
    is_map(app) || typed_in_line(app).is_some()
}

/// Returns true if the user is typing the axes of a map, whose rows can be changed.
fn is_map(app: &App) -> bool {
    let prompt = app.prompt.as_ref();
    prompt.is_some_and(|prompt| matches!(prompt.purpose, Purpose::Map))
}

/// Requests the paths that begin with the typed path, as a task. In the prompt of a map, goes to
/// the next row.
pub fn complete(app: &mut App) {
    if is_map(app) {
        return map_over::next_row(app);
    }
    if let Some(path) = typed_in_line(app) {
        app.effects.push(Task::Complete(path));
    }
}

/// Completes the typed path with all characters that the found paths have in common. If several
/// paths were found, they are shown.
pub fn completed(app: &mut App, paths: Vec<String>) {
    let Some(typed) = typed_in_line(app) else {
        return;
    };
    let common = common_start(&paths);
    if let Some(rest) = common.strip_prefix(&typed) {
        edit::edit_line(app, |line| {
            line.edit(InputRequest::GoToEnd);
            line.insert(rest);
        });
    }
    let Some(prompt) = &mut app.prompt else {
        return;
    };
    prompt.refused = if paths.is_empty() {
        Some("no file or folder begins so".to_owned())
    } else {
        None
    };
    prompt.paths = if paths.len() > 1 { paths } else { Vec::new() };
}
