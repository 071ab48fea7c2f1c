//! `asperity [SCENE]`: opens the explorer on a scene or on a finished study.

use super::{Arguments, CliError, Overrides};
use crate::explorer::theme::{Marker, Theme};
use crate::explorer::{self, Opening, OpeningError, Options};
use crate::export::brief_summary;
use crate::scene::DEFAULT;
use clap::{Args, CommandFactory};
use std::io::{IsTerminal, Write, stdin, stdout};

/// Arguments of the explorer.
#[derive(Args, Debug)]
pub struct ExploreArguments {
    /// Explore this scene file, built-in scene (see `asperity presets list`), or merged study
    ///
    /// The folder of a merged study opens its map over κ and H, if the study varies both.
    pub scene: Option<String>,
    /// Overrides of the scene.
    #[command(flatten)]
    pub overrides: Overrides,
    /// Colours and markers of the explorer, and its mouse.
    #[command(flatten)]
    pub look: LookArguments,
}

/// Colours and markers of the explorer, and its mouse.
#[derive(Args, Clone, Copy, Debug)]
pub struct LookArguments {
    /// Colours
    ///
    /// Default: chosen from NO_COLOR and COLORFGBG.
    #[arg(long, value_enum)]
    pub theme: Option<Theme>,
    /// Markers
    ///
    /// Marker of plots; default: braille.
    #[arg(long, value_enum)]
    pub marker: Option<Marker>,
    /// Leave the mouse to the terminal
    #[arg(long)]
    pub no_mouse: bool,
}

impl LookArguments {
    fn options(self) -> Options {
        Options { theme: self.theme, marker: self.marker, no_mouse: self.no_mouse }
    }
}

/// Opens the explorer on a scene or a study.
///
/// On leaving, prints a brief summary of the last scene.
pub(super) fn explore(arguments: &ExploreArguments, out: &mut dyn Write) -> Result<(), CliError> {
    let opening = opening(arguments)?;
    if !stdin().is_terminal() || !stdout().is_terminal() {
        let name = opening.document.name().into();
        return Err(match opening.study_map {
            None => CliError::NoTerminal { scene: name },
            Some(_) => CliError::NoTerminalForStudy { folder: name },
        });
    }
    open(opening, arguments.look, out)
}

/// Opens the explorer in the terminal; on leaving, prints a brief summary of the last scene.
pub(super) fn open(opening: Opening, look: LookArguments, out: &mut dyn Write) -> Result<(), CliError> {
    if std::env::var_os("TERM").is_some_and(|term| term == "dumb") {
        return Err(CliError::DumbTerminal { scene: opening.document.name().into() });
    }
    let left =
        explorer::open(opening, look.options()).map_err(|error| CliError::Explorer(error.to_string()))?;
    if let Some(signal) = left.signal {
        explorer::end_by(signal);
    }
    if let Some(computed) = &left.computed {
        out.write_all(brief_summary(left.document.scene(), &computed.outcome).as_bytes())?;
    }
    Ok(())
}

fn opening(arguments: &ExploreArguments) -> Result<Opening, CliError> {
    let name = arguments.scene.as_deref().unwrap_or(DEFAULT);
    let mut opening = Opening::of_argument(name).map_err(|error| match error {
        OpeningError::Scene(errors) => {
            // A single word that is no scene may have been meant as a command.
            let is_word = name.chars().all(|c| c.is_ascii_alphabetic());
            if is_word && !std::path::Path::new(name).exists() {
                let command = Arguments::command();
                let commands: Vec<_> = command.get_subcommands().map(|command| command.get_name()).collect();
                let commands = commands.join(", ");
                CliError::NeitherSceneNorCommand { errors, commands }
            } else {
                CliError::Scene(errors)
            }
        }
        error => CliError::Opening(error),
    })?;
    opening.document = arguments.overrides.apply(opening.document)?;
    Ok(opening)
}
