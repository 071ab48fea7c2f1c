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
//! [`Stepwise`] moves by small steps and relaxes, as the paper does. Functions that allocate return
//! [`ContactError::OutOfMemory`]; other errors are listed.

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
pub use contact::{Contact, ContactBuilder};
pub use cycle::{Curve, Cycle, LoadOptions};
pub use error::ContactError;
pub use figures::Figures;
pub use history::{CurvePoint, Direction, History, LegRecord, Patch, Work};
pub use modulus::Modulus;
pub use profile::Profile;
pub use target::Move;

/// A contact that is moved step by step: for instruments, particle codes, and to compare with the rules themselves.
pub mod motion {
    pub use crate::adhesive::tree::ContactTree;
    pub use crate::body::{Body, Motion, MovingBody, load_body};
    pub use crate::leg::{Leg, PatchState};
    pub use crate::stepwise::Stepwise;
}

/// Points of a force curve with a name, as preload and pull-off: for figures and readers of curves.
pub mod points {
    pub use crate::branches::{Branch, preload_point, pull_off_point};
    pub use crate::figures::{Mark, marks};
}

/// Closed forms of single contacts: for comparisons with theory.
pub mod closed_forms {
    pub use crate::closed_form::{ClosedForm, flat_punch, ideal_adhesion_force};
}
