#![forbid(unsafe_code)]
#![warn(missing_docs)]
#![doc = include_str!("../README.md")]

mod error;
mod line;
mod spectrum;
mod topography;

pub use error::{Place, SurfaceError};
pub use line::equivalent::{EquivalentLine, MeasuredRoughness};
pub use line::form::{Form, power_law_factor, struve_0};
pub use line::measured::{Face, MeasuredOptions, MeasuredProfile, read_faces};
pub use line::modes::phases;
pub use line::rigid_line::{Histogram, Line};
pub use line::roughness::Synthesizer;
pub use line::spectrum::{Amplitude, SelfAffine};
pub use line::table::{FormTable, Rows};
pub use spectrum::analysis::{Analysis, AnalysisOptions, analyse};
pub use spectrum::fit::SelfAffineFit;
pub use spectrum::isotropic::{End, IsotropicSpectrum, LineMoments, Moment, Node, ValueWithError};
pub use spectrum::periodogram::{Along, Bin, line_spectrum};
pub use spectrum::statistics::PointStatistics;
pub use topography::Unit;
pub use topography::open::{parse, read};
pub use topography::reading::ReadOptions;
pub use topography::surface::{Cropped, Cut, Detrend, Topography};

/// Content of files for other readers: bytes, gzip and columns of NumPy arrays, as readers of force curves need them.
pub mod files {
    pub use crate::error::refused;
    pub use crate::topography::npy::columns;
    pub use crate::topography::open::{content, unpacked};
}
