//! Prompts, questions, and the help.

use super::{Effect, accuracy, edit, files, library, movement, run, show};
use crate::explorer::action::OutputFile;
use crate::explorer::app::{App, Pane};
use crate::explorer::completion::common_start;
use crate::explorer::mode::{Mode, ModeKind};
use crate::explorer::palette::{Entry, entries};
use crate::explorer::prompt::{Prompt, Purpose};
use crate::explorer::text_line::{Motion, TextLine};
use crate::explorer::view::help_end;
use crate::scene::typed_path;
use std::path::Path;

/// Opens the search of the list of parameters, in its pane.
pub fn find_parameter(app: &mut App) -> Vec<Effect> {
    app.ask(Purpose::Parameter { before: app.view.pane }, TextLine::default());
    edit::show_parameters(app)
}

/// Opens the list of all commands.
pub fn open_palette(app: &mut App) {
    app.ask(Purpose::Command(entries(&app.config.bindings)), TextLine::default());
}

/// Inserts typed or pasted text.
pub fn insert(app: &mut App, text: &str) -> Vec<Effect> {
    edit_line(app, |line| line.insert(text))
}

/// Edits the line; the preview of the value, or the list, follows.
pub fn edit_line(app: &mut App, change: impl FnOnce(&mut TextLine)) -> Vec<Effect> {
    let Mode::Prompt(prompt) = &mut app.mode else { return Vec::new() };
    change(&mut prompt.line);
    (prompt.refused, prompt.paths) = (None, Vec::new());
    prompt.search(&app.edit.parameters);
    if prompt.purpose == Purpose::Value { edit::preview(app) } else { Vec::new() }
}

/// Moves the cursor in the line.
pub fn move_cursor(app: &mut App, motion: Motion) {
    if let Some(line) = app.mode.line_mut() {
        line.go(motion);
    }
}

/// Moves the selection of a list, or scrolls the help by a line.
pub fn select(app: &mut App, rows: i32) {
    let last = if let Mode::Help { .. } = app.mode { help_end(app) } else { 0 };
    match &mut app.mode {
        Mode::Help { scroll } => {
            *scroll = (*scroll).min(last).saturating_add_signed(rows.signum() as i16).min(last);
        }
        Mode::Prompt(prompt) => prompt.select(rows),
        _ => {}
    }
}

/// Accepts the line, the selected row, or the question. A refused line stays, with the reason.
pub fn accept(app: &mut App) -> Vec<Effect> {
    match std::mem::replace(&mut app.mode, Mode::Explore) {
        Mode::Prompt(prompt) => {
            let effects = accept_line(app, &prompt);
            effects.unwrap_or_else(|why| {
                app.mode = Mode::Prompt(Prompt { refused: Some(why), ..prompt });
                Vec::new()
            })
        }
        Mode::Overwrite(file) => vec![Effect::Write(OutputFile { overwrite: true, ..file })],
        mode => {
            app.mode = mode;
            Vec::new()
        }
    }
}

fn accept_line(app: &mut App, prompt: &Prompt) -> Result<Vec<Effect>, String> {
    let typed = prompt.line.text();
    let nothing = || "nothing in the list fits".to_owned();
    match &prompt.purpose {
        Purpose::Value => edit::accept_value(app, &typed),
        Purpose::Force => movement::accept_force(app, &typed),
        Purpose::Tolerance => accuracy::accept_tolerance(app, &typed),
        Purpose::Save { then_quit } => files::save(typed_path(&typed), *then_quit),
        Purpose::Export => files::export(app, typed_path(&typed)),
        Purpose::Scene(_) => library::accept(app, prompt),
        Purpose::Parameter { .. } => {
            edit::select(app, prompt.choice().ok_or_else(nothing)?);
            Ok(show::choose(app, Pane::Parameters))
        }
        Purpose::Command(entries) => {
            let entry = prompt.choice().and_then(|index| entries.get(index)).ok_or_else(nothing)?;
            Ok(run_entry(app, entry))
        }
    }
}

/// Leaves the prompt, the question or the help without a change.
pub fn cancel(app: &mut App) -> Vec<Effect> {
    match std::mem::replace(&mut app.mode, Mode::Explore) {
        Mode::Prompt(Prompt { purpose: Purpose::Value, .. }) => edit::preview(app),
        Mode::Prompt(Prompt { purpose: Purpose::Parameter { before }, .. }) => {
            app.view.pane = before;
            vec![Effect::Ask]
        }
        _ => Vec::new(),
    }
}

/// Runs a command of the list, in a pane where its key is valid.
fn run_entry(app: &mut App, entry: &Entry) -> Vec<Effect> {
    let is_valid = |mode: &ModeKind| entry.modes.contains(mode);
    let mut effects = match app.keys() {
        here if is_valid(&here) => Vec::new(),
        _ if is_valid(&ModeKind::Parameters) => show::choose(app, Pane::Parameters),
        _ if is_valid(&ModeKind::Explore) => show::choose(app, Pane::Force),
        _ => show::choose(app, Pane::Chart),
    };
    effects.extend(run(app, entry.command));
    effects
}

/// A path being typed at the end of a line.
struct TypedPath {
    /// Text of the line before the path.
    before: String,
    /// Folder of a relative path; empty for the working folder.
    folder: String,
    /// The path as typed.
    path: String,
}

impl TypedPath {
    /// The whole line, or in the value of a roughness the text behind an open quote or a value without brackets.
    fn of(app: &App) -> Option<Self> {
        let Mode::Prompt(prompt) = &app.mode else { return None };
        let text = prompt.line.text();
        match prompt.purpose {
            Purpose::Save { .. } | Purpose::Export | Purpose::Scene(_) => {
                return Some(TypedPath { before: String::new(), folder: String::new(), path: text });
            }
            Purpose::Value if names_files(&app.parameter()?.path) => {}
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
        Some(TypedPath { before: before.to_owned(), folder, path: path.to_owned() })
    }

    /// The path from the working folder.
    fn whole(&self) -> String {
        format!("{}{}", self.folder, self.path)
    }
}

/// Returns true for the parameters whose values hold names of files.
fn names_files(path: &str) -> bool {
    ["roughness", "roughness.file", "roughness.further_files", "roughness.opposite"].contains(&path)
}

/// Returns true if a path is being typed.
pub fn can_complete(app: &App) -> bool {
    TypedPath::of(app).is_some()
}

/// Requests the paths that begin as typed.
pub fn complete(app: &mut App) -> Vec<Effect> {
    TypedPath::of(app).map_or_else(Vec::new, |typed| vec![Effect::Complete(typed.whole())])
}

/// Types the common start of the paths that begin as typed, and shows them if they are several.
pub fn completed(app: &mut App, paths: Vec<String>) -> Vec<Effect> {
    let Some(typed) = TypedPath::of(app) else { return Vec::new() };
    let common = common_start(&paths);
    let effects = if common.len() > typed.whole().len() {
        let path = common.strip_prefix(&typed.folder).unwrap_or(&common);
        let line = TextLine::new(&format!("{}{path}", typed.before));
        edit_line(app, |present| *present = line)
    } else {
        Vec::new()
    };
    if let Mode::Prompt(prompt) = &mut app.mode {
        prompt.refused = paths.is_empty().then(|| "no file or folder begins so".to_owned());
        prompt.paths = if paths.len() > 1 { paths } else { Vec::new() };
    }
    effects
}
