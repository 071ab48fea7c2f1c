//! Files that the explorer writes: scenes, curves, figures of panes, and pictures of the screen.

use super::action::{Action, Content, OutputFile, WriteFailure};
use super::app::{App, Message};
use super::commands::stages::with_path;
use super::pane::Pane;
use super::panes;
use super::panes::row::{Exported, OPEN_COMMAND};
use super::theme::Theme;
use super::view;
use crate::explorer::command_line::command_line;
use asperity_data::{Table, WriteError, write_new_file};
use asperity_plot::{Figure, Palette, screen_svg, screen_text};
use asperity_report::{Format, Json, Report, scene_provenance};
use asperity_scene::Scene;
use asperity_scene::library::own_folder;
use ratatui::Terminal;
use ratatui::backend::TestBackend;
use ratatui::buffer::Buffer;
use serde::Serialize;
use std::fs::create_dir_all;
use std::io;
use std::io::Write;
use std::path::{Path, is_separator};

/// Writes a file, whose path is relative to `folder`. Only regular files are written: a pipe is
/// refused, because writing to a pipe could wait for ever. A scene file without an extension gets
/// the extension `.ron`, unless its path leads to something other than a file, such as a folder.
/// Returns the action that reports the final name of the file and whether it was written.
pub(super) fn write(app: &App, folder: &Path, mut file: OutputFile) -> Action {
    let is_scene = file.content == Content::Scene;
    if is_scene && file.path.extension().is_none() && can_be_file(&folder.join(&file.path)) {
        file.path.set_extension("ron");
    }
    let result = write_file(app, folder, &file).map_err(|error| match error {
        WriteError::Exists { .. } => WriteFailure::Exists,
        other => WriteFailure::Refused(other.to_string()),
    });
    Action::Written(file, result)
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
    write_new_file(&path, file.overwrite, |out| {
        write_content(out, app, &file.path, file.content)
    })
}

fn write_content(out: &mut dyn Write, app: &App, path: &Path, content: Content) -> io::Result<()> {
    match content {
        Content::Scene => out.write_all(app.edit.document.text_for_own_file().as_bytes()),
        Content::Pane(Format::Text) => out.write_all(screen_text(&picture_of(app)).as_bytes()),
        Content::Pane(format) => write_pane(out, app, path, format),
    }
}

/// Writes the content of the selected pane, and the command that computes this content.
fn write_pane(out: &mut dyn Write, app: &App, path: &Path, format: Format) -> io::Result<()> {
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
    let destination = path.parent().unwrap_or(Path::new(""));
    let provenance = scene_provenance(&command, document.scene(), &folder, destination)
        .map_err(io::Error::other)?;
    if format == Format::Json && report.json().is_none() {
        let table = SceneTable {
            scene: document.scene(),
            table: &*report,
        };
        return asperity_report::write(out, &table, format, &provenance);
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
    let palette = if app.view.appearance.theme == Theme::Light {
        Palette::LIGHT
    } else {
        Palette::DARK
    };
    let path = Path::new(app.edit.document.name());
    let name = path.file_stem().unwrap_or_default();
    let title = format!("Asperity: {}", name.to_string_lossy());
    screen_svg(&picture_of(app), &palette, &title)
}

/// Returns the screen without prompts and questions. Of the messages, only errors are shown.
pub fn picture_of(app: &App) -> Buffer {
    let mut app = app.clone();
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
