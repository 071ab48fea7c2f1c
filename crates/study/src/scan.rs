//! Search for crossings of a quantity that may rise and fall over a range of numbers.
//!
//! First the quantity is computed at evenly spaced numbers. An interval between two of these
//! numbers is then halved if the quantity may reach the target within it. This is assumed if the
//! quantity deviates from a straight line by as much as its distance from the target, or if the
//! quantity turns close to the target.

use super::coordinates::Coordinates;
use asperity_scene::RunError;
use std::cmp::Ordering;

/// Number of intervals into which a scan first divides the range of searched numbers.
pub(super) const INTERVALS: usize = 32;
/// Largest number of searched numbers at which a scan computes the quantity that should reach a
/// target.
pub(super) const MOST_TRIED: usize = 192;
/// Smallest width of an interval that is still halved, as a share of the range in coordinates.
const NARROWEST: f64 = 1.0 / 4096.0;
/// An interval is halved if the distance of the quantity from the target is at most this factor
/// times its deviation from a straight line.
const SAFETY: f64 = 4.0;

/// If the quantity turns in an interval, its deviation from a straight line is assumed to be at
/// least this share of the difference between its largest and smallest value.
const CLOSE: f64 = 1.0 / 400.0;

/// A number, and the value of the quantity at this number; NaN if the quantity has no value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Tried {
    pub number: f64,
    pub value: f64,
}

impl Tried {
    /// Returns true if the quantity has a value at this number.
    fn is_known(&self) -> bool {
        !self.value.is_nan()
    }
}

/// Function that computes the searched quantity at several ascending numbers, such as preloads.
pub(super) type Compute<'c> = dyn FnMut(&[f64]) -> Result<Vec<f64>, RunError> + 'c;

/// Ascending numbers of a searched range, such as preloads, with the value of the searched quantity
/// at each of them.
#[derive(Clone, Debug)]
pub(super) struct Scan {
    coordinates: Coordinates,
    target: f64,
    pub tried: Vec<Tried>,
    /// True if the quantity was computed at all allowed numbers.
    is_complete: bool,
}

/// Interval between neighbouring numbers of a scan that may hide a crossing.
#[derive(Clone, Copy, Debug)]
struct Suspect {
    /// Number in the middle of the interval, at which the quantity is computed next.
    middle: f64,
    /// True if the interval lies above the first known crossing.
    is_beyond: bool,
    /// Possible deviation of the quantity from a straight line divided by its distance from the
    /// target.
    urgency: f64,
}

impl Scan {
    /// Scans the whole range of `coordinates` for numbers at which a quantity crosses `target`.
    /// `compute` returns the quantity at several numbers.
    ///
    /// # Errors
    /// Returns the first error of `compute`.
    pub fn of(
        coordinates: Coordinates,
        target: f64,
        compute: &mut Compute<'_>,
    ) -> Result<Scan, RunError> {
        let (numbers, is_complete) = coordinates.spread(INTERVALS, MOST_TRIED);
        let mut scan = Scan {
            coordinates,
            target,
            tried: Vec::new(),
            is_complete,
        };
        scan.add(&numbers, compute)?;
        scan.complete(compute)?;
        while !scan.is_complete {
            let numbers = scan.next_numbers();
            if numbers.is_empty() {
                break;
            }
            scan.add(&numbers, compute)?;
        }
        Ok(scan)
    }

    /// If the range has few allowed numbers, computes the quantity at all of them. Numbers near an
    /// end of the range are left out if the quantity has no value at a number farther inside.
    fn complete(&mut self, compute: &mut Compute<'_>) -> Result<(), RunError> {
        let mut tried = self.tried.iter();
        let first = tried.position(Tried::is_known).unwrap_or(0);
        let mut tried = self.tried.iter();
        let last = tried.rposition(Tried::is_known).unwrap_or(0);
        let ends = [
            first.saturating_sub(1),
            (last + 1).min(self.tried.len() - 1),
        ];
        let between = self
            .coordinates
            .all_between(ends.map(|point| self.tried[point].number), MOST_TRIED);
        let Some(mut numbers) = between.filter(|_| !self.is_complete) else {
            return Ok(());
        };
        numbers.retain(|number| self.tried.iter().all(|tried| tried.number != *number));
        self.is_complete = true;
        self.add(&numbers, compute)
    }

    fn add(&mut self, numbers: &[f64], compute: &mut Compute<'_>) -> Result<(), RunError> {
        let values = compute(numbers)?;
        let tried = numbers
            .iter()
            .zip(values)
            .map(|(&number, value)| Tried { number, value });
        self.tried.extend(tried);
        self.tried
            .sort_by(|first, second| first.number.total_cmp(&second.number));
        Ok(())
    }

    /// Returns the numbers that are computed next, in ascending order.
    fn next_numbers(&self) -> Vec<f64> {
        let left = MOST_TRIED.saturating_sub(self.tried.len()).min(INTERVALS);
        let mut suspects = self.suspects();
        // Intervals below the first known crossing come first, because the first crossing is the
        // answer.
        suspects.sort_by(|first, second| {
            let by_urgency = second.urgency.total_cmp(&first.urgency);
            first.is_beyond.cmp(&second.is_beyond).then(by_urgency)
        });
        let mut numbers: Vec<f64> = suspects
            .iter()
            .take(left)
            .map(|suspect| suspect.middle)
            .collect();
        numbers.sort_by(f64::total_cmp);
        numbers
    }

    /// Returns the intervals that may hide a crossing and are wide enough to be halved.
    fn suspects(&self) -> Vec<Suspect> {
        let mut suspects = Vec::new();
        let mut is_beyond = false;
        for index in 0..self.tried.len().saturating_sub(1) {
            let urgency = self.urgency(index);
            let ends = [self.tried[index].number, self.tried[index + 1].number];
            if urgency > 1.0 && self.width(index) > NARROWEST * self.coordinates.length() {
                let middle = self.coordinates.middle(ends);
                suspects.extend(middle.map(|middle| Suspect {
                    middle,
                    is_beyond,
                    urgency,
                }));
            }
            is_beyond |= self.is_crossed(index);
        }
        suspects
    }

    /// Returns true if a number at which the quantity crosses the target may have been missed,
    /// because the quantity comes close to the target between two computed numbers.
    pub fn may_miss(&self) -> bool {
        let mut intervals = 0..self.tried.len().saturating_sub(1);
        !self.is_complete && intervals.any(|index| self.may_hide(index))
    }

    /// Returns true if the interval with this index may hide a crossing and contains an allowed
    /// number that was not tried.
    fn may_hide(&self, index: usize) -> bool {
        let ends = [self.tried[index].number, self.tried[index + 1].number];
        self.urgency(index) > 1.0 && self.coordinates.middle(ends).is_some()
    }

    /// Returns true if the quantity was computed at all allowed numbers, so that no crossing of the
    /// target is missed.
    pub fn is_complete(&self) -> bool {
        self.is_complete
    }

    /// Returns true if the quantity is on different sides of the target at the number with this
    /// index and at the next number.
    fn is_crossed(&self, index: usize) -> bool {
        let sides = [
            side(self.tried[index], self.target),
            side(self.tried[index + 1], self.target),
        ];
        matches!(sides, [Some(one), Some(other)] if one != other)
    }

    /// Returns the width of the interval with this index in coordinates.
    fn width(&self, index: usize) -> f64 {
        let places =
            [index, index + 1].map(|point| self.coordinates.coordinate(self.tried[point].number));
        places[1] - places[0]
    }

    /// Returns how urgent it is to halve the interval with this index. Above 1 the interval may
    /// hide a crossing.
    fn urgency(&self, index: usize) -> f64 {
        let from = self.tried[index].value;
        let to = self.tried[index + 1].value;
        if from.is_nan() && to.is_nan() {
            return 0.0;
        }
        let is_edge = from.is_nan() || to.is_nan();
        if is_edge && self.width(index) > NARROWEST * self.coordinates.length() {
            return f64::INFINITY;
        }
        let distances = [(from - self.target).abs(), (to - self.target).abs()];
        // An interval whose ends are on one side of the target hides a crossing if the quantity
        // goes beyond the values at both ends and reaches the target. An interval with a crossing
        // hides two more if the quantity turns inside the interval.
        let distance = if self.is_crossed(index) {
            0.5 * (to - from).abs()
        } else {
            distances[0].min(distances[1])
        };
        let mut deviation = self.deviation(index);
        if self.turns(index) {
            deviation = deviation.max(CLOSE * self.spread());
        }
        let deviation = SAFETY * deviation;
        if deviation > 0.0 {
            deviation / distance
        } else {
            0.0
        }
    }

    /// Returns true if the quantity turns close to the target at an end of the interval: it is
    /// closer to the target there than at the two neighbouring numbers, and all three values are on
    /// the same side of the target.
    fn turns(&self, index: usize) -> bool {
        let end = if self.distance(index) <= self.distance(index + 1) {
            index
        } else {
            index + 1
        };
        let beside = [
            end.checked_sub(1),
            Some(end + 1).filter(|point| *point < self.tried.len()),
        ];
        beside.into_iter().flatten().all(|point| {
            let same_side =
                side(self.tried[point], self.target) == side(self.tried[end], self.target);
            same_side && self.distance(point) >= self.distance(end)
        })
    }

    /// Returns the distance between the quantity and the target at the number with the index
    /// `point`.
    fn distance(&self, point: usize) -> f64 {
        (self.tried[point].value - self.target).abs()
    }

    /// Returns the difference between the largest and the smallest computed value of the quantity.
    fn spread(&self) -> f64 {
        let mut most = f64::NEG_INFINITY;
        let mut least = f64::INFINITY;
        for tried in self.tried.iter().filter(|tried| tried.is_known()) {
            most = most.max(tried.value);
            least = least.min(tried.value);
        }
        most - least
    }

    /// Returns how far the quantity may deviate from a straight line in the interval with this
    /// index: the median of the deviations at the eight nearest numbers. A single jump of the
    /// quantity does not affect the median, because it causes deviations at only two numbers.
    fn deviation(&self, index: usize) -> f64 {
        let width = self.width(index);
        let first = index.saturating_sub(3);
        let mut deviations: Vec<f64> = (first..=index + 4)
            .filter_map(|point| self.deviation_at(point, width))
            .collect();
        deviations.sort_by(f64::total_cmp);
        deviations.get(deviations.len() / 2).copied().unwrap_or(0.0)
    }

    /// Returns the deviation of the quantity at the number with the index `point` from the straight
    /// line between the two neighbouring values. The deviation grows with the square of the
    /// distance between the numbers. If `width` is larger than this distance, the deviation is
    /// scaled to `width`.
    fn deviation_at(&self, point: usize, width: f64) -> Option<f64> {
        let before = self.tried.get(point.checked_sub(1)?)?;
        let here = self.tried.get(point)?;
        let after = self.tried.get(point + 1)?;
        let widths = [self.width(point - 1), self.width(point)];
        let share = widths[0] / (widths[0] + widths[1]);
        let straight = before.value + share * (after.value - before.value);
        let growth = (width * width / (4.0 * widths[0] * widths[1])).max(1.0);
        Some((here.value - straight).abs() * growth).filter(|deviation| deviation.is_finite())
    }
}

/// Returns the side of the target on which the quantity is; `None` if the quantity has no value.
pub(super) fn side(tried: Tried, target: f64) -> Option<Ordering> {
    tried.value.partial_cmp(&target)
}
