//! The rigid profile: macroscopic form, self-affine or measured roughness, and its statistics.

pub(crate) mod equivalent;
pub(crate) mod form;
pub(crate) mod measured;
pub(crate) mod modes;
pub(crate) mod rigid_line;
pub(crate) mod roughness;
pub(crate) mod spectrum;
pub(crate) mod table;

use asperity_data::OutOfMemory;
use std::path::Path;
use thiserror::Error;

/// Reason why a profile could not be made.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum SurfaceError {
    /// The arrays of the springs do not fit into memory.
    #[error("numerics.points: {0}")]
    OutOfMemory(#[from] OutOfMemory),
    /// The Fourier transform refused its input.
    #[error("roughness: the Fourier transform failed: {0}")]
    Transform(String),
    /// The height at this spring, by index, is not finite; earlier ones are.
    #[error("the line has a height that is not finite at spring {0}; form and roughness are too large")]
    NotFinite(usize),
    /// A measured profile or the table of a form could not be read, or a table ends within the profile.
    #[error("{field} = {file:?}: {reason}")]
    File {
        /// Field of the scene, `roughness.file` or `form.file`.
        field: &'static str,
        /// Path of the file.
        file: String,
        /// What is wrong, with the place in the file where it is known.
        reason: String,
    },
    /// No spring lies under the punch, whose diameter is rounded to whole cells; the value is the smallest allowed radius, m.
    #[error(
        "form.radius: no spring lies under the punch; allowed: at least a quarter of the spacing, {0:e} m"
    )]
    NoSprings(f64),
}

impl SurfaceError {
    /// Creates the error of a file with a measured surface.
    pub fn measured(file: &Path, reason: &(impl ToString + ?Sized)) -> Self {
        let (field, file) = ("roughness.file", file.display().to_string());
        SurfaceError::File { field, file, reason: reason.to_string() }
    }
}
