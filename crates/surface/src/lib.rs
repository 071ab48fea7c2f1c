#![forbid(unsafe_code)]
#![warn(missing_docs)]
#![doc = include_str!("../README.md")]

mod line;
mod spectrum;
mod topography;

pub use line::SurfaceError;
pub use line::equivalent::{EquivalentLine, MeasuredRoughness};
pub use line::form::{Form, power_law_factor, struve_0};
pub use line::measured::{Face, MeasuredOptions, MeasuredProfile, read_faces};
pub use line::modes::phases;
pub use line::rigid_line::{Histogram, Line};
pub use line::roughness::Synthesizer;
pub use line::spectrum::{Amplitude, SelfAffine};
pub use line::table::{FormTable, Rows};
pub use spectrum::SpectrumError;
pub use spectrum::analysis::{Analysis, Options, analyse};
pub use spectrum::fit::PowerLaw;
pub use spectrum::isotropic::{End, Estimate, IsotropicSpectrum, LineMoments, Moment, Node};
pub use spectrum::periodogram::{Along, Bin, line_spectrum};
pub use spectrum::statistics::PointStatistics;
pub use topography::npy::columns;
pub use topography::open::{content, parse, read, unpacked};
pub use topography::reading::ReadOptions;
pub use topography::surface::{Cropped, Cut, Detrend, Topography};
pub use topography::text::each_text;
pub use topography::text::header::{Column, Header, Role};
pub use topography::text::layout::{Cell, Decimal, ONE_MARK, Separator};
pub use topography::{Place, TopographyError, Unit, UnitError, refused, shown};
