//! Output of the explorer: the scene, exports, the command that opens the scene.

use super::{Effect, edit};
use crate::explorer::action::{Content, WriteFailure, Written};
use crate::explorer::mode::{Mode, SaveForm};
use crate::explorer::model::{Model, Notice, Writing};
use crate::explorer::text_line::TextLine;
use crate::scene::{Document, command_line, ron_string, typed_path};
use std::path::PathBuf;

/// Asks for the file to save to, for title and notice.
pub fn save_as(document: &Document, then_quit: bool) -> Mode {
    let name = document.name();
    let is_file = std::path::Path::new(name).extension().is_some_and(|extension| extension == "ron");
    let file = if is_file { name.to_owned() } else { format!("{name}.ron") };
    let scene = document.scene();
    let lines = [&file, &scene.title, &scene.notice].map(|text| TextLine::new(text));
    Mode::SaveAs(SaveForm { lines, line: 0, then_quit })
}

/// Saves the scene with the title and the notice that were typed, as an edit where they are others. Comments about changed
/// values are asked about first.
pub fn save(model: &mut Model, form: &SaveForm) -> Vec<Effect> {
    let [file, title, notice] = form.lines.each_ref().map(TextLine::text);
    let path = typed_path(&file);
    if path.as_os_str().is_empty() {
        return Vec::new();
    }
    let scene = model.document.scene();
    let texts = [("title", &scene.title, title), ("notice", &scene.notice, notice)];
    // The lines have no line breaks; a text that was not touched keeps its own.
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
    let (count, then_quit) = (model.document.stale_comments(), form.then_quit);
    if count > 0 {
        model.mode = Mode::StaleComments { count, path, then_quit };
    } else {
        effects.extend(write(model, path, Content::Scene, then_quit));
    }
    effects
}

/// Saves the scene without the comments about changed values.
pub fn save_without_comments(model: &mut Model, path: PathBuf, then_quit: bool) -> Vec<Effect> {
    let document = model.document.without_stale_comments();
    let mut effects = edit::adopt(model, document);
    effects.extend(write(model, path, Content::Scene, then_quit));
    effects
}

/// Asks for the file of the scene or, where that is saved, of one that was left with unsaved changes.
pub fn save_before_leaving(model: &mut Model) -> Vec<Effect> {
    let mut effects = Vec::new();
    if !model.is_unsaved()
        && let Some(document) = model.unsaved().first().map(|document| Document::clone(document))
    {
        effects = edit::adopt(model, document);
    }
    model.mode = save_as(&model.document, true);
    effects
}

/// Asks for the name of the file to export to.
pub fn ask_export(model: &mut Model) {
    let name = std::path::Path::new(model.document.name());
    let stem = name.file_stem().map_or_else(|| "scene".into(), |stem| stem.to_string_lossy());
    model.mode = Mode::Export(TextLine::new(&format!("{stem}.csv")));
}

/// Exports to a file; the ending of its name selects the content.
pub fn export(model: &mut Model, path: PathBuf) -> Vec<Effect> {
    if path.as_os_str().is_empty() {
        return Vec::new();
    }
    let Some(content) = Content::of_file(model.exports(), &path) else {
        let is_map = model.exports() == Content::MAP_EXPORTS;
        let what = if is_map { "the map" } else { "the curve" };
        let endings: Vec<String> = model.exports().iter().map(|(ending, _)| format!(".{ending}")).collect();
        let why =
            format!("{}: the name must end in {}, to export {what}", path.display(), endings.join(", "));
        model.notice = Some(Notice::Error(why));
        model.mode = Mode::Explore;
        return Vec::new();
    };
    if matches!(content, Content::MapCells | Content::MapFigure(_)) && model.chart.map_model().is_none() {
        model.notice = Some(Notice::Error("there is no map yet to export".to_owned()));
        model.mode = Mode::Explore;
        return Vec::new();
    }
    if matches!(content, Content::Curve(_) | Content::Outcome) && !model.is_current() {
        model.notice = Some(Notice::Error("the scene has no curve yet to export".to_owned()));
        model.mode = Mode::Explore;
        return Vec::new();
    }
    write(model, path, content, false)
}

/// Writes a file that is not there yet.
pub fn write(model: &mut Model, path: PathBuf, content: Content, then_quit: bool) -> Vec<Effect> {
    if path.as_os_str().is_empty() {
        return Vec::new();
    }
    begin(model, path, content, then_quit, false)
}

/// Writes a file in place of the one that is there.
pub fn overwrite(model: &mut Model, path: PathBuf, content: Content, then_quit: bool) -> Vec<Effect> {
    begin(model, path, content, then_quit, true)
}

fn begin(
    model: &mut Model,
    path: PathBuf,
    content: Content,
    then_quit: bool,
    overwrite: bool,
) -> Vec<Effect> {
    model.mode = Mode::Explore;
    if let Some(writing) = &model.writing {
        let why = format!("{} is still being written; nothing else is until then", writing.path.display());
        model.notice = Some(Notice::Error(why));
        return Vec::new();
    }
    model.writing = Some(Writing { path: path.clone(), text: model.document.text().to_owned(), then_quit });
    vec![Effect::Write { path, content, overwrite }]
}

/// Takes in how writing went. It may have taken long: the scene can have been changed meanwhile.
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
            model.notice = Some(Notice::Done(format!("{how} to {}", path.display())));
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
            model.notice = Some(Notice::Error(format!("not written: {error}")));
        }
    }
}

/// Leaves the explorer, but first has a file written to its end. Asked once more, it leaves without.
pub fn quit(model: &mut Model) {
    match &mut model.writing {
        Some(writing) if !writing.then_quit => {
            writing.then_quit = true;
            let path = writing.path.display();
            let text = format!("leaving as soon as {path} is written; once more leaves without");
            model.notice = Some(Notice::Done(text));
        }
        _ => model.finished = true,
    }
}

/// Copies the command that opens the present scene.
pub fn copy_command(model: &mut Model) -> Vec<Effect> {
    let command = command_line(model.document.name(), model.document.overrides());
    // The terminal does not confirm a copy, so the notice has the command too.
    model.notice = Some(Notice::Done(format!("copy: {command}")));
    vec![Effect::Copy(command)]
}
