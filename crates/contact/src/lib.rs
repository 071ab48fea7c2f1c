#![forbid(unsafe_code)]
#![warn(missing_docs)]
#![doc = include_str!("../README.md")]
//!
//! # Rules
//!
//! The rigid line on the elastic foundation: attachment and detachment of each spring, and the force.
//!
//! Everything here follows the rules of equilibrium of the method of dimensionality reduction with the
//! rule of Hess:
//!
//! * *touch*: a free spring whose gap is closed, c ≤ d, comes into contact;
//! * *grow*: a free spring beside a fragment of n springs comes into contact when
//!   d ≥ c − Δl_max(n), eq. (10);
//! * *detach*: within a fragment of n springs the most stretched one detaches when d ≤ c − Δl_max(n), but
//!   not while its gap is closed.
//!
//! A [`Contact`] is what stays the same while the body moves, a [`Leg`] the contact at all indentations of a motion in
//! one direction, and a [`Body`] a leg and the position on it. [`Leg`] applies these rules in one pass over a tree;
//! [`Stepwise`] moves by small steps and relaxes, as the paper does. What allocates may lack memory; other errors are named.

mod adhesive;
mod body;
mod contact_state;
mod history;
mod interval;
mod leg;
mod springs;
mod stepwise;
mod thresholds;
mod totals;

pub use adhesive::levels::Edges;
pub use adhesive::tree::ContactTree;
pub use body::{Body, Motion, Reversal, Solver, run};
pub use history::{CurvePoint, Direction, History, LegRecord, Move, Patch, Work};
pub use leg::{Leg, PatchState};
pub use springs::{Contact, Foundation, HessRule, Springs};
pub use stepwise::Stepwise;
pub use totals::{ContactTotals, GapScale};

use asperity_data::OutOfMemory;
use thiserror::Error;

/// Limit of the steps of one motion of the stepwise solver.
const STEP_LIMIT: u64 = 10_000_000;

/// Number of springs above which a second thread saves more time than it costs.
const TWO_THREADS: usize = 1 << 17;

/// Reason why a body does not move to a target.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ContactError {
    /// A stage of a loading is refused.
    #[error("loading.{index} = {target:?}: {reason}")]
    Stage {
        /// Index of the stage, from 0.
        index: usize,
        /// Target of the stage.
        target: Move,
        /// Reason of the refusal.
        reason: Box<ContactError>,
    },
    /// An array does not fit into memory.
    #[error(transparent)]
    OutOfMemory(#[from] OutOfMemory),
    /// The value of the target, which is infinite or not a number.
    #[error("{0} is not finite; allowed: finite numbers")]
    NotFinite(f64),
    /// A tensile force is the target of a separated body.
    #[error("a pulling force needs a contact; allowed from separation: at least 0 N")]
    NothingToPull,
    /// A turning point lies in separation.
    #[error("a reversal begins in contact; allowed: an indentation of at least 0 m, or a force")]
    NoContact,
    /// The contact detaches before it falls to the force of the target.
    #[error("the contact detaches before that force; smallest force within reach: {smallest:e} N")]
    DetachesBefore {
        /// Smallest force the contact bears, N.
        smallest: f64,
    },
    /// No finite indentation reaches the force.
    #[error("no finite indentation reaches that force on this foundation")]
    OutOfReach,
    /// The stepwise solver would need too many steps.
    #[error(
        "more than {STEP_LIMIT} steps of {0:e} m; take a larger numerics.solver.step or the exact solver"
    )]
    TooManySteps(f64),
    /// A motion or a search needs an exact leg, but the leg is of the stepwise solver.
    #[error("a leg of the stepwise solver is known at its steps alone; allowed: a leg of the exact solver")]
    Stepwise,
    /// A state that the program excludes, with its description: a defect.
    #[error("internal error, please report it: {0}")]
    Internal(&'static str),
    /// The computation was stopped.
    #[error("interrupted")]
    Interrupted,
}

impl ContactError {
    /// Returns true if the contact cannot reach the force of the target.
    pub fn is_out_of_reach(&self) -> bool {
        use ContactError::{DetachesBefore, NothingToPull, OutOfReach, Stage};
        let reason = if let Stage { reason, .. } = self { reason } else { self };
        matches!(reason, NothingToPull | DetachesBefore { .. } | OutOfReach)
    }

    /// Adds the stage to the reason; lack of memory, interruptions and defects concern the whole loading and stay as they
    /// are.
    pub(crate) fn in_stage(self, index: usize, target: Move) -> Self {
        match self {
            ContactError::Stage { .. }
            | ContactError::OutOfMemory { .. }
            | ContactError::Internal(_)
            | ContactError::Interrupted => self,
            reason => ContactError::Stage { index, target, reason: Box::new(reason) },
        }
    }
}
