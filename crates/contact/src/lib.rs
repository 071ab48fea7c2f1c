#![forbid(unsafe_code)]
#![warn(missing_docs)]
#![doc = include_str!("../README.md")]
//!
//! # Names by task
//!
//! * To set up a [`Contact`]: a [`ContactBuilder`] takes a [`Profile`], a [`Modulus`] and the edge
//!   model [`Edges`].
//! * To load it: [`Contact::load`] takes one [`Move`] for each stage, and [`Contact::load_with`]
//!   also takes [`LoadOptions`]. [`Contact::reversals`] computes a [`Reversal`], the unloading to
//!   separation, for each of many turning points.
//! * Results: a [`Cycle`] has the force [`Curve`], the [`Figures`] such as the pull-off force, and
//!   a [`StageRecord`] of each stage with its [`Direction`] and its [`CurvePoint`]s. A [`Mark`]
//!   names a special point of the curve, and a [`MarkedPoint`] has its place. A [`Branch`] joins
//!   successive stages in one direction. A [`Patch`] is a group of neighbouring springs in contact.
//!   [`Events`] are the jumps and marks of a loading, each as an [`Event`]. A [`History`], which
//!   the module [`motion`] returns, has the records of all stages and counts of computing [`Work`].
//! * To check results: [`ClosedForm`] computes the forces of a sphere, a cone and other bodies by
//!   theory.
//! * Errors: [`ContactError`] names the value or the stage that is refused.
//!
//! Programs that decide during the motion where a body moves next use the module [`motion`].
//!
//! # Rules
//!
//! A rigid profile lies on an elastic foundation of independent springs. Each spring attaches and
//! detaches by the equilibrium rules of the method of dimensionality reduction, with the rule of
//! Hess for adhesion. A *patch* is a group of neighbouring springs in contact. The gap c of a
//! spring is the depth of the profile at this spring below the highest point of the profile. The
//! indentation is d. Δl_max(n) is the largest stretch that a patch of n springs bears. The equation
//! numbers refer to Popov and Filippov (2012). The rules are:
//!
//! * *touch*: a free spring attaches when its gap is closed, c ≤ d;
//! * *grow*: a free spring beside a patch of n springs attaches when d ≥ c − Δl_max(n), eq. (10);
//! * *detach*: the most stretched spring of a patch of n springs detaches when d ≤ c − Δl_max(n),
//!   unless its gap is closed.
//!
//! A [`Stage`](motion::Stage) describes a motion in one direction: which springs are in contact at
//! each indentation. A [`Body`](motion::Body) is the exact solver. [`Stepwise`](motion::Stepwise)
//! is the stepwise solver: it moves by small steps and finds equilibrium after each step, as
//! Popov and Filippov (2012) do. Any function that allocates may return
//! [`ContactError::OutOfMemory`]; the documentation of a function lists all other errors.

mod adhesive;
mod body;
mod branches;
mod closed_form;
mod contact;
mod contact_state;
mod crossing;
mod cycle;
mod detachment;
mod error;
mod events;
mod figures;
mod foundation;
mod history;
mod interval;
mod modulus;
mod moving_body;
mod nominal_form;
mod profile;
mod relaxation;
mod stage;
mod stepwise;
mod target;
mod thresholds;
mod totals;

pub use adhesive::levels::Edges;
pub use body::Reversal;
pub use branches::Branch;
pub use closed_form::ClosedForm;
pub use contact::{Contact, ContactBuilder};
pub use cycle::{Curve, Cycle, LoadOptions};
pub use error::ContactError;
pub use events::{Event, Events};
pub use figures::{Figures, Mark, MarkedPoint};
pub use history::{CurvePoint, Direction, ForcePoint, History, Patch, StageRecord, Work};
pub use modulus::Modulus;
pub use nominal_form::NominalForm;
pub use profile::Profile;
pub use relaxation::law::Relaxation;
pub use target::Move;

pub use asperity_data::Warning;

/// Solvers for bodies that move from one target to the next, for models of instruments and for
/// simulations of particles. [`Body`](motion::Body) is the exact solver.
/// [`Stepwise`](motion::Stepwise), the stepwise solver, serves to check the exact solver.
pub mod motion {
    pub use crate::adhesive::tree::ContactTree;
    pub use crate::body::{Body, Motion};
    pub use crate::events::JumpCollector;
    pub use crate::moving_body::{MovingBody, load_body};
    pub use crate::relaxation::body::RelaxingBody;
    pub use crate::stage::forces::InstrumentJump;
    pub use crate::stage::jumps::{Jump, JumpKind};
    pub use crate::stage::{PatchState, Stage};
    pub use crate::stepwise::Stepwise;
}
