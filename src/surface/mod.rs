//! The rigid profile: macroscopic form, self-affine or measured roughness, and its statistics.

mod amplitude;
mod equivalent;
mod error;
mod form;
mod histogram;
mod line;
mod measured;
mod modes;
mod phases;
mod roughness;
mod spectrum;
mod struve;
mod table;

pub use amplitude::Amplitude;
pub use equivalent::{EquivalentLine, Face, MeasuredRoughness, read_faces};
pub use error::SurfaceError;
pub use form::{Form, power_law_factor};
pub use histogram::Histogram;
pub use line::Line;
pub use measured::{MeasuredOptions, MeasuredProfile};
pub use phases::phases;
pub use roughness::Synthesizer;
pub use spectrum::SelfAffine;
pub use struve::struve_0;
pub use table::{FormTable, Rows};
