//! Files that the explorer writes: scenes, curves, figures of panes, and pictures of the screen.

use super::action::{Action, Content, OutputFile, WriteFailure};
use super::app::{App, Message};
use super::commands::manual::with_path;
use super::commands::map_over::plan;
use super::pane::Pane;
use super::panes;
use super::panes::row::{Exported, OPEN_COMMAND};
use super::view;
use crate::explorer::command_line::command_line;
use asperity_data::{Table, WriteError, write_new_file};
use asperity_plot::{Colours, Figure, screen_svg, screen_text};
use asperity_report::{Format, Json, Report, printed_pixels, scene_provenance};
use asperity_scene::Scene;
use asperity_scene::library::own_folder;
use ratatui::Terminal;
use ratatui::backend::TestBackend;
use ratatui::buffer::Buffer;
use serde::Serialize;
use std::fs::{create_dir_all, read_to_string};
use std::io;
use std::io::Write;
use std::path::{Path, is_separator};

/// Writes a file, whose path is relative to `folder`. Only regular files are written: a pipe is
/// refused, because writing to a pipe could wait for ever. A scene file without an extension gets
/// the extension `.ron`, unless its path leads to something other than a file, such as a folder.
/// Returns the action that reports the final name of the file and whether it was written.
pub(super) fn write(app: &App, folder: &Path, mut file: OutputFile) -> Action {
    let is_ron = matches!(file.content, Content::Scene | Content::Plan);
    if is_ron && file.path.extension().is_none() && can_be_file(&folder.join(&file.path)) {
        file.path.set_extension("ron");
    }
    let result = write_file(app, folder, &file).map_err(|error| match error {
        WriteError::Exists { .. } => WriteFailure::Exists {
            is_changed: file.content == Content::Scene && is_changed(app, folder, &file.path),
        },
        other => WriteFailure::Refused(other.to_string()),
    });
    Action::Written(file, result)
}

/// Returns true if a file is the one of the scene, and its text is not the one that the explorer
/// has last read from it or written to it.
fn is_changed(app: &App, folder: &Path, path: &Path) -> bool {
    let name = app.edit.document.name();
    let Some(saved) = app.edit.saved.get(name) else {
        return false;
    };
    let is_own = Path::new(name) == path;
    is_own
        && read_to_string(folder.join(path))
            .is_ok_and(|text| text != saved.text() && text != saved.text_for_own_file())
}

/// Returns true if the path leads to a file, or if nothing exists at the path and the path does not
/// end like the path of a folder.
fn can_be_file(path: &Path) -> bool {
    let ends_as_folder = path.to_string_lossy().ends_with(is_separator);
    path.is_file() || !path.exists() && !ends_as_folder
}

fn write_file(app: &App, folder: &Path, file: &OutputFile) -> Result<(), WriteError> {
    let path = folder.join(&file.path);
    // This folder is created when the user first saves a scene of their own.
    if let Some(own) = own_folder()
        && path.parent() == Some(&own)
    {
        create_dir_all(&own).map_err(|reason| WriteError::Failed {
            path: own.clone(),
            reason,
        })?;
    }
    write_new_file(&path, file.overwrite, |out| write_content(out, app, file))
}

fn write_content(out: &mut dyn Write, app: &App, file: &OutputFile) -> io::Result<()> {
    match file.content {
        Content::Scene => out.write_all(app.edit.document.text_for_own_file().as_bytes()),
        Content::Plan => {
            let plan = plan(app, app.edit.count_profiles()).map_err(io::Error::other)?;
            out.write_all(plan.to_ron().as_bytes())
        }
        Content::Pane(Format::Text) => out.write_all(text_of(app).as_bytes()),
        Content::Pane(format) => write_pane(out, app, file, format),
    }
}

/// Writes the content of the selected pane, and the command that computes this content.
fn write_pane(out: &mut dyn Write, app: &App, file: &OutputFile, format: Format) -> io::Result<()> {
    let Some((command, report)) = exported(app, format) else {
        let why = "the selected pane has nothing yet to export";
        return Err(io::Error::other(why));
    };
    // If manual loading is exported, the command opens a scene whose loading is the path of manual
    // loading.
    let opened = match with_path(app) {
        Some(Ok(document)) if command == OPEN_COMMAND => Some(document),
        _ => None,
    };
    let document = opened.as_ref().unwrap_or(&app.edit.document);
    let command = command_line(&command, document.name(), document.overrides());
    let folder = document.resolve("");
    let destination = file.path.parent().unwrap_or(Path::new(""));
    let provenance = scene_provenance(&command, document.scene(), &folder, destination)
        .map_err(io::Error::other)?;
    if format == Format::Json && report.json().is_none() {
        let table = SceneTable {
            scene: document.scene(),
            table: &*report,
        };
        return asperity_report::write(out, &table, format, &provenance);
    }
    if format.is_picture()
        && let Some(width) = file.width
        && let Some(figure) = report.figure()
    {
        let figure = Figure {
            width: Some(printed_pixels(1e-6 * f64::from(width))),
            ..figure
        };
        return asperity_report::write(out, &figure, format, &provenance);
    }
    asperity_report::write(out, &*report, format, &provenance)
}

/// Returns the content of the selected pane as a report. For a picture, the report is the figure of
/// the pane. For data, it is the result of the pane or, if the pane has no result, the curves of
/// its figure.
fn exported(app: &App, format: Format) -> Exported<'_> {
    if !format.is_picture() {
        let result = (panes::row(app.view.pane).report)(app);
        if result.is_some() {
            return result;
        }
    }
    let drawn = figure(app)?;
    let has_table = app.is_current() && drawn.table().is_some();
    if !format.is_picture() && !has_table {
        return None;
    }
    Some((OPEN_COMMAND.into(), Box::new(drawn)))
}

/// Table of a pane together with its scene. It is written as JSON if the result of the pane has no
/// JSON of its own.
struct SceneTable<'a> {
    scene: &'a Scene,
    table: &'a dyn Report,
}

impl Report for SceneTable<'_> {
    fn json(&self) -> Option<Box<dyn Json + '_>> {
        Some(Box::new(SceneRows {
            scene: self.scene,
            rows: self.table.table()?,
        }))
    }
}

/// A scene and the rows of a table, in the order of the keys of the JSON.
#[derive(Serialize)]
struct SceneRows<'a> {
    scene: &'a Scene,
    rows: Table<'a>,
}

/// Returns the figure of the selected pane. For the list of parameters, returns the force curve.
fn figure(app: &App) -> Option<Figure> {
    let pane = if app.view.pane == Pane::Parameters {
        Pane::Force
    } else {
        app.view.pane
    };
    panes::figure(app, pane)
}

/// Returns the screen as an SVG document, with a background that suits the colours.
pub fn screenshot(app: &App) -> String {
    let path = Path::new(app.edit.document.name());
    let name = path.file_stem().unwrap_or_default();
    let title = format!("Asperity: {}", name.to_string_lossy());
    let colours = match app.view.appearance.colours {
        Colours::Plain => Colours::Plain,
        // A picture has all colours, whatever the terminal can show.
        Colours::Ansi16 | Colours::Ansi256 | Colours::TrueColour => Colours::TrueColour,
    };
    screen_svg(
        &picture_of(app, colours),
        app.view.appearance.palette(),
        &title,
    )
}

/// Returns the screen as text. What colours show on a screen, characters show in the text.
pub fn text_of(app: &App) -> String {
    screen_text(&picture_of(app, Colours::Plain))
}

/// Returns the screen with these colours, without prompts and questions. Of the messages, only
/// errors are shown.
fn picture_of(app: &App, colours: Colours) -> Buffer {
    let mut app = app.clone();
    app.view.appearance.colours = colours;
    app.prompt = None;
    if !matches!(app.message, Some(Message::Error(_))) {
        app.message = None;
    }
    let (columns, rows) = app.view.size;
    let mut terminal = match Terminal::new(TestBackend::new(columns, rows)) {
        Ok(terminal) => terminal,
        Err(never) => match never {},
    };
    match terminal.draw(|frame| view::draw(frame, &app)) {
        Ok(_) => {}
        Err(never) => match never {},
    }
    terminal.backend().buffer().clone()
}
