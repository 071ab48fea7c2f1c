//! From a scene to its force curve: the stages, their selection by the scene, and their results.

mod outcome;
pub(crate) mod reach;
mod reversals;
mod roughness;
mod smooth;
mod stages;
mod workload;

pub use outcome::{LineFacts, Outcome, RunError, Timings};
pub use reach::BeyondFullContact;
pub(crate) use reversals::FEW_SAMPLES;
pub use reversals::{SeeReversal, TURNING_POINTS};
pub use roughness::equivalent_springs;
pub use stages::{AfterLeg, Simulation};
pub use workload::{PlannedStage, Stage, Workload};
