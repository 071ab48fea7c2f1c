//! Dialogues: typed lines, searched lists, questions, and the help.

use super::{Effect, accuracy, edit, files, library, movement, run, show};
use crate::explorer::action::OutputFile;
use crate::explorer::finder::Finder;
use crate::explorer::mode::{Mode, ModeKind};
use crate::explorer::model::{Model, Pane};
use crate::explorer::palette::{Entry, entries};
use crate::explorer::parameters::Parameter;
use crate::explorer::text_line::{Motion, TextLine};
use crate::explorer::view::help_end;
use crate::scene::typed_path;

/// Opens the search of the list of parameters, in its pane.
pub fn find_parameter(model: &mut Model) -> Vec<Effect> {
    model.mode = Mode::Find(Finder::new(model.parameters.len()));
    model.pane_before = model.pane;
    edit::show_parameters(model)
}

/// Opens the list of all commands.
pub fn open_palette(model: &mut Model) {
    model.mode = Mode::Palette(Finder::new(entries(&model.bindings).len()));
}

/// Inserts typed or pasted text.
pub fn insert(model: &mut Model, text: &str) -> Vec<Effect> {
    model.completion = None;
    edit_line(model, |line| line.insert(text))
}

/// Edits the line or query; the preview of the value, or the list, follows.
pub fn edit_line(model: &mut Model, change: impl FnOnce(&mut TextLine)) -> Vec<Effect> {
    change_line(model, change);
    match &mut model.mode {
        Mode::Edit(_) => return edit::preview(model),
        Mode::Library(_) => return library::search(model),
        Mode::Find(finder) => finder.search(model.parameters.iter().map(Parameter::candidate)),
        Mode::Palette(finder) => finder.search(entries(&model.bindings).iter().map(Entry::candidate)),
        _ => {}
    }
    Vec::new()
}

/// Moves the cursor in the line or query.
pub fn move_cursor(model: &mut Model, motion: Motion) {
    change_line(model, |line| line.go(motion));
}

fn change_line(model: &mut Model, change: impl FnOnce(&mut TextLine)) {
    if let Mode::Edit(_) = model.mode {
        model.refused = None;
    }
    if let Some(line) = model.mode.line_mut() {
        change(line);
    }
}

/// Goes to the next or previous of several lines.
pub fn go_to_line(model: &mut Model, lines: i32) {
    if let Mode::SaveAs(form) = &mut model.mode {
        form.go(lines);
    }
}

/// Moves the selection of a list, or scrolls the help by a line.
pub fn select(model: &mut Model, rows: i32) -> Vec<Effect> {
    let last = if let Mode::Help { .. } = model.mode { help_end(model) } else { 0 };
    match &mut model.mode {
        Mode::Help { scroll } => {
            *scroll = (*scroll).min(last).saturating_add_signed(rows.signum() as i16).min(last);
        }
        Mode::Library(library) => {
            library.finder.select(rows);
            return library::preview(model);
        }
        Mode::Find(finder) | Mode::Palette(finder) => finder.select(rows),
        _ => {}
    }
    Vec::new()
}

/// Accepts the line, the selected row, or the question.
pub fn accept(model: &mut Model) -> Vec<Effect> {
    match model.mode.clone() {
        Mode::Edit(line) => edit::accept_value(model, &line.text()),
        Mode::Force(line) => {
            model.mode = Mode::Explore;
            movement::accept_force(model, &line.text())
        }
        Mode::Tolerance(line) => {
            model.mode = Mode::Explore;
            accuracy::accept_tolerance(model, &line.text())
        }
        Mode::SaveAs(form) => files::save(model, &form),
        Mode::Export(line) => files::export(model, typed_path(&line.text())),
        Mode::Library(library) => library::accept(model, &library),
        Mode::Find(finder) => finder.choice().map_or_else(Vec::new, |found| {
            model.mode = Mode::Explore;
            edit::select(model, found);
            show::choose(model, Pane::Parameters)
        }),
        Mode::Palette(finder) => {
            let chosen = finder.choice().and_then(|index| entries(&model.bindings).into_iter().nth(index));
            chosen.map_or_else(Vec::new, |entry| run_entry(model, &entry))
        }
        Mode::Overwrite(file) => files::write(model, OutputFile { overwrite: true, ..file }),
        Mode::Explore | Mode::Help { .. } | Mode::Quit => Vec::new(),
    }
}

/// Leaves the line, list, question or help without a change.
pub fn cancel(model: &mut Model) -> Vec<Effect> {
    match std::mem::replace(&mut model.mode, Mode::Explore) {
        Mode::Edit(_) => {
            model.refused = None;
            edit::preview(model)
        }
        Mode::Find(_) => {
            model.pane = model.pane_before;
            vec![Effect::Show]
        }
        _ => Vec::new(),
    }
}

/// Runs a command of the list, in the pane where its key is valid.
fn run_entry(model: &mut Model, entry: &Entry) -> Vec<Effect> {
    model.mode = Mode::Explore;
    let mut effects = match model.keys() {
        here if entry.modes.contains(&here) => Vec::new(),
        _ if entry.modes.contains(&ModeKind::Chart) => show::choose(model, Pane::Chart),
        _ => show::choose(model, Pane::Parameters),
    };
    effects.extend(run(model, entry.command));
    effects
}
