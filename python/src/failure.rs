//! Failures of computations and their exceptions.

use asperity::contact::ContactError;
use asperity::data::{OutOfMemory, QuantityError};
use asperity::scene::{Error, Origin, RunError, SceneError, SceneErrors};
use asperity::study::StudyError;
use pyo3::create_exception;
use pyo3::exceptions::{PyMemoryError, PyOSError, PyValueError};
use pyo3::prelude::*;
use std::fmt::Display;
use std::fs::File;
use std::path::Path;

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

/// Reason why a computation has no result.
pub enum Failure {
    /// A value that is not allowed, with its name and the allowed values; empty if the message contains them.
    Field { message: String, field: String, value: String, allowed: String },
    /// A loading stage out of reach, by its number from 1, with the smallest force within reach, N.
    Loading { message: String, stage: usize, smallest_force: Option<f64> },
    /// A file that cannot be read.
    File(String),
    /// Lack of memory.
    Memory(String),
    /// Any other input that is not allowed.
    Value(String),
}

impl Failure {
    /// A value that is not allowed.
    pub fn field(field: &str, value: impl Display, allowed: impl Display) -> Failure {
        let (value, allowed) = (value.to_string(), allowed.to_string());
        Failure::Field {
            message: format!("{field} = {value}; allowed: {allowed}"),
            field: field.into(),
            value,
            allowed,
        }
    }

    /// A text that is not understood, for this reason.
    pub fn explained(field: &str, value: &str, reason: &dyn Display) -> Failure {
        let (message, allowed) = (format!("{field} = {value:?}: {reason}"), reason.to_string());
        Failure::Field { message, field: field.into(), value: value.into(), allowed }
    }

    /// The failure to read a file if the file does not open, otherwise the failure that its content explains.
    pub fn of_file(path: &Path, error: impl Display) -> Failure {
        let message = format!("{}: {error}", path.display());
        if path.is_dir() || File::open(path).is_err() {
            Failure::File(message)
        } else {
            Failure::Value(message)
        }
    }

    /// The exception of Python.
    pub fn exception(self, py: Python<'_>) -> PyErr {
        match self {
            Failure::Field { message, field, value, allowed } => {
                let error = FieldError::new_err(message);
                for (name, text) in [("field", field), ("value", value), ("allowed", allowed)] {
                    // An exception of one's own class takes any attribute.
                    let _ = error.value(py).setattr(name, text);
                }
                error
            }
            Failure::Loading { message, stage, smallest_force } => {
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

impl From<SceneErrors> for Failure {
    fn from(errors: SceneErrors) -> Failure {
        let first = errors.first();
        let (field, value, allowed) = (first.field.clone(), first.value.clone(), first.allowed.clone());
        // The options of the command line are no part of Python.
        let line = |error: &SceneError| match error.origin {
            Origin::Overrides(_) if error.field.is_empty() => error.to_string().replace("--set ", ""),
            Origin::Overrides(_) => error.what(),
            _ => error.to_string(),
        };
        let message = errors.iter().map(line).collect::<Vec<_>>().join("\n");
        if field.is_empty() {
            Failure::Value(message)
        } else {
            Failure::Field { message, field, value, allowed }
        }
    }
}

impl From<Error> for Failure {
    fn from(error: Error) -> Failure {
        match error {
            Error::Values(errors) => errors.into(),
            Error::Value { name, value, allowed } => {
                let message = Error::Value { name: name.clone(), value, allowed }.to_string();
                Failure::Field { message, field: name, value: value.to_string(), allowed: allowed.to_owned() }
            }
            Error::Run(error) => error.into(),
        }
    }
}

impl From<RunError> for Failure {
    fn from(error: RunError) -> Failure {
        let message = error.to_string();
        match error {
            RunError::Values(errors) => errors.into(),
            RunError::OutOfMemory { .. } | RunError::Contact(ContactError::OutOfMemory(_)) => {
                Failure::Memory(message)
            }
            RunError::Contact(ContactError::Stage { index, reason, .. }) => {
                let smallest = if let ContactError::DetachesBefore { smallest } = *reason {
                    Some(smallest)
                } else {
                    None
                };
                Failure::Loading { message, stage: index + 1, smallest_force: smallest }
            }
            _ => Failure::Value(message),
        }
    }
}

impl From<StudyError> for Failure {
    fn from(error: StudyError) -> Failure {
        let message = error.to_string();
        match error {
            StudyError::TooManyRecords(_) | StudyError::Memory { .. } => Failure::Memory(message),
            StudyError::Folder { .. } | StudyError::Write(_) => Failure::File(message),
            StudyError::Run { place, error } if place.is_empty() => error.into(),
            _ => Failure::Value(message),
        }
    }
}

impl From<OutOfMemory> for Failure {
    fn from(error: OutOfMemory) -> Failure {
        Failure::Memory(error.to_string())
    }
}

impl From<QuantityError> for Failure {
    fn from(error: QuantityError) -> Failure {
        Failure::Value(error.to_string())
    }
}
