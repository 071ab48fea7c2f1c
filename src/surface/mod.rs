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

pub use amplitude::{Amplitude, WaveNumbers};
pub use equivalent::{EquivalentLine, Face, MeasuredOptions, MeasuredRoughness, read_faces};
pub use error::SurfaceError;
pub use form::{line_power_law, mdr_profile, power_law_factor};
pub use histogram::Histogram;
pub use line::Line;
pub use measured::MeasuredProfile;
pub use phases::phases;
pub use roughness::{Synthesizer, UnitRoughness};
pub use spectrum::SelfAffine;
pub use struve::{struve_0, struve_1};
