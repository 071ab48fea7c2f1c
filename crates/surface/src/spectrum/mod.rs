//! Spectrum of a measured surface: from profiles and maps to the underlying isotropic spectrum C2D(q), its
//! equivalent line, and their uncertainty.
//!
//! A measured profile is a cut through a surface, not the line of the method of dimensionality reduction. For an isotropic
//! surface both follow from one spectrum,
//!
//! C_cut(k) = (1/π) ∫₀^∞ C2D(√(k² + t²)) dt,  C_line(q) = q C2D(q)/2,
//!
//! so that the line has the rms height of the cut, √2 times its rms gradient and π/2 times its elastic energy. Inverting
//! one periodogram amplifies its noise; the fit maximises the likelihood of the periodograms instead, over spectra that
//! are positive and smooth.
//!
//! Conventions: wave number q = 2π/wavelength in rad/m; C1D in m³ with h² = (1/π) ∫₀^∞ C1D dq; C2D in m⁴ with
//! h² = (1/2π) ∫₀^∞ q C2D dq. Steps are described in `docs/surface-estimate.md`.

pub(crate) mod analysis;
pub(crate) mod fit;
pub(crate) mod interlaced;
pub(crate) mod isotropic;
pub(crate) mod linear;
pub(crate) mod observation;
pub(crate) mod periodogram;
pub(crate) mod statistics;

use crate::topography::TopographyError;
use asperity_data::OutOfMemory;
use thiserror::Error;

/// Reason why surfaces cannot be analysed.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum SpectrumError {
    /// One of the surfaces cannot be analysed.
    #[error("{reason}")]
    Surface {
        /// Index of the surface, from 0.
        index: usize,
        /// Reason of the refusal.
        reason: TopographyError,
    },
    /// The surfaces or the options of the analysis are not allowed.
    #[error("{found}; allowed: {allowed}")]
    Refused {
        /// What was found, in words.
        found: String,
        /// What is allowed, and the option that helps.
        allowed: String,
    },
    /// The Fourier transform refused its input.
    #[error("the Fourier transform failed: {0}")]
    Transform(String),
    /// Insufficient memory.
    #[error(transparent)]
    OutOfMemory(#[from] OutOfMemory),
}

impl SpectrumError {
    fn refused(found: impl ToString, allowed: impl ToString) -> Self {
        SpectrumError::Refused { found: found.to_string(), allowed: allowed.to_string() }
    }

    fn no_maximum() -> Self {
        let found = "the likelihood has no maximum: heights without noise or with few digits";
        SpectrumError::refused(found, "measured heights")
    }

    /// Index of the surface that cannot be analysed; 0 if the fault lies in all of them together.
    pub fn surface(&self) -> usize {
        if let SpectrumError::Surface { index, .. } = self { *index } else { 0 }
    }
}
