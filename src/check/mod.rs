//! The catalogue of hard cases: what must hold however hard it is on the numbers, and whether it does here.
//!
//! Each case says in one sentence what must hold, computes it with the library as it is, and gives one number:
//! the error, against a bound that is stated beforehand. References are closed forms; relaxation of the three
//! rules, written without tree and thresholds; sums of twice the digits; and laws (scales, mirrors, memory,
//! order, energy) that hold for every body. A case whose contact is another than the rules', or that cannot be
//! computed, fails with a sentence that says where.

mod body;
mod case;
mod cases;
mod catalogue;
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

/// Reason for which a case gave no number.
#[derive(Debug, Error)]
pub enum Fault {
    /// Something is not as it must be.
    #[error("{0}")]
    Wrong(String),
    /// A line could not be made.
    #[error(transparent)]
    Surface(#[from] SurfaceError),
    /// A body could not be moved.
    #[error(transparent)]
    Contact(#[from] ContactError),
    /// A scene could not be computed.
    #[error(transparent)]
    Run(#[from] RunError),
    /// Several lines could not be computed.
    #[error(transparent)]
    Lines(#[from] LinesError),
    /// A scene is not allowed.
    #[error(transparent)]
    Scene(Box<SceneErrors>),
}

impl From<SceneErrors> for Fault {
    fn from(errors: SceneErrors) -> Self {
        Fault::Scene(Box::new(errors))
    }
}

/// A fault unless something holds.
pub(crate) fn ensure(holds: bool, what: impl FnOnce() -> String) -> Result<(), Fault> {
    if holds { Ok(()) } else { Err(Fault::Wrong(what())) }
}
