//! `asperity presets`: the built-in scenes and the user's own, and checking scene files.

use super::{CliError, Format};
use crate::export::sheet::Sheet;
use crate::io::write_json_value;
use crate::scene::{self, Document, Entry, Library, Text, line_column};
use crate::simulation::measured_options;
use crate::surface::MeasuredRoughness;
use crate::text::printable;
use clap::Subcommand;
use serde::Serialize;
use std::io::{self, Write};
use std::path::Path;

const CHECK_EXAMPLES: &str = "\
Examples:
  asperity presets check my-scene.ron other-scene.ron
  asperity presets show jkr-sphere | asperity presets check -

Every error of every file is printed with its line and column. The exit code is 1 if there is any.";

const SHOW_EXAMPLES: &str = "\
Example:
  asperity presets show rough-sphere > my-scene.ron";

/// Subcommands on scenes.
#[derive(Debug, Subcommand)]
pub enum PresetsCommand {
    /// List the built-in scenes, one's own and those of the working folder
    List {
        /// Format of the list
        #[arg(long, value_parser = Format::parser(FORMATS), default_value = "text")]
        format: Format,
    },
    /// Print the text of a listed scene, to start one's own from
    #[command(after_help = SHOW_EXAMPLES)]
    Show {
        /// Its name
        name: String,
    },
    /// Check scene files, without computing anything
    #[command(after_help = CHECK_EXAMPLES)]
    Check {
        /// Scene files; `-` is standard input
        #[arg(required = true, value_name = "FILE")]
        files: Vec<String>,
    },
}

/// Formats of the list: name and title in columns, or objects with name, title and notice, and of scenes of files path
/// and error.
const FORMATS: &[Format] = &[Format::Text, Format::Json];

/// A scene in the list.
#[derive(Serialize)]
struct Listed {
    name: String,
    title: String,
    notice: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    path: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    error: Option<String>,
}

/// Does one of the commands.
pub(super) fn presets(command: &PresetsCommand, stdout: &mut dyn Write) -> Result<(), CliError> {
    match command {
        PresetsCommand::List { format } => list(*format, stdout),
        PresetsCommand::Show { name } => show(name, stdout),
        PresetsCommand::Check { files } => check(files, stdout),
    }
}

fn list(format: Format, stdout: &mut dyn Write) -> Result<(), CliError> {
    let library = Library::of_environment();
    let entries = library.list();
    match format {
        Format::Json => {
            let listed: Vec<_> = entries.into_iter().map(Listed::from).collect();
            write_json_value(stdout, &listed)?;
        }
        _ => {
            let row = |entry: Entry| [entry.name, entry.error.unwrap_or(entry.title)];
            let rows: Vec<_> = entries.into_iter().map(row).collect();
            let mut sheet = Sheet::default();
            sheet.table(&rows);
            stdout.write_all(sheet.into_text().as_bytes())?;
        }
    }
    Ok(())
}

impl From<Entry> for Listed {
    fn from(entry: Entry) -> Listed {
        let path = entry.path.map(|path| path.display().to_string());
        let Entry { name, title, notice, error, .. } = entry;
        Listed { name, title, notice, path, error }
    }
}

fn show(name: &str, stdout: &mut dyn Write) -> Result<(), CliError> {
    if let Some(preset) = scene::find(name) {
        return Ok(stdout.write_all(preset.text.as_bytes())?);
    }
    if let Some(entry) = Library::of_environment().list().into_iter().find(|entry| entry.name == name) {
        return Ok(stdout.write_all(entry.document()?.text().as_bytes())?);
    }
    let names: Vec<_> = scene::presets().iter().map(|preset| preset.name).collect();
    Err(CliError::named(name, format!("there is no such built-in scene; allowed: {}", names.join(", "))))
}

fn check(files: &[String], stdout: &mut dyn Write) -> Result<(), CliError> {
    let mut wrong = Vec::new();
    for file in files {
        match checked(file) {
            Ok(name) => writeln!(stdout, "{}: ok", printable(&name))?,
            Err(errors) => wrong.push(errors),
        }
    }
    if wrong.is_empty() { Ok(()) } else { Err(CliError::Checked(wrong)) }
}

/// The name of a scene in which nothing is wrong, or all that is, line by line.
fn checked(file: &str) -> Result<String, String> {
    let document = of_file(file)?;
    match profile_error(&document) {
        None => Ok(document.name().into()),
        Some(error) => Err(error),
    }
}

fn of_file(file: &str) -> Result<Document, String> {
    if file == "-" {
        return scene::open_argument(file).map_err(|errors| errors.to_string());
    }
    let path = Path::new(file);
    // Names of built-in scenes are no files.
    match path.metadata() {
        Err(error) if error.kind() == io::ErrorKind::NotFound => {
            Err(format!("{file}: there is no such file"))
        }
        Err(error) => Err(format!("{file}: cannot be read: {error}")),
        Ok(found) if found.is_dir() => Err(format!("{file}: this is a folder; allowed: files")),
        Ok(_) => scene::open_argument(file).map_err(|errors| errors.to_string()),
    }
}

/// Error of the measured surface that a scene names, with its place in the scene.
fn profile_error(document: &Document) -> Option<String> {
    let scene = document.scene();
    let files: Vec<_> = scene.measured_files().into_iter().map(|file| document.resolve(file)).collect();
    if files.is_empty() {
        return None;
    }
    let error = match MeasuredRoughness::read(&files, &measured_options(scene), &mut |_| ()) {
        Err(error) => error.to_string(),
        Ok(measured) => measured.check(scene.length, scene.numerics.points as usize).err()?,
    };
    let offset = Text::new(document.text())
        .ok()
        .and_then(|text| text.span("roughness.file"))
        .map_or(0, |span| span.value.start);
    let (line, column) = line_column(document.text(), offset);
    Some(format!("{}:{line}:{column}: {error}", document.name()))
}
