//! Interface of the solvers: a body moved leg by leg.

use super::{ContactError, History, LegContact, LegRecord, LegView, Work};
use crate::scene::Leg;

/// A body on its foundation that can be moved leg by leg. It begins separated, at d = 0 just before
/// first touch.
pub trait Solver {
    /// Moves the body along one leg.
    ///
    /// # Errors
    /// For a target out of reach; the body then stays at its indentation.
    fn advance(&mut self, leg: Leg) -> Result<LegRecord, ContactError>;

    /// Contact at all indentations of the present leg.
    fn leg(&self) -> LegView<'_>;

    /// Work counts since the start.
    fn work(&self) -> Work;

    /// Seconds spent on curves and extremes since the start, without the thresholds.
    fn curve_seconds(&self) -> f64;

    /// See [`LegView::fragments`].
    fn fragments(&self, indentation: f64) -> Vec<(usize, usize)> {
        self.leg().fragments(indentation)
    }

    /// See [`LegView::rises`].
    fn rises(&self, indentation: f64) -> Vec<f64> {
        self.leg().rises(indentation)
    }

    /// See [`LegView::thresholds`].
    fn thresholds_along_line(&self, out: &mut Vec<f64>) {
        self.leg().thresholds(out);
    }

    /// Copies the contact at all indentations of the present leg into the memory of `copy`: far
    /// cheaper than [`Solver::thresholds_along_line`] and enough to replay the leg.
    ///
    /// # Errors
    /// [`ContactError::OutOfMemory`]; the copy then holds no contact.
    fn copy_leg(&self, copy: &mut LegContact) -> Result<(), ContactError> {
        copy.copy(self.leg())
    }
}

/// Runs a whole loading history. `after` receives each completed leg and the solver in its state then.
///
/// # Errors
/// The first leg that fails ends the run.
pub fn run<S: Solver + ?Sized>(
    solver: &mut S,
    legs: &[Leg],
    mut after: impl FnMut(&LegRecord, &S) -> Result<(), ContactError>,
) -> Result<History, ContactError> {
    let mut history = History::default();
    for &leg in legs {
        let record = solver.advance(leg)?;
        after(&record, solver)?;
        history.legs.push(record);
    }
    let end = history.legs.last().and_then(|record| record.curve.last());
    history.contacts = match end {
        Some(point) if point.springs > 0 => solver.fragments(point.indentation),
        _ => Vec::new(),
    };
    history.work = solver.work();
    Ok(history)
}
