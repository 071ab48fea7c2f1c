//! Options of the command line in the words of Python: errors of the libraries name the options of
//! commands.

use crate::failure::Failure;
use asperity::cli::arguments::{Arguments, Command};
use asperity::data::printable_lines;
use clap::builder::PossibleValue;
use clap::error::{ContextKind, ContextValue};
use clap::{Arg, CommandFactory, Parser};
use std::error::Error;

/// Commands whose options have arguments of the same names in Python.
const COMMANDS: [&str; 4] = ["surface", "find", "reference", "run"];

/// Options of `asperity fit` that are arguments of `asperity.fit`. All others are entries of its
/// dictionary `options`.
const ARGUMENTS_OF_FIT: [&str; 3] = ["free", "jobs", "profiles"];

/// Fields of a scene that errors name beside an option.
const IN_A_SCENE: &str = ", in a scene ";

/// Largest number of characters of a word of a message. A longer word is a foreign text that is
/// cut.
const LONGEST_WORD: usize = 255;

/// Returns a message for Python: options of the command line are arguments, no sign controls a
/// terminal, and foreign texts are shortened.
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
    in_python(&shortened)
}

/// Returns a message in which options of the command line are arguments of Python:
/// `--unit um, in a scene roughness.unit` is `unit="um"`.
fn in_python(message: &str) -> String {
    if !message.contains("--") {
        return message.to_owned();
    }
    let program = Arguments::command();
    let mut written = String::new();
    let mut rest = message;
    while let Some(start) = rest.find("--") {
        written += &rest[..start];
        let after = &rest[start + 2..];
        let length = after
            .find(|sign: char| !(sign.is_ascii_lowercase() || sign == '-'))
            .unwrap_or(after.len());
        let (name, following) = after.split_at(length);
        match option(&program, name) {
            Some((option, is_entry)) => {
                let (value, following) = value_of(option, following);
                written += &argument(name, option, value, is_entry);
                rest = without_fields(following);
            }
            None => {
                written += "--";
                rest = after;
            }
        }
    }
    written + rest
}

/// Returns the option of this name, and true if it is an entry of `options` of `asperity.fit`.
fn option<'a>(program: &'a clap::Command, name: &str) -> Option<(&'a Arg, bool)> {
    let of_command = |command: &str| {
        let command = program.find_subcommand(command)?;
        command
            .get_arguments()
            .find(|argument| argument.get_long() == Some(name))
    };
    if let Some(option) = of_command("fit") {
        return Some((option, !ARGUMENTS_OF_FIT.contains(&name)));
    }
    COMMANDS
        .into_iter()
        .find_map(of_command)
        .map(|option| (option, false))
}

/// Splits the text after an option into the value of the option, if there is one, and the rest.
fn value_of<'a>(option: &Arg, following: &'a str) -> (Option<&'a str>, &'a str) {
    let Some(text) = following
        .strip_prefix(' ')
        .filter(|_| option.get_action().takes_values())
    else {
        return (None, following);
    };
    let end = text.find([' ', ';', ')', '`']).unwrap_or(text.len());
    let word = text[..end].trim_end_matches([',', '.', ':']);
    let is_known = |known: &PossibleValue| known.get_name() == word;
    let is_value = word.contains(|sign: char| sign.is_ascii_digit() || sign.is_ascii_uppercase())
        || word.contains(',')
        || option.get_possible_values().iter().any(is_known)
        || ["um", "none", "remove"].contains(&word);
    // A placeholder, such as COUNT, stands for any value.
    let is_placeholder = word
        .chars()
        .all(|sign| sign.is_ascii_uppercase() || sign == ',');
    match (is_value, is_placeholder) {
        (true, true) => (None, &text[word.len()..]),
        (true, false) => (Some(word), &text[word.len()..]),
        (false, _) => (None, following),
    }
}

/// Returns the text without the fields of a scene at its beginning.
fn without_fields(text: &str) -> &str {
    let Some(mut rest) = text.strip_prefix(IN_A_SCENE) else {
        return text;
    };
    loop {
        let end = rest.find([' ', ',', ';', ')']).unwrap_or(rest.len());
        rest = &rest[end..];
        match rest
            .strip_prefix(" or ")
            .filter(|further| further.starts_with("roughness."))
        {
            Some(further) => rest = further,
            None => return rest,
        }
    }
}

fn argument(name: &str, option: &Arg, value: Option<&str>, is_entry: bool) -> String {
    let name = name.replace('-', "_");
    let value = match value {
        Some(number) if number.parse::<f64>().is_ok() => Some(number.to_owned()),
        Some(text) => Some(format!("\"{text}\"")),
        None if !option.get_action().takes_values() => Some("True".to_owned()),
        None => None,
    };
    match (value, is_entry) {
        (Some(value), true) => format!("options={{\"{name}\": {value}}}"),
        (Some(value), false) => format!("{name}={value}"),
        (None, true) => format!("options[\"{name}\"]"),
        (None, false) => name,
    }
}

/// Parses the options of a command, given as its words. Errors have the words of Python.
pub fn command(name: &str, words: Vec<String>) -> Result<Option<Command>, Failure> {
    let line = ["asperity".to_owned(), name.to_owned()]
        .into_iter()
        .chain(words);
    Ok(Arguments::try_parse_from(line)
        .map_err(|error| refused(name, &error))?
        .command)
}

/// Returns the failure for an option that is unknown, or whose value is not allowed.
fn refused(command: &str, error: &clap::Error) -> Failure {
    let context = |kind: ContextKind| match error.get(kind) {
        Some(ContextValue::String(text)) => Some(text.clone()),
        Some(ContextValue::Strings(texts)) => Some(texts.join(", ")),
        _ => None,
    };
    let Some(given) = context(ContextKind::InvalidArg) else {
        return first_paragraph(error).into();
    };
    let name = given
        .trim_start_matches("--")
        .split([' ', '='])
        .next()
        .unwrap_or_default()
        .replace('-', "_");
    let reason = error.source().map(|source| sentence(&source.to_string()));
    let value = context(ContextKind::InvalidValue);
    match (reason.or_else(|| context(ContextKind::ValidValue)), value) {
        (Some(allowed), Some(value)) => {
            let allowed = allowed.strip_prefix("allowed: ").unwrap_or(&allowed);
            Failure::field(&name, &value, allowed)
        }
        _ => Failure::field("options", &name, &names_of_options(command)),
    }
}

fn names_of_options(command: &str) -> String {
    let program = Arguments::command();
    let options = program
        .find_subcommand(command)
        .into_iter()
        .flat_map(clap::Command::get_arguments);
    let names = options
        .filter_map(Arg::get_long)
        .filter(|name| !NOT_IN_PYTHON.contains(name));
    names
        .map(|name| name.replace('-', "_"))
        .collect::<Vec<_>>()
        .join(", ")
}

/// Options of `asperity fit` that Python has in another form.
const NOT_IN_PYTHON: [&str; 8] = [
    "set", "free", "jobs", "profiles", "scene", "format", "output", "force",
];

fn first_paragraph(error: &clap::Error) -> String {
    let text = error.to_string();
    let lines = text
        .lines()
        .map(|line| line.trim().trim_start_matches("error: "));
    lines
        .take_while(|line| !line.is_empty())
        .collect::<Vec<_>>()
        .join(" ")
}
