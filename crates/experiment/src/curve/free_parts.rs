//! The parts of a curve without contact, and the place at which the contact begins.

use crate::curve::numerics::{Baseline, Extent, correlated, growing, noise_of_neighbours};
use crate::curve::points::Points;
use crate::error::{ExperimentError, refused};
use crate::read::options::CurveOptions;
use asperity_data::mean;
use std::ops::Range;

/// Smallest number of points without contact.
pub(crate) const FEWEST: usize = 10;
/// Smallest number of points in contact.
const FEWEST_IN_CONTACT: usize = 4;
/// Least gain by a contact over a straight line. The gain is the number of points times the
/// decrease of the logarithm of the sum of squared residuals. A smaller gain is attributed to
/// noise.
const GAIN: f64 = 40.0;
/// Deviation of the last points from the line before them, in standard errors, above which these
/// points are in contact.
const DEVIATES: f64 = 4.0;
/// Noise of a part without contact, divided by the noise between neighbouring points, above which a
/// contact may have been counted as part without contact.
const UNLIKE_NEIGHBOURS: f64 = 3.0;
/// Share of this noise that must remain without the points of such a contact.
const QUIETER: f64 = 0.3;
/// Values of n: the last n-th of the points without contact is compared with the points before.
const PARTS: [usize; 3] = [5, 10, 20];
/// A segment is in contact from its first point if the slope of its beginning exceeds this share of
/// the slope in contact, and the change of the force before contact is notable.
const STEEP: f64 = 0.5;
/// Share of the range of the force above which a change of the force is notable.
const NOTABLE: f64 = 0.05;

/// Share of the largest tension above which the end of a retraction may still be in contact.
const HELD: f64 = 0.5;
/// Tension at the end of a retraction, in units of the noise, below which it is noise.
const BEYOND_NOISE: f64 = 5.0;
/// Way of a part without contact whose force is such a tension, divided by the way over which the
/// tension came about. A body that is held passes the largest tension on a shorter way.
const LONG: f64 = 1.0;

/// Least gain by a parabola over a straight line at the end of a retraction.
const GAIN_BY_PARABOLA: f64 = 20.0;
/// Noise of the points at the end about a parabola, divided by the noise between neighbours, up to
/// which they are a parabola.
const LIKE_NEIGHBOURS: f64 = 1.5;

/// Reason why a segment has no part without contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum NoFreePart {
    /// The segment has too few points.
    Few,
    /// The segment is a straight line, with this range and this noise of the force in N.
    Straight { range: f64, noise: f64 },
    /// The force changes from the first point on.
    InContact,
}

/// Returns the number of forces before contact at the beginning of a segment. The noise is assumed
/// to be at least `least_noise`.
///
/// The contact begins where a straight line before it and a parabola after it describe the segment
/// best. This place lies in the steep part of the contact. Its weak beginning is found by going
/// back until the last points no longer deviate from the line through the points before.
///
/// Where the force has several steep parts, as in a loading by steps, this place may lie in a later
/// one. The noise before it is then far above the differences of neighbouring points, and the
/// contact is sought again in the points before.
pub(crate) fn free_count(forces: &[f64], least_noise: f64) -> Result<usize, NoFreePart> {
    let mut free = count_before_change(forces, least_noise)?;
    loop {
        let part = &forces[..free];
        let noise = Baseline::through(part).noise;
        if noise <= UNLIKE_NEIGHBOURS * noise_of_neighbours(part).max(least_noise) {
            return Ok(free);
        }
        let Ok(earlier) = count_before_change(part, least_noise) else {
            return Ok(free);
        };
        if Baseline::through(&part[..earlier]).noise > QUIETER * noise {
            return Ok(free);
        }
        free = earlier;
    }
}

/// Returns the number of forces before the change that a line and a parabola describe best.
fn count_before_change(forces: &[f64], least_noise: f64) -> Result<usize, NoFreePart> {
    let count = forces.len();
    if count < 2 * FEWEST {
        return Err(NoFreePart::Few);
    }
    // Sums of squares below those of the least noise mean nothing.
    let floor = count as f64 * least_noise * least_noise;
    let before = growing(forces.iter().copied(), 2);
    let change = steepest_change(forces, &before, floor);
    let whole = before[count - 1] + floor;
    if count as f64 * (whole / change.squares).ln() < GAIN {
        return Err(NoFreePart::Straight {
            range: range_of(forces),
            noise: Baseline::through(forces).noise,
        });
    }

    let free = without_weak_contact(forces, change.place, least_noise);
    if free <= FEWEST
        || begins_steep(forces, free)
        || begins_curved(forces, free, before[free - 1], floor)
    {
        return Err(NoFreePart::InContact);
    }
    Ok(free)
}

/// Place at which a straight line ends and a parabola begins.
struct Change {
    place: usize,
    /// Sum of the squared residuals of both.
    squares: f64,
}

/// Returns the place at which a line before and a parabola after describe the forces best. `before`
/// has the sums of squares of lines up to each place, and `floor` is added to all sums.
fn steepest_change(forces: &[f64], before: &[f64], floor: f64) -> Change {
    let mut after = growing(forces.iter().rev().copied(), 3);
    after.reverse();
    let mut best = Change {
        place: FEWEST,
        squares: f64::INFINITY,
    };
    for place in FEWEST..=forces.len() - FEWEST_IN_CONTACT {
        let squares = before[place - 1] + after[place] + floor;
        if squares < best.squares {
            best = Change { place, squares };
        }
    }
    best
}

/// Returns the number of forces before the steep part of a contact, of which the last may belong to
/// its weak beginning.
pub(crate) fn count_before_steep_part(forces: &[f64]) -> usize {
    let before = growing(forces.iter().copied(), 2);
    steepest_change(forces, &before, 0.0).place
}

fn range_of(forces: &[f64]) -> f64 {
    Extent::of(forces.iter().copied()).width()
}

/// Returns true if the force changes before contact nearly as fast as in contact.
fn begins_steep(forces: &[f64], free: usize) -> bool {
    let slope = Baseline::through(&forces[..free]).slope.abs();
    let slope_in_contact = range_of(&forces[free..]) / (forces.len() - free) as f64;
    slope > STEEP * slope_in_contact && slope * free as f64 > NOTABLE * range_of(forces)
}

/// Returns true if the part before contact is short and curved, as the beginning of a contact is.
/// `squares` is the sum of squared residuals of its straight line.
fn begins_curved(forces: &[f64], free: usize, squares: f64, floor: f64) -> bool {
    if 10 * free >= forces.len() {
        return false;
    }
    let squares_of_parabola = growing(forces[..free].iter().copied(), 3)[free - 1];
    free as f64 * ((squares + floor) / (squares_of_parabola + floor)).ln() > GAIN
}

/// Reduces the number `free` of forces without contact until the last of these forces do not
/// deviate from the line through the forces before.
fn without_weak_contact(forces: &[f64], mut free: usize, least_noise: f64) -> usize {
    while free > 2 * FEWEST {
        let parts = PARTS.map(|part| (free / part).max(3));
        let deviating = parts
            .into_iter()
            .chain([1])
            .find(|last| end_deviates(&forces[..free], *last, least_noise));
        let Some(last) = deviating else {
            break;
        };
        free -= last.div_ceil(3);
    }
    free
}

/// Returns true if the mean of the last forces deviates from the line through the forces before.
fn end_deviates(forces: &[f64], last: usize, least_noise: f64) -> bool {
    let free = forces.len();
    let line = Baseline::through(&forces[..free - last]);
    let residuals = line.residuals(forces);
    let (before, end) = residuals.split_at(free - last);
    let count = before.len() as f64;
    let mean = end.iter().sum::<f64>() / last as f64;
    // The error of the line grows beyond its end.
    let ahead = 0.5 * free as f64;
    let variance = 1.0 / last as f64 + 1.0 / count + ahead * ahead * 12.0 / count.powi(3);
    let error = line.noise.max(least_noise) * (correlated(before) * variance).sqrt();
    mean.abs() > DEVIATES * error
}

/// Points without contact: at the beginning of an approach and at the end of a retraction.
pub(crate) struct FreeParts {
    /// Number of points before contact; `None` for a retraction without an approach, or if contact
    /// is not found in the approach and only other segments are used.
    pub before: Option<usize>,
    /// Number of points after contact at the end; 0 if there are few.
    pub after: usize,
    /// True if the last points of the last retraction look straight, but are a tension that still
    /// holds the body.
    pub ends_in_contact: bool,
    /// Time and displacement of each point, as shares of the whole curve.
    pub shares: [Vec<f64>; 2],
}

impl FreeParts {
    /// Finds the points without contact. `averaged` is the number of points of the file that a
    /// point averages.
    pub fn of(
        points: &Points,
        options: &CurveOptions,
        averaged: usize,
        least_noise: f64,
    ) -> Result<Self, ExperimentError> {
        let count = points.force.len();
        let approach = &points.force[points.moving(0)];
        let is_retraction = approach.is_empty();
        let asked = options.free_points.map(|free| free / averaged);
        let before = match asked {
            Some(free) if !is_retraction => Ok(free),
            _ => free_count(approach, least_noise),
        };
        let after = match asked {
            Some(free) if is_retraction => free,
            _ => count_after_contact(points, least_noise),
        };
        let ends_in_contact = match before {
            Ok(before) => asked.is_none() && is_still_held(points, before, after, least_noise),
            Err(_) => false,
        };
        let after = if ends_in_contact { 0 } else { after };

        let needs_approach =
            !is_retraction && (options.segments.is_empty() || options.segments.contains(&1));
        let deciding = if needs_approach {
            before
        } else {
            before.or(Ok(after))
        };
        let most = if needs_approach {
            approach.len()
        } else {
            count
        };
        let free = match deciding {
            Ok(free) => free,
            Err(reason) => return refuse(reason, points, approach, least_noise),
        };
        if !(FEWEST..most).contains(&free) {
            let part = if needs_approach { "before" } else { "without" };
            return Err(ExperimentError::NoFreePart {
                part,
                found: free,
                points: most,
                least: FEWEST,
            });
        }
        Ok(FreeParts {
            before: before.ok(),
            after,
            ends_in_contact,
            shares: [shares_of_time(count), shares_of_range(&points.displacement)],
        })
    }

    /// Returns the index range of the points without contact that give the zero and the noise.
    pub fn base(&self) -> Range<usize> {
        let count = self.shares[0].len();
        match self.before {
            Some(before) => 0..before,
            None => count - self.after..count,
        }
    }

    /// Returns the displacement in m at which the contact seems to begin, after the part before
    /// contact. For a retraction without an approach it lies where compression ends, or half way to
    /// its end.
    pub fn contact_point(&self, points: &Points) -> f64 {
        if let Some(before) = self.before {
            return points.displacement[before];
        }
        let retraction = points.range_of(1);
        let forces = &points.force[retraction.clone()];
        let end = forces.len().saturating_sub(self.after).max(1);
        let place = match forces[..end].iter().position(|force| *force <= 0.0) {
            Some(0) => end / 2,
            Some(crossing) => crossing,
            None => end,
        };
        points.displacement[retraction.start + place.min(forces.len() - 1)]
    }
}

fn shares_of_time(count: usize) -> Vec<f64> {
    (0..count)
        .map(|index| index as f64 / (count - 1) as f64)
        .collect()
}

fn shares_of_range(displacements: &[f64]) -> Vec<f64> {
    let range = Extent::of(displacements.iter().copied());
    displacements
        .iter()
        .map(|displacement| (displacement - range.low) / range.width())
        .collect()
}

/// Returns the number of points after contact at the end of a curve that ends with a retraction; 0
/// if they cannot be found.
fn count_after_contact(points: &Points, least_noise: f64) -> usize {
    let last = points.last_segment();
    if last.is_multiple_of(2) {
        return 0;
    }
    let forces = &points.force[points.moving(last)];
    free_count_at_end(forces, least_noise).unwrap_or(0)
}

/// Returns the number of forces after contact at the end of a segment. A parabola there is a tension
/// about its largest value.
fn free_count_at_end(forces: &[f64], least_noise: f64) -> Result<usize, NoFreePart> {
    let reversed: Vec<f64> = forces.iter().rev().copied().collect();
    let free = free_count(&reversed, least_noise)?;
    let part = &reversed[..free];
    let noise = LIKE_NEIGHBOURS * noise_of_neighbours(part).max(least_noise);
    let squares = |terms: usize| growing(part.iter().copied(), terms)[free - 1];
    let least_squares = free as f64 * least_noise * least_noise;
    let squares_of_parabola = squares(3) + least_squares;
    let gain = free as f64 * ((squares(2) + least_squares) / squares_of_parabola).ln();
    let is_parabola = squares_of_parabola <= free as f64 * noise * noise;
    if gain > GAIN_BY_PARABOLA && is_parabola {
        return Err(NoFreePart::InContact);
    }
    Ok(free)
}

/// Returns true if the last `after` points, which are nearly on a straight line, are no part without
/// contact. Where a tension is largest, its curve is flat too, and a soft instrument or points at a
/// falling speed make it straight. `before` points at the beginning have the zero of the force.
///
/// A drag of a fluid is a tension as well, but it lasts over a longer way than the contact.
fn is_still_held(points: &Points, before: usize, after: usize, least_noise: f64) -> bool {
    if before < FEWEST || after == 0 {
        return false;
    }
    let free = &points.force[..before];
    let zero = mean(free);
    let noise = Baseline::through(free).noise.max(least_noise);
    let retraction = points.moving(points.last_segment());
    let tensions: Vec<f64> = points.force[retraction.clone()]
        .iter()
        .map(|force| zero - force)
        .collect();
    let displacements = &points.displacement[retraction];
    let first = tensions.len() - after.min(tensions.len());
    let end = mean(&tensions[first..]);
    let largest = Extent::of(tensions.iter().copied()).high;
    if end <= BEYOND_NOISE * noise || end <= HELD * largest {
        return false;
    }
    let crossing = tensions.iter().position(|tension| *tension >= 0.0);
    let way_of_tension = displacements[crossing.unwrap_or(first).min(first)] - displacements[first];
    let way_without_contact = Extent::of(displacements[first..].iter().copied()).width();
    way_without_contact < LONG * way_of_tension
}

/// Returns true if the forces of a segment end without contact.
pub(crate) fn ends_free(forces: &[f64], least_noise: f64) -> bool {
    let Ok(at_end) = free_count_at_end(forces, least_noise) else {
        return false;
    };
    let Ok(at_begin) = free_count(forces, least_noise) else {
        return true;
    };
    change_along(&forces[forces.len() - at_end..]) < change_along(&forces[..at_begin])
}

/// Returns the change of the force in N over a part without contact, along its straight line.
fn change_along(forces: &[f64]) -> f64 {
    Baseline::through(forces).slope.abs() * forces.len() as f64
}

/// Returns the error of a curve without a part before contact, according to the reason.
fn refuse<T>(
    reason: NoFreePart,
    points: &Points,
    approach: &[f64],
    least_noise: f64,
) -> Result<T, ExperimentError> {
    match reason {
        NoFreePart::Few if approach.is_empty() => refused(
            "no part without contact after the retraction",
            "a retraction that ends without contact",
        ),
        NoFreePart::Few => Err(ExperimentError::ShortApproach {
            found: approach.len(),
            least: 2 * FEWEST,
        }),
        NoFreePart::InContact if is_retraction_first(points, approach, least_noise) => refused(
            "the first segment begins in contact and ends without it: a retraction",
            "an approach first, in the order of time",
        ),
        NoFreePart::InContact => Err(ExperimentError::BeginsInContact),
        NoFreePart::Straight { range, noise } => Err(ExperimentError::NoContact { range, noise }),
    }
}

/// Returns true if the segment that should be an approach ends without contact.
fn is_retraction_first(points: &Points, approach: &[f64], least_noise: f64) -> bool {
    points.segment.contains(&1) && free_count_at_end(approach, least_noise).is_ok()
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
                matches!(free_count(&flat, 0.0), Err(NoFreePart::Straight { .. })),
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

    /// In a loading by steps the first contact is the first step, though a later one is steeper.
    #[test]
    fn the_first_step_of_a_loading_is_the_contact() {
        for seed in 1..=4 {
            let force = |index: usize| {
                let index = index as f64;
                let snap = if index >= 150.0 { -3.0 } else { 0.0 };
                let first = 0.1 * (index - 150.0).clamp(0.0, 20.0);
                let second = 0.4 * (index - 240.0).clamp(0.0, 30.0);
                let third = 0.6 * (index - 330.0).max(0.0);
                snap + first + second + third
            };
            let values = noisy((0..380).map(force), 0.02, seed);
            let free = free_count(&values, 0.0).unwrap();
            assert!((145..=151).contains(&free), "{seed}: {free}");
        }
    }
}
