#![forbid(unsafe_code)]
#![warn(missing_docs)]
#![doc = include_str!("../README.md")]
//!
//! # Names by task
//!
//! * To read a surface: [`read`] takes a file, [`parse`] takes its content, and both return a
//!   [`Topography`]. Both take [`ReadOptions`], such as a [`Unit`] or a [`Cut`]. [`Cropped`] counts
//!   empty rows and columns that are left out.
//! * To analyse surfaces: [`analyse`] takes [`AnalysisOptions`], such as a [`Detrend`], and returns
//!   an [`Analysis`]. An analysis contains [`PointStatistics`], [`LineMoments`] and a
//!   [`SelfAffineFit`]. The type of each moment is [`Moment`], and the type of each fitted
//!   parameter is [`ValueWithError`].
//! * To make rigid profiles: [`EquivalentLine`] has the spectrum of a measured surface,
//!   [`SelfAffine`] is a spectrum given by few numbers and computes its [`Amplitude`], and [`Form`]
//!   is the shape without roughness, which may be a [`FormTable`].
//! * Errors: [`SurfaceError`] names what is refused, and its [`Place`].
//!
//! The modules are for programs that need more: [`lines`] makes the profiles of whole scenes,
//! [`spectra`] has spectra for figures, and [`files`] helps to read other formats.

mod error;
mod line;
mod spectrum;
mod topography;

pub use error::{ChosenBy, Place, PlaceInFile, SurfaceError};
pub use line::equivalent::EquivalentLine;
pub use line::form::{Form, Sphere};
pub use line::spectrum::{Amplitude, SelfAffine};
pub use line::table::FormTable;
pub use spectrum::analysis::{Analysis, analyse};
pub use spectrum::moments::{LineMoments, Moment, ValueWithError};
pub use spectrum::options::AnalysisOptions;
pub use spectrum::self_affine_fit::SelfAffineFit;
pub use spectrum::statistics::PointStatistics;
pub use topography::cut::Cut;
pub use topography::open::{parse, read};
pub use topography::options::ReadOptions;
pub use topography::surface::{Cropped, Detrend, Topography};
pub use topography::unit::Unit;

/// Functions for programs that read other data than surfaces, such as measured force curves. The
/// functions read the bytes of a file, decompress gzip, and read columns of NumPy arrays and of
/// arrays of the program Igor Pro.
pub mod files {
    pub use crate::error::refused;
    pub use crate::topography::igor::{IgorWave, WaveDimension, is_igor_wave};
    pub use crate::topography::npy::columns;
    pub use crate::topography::open::{content, unpacked};
}

/// Rigid profiles with random or measured roughness, for programs that compute a contact from a
/// scene file.
pub mod lines {
    pub use crate::line::equivalent::MeasuredRoughness;
    pub use crate::line::form::{power_law_factor, struve_0};
    pub use crate::line::measured::{Face, MeasuredOptions, MeasuredProfile, read_faces};
    pub use crate::line::modes::phases;
    pub use crate::line::rigid_line::{Histogram, Line};
    pub use crate::line::roughness::Synthesizer;
    pub use crate::line::spectrum::ModeRange;
    pub use crate::line::table::Rows;
}

/// Spectra of measured surfaces over the wave number, for charts.
pub mod spectra {
    pub use crate::spectrum::isotropic::{IsotropicSpectrum, Node};
    pub use crate::spectrum::nodes::End;
    pub use crate::spectrum::periodogram::{Along, Bin, line_spectrum};
}
