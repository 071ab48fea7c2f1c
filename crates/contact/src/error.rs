//! Reasons why a value is refused or a body does not move to a target.

use super::target::Move;
use asperity_data::{OutOfMemory, format_quantity, rounded_up};
use thiserror::Error;

/// Largest number of steps of one motion of the stepwise solver.
pub const STEP_LIMIT: u64 = 10_000_000;

/// Largest value, in SI units, of any quantity of a contact. The inverse 1e-50 is the smallest
/// length, modulus or stiffness. With these limits, products of quantities are finite.
pub const LARGEST: f64 = 1e50;

/// Reason why a value is refused, or why a body does not move to a target.
///
/// ```
/// use asperity_contact::{Contact, Modulus, Move, Profile};
///
/// let flat = Profile::from_gaps(vec![0.0; 8], 1.0e-6)?;
/// let contact = Contact::builder(&flat, Modulus::effective(1.0e6)?)
///     .work_of_adhesion(0.05)
///     .build()?;
/// let refused = contact
///     .load(&[Move::ToForce(1.0e-3), Move::ToForce(-1.0)])
///     .unwrap_err();
/// assert_eq!(refused.stage(), Some(1));
/// assert!(
///     refused
///         .smallest_force()
///         .is_some_and(|force| -1.0 < force && force < 0.0)
/// );
/// assert!(
///     refused.to_string().starts_with(
///         "stage 2: the contact detaches before -1 N; smallest force within reach: "
///     )
/// );
/// # Ok::<(), asperity_contact::ContactError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ContactError {
    /// A value of a profile, a modulus or a contact is out of its range.
    #[error("{name} = {}; allowed: {allowed}", shown(*value))]
    Value {
        /// Name of the refused value, such as `spacing`.
        name: String,
        /// The refused value in SI units.
        value: f64,
        /// Allowed range of the value, with its unit.
        allowed: &'static str,
    },
    /// A loading stage cannot be computed.
    #[error("stage {}: {}", index + 1, reason.in_words(*target))]
    Stage {
        /// Index of the stage, from 0.
        index: usize,
        /// Target of the stage.
        target: Move,
        /// Reason why the stage cannot be computed, as an error of another variant.
        reason: Box<ContactError>,
    },
    /// An array that the computation needs does not fit into memory. The message states the size of
    /// the array in MiB.
    #[error(transparent)]
    OutOfMemory(#[from] OutOfMemory),
    /// A target is infinite or not a number. The field is the value of the target.
    #[error("{0} is not finite; allowed: finite numbers")]
    NotFinite(f64),
    /// A body that is separated cannot move to a tensile force.
    #[error("a pulling force needs a contact; allowed from separation: at least 0 N")]
    NothingToPull,
    /// At a target of [`Contact::reversals`](crate::Contact::reversals), where the body should turn
    /// back, the body is not in contact.
    #[error("a reversal begins in contact; allowed: an indentation of at least 0 m, or a force")]
    NoContact,
    /// The contact detaches before the force falls to the target force.
    #[error("the contact detaches before that force; smallest force within reach: {smallest:e} N")]
    DetachesBefore {
        /// Smallest force in N that the contact reaches on this unloading.
        smallest: f64,
    },
    /// A body over a foundation with [relaxation](crate::Relaxation) cannot load again after
    /// springs have detached, because the free surface has not recovered.
    #[error(
        "with relaxation the surface that has detached has not recovered; allowed: one approach and one unloading, or no relaxation"
    )]
    NotRecovered,
    /// An unloading from each of many turning points, and a motion by hand, are computed only for
    /// an elastic foundation, without [relaxation](crate::Relaxation).
    #[error(
        "reversals and motions by hand need an elastic foundation; allowed: no relaxation, or one loading for each turning point"
    )]
    NotElastic,
    /// No finite indentation on this foundation has the target force.
    #[error("no finite indentation reaches that force on this foundation")]
    OutOfReach,
    /// The [stepwise solver](crate::motion::Stepwise) would need more steps than it allows. The
    /// field is the length of a step in m.
    #[error(
        "more than {STEP_LIMIT} steps of {0:e} m; take a larger numerics.solver.step or the exact solver"
    )]
    TooManySteps(f64),
    /// A motion or a search needs a [`Stage`](crate::motion::Stage) of the exact solver, but the
    /// stage belongs to the stepwise solver.
    #[error(
        "a stage of the stepwise solver is known at its steps alone; allowed: a stage of the exact solver"
    )]
    Stepwise,
    /// The program has a defect. The field describes the impossible state that was found.
    #[error("internal error, please report it: {0}")]
    Internal(&'static str),
    /// The computation ended because a function of the caller requested this, such as the function
    /// of [`LoadOptions::before_stage`](crate::LoadOptions::before_stage).
    #[error("interrupted")]
    Interrupted,
}

impl ContactError {
    /// Returns the index, from 0, of the loading stage that was refused. Returns `None` for an
    /// error that does not concern one stage.
    pub fn stage(&self) -> Option<usize> {
        if let ContactError::Stage { index, .. } = self {
            Some(*index)
        } else {
            None
        }
    }

    /// Returns the smallest force in N that the contact reaches on the unloading, if the target is
    /// a smaller force. Returns `None` for other errors.
    pub fn smallest_force(&self) -> Option<f64> {
        if let ContactError::DetachesBefore { smallest } = self.reason() {
            Some(*smallest)
        } else {
            None
        }
    }

    /// Returns true if the target is a force that the contact cannot reach.
    pub fn is_out_of_reach(&self) -> bool {
        use ContactError::{DetachesBefore, NothingToPull, OutOfReach};
        matches!(
            self.reason(),
            NothingToPull | DetachesBefore { .. } | OutOfReach
        )
    }

    /// Returns a message that states why a body does not move to a target, with forces in suitable
    /// units.
    pub fn in_words(&self, target: Move) -> String {
        let ContactError::DetachesBefore { smallest } = self else {
            return self.to_string();
        };
        let Move::ToForce(force) = target else {
            return self.to_string();
        };
        let force = format_quantity(force, "N");
        let least = format_quantity(rounded_up(*smallest), "N");
        format!("the contact detaches before {force}; smallest force within reach: {least}")
    }

    /// Returns the reason of an error that names a stage; returns any other error unchanged.
    fn reason(&self) -> &ContactError {
        if let ContactError::Stage { reason, .. } = self {
            reason
        } else {
            self
        }
    }

    /// Returns the error of a loading stage, with this error as its reason. Errors about memory,
    /// interruptions and defects are returned unchanged, because they concern the whole loading.
    pub(crate) fn in_stage(self, index: usize, target: Move) -> Self {
        match self {
            ContactError::Stage { .. }
            | ContactError::OutOfMemory { .. }
            | ContactError::Internal(_)
            | ContactError::Interrupted => self,
            reason => ContactError::Stage {
                index,
                target,
                reason: Box::new(reason),
            },
        }
    }
}

/// Returns true if a value is positive and its magnitude is in the allowed range, from 1e-50 to
/// 1e50.
pub fn is_positive(value: f64) -> bool {
    (LARGEST.recip()..=LARGEST).contains(&value)
}

/// Returns `Ok` if the value is allowed, otherwise an error that states the value and the allowed
/// range.
pub fn check(
    name: &str,
    value: f64,
    is_allowed: bool,
    allowed: &'static str,
) -> Result<(), ContactError> {
    if is_allowed {
        return Ok(());
    }
    Err(ContactError::Value {
        name: name.to_owned(),
        value,
        allowed,
    })
}

/// Writes a value as a user would write it: values from 0.001 to 1e10 and zero without an exponent.
fn shown(value: f64) -> String {
    let is_plain = value == 0.0 || (1e-3..1e10).contains(&value.abs());
    if is_plain {
        value.to_string()
    } else {
        format!("{value:e}")
    }
}
