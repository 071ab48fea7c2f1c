//! The rigid profile: macroscopic form, self-affine or measured roughness, and its statistics.

mod equivalent;
mod error;
mod form;
mod line;
mod measured;
mod modes;
mod roughness;
mod spectrum;
mod table;

pub use equivalent::{EquivalentLine, Face, MeasuredRoughness, read_faces};
pub use error::SurfaceError;
pub use form::{Form, power_law_factor, struve_0};
pub use line::{Histogram, Line};
pub use measured::{MeasuredOptions, MeasuredProfile};
pub use modes::phases;
pub use roughness::Synthesizer;
pub use spectrum::{Amplitude, SelfAffine};
pub use table::{FormTable, Rows};
