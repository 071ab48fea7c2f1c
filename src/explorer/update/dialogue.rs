//! Prompts, questions, and the help.

use super::{Effect, accuracy, edit, files, library, movement, run, show};
use crate::explorer::action::OutputFile;
use crate::explorer::completion::common_start;
use crate::explorer::mode::{Mode, ModeKind};
use crate::explorer::model::{Model, Pane};
use crate::explorer::palette::{Entry, entries};
use crate::explorer::prompt::{Prompt, Purpose};
use crate::explorer::text_line::{Motion, TextLine};
use crate::explorer::view::help_end;
use crate::scene::typed_path;
use std::path::Path;

/// Opens the search of the list of parameters, in its pane.
pub fn find_parameter(model: &mut Model) -> Vec<Effect> {
    model.ask(Purpose::Parameter { before: model.pane }, TextLine::default());
    edit::show_parameters(model)
}

/// Opens the list of all commands.
pub fn open_palette(model: &mut Model) {
    model.ask(Purpose::Command(entries(&model.bindings)), TextLine::default());
}

/// Inserts typed or pasted text.
pub fn insert(model: &mut Model, text: &str) -> Vec<Effect> {
    edit_line(model, |line| line.insert(text))
}

/// Edits the line; the preview of the value, or the list, follows.
pub fn edit_line(model: &mut Model, change: impl FnOnce(&mut TextLine)) -> Vec<Effect> {
    let Mode::Prompt(prompt) = &mut model.mode else { return Vec::new() };
    change(&mut prompt.line);
    (prompt.refused, prompt.paths) = (None, Vec::new());
    prompt.search(&model.parameters);
    if prompt.purpose == Purpose::Value { edit::preview(model) } else { Vec::new() }
}

/// Moves the cursor in the line.
pub fn move_cursor(model: &mut Model, motion: Motion) {
    if let Some(line) = model.mode.line_mut() {
        line.go(motion);
    }
}

/// Moves the selection of a list, or scrolls the help by a line.
pub fn select(model: &mut Model, rows: i32) {
    let last = if let Mode::Help { .. } = model.mode { help_end(model) } else { 0 };
    match &mut model.mode {
        Mode::Help { scroll } => {
            *scroll = (*scroll).min(last).saturating_add_signed(rows.signum() as i16).min(last);
        }
        Mode::Prompt(prompt) => prompt.select(rows),
        _ => {}
    }
}

/// Accepts the line, the selected row, or the question. A refused line stays, with the reason.
pub fn accept(model: &mut Model) -> Vec<Effect> {
    match std::mem::replace(&mut model.mode, Mode::Explore) {
        Mode::Prompt(prompt) => {
            let effects = accept_line(model, &prompt);
            effects.unwrap_or_else(|why| {
                model.mode = Mode::Prompt(Prompt { refused: Some(why), ..prompt });
                Vec::new()
            })
        }
        Mode::Overwrite(file) => vec![Effect::Write(OutputFile { overwrite: true, ..file })],
        mode => {
            model.mode = mode;
            Vec::new()
        }
    }
}

fn accept_line(model: &mut Model, prompt: &Prompt) -> Result<Vec<Effect>, String> {
    let typed = prompt.line.text();
    let nothing = || "nothing in the list fits".to_owned();
    match &prompt.purpose {
        Purpose::Value => edit::accept_value(model, &typed),
        Purpose::Force => movement::accept_force(model, &typed),
        Purpose::Tolerance => accuracy::accept_tolerance(model, &typed),
        Purpose::Save { then_quit } => files::save(typed_path(&typed), *then_quit),
        Purpose::Export => files::export(model, typed_path(&typed)),
        Purpose::Scene(_) => library::accept(model, prompt),
        Purpose::Parameter { .. } => {
            edit::select(model, prompt.choice().ok_or_else(nothing)?);
            Ok(show::choose(model, Pane::Parameters))
        }
        Purpose::Command(entries) => {
            let entry = prompt.choice().and_then(|index| entries.get(index)).ok_or_else(nothing)?;
            Ok(run_entry(model, entry))
        }
    }
}

/// Leaves the prompt, the question or the help without a change.
pub fn cancel(model: &mut Model) -> Vec<Effect> {
    match std::mem::replace(&mut model.mode, Mode::Explore) {
        Mode::Prompt(Prompt { purpose: Purpose::Value, .. }) => edit::preview(model),
        Mode::Prompt(Prompt { purpose: Purpose::Parameter { before }, .. }) => {
            model.pane = before;
            vec![Effect::Ask]
        }
        _ => Vec::new(),
    }
}

/// Runs a command of the list, in a pane where its key is valid.
fn run_entry(model: &mut Model, entry: &Entry) -> Vec<Effect> {
    let is_valid = |mode: &ModeKind| entry.modes.contains(mode);
    let mut effects = match model.keys() {
        here if is_valid(&here) => Vec::new(),
        _ if is_valid(&ModeKind::Parameters) => show::choose(model, Pane::Parameters),
        _ if is_valid(&ModeKind::Explore) => show::choose(model, Pane::Force),
        _ => show::choose(model, Pane::Chart),
    };
    effects.extend(run(model, entry.command));
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
    fn of(model: &Model) -> Option<Self> {
        let Mode::Prompt(prompt) = &model.mode else { return None };
        let text = prompt.line.text();
        match prompt.purpose {
            Purpose::Save { .. } | Purpose::Export | Purpose::Scene(_) => {
                return Some(TypedPath { before: String::new(), folder: String::new(), path: text });
            }
            Purpose::Value if names_files(&model.parameter()?.path) => {}
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
            if is_absolute { String::new() } else { model.document.resolve("").display().to_string() };
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
pub fn can_complete(model: &Model) -> bool {
    TypedPath::of(model).is_some()
}

/// Requests the paths that begin as typed.
pub fn complete(model: &mut Model) -> Vec<Effect> {
    TypedPath::of(model).map_or_else(Vec::new, |typed| vec![Effect::Complete(typed.whole())])
}

/// Types the common start of the paths that begin as typed, and shows them if they are several.
pub fn completed(model: &mut Model, paths: Vec<String>) -> Vec<Effect> {
    let Some(typed) = TypedPath::of(model) else { return Vec::new() };
    let common = common_start(&paths);
    let effects = if common.len() > typed.whole().len() {
        let path = common.strip_prefix(&typed.folder).unwrap_or(&common);
        let line = TextLine::new(&format!("{}{path}", typed.before));
        edit_line(model, |present| *present = line)
    } else {
        Vec::new()
    };
    if let Mode::Prompt(prompt) = &mut model.mode {
        prompt.refused = paths.is_empty().then(|| "no file or folder begins so".to_owned());
        prompt.paths = if paths.len() > 1 { paths } else { Vec::new() };
    }
    effects
}
