//! Spectrum of a measured surface: the isotropic spectrum C2D(q) that follows from profiles and
//! maps, its equivalent line, and the uncertainty of both.
//!
//! A measured profile is a cut through a surface. It is not the equivalent line, which the method
//! of dimensionality reduction needs. For an isotropic surface the spectra of the cut and of the
//! equivalent line follow from the same spectrum C2D:
//!
//! C_cut(k) = (1/π) ∫₀^∞ C2D(√(k² + t²)) dt, C_line(q) = q C2D(q)/2.
//!
//! The line therefore has the same rms height as the cut, √2 times the rms gradient of the cut, and
//! π/2 times its elastic energy. A direct computation of C2D from one periodogram would amplify the
//! noise of the periodogram. The fit therefore maximises the likelihood of the periodograms over
//! all spectra that are positive and smooth.
//!
//! The wave number is q = 2π/wavelength in rad/m. The spectral densities C1D in m³ and C2D in m⁴
//! give the rms height h by h² = (1/π) ∫₀^∞ C1D dq = (1/2π) ∫₀^∞ q C2D dq. The steps are described
//! in `docs/surface-estimate.md`.

pub(crate) mod analysis;
mod axis_power;
mod detrend;
mod differences;
mod exact;
mod fits;
mod given;
mod grid_model;
mod identities;
mod interlaced;
pub(crate) mod isotropic;
mod isotropic_fit;
mod last_wave;
mod levelled;
mod likelihood;
mod map_power;
pub(crate) mod moments;
pub(crate) mod nodes;
mod observation;
pub(crate) mod options;
mod parts;
pub(crate) mod periodogram;
mod point_results;
mod powers;
mod quadrature;
mod scoring;
mod self_affine_ends;
pub(crate) mod self_affine_fit;
pub(crate) mod statistics;
mod trends;
mod weights;

use crate::error::{Place, SurfaceError, refused};

fn no_maximum() -> SurfaceError {
    let fault = "the likelihood has no maximum: heights without noise or with few digits";
    refused(Place::File, fault, "measured heights")
}
