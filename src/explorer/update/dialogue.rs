//! Prompts: what opens, edits, accepts and cancels them.

use super::{Effect, accuracy, edit, files, movement, run, show};
use crate::explorer::action::OutputFile;
use crate::explorer::app::App;
use crate::explorer::completion::common_start;
use crate::explorer::keys::{Command, Context};
use crate::explorer::palette::commands;
use crate::explorer::panes::Pane;
use crate::explorer::prompt::{Prompt, Purpose};
use crate::explorer::text_line::TextLine;
use crate::explorer::view::help_end;
use crate::scene::{Entry, typed_path};
use std::path::Path;

/// Opens the help.
pub fn help(app: &mut App) {
    app.ask(Purpose::Help, TextLine::default());
}

/// Opens the search of the list of parameters, in its pane.
pub fn find_parameter(app: &mut App) -> Vec<Effect> {
    app.ask(Purpose::Parameter { before: app.view.pane }, TextLine::default());
    edit::show_parameters(app)
}

/// Opens the list of all commands.
pub fn open_palette(app: &mut App) {
    app.ask(Purpose::Command(commands(&app.config.bindings)), TextLine::default());
}

/// Opens the list of scenes.
pub fn open_library(app: &mut App) -> Vec<Effect> {
    app.ask(Purpose::Scene(Vec::new()), TextLine::default());
    vec![Effect::List]
}

/// Stores the scenes that can be opened.
pub fn listed(app: &mut App, entries: Vec<Entry>) {
    if let Some(prompt) = &mut app.prompt {
        prompt.purpose = Purpose::Scene(entries);
        prompt.search(&app.edit.parameters);
    }
}

/// Asks again for a path that could not be used, for this reason, which may begin with the path.
pub fn ask_again(app: &mut App, purpose: Purpose, path: &str, why: &str) {
    let reason = why.strip_prefix(path).and_then(|rest| rest.strip_prefix(": ")).unwrap_or(why);
    app.ask(purpose, TextLine::new(path));
    refuse(app, Some(reason.to_owned()));
}

fn refuse(app: &mut App, why: Option<String>) {
    if let Some(prompt) = &mut app.prompt {
        prompt.refused = why;
    }
}

/// Edits the line; the preview of the value, or the list, follows.
pub fn edit_line(app: &mut App, change: impl FnOnce(&mut TextLine)) -> Vec<Effect> {
    let Some(prompt) = &mut app.prompt else { return Vec::new() };
    let before = prompt.line.text().to_owned();
    change(&mut prompt.line);
    if prompt.line.text() == before && prompt.line.left_out().is_none() {
        return Vec::new();
    }
    (prompt.refused, prompt.paths) = (None, Vec::new());
    prompt.search(&app.edit.parameters);
    if matches!(prompt.purpose, Purpose::Value) { edit::preview(app) } else { Vec::new() }
}

/// Moves the selection of a list, or scrolls the help by a line.
pub fn select(app: &mut App, rows: i32) {
    let is_help = app.prompt.as_ref().is_some_and(|prompt| matches!(prompt.purpose, Purpose::Help));
    let end = is_help.then(|| usize::from(help_end(app)));
    let Some(prompt) = &mut app.prompt else { return };
    let last = end.unwrap_or(prompt.found.len().saturating_sub(1));
    let rows = if is_help { rows.signum() } else { rows };
    prompt.selected = prompt.selected.min(last).saturating_add_signed(rows as isize).min(last);
}

/// Accepts the line, the selected row, or the question. A refused line stays, with the reason.
pub fn accept(app: &mut App) -> Vec<Effect> {
    let Some(prompt) = app.prompt.take() else { return Vec::new() };
    accept_prompt(app, &prompt).unwrap_or_else(|why| {
        app.prompt = Some(Prompt { refused: Some(why), ..prompt });
        Vec::new()
    })
}

fn accept_prompt(app: &mut App, prompt: &Prompt) -> Result<Vec<Effect>, String> {
    let typed = prompt.line.text();
    let nothing = || "nothing in the list fits".to_owned();
    match &prompt.purpose {
        Purpose::Value => edit::accept_value(app, typed),
        Purpose::Force => movement::accept_force(app, typed),
        Purpose::Tolerance => accuracy::accept_tolerance(app, typed),
        Purpose::Save { then_quit } => files::save(typed_path(typed), *then_quit),
        Purpose::Export => files::export(app, typed_path(typed)),
        Purpose::Scene(_) => match prompt.scene() {
            Some(entry) => Ok(edit::open_read(app, entry.document.clone())),
            None if typed.trim().is_empty() => Err("type a name or a path".to_owned()),
            // The path of a scene, or of a study.
            None => Ok(vec![Effect::Open(typed_path(typed.trim()).to_string_lossy().into_owned())]),
        },
        Purpose::Parameter { .. } => {
            edit::select(app, prompt.choice().ok_or_else(nothing)?);
            Ok(show::choose(app, Pane::Parameters))
        }
        Purpose::Command(commands) => {
            let listed = prompt.choice().and_then(|index| commands.get(index)).ok_or_else(nothing)?;
            Ok(run_listed(app, listed.command))
        }
        Purpose::Overwrite(file) => Ok(vec![Effect::Write(OutputFile { overwrite: true, ..file.clone() })]),
        Purpose::Leave | Purpose::Help => Ok(Vec::new()),
    }
}

/// Closes the prompt without a change.
pub fn cancel(app: &mut App) -> Vec<Effect> {
    match app.prompt.take().map(|prompt| prompt.purpose) {
        Some(Purpose::Value) => edit::preview(app),
        Some(Purpose::Parameter { before }) => {
            app.view.pane = before;
            vec![Effect::Ask]
        }
        _ => Vec::new(),
    }
}

/// Runs a command of the list, in a pane where its key is valid.
fn run_listed(app: &mut App, command: Command) -> Vec<Effect> {
    let is_valid = |context: Context| command.row.contexts.contains(&context);
    let mut effects = match app.keys() {
        here if is_valid(here) => Vec::new(),
        _ if is_valid(Context::Parameters) => show::choose(app, Pane::Parameters),
        _ if is_valid(Context::Explore) => show::choose(app, Pane::Force),
        _ => show::choose(app, Pane::Chart),
    };
    effects.extend(run(app, command));
    effects
}

/// Parameters whose values hold names of files.
const WITH_FILES: [&str; 4] =
    ["roughness", "roughness.file", "roughness.further_files", "roughness.opposite"];

/// The typed path behind the text of the line before the path, and the folder of a relative path. In a value the path
/// begins behind an open quote, or the value has no brackets.
fn path_in_line(app: &App) -> Option<(&str, String, &str)> {
    let prompt = app.prompt.as_ref()?;
    let text = prompt.line.text();
    match prompt.purpose {
        Purpose::Save { .. } | Purpose::Export | Purpose::Scene(_) => return Some(("", String::new(), text)),
        Purpose::Value if WITH_FILES.contains(&app.parameter()?.path.as_str()) => {}
        _ => return None,
    }
    let begin = match text.rfind('"') {
        Some(quote) if text.matches('"').count() % 2 == 1 => quote + 1,
        None if !text.contains(['(', '[']) => 0,
        _ => return None,
    };
    let (before, path) = text.split_at(begin);
    let is_absolute = Path::new(path).is_absolute();
    let folder =
        if is_absolute { String::new() } else { app.edit.document.resolve("").display().to_string() };
    Some((before, folder, path))
}

/// Returns true if a path is being typed.
pub fn can_complete(app: &App) -> bool {
    path_in_line(app).is_some()
}

/// Requests the paths that begin as typed.
pub fn complete(app: &mut App) -> Vec<Effect> {
    path_in_line(app).map_or_else(Vec::new, |(_, folder, path)| vec![Effect::Complete(folder + path)])
}

/// Types the common start of the paths that begin as typed, and shows them if they are several.
pub fn completed(app: &mut App, paths: Vec<String>) -> Vec<Effect> {
    let Some((before, folder, path)) = path_in_line(app) else { return Vec::new() };
    let common = common_start(&paths);
    let rest = common.strip_prefix(&folder).unwrap_or(&common);
    let line = (rest.len() > path.len()).then(|| TextLine::new(&format!("{before}{rest}")));
    let effects = line.map_or_else(Vec::new, |line| edit_line(app, |present| *present = line));
    refuse(app, paths.is_empty().then(|| "no file or folder begins so".to_owned()));
    if let Some(prompt) = &mut app.prompt {
        prompt.paths = if paths.len() > 1 { paths } else { Vec::new() };
    }
    effects
}
