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
//! h² = (1/2π) ∫₀^∞ q C2D dq. Steps are described in `docs/surfaces.md`.

mod analysis;
mod fit;
mod interlaced;
mod isotropic;
mod linear;
mod observation;
mod periodogram;
mod statistics;

pub use crate::topography::Detrend;
pub use analysis::{Analysis, Options, analyse};
pub use fit::PowerLaw;
pub(crate) use isotropic::line_moments;
pub use isotropic::{End, Estimate, IsotropicSpectrum, LineMoments, Moment};
pub use periodogram::{Bin, Direction, line_spectrum};
pub use statistics::Statistics;

use crate::memory::OutOfMemory;
use thiserror::Error;

/// Reason why surfaces are not analysed.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("{reason}")]
pub struct SpectrumError {
    /// Index of the refused surface, from 0, if it is one.
    pub(crate) surface: Option<usize>,
    reason: String,
}

impl SpectrumError {
    fn new(reason: impl ToString) -> Self {
        SpectrumError { surface: None, reason: reason.to_string() }
    }

    fn no_maximum() -> Self {
        let fault = "the likelihood has no maximum: heights without noise or with few digits";
        SpectrumError::new(format!("{fault}; allowed: measured heights"))
    }
}

impl From<OutOfMemory> for SpectrumError {
    fn from(error: OutOfMemory) -> Self {
        SpectrumError::new(error)
    }
}
