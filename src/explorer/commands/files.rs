//! Output of the explorer: the scene, exports, and the command that opens the scene.

use super::edit;
use crate::explorer::action::{Content, EXPORTS, OutputFile, Task, WriteFailure};
use crate::explorer::app::App;
use crate::explorer::measured::Measured;
use crate::explorer::prompt::Purpose;
use asperity_data::is_control;
use asperity_report::{Format, check_extension};
use asperity_scene::Document;
use asperity_scene::text::{command_line, quoted};
use std::path::{Path, PathBuf};

pub fn ask_save(app: &mut App, then_quit: bool) {
    let name = app.edit.document.name();
    let is_file = Path::new(name)
        .extension()
        .is_some_and(|extension| extension == "ron");
    let file = if is_file {
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

/// Asks for the file of the scene or, if that is saved, of another scene with unsaved changes.
pub fn save_before_leaving(app: &mut App) {
    let left = app
        .edit
        .unsaved()
        .first()
        .map(|document| Document::clone(document));
    if let Some(document) = left.filter(|_| !app.edit.is_unsaved()) {
        edit::adopt(app, document);
    }
    ask_save(app, true);
}

pub fn ask_export(app: &mut App) {
    let name = Path::new(app.edit.document.name());
    let stem = name
        .file_stem()
        .map_or_else(|| "scene".into(), |stem| stem.to_string_lossy());
    app.ask(
        Purpose::Export,
        &format!("{stem}-{}.csv", app.view.pane.file_name()),
    );
}

/// Exports the selected pane to a file; the extension of the name chooses the format.
pub fn export(app: &mut App, path: PathBuf) -> Result<(), String> {
    let extensions = EXPORTS.map(Format::extension);
    let place = check_extension(&path, &extensions)?.ok_or_else(|| {
        let extensions = extensions
            .map(|extension| format!(".{extension}"))
            .join(", ");
        format!("the extension chooses the format; use one of {extensions}")
    })?;
    write(app, path, Content::Pane(EXPORTS[place]), false)
}

/// Reports the result of writing a file, and what follows from it.
pub fn written(app: &mut App, file: OutputFile, result: Result<(), WriteFailure>) {
    let path = file.path.display();
    match result {
        Ok(()) => {
            let how = if file.content == Content::Scene {
                "saved"
            } else {
                "exported"
            };
            app.set_done(format!("{how} to {path}"));
            if file.content == Content::Scene {
                app.edit.set_saved_as(&file.path);
            }
            if file.then_quit {
                ask_quit(app);
            }
        }
        Err(WriteFailure::Exists) => app.ask(Purpose::Overwrite(file), ""),
        Err(WriteFailure::Refused(error)) => {
            let is_scene = file.content == Content::Scene;
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

/// Leaves the explorer, or asks about unsaved changes first.
pub fn ask_quit(app: &mut App) {
    if app.edit.unsaved().is_empty() {
        app.finished = true;
    } else {
        app.ask(Purpose::Leave, "");
    }
}

pub fn copy_command(app: &mut App) {
    let measured = app
        .edit
        .measured
        .as_ref()
        .map_or_else(String::new, |Measured { path, options, .. }| {
            format!(" --measured={}{options}", quoted(path))
        });
    let program = format!("asperity{measured}");
    let command = command_line(
        &program,
        app.edit.document.name(),
        app.edit.document.overrides(),
    );
    if command.contains(is_control) {
        // Pasted into a shell they would act on its terminal.
        app.set_error(
            "not copied: control characters in the name of the file; allowed: a name without any",
        );
        return;
    }
    // The terminal does not confirm a copy, so the notice has the command too.
    app.set_done(format!("copied: {command}"));
    app.effects.push(Task::Copy(command));
}
