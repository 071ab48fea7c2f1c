//! The command line: its arguments, and one function for each command.
//!
//! Results are written to standard output, and everything else to standard error. The exit code is
//! 0 for success, 1 if the input is wrong or the computation fails, and 2 for wrong usage.

mod advice;
pub mod arguments;
mod check;
mod completions;
mod cost;
mod curve_tables;
mod demo;
mod ensemble;
mod error;
mod explore;
mod find;
pub mod fit;
mod fits;
mod output;
mod plan;
mod presets;
mod profile;
mod progress;
mod reference;
mod reversals;
mod run;
mod scene;
mod sensitivity;
pub mod surface;
mod sweep;
mod typed;

use arguments::{Arguments, Command};

use error::CliError;

use asperity_data::{printable, printable_lines};
use asperity_scene::presets;
use asperity_scene::text::{did_you_mean, quoted};
use clap::error::{ContextKind, ErrorKind};
use clap::{CommandFactory, Parser};
use std::borrow::Cow;
use std::ffi::OsString;
use std::io;
use std::io::{BufWriter, Write};
use std::path::Path;

/// Size in bytes of the buffer for standard output.
const BUFFER: usize = 1 << 18;

const SUCCESS: u8 = 0;
const WRONG_USAGE: u8 = 2;

/// Runs the program with the given arguments and returns the exit code. The first argument is the
/// name of the program.
pub fn main(arguments: impl IntoIterator<Item = OsString>) -> u8 {
    let typed = typed::TYPED.get_or_init(|| arguments.into_iter().collect());
    if let Some(word) = typed.iter().skip(1).find(|word| word.to_str().is_none()) {
        // Scenes, tables and messages contain the names of files as text. Therefore the arguments
        // must be UTF-8.
        let word = printable(&word.to_string_lossy()).into_owned();
        let _ = writeln!(
            io::stderr(),
            "{word}: this argument is not UTF-8 text; allowed: names of files in UTF-8"
        );
        return WRONG_USAGE;
    }
    let arguments = match Arguments::try_parse_from(typed) {
        Ok(arguments) => arguments,
        Err(error) => {
            let error = explained(error, typed);
            // The texts of help and version arrive here too. If an error repeats control characters
            // of an argument, it is printed with these characters escaped and without colours.
            let printed = match printable_lines(&error.render().to_string()) {
                Cow::Owned(shown) if error.use_stderr() => io::stderr().write_all(shown.as_bytes()),
                _ => error.print(),
            };
            return match printed.map_err(CliError::from) {
                _ if error.use_stderr() => WRONG_USAGE,
                Err(failed) if !failed.is_closed_pipe => {
                    let _ = writeln!(io::stderr(), "{failed}");
                    failed.exit_code
                }
                _ => SUCCESS,
            };
        }
    };
    let mut stdout = BufWriter::with_capacity(BUFFER, io::stdout().lock());
    let done = dispatch(&arguments, &mut stdout).and_then(|()| Ok(stdout.flush()?));
    match done {
        Ok(()) => SUCCESS,
        // The program that reads the results has closed the pipe, as in `asperity run … | head`.
        // This is no error.
        Err(error) if error.is_closed_pipe => SUCCESS,
        Err(error) => {
            let _ = stdout.flush();
            // Errors may contain names of files and excerpts from files. Control characters in them
            // are escaped.
            let _ = writeln!(io::stderr(), "{}", printable_lines(&error.to_string()));
            error.exit_code
        }
    }
}

/// Returns the error of the argument parser or, if the first word is not a command, a plainer
/// error. In this case the parser takes the first word for a scene, and the next words for a
/// command or for options.
fn explained(error: clap::Error, typed: &[OsString]) -> clap::Error {
    let mut command = Arguments::command();
    let names = names(&command);
    let words: Vec<_> = typed
        .iter()
        .skip(1)
        .map(|word| word.to_string_lossy())
        .collect();
    let refused = error
        .get(ContextKind::InvalidArg)
        .filter(|_| error.kind() == ErrorKind::UnknownArgument);
    let refused = refused.map(ToString::to_string);
    let Some(first) = words.first() else {
        return error;
    };
    // Second word that does not begin with a dash. The parser takes it for a command.
    let second = error
        .get(ContextKind::InvalidSubcommand)
        .map(ToString::to_string);
    let command_word = words
        .iter()
        .find(|word| names.iter().any(|name| name == *word));
    let message = match (command_word, &refused, &second) {
        (Some(misplaced), ..)
            if misplaced != first
                && matches!(
                    error.kind(),
                    ErrorKind::ArgumentConflict | ErrorKind::UnknownArgument
                ) =>
        {
            format!("the command '{misplaced}' comes first, its scene and options follow")
        }
        (None, Some(option), _) if is_scene(first) => {
            format!(
                "unexpected argument '{option}'; a command comes first, such as asperity run {}",
                quoted(&**first)
            )
        }
        (None, None, Some(second)) if is_scene(first) => {
            let first = quoted(&**first);
            let second = quoted(second.as_str());
            format!(
                "the explorer opens one scene; asperity {first} --compare {second} adds the curve of another"
            )
        }
        (None, ..) if !first.starts_with('-') && (refused.is_some() || second.is_some()) => {
            let unexpected = refused.map_or_else(String::new, |option| {
                format!("unexpected argument '{option}': ")
            });
            let scenes = presets().iter().map(|preset| preset.name);
            let near = did_you_mean(first, names.iter().map(String::as_str).chain(scenes));
            format!(
                "{unexpected}'{first}' is not a command{near} (commands: {})",
                names.join(", ")
            )
        }
        _ => return error,
    };
    command.error(ErrorKind::InvalidSubcommand, message)
}

/// Returns true if a word is the name of a built-in scene or the path of a scene file.
fn is_scene(word: &str) -> bool {
    asperity_scene::library::find_scene(word).is_some() || Path::new(word).exists()
}

fn names(program: &clap::Command) -> Vec<String> {
    program
        .get_subcommands()
        .map(|command| command.get_name().to_owned())
        .collect()
}

fn dispatch(arguments: &Arguments, stdout: &mut dyn Write) -> Result<(), CliError> {
    match &arguments.command {
        None => explore::explore(
            &arguments.explore,
            &names(&Arguments::command()).join(", "),
            stdout,
        ),
        Some(Command::Run(arguments)) => run::run(arguments, stdout),
        Some(Command::Find(arguments)) => find::find(arguments, stdout),
        Some(Command::Reversals(arguments)) => reversals::reversals(arguments, stdout),
        Some(Command::Sensitivity(arguments)) => sensitivity::sensitivity(arguments, stdout),
        Some(Command::Fit(arguments)) => fit::fit(arguments, stdout),
        Some(Command::Demo(arguments)) => demo::demo(arguments, stdout),
        Some(Command::Cost(arguments)) => cost::cost(arguments, stdout),
        Some(Command::Reference(arguments)) => reference::reference(arguments, stdout),
        Some(Command::Sweep(arguments)) => sweep::sweep(arguments, stdout),
        Some(Command::Check(arguments)) => check::check(arguments, stdout),
        Some(Command::Plan(arguments)) => plan::plan(arguments, stdout),
        Some(Command::Profile(arguments)) => profile::profile(arguments, stdout),
        Some(Command::Surface(arguments)) => surface::surface(arguments, stdout),
        Some(Command::Presets(command)) => presets::presets(command, stdout),
        Some(Command::Completions(arguments)) => {
            completions::completions(arguments, Arguments::command(), stdout)
        }
    }
}
