//! Failures of computations and their exceptions.

use asperity::contact::ContactError;
use asperity::experiment::ExperimentError;
use asperity::scene::{Error, Origin, RunError, SceneError, SceneErrors};
use asperity::study::StudyError;
use asperity::surface::SurfaceError;
use pyo3::create_exception;
use pyo3::exceptions::{PyMemoryError, PyOSError, PyValueError};
use pyo3::prelude::*;
use std::fmt::Display;
use std::fs::File;
use std::path::PathBuf;

create_exception!(
    asperity,
    FieldError,
    PyValueError,
    "A value is out of its range: `field`, `value` and `allowed` state which value, and what is allowed."
);
create_exception!(
    asperity,
    LoadingError,
    PyValueError,
    "The contact does not reach a loading stage: `stage` is its number from 1, `smallest_force` the smallest force \
     within reach in N, or None."
);

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
    /// A value that is not allowed.
    pub fn field(field: &str, value: impl Display, allowed: impl Display) -> Failure {
        let message = format!("{field} = {value}; allowed: {allowed}");
        Failure::Field(message, [field.to_owned(), value.to_string(), allowed.to_string()])
    }

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

    /// The exception of Python. An exception of a class of its own takes any attribute.
    pub fn exception(self, py: Python<'_>) -> PyErr {
        match self {
            Failure::Field(message, values) => {
                let error = FieldError::new_err(message);
                for (name, value) in ["field", "value", "allowed"].into_iter().zip(values) {
                    let _ = error.value(py).setattr(name, value);
                }
                error
            }
            Failure::Loading(message, (stage, smallest_force)) => {
                let error = LoadingError::new_err(message);
                let _ = error.value(py).setattr("stage", stage);
                let _ = error.value(py).setattr("smallest_force", smallest_force);
                error
            }
            Failure::File(message) => PyOSError::new_err(message),
            Failure::Memory(message) => PyMemoryError::new_err(message),
            Failure::Value(message) => PyValueError::new_err(message),
        }
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

impl From<SurfaceError> for Failure {
    fn from(error: SurfaceError) -> Failure {
        match error {
            SurfaceError::OutOfMemory { .. } => Failure::Memory(error.to_string()),
            SurfaceError::Unreadable { .. } => Failure::File(error.to_string()),
            _ => Failure::Value(error.to_string()),
        }
    }
}

impl From<RunError> for Failure {
    fn from(error: RunError) -> Failure {
        match error {
            RunError::Values(errors) => errors.into(),
            RunError::Surface(error) => error.into(),
            RunError::Contact(error) => error.into(),
            RunError::OutOfMemory { .. } => Failure::Memory(error.to_string()),
            error => Failure::Value(error.to_string()),
        }
    }
}

impl From<Error> for Failure {
    fn from(error: Error) -> Failure {
        match error {
            Error::Values(errors) => errors.into(),
            Error::Contact(error) => error.into(),
            Error::Run(error) => error.into(),
            error => Failure::Value(error.to_string()),
        }
    }
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

impl From<ExperimentError> for Failure {
    fn from(error: ExperimentError) -> Failure {
        match error {
            ExperimentError::File(error) => error.into(),
            ExperimentError::Run(error) => error.into(),
            error => Failure::Value(error.to_string()),
        }
    }
}
