//! `asperity completions`: writes completion scripts for shells.

use super::error::CliError;
use clap::{Args, Command};
use clap_complete::Shell;
use std::io::Write;

const EXAMPLES: &str = "\
Examples:
  asperity completions bash > ~/.local/share/bash-completion/completions/asperity
  asperity completions zsh > ~/.zfunc/_asperity
  asperity completions fish > ~/.config/fish/completions/asperity.fish";

#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct CompletionsArguments {
    /// The shell
    pub shell: Shell,
}

pub(super) fn completions(
    arguments: &CompletionsArguments,
    mut program: Command,
    stdout: &mut dyn Write,
) -> Result<(), CliError> {
    // The generator panics if writing fails. Therefore the script is written to memory first.
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut program, "asperity", &mut script);
    Ok(stdout.write_all(&script)?)
}
