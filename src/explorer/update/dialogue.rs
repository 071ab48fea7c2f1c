//! Prompts: what opens, edits, accepts and cancels them.

use super::{Effect, accuracy, edit, files, measured, movement};
use crate::explorer::action::OutputFile;
use crate::explorer::app::App;
use crate::explorer::completion::common_start;
use crate::explorer::keys::{Command, Context};
use crate::explorer::pane::Pane;
use crate::explorer::prompt::{Prompt, Purpose};
use crate::explorer::view::help_end;
use crate::scene::{Entry, typed_path};
use tui_input::InputRequest;

/// Opens the search of the list of parameters, in its pane.
pub fn find_parameter(app: &mut App) {
    app.ask(Purpose::Parameter { before: app.view.pane }, "");
    edit::show_parameters(app)
}

pub fn open_library(app: &mut App) {
    app.ask(Purpose::Scene(Vec::new()), "");
    app.effects.push(Effect::List);
}

pub fn listed(app: &mut App, entries: Vec<Entry>) {
    if let Some(prompt) = &mut app.prompt {
        prompt.purpose = Purpose::Scene(entries);
        prompt.search(&app.edit.parameters);
    }
}

/// Moves the selection of a list, or scrolls the help by a line.
pub fn select(app: &mut App, rows: i32) {
    let is_help = app.prompt.as_ref().is_some_and(|prompt| matches!(prompt.purpose, Purpose::Help));
    let end = is_help.then(|| usize::from(help_end(app)));
    let Some(prompt) = &mut app.prompt else { return };
    let last = end.unwrap_or(prompt.found.len().saturating_sub(1));
    prompt.selected = prompt.selected.min(last).saturating_add_signed(rows as isize).min(last);
}

/// Accepts the line, the selected row, or the question. A refused line stays, with the reason.
pub fn accept(app: &mut App) {
    let Some(prompt) = app.prompt.take() else { return };
    if let Err(why) = accept_prompt(app, &prompt) {
        app.prompt = Some(Prompt { refused: Some(why), ..prompt });
    }
}

fn accept_prompt(app: &mut App, prompt: &Prompt) -> Result<(), String> {
    let typed = prompt.line.text();
    let nothing = || "nothing in the list fits".to_owned();
    match &prompt.purpose {
        Purpose::Value => return edit::accept_value(app, typed),
        Purpose::Force => return movement::accept_force(app, typed),
        Purpose::Tolerance => return accuracy::accept_tolerance(app, typed),
        Purpose::Fit => return measured::accept_fit(app, typed),
        Purpose::Save { then_quit } => return files::save(app, typed_path(typed), *then_quit),
        Purpose::Export => return files::export(app, typed_path(typed)),
        Purpose::Scene(_) => match prompt.scene() {
            Some(entry) => edit::open_read(app, entry.document.clone()),
            None if typed.trim().is_empty() => return Err("type a name or a path".to_owned()),
            // The path of a scene, or of a study.
            None => {
                let path = typed_path(typed.trim()).to_string_lossy().into_owned();
                app.effects.push(Effect::Open(path));
            }
        },
        Purpose::Parameter { .. } => {
            app.edit.select(prompt.choice().ok_or_else(nothing)?);
            app.show(Pane::Parameters);
        }
        Purpose::Command(commands) => {
            let listed = prompt.choice().and_then(|index| commands.get(index)).ok_or_else(nothing)?;
            choose(app, Command { row: listed.row, character: None });
        }
        Purpose::Overwrite(file) => {
            app.effects.push(Effect::Write(OutputFile { overwrite: true, ..file.clone() }));
        }
        Purpose::Leave | Purpose::Help => {}
    }
    Ok(())
}

pub fn cancel(app: &mut App) {
    match app.prompt.take().map(|prompt| prompt.purpose) {
        Some(Purpose::Value) => edit::preview(app),
        Some(Purpose::Parameter { before }) => app.view.pane = before,
        _ => {}
    }
}

/// Chooses a command of the list, in a pane where its key is valid.
fn choose(app: &mut App, command: Command) {
    let is_valid = |context: Context| command.row.contexts.contains(&context);
    match app.keys() {
        here if is_valid(here) => {}
        _ if is_valid(Context::Parameters) => app.show(Pane::Parameters),
        _ if is_valid(Context::Explore) => app.show(Pane::Force),
        _ => app.show(Pane::Map),
    }
    app.chosen = Some(command);
}

/// Parameters whose values have names of files.
const WITH_FILES: [&str; 4] =
    ["roughness", "roughness.file", "roughness.further_files", "roughness.opposite"];

/// The path being typed: the whole line or, in a value, what follows the last quote, in the folder of the scene.
fn typed_in_line(app: &App) -> Option<String> {
    let prompt = app.prompt.as_ref()?;
    let text = prompt.line.text().trim_start();
    match prompt.purpose {
        Purpose::Save { .. } | Purpose::Export | Purpose::Scene(_) => Some(text.to_owned()),
        Purpose::Value if WITH_FILES.contains(&app.edit.parameter()?.path.as_str()) => {
            let path = text.rsplit('"').next().unwrap_or(text);
            Some(app.edit.document.resolve(path).to_string_lossy().into_owned())
        }
        _ => None,
    }
}

pub fn can_complete(app: &App) -> bool {
    typed_in_line(app).is_some()
}

/// Requests the paths that begin as typed.
pub fn complete(app: &mut App) {
    if let Some(path) = typed_in_line(app) {
        app.effects.push(Effect::Complete(path));
    }
}

/// Types the common start of the paths that begin as typed, and shows them if they are several.
pub fn completed(app: &mut App, paths: Vec<String>) {
    let Some(typed) = typed_in_line(app) else { return };
    let common = common_start(&paths);
    if let Some(rest) = common.strip_prefix(&typed) {
        edit::edit_line(app, |line| {
            line.edit(InputRequest::GoToEnd);
            line.insert(rest);
        });
    }
    app.refuse(paths.is_empty().then(|| "no file or folder begins so".to_owned()));
    if let Some(prompt) = &mut app.prompt {
        prompt.paths = if paths.len() > 1 { paths } else { Vec::new() };
    }
}
