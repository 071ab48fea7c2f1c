#![forbid(unsafe_code)]
#![warn(missing_docs)]
#![doc = include_str!("../README.md")]
//!
//! # Names by task
//!
//! * Reading: [`read`] and [`parse`] with [`ReadOptions`] return a [`Topography`]; [`Unit`], [`Cut`] and [`Detrend`] are
//!   options, and [`Cropped`] says what was left out.
//! * Analysis: [`analyse`] with [`AnalysisOptions`] returns an [`Analysis`]: [`PointStatistics`], [`LineMoments`] of one
//!   [`Moment`] each, a [`SelfAffineFit`], each a [`ValueWithError`].
//! * Profiles for the model: [`EquivalentLine`] of a measured surface, [`SelfAffine`] with its [`Amplitude`], [`Form`] and
//!   [`FormTable`].
//! * What is refused: [`SurfaceError`] at a [`Place`].
//!
//! The modules are for programs: [`lines`] on which a scene is computed, [`spectra`] for figures, and [`files`] for readers
//! of other formats.

mod error;
mod line;
mod spectrum;
mod topography;

pub use error::{Place, SurfaceError};
pub use line::equivalent::EquivalentLine;
pub use line::form::Form;
pub use line::spectrum::{Amplitude, SelfAffine};
pub use line::table::FormTable;
pub use spectrum::analysis::{Analysis, AnalysisOptions, analyse};
pub use spectrum::fit::SelfAffineFit;
pub use spectrum::isotropic::{LineMoments, Moment, ValueWithError};
pub use spectrum::statistics::PointStatistics;
pub use topography::Unit;
pub use topography::open::{parse, read};
pub use topography::reading::ReadOptions;
pub use topography::surface::{Cropped, Cut, Detrend, Topography};

/// Reading of bytes, gzip and columns of NumPy arrays, for readers of other files such as force curves.
pub mod files {
    pub use crate::error::refused;
    pub use crate::topography::npy::columns;
    pub use crate::topography::open::{content, unpacked};
}

/// Rigid profiles with random or measured roughness, for the computation of scenes.
pub mod lines {
    pub use crate::line::equivalent::MeasuredRoughness;
    pub use crate::line::form::{power_law_factor, struve_0};
    pub use crate::line::measured::{Face, MeasuredOptions, MeasuredProfile, read_faces};
    pub use crate::line::modes::phases;
    pub use crate::line::rigid_line::{Histogram, Line};
    pub use crate::line::roughness::Synthesizer;
    pub use crate::line::table::Rows;
}

/// Spectra of measured surfaces over the wave number, for figures.
pub mod spectra {
    pub use crate::spectrum::isotropic::{End, IsotropicSpectrum, Node};
    pub use crate::spectrum::periodogram::{Along, Bin, line_spectrum};
}
