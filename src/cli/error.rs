//! Errors of commands.

use super::advice::advised;
use asperity_data::WriteError;
use std::error::Error;
use std::fmt::Display;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::{fmt, io};

/// Exit code if a computation failed or the input is wrong.
const FAILED: u8 = 1;

/// Error of a command: one message, or one message for each wrong line of the input.
#[derive(Debug)]
pub struct CliError {
    pub message: String,
    /// Exit code of the process.
    pub exit_code: u8,
    /// True if the program that reads the results has closed the pipe.
    pub is_closed_pipe: bool,
}

impl CliError {
    /// Creates an error with this message.
    pub fn message(message: impl Into<String>) -> CliError {
        CliError {
            message: message.into(),
            exit_code: FAILED,
            is_closed_pipe: false,
        }
    }

    /// Creates the error of a command that a signal has ended. The process then has the exit code
    /// that shells use for this signal.
    pub fn interrupted(signal: &AtomicUsize, message: impl Into<String>) -> CliError {
        let exit_code = 128 + u8::try_from(signal.load(Ordering::SeqCst)).unwrap_or_default();
        CliError {
            exit_code,
            ..CliError::message(message)
        }
    }

    /// Returns true if the command was ended by a signal.
    pub fn is_interruption(&self) -> bool {
        self.exit_code > 128
    }

    /// Creates an error whose message begins with `name`. The message ends with the options of the
    /// command line that remove the cause of the error.
    pub fn advised(name: impl Display, error: &(dyn Error + 'static)) -> CliError {
        CliError::named(name, advised(error))
    }

    /// Creates an error whose message begins with `name`, which is the scene, file or argument that
    /// caused the error.
    pub fn named(name: impl Display, error: impl Display) -> CliError {
        CliError::message(format!("{name}: {error}"))
    }
}

impl Display for CliError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl<E: Error + 'static> From<E> for CliError {
    fn from(error: E) -> CliError {
        let any: &(dyn Error + 'static) = &error;
        let of_file = any.downcast_ref();
        let of_output = any.downcast_ref::<io::Error>();
        let message = match of_file {
            Some(WriteError::Exists(_)) => format!("{error}; --force overwrites it"),
            _ if of_output.is_some() => format!("standard output: cannot be written: {error}"),
            _ => advised(any),
        };
        let reason = match of_file {
            Some(WriteError::Failed { reason, .. }) => Some(reason),
            _ => of_output,
        };
        let is_closed_pipe =
            reason.is_some_and(|reason| reason.kind() == io::ErrorKind::BrokenPipe);
        CliError {
            is_closed_pipe,
            ..CliError::message(message)
        }
    }
}
