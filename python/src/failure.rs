//! Failures of computations and their exceptions.

use asperity::contact::ContactError;
use asperity::experiment::ExperimentError;
use asperity::scene::{Error, Origin, RunError, SceneError, SceneErrors};
use asperity::study::StudyError;
use asperity::surface::SurfaceError;
use asperity_half_space::HalfSpaceError;
use pyo3::exceptions::{PyMemoryError, PyOSError, PyValueError};
use pyo3::prelude::*;
use std::fmt::Display;
use std::fs::File;
use std::path::PathBuf;

/// Reason why a computation has no result, each with its sentence.
pub enum Failure {
    /// A value that is not allowed: its name, the value, and what is allowed.
    Field(String, [String; 3]),
    /// A loading stage out of reach: its number from 1, and the smallest force within reach, N.
    Loading(String, (usize, Option<f64>)),
    /// A file that cannot be read.
    File(String),
    Memory(String),
    /// Any other input that is not allowed.
    Value(String),
}

impl Failure {
    /// A text that is not understood, for this reason.
    pub fn explained(field: &str, value: &str, reason: &impl Display) -> Failure {
        let message = format!("{field} = {value:?}: {reason}");
        Failure::Field(message, [field.to_owned(), value.to_owned(), reason.to_string()])
    }

    /// The failure to read files if one of them does not open, otherwise the failure that their content explains.
    pub fn of_files(files: &[PathBuf], error: impl Display) -> Failure {
        let is_missing = |path: &PathBuf| path.is_dir() || File::open(path).is_err();
        let is_any_missing = files.iter().any(is_missing);
        if is_any_missing { Failure::File(error.to_string()) } else { Failure::Value(error.to_string()) }
    }

    /// The sentence of the exception.
    pub fn message(&self) -> &str {
        match self {
            Failure::Field(message, _) | Failure::Loading(message, _) => message,
            Failure::File(message) | Failure::Memory(message) | Failure::Value(message) => message,
        }
    }
}

/// The exception of Python; those with values are classes of the package.
impl From<Failure> for PyErr {
    fn from(failure: Failure) -> PyErr {
        Python::attach(|py| {
            let class = |name| py.import("asperity._errors").and_then(|errors| errors.getattr(name));
            let made = match failure {
                Failure::Field(message, [field, value, allowed]) => {
                    class("FieldError").and_then(|class| class.call1((message, field, value, allowed)))
                }
                Failure::Loading(message, (stage, smallest)) => {
                    class("LoadingError").and_then(|class| class.call1((message, stage, smallest)))
                }
                Failure::File(message) => return PyOSError::new_err(message),
                Failure::Memory(message) => return PyMemoryError::new_err(message),
                Failure::Value(message) => return PyValueError::new_err(message),
            };
            made.map_or_else(|error| error, PyErr::from_value)
        })
    }
}

impl From<String> for Failure {
    fn from(message: String) -> Failure {
        Failure::Value(message)
    }
}

impl From<SceneErrors> for Failure {
    fn from(errors: SceneErrors) -> Failure {
        // The options of the command line are no part of Python.
        let line = |error: &SceneError| match error.origin {
            Origin::Overrides(_) if error.field.is_empty() => error.to_string().replace("--set ", ""),
            Origin::Overrides(_) => error.what(),
            _ => error.to_string(),
        };
        let message = errors.iter().map(line).collect::<Vec<_>>().join("\n");
        let SceneError { field, value, allowed, .. } = errors.first().clone();
        if field.is_empty() {
            Failure::Value(message)
        } else {
            Failure::Field(message, [field, value, allowed])
        }
    }
}

impl From<ContactError> for Failure {
    fn from(error: ContactError) -> Failure {
        let message = error.to_string();
        match (error.stage(), &error) {
            (Some(stage), _) => Failure::Loading(message, (stage + 1, error.smallest_force())),
            (None, ContactError::OutOfMemory(_)) => Failure::Memory(message),
            (None, ContactError::Value { name, value, allowed }) => {
                Failure::Field(message, [name.clone(), value.to_string(), (*allowed).to_owned()])
            }
            _ => Failure::Value(message),
        }
    }
}

/// Failures of errors by their variants: those that hold another error, lack of memory, unreadable files; all others are values.
macro_rules! failures {
    ($($error:ident: $($inner:ident)*, memory $($memory:ident)*, file $($file:ident)*;)*) => {$(
        impl From<$error> for Failure {
            fn from(error: $error) -> Failure {
                match error {
                    $($error::$inner(inner) => inner.into(),)*
                    $($error::$memory { .. } => Failure::Memory(error.to_string()),)*
                    $($error::$file { .. } => Failure::File(error.to_string()),)*
                    _ => Failure::Value(error.to_string()),
                }
            }
        }
    )*};
}

failures! {
    Error: Values Contact Run, memory, file;
    ExperimentError: File Run, memory, file;
    HalfSpaceError: , memory OutOfMemory, file;
    RunError: Values Surface Contact, memory OutOfMemory, file;
    SurfaceError: , memory OutOfMemory, file Unreadable;
}

impl From<StudyError> for Failure {
    fn from(error: StudyError) -> Failure {
        match error {
            StudyError::Measured(error) => error.into(),
            StudyError::Run { place, error } if place.is_empty() => error.into(),
            StudyError::TooManyRecords(_) | StudyError::Memory { .. } => Failure::Memory(error.to_string()),
            error => Failure::Value(error.to_string()),
        }
    }
}
