//! Files that the explorer writes: scenes, curves, figures of panes, pictures of the screen.

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

/// Writes a regular file, relative to a folder; a pipe would block. The name of a scene gets the
/// extension `.ron` if it has none, unless it names something that is no file. Returns the file
/// with its final name, and the result.
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

/// Returns true for a path of a file, or of nothing that ends as a folder does.
fn can_be_file(path: &Path) -> bool {
    let ends_as_folder = path.to_string_lossy().ends_with(is_separator);
    path.is_file() || !path.exists() && !ends_as_folder
}

fn write_file(app: &App, folder: &Path, file: &OutputFile) -> Result<(), WriteError> {
    let path = folder.join(&file.path);
    // The folder of the user's own scenes is made for the first of them.
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

/// Writes the selected pane, with the command that computes its content.
fn write_pane(out: &mut dyn Write, app: &App, path: &Path, format: Format) -> io::Result<()> {
    let Some((command, report)) = exported(app, format) else {
        let why = "the selected pane has nothing yet to export";
        return Err(io::Error::other(why));
    };
    // The command opens the path of manual loading as the loading of the scene.
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

/// The selected pane as a report: for a picture its figure, otherwise its result, or without one
/// the curves of its figure.
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

/// The table of a pane beside its scene, as JSON of a result that has no other.
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

/// The selected pane as a figure; the force curve while the parameters are selected.
fn figure(app: &App) -> Option<Figure> {
    let pane = if app.view.pane == Pane::Parameters {
        Pane::Force
    } else {
        app.view.pane
    };
    panes::figure(app, pane)
}

/// The screen as an SVG document, on a background that suits its colours.
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

/// The screen without prompts, questions and messages other than errors.
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
