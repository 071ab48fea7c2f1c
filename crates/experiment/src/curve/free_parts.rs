//! The parts of a curve without contact, and the point at which the contact begins.

use crate::curve::numerics::{Baseline, Extent, correlated, growing, noise_of_neighbours};
use crate::curve::points::Points;
use crate::error::{ExperimentError, refused};
use crate::read::options::CurveOptions;
use asperity_data::mean;
use std::ops::Range;

/// Smallest allowed number of points in a part without contact.
pub(crate) const FEWEST: usize = 10;
/// Smallest number of points in contact.
const FEWEST_IN_CONTACT: usize = 4;
/// Smallest gain with which a segment counts as having a contact. The gain compares the fit of a
/// straight line followed by a parabola with the fit of a single straight line: it is the number of
/// points times the decrease of the logarithm of the sum of squared residuals. A smaller gain can
/// result from noise.
const GAIN: f64 = 40.0;
/// Deviation, in standard errors, of the mean of the last points from the straight line through the
/// points before them, above which these last points are in contact.
const DEVIATES: f64 = 4.0;
/// Smallest ratio of the noise about the straight line of a part without contact to the noise
/// computed from differences of neighbouring points. Above this ratio the part may contain an
/// earlier contact.
const UNLIKE_NEIGHBOURS: f64 = 3.0;
/// Largest ratio of the noise before an earlier contact to the noise of the whole part. The earlier
/// contact is accepted only below this ratio.
const QUIETER: f64 = 0.3;
/// Divisors n for the search of a weak contact: the last 1/n of the points assumed to be without
/// contact is compared with the points before it.
const PARTS: [usize; 3] = [5, 10, 20];
/// Share of the mean slope in contact. If the slope at the beginning of a segment exceeds this
/// share, and the force changes there by more than [`NOTABLE`], the segment is in contact from its
/// first point on.
const STEEP: f64 = 0.5;
/// Smallest change of the force for which the bound [`STEEP`] is applied, as a share of the range
/// of the force.
const NOTABLE: f64 = 0.05;

/// Share of the largest tension above which the end of a retraction may still be in contact.
const HELD: f64 = 0.5;
/// Tension at the end of a retraction, in units of the noise, up to which it counts as noise.
const BEYOND_NOISE: f64 = 5.0;
/// Ratio of two distances below which the last points, whose tension is nearly straight, are still
/// in contact. The first distance is the length of this part of the curve. The second is the
/// distance over which the tension grew before.
const LONG: f64 = 1.0;

/// Smallest gain of a parabola over a straight line, with which the last points of a retraction
/// count as a parabola.
const GAIN_BY_PARABOLA: f64 = 20.0;
/// Largest ratio of the noise of the last points about a parabola to the noise of neighbouring
/// points, with which the last points count as a parabola.
const LIKE_NEIGHBOURS: f64 = 1.5;

/// Reason why a segment has no part without contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum NoFreePart {
    /// The segment has too few points to find where the contact begins.
    Few,
    /// The segment is a straight line, so that no contact is found. `range` is the change of the
    /// force along the line and `noise` the noise of the force, both in N.
    Straight { range: f64, noise: f64 },
    /// The force changes from the first point on, so that the whole segment is in contact.
    InContact,
}

/// Returns the number of points before contact at the beginning of a segment. `forces` are the
/// forces of the segment in N. The noise is assumed to be at least `least_noise` in N.
///
/// First the function finds the point that divides the segment best into a straight line and a
/// parabola. This point lies in the steep part of the contact. Then the function goes back to the
/// weak beginning of the contact: it removes points until the last ones no longer deviate from the
/// straight line through the points before them.
///
/// If the force rises in several steep parts, as in a loading by steps, the dividing point may lie
/// in a later part. The noise before this point is then far above the differences of neighbouring
/// forces, and the search is repeated among the points before it.
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

/// Returns the number of points before contact that follows from the best fit of a straight line
/// and a parabola to the forces.
fn count_before_change(forces: &[f64], least_noise: f64) -> Result<usize, NoFreePart> {
    let count = forces.len();
    if count < 2 * FEWEST {
        return Err(NoFreePart::Few);
    }
    // The sum of squares that the smallest noise would give is added to each sum of squares.
    // Differences below this noise then do not affect the result.
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

/// Place at which the straight line of the fit ends and the parabola begins.
struct Change {
    place: usize,
    /// Sum of the squared residuals of the line and the parabola.
    squares: f64,
}

/// Returns the place for which a straight line before it and a parabola after it describe the
/// forces best. The element of `before` at each place is the sum of the squared residuals of a
/// straight line through the forces up to this place. `floor` is added to each sum of squares.
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

/// Returns the number of forces before the steep part of the contact. The last of these forces may
/// already belong to the weak beginning of the contact.
pub(crate) fn count_before_steep_part(forces: &[f64]) -> usize {
    let before = growing(forces.iter().copied(), 2);
    steepest_change(forces, &before, 0.0).place
}

fn range_of(forces: &[f64]) -> f64 {
    Extent::of(forces.iter().copied()).width()
}

/// Returns true if the force changes in the first `free` points at least half as fast as in
/// contact, and by a notable part of its range.
fn begins_steep(forces: &[f64], free: usize) -> bool {
    let slope = Baseline::through(&forces[..free]).slope.abs();
    let slope_in_contact = range_of(&forces[free..]) / (forces.len() - free) as f64;
    slope > STEEP * slope_in_contact && slope * free as f64 > NOTABLE * range_of(forces)
}

/// Returns true if the first `free` points are less than a tenth of the segment and lie on a curve,
/// as the beginning of a contact does. `squares` is the sum of squared residuals of the straight
/// line through these points, and `floor` is added to each sum of squares.
fn begins_curved(forces: &[f64], free: usize, squares: f64, floor: f64) -> bool {
    if 10 * free >= forces.len() {
        return false;
    }
    let squares_of_parabola = growing(forces[..free].iter().copied(), 3)[free - 1];
    free as f64 * ((squares + floor) / (squares_of_parabola + floor)).ln() > GAIN
}

/// Reduces the number `free` of forces without contact until the last of these forces do not
/// deviate from the straight line through the forces before them.
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

/// Returns true if the mean of the last `last` forces deviates from the straight line through the
/// forces before them.
fn end_deviates(forces: &[f64], last: usize, least_noise: f64) -> bool {
    let free = forces.len();
    let line = Baseline::through(&forces[..free - last]);
    let residuals = line.residuals(forces);
    let (before, end) = residuals.split_at(free - last);
    let count = before.len() as f64;
    let mean = end.iter().sum::<f64>() / last as f64;
    // The line is extrapolated, and its error grows with the distance from its points.
    let ahead = 0.5 * free as f64;
    let variance = 1.0 / last as f64 + 1.0 / count + ahead * ahead * 12.0 / count.powi(3);
    let error = line.noise.max(least_noise) * (correlated(before) * variance).sqrt();
    mean.abs() > DEVIATES * error
}

/// Numbers of the points without contact at the beginning of an approach and at the end of a
/// retraction.
pub(crate) struct FreeParts {
    /// Number of points before contact. It is `None` for a retraction without an approach. It is
    /// also `None` if no contact is found in the approach and the options select only other
    /// segments.
    pub before: Option<usize>,
    /// Number of points after contact at the end of the curve; 0 if no such points are found.
    pub after: usize,
    /// True if the curve ends in contact although its last points look straight: a tension still
    /// holds the body at the end of the last retraction.
    pub ends_in_contact: bool,
    /// Time and displacement of each point, both divided by their range over the whole curve.
    pub shares: [Vec<f64>; 2],
}

impl FreeParts {
    /// Finds the parts of a curve without contact. Each of the `points` is the mean of `averaged`
    /// points of the file. `least_noise` is the smallest assumed noise in N.
    ///
    /// # Errors
    /// Returns an error if the part without contact has too few points, or if no contact is found.
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

    /// Returns the range of indices of those points without contact from which the zero offset and
    /// the noise of the force are determined.
    pub fn base(&self) -> Range<usize> {
        let count = self.shares[0].len();
        match self.before {
            Some(before) => 0..before,
            None => count - self.after..count,
        }
    }

    /// Returns an estimate of the displacement in m at which the contact begins. For a curve with
    /// an approach, this is the end of the part before contact. For a retraction without an
    /// approach, it is the displacement at which the compression ends. If such a retraction begins
    /// in tension, it is the displacement of the middle one of the points in contact.
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

/// Returns the number of points after contact at the end of a curve. It is 0 if the curve does not
/// end with a retraction, or if no part without contact is found.
fn count_after_contact(points: &Points, least_noise: f64) -> usize {
    let last = points.last_segment();
    if last.is_multiple_of(2) {
        return 0;
    }
    let forces = &points.force[points.moving(last)];
    free_count_at_end(forces, least_noise).unwrap_or(0)
}

/// Returns the number of forces after contact at the end of a segment. If the last points lie on a
/// parabola, they belong to a tension near its largest value, and an error is returned.
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

/// Returns true if the last `after` points, which are nearly on a straight line, are no part
/// without contact. The force is also flat where a tension is largest, and a soft instrument, or
/// points that are taken at a falling speed, make it look straight. The first `before` points of
/// the curve show the zero of the force.
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

/// Returns true if a segment ends without contact. The end of the segment must have a part without
/// contact. If the beginning of the segment has such a part too, the force must change more along
/// it than along the part at the end.
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

/// Returns the error for a curve in which no part before contact is found, for this `reason`.
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

/// Returns true if the first segment is a retraction although it should be an approach. It is a
/// retraction if its end is without contact.
fn is_retraction_first(points: &Points, approach: &[f64], least_noise: f64) -> bool {
    points.segment.contains(&1) && free_count_at_end(approach, least_noise).is_ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::curve::numerics::tests::noisy;

    /// Returns the forces of a sphere without adhesion, which touches after a share `touch` of the
    /// points. The last force is 1.
    fn hertz(count: usize, touch: f64) -> impl Iterator<Item = f64> {
        let share =
            move |index: usize| (index as f64 / count as f64 - touch).max(0.0) / (1.0 - touch);
        (0..count).map(move |index| share(index).powf(1.5))
    }

    /// The beginning of the contact is found under noise of up to 5 % of the largest force. With
    /// more noise it is found later, because the weak beginning of the contact is hidden by the
    /// noise.
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

    /// In a curve without noise, such as a computed one, the contact begins exactly where the force
    /// begins.
    #[test]
    fn a_contact_without_noise_begins_where_the_force_does() {
        let parabola: Vec<f64> = (0..100)
            .map(|index| (f64::from(index) - 59.0).max(0.0).powi(2))
            .collect();
        let free = free_count(&parabola, 0.0).unwrap();
        assert!((59..=62).contains(&free), "{free}");
    }

    /// A weak contact long before the strong contact is not taken for a part without contact,
    /// although its forces are only a few times the noise.
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

    /// If a body is loaded by steps, the contact begins at the first step, although a later step is
    /// steeper.
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
