//! Interface that the exact and the stepwise solver share: a body moves from target to target and
//! records its history.

use super::error::ContactError;
use super::history::{History, StageRecord, Work};
use super::stage::Stage;
use super::target::Move;

/// A rigid body that moves from target to target on its springs. The exact solver
/// [`Body`](crate::motion::Body) and the stepwise solver [`Stepwise`](crate::motion::Stepwise)
/// implement this trait.
///
/// ```
/// use asperity_contact::motion::{Body, MovingBody};
/// use asperity_contact::{Contact, Modulus, Move, Profile};
///
/// # let gaps: Vec<f64> = (-512..=512).map(|i| (f64::from(i) * 1.0e-7).powi(2) / 1.0e-4).collect();
/// # let sphere = Profile::from_gaps(gaps, 1.0e-7)?;
/// # let contact = Contact::builder(&sphere, Modulus::effective(1.0e6)?)
/// #     .work_of_adhesion(0.05)
/// #     .build()?;
/// let mut body = Body::new(&contact, 64);
/// let pressed = body.advance(Move::ToForce(1.0e-4))?;
/// // A target out of reach is refused, and the body stays in place.
/// assert!(body.advance(Move::ToForce(-1.0)).is_err());
/// assert_eq!(body.point().indentation, pressed.end());
/// # Ok::<(), asperity_contact::ContactError>(())
/// ```
pub trait MovingBody {
    /// Moves the body to a target. Returns the [`StageRecord`] of this motion, with its force curve
    /// and its energies.
    ///
    /// # Errors
    /// Returns an error for a target that the contact cannot reach. The body then stays in place.
    fn advance(&mut self, target: Move) -> Result<StageRecord, ContactError>;

    /// Returns the [`Stage`] of the present motion. The stage gives the contact at each indentation
    /// of the motion.
    fn stage(&self) -> Stage;

    /// Returns counts of the computing work for this body since it was created.
    fn work(&self) -> Work;

    /// Returns the time in s that the solver has spent on force curves and their extremes since the
    /// body was created. The time to find the patches is not included.
    fn curve_seconds(&self) -> f64;
}

/// Moves the body `solver` to the targets one after the other, and returns the records of all
/// stages. Each target is one loading stage. `after` is called at the end of each stage. Its
/// arguments are the record and the stage of the stage.
///
/// # Errors
/// Returns the error of the first stage that fails, or the first error that `after` returns.
///
/// ```
/// use asperity_contact::motion::{Body, load_body};
/// use asperity_contact::{Contact, Modulus, Move, Profile};
///
/// # let gaps: Vec<f64> = (-512..=512).map(|i| (f64::from(i) * 1.0e-7).powi(2) / 1.0e-4).collect();
/// # let sphere = Profile::from_gaps(gaps, 1.0e-7)?;
/// # let contact = Contact::builder(&sphere, Modulus::effective(1.0e6)?)
/// #     .work_of_adhesion(0.05)
/// #     .build()?;
/// let mut forces = Vec::new();
/// let stages = [Move::ToForce(1.0e-5), Move::ToForce(2.0e-5)];
/// load_body(&mut Body::new(&contact, 16), &stages, |record, _| {
///     forces.push(record.largest.force);
///     Ok(())
/// })?;
/// assert!((forces[1] / forces[0] - 2.0).abs() < 1e-9);
/// # Ok::<(), asperity_contact::ContactError>(())
/// ```
pub fn load_body(
    solver: &mut dyn MovingBody,
    targets: &[Move],
    mut after: impl FnMut(&StageRecord, &Stage) -> Result<(), ContactError>,
) -> Result<History, ContactError> {
    let mut history = History::default();
    for (index, &target) in targets.iter().enumerate() {
        let record = solver
            .advance(target)
            .map_err(|reason| reason.in_stage(index, target))?;
        after(&record, &solver.stage())?;
        history.stages.push(record);
    }
    let last_stage = history.stages.last();
    if let Some(end) = last_stage.and_then(StageRecord::end_in_contact) {
        history.contacts = solver.stage().patches(end.indentation);
    }
    history.work = solver.work();
    Ok(history)
}
