//! Branches, preload and pull-off of a loading history. They depend only on the motion of the body,
//! not on the division of the motion into loading stages.

use super::history::{CurvePoint, Direction, StageRecord};
use asperity_data::Warning;
use std::ops::Range;

/// Relative difference within which two forces or two indentations count as equal, because equal
/// forces may be computed as different sums.
pub(super) const ROUNDING: f64 = 1e-9;
/// Largest relative motion that counts as rounding, if a stage moves the body to a force or
/// displacement that it already has.
const NO_MOTION: f64 = 4.0 * f64::EPSILON;

/// Motion of a body in one direction: consecutive loading stages in this direction, taken together.
///
/// ```
/// use asperity_contact::Branch;
/// use asperity_contact::{Contact, Direction, Modulus, Move, Profile};
///
/// # let gaps: Vec<f64> = (-512..=512).map(|i| (f64::from(i) * 1.0e-7).powi(2) / 1.0e-4).collect();
/// # let sphere = Profile::from_gaps(gaps, 1.0e-7)?;
/// # let contact = Contact::builder(&sphere, Modulus::effective(1.0e6)?)
/// #     .work_of_adhesion(0.05)
/// #     .build()?;
/// // Two stages that load are one branch.
/// let cycle = contact.load(&[Move::ToTouch, Move::ToForce(1.0e-5), Move::ToSeparation])?;
/// let branches = Branch::all(cycle.stages());
/// assert_eq!((branches[0].direction, branches[0].stages.clone()), (Direction::Loading, 0..2));
/// # Ok::<(), asperity_contact::ContactError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Branch {
    /// Direction of the motion.
    pub direction: Direction,
    /// Indices of the stages of the branch.
    pub stages: Range<usize>,
}

impl Branch {
    /// Divides a history into branches, and returns the branches in their order. `records` are the
    /// records of all loading stages.
    pub fn all(records: &[StageRecord]) -> Vec<Branch> {
        let mut branches: Vec<Branch> = Vec::new();
        for (stage, record) in records.iter().enumerate() {
            match branches.last_mut() {
                Some(last) if last.direction == record.direction || is_still(record) => {
                    last.stages.end += 1
                }
                // If all stages so far leave the body in place, they belong to the branch of the
                // next stage.
                Some(last) if records[last.stages.clone()].iter().all(is_still) => {
                    *last = Branch {
                        direction: record.direction,
                        stages: last.stages.start..stage + 1,
                    };
                }
                _ => branches.push(Branch {
                    direction: record.direction,
                    stages: stage..stage + 1,
                }),
            }
        }
        branches
    }

    /// Returns the last branch that moves a body in contact away from the foundation; `None` if
    /// there is no such branch.
    pub fn last_unloading(records: &[StageRecord]) -> Option<Branch> {
        let mut branches = Branch::all(records).into_iter();
        branches.rfind(|branch| {
            branch.direction == Direction::Unloading && branch.touching(records).next().is_some()
        })
    }

    /// Returns the stages of the branch that move in its direction and have contact, with the
    /// indices of the stages. A stage without contact has no extreme force.
    fn touching<'l>(
        &self,
        records: &'l [StageRecord],
    ) -> impl DoubleEndedIterator<Item = (usize, &'l StageRecord)> {
        stages_in_contact(records, self.stages.clone(), self.direction)
    }

    /// Finds the point of the preload. Returns the index of its stage and the point. The preload is
    /// the largest force on loading before the last unloading. Forces before an earlier separation
    /// of the body do not count.
    ///
    /// ```
    /// use asperity_contact::{Branch, Contact, Modulus, Move, Profile};
    ///
    /// # let gaps: Vec<f64> = (-512..=512)
    /// #     .map(|i| (f64::from(i) * 1.0e-7).powi(2) / 1.0e-4)
    /// #     .collect();
    /// # let sphere = Profile::from_gaps(gaps, 1.0e-7)?;
    /// # let contact = Contact::builder(&sphere, Modulus::effective(1.0e6)?)
    /// #     .work_of_adhesion(0.05)
    /// #     .build()?;
    /// let cycle = contact.load(&[
    ///     Move::ToForce(1.0e-5),
    ///     Move::ToForce(-1.0e-5),
    ///     Move::ToForce(2.0e-5),
    ///     Move::ToSeparation,
    /// ])?;
    /// // The preload is reached by the third stage, the pull-off by the last.
    /// assert_eq!(
    ///     Branch::preload(cycle.stages()).map(|(stage, _)| stage),
    ///     Some(2)
    /// );
    /// assert_eq!(
    ///     Branch::pull_off(cycle.stages()).map(|(stage, _)| stage),
    ///     Some(3)
    /// );
    /// # Ok::<(), asperity_contact::ContactError>(())
    /// ```
    pub fn preload(records: &[StageRecord]) -> Option<(usize, CurvePoint)> {
        let end = match Branch::last_unloading(records) {
            Some(unloading) => unloading.stages.start,
            None => records.len(),
        };
        let last_separation = records[..end].iter().rposition(|record| {
            record.direction == Direction::Unloading && record.end_in_contact().is_none()
        });
        let start = last_separation.map_or(0, |stage| stage + 1);
        let loadings = stages_in_contact(records, start..end, Direction::Loading);
        let largest = loadings.map(|(stage, record)| (stage, record.largest));
        // If several stages have the same largest force, the last one counts, as within one stage.
        largest.max_by(|(_, point), (_, other)| point.force.total_cmp(&other.force))
    }

    /// Finds the point of the pull-off. Returns the index of its stage and the point. The pull-off
    /// is the smallest force of the last unloading. Returns `None` in three cases:
    ///
    /// * the smallest force is above zero;
    /// * the unloading ends in contact while the force is still falling;
    /// * the unloading ends in contact, and a further unloading to separation would pass a smaller
    ///   force.
    pub fn pull_off(records: &[StageRecord]) -> Option<(usize, CurvePoint)> {
        let unloading = Branch::last_unloading(records)?;
        let (stage, least) = unloading.smallest(records)?;
        let rounding = unloading.rounding(records);
        let is_passed = match unloading.rest(records) {
            Rest::None => true,
            Rest::Unknown => false,
            Rest::Smallest(of_rest) => {
                let end = records.get(unloading.stages.end - 1)?.curve.last()?;
                least.force < end.force - rounding && least.force <= of_rest.force + rounding
            }
        };
        (least.force <= 0.0 && is_passed).then_some((stage, least))
    }

    /// Returns a warning if the last unloading ends in contact before the largest tensile force is
    /// reached. Returns `None` if the pull-off force has been passed, or if no tensile force acts.
    pub fn ends_in_contact(records: &[StageRecord]) -> Option<Warning> {
        let unloading = Branch::last_unloading(records)?;
        let (_, least) = unloading.smallest(records)?;
        match unloading.rest(records) {
            Rest::None => None,
            Rest::Unknown => Some(Warning::EndsInContact { further: None }),
            Rest::Smallest(of_rest) => {
                let pulls_further =
                    of_rest.force < (least.force - unloading.rounding(records)).min(0.0);
                pulls_further.then_some(Warning::EndsInContact {
                    further: Some(-of_rest.force),
                })
            }
        }
    }

    /// Returns what is known about the rest of an unloading, from its end to separation.
    fn rest(&self, records: &[StageRecord]) -> Rest {
        // The last stages may leave the body in place, so they are left out.
        let Some((_, last)) = self.touching(records).next_back() else {
            return Rest::None;
        };
        if last.end_in_contact().is_none() {
            return Rest::None;
        }
        last.smallest_of_rest.map_or(Rest::Unknown, Rest::Smallest)
    }

    /// Returns the difference in N within which two forces of the branch count as equal.
    fn rounding(&self, records: &[StageRecord]) -> f64 {
        records
            .get(self.stages.start)
            .map_or(0.0, |first| ROUNDING * first.largest.force.abs())
    }

    /// Finds the point of the smallest force while the body is in contact on this branch. Returns
    /// the index of its stage and the point; `None` if the body is never in contact on this branch.
    pub fn smallest(&self, records: &[StageRecord]) -> Option<(usize, CurvePoint)> {
        let stages = self.touching(records);
        let smallest = stages.map(|(stage, record)| (stage, record.smallest));
        // If several points have the same smallest force, the one at the smallest indentation
        // counts, as within one stage.
        smallest.min_by(|(_, point), (_, other)| {
            let by_force = point.force.total_cmp(&other.force);
            by_force.then(point.indentation.total_cmp(&other.indentation))
        })
    }
}

/// The rest of an unloading, from its end to separation.
enum Rest {
    /// There is no rest, because the unloading separates the bodies.
    None,
    /// The forces of the rest are not known.
    Unknown,
    /// Point of the smallest force of the rest.
    Smallest(CurvePoint),
}

/// Returns true if a stage leaves the body in place and neither closes nor opens the contact.
fn is_still(record: &StageRecord) -> bool {
    let start = record.start();
    let end = record.end();
    let motion = (start - end).abs();
    let starts_in_contact = record.curve.first().is_some_and(|point| point.springs > 0);
    let mut points = record.curve.iter();
    motion <= NO_MOTION * start.abs().max(end.abs())
        && points.all(|point| (point.springs > 0) == starts_in_contact)
}

/// Returns the stages of a range that move in a direction and have contact, with their indices.
fn stages_in_contact(
    records: &[StageRecord],
    stages: Range<usize>,
    direction: Direction,
) -> impl DoubleEndedIterator<Item = (usize, &StageRecord)> {
    let numbered = stages.clone().zip(&records[stages]);
    numbered.filter(move |(_, record)| {
        record.direction == direction && record.curve.iter().any(|point| point.springs > 0)
    })
}
