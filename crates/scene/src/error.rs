//! The error of the front of the library.

use crate::scene::errors::SceneErrors;
use crate::simulation::outcome::RunError;
use thiserror::Error;

/// Error of the functions at the root of this crate.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum Error {
    /// Values out of their ranges: field, value and allowed range of each.
    #[error(transparent)]
    Values(#[from] SceneErrors),
    /// A value of a profile or a contact out of its range.
    #[error("{name} = {}; allowed: {allowed}", shown(*value))]
    Value {
        /// Name of the value.
        name: String,
        /// The value.
        value: f64,
        /// Allowed range.
        allowed: &'static str,
    },
    /// A force out of reach, a file that cannot be read, or not enough memory.
    #[error(transparent)]
    Run(#[from] RunError),
}

/// A value as a user would write it: a count without an exponent.
fn shown(value: f64) -> String {
    let is_plain = value == 0.0 || (1e-3..1e10).contains(&value.abs());
    if is_plain { value.to_string() } else { format!("{value:e}") }
}
