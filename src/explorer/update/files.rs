//! Output of the explorer: the scene, exports, the command to open the scene.

use super::{Effect, edit};
use crate::explorer::action::{Content, WriteFailure, Written};
use crate::explorer::mode::{Mode, SaveForm};
use crate::explorer::model::{Model, Writing};
use crate::explorer::text_line::TextLine;
use crate::export::check_extension;
use crate::scene::{Document, command_line, ron_string, typed_path};
use crate::text::is_control;
use std::path::{Path, PathBuf};

/// Asks for the file to save to, for title and notice.
pub fn ask_save(model: &mut Model, then_quit: bool) {
    let (name, scene) = (model.document.name(), model.document.scene());
    let is_file = Path::new(name).extension().is_some_and(|extension| extension == "ron");
    let file = if is_file { name.to_owned() } else { format!("{name}.ron") };
    let lines = [&file, &scene.title, &scene.notice].map(|text| TextLine::new(text));
    model.mode = Mode::SaveAs(SaveForm { lines, line: 0, then_quit });
}

/// Saves the scene with the typed title and notice, as an edit where these differ.
pub fn save(model: &mut Model, form: &SaveForm) -> Vec<Effect> {
    let [file, title, notice] = form.lines.each_ref().map(TextLine::text);
    let path = typed_path(&file);
    if path.as_os_str().is_empty() {
        return Vec::new();
    }
    let scene = model.document.scene();
    let texts = [("title", &scene.title, title), ("notice", &scene.notice, notice)];
    // The lines have no line breaks; an untouched text keeps its own.
    let changed = texts.into_iter().filter(|(_, before, now)| TextLine::new(before).text() != *now);
    let changed: Vec<_> = changed.map(|(path, _, now)| (path.to_owned(), ron_string(&now))).collect();
    let mut effects = Vec::new();
    if !changed.is_empty() {
        let document = model.document.set_all(&changed);
        effects = edit::take_over(model, document);
        if model.refused.is_some() {
            return effects;
        }
    }
    effects.extend(write(model, path, Content::Scene, form.then_quit, false));
    effects
}

/// Asks for the file of the scene or, where that is saved, of one left with unsaved changes.
pub fn save_before_leaving(model: &mut Model) -> Vec<Effect> {
    let mut effects = Vec::new();
    if !model.is_unsaved()
        && let Some(document) = model.unsaved().first().map(|document| Document::clone(document))
    {
        effects = edit::adopt(model, document);
    }
    ask_save(model, true);
    effects
}

/// Asks for the name of the file to export to.
pub fn ask_export(model: &mut Model) {
    let name = Path::new(model.document.name());
    let stem = name.file_stem().map_or_else(|| "scene".into(), |stem| stem.to_string_lossy());
    model.mode = Mode::Export(TextLine::new(&format!("{stem}.csv")));
}

/// Exports to a file; the extension of its name selects the content.
pub fn export(model: &mut Model, path: PathBuf) -> Vec<Effect> {
    if path.as_os_str().is_empty() {
        return Vec::new();
    }
    match content_for(model, &path) {
        Ok(content) => write(model, path, content, false, false),
        Err(why) => {
            model.set_error(why);
            model.mode = Mode::Explore;
            Vec::new()
        }
    }
}

/// Content for an exported file; or why there is none.
fn content_for(model: &Model, path: &Path) -> Result<Content, String> {
    let exports = model.exports();
    let extensions: Vec<_> = exports.iter().map(|(format, _)| format.extension()).collect();
    let content = match check_extension(path, &extensions) {
        Ok(Some(place)) => exports[place].1,
        Ok(None) => {
            let extensions: Vec<String> =
                extensions.iter().map(|extension| format!(".{extension}")).collect();
            let path = path.display();
            return Err(format!(
                "{path}: the extension chooses the format; use one of {}",
                extensions.join(", ")
            ));
        }
        Err(error) => return Err(error.to_string()),
    };
    match content {
        Content::MapCells if model.chart.map_model().is_none() => {
            Err("there is no map yet to export".to_owned())
        }
        Content::Figure(_) if model.figure().is_none() => {
            Err("the selected pane is empty; there is no figure to export".to_owned())
        }
        Content::Outcome(_) if !model.is_current() => Err("the scene has no curve yet to export".to_owned()),
        content => Ok(content),
    }
}

/// Writes a file; `overwrite`: in place of an existing one.
pub fn write(
    model: &mut Model,
    path: PathBuf,
    content: Content,
    then_quit: bool,
    overwrite: bool,
) -> Vec<Effect> {
    model.mode = Mode::Explore;
    if let Some(writing) = &model.writing {
        let why = format!("{} is still being written; nothing else is until then", writing.path.display());
        model.set_error(why);
        return Vec::new();
    }
    model.writing = Some(Writing { path: path.clone(), text: model.document.text().to_owned(), then_quit });
    vec![Effect::Write { path, content, overwrite }]
}

/// Handles the result of writing; the scene may have been changed meanwhile.
pub fn written(model: &mut Model, result: Result<Written, WriteFailure>) {
    let Some(writing) = model.writing.take() else { return };
    let then_quit = writing.then_quit;
    match result {
        Ok(Written { path, content }) => {
            let how = if content == Content::Scene {
                if model.document.text() == writing.text {
                    model.set_saved_as(&path);
                }
                "saved"
            } else {
                "exported"
            };
            model.set_done(format!("{how} to {}", path.display()));
            if then_quit && !model.unsaved().is_empty() {
                model.mode = Mode::Quit;
            } else {
                model.finished = then_quit;
            }
        }
        Err(WriteFailure::Exists(path, content)) => {
            model.mode = Mode::Overwrite { path, content, then_quit };
        }
        Err(WriteFailure::Refused(error)) => {
            model.set_error(format!("not written: {error}"));
        }
    }
}

/// Leaves the explorer, or asks about unsaved changes first.
pub fn ask_quit(model: &mut Model) {
    if model.unsaved().is_empty() {
        quit(model);
    } else {
        model.mode = Mode::Quit;
    }
}

/// Leaves the explorer once a file being written is complete; a second request leaves at once.
pub fn quit(model: &mut Model) {
    match &mut model.writing {
        Some(writing) if !writing.then_quit => {
            writing.then_quit = true;
            let path = writing.path.display();
            let text = format!("leaving as soon as {path} is written; once more leaves without");
            model.set_done(text);
        }
        _ => model.finished = true,
    }
}

/// Copies the command that opens the present scene.
pub fn copy_command(model: &mut Model) -> Vec<Effect> {
    let command = command_line("asperity", model.document.name(), model.document.overrides());
    if command.contains(is_control) {
        // Pasted into a shell they would act on its terminal.
        model
            .set_error("not copied: control characters in the name of the file; allowed: a name without any");
        return Vec::new();
    }
    // The terminal does not confirm a copy, so the notice has the command too.
    model.set_done(format!("copy: {command}"));
    vec![Effect::Copy(command)]
}
