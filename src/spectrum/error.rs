//! Errors of the analysis of surfaces.

use crate::topography::TopographyError;
use thiserror::Error;

/// Reason why surfaces are not analysed.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum SpectrumError {
    /// There is no surface.
    #[error("no surface; allowed: at least one")]
    Nothing,
    /// A surface is refused; numbered from 0.
    #[error("{error}")]
    Surface {
        /// Index of the surface.
        index: usize,
        /// Reason.
        error: TopographyError,
    },
    /// All heights are equal.
    #[error("no roughness is left after detrending; allowed: heights that differ")]
    Smooth,
    /// The spectrum would continue up to a wave number that is already resolved.
    #[error(
        "the spectrum continues up to q = {to:e} rad/m; allowed: above the last resolved wave, q = {last:e} rad/m"
    )]
    End {
        /// Requested wave number, rad/m.
        to: f64,
        /// Last resolved wave number, rad/m.
        last: f64,
    },
    /// No spectrum explains the powers.
    #[error(
        "the likelihood has no maximum: heights without noise or with few digits; allowed: measured heights"
    )]
    NoMaximum,
    /// Insufficient memory for this number of points.
    #[error("not enough memory for the transform of {0} points")]
    OutOfMemory(usize),
    /// The Fourier transform refused its input.
    #[error("the Fourier transform failed: {0}")]
    Transform(String),
}

impl SpectrumError {
    /// Index of the refused surface, if the error is that of one; numbered from 0.
    pub(crate) fn surface(&self) -> Option<usize> {
        match self {
            SpectrumError::Surface { index, .. } => Some(*index),
            _ => None,
        }
    }
}
