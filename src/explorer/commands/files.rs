//! Output of the explorer: scene files, exports, and the command that opens the scene.

use super::edit;
use crate::explorer::action::{Content, EXPORTS, OutputFile, Task, WriteFailure};
use crate::explorer::app::App;
use crate::explorer::command_line::{command_line, curve_arguments};
use crate::explorer::measured::Measured;
use crate::explorer::prompt::Purpose;
use asperity_data::is_control;
use asperity_report::{Format, check_extension};
use asperity_scene::Document;
use asperity_scene::text::quoted;
use std::path::{Path, PathBuf};

pub fn ask_save(app: &mut App, then_quit: bool) {
    let name = app.edit.document.name();
    let extension = Path::new(name).extension();
    let file = if extension.is_some_and(|extension| extension == "ron") {
        name.to_owned()
    } else {
        format!("{name}.ron")
    };
    app.ask(Purpose::Save { then_quit }, &file);
}

pub fn save(app: &mut App, path: PathBuf, then_quit: bool) -> Result<(), String> {
    check_extension(&path, &["ron"])?;
    write(app, path, Content::Scene, then_quit)
}

fn write(app: &mut App, path: PathBuf, content: Content, then_quit: bool) -> Result<(), String> {
    if path.as_os_str().is_empty() {
        return Err("type the name of a file".to_owned());
    }
    app.effects.push(Task::Write(OutputFile {
        path,
        content,
        overwrite: false,
        then_quit,
    }));
    Ok(())
}

/// Asks for the name of a file for the present scene, which is saved before the explorer ends. If
/// the present scene is already saved, another scene with unsaved changes becomes the present scene
/// first.
pub fn save_before_leaving(app: &mut App) {
    if !app.edit.is_unsaved()
        && let Some(document) = app.edit.unsaved().first()
    {
        let document = Document::clone(document);
        edit::adopt(app, document);
    }
    ask_save(app, true);
}

pub fn ask_export(app: &mut App) {
    let name = Path::new(app.edit.document.name());
    let stem = match name.file_stem() {
        Some(stem) => stem.to_string_lossy(),
        None => "scene".into(),
    };
    let file = format!("{stem}-{}.csv", app.view.pane.file_name());
    app.ask(Purpose::Export, &file);
}

/// Exports the selected pane to a file. The extension of the file name determines the format.
pub fn export(app: &mut App, path: PathBuf) -> Result<(), String> {
    let extensions = EXPORTS.map(Format::extension);
    let Some(place) = check_extension(&path, &extensions)? else {
        let extensions = extensions.map(|extension| format!(".{extension}"));
        return Err(format!(
            "the extension chooses the format; use one of {}",
            extensions.join(", ")
        ));
    };
    write(app, path, Content::Pane(EXPORTS[place]), false)
}

/// Shows a message whether a file has been written. Then takes the next step, which may be a
/// question to the user or the end of the explorer.
pub fn written(app: &mut App, file: OutputFile, result: Result<(), WriteFailure>) {
    let path = file.path.display();
    let is_scene = file.content == Content::Scene;
    match result {
        Ok(()) => {
            let how = if is_scene { "saved" } else { "exported" };
            app.set_done(format!("{how} to {path}"));
            if is_scene {
                app.edit.set_saved_as(&file.path);
            }
            if file.then_quit {
                ask_quit(app);
            }
        }
        Err(WriteFailure::Exists) => app.ask(Purpose::Overwrite(file), ""),
        Err(WriteFailure::Refused(error)) => {
            let purpose = if is_scene {
                Purpose::Save {
                    then_quit: file.then_quit,
                }
            } else {
                Purpose::Export
            };
            app.ask_again(purpose, &file.path.to_string_lossy(), &error);
        }
    }
}

/// Ends the explorer. If there are unsaved changes, asks the user first.
pub fn ask_quit(app: &mut App) {
    if app.edit.unsaved().is_empty() {
        app.finished = true;
    } else {
        app.ask(Purpose::Leave, "");
    }
}

/// Copies to the clipboard the command that opens the scene with its changes and the measured
/// curve.
pub fn copy_command(app: &mut App) {
    let measured = match &app.edit.measured {
        Some(Measured { path, options, .. }) => {
            format!(" --measured={}{}", quoted(path), curve_arguments(options))
        }
        None => String::new(),
    };
    let document = &app.edit.document;
    let program = format!("asperity{measured}");
    let command = command_line(&program, document.name(), document.overrides());
    // If the user pasted the command into a shell, control characters in it would act on the
    // terminal.
    if command.contains(is_control) {
        app.set_error(
            "not copied: control characters in the name of the file; allowed: a name without any",
        );
        return;
    }
    // The terminal does not confirm that it has copied the text. Therefore the message also
    // contains the command, so that the user can select it.
    app.set_done(format!("copied: {command}"));
    app.effects.push(Task::Copy(command));
}
