//! Output of the explorer: scene files, exports, and the command that opens the scene.

use super::edit;
use crate::explorer::action::{Content, EXPORTS, OutputFile, Task, WriteFailure};
use crate::explorer::app::{App, ExportKind};
use crate::explorer::command_line::{command_line, curve_arguments};
use crate::explorer::measured::Measured;
use crate::explorer::pane::Pane;
use crate::explorer::prompt::Purpose;
use asperity_data::{is_control, parse_quantity};
use asperity_report::{Format, LEAST_WIDTH, check_extension, parse_printed_length};
use asperity_scene::Document;
use asperity_scene::library::typed_path;
use asperity_scene::text::quoted;
use std::path::{Path, PathBuf};

/// Asks for the name of a file for the scene. If a live map is selected, asks for the name of a
/// file for its plan instead.
pub fn ask_save(app: &mut App, then_quit: bool) {
    let is_map = app.view.pane == Pane::Map && app.map.shown_study().is_none();
    if is_map && !then_quit && app.map.plan(app.edit.document.scene()).is_ok() {
        let file = format!("{}-map.ron", stem(app));
        return app.ask(Purpose::SavePlan, &file);
    }
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

pub fn save_plan(app: &mut App, path: PathBuf) -> Result<(), String> {
    check_extension(&path, &["ron"])?;
    write(app, path, Content::Plan, false)
}

/// Returns the name of the scene without folders and extension.
fn stem(app: &App) -> String {
    match Path::new(app.edit.document.name()).file_stem() {
        Some(stem) => stem.to_string_lossy().into_owned(),
        None => "scene".to_owned(),
    }
}

fn write(app: &mut App, path: PathBuf, content: Content, then_quit: bool) -> Result<(), String> {
    if path.as_os_str().is_empty() {
        return Err("type the name of a file".to_owned());
    }
    let is_figure = matches!(content, Content::Pane(format) if format.is_picture());
    app.effects.push(Task::Write(OutputFile {
        path,
        content,
        width: app.view.export.width.filter(|_| is_figure),
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
    let ExportKind { mut format, width } = app.view.export;
    if app.view.pane == Pane::Events && format.is_picture() {
        // A list has no figure of its own.
        format = Format::Csv;
    }
    let name = format!("{}-{}", stem(app), app.view.pane.file_name());
    let width = match width.filter(|_| format.is_picture()) {
        Some(width) => format!(" {}mm", f64::from(width) / MICROMETRES_IN_MM),
        None => String::new(),
    };
    let file = format!("{name}.{}{width}", format.extension());
    app.ask(Purpose::Export, &file);
}

const MICROMETRES_IN_MM: f64 = 1e3;

/// File and width of a figure, as the user has typed them.
struct TypedExport<'a> {
    file: &'a str,
    /// Width in µm; `None` for the usual width.
    width: Option<u32>,
}

impl TypedExport<'_> {
    /// Takes a width such as `85mm` or `85 mm` off the end of a typed text. A file name that
    /// contains blanks stays whole.
    fn read(typed: &str) -> Result<TypedExport<'_>, String> {
        let whole = TypedExport {
            file: typed,
            width: None,
        };
        let mut places = typed.rmatch_indices(' ').map(|(place, _)| place);
        let width = places.by_ref().take(2).find_map(|place| {
            let (file, width) = typed.split_at(place);
            let is_length = parse_quantity(width.trim(), "m").is_ok();
            is_length.then_some((file.trim_end(), width.trim()))
        });
        let Some((file, width)) = width else {
            return Ok(whole);
        };
        // A number alone is no width: `figure 2` is the name of a file.
        if width.ends_with(|last: char| last.is_ascii_digit()) {
            return Ok(whole);
        }
        let length = parse_printed_length(width, LEAST_WIDTH)
            .map_err(|why| format!("width {width}: {why}"))?;
        let width = Some((1e6 * length).round() as u32);
        Ok(TypedExport { file, width })
    }
}

/// Exports the selected pane to a file. The extension of the file name determines the format. A
/// figure may have a width after its name, as in `loop.pdf 85mm`.
pub fn export(app: &mut App, typed: &str) -> Result<(), String> {
    let TypedExport { file, width } = TypedExport::read(typed)?;
    let path = typed_path(file);
    let extensions = EXPORTS.map(Format::extension);
    let Some(place) = check_extension(&path, &extensions)? else {
        let extensions = extensions.map(|extension| format!(".{extension}"));
        return Err(format!(
            "the extension chooses the format; use one of {}",
            extensions.join(", ")
        ));
    };
    let format = EXPORTS[place];
    if width.is_some() && !format.is_picture() {
        return Err(format!("a .{} file has no width", format.extension()));
    }
    app.view.export = ExportKind { format, width };
    write(app, path, Content::Pane(format), false)
}

/// Shows a message whether a file has been written. Then takes the next step, which may be a
/// question to the user or the end of the explorer.
pub fn written(app: &mut App, file: OutputFile, result: Result<(), WriteFailure>) {
    let path = file.path.display();
    let is_scene = file.content == Content::Scene;
    match result {
        Ok(()) if file.content == Content::Plan => {
            app.set_done(format!(
                "plan saved to {path}; y copies the command of its study"
            ));
            app.map.plan_file = Some(file.path);
        }
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
        Err(WriteFailure::Exists { is_changed }) => {
            app.ask(Purpose::Overwrite { file, is_changed }, "");
        }
        Err(WriteFailure::Refused(error)) => {
            let purpose = if is_scene {
                Purpose::Save {
                    then_quit: file.then_quit,
                }
            } else if file.content == Content::Plan {
                Purpose::SavePlan
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
/// curve. If a map over chosen axes is selected, copies the command that computes its study.
pub fn copy_command(app: &mut App) {
    let is_map = app.view.pane == Pane::Map && app.map.shown_study().is_none();
    if is_map && let Some(file) = &app.map.plan_file {
        let plan = quoted(file);
        let study = quoted(file.with_extension(""));
        return copy(app, format!("asperity sweep {plan} -o {study}"));
    }
    if is_map && app.map.chosen.is_some() {
        return app.set_error("the command needs a file: s saves the plan of this map");
    }
    let measured = match &app.edit.measured {
        Some(Measured { path, options, .. }) => {
            format!(" --measured={}{}", quoted(path), curve_arguments(options))
        }
        None => String::new(),
    };
    let document = &app.edit.document;
    let profiles = app.edit.profiles_argument();
    let program = format!("asperity{profiles}{measured}");
    let command = command_line(&program, document.name(), document.overrides());
    copy(app, command);
}

fn copy(app: &mut App, command: String) {
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
