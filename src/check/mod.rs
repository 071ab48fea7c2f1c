//! The catalogue of hard cases: claims that must hold for numerically difficult input, and checks on this machine.
//!
//! Each case has a claim of one sentence, computes it with the unmodified library, and returns one number: the
//! error, against a bound that is stated beforehand. References are closed forms; relaxation of the three rules,
//! written without tree and thresholds; sums with twice the digits; and laws (scales, mirrors, memory, order,
//! energy) that hold for every body. A case whose contact differs from that of the rules, or that cannot be
//! computed, fails with a sentence about the place.

mod body;
mod case;
mod cases;
mod catalogue;
mod exhaustive;
mod extended;
mod reference;
mod relaxation;

pub use body::{Body, LENGTH, MODULUS, RMS_HEIGHT, end};
pub use case::{Case, Evidence, Family, Scope};
pub use catalogue::{Check, Verdict, catalogue, checks, judge};
pub use extended::Extended;
pub use reference::{Agreement, follow, force_error};
pub use relaxation::Relaxation;

use crate::contact::ContactError;
use crate::scene::SceneErrors;
use crate::simulation::RunError;
use crate::study::LinesError;
use crate::surface::SurfaceError;
use thiserror::Error;

/// Reason why a case returned no number.
#[derive(Debug, Error)]
pub enum Fault {
    /// A claim does not hold.
    #[error("{0}")]
    Wrong(String),
    /// A profile could not be made.
    #[error(transparent)]
    Surface(#[from] SurfaceError),
    /// A body could not be moved.
    #[error(transparent)]
    Contact(#[from] ContactError),
    /// A scene could not be computed.
    #[error(transparent)]
    Run(#[from] RunError),
    /// Several profiles could not be computed.
    #[error(transparent)]
    Lines(#[from] LinesError),
    /// A scene is invalid.
    #[error(transparent)]
    Scene(Box<SceneErrors>),
}

impl From<SceneErrors> for Fault {
    fn from(errors: SceneErrors) -> Self {
        Fault::Scene(Box::new(errors))
    }
}

/// Returns a fault unless `holds`.
pub(crate) fn ensure(holds: bool, what: impl FnOnce() -> String) -> Result<(), Fault> {
    if holds { Ok(()) } else { Err(Fault::Wrong(what())) }
}
