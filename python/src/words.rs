//! Options of commands: functions that parse the arguments of a Python function as options of a
//! command, and that make the texts of errors.

use crate::failure::Failure;
use asperity::cli::arguments::{Arguments, Command};
use asperity::data::printable_lines;
use clap::error::{ContextKind, ContextValue};
use clap::{Arg, CommandFactory, Parser};
use std::error::Error;

/// Largest number of characters of a word in a message. A longer word can only come from a text of
/// the user, and is cut.
const LONGEST_WORD: usize = 255;

/// Returns `message` as it is shown in Python: control characters of terminals are escaped, and
/// long words are shortened.
pub fn sentence(message: &str) -> String {
    let mut shortened = String::new();
    let mut length = 0;
    for sign in printable_lines(message).chars() {
        length = if sign.is_whitespace() { 0 } else { length + 1 };
        if length <= LONGEST_WORD {
            shortened.push(sign);
        } else if length == LONGEST_WORD + 1 {
            shortened.push('…');
        }
    }
    shortened
}

/// Parses the options of a command. Error messages use the names of the Python arguments instead of
/// the names of the options.
pub fn command(name: &str, words: Vec<String>) -> Result<Option<Command>, Failure> {
    let line = ["asperity".to_owned(), name.to_owned()]
        .into_iter()
        .chain(words);
    Ok(Arguments::try_parse_from(line)
        .map_err(|error| refused(name, &error))?
        .command)
}

/// Returns the failure for an option that does not exist, or whose value is not allowed.
fn refused(command: &str, error: &clap::Error) -> Failure {
    let Some(given) = context(error, ContextKind::InvalidArg) else {
        return first_paragraph(error).into();
    };
    let name = given
        .trim_start_matches("--")
        .split([' ', '='])
        .next()
        .unwrap_or_default()
        .replace('-', "_");
    let reason = error.source().map(|source| sentence(&source.to_string()));
    let value = context(error, ContextKind::InvalidValue);
    match (
        reason.or_else(|| context(error, ContextKind::ValidValue)),
        value,
    ) {
        (Some(allowed), Some(value)) => {
            let allowed = allowed.strip_prefix("allowed: ").unwrap_or(&allowed);
            Failure::field(&name, &value, allowed)
        }
        _ => Failure::field("options", &name, &names_of_options(command)),
    }
}

fn context(error: &clap::Error, kind: ContextKind) -> Option<String> {
    match error.get(kind)? {
        ContextValue::String(text) => Some(text.clone()),
        ContextValue::Strings(texts) => Some(texts.join(", ")),
        _ => None,
    }
}

fn names_of_options(command: &str) -> String {
    let program = Arguments::command();
    let Some(command) = program.find_subcommand(command) else {
        return String::new();
    };
    let mut names = Vec::new();
    for name in command.get_arguments().filter_map(Arg::get_long) {
        if !NOT_IN_PYTHON.contains(&name) {
            names.push(name.replace('-', "_"));
        }
    }
    names.join(", ")
}

/// Options of `asperity fit` that are not arguments in Python, because other arguments replace
/// them.
const NOT_IN_PYTHON: [&str; 8] = [
    "set", "free", "jobs", "profiles", "scene", "format", "output", "force",
];

fn first_paragraph(error: &clap::Error) -> String {
    let text = error.to_string();
    let mut lines = Vec::new();
    for line in text.lines() {
        let line = line.trim().trim_start_matches("error: ");
        if line.is_empty() {
            break;
        }
        lines.push(line);
    }
    // In Python, the options are arguments with the same names but without dashes.
    lines.join(" ").replace("--", "")
}
