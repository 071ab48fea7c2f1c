//! The parts of a curve without contact, and the place at which the contact begins.

use crate::curve::numerics::{Baseline, correlated, ends, growing};
use crate::curve::points::Points;
use crate::error::{ExperimentError, refused};
use crate::read::options::CurveOptions;
use asperity_data::format_quantity;
use std::ops::Range;

/// Smallest number of points without contact, and of points in contact.
pub(crate) const FEWEST: usize = 10;
const FEWEST_IN_CONTACT: usize = 4;
/// Least gain by a contact over a straight line. The gain is the number of points times the
/// decrease of the logarithm of the sum of squared residuals. A smaller gain is attributed to
/// noise.
const GAIN: f64 = 40.0;
/// Deviation of the last points from the line before them, in standard errors, above which these
/// points are in contact.
const DEVIATES: f64 = 4.0;
/// Values of n: the last n-th of the points without contact is compared with the points before.
const PARTS: [usize; 3] = [5, 10, 20];
/// A segment is in contact from its first point if two shares are exceeded: the slope of its
/// beginning by the first share of the slope in contact, and the change of the force before contact
/// by the second share of the range of the force.
const STEEP: f64 = 0.5;
const NOTABLE: f64 = 0.05;

/// Reason why a segment has no part without contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum NoBaseline {
    /// The segment has too few points: this number.
    Few,
    /// The segment is a straight line, with this range and this noise of the force in N.
    Straight(f64, f64),
    /// The force changes from the first point on.
    InContact,
}

/// Returns the number of values before contact at the beginning of a segment. The noise is assumed
/// to be at least `least`.
///
/// The contact begins where a straight line before it and a parabola behind it describe the segment
/// best. This place lies in the steep part of the contact. Its weak beginning is found by going
/// back until the last points no longer deviate from the line through the points before.
pub(crate) fn free_count(values: &[f64], least: f64) -> Result<usize, NoBaseline> {
    let count = values.len();
    if count < 2 * FEWEST {
        return Err(NoBaseline::Few);
    }
    let before = growing(values.iter().copied(), 2);
    let mut behind = growing(values.iter().rev().copied(), 3);
    behind.reverse();
    // Sums of squares below those of the least noise say nothing.
    let floor = count as f64 * least * least;
    let sum = |end: &usize| before[*end - 1] + behind[*end] + floor;
    let places = FEWEST..=count - FEWEST_IN_CONTACT;
    let best = places
        .min_by(|one, other| sum(one).total_cmp(&sum(other)))
        .unwrap_or(FEWEST);
    let whole = before[count - 1] + floor;
    if count as f64 * (whole / sum(&best)).ln() < GAIN {
        let (low, high) = ends(values.iter().copied());
        return Err(NoBaseline::Straight(
            high - low,
            Baseline::through(values).noise,
        ));
    }
    let free = without_weak_contact(values, best, least);
    let slope = Baseline::through(&values[..free]).slope.abs();
    let range = |values: &[f64]| -> f64 {
        let (low, high) = ends(values.iter().copied());
        high - low
    };
    let is_steep = slope > STEEP * range(&values[free..]) / (count - free) as f64;
    // A short part that is curved is the beginning of a contact.
    let is_curved = || {
        let curved = growing(values[..free].iter().copied(), 3)[free - 1] + floor;
        10 * free < count && free as f64 * ((before[free - 1] + floor) / curved).ln() > GAIN
    };
    if free <= FEWEST || is_steep && slope * free as f64 > NOTABLE * range(values) || is_curved() {
        return Err(NoBaseline::InContact);
    }
    Ok(free)
}

/// Reduces the number `free` of values without contact until the last of these values do not
/// deviate from the line through the values before.
fn without_weak_contact(values: &[f64], mut free: usize, least: f64) -> usize {
    let deviates = |free: usize, last: usize| {
        let line = Baseline::through(&values[..free - last]);
        let rests: Vec<f64> = line.rests(&values[..free]).collect();
        let (before, behind) = rests.split_at(free - last);
        let count = before.len() as f64;
        let mean = behind.iter().sum::<f64>() / last as f64;
        // The error of the line grows beyond its end.
        let ahead = 0.5 * free as f64;
        let variance = 1.0 / last as f64 + 1.0 / count + ahead * ahead * 12.0 / count.powi(3);
        mean.abs() > DEVIATES * line.noise.max(least) * (correlated(before) * variance).sqrt()
    };
    while free > 2 * FEWEST {
        let parts = PARTS.map(|part| (free / part).max(3));
        let Some(last) = parts
            .into_iter()
            .chain([1])
            .find(|last| deviates(free, *last))
        else {
            break;
        };
        free -= last.div_ceil(3);
    }
    free
}

/// Points without contact: at the beginning of an approach and at the end of a retraction.
pub(crate) struct FreeParts {
    pub before: Option<usize>,
    /// Number of points after contact at the end; 0 if there are few.
    pub after: usize,
    /// Time and displacement of each point, as shares of the whole curve.
    pub shares: [Vec<f64>; 2],
}

impl FreeParts {
    pub fn of(
        points: &Points,
        options: &CurveOptions,
        averaged: usize,
        least: f64,
    ) -> Result<Self, ExperimentError> {
        let count = points.force.len();
        let approach = &points.force[points.moving(0)];
        let is_retraction = approach.is_empty();
        let asked = options.free_points.map(|free| free / averaged);
        let before = match asked.filter(|_| !is_retraction) {
            Some(free) => Ok(free),
            None => free_count(approach, least),
        };
        let ends_apart = points.segment[count - 1] % 2 == 1;
        let after = ends_apart.then(|| free_at_the_end(points, least)).flatten();
        let after = asked.filter(|_| is_retraction).or(after).unwrap_or(0);
        let needs_approach =
            !is_retraction && (options.segments.is_empty() || options.segments.contains(&1));
        let (number, of) = if needs_approach {
            (before, approach.len())
        } else {
            (before.or(Ok(after)), count)
        };
        let free = number.map_or_else(|why| refuse_baseline(why, points, approach, least), Ok)?;
        if !(FEWEST..of).contains(&free) {
            let place = if needs_approach { "before" } else { "without" };
            let fault = format!("no part {place} contact: {free} of {of} points");
            return refused(
                fault,
                format!("at least {FEWEST}, found or by --free-points"),
            );
        }
        let (low, high) = ends(points.displacement.iter().copied());
        let time = (0..count)
            .map(|index| index as f64 / (count - 1) as f64)
            .collect();
        let displacement = points
            .displacement
            .iter()
            .map(|at| (at - low) / (high - low))
            .collect();
        Ok(FreeParts {
            before: before.ok(),
            after,
            shares: [time, displacement],
        })
    }

    /// Returns the index range of the points without contact that give the zero and the noise.
    pub fn base(&self) -> Range<usize> {
        let count = self.shares[0].len();
        self.before
            .map_or(count - self.after..count, |before| 0..before)
    }

    /// Returns the displacement in m at which the contact seems to begin, behind the part before
    /// contact. For a retraction without an approach it lies where compression ends, or half way to
    /// its end.
    pub fn touch(&self, points: &Points) -> f64 {
        if let Some(before) = self.before {
            return points.displacement[before];
        }
        let in_contact = &points.force[points.of(1)];
        let end = in_contact.len().saturating_sub(self.after).max(1);
        let place = match in_contact[..end].iter().position(|force| *force <= 0.0) {
            Some(0) => end / 2,
            crossing => crossing.unwrap_or(end),
        };
        points.displacement[points.of(1).start + place.min(in_contact.len() - 1)]
    }
}

/// Returns the number of points after contact at the end; `None` if they cannot be found.
fn free_at_the_end(points: &Points, least: f64) -> Option<usize> {
    let last = points.moving(*points.segment.last()?);
    let reversed: Vec<f64> = points.force[last].iter().rev().copied().collect();
    free_count(&reversed, least).ok()
}

/// Returns true if the forces of a segment end without contact.
pub(crate) fn ends_free(force: &[f64], least: f64) -> bool {
    let change = |values: &[f64]| {
        let free = free_count(values, least).ok()?;
        Some(Baseline::through(&values[..free]).slope.abs() * free as f64)
    };
    let reversed: Vec<f64> = force.iter().rev().copied().collect();
    change(&reversed).is_some_and(|after| change(force).is_none_or(|before| after < before))
}

/// Returns the error of a curve without a part before contact, according to the reason.
fn refuse_baseline<T>(
    why: NoBaseline,
    points: &Points,
    approach: &[f64],
    least: f64,
) -> Result<T, ExperimentError> {
    let newton = |force: f64| format_quantity(force, "N");
    let first: Vec<f64> = approach.iter().rev().copied().collect();
    match why {
        NoBaseline::Few if approach.is_empty() => refused(
            "no part without contact after the retraction",
            "a retraction that ends without contact",
        ),
        NoBaseline::Few => refused(
            format!(
                "{} points in the approach are too few to find the contact",
                approach.len()
            ),
            format!("at least {}, or --free-points COUNT", 2 * FEWEST),
        ),
        NoBaseline::InContact
            if points.segment.contains(&1) && free_count(&first, least).is_ok() =>
        {
            refused(
                "the first segment begins in contact and ends without it: a retraction",
                "an approach first, in the order of time",
            )
        }
        NoBaseline::InContact => refused(
            "no part before contact: the force changes from the first point on",
            "an approach that begins farther away; --free-points COUNT; --segments 2 for the retraction alone",
        ),
        NoBaseline::Straight(range, noise) if range > 20.0 * noise => refused(
            format!(
                "no contact, or contact from the first point on: the force changes by {} along one straight line",
                newton(range)
            ),
            "a part before contact, then another slope; --free-points COUNT for a weak contact",
        ),
        NoBaseline::Straight(_, noise) => refused(
            format!(
                "no contact: in the approach the force stays within its noise of {}",
                newton(noise)
            ),
            "a change by more than the noise; --free-points COUNT for a weak contact",
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::curve::numerics::tests::noisy;

    /// The force of a sphere without adhesion, 1 at the end, which touches after this share of the
    /// points.
    fn hertz(count: usize, touch: f64) -> impl Iterator<Item = f64> {
        let share =
            move |index: usize| (index as f64 / count as f64 - touch).max(0.0) / (1.0 - touch);
        (0..count).map(move |index| share(index).powf(1.5))
    }

    /// Noise of up to 5 % of the largest force hides no contact; the later the contact is found,
    /// the less of it exceeds the noise.
    #[test]
    fn contacts_are_found_under_noise() {
        for (count, seed) in [(200, 1), (200, 2), (200, 3), (500, 4), (500, 5), (500, 6)] {
            for noise in [0.001, 0.02, 0.05] {
                for touch in [0.3, 0.6] {
                    let values = noisy(hertz(count, touch), noise, seed);
                    let free = free_count(&values, 0.0).unwrap() as f64 / count as f64;
                    let late = touch + (1.0 - touch) * (1.5 * noise).powf(2.0 / 3.0) + 0.02;
                    assert!(
                        (touch - 0.15..late).contains(&free),
                        "{count} {noise} {touch}: {free}"
                    );
                }
                let snap = (0..count).map(|index| {
                    if 2 * index < count {
                        0.0
                    } else {
                        index as f64 / count as f64 - 0.95
                    }
                });
                let free = free_count(&noisy(snap, noise, seed), 0.0).unwrap();
                assert!(
                    free.abs_diff(count / 2) <= count / 20,
                    "{count} {noise}: {free}"
                );
            }
            let flat = noisy((0..count).map(|index| 0.01 * index as f64), 1.0, seed);
            assert!(
                matches!(free_count(&flat, 0.0), Err(NoBaseline::Straight(..))),
                "{count}"
            );
        }
    }

    /// In a force without noise, as of a computed curve, the contact begins exactly where the force
    /// does.
    #[test]
    fn a_contact_without_noise_begins_where_the_force_does() {
        let parabola: Vec<f64> = (0..100)
            .map(|index| (f64::from(index) - 59.0).max(0.0).powi(2))
            .collect();
        let free = free_count(&parabola, 0.0).unwrap();
        assert!((59..=62).contains(&free), "{free}");
    }

    /// A weak contact, a few times the noise, long before the strong one does not count as part
    /// without contact.
    #[test]
    fn weak_contact_is_not_part_of_the_noise() {
        for seed in 1..=6 {
            let force = |index: usize| {
                let weak = 0.02 * (index as f64 - 250.0).max(0.0) / 100.0;
                weak + (index as f64 - 400.0).max(0.0).powf(1.5) / 1000.0
            };
            let values = noisy((0..500).map(force), 0.002, seed);
            let free = free_count(&values, 0.0).unwrap();
            let noise = Baseline::through(&values[..free]).noise / 0.002;
            assert!((0.85..1.2).contains(&noise), "{seed}: {free} {noise}");
        }
    }
}
