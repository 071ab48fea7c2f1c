//! Branches, preload and pull-off of a loading history. They depend only on the path of the body,
//! not on the division of this path into loading stages.

use super::history::{CurvePoint, Direction, LegRecord};
use asperity_data::Warning;
use std::ops::Range;

/// Relative difference within which two forces or two indentations count as equal. Equal forces may
/// be different sums.
pub(super) const ROUNDING: f64 = 1e-9;
/// Relative motion that counts as rounding, for a force or displacement that is reached again.
const NO_MOTION: f64 = 4.0 * f64::EPSILON;

/// Consecutive loading stages that move the body in the same direction, taken together as one
/// motion.
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
    /// Divides the stages of a history into branches, and returns the branches in their order.
    pub fn all(legs: &[LegRecord]) -> Vec<Branch> {
        let mut branches: Vec<Branch> = Vec::new();
        for (stage, leg) in legs.iter().enumerate() {
            match branches.last_mut() {
                Some(last) if last.direction == leg.direction || is_still(leg) => {
                    last.stages.end += 1
                }
                // The first stages may leave the body in place.
                Some(last) if legs[last.stages.clone()].iter().all(is_still) => {
                    *last = Branch {
                        direction: leg.direction,
                        stages: last.stages.start..stage + 1,
                    };
                }
                _ => branches.push(Branch {
                    direction: leg.direction,
                    stages: stage..stage + 1,
                }),
            }
        }
        branches
    }

    /// Returns the last branch that unloads a body in contact; `None` if no branch does.
    pub fn last_unloading(legs: &[LegRecord]) -> Option<Branch> {
        let mut branches = Branch::all(legs).into_iter();
        branches.rfind(|branch| {
            branch.direction == Direction::Unloading && branch.touching(legs).next().is_some()
        })
    }

    /// Returns the stages of the branch that move in its direction and have contact, with their
    /// indices. A stage of a separated body has no extremes of the contact.
    fn touching<'l>(
        &self,
        legs: &'l [LegRecord],
    ) -> impl DoubleEndedIterator<Item = (usize, &'l LegRecord)> {
        stages_in_contact(legs, self.stages.clone(), self.direction)
    }

    /// Finds the preload, the point of the largest force on loading before the last unloading, and
    /// the index of its stage. An earlier contact that ended in separation does not count.
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
    pub fn preload(legs: &[LegRecord]) -> Option<(usize, CurvePoint)> {
        let end = match Branch::last_unloading(legs) {
            Some(unloading) => unloading.stages.start,
            None => legs.len(),
        };
        let last_separation = legs[..end].iter().rposition(|leg| {
            leg.direction == Direction::Unloading && leg.end_in_contact().is_none()
        });
        let start = last_separation.map_or(0, |stage| stage + 1);
        let loadings = stages_in_contact(legs, start..end, Direction::Loading);
        let largest = loadings.map(|(stage, leg)| (stage, leg.largest));
        // Of equal forces the last one, as on one stage.
        largest.max_by(|(_, point), (_, other)| point.force.total_cmp(&other.force))
    }

    /// Finds the pull-off, the point of the smallest force of the last unloading, and the index of
    /// its stage. Returns `None` if this force is above zero, or if the unloading ends in contact
    /// while the force still falls, or with a smaller force on its rest up to separation.
    pub fn pull_off(legs: &[LegRecord]) -> Option<(usize, CurvePoint)> {
        let unloading = Branch::last_unloading(legs)?;
        let (stage, least) = unloading.smallest(legs)?;
        let rounding = unloading.rounding(legs);
        let is_passed = match unloading.rest(legs) {
            Rest::None => true,
            Rest::Unknown => false,
            Rest::Smallest(of_rest) => {
                let end = legs.get(unloading.stages.end - 1)?.curve.last()?;
                least.force < end.force - rounding && least.force <= of_rest.force + rounding
            }
        };
        (least.force <= 0.0 && is_passed).then_some((stage, least))
    }

    /// Returns the warning that the last unloading ends in contact although its rest would pull
    /// with a larger force than the unloading so far. Returns `None` if the bodies are pulled off,
    /// or if nothing pulls.
    pub fn ends_in_contact(legs: &[LegRecord]) -> Option<Warning> {
        let unloading = Branch::last_unloading(legs)?;
        let (_, least) = unloading.smallest(legs)?;
        match unloading.rest(legs) {
            Rest::None => None,
            Rest::Unknown => Some(Warning::EndsInContact { further: None }),
            Rest::Smallest(of_rest) => {
                let pulls_further =
                    of_rest.force < (least.force - unloading.rounding(legs)).min(0.0);
                pulls_further.then_some(Warning::EndsInContact {
                    further: Some(-of_rest.force),
                })
            }
        }
    }

    /// Returns what is known of the way from the end of an unloading to separation.
    fn rest(&self, legs: &[LegRecord]) -> Rest {
        // The last stages may leave the body in place.
        let Some((_, last)) = self.touching(legs).next_back() else {
            return Rest::None;
        };
        if last.end_in_contact().is_none() {
            return Rest::None;
        }
        last.smallest_of_rest.map_or(Rest::Unknown, Rest::Smallest)
    }

    /// Returns the difference in N within which two forces of the branch count as equal.
    fn rounding(&self, legs: &[LegRecord]) -> f64 {
        legs.get(self.stages.start)
            .map_or(0.0, |first| ROUNDING * first.largest.force.abs())
    }

    /// Returns the point of the smallest force while the branch is in contact, and the index of its
    /// stage. Returns `None` if the branch has no contact.
    pub fn smallest(&self, legs: &[LegRecord]) -> Option<(usize, CurvePoint)> {
        let stages = self.touching(legs);
        let smallest = stages.map(|(stage, leg)| (stage, leg.smallest));
        // Of equal forces the one at the smallest indentation, as on one stage.
        smallest.min_by(|(_, point), (_, other)| {
            let by_force = point.force.total_cmp(&other.force);
            by_force.then(point.indentation.total_cmp(&other.indentation))
        })
    }
}

/// Way from the end of an unloading to separation.
enum Rest {
    /// There is none: the unloading separates the bodies.
    None,
    /// The way is not known.
    Unknown,
    /// Point of the smallest force of the way.
    Smallest(CurvePoint),
}

/// Returns true if a stage leaves the body in place, in contact or separated throughout.
fn is_still(leg: &LegRecord) -> bool {
    let start = leg.start();
    let end = leg.end();
    let motion = (start - end).abs();
    let starts_in_contact = leg.curve.first().is_some_and(|point| point.springs > 0);
    let mut points = leg.curve.iter();
    motion <= NO_MOTION * start.abs().max(end.abs())
        && points.all(|point| (point.springs > 0) == starts_in_contact)
}

/// Returns the stages of a range that move in a direction and have contact, with their indices.
fn stages_in_contact(
    legs: &[LegRecord],
    stages: Range<usize>,
    direction: Direction,
) -> impl DoubleEndedIterator<Item = (usize, &LegRecord)> {
    let numbered = stages.clone().zip(&legs[stages]);
    numbered.filter(move |(_, leg)| {
        leg.direction == direction && leg.curve.iter().any(|point| point.springs > 0)
    })
}
