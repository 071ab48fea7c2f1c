//! Output of the explorer: the scene, exports, the command to open the scene.

use super::{Effect, edit};
use crate::explorer::action::{Content, OutputFile, WriteFailure};
use crate::explorer::mode::{Mode, SaveForm};
use crate::explorer::model::Model;
use crate::explorer::text_line::TextLine;
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
    let file = OutputFile { path, content: Content::Scene, overwrite: false, then_quit: form.then_quit };
    effects.extend(write(model, file));
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

/// Exports to a file; the ending of its name selects the content.
pub fn export(model: &mut Model, path: PathBuf) -> Vec<Effect> {
    if path.as_os_str().is_empty() {
        return Vec::new();
    }
    match content_for(model, &path) {
        Ok(content) => write(model, OutputFile { path, content, overwrite: false, then_quit: false }),
        Err(why) => {
            model.set_error(why);
            model.mode = Mode::Explore;
            Vec::new()
        }
    }
}

/// Content for an exported file; or why there is none.
fn content_for(model: &Model, path: &Path) -> Result<Content, String> {
    let (exports, is_map) = (model.exports(), model.exports() == Content::MAP_EXPORTS);
    let Some(content) = Content::of_file(exports, path) else {
        let what = if is_map { "the map" } else { "the curve" };
        let endings: Vec<String> = exports.iter().map(|(ending, _)| format!(".{ending}")).collect();
        let (path, endings) = (path.display(), endings.join(", "));
        return Err(format!("{path}: the name must end in {endings}, to export {what}"));
    };
    match content {
        Content::MapCells if model.chart.map_model().is_none() => {
            Err("there is no map yet to export".to_owned())
        }
        Content::Figure(_) if model.figure().is_none() => {
            Err("the selected pane is empty; there is no figure to export".to_owned())
        }
        Content::Curve(_) | Content::Outcome if !model.is_current() => {
            Err("the scene has no curve yet to export".to_owned())
        }
        content => Ok(content),
    }
}

/// Writes a file.
pub fn write(model: &mut Model, file: OutputFile) -> Vec<Effect> {
    model.mode = Mode::Explore;
    vec![Effect::Write(file)]
}

/// Handles the result of writing.
pub fn written(model: &mut Model, file: OutputFile, result: Result<(), WriteFailure>) {
    let path = file.path.display();
    match result {
        Ok(()) => {
            let how = if file.content == Content::Scene { "saved" } else { "exported" };
            model.set_done(format!("{how} to {path}"));
            if file.content == Content::Scene {
                model.set_saved_as(&file.path);
            }
            if file.then_quit {
                ask_quit(model);
            }
        }
        Err(WriteFailure::Exists) => model.mode = Mode::Overwrite(file),
        Err(WriteFailure::Refused(error)) => model.set_error(format!("not written: {error}")),
    }
}

/// Leaves the explorer, or asks about unsaved changes first.
pub fn ask_quit(model: &mut Model) {
    if model.unsaved().is_empty() {
        model.finished = true;
    } else {
        model.mode = Mode::Quit;
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
