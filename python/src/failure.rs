//! Failures of computations, and the Python exceptions that they become.

use crate::advice::{argument, name};
use crate::words::sentence;
use asperity::contact::ContactError;
use asperity::data::{Remedied, shown};
use asperity::experiment::ExperimentError;
use asperity::scene::{Error, Origin, RunError, SceneError, SceneErrors};
use asperity::study::StudyError;
use asperity::surface::SurfaceError;
use asperity_half_space::HalfSpaceError;
use pyo3::call::PyCallArgs;
use pyo3::exceptions::{PyMemoryError, PyOSError, PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use std::fmt::Display;
use std::fs::File;
use std::path::PathBuf;

/// Creates an exception of the class with the name `class`, which the Python package `asperity`
/// defines. `values` are the arguments of the class.
fn exception<'py>(
    py: Python<'py>,
    class: &str,
    values: impl PyCallArgs<'py>,
) -> PyResult<Bound<'py, PyAny>> {
    py.import("asperity._errors")?.getattr(class)?.call1(values)
}

/// Reason why a computation has no result. It contains a Python exception, whose message is a
/// sentence.
pub struct Failure(PyErr);

impl Failure {
    /// Creates a failure with an exception of the class `name`, which the Python package defines.
    fn of_class(name: &str, values: impl for<'py> PyCallArgs<'py>) -> Failure {
        // A computation that was stopped may fail while the interpreter ends.
        let error = Python::try_attach(|py| match exception(py, name, values) {
            Ok(exception) => PyErr::from_value(exception),
            Err(error) => error,
        });
        Failure(error.unwrap_or_else(|| PyRuntimeError::new_err("the interpreter ends")))
    }

    /// Creates the failure for a value that is not allowed. `field` is the name of the argument,
    /// and `allowed` describes the allowed values. The message of the exception contains `value`,
    /// escaped and shortened.
    pub fn field(field: &str, value: &str, allowed: &str) -> Failure {
        let message = format!("{} = {}; allowed: {allowed}", shown(field), shown(value));
        Failure::field_in_words(message, field, value, allowed)
    }

    /// Creates the failure for a value that is not allowed, with `message` as the sentence of the
    /// exception.
    fn field_in_words(message: String, field: &str, value: &str, allowed: &str) -> Failure {
        Failure::of_class("FieldError", (sentence(&message), field, value, allowed))
    }

    /// Creates the failure for a text that cannot be read. `field` is the name of the argument,
    /// `value` the text, and `reason` states why it cannot be read.
    pub fn explained(field: &str, value: &str, reason: &impl Display) -> Failure {
        let message = format!("{} = \"{}\": {reason}", shown(field), shown(value));
        Failure::field_in_words(message, field, value, &reason.to_string())
    }

    /// Creates the failure for an argument that an error refuses without its name. The words after
    /// `allowed: ` in the error describe the allowed values.
    pub fn of_argument(field: &str, value: &str, error: &impl Display) -> Failure {
        let message = error.to_string();
        let allowed = message.rsplit("allowed: ").next().unwrap_or_default();
        Failure::field_in_words(message.clone(), field, value, allowed)
    }

    /// Creates the failure for an argument that a study refuses. Other errors of the study keep
    /// their own exceptions.
    pub fn of_refusal(field: &str, value: &str, error: StudyError) -> Failure {
        match error {
            StudyError::Refused { .. } => {
                Failure::of_argument(field, value, &error.in_words(argument))
            }
            error => error.into(),
        }
    }

    /// Creates the failure of a function that reads files. If a file cannot be opened, the failure
    /// is an `OSError`. Otherwise the content of the files has a fault, and the failure follows
    /// from `error`.
    pub fn of_files(files: &[PathBuf], error: impl ToString + Into<Failure>) -> Failure {
        for file in files {
            if file.is_dir() || File::open(file).is_err() {
                return Failure(PyOSError::new_err(sentence(&error.to_string())));
            }
        }
        error.into()
    }

    /// Creates the failure for an error, with the Python arguments that are remedies.
    fn of_remedied(error: &impl Remedied) -> Failure {
        error.in_words(argument).into()
    }

    /// Returns the message of the exception.
    pub fn message(&self) -> String {
        Python::attach(|py| self.0.value(py).to_string())
    }
}

impl From<Failure> for PyErr {
    fn from(failure: Failure) -> PyErr {
        failure.0
    }
}

impl From<String> for Failure {
    fn from(message: String) -> Failure {
        Failure(PyValueError::new_err(sentence(&message)))
    }
}

impl From<SceneErrors> for Failure {
    fn from(errors: SceneErrors) -> Failure {
        let mut lines = Vec::new();
        for error in errors.iter() {
            lines.push(match error.origin {
                Origin::Overrides(_) if !error.field.is_empty() => error.what(),
                _ => error.to_string(),
            });
        }
        let message = lines.join("\n");
        let SceneError {
            field,
            value,
            allowed,
            ..
        } = errors.first();
        if field.is_empty() {
            return message.into();
        }
        let allowed = if allowed.is_empty() {
            &message
        } else {
            allowed
        };
        Failure::field_in_words(message.clone(), field, value, allowed)
    }
}

impl From<ContactError> for Failure {
    fn from(error: ContactError) -> Failure {
        let message = error.to_string();
        match (error.stage(), &error) {
            (Some(stage), _) => {
                // Python and all tables count loading stages from 0.
                let reason = message
                    .strip_prefix(&format!("stage {}: ", stage + 1))
                    .unwrap_or(&message);
                let message = format!("stage {stage}, counted from 0: {reason}");
                Failure::of_class(
                    "LoadingError",
                    (sentence(&message), stage, error.smallest_force()),
                )
            }
            (None, ContactError::OutOfMemory(_)) => Failure(PyMemoryError::new_err(message)),
            (
                None,
                ContactError::Value {
                    name,
                    value,
                    allowed,
                },
            ) => Failure::field_in_words(message, name, &value.to_string(), allowed),
            _ => message.into(),
        }
    }
}

/// Converts errors to failures, depending on their variants. If a variant contains another error,
/// the failure of this other error is used. Lack of memory becomes a `MemoryError`, and an
/// unreadable file an `OSError`. All other variants mean that a value is not allowed.
macro_rules! failures {
    ($($error:ident: $($inner:ident)*, memory $($memory:ident)*, file $($file:ident)*;)*) => {$(
        impl From<$error> for Failure {
            fn from(error: $error) -> Failure {
                match error {
                    $($error::$inner(inner) => inner.into(),)*
                    $($error::$memory { .. } => Failure(PyMemoryError::new_err(sentence(&error.to_string()))),)*
                    $($error::$file { .. } => Failure(PyOSError::new_err(sentence(&error.to_string()))),)*
                    error => Failure::of_remedied(&error),
                }
            }
        }
    )*};
}

failures! {
    Error: Values Contact Run, memory, file;
    RunError: Values Surface Contact, memory OutOfMemory, file;
}

impl From<HalfSpaceError> for Failure {
    fn from(error: HalfSpaceError) -> Failure {
        let message = error.to_string();
        match error {
            HalfSpaceError::OutOfMemory { .. } => {
                Failure(PyMemoryError::new_err(sentence(&message)))
            }
            _ => message.into(),
        }
    }
}

impl From<SurfaceError> for Failure {
    fn from(error: SurfaceError) -> Failure {
        let message = error.in_words(argument);
        match &error {
            SurfaceError::OutOfMemory { .. } => Failure(PyMemoryError::new_err(sentence(&message))),
            SurfaceError::Unreadable { .. } => Failure(PyOSError::new_err(sentence(&message))),
            SurfaceError::MissingPoints { .. } => {
                Failure::field_in_words(message, "interpolate", "False", "True")
            }
            SurfaceError::NoUnit { .. } => {
                Failure::field_in_words(message, "unit", "None", "a unit of length, such as um")
            }
            SurfaceError::Channel { allowed, .. } => {
                let field = first_name(&error).unwrap_or("channel");
                Failure::field_in_words(message, field, "", allowed)
            }
            SurfaceError::Refused { found, allowed, .. } => match first_name(&error) {
                Some(field) => Failure::field_in_words(message, field, found, allowed),
                None => message.into(),
            },
            _ => message.into(),
        }
    }
}

impl From<ExperimentError> for Failure {
    fn from(error: ExperimentError) -> Failure {
        let message = error.in_words(argument);
        match &error {
            ExperimentError::File(error) => error.clone().into(),
            ExperimentError::Run(error) => error.clone().into(),
            ExperimentError::NoSuchSegment { wanted, segments } => {
                let allowed = format!("{} to {}", segments.start(), segments.end());
                Failure::field_in_words(message, "segments", &wanted.to_string(), &allowed)
            }
            ExperimentError::Refused { found, allowed, .. } => match first_name(&error) {
                Some(field) => Failure::field_in_words(message, field, found, allowed),
                None => message.into(),
            },
            _ => message.into(),
        }
    }
}

/// Returns the name of the Python argument with which the first remedy of an error is applied.
fn first_name(error: &impl Remedied) -> Option<&'static str> {
    error.remedies().first().and_then(name)
}

impl From<StudyError> for Failure {
    fn from(error: StudyError) -> Failure {
        match error {
            StudyError::Measured(error) => error.into(),
            StudyError::Run { place, error } if place.is_empty() => (*error).into(),
            StudyError::TooManyRecords(_) | StudyError::Memory { .. } => {
                Failure(PyMemoryError::new_err(sentence(&error.to_string())))
            }
            error => Failure::of_remedied(&error),
        }
    }
}
