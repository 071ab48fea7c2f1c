//! Files that the explorer writes: scenes, curves, figures of panes, pictures of the screen.

use super::action::{Action, Content, OutputFile, WriteFailure};
use super::app::{App, Message};
use super::commands::stages::with_path;
use super::pane::Pane;
use super::panes;
use super::panes::row::OPEN_COMMAND;
use super::theme::Theme;
use super::view;
use asperity_data::{WriteError, object, write_new_file};
use asperity_plot::{Figure, Palette, screen_svg, screen_text};
use asperity_report::{Format, Json, Report, scene_provenance};
use asperity_scene::Scene;
use asperity_scene::library::own_folder;
use asperity_scene::text::command_line;
use ratatui::Terminal;
use ratatui::backend::TestBackend;
use ratatui::buffer::Buffer;
use std::fs::create_dir_all;
use std::io;
use std::io::Write;
use std::path::{Path, is_separator};

/// Writes a regular file, relative to a folder; a pipe would block. The name of a scene gets the
/// extension `.ron` if it has none, unless it names something that is no file. Returns the file
/// with its final name, and the result.
pub(super) fn write(app: &App, folder: &Path, mut file: OutputFile) -> Action {
    let mut written = || {
        let path = folder.join(&file.path);
        let is_file =
            path.is_file() || !(path.exists() || path.to_string_lossy().ends_with(is_separator));
        if file.content == Content::Scene && file.path.extension().is_none() && is_file {
            file.path.set_extension("ron");
        }
        let path = folder.join(&file.path);
        // The folder of the user's own scenes comes with the first of them.
        if let Some(own) = own_folder().filter(|own| path.parent() == Some(own)) {
            create_dir_all(&own).map_err(|reason| WriteError::Failed {
                path: own.clone(),
                reason,
            })?;
        }
        write_new_file(&path, file.overwrite, |out| {
            write_content(out, app, &file.path, file.content)
        })
    };
    let result = written().map_err(|error| match error {
        WriteError::Exists { .. } => WriteFailure::Exists,
        other => WriteFailure::Refused(other.to_string()),
    });
    Action::Written(file, result)
}

fn write_content(out: &mut dyn Write, app: &App, path: &Path, content: Content) -> io::Result<()> {
    let missing = || io::Error::other("the selected pane has nothing yet to export");
    match content {
        Content::Scene => out.write_all(app.edit.document.text_for_own_file().as_bytes()),
        Content::Pane(Format::Text) => out.write_all(screen_text(&picture_of(app)).as_bytes()),
        Content::Pane(format) => {
            let drawn = |figure: Figure| (OPEN_COMMAND.into(), Box::new(figure) as Box<dyn Report>);
            let has_table = |figure: &Figure| app.is_current() && figure.table().is_some();
            let report = if format.is_picture() {
                figure(app).map(drawn)
            } else {
                let report = (panes::row(app.view.pane).report)(app);
                report.or_else(|| figure(app).filter(has_table).map(drawn))
            };
            let (command, report) = report.ok_or_else(missing)?;
            let kept = if command == OPEN_COMMAND {
                with_path(app).and_then(Result::ok)
            } else {
                None
            };
            let document = kept.as_ref().unwrap_or(&app.edit.document);
            let command = command_line(&command, document.name(), document.overrides());
            let (folder, destination) =
                (document.resolve(""), path.parent().unwrap_or(Path::new("")));
            let provenance = scene_provenance(&command, document.scene(), &folder, destination);
            let provenance = provenance.map_err(io::Error::other)?;
            let beside_scene = SceneTable {
                scene: document.scene(),
                table: &*report,
            };
            let is_table_alone = format == Format::Json && report.json().is_none();
            let report: &dyn Report = if is_table_alone {
                &beside_scene
            } else {
                &*report
            };
            asperity_report::write(out, report, format, &provenance)
        }
    }
}

/// The table of a pane beside its scene, as JSON of a result that has no other.
struct SceneTable<'a> {
    scene: &'a Scene,
    table: &'a dyn Report,
}

impl Report for SceneTable<'_> {
    fn json(&self) -> Option<Box<dyn Json + '_>> {
        Some(Box::new(
            object! { "scene": self.scene, "rows": self.table.table()? },
        ))
    }
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
    let name = Path::new(app.edit.document.name())
        .file_stem()
        .unwrap_or_default();
    screen_svg(
        &picture_of(app),
        &palette,
        &format!("Asperity: {}", name.to_string_lossy()),
    )
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
