//! Messages about arguments that exclude each other.

use super::Arguments;
use crate::text::printable_lines;
use clap::error::{ContextKind, ErrorKind};
use clap::{CommandFactory, Error};
use std::borrow::Cow;
use std::ffi::OsString;
use std::io::{self, Write};

/// Prints an error of the parser. An error that repeats control characters loses its colours, and has them escaped.
pub(super) fn print(error: &Error) -> io::Result<()> {
    let plain = error.render().to_string();
    match printable_lines(&plain) {
        Cow::Owned(shown) if error.use_stderr() => io::stderr().write_all(shown.as_bytes()),
        _ => error.print(),
    }
}

/// The error, or a plainer one if the parser confused a scene and a command: it takes a misspelt command for a
/// scene, and the next words for another command or for options of none.
pub(super) fn explained(error: Error, typed: &[OsString]) -> Error {
    let mut command = Arguments::command();
    let names: Vec<String> = command.get_subcommands().map(|command| command.get_name().into()).collect();
    let is_command = |word: &str| names.iter().any(|name| name == word);
    let words: Vec<_> = typed.iter().skip(1).map(|word| word.to_string_lossy()).collect();
    let Some(first) = words.first().filter(|first| !is_command(first)) else { return error };
    let misplaced = words.iter().find(|word| is_command(word));
    let no_command = format!("'{first}' is not a command; the commands are {}", names.join(", "));
    let message = match (error.kind(), misplaced) {
        (ErrorKind::ArgumentConflict, Some(misplaced)) => {
            format!("the command '{misplaced}' comes first, its scene and options follow")
        }
        (ErrorKind::ArgumentConflict, None) if !first.starts_with('-') => no_command,
        (ErrorKind::UnknownArgument, _) if !first.starts_with('-') => {
            match error.get(ContextKind::InvalidArg) {
                Some(unknown) => format!("unexpected argument '{unknown}': {no_command}"),
                None => no_command,
            }
        }
        _ => return error,
    };
    command.error(ErrorKind::InvalidSubcommand, message)
}
