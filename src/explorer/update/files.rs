//! What leaves the explorer: the scene, exports, the command that opens it.

use super::Effect;
use crate::explorer::action::{Content, WriteFailure, Written};
use crate::explorer::mode::Mode;
use crate::explorer::model::{Model, Notice};
use crate::explorer::text_line::TextLine;
use crate::scene::{Document, command_line};
use std::path::PathBuf;

/// Asks for the name of the file to save to.
pub fn save_as(document: &Document, then_quit: bool) -> Mode {
    let name = document.name();
    let is_file = std::path::Path::new(name).extension().is_some_and(|extension| extension == "ron");
    let line = TextLine::new(&if is_file { name.to_owned() } else { format!("{name}.ron") });
    Mode::SaveAs { line, then_quit }
}

/// Asks for the name of the file to export to.
pub fn ask_export(model: &mut Model) {
    let name = std::path::Path::new(model.document.name());
    let stem = name.file_stem().map_or_else(|| "scene".into(), |stem| stem.to_string_lossy());
    model.mode = Mode::Export(TextLine::new(&format!("{stem}.csv")));
}

/// Exports to a file; the ending of its name tells what.
pub fn export(model: &mut Model, path: PathBuf) -> Vec<Effect> {
    if path.as_os_str().is_empty() {
        return Vec::new();
    }
    let Some(content) = Content::of_file(&path) else {
        let endings: Vec<String> = Content::EXPORTS.iter().map(|(ending, _)| format!(".{ending}")).collect();
        let why = format!("{}: the name must end in {}", path.display(), endings.join(", "));
        model.notice = Some(Notice::Error(why));
        model.mode = Mode::Explore;
        return Vec::new();
    };
    if matches!(content, Content::Curve | Content::Outcome) && !model.is_current() {
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
    // Kept until the outcome is known, for the question whether to overwrite.
    model.mode = Mode::Overwrite { path: path.clone(), content, then_quit };
    vec![Effect::Write { path, content, overwrite: false }]
}

/// Takes in how writing went.
pub fn written(model: &mut Model, result: Result<Written, WriteFailure>) {
    let then_quit = matches!(model.mode, Mode::Overwrite { then_quit: true, .. });
    match result {
        Ok(Written { path, content }) => {
            model.mode = Mode::Explore;
            let how = match content {
                Content::Scene => {
                    model.set_saved_as(&path);
                    model.finished = then_quit;
                    "saved"
                }
                _ => "exported",
            };
            model.notice = Some(Notice::Done(format!("{how} to {}", path.display())));
        }
        Err(WriteFailure::Exists(path, content)) => {
            model.mode = Mode::Overwrite { path, content, then_quit };
        }
        Err(WriteFailure::Refused(error)) => {
            model.notice = Some(Notice::Error(format!("not written: {error}")));
            model.mode = Mode::Explore;
        }
    }
}

/// Copies the command that opens the scene as it stands.
pub fn copy_command(model: &mut Model) -> Vec<Effect> {
    let command = command_line(model.document.name(), model.document.overrides());
    // Whether the terminal does as it is asked cannot be known, so the command stands here as well.
    model.notice = Some(Notice::Done(format!("copy: {command}")));
    vec![Effect::Copy(command)]
}
