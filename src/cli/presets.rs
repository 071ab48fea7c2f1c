//! `asperity presets`: lists and shows the built-in scenes and the user's own, and checks scene
//! files.

use super::advice::advised;
use super::error::CliError;
use super::output::AnswerFormat;
use asperity_data::{Warning, printable, printable_lines};
use asperity_report::Sheet;
use asperity_scene::library::Entry;
use asperity_scene::{Document, Simulation};
use clap::Subcommand;
use serde::Serialize;
use std::io;
use std::io::{IsTerminal, Write};
use std::path::Path;

const CHECK_EXAMPLES: &str = "\
Examples:
  asperity presets check my-scene.ron other-scene.ron
  asperity presets show jkr-sphere | asperity presets check -

All errors of all files are printed with line and column. The exit code is 1 if there is an error.";

const SHOW_EXAMPLES: &str = "\
Example:
  asperity presets show rough-sphere > my-scene.ron";

/// Subcommands on scenes.
#[derive(Debug, Subcommand)]
pub enum PresetsCommand {
    /// List the built-in scenes, your own scenes and the scenes of the working folder
    List {
        /// Name and title in columns, or objects with name, title and notice, and of scenes of
        /// files path and error.
        #[command(flatten)]
        format: AnswerFormat,
    },
    /// Print a scene, as a template for your own
    #[command(after_help = SHOW_EXAMPLES)]
    Show {
        /// Its name
        name: String,
    },
    /// Check scenes without computing them
    #[command(after_help = CHECK_EXAMPLES)]
    Check {
        /// Scene files, or names of scenes; `-` is standard input
        #[arg(required = true, value_name = "FILE")]
        files: Vec<String>,
    },
}

pub(super) fn presets(command: &PresetsCommand, stdout: &mut dyn Write) -> Result<(), CliError> {
    match command {
        PresetsCommand::List { format } => list(*format, stdout),
        PresetsCommand::Show { name } => show(asperity_scene::open(name)?.text(), stdout),
        PresetsCommand::Check { files } => check(files, stdout),
    }
}

/// Prints the text of a scene. On a terminal, control characters are escaped, because the scene may
/// come from an unknown author.
fn show(text: &str, stdout: &mut dyn Write) -> Result<(), CliError> {
    let shown = if io::stdout().is_terminal() {
        printable_lines(text)
    } else {
        text.into()
    };
    Ok(stdout.write_all(shown.as_bytes())?)
}

fn list(format: AnswerFormat, stdout: &mut dyn Write) -> Result<(), CliError> {
    let entries = asperity_scene::library::scenes(
        asperity_scene::library::own_folder().as_deref(),
        Path::new("."),
    );
    let scenes = entries.iter().map(SceneEntry::of).collect();
    format.write(stdout, || table(&entries), &SceneList { scenes })
}

/// Returns a table of names and titles. If a scene has an error, the table shows the error in place
/// of the title.
fn table(entries: &[Entry]) -> String {
    let mut rows = Vec::with_capacity(entries.len());
    for entry in entries {
        let title = entry.error().unwrap_or_else(|| entry.title().to_owned());
        rows.push([entry.name.clone(), title]);
    }
    Sheet::of_table(&rows)
}

#[derive(Serialize)]
struct SceneList<'a> {
    scenes: Vec<SceneEntry<'a>>,
}

#[derive(Serialize)]
struct SceneEntry<'a> {
    name: &'a str,
    title: &'a str,
    notice: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    path: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    error: Option<String>,
}

impl SceneEntry<'_> {
    fn of(entry: &Entry) -> SceneEntry<'_> {
        SceneEntry {
            name: &entry.name,
            title: entry.title(),
            notice: entry.notice(),
            path: entry.path.as_ref().map(|path| path.display().to_string()),
            error: entry.error(),
        }
    }
}

fn check(files: &[String], stdout: &mut dyn Write) -> Result<(), CliError> {
    let mut wrong = Vec::new();
    for file in files {
        match checked(file) {
            Ok((name, warnings)) => {
                writeln!(stdout, "{}: ok", printable(&name))?;
                for warning in warnings {
                    writeln!(stdout, "{}: warning: {warning}", printable(&name))?;
                }
            }
            Err(errors) => wrong.push(errors),
        }
    }
    if wrong.is_empty() {
        Ok(())
    } else {
        Err(CliError::message(wrong.join("\n")))
    }
}

/// Returns the name of a valid scene with its warnings. For an invalid scene, returns an error that
/// contains all errors of the scene, one in each line.
fn checked(file: &str) -> Result<(String, Vec<Warning>), String> {
    let document =
        asperity_scene::library::open_argument(file).map_err(|errors| errors.to_string())?;
    match profile_error(&document) {
        None => Ok((document.name().into(), document.scene().warnings())),
        Some(error) => Err(error),
    }
}

/// Returns the error that occurs when the profile is made from a measured surface, with the path of
/// the wrong field. `None` if there is no error, or if the scene has no measured surface.
fn profile_error(document: &Document) -> Option<String> {
    let scene = document.scene();
    scene.measured()?;
    let error = Simulation::new(document.resolve(""))
        .make_line(scene)
        .err()?;
    let (line, column) = document.place("roughness.file");
    let error = advised(&error);
    Some(format!("{}:{line}:{column}: {error}", document.name()))
}
