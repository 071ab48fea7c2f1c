//! Targets of a motion.

#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// Target of a body: one loading stage.
///
/// ```
/// use asperity_contact::{Contact, Modulus, Move, Profile};
///
/// # let gaps: Vec<f64> = (-512..=512).map(|i| (f64::from(i) * 1.0e-7).powi(2) / 1.0e-4).collect();
/// # let sphere = Profile::from_gaps(gaps, 1.0e-7)?;
/// # let contact = Contact::builder(&sphere, Modulus::effective(1.0e6)?).work_of_adhesion(0.05).build()?;
/// // Adhesion draws the sphere in until the force is zero; then it is pressed and pulled off.
/// let cycle = contact.load(&[Move::ToTouch, Move::ToZeroForce, Move::ToForce(1.0e-5), Move::ToSeparation])?;
/// assert!(cycle.stages()[1].end() > 0.0 && cycle.stages()[3].end() < 0.0);
/// # Ok::<(), asperity_contact::ContactError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub enum Move {
    /// Until the force first reaches this value, N (compression positive).
    ToForce(f64),
    /// To this indentation, m (0 at first touch).
    ToIndentation(f64),
    /// Until the displacement of the instrument D = d + F/k first reaches this value, m, where k is the loading stiffness
    /// of the contact. For a rigid instrument D is the indentation.
    ToDisplacement(f64),
    /// To the indentation of first touch, d = 0.
    ToTouch,
    /// Until the force is zero; from separation, past first touch until the force is back at zero.
    ToZeroForce,
    /// To separation.
    ToSeparation,
}
