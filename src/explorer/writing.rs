//! Files of the explorer: scenes, curves, figures of its panes, pictures of its screen.

use super::action::{Action, Content, OutputFile, WriteFailure};
use super::app::{App, Message};
use super::picture::{svg, text};
use super::theme::Theme;
use super::view;
use crate::draw::Palette;
use crate::export::{self, Format, RunReport, scene_provenance};
use crate::io::{WriteError, write_new_file};
use crate::scene::command_line;
use ratatui::Terminal;
use ratatui::backend::TestBackend;
use ratatui::buffer::Buffer;
use std::io::{self, Write};
use std::path::{Path, is_separator};

/// Writes a regular file, relative to a folder: a pipe would block. A scene gets the extension `.ron` unless its name has
/// one or is that of something else than a file. Returns the file with its name, and the result.
pub(super) fn write(app: &App, folder: &Path, mut file: OutputFile) -> Action {
    let mut written = || {
        let path = folder.join(&file.path);
        let is_file = path.is_file() || !(path.exists() || path.to_string_lossy().ends_with(is_separator));
        if file.content == Content::Scene && file.path.extension().is_none() && is_file {
            file.path.set_extension("ron");
        }
        write_new_file(&folder.join(&file.path), file.overwrite, |out| {
            write_content(out, app, &file.path, file.content)
        })
    };
    let result = written().map_err(|error| match error {
        WriteError::Exists { .. } => WriteFailure::Exists,
        other => WriteFailure::Refused(other.to_string()),
    });
    Action::Written(file, result)
}

fn write_content(file: &mut dyn Write, app: &App, path: &Path, content: Content) -> io::Result<()> {
    let no_map = || io::Error::other("there is no map yet");
    let no_curve = || io::Error::other("the scene has no curve yet");
    let computed = || app.current().ok_or_else(no_curve);
    match content {
        Content::Scene => file.write_all(app.edit.document.text().as_bytes()),
        Content::Outcome(format) => {
            let (document, destination) = (&app.edit.document, path.parent().unwrap_or(Path::new("")));
            let (scene, folder) = (document.scene(), document.resolve(""));
            let command = command_line("asperity run", document.name(), document.overrides());
            let provenance = match format {
                Format::Json => String::new(),
                _ => scene_provenance(&command, scene, &folder, destination).map_err(io::Error::other)?,
            };
            let (title, outcome) = (document.title(), &computed()?.outcome);
            let estimate = app.studies.value();
            let report = RunReport { title, scene, outcome, choice: None, estimate };
            export::write(file, &report, format, &provenance)
        }
        Content::Figure(format) => {
            let figure = app.figure().ok_or_else(|| io::Error::other("the pane is empty"))?;
            export::write(file, &figure, format, "")
        }
        Content::MapCells => export::write(file, app.grid().ok_or_else(no_map)?, Format::Csv, ""),
        Content::Text => file.write_all(text(&picture_of(app)).as_bytes()),
    }
}

/// The screen as an SVG document, on a background that suits its colours.
#[must_use]
pub fn screenshot(app: &App) -> String {
    let palette = if app.view.appearance.theme == Theme::Light { Palette::LIGHT } else { Palette::DARK };
    let name = Path::new(app.edit.document.name()).file_stem().unwrap_or_default();
    svg(&picture_of(app), &palette, &format!("Asperity: {}", name.to_string_lossy()))
}

/// The screen without any question or line of text.
#[must_use]
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
