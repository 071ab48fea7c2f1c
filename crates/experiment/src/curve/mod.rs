//! A measured force curve: its segments, the zero offset and drift of its force, and its noise.
//! Forces in compression and displacements towards the specimen are positive.

pub(crate) mod drag;
pub(crate) mod features;
pub(crate) mod free_parts;
pub(crate) mod motion;
pub(crate) mod numerics;
mod ordered;
pub(crate) mod points;
mod prepare;
mod rest;
pub(crate) mod segments;
pub(crate) mod sources;
mod statements;
#[cfg(test)]
mod tests;
pub(crate) mod timing;
pub(crate) mod zero;

use crate::curve::drag::{Drag, DragForce};
use crate::curve::features::{CurveFeatures, ForceJump};
use crate::curve::numerics::Extent;
use crate::curve::timing::Timing;
use asperity_data::Note;

/// Smallest force that counts as a pull or a tension, in standard deviations of the noise. A
/// smaller force may be noise.
const LEAST_TENSION: f64 = 5.0;

/// Measured force curve in SI units. The displacement grows when the body is pressed on. The force
/// is positive in compression; before contact it is zero except for noise and drift.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredCurve {
    /// Displacement of the instrument at each point, in m. If the file has only the displacement of
    /// the body, and no stiffness of the instrument is known, these values are displacements of the
    /// body.
    pub displacement: Vec<f64>,
    /// Force at each point, in N.
    pub force: Vec<f64>,
    /// Index, counted from 0, of the segment of each point. A segment is a part of the curve
    /// between two turning points. The body is pressed in segments with even indices, and pulled in
    /// segments with odd indices.
    pub segment: Vec<usize>,
    /// Number of points at the beginning of the curve that lie before the contact.
    pub(crate) free: usize,
    /// Number of points at the end of the curve that lie after the contact.
    pub(crate) free_at_end: usize,
    /// Displacement in m at which the contact begins, estimated from the force.
    pub touch: f64,
    /// Standard deviation of the noise of the force in N. It is computed from the points before
    /// contact unless [`CurveOptions::noise`](crate::CurveOptions::noise) gives its value.
    pub noise: f64,
    /// Features that are computed from the curve without a model, such as its jumps.
    pub features: CurveFeatures,
    /// Drag of a fluid in contact, which was found from the points without contact and subtracted
    /// from the force; `None` if no drag was found.
    pub drag: Option<DragForce>,
    /// The drag as a function of the distance to first touch; `None` if the drag has the same value
    /// at all distances.
    pub(crate) drag_over_distance: Option<Drag>,
    /// True if the body is out of contact at the end of the last retraction.
    pub detaches: bool,
    /// Number of points of the file that are used. In a long curve, neighbouring points are
    /// averaged, so that there are fewer values in [`Self::force`].
    pub points: usize,
    /// Number of points of the file that are left out because displacement or force is missing.
    pub missing: usize,
    /// Jumps of the force of the whole curve, in the order of time.
    pub(crate) jumps: Vec<ForceJump>,
    /// Displacement at the end of each segment, in m.
    pub(crate) turns: Vec<f64>,
    /// Speed of the instrument, and its rest between approach and retraction.
    pub(crate) timing: Timing,
    /// Time in s since the instrument began to rest, for each point of its rest; `None` for the
    /// other points. Empty if the curve has no points of a rest.
    pub(crate) seconds_at_rest: Vec<Option<f64>>,
    /// Changes of the force, in N, that remain in the points without contact: the drift over time,
    /// the tilt over the displacement, and the step from before to after the contact. A change that
    /// was not found is 0.
    pub(crate) remaining: [f64; 3],
    /// Contributions to the force that were estimated from the points without contact and
    /// subtracted: the zero offset (unless the options state it), drift, tilt and drag.
    pub(crate) subtracted: SubtractedLines,
    /// Stiffness of the instrument in N/m as the file states it, with its name in the file.
    pub(crate) stiffness: Option<(String, f64)>,
    /// Name of the column of the displacement if this displacement excludes the deflection of the
    /// instrument, otherwise `None`.
    pub(crate) of_body: Option<String>,
    /// Sentences on the assumptions and changes that were made when the curve was read, such as the
    /// choice of columns and units.
    pub statements: Vec<Note>,
}

/// Contributions to the force, called lines, that were estimated from the points without contact
/// and subtracted from a curve: the zero offset of the force, drift, tilt and drag.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct SubtractedLines {
    /// True if the zero offset of the force was estimated, and not stated by the options.
    pub has_zero: bool,
    /// Contributions that were subtracted from the force, such as a drift, except the constant zero
    /// offset. Each element has the values of one contribution at all points of the curve.
    pub columns: Vec<Vec<f64>>,
    /// Sums of products of the subtracted contributions, one sum for each pair of contributions.
    /// The sums are over the points without contact in segments that the options leave out and of
    /// which the curve has no points. The first row and column belong to the zero offset, whose
    /// value is 1 at each point.
    pub elsewhere: Vec<Vec<f64>>,
}

impl MeasuredCurve {
    /// Returns the displacement in m and the force in N of each point.
    pub fn points(&self) -> impl Iterator<Item = (f64, f64)> {
        self.displacement
            .iter()
            .copied()
            .zip(self.force.iter().copied())
    }

    /// Returns the largest tensile force during the retractions in N, as a positive number. Returns
    /// `None` if this force is at most 5 times [`Self::noise`], or if the body does not detach.
    pub fn pull_off_force(&self) -> Option<f64> {
        if !self.detaches {
            return None;
        }
        let points = self.force.iter().zip(&self.segment);
        let pulled = points.filter(|(_, segment)| *segment % 2 == 1);
        let force = -Extent::of(pulled.map(|(force, _)| *force)).low;
        (force > LEAST_TENSION * self.noise && force.is_finite()).then_some(force)
    }

    /// Returns the curve with about `count` of its points at equal steps of the index; `None` if
    /// the curve has fewer than 2 × `count` points.
    pub(crate) fn thinned(&self, count: usize) -> Option<MeasuredCurve> {
        let step = self.force.len() / count;
        if step < 2 {
            return None;
        }
        let end_of_contact = (self.force.len() - self.free_at_end).div_ceil(step);
        let count = self.force.len().div_ceil(step);
        let thin = |values: &[f64]| values.iter().step_by(step).copied().collect::<Vec<f64>>();
        Some(MeasuredCurve {
            displacement: thin(&self.displacement),
            force: thin(&self.force),
            segment: self.segment.iter().step_by(step).copied().collect(),
            free: self.free.div_ceil(step),
            free_at_end: count - end_of_contact.min(count),
            subtracted: SubtractedLines {
                has_zero: self.subtracted.has_zero,
                elsewhere: self.subtracted.elsewhere.clone(),
                columns: self
                    .subtracted
                    .columns
                    .iter()
                    .map(|column| thin(column))
                    .collect(),
            },
            jumps: self.jumps.clone(),
            turns: self.turns.clone(),
            statements: self.statements.clone(),
            stiffness: self.stiffness.clone(),
            of_body: self.of_body.clone(),
            timing: self.timing.clone(),
            seconds_at_rest: self.seconds_at_rest.iter().step_by(step).copied().collect(),
            ..*self
        })
    }

    /// Returns one column for each line (zero offset, drift, tilt or drag) that was estimated and
    /// subtracted, with its value at each point. A fit of a model uses these columns to estimate
    /// the lines again. If `has_zero` is true, the zero offset is a free parameter of this fit and
    /// gets no column.
    pub(crate) fn lines(&self, has_zero: bool) -> Vec<Vec<f64>> {
        let mut columns = Vec::new();
        if self.subtracted.has_zero && !has_zero {
            columns.push(vec![1.0; self.force.len()]);
        }
        columns.extend(self.subtracted.columns.iter().cloned());
        columns
    }

    /// Returns true for each point between the part before contact and the part after contact, and
    /// false for each other point. The two parts were found without a model.
    pub(crate) fn in_contact(&self) -> Vec<bool> {
        let end = self.force.len() - self.free_at_end;
        (0..self.force.len())
            .map(|index| (self.free..end).contains(&index))
            .collect()
    }
}
