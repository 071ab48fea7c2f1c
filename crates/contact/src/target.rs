//! Targets of the motion of a body.

#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// Target of one loading stage of a body.
///
/// ```
/// use asperity_contact::{Contact, Modulus, Move, Profile};
///
/// # let gaps: Vec<f64> = (-512..=512).map(|i| (f64::from(i) * 1.0e-7).powi(2) / 1.0e-4).collect();
/// # let sphere = Profile::from_gaps(gaps, 1.0e-7)?;
/// # let contact = Contact::builder(&sphere, Modulus::effective(1.0e6)?)
/// #     .work_of_adhesion(0.05)
/// #     .build()?;
/// // Adhesion draws the sphere in until the force is zero; then it is pressed and pulled off.
/// let cycle = contact.load(&[
///     Move::ToTouch,
///     Move::ToZeroForce,
///     Move::ToForce(1.0e-5),
///     Move::ToSeparation,
/// ])?;
/// assert!(cycle.stages()[1].end() > 0.0 && cycle.stages()[3].end() < 0.0);
/// # Ok::<(), asperity_contact::ContactError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub enum Move {
    /// Moves until the force first reaches this value in N; compression is positive.
    ToForce(f64),
    /// Moves to this indentation in m; 0 is the first touch.
    ToIndentation(f64),
    /// Moves until the drive of the instrument first reaches this displacement D = d + F/k in m. d
    /// is the indentation, F the force, and k the stiffness of the instrument in N/m.
    ToDisplacement(f64),
    /// Moves to the indentation of first touch, d = 0.
    ToTouch,
    /// Moves until the force is zero. A separated body is moved into contact beyond first touch,
    /// until the force has returned to zero.
    ToZeroForce,
    /// Moves until the bodies separate.
    ToSeparation,
    /// Keeps the drive of the instrument in place for this time in s. Without
    /// [relaxation](crate::Relaxation) nothing changes in this time.
    Hold(f64),
}
