//! Errors of the contact solvers.

use crate::scene::Leg;
use thiserror::Error;

/// Reason for which a contact is not computed.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ContactError {
    /// An array does not fit into memory.
    #[error("not enough memory for {springs} springs")]
    OutOfMemory {
        /// Requested number of springs.
        springs: usize,
    },
    /// A pulling force on a separated body.
    #[error(
        "loading.{index} = ToForce({force:e}): a pulling force needs a contact; allowed from separation: at least 0 N"
    )]
    NothingToPull {
        /// Index of the leg.
        index: usize,
        /// Requested force, N.
        force: f64,
    },
    /// A turning point without contact.
    #[error(
        "loading.{index} = {leg:?}: a reversal begins in contact; allowed: an indentation of at least 0 m, or a force"
    )]
    NoContact {
        /// Index of the leg.
        index: usize,
        /// The leg.
        leg: Leg,
    },
    /// The contact detaches above this force.
    #[error(
        "loading.{index} = {leg:?}: the contact detaches above that force; allowed in this stage: at least {smallest:e} N"
    )]
    DetachesBefore {
        /// Index of the leg.
        index: usize,
        /// The leg.
        leg: Leg,
        /// Smallest force the contact bears, N.
        smallest: f64,
    },
    /// No finite indentation reaches the force.
    #[error("loading.{index} = {leg:?}: no finite indentation reaches that force on this foundation")]
    OutOfReach {
        /// Index of the leg.
        index: usize,
        /// The leg.
        leg: Leg,
    },
    /// The stepwise solver would need too many steps.
    #[error(
        "loading.{index}: more than {limit} steps of {step:e} m; take a larger numerics.solver.step or the exact solver"
    )]
    TooManySteps {
        /// Index of the leg.
        index: usize,
        /// Step, m.
        step: f64,
        /// Most steps allowed on one leg.
        limit: u64,
    },
    /// A state that the program excludes: a defect.
    #[error("internal error, please report it: {0}")]
    Internal(&'static str),
    /// The computation was stopped.
    #[error("interrupted")]
    Interrupted,
}
