//! Reasons why a value is refused or a body does not move to a target.

use super::target::Move;
use asperity_data::{OutOfMemory, format_quantity, rounded_up};
use thiserror::Error;

/// Limit of the steps of one motion of the stepwise solver.
pub const STEP_LIMIT: u64 = 10_000_000;

/// Largest value, in SI units, of any quantity of a contact; its inverse is the smallest length, modulus or stiffness.
/// Products of such values are finite.
pub const LARGEST: f64 = 1e50;

/// Reason why a value is refused, or why a body does not move to a target.
///
/// ```
/// use asperity_contact::{Contact, Modulus, Move, Profile};
///
/// let flat = Profile::from_gaps(vec![0.0; 8], 1.0e-6)?;
/// let contact = Contact::builder(&flat, Modulus::effective(1.0e6)?).work_of_adhesion(0.05).build()?;
/// let refused = contact.load(&[Move::ToForce(1.0e-3), Move::ToForce(-1.0)]).unwrap_err();
/// assert_eq!(refused.stage(), Some(1));
/// assert!(refused.smallest_force().is_some_and(|force| -1.0 < force && force < 0.0));
/// assert!(refused.to_string().starts_with("stage 2: the contact detaches before -1 N; smallest force within reach: "));
/// # Ok::<(), asperity_contact::ContactError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ContactError {
    /// A value of a profile, a modulus or a contact is out of its range.
    #[error("{name} = {}; allowed: {allowed}", shown(*value))]
    Value {
        /// Name of the value.
        name: String,
        /// The value as it was given, in SI units.
        value: f64,
        /// Allowed range, with its unit.
        allowed: &'static str,
    },
    /// A stage of a loading is refused.
    #[error("stage {}: {}", index + 1, reason.in_words(*target))]
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
    /// A turning point has no contact.
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
    /// Index of the refused stage of a loading, from 0; `None` for an error that is not of a stage.
    pub fn stage(&self) -> Option<usize> {
        if let ContactError::Stage { index, .. } = self { Some(*index) } else { None }
    }

    /// Smallest force that the contact bears, N, if a stage was refused because its force is smaller.
    pub fn smallest_force(&self) -> Option<f64> {
        if let ContactError::DetachesBefore { smallest } = self.reason() { Some(*smallest) } else { None }
    }

    /// Returns true if the contact cannot reach the force of the target.
    pub fn is_out_of_reach(&self) -> bool {
        use ContactError::{DetachesBefore, NothingToPull, OutOfReach};
        matches!(self.reason(), NothingToPull | DetachesBefore { .. } | OutOfReach)
    }

    /// Reason why a body does not move to a target, in words, with forces rounded into the allowed range.
    pub fn in_words(&self, target: Move) -> String {
        match (self, target) {
            (&ContactError::DetachesBefore { smallest }, Move::ToForce(force)) => {
                let [force, least] = [force, rounded_up(smallest)].map(|force| format_quantity(force, "N"));
                format!("the contact detaches before {force}; smallest force within reach: {least}")
            }
            (error, _) => error.to_string(),
        }
    }

    /// The reason without its stage.
    fn reason(&self) -> &ContactError {
        if let ContactError::Stage { reason, .. } = self { reason } else { self }
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

/// Returns true for a positive value within the allowed magnitudes.
pub fn is_positive(value: f64) -> bool {
    (LARGEST.recip()..=LARGEST).contains(&value)
}

/// Returns an error that names the value and what is allowed, unless the value is allowed.
pub fn check(name: &str, value: f64, is_allowed: bool, allowed: &'static str) -> Result<(), ContactError> {
    if is_allowed { Ok(()) } else { Err(ContactError::Value { name: name.to_owned(), value, allowed }) }
}

/// A value as a user would write it: numbers of ordinary size without an exponent.
fn shown(value: f64) -> String {
    let is_plain = value == 0.0 || (1e-3..1e10).contains(&value.abs());
    if is_plain { value.to_string() } else { format!("{value:e}") }
}
