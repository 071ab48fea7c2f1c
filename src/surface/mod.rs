//! The rigid profile: macroscopic form, self-affine or measured roughness, and its statistics.

mod equivalent;
mod form;
mod line;
mod measured;
mod modes;
mod roughness;
mod spectrum;
mod table;
pub use equivalent::{EquivalentLine, MeasuredRoughness};
pub use form::{Form, power_law_factor, struve_0};
pub use line::{Histogram, Line};
pub use measured::{Face, MeasuredOptions, MeasuredProfile, read_faces};
pub use modes::phases;
pub use roughness::Synthesizer;
pub use spectrum::{Amplitude, SelfAffine};
pub use table::{FormTable, Rows};

use crate::memory::OutOfMemory;
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
    /// The height at a spring, the first such one, is not finite.
    #[error("the line has a height that is not finite at spring {0}; form and roughness are too large")]
    NotFinite(usize),
    /// A measured profile or the table of a form could not be read, or a table ends within the profile.
    #[error("{field} = {file:?}: {reason}")]
    File {
        /// Field of the scene, `roughness.file` or `form.file`.
        field: &'static str,
        /// The file.
        file: String,
        /// Fault, with its place if known.
        reason: String,
    },
    /// No spring lies under the punch, with the smallest allowed radius, m: the diameter is rounded to whole cells.
    #[error(
        "form.radius: no spring lies under the punch; allowed: at least a quarter of the spacing, {0:e} m"
    )]
    NoSprings(f64),
}

impl SurfaceError {
    pub(crate) fn measured(file: &Path, reason: &(impl ToString + ?Sized)) -> Self {
        let (field, file) = ("roughness.file", file.display().to_string());
        SurfaceError::File { field, file, reason: reason.to_string() }
    }
}
