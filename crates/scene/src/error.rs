//! The error type of the functions at the root of this crate.

use crate::scene::errors::SceneErrors;
use crate::simulation::outcome::RunError;
use thiserror::Error;

/// Error of the functions at the root of this crate.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum Error {
    /// Values of a scene are out of their ranges; each error has field, value and allowed range.
    #[error(transparent)]
    Values(#[from] SceneErrors),
    /// A value of a profile or a contact is out of its range.
    #[error("{name} = {}; allowed: {allowed}", shown(*value))]
    Value {
        /// Name of the value.
        name: String,
        /// The value as it was given, in SI units.
        value: f64,
        /// Allowed range, with its unit.
        allowed: &'static str,
    },
    /// A computation failed: a force out of reach, a file that cannot be read, or not enough memory.
    #[error(transparent)]
    Run(#[from] RunError),
}

/// A value as a user would write it: numbers of ordinary size without an exponent.
fn shown(value: f64) -> String {
    let is_plain = value == 0.0 || (1e-3..1e10).contains(&value.abs());
    if is_plain { value.to_string() } else { format!("{value:e}") }
}
