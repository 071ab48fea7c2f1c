//! `asperity [SCENE]`: opens the explorer on a scene or on a finished study.

use super::advice::option;
use super::error::CliError;
use super::scene::{Overrides, compute, open_scene};
use crate::explorer::autosave;
use crate::explorer::autosave::Newest;
use crate::explorer::commands::table::bindings;
use crate::explorer::config::{Config, default_path};
use crate::explorer::ghost::Ghost;
use crate::explorer::measured::Measured;
use crate::explorer::opening::{Opening, OpeningError};
use crate::explorer::profiles::ALLOWED;
use crate::explorer::recognition::{no_curve, no_scene};
use crate::explorer::session::Options;
use crate::explorer::theme::{Marker, Theme};
use crate::explorer::view;
use asperity_data::path_name;
use asperity_experiment::CurveOptions;
use asperity_report::brief_summary;
use asperity_scene::Simulation;
use asperity_scene::text::{nearest, quoted};
use clap::Args;
use std::fmt::Display;
use std::io::{IsTerminal, Write, stdin, stdout};
use std::path::{Path, PathBuf};

#[derive(Args, Debug)]
pub struct ExploreArguments {
    /// Explore this scene file, built-in scene (see `asperity presets list`), or merged study
    ///
    /// The folder of a merged study opens its map, or the section along its only axis.
    /// Default: `scene` of the configuration file, else pressure-sensitive.
    #[arg(verbatim_doc_comment)]
    pub scene: Option<String>,
    #[command(flatten)]
    pub overrides: Overrides,
    /// Compare with this scene: its curve is shown as a ghost
    #[arg(long, value_name = "OTHER", conflicts_with = "restore")]
    pub compare: Option<String>,
    /// Show medians over COUNT random profiles; default: 16
    ///
    /// The row `profiles` of the explorer changes it. A fixed profile is the only one.
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u64).range(ALLOWED), verbatim_doc_comment)]
    pub profiles: Option<u64>,
    #[command(flatten)]
    pub look: LookArguments,
    /// Open the unsaved changes of a session that was interrupted
    ///
    /// While the explorer runs, unsaved changes are kept in ~/.local/state/asperity/unsaved.
    /// They are removed on saving and on leaving without saving.
    #[arg(long, conflicts_with_all = ["scene", "set"], verbatim_doc_comment)]
    pub restore: bool,
    /// Show this measured force curve with the residual of the scene
    #[arg(
        long,
        value_name = "CURVE",
        conflicts_with = "restore",
        help_heading = "Measured curve"
    )]
    pub measured: Option<PathBuf>,
    #[command(flatten, next_help_heading = "Measured curve")]
    pub reading: CurveOptions,
}

/// Colours and markers of the explorer, and its configuration.
#[derive(Args, Debug)]
pub struct LookArguments {
    /// Background of the terminal
    ///
    /// Default: chosen from COLORFGBG.
    #[arg(long, value_enum)]
    pub theme: Option<Theme>,
    /// Marker of plots
    ///
    /// Default: braille.
    #[arg(long, value_enum)]
    pub marker: Option<Marker>,
    /// Read this configuration file; none: read no file
    ///
    /// Default: asperity/config.ron in the configuration folder of the user (~/.config),
    /// if it exists.
    #[arg(long, value_name = "FILE", verbatim_doc_comment)]
    pub config: Option<PathBuf>,
}

impl LookArguments {
    /// Returns the options of the explorer that follow from the arguments and the configuration
    /// file. If the usual configuration file has an error, the explorer opens with a warning and
    /// with default values.
    ///
    /// # Errors
    /// Returns the first error of a configuration file that the user has named on the command line.
    pub(super) fn options(&self) -> Result<Options, CliError> {
        let defaults = || Config::new(bindings());
        let (config, warning) = match (&self.config, default_path()) {
            (Some(path), _) if path == Path::new("none") => (defaults(), None),
            (Some(path), _) => (
                Config::read(path, true, bindings()).map_err(CliError::message)?,
                None,
            ),
            (None, Some(path)) => match Config::read(&path, false, bindings()) {
                Ok(config) => (config, None),
                Err(error) => (defaults(), Some(format!("{error}; defaults are used"))),
            },
            _ => (defaults(), None),
        };
        Ok(Options {
            theme: self.theme,
            marker: self.marker,
            warning,
            ..Options::new(config)
        })
    }
}

/// Opens the explorer on a scene or a study. `commands` are the names of all commands. If the
/// argument names neither a scene nor a study, the error message proposes a command with a similar
/// name.
///
/// After the explorer is closed, a brief summary of the last scene is printed.
pub(super) fn explore(
    arguments: &ExploreArguments,
    commands: &str,
    out: &mut dyn Write,
) -> Result<(), CliError> {
    let unsaved = autosave::folder();
    let mut options = arguments.look.options()?;
    if arguments.restore {
        let Newest { kept, unreadable } = restored(unsaved.as_deref())?;
        options.restored = kept;
        let skipped = unreadable
            .into_iter()
            .map(|why| format!("{why}; older unsaved changes are open"));
        let warnings: Vec<String> = options.warning.into_iter().chain(skipped).collect();
        options.warning = (!warnings.is_empty()).then(|| warnings.join(" · "));
    }
    options.unsaved = unsaved;
    let first = options
        .restored
        .as_ref()
        .and_then(|kept| kept.documents.first().cloned());
    let opening = first.map_or_else(
        || opening(arguments, &options.config.scene, commands),
        |document| Ok(document.into()),
    )?;
    if !stdin().is_terminal() || !stdout().is_terminal() {
        let name = quoted(opening.document.name());
        let (command, does) = match opening.study_map {
            None => ("run", "computes the scene"),
            Some(_) => ("sweep plot", "draws the study"),
        };
        let without = format!("asperity {command} {name} {does} without one");
        return Err(CliError::message(format!(
            "the explorer needs a terminal; {without}"
        )));
    }
    open(opening, options, out)
}

pub(super) fn failed(error: impl Display) -> CliError {
    CliError::message(format!("the explorer failed: {error}"))
}

/// Opens the explorer in the terminal. After it is closed, prints a brief summary of the last
/// scene.
fn open(opening: Opening, options: Options, out: &mut dyn Write) -> Result<(), CliError> {
    if std::env::var_os("TERM").is_some_and(|term| term == "dumb") {
        return Err(CliError::message(format!(
            "TERM=dumb: the explorer places characters, this terminal does not; asperity run {} computes the scene \
             without one",
            quoted(opening.document.name())
        )));
    }
    let left = crate::explorer::session::open(opening, options, Simulation::run, view::draw)
        .map_err(failed)?;
    if let Some(signal) = left.signal {
        crate::explorer::signals::end_by(signal);
    }
    if let Some(computed) = &left.computed {
        out.write_all(brief_summary(left.document.scene(), &computed.outcome).as_bytes())?;
    }
    Ok(())
}

/// Returns the newest unsaved changes of an ended session that can be read. Returns an error if
/// there are none.
fn restored(folder: Option<&Path>) -> Result<Newest, CliError> {
    let newest = folder.map(autosave::newest).unwrap_or_default();
    if newest.kept.is_some() {
        return Ok(newest);
    }
    let why = match &newest.unreadable[..] {
        [] => "no unsaved changes are kept; asperity opens a scene".to_owned(),
        unreadable => format!("no unsaved changes can be read: {}", unreadable.join("; ")),
    };
    Err(CliError::named("--restore", why))
}

/// Returns what the explorer shows first: a scene or a study with changed fields, a scene for
/// comparison, and a measured curve. `default` is the scene for the case that the user names none.
fn opening(
    arguments: &ExploreArguments,
    default: &str,
    commands: &str,
) -> Result<Opening, CliError> {
    let name = arguments.scene.as_deref().unwrap_or(default);
    let mut opening = Opening::of_argument(name).map_err(|error| match error {
        OpeningError::Scene(errors) => {
            if let Some(way) = no_scene(Path::new(name)) {
                return CliError::message(way);
            }
            // A single word that does not name a scene may be a misspelt command.
            let is_word = name.chars().all(|c| c.is_ascii_alphabetic()) && !Path::new(name).exists();
            match nearest(name, commands.split(", ")).filter(|_| is_word) {
                Some(near) => CliError::named(
                    name,
                    format!("there is no such command and no such scene; did you mean asperity {near}? (commands: {commands})"),
                ),
                None => errors.into(),
            }
        }
        OpeningError::Study(error) => (*error).into(),
        error => error.into(),
    })?;
    opening.document = arguments.overrides.apply(opening.document)?;
    opening.profiles = arguments.profiles;
    if let Some(other) = &arguments.compare {
        let document = open_scene(other)?;
        let outcome = compute(&document, document.scene())?.into();
        opening.ghost = Some(Ghost { document, outcome });
    }
    if arguments.measured.is_none() && arguments.reading != CurveOptions::default() {
        return Err(CliError::message(
            "--columns, --units and the like read a measured curve: --measured CURVE names its file",
        ));
    }
    if let Some(path) = &arguments.measured {
        let name = path_name(path);
        let instrument = opening.document.scene().loading_stiffness;
        let reading = CurveOptions {
            instrument,
            ..arguments.reading.clone()
        };
        let measured = Measured::read(path, reading);
        opening.measured =
            Some(measured.map_err(|error| CliError::named(&name, no_curve(path, &error, option)))?);
    }
    Ok(opening)
}
