//! `asperity config`: the configuration file of the explorer.

use super::error::CliError;
use crate::explorer::config::{Config, default_path, write_template};
use crate::explorer::keys::bindings;
use crate::explorer::theme::Appearance;
use clap::Args;
use std::io::Write;
use std::path::PathBuf;

const EXAMPLES: &str = "\
Examples:
  asperity config                           Print the settings in effect
  asperity config --write                   Write a configuration file with all fields in comments
  asperity config my-config.ron             Check another file and print its settings";

#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct ConfigArguments {
    /// Configuration file; default: asperity/config.ron in the configuration folder of the user
    pub file: Option<PathBuf>,
    /// Write a file with all fields in comments; an existing file is kept
    #[arg(long)]
    pub write: bool,
}

pub(super) fn config(arguments: &ConfigArguments, stdout: &mut dyn Write) -> Result<(), CliError> {
    let path = arguments.file.clone().or_else(default_path);
    let no_folder = "this system has no configuration folder; allowed: --config FILE";
    let path = path.ok_or_else(|| CliError::message(no_folder))?;
    if arguments.write {
        write_template(&path).map_err(CliError::message)?;
        return Ok(writeln!(stdout, "{}: written", path.display())?);
    }
    let mut config = Config::read(&path, arguments.file.is_some(), bindings()).map_err(CliError::message)?;
    let environment = Appearance::of_environment();
    config.theme.get_or_insert(environment.theme);
    config.markers.get_or_insert(environment.marker);
    let is_there = if path.is_file() { "" } else { ", which does not exist: defaults" };
    writeln!(stdout, "// {}{is_there}", path.display())?;
    let text = config.text().map_err(|error| CliError::message(error.to_string()))?;
    Ok(stdout.write_all(text.as_bytes())?)
}
