//! `asperity [SCENE]`: opens the explorer.

use super::{Arguments, CliError, Overrides};
use crate::explorer;
use crate::scene::{DEFAULT, Document, open};
use clap::{Args, CommandFactory};
use std::io::{IsTerminal, stdin, stdout};

/// Arguments of the explorer.
#[derive(Args, Debug)]
pub struct ExploreArguments {
    /// Open the explorer on this scene file or built-in scene (see `asperity presets list`)
    pub scene: Option<String>,
    /// What is changed in it.
    #[command(flatten)]
    pub overrides: Overrides,
}

/// Opens the explorer on a scene.
pub(super) fn explore(arguments: &ExploreArguments) -> Result<(), CliError> {
    let document = document(arguments)?;
    if !stdin().is_terminal() || !stdout().is_terminal() {
        return Err(CliError::NoTerminal { scene: document.name().into() });
    }
    let folder = document.resolve("");
    explorer::open(document, folder).map(drop).map_err(|error| CliError::Explorer(error.to_string()))
}

fn document(arguments: &ExploreArguments) -> Result<Document, CliError> {
    let name = arguments.scene.as_deref().unwrap_or(DEFAULT);
    let document = open(name).map_err(|errors| {
        // A single word that is no scene may have been meant as a command.
        let is_word = name.chars().all(|c| c.is_ascii_alphabetic());
        if is_word && !std::path::Path::new(name).exists() {
            let command = Arguments::command();
            let commands: Vec<_> = command.get_subcommands().map(|command| command.get_name()).collect();
            let commands = commands.join(", ");
            CliError::NeitherSceneNorCommand { errors: Box::new(errors), commands }
        } else {
            errors.into()
        }
    })?;
    arguments.overrides.apply(document)
}
