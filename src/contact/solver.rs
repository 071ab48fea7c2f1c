//! What every solver offers: a body moved leg by leg.

use super::{ContactError, History, LegRecord, Work};
use crate::scene::Leg;

/// A body on its foundation that can be moved leg by leg. It begins separated, at d = 0 just before
/// first touch.
pub trait Solver {
    /// Moves the body along one leg.
    ///
    /// # Errors
    /// When the target of the leg cannot be reached; the body then stands where it stood.
    fn advance(&mut self, leg: Leg) -> Result<LegRecord, ContactError>;

    /// First and last spring of each contact fragment at `indentation` on the present leg, in
    /// ascending order.
    fn fragments(&self, indentation: f64) -> Vec<(usize, usize)>;

    /// Writes, for each spring in its order along the line, the smallest indentation at which it is in
    /// contact on the present leg (−∞ always, +∞ never).
    fn thresholds_along_line(&self, out: &mut Vec<f64>);

    /// What has been done so far.
    fn work(&self) -> Work;

    /// Seconds spent so far on curves and extremes rather than on what joins and leaves.
    fn curve_seconds(&self) -> f64;
}

/// Runs a whole loading history. `after` sees each leg as soon as it is done, with the solver as it
/// then stands.
///
/// # Errors
/// The first leg that fails ends the run.
pub fn run(
    solver: &mut dyn Solver,
    legs: &[Leg],
    mut after: impl FnMut(&LegRecord, &dyn Solver) -> Result<(), ContactError>,
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
