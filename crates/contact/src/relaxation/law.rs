//! The parameters of relaxation.

use crate::error::{ContactError, check, is_positive};

/// Relaxation of the foundation: a standard linear solid with one relaxation time.
///
/// ```
/// use asperity_contact::{Contact, Modulus, Move, Profile, Relaxation};
///
/// let gaps: Vec<f64> = (-512..=512)
///     .map(|i| (f64::from(i) * 1.0e-7).powi(2) / 1.0e-4)
///     .collect();
/// let sphere = Profile::from_gaps(gaps, 1.0e-7)?;
/// let contact = Contact::builder(&sphere, Modulus::effective(1.0e6)?)
///     .work_of_adhesion(0.05)
///     .relaxation(Relaxation::new(0.5, 1.0)?)
///     .loading_speed(1.0e-3)
///     .build()?;
/// // The force falls while the sphere rests, and the sphere then adheres twice as strongly.
/// let cycle = contact.load(&[Move::ToForce(1.0e-4), Move::Hold(100.0), Move::ToSeparation])?;
/// let held = &cycle.stages()[1];
/// assert!(held.curve[held.curve.len() - 1].force < 0.7e-4);
/// assert!(cycle.pull_off_force().unwrap() > 1.5 * 1.5 * std::f64::consts::PI * 0.05 * 1.0e-4);
/// # Ok::<(), asperity_contact::ContactError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Relaxation {
    share: f64,
    time: f64,
}

impl Relaxation {
    /// Largest share of the modulus that may relax. If the whole modulus relaxed, no force would
    /// remain at rest, and there would be no equilibrium.
    pub const LARGEST_SHARE: f64 = 0.99;

    /// Largest error that the finite steps in time may cause in a force, as a share of the largest
    /// force.
    pub const STEP_ERROR: f64 = 1e-3;

    /// Creates the relaxation of a foundation whose modulus falls by the share `share` of its
    /// instantaneous value, with the relaxation time `time` in s. A share of zero is an elastic
    /// foundation.
    ///
    /// # Errors
    /// Returns [`ContactError::Value`] for a share that is not from 0 to 0.99, and for a time that
    /// is not from 1e-50 to 1e50 s.
    pub fn new(share: f64, time: f64) -> Result<Self, ContactError> {
        let is_allowed = (0.0..=Self::LARGEST_SHARE).contains(&share);
        check("relaxation share", share, is_allowed, "from 0 to 0.99")?;
        let allowed = "from 1e-50 to 1e50 s";
        check("relaxation time", time, is_positive(time), allowed)?;
        Ok(Relaxation { share, time })
    }

    /// Returns the share s of the instantaneous modulus that relaxes.
    pub fn share(self) -> f64 {
        self.share
    }

    /// Returns the relaxation time τ in s.
    pub fn time(self) -> f64 {
        self.time
    }

    /// Returns the share of the instantaneous modulus that remains after a long time.
    pub fn remaining_share(self) -> f64 {
        1.0 - self.share
    }
}
