#![forbid(unsafe_code)]
#![warn(missing_docs)]
#![doc = include_str!("../README.md")]
//!
//! # Names by task
//!
//! * A contact: [`Profile`], [`Modulus`], [`Edges`], and [`Contact`] from a [`ContactBuilder`].
//! * Loading it: [`Move`]s with [`LoadOptions`], the turning points of [`Contact::reversals`] with a [`Reversal`] each.
//! * Results: a [`Cycle`] with its [`History`] of [`LegRecord`]s in one [`Direction`] each; the [`Curve`] with its
//!   [`CurvePoint`]s; the [`Patch`]es at the end; [`Figures`], the marked points ([`Mark`]) and the [`Branch`]es; the
//!   [`Work`] done by the computer.
//! * Theory beside them: [`ClosedForm`].
//! * What is refused: [`ContactError`].
//!
//! Programs that move a contact step by step also need the module [`motion`].
//!
//! # Rules
//!
//! A rigid profile lies on an elastic foundation of independent springs. Each spring attaches and detaches by the equilibrium
//! rules of the method of dimensionality reduction, with the rule of Hess for adhesion. Here c is the gap of a spring, d the
//! indentation and Δl_max(n) the largest stretch of a patch of n springs. The paper, whose equations are cited by number, is
//! Popov and Filippov (2012). The rules are:
//!
//! * *touch*: a free spring attaches when its gap is closed, c ≤ d;
//! * *grow*: a free spring beside a patch of n springs attaches when d ≥ c − Δl_max(n), eq. (10);
//! * *detach*: the most stretched spring of a patch of n springs detaches when d ≤ c − Δl_max(n), unless its gap is closed.
//!
//! A [`Contact`] has the profile, the modulus and the adhesion, which remain the same while the body moves. A
//! [`Leg`](motion::Leg) is the contact at all indentations of a motion in one direction, and a [`Body`](motion::Body) is a leg
//! with the position on it. A leg follows from these rules in one pass over a tree. [`Stepwise`](motion::Stepwise) moves by
//! small steps and relaxes after each step, as the paper does. Any function that allocates may return
//! [`ContactError::OutOfMemory`]; the documentation of a function lists all other errors.

mod adhesive;
mod body;
mod branches;
mod closed_form;
mod contact;
mod contact_state;
mod cycle;
mod error;
mod figures;
mod foundation;
mod history;
mod interval;
mod leg;
mod modulus;
mod profile;
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
pub use figures::{Figures, Mark};
pub use history::{CurvePoint, Direction, History, LegRecord, Patch, Work};
pub use modulus::Modulus;
pub use profile::Profile;
pub use target::Move;

/// Bodies that move from target to target, as instruments and particle codes need them. The stepwise solver serves to check the
/// exact one.
pub mod motion {
    pub use crate::adhesive::tree::ContactTree;
    pub use crate::body::{Body, Motion, MovingBody, load_body};
    pub use crate::leg::{Leg, PatchState};
    pub use crate::stepwise::Stepwise;
}
