//! Errors of the rigid profile.

use thiserror::Error;

use std::path::Path;

/// Reason why a profile could not be made.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum SurfaceError {
    /// An array does not fit into memory.
    #[error("numerics.points: not enough memory for {points} springs")]
    OutOfMemory {
        /// Requested springs.
        points: usize,
    },
    /// The Fourier transform refused its input.
    #[error("roughness: the Fourier transform failed: {0}")]
    Transform(String),
    /// A height is not finite.
    #[error("the line has a height that is not finite at spring {index}; form and roughness are too large")]
    NotFinite {
        /// First such spring.
        index: usize,
    },
    /// A measured profile could not be read.
    #[error("roughness.file = {file:?}: {reason}")]
    Measured {
        /// The file.
        file: String,
        /// Fault, with its row if known.
        reason: String,
    },
    /// No spring lies under the body.
    #[error(
        "form.radius: no spring lies under the punch; allowed: at least a quarter of the spacing, {least:e} m"
    )]
    NoSprings {
        /// Smallest allowed radius, m: the diameter is rounded to whole cells.
        least: f64,
    },
}

impl SurfaceError {
    /// A refused measured surface.
    pub(crate) fn measured(file: &Path, reason: &(impl ToString + ?Sized)) -> Self {
        SurfaceError::Measured { file: file.display().to_string(), reason: reason.to_string() }
    }
}
