//! The segments of a curve, and the pauses between them. In one segment the body is pressed, in the
//! next the body is pulled.

use crate::curve::numerics::Extent;
use crate::read::points::Label;
use asperity_data::quantile;

/// Smallest distance that the displacement goes back after a turning point, as a share of its
/// range.
const TURN: f64 = 0.05;
/// Smallest distance by which the displacement goes back after the turning point between two steady
/// motions, as a share of its range. The retraction may be much longer than the approach.
const STEADY_TURN: f64 = 0.01;
/// Largest length of the path from point to point of a steady motion, divided by the distance from
/// its beginning to its end.
const STEADY: f64 = 1.05;
/// Smallest number of points of a steady motion.
const FEWEST_STEADY: usize = 20;
/// Share of the points that a smoothed displacement averages.
const SMOOTHING: f64 = 1e-3;
/// Largest change of the displacement during a pause at a turning point, as a share of the range of
/// displacements.
const STILL: f64 = 0.01;
/// Largest change of the displacement during a pause of few points, as a share of the range of
/// displacements. Such a pause is found if its points stay at nearly one displacement.
const SHORT_STILL: f64 = 0.001;
/// Smallest change of the displacement, as a share of its range, with which a part of the file with
/// the same label counts as a motion. The part must also be about as fast as other parts.
const SHORTEST: f64 = 0.002;
/// Smallest number of points of a pause.
const FEWEST: usize = 10;
/// Smallest ratio of the number of points of a pause to the number of points of a motion over the
/// same distance.
const MORE: f64 = 8.0;
/// Smallest distance between the quartiles of the displacements near a turning point, with which
/// the points may belong to a motion. It is given as a share of the distance up to which points
/// count as near. For points of an even motion this share is 0.5.
const SPREAD: f64 = 0.2;
/// Smallest share of the steps from point to point near a turning point that go in the direction of
/// the motion, if the motion is steady.
const STEADILY: f64 = 0.85;
/// Mean distance between consecutive displacements, as a share of their range, above which the rows
/// of the file are not in the order of time.
const SHUFFLED: f64 = 0.2;

pub(crate) struct Segments {
    /// Index of the segment of each point, from 0.
    pub numbers: Vec<usize>,
    /// True for each point that belongs to a pause.
    pub is_still: Vec<bool>,
}

impl Segments {
    /// Finds the segments from the labels of the points. If there are no usable labels, the
    /// segments end at the turning points of the displacement.
    pub fn of(displacement: &[f64], labels: &[Label]) -> Self {
        let mut segments = by_labels(labels, displacement).unwrap_or_else(|| Segments {
            numbers: by_turning_points(displacement),
            is_still: vec![false; displacement.len()],
        });
        if !segments.is_still.contains(&true) {
            segments.find_pauses(displacement);
        }
        segments
    }

    /// Exchanges the first two segments. `first` is the number of points in the first segment.
    pub fn exchange(&mut self, first: usize) {
        self.is_still.rotate_left(first);
        let second = self.numbers.len() - first;
        self.numbers[..second].fill(0);
        self.numbers[second..].fill(1);
    }

    /// Returns the index of the first point of a segment.
    fn start_of(&self, number: usize) -> usize {
        self.numbers.partition_point(|segment| *segment < number)
    }

    /// Marks the points near each turning point as a pause, if there are many more of them than a
    /// motion over the same distance would have.
    fn find_pauses(&mut self, displacement: &[f64]) {
        let range = Extent::of(displacement.iter().copied()).width();
        let last_segment = self.numbers.last().copied().unwrap_or(0);
        for segment in 1..=last_segment {
            for near in [STILL * range, SHORT_STILL * range] {
                if self.find_pause(displacement, segment, near) {
                    break;
                }
            }
        }
    }

    /// Marks the points within `near` m of the turning point at the beginning of a segment as a
    /// pause, and returns true, if there are many more of them than a motion would have.
    fn find_pause(&mut self, displacement: &[f64], segment: usize, near: f64) -> bool {
        let start = self.start_of(segment - 1);
        let turn = self.start_of(segment);
        let end = self.start_of(segment + 1);
        let distance = |index: usize| (displacement[index] - displacement[turn]).abs();
        let is_near = |index: &usize| distance(*index) <= near;

        let before = (start..turn).rev().take_while(is_near).last();
        let after = (turn..end).take_while(is_near).last();
        let first = before.unwrap_or(turn);
        let last = after.unwrap_or(turn);
        let staying = last + 1 - first;
        let way = distance(start) + distance(end - 1);
        let passing = 2.0 * near * (end - start - staying) as f64 / way;
        let is_slow = staying >= FEWEST && staying as f64 > MORE * passing;
        if is_slow && !is_finely_sampled(&displacement[first..=last], turn - first, near) {
            self.is_still[first..=last].fill(true);
            return true;
        }
        false
    }
}

/// Returns true if the points near a turn, at the index `turn`, are those of a steady motion that
/// has more points there than elsewhere, as a computed curve may have. In a pause, the displacement
/// stays at one value, or moves back and forth by its noise. `near` is the distance in m from the
/// turn up to which the points lie.
fn is_finely_sampled(displacements: &[f64], turn: usize, near: f64) -> bool {
    let mut sorted = displacements.to_vec();
    sorted.sort_by(f64::total_cmp);
    let (Some(low), Some(high)) = (quantile(&sorted, 0.25), quantile(&sorted, 0.75)) else {
        return false;
    };
    let mut forwards = 0;
    let mut all = 0;
    for (index, pair) in displacements.windows(2).enumerate() {
        let step = pair[1] - pair[0];
        let from_turn = displacements[turn] - pair[0];
        let is_before = index < turn;
        // The displacement moves to the turn before it, and away from it afterwards.
        let is_forwards = (step * from_turn > 0.0) == is_before || from_turn == 0.0;
        all += 1;
        forwards += usize::from(step != 0.0 && is_forwards);
    }
    high - low > SPREAD * near && forwards as f64 > STEADILY * f64::from(all)
}

/// Returns true if the displacement changes so much from point to point that the rows of the file
/// cannot be in the order of time.
pub(crate) fn are_shuffled(displacement: &[f64]) -> bool {
    let range = Extent::of(displacement.iter().copied());
    let way: f64 = displacement
        .windows(2)
        .map(|pair| (pair[1] - pair[0]).abs())
        .sum();
    way > SHUFFLED * range.width() * displacement.len() as f64
}

/// Returns the displacements smoothed by running means.
fn smoothed(displacement: &[f64]) -> Vec<f64> {
    let last = displacement.len() - 1;
    let widest = (0.5 * SMOOTHING * last as f64) as usize;
    let mut means = Vec::with_capacity(displacement.len());
    for index in 0..=last {
        let half = widest.min(index).min(last - index);
        let values = &displacement[index - half..=index + half];
        means.push(values.iter().sum::<f64>() / (2 * half + 1) as f64);
    }
    means
}

/// Returns the index of the segment of each point. A segment ends at a turning point of the
/// smoothed displacement if the displacement then goes back by at least [`TURN`] of its range.
fn by_turning_points(displacement: &[f64]) -> Vec<usize> {
    let smooth = smoothed(displacement);
    let range = Extent::of(smooth.iter().copied()).width();
    let numbers = by_turns_of(&smooth, TURN * range);
    if numbers.last() != Some(&0) {
        return numbers;
    }
    let steady = by_turns_of(&smooth, STEADY_TURN * range);
    let first = steady.partition_point(|number| *number == 0);
    let are_two = steady.last() == Some(&1);
    // Both motions contain the point at which the displacement turns.
    if are_two && is_steady(&smooth[..first]) && is_steady(&smooth[first - 1..]) {
        return steady;
    }
    numbers
}

/// Returns true if there are enough displacements and they hardly move back.
fn is_steady(displacements: &[f64]) -> bool {
    let count = displacements.len();
    if count < FEWEST_STEADY {
        return false;
    }
    let steps = displacements.windows(2);
    let way: f64 = steps.map(|pair| (pair[1] - pair[0]).abs()).sum();
    way <= STEADY * (displacements[count - 1] - displacements[0]).abs()
}

/// Returns the index of the segment of each displacement. A turning point counts if the
/// displacement goes back by at least `least` m after it.
fn by_turns_of(smooth: &[f64], least: f64) -> Vec<usize> {
    let mut numbers = vec![0; smooth.len()];
    if least <= 0.0 {
        return numbers;
    }
    let mut number = 0;
    // Indices of the largest and the smallest displacement since the last turning point.
    let mut highest = 0;
    let mut lowest = 0;
    // True while the displacement grows; `None` before the direction is known.
    let mut grows: Option<bool> = None;
    for (index, &value) in smooth.iter().enumerate() {
        if value > smooth[highest] {
            highest = index;
        }
        if value < smooth[lowest] {
            lowest = index;
        }
        let has_fallen = smooth[highest] - value >= least;
        let has_risen = value - smooth[lowest] >= least;
        let turn = if has_fallen && grows != Some(false) {
            highest
        } else if has_risen && grows != Some(true) {
            lowest
        } else {
            continue;
        };
        if grows.is_some() {
            number += 1;
            numbers[turn + 1..].fill(number);
        }
        grows = Some(turn == lowest);
        highest = index;
        lowest = index;
    }
    numbers
}

/// Returns the mean distance in m between neighbouring points in the fastest part of the file. The
/// points of a part have the same label.
fn fastest_part(labels: &[Label], displacement: &[f64]) -> f64 {
    let mut fastest = 0.0_f64;
    let mut start = 0;
    for part in labels.chunk_by(|label, next| label == next) {
        let last = start + part.len() - 1;
        let way = (displacement[last] - displacement[start]).abs();
        fastest = fastest.max(way / part.len() as f64);
        start += part.len();
    }
    fastest
}

/// Finds segments from the labels that a file gives to its points. Consecutive parts of the file
/// with motion in the same direction form one segment, and parts without motion are pauses. Returns
/// `None` if a part contains motions in both directions, or if all parts have the same direction.
fn by_labels(labels: &[Label], displacement: &[f64]) -> Option<Segments> {
    let range = Extent::of(displacement.iter().copied()).width();
    let least = TURN * range;
    let fastest = fastest_part(labels, displacement);
    let mut segments = Segments {
        numbers: Vec::with_capacity(labels.len()),
        is_still: Vec::with_capacity(labels.len()),
    };
    let mut number = 0;
    // True if the previous motion pressed the body, false if it pulled; `None` before the first
    // motion.
    let mut pressed_before = None;
    for part in labels.chunk_by(|label, next| label == next) {
        let is_pause = part[0].is_pause;
        let start = segments.numbers.len();
        let places = &displacement[start..start + part.len()];
        let moved = places[places.len() - 1] - places[0];
        let width = Extent::of(places.iter().copied()).width();
        if !is_pause && width > 2.0 * moved.abs().max(least) {
            return None;
        }
        // A short step of a loading by steps is a motion and not a pause. It is recognised because
        // it is about as fast as other parts.
        let is_step = moved.abs() > (SHORTEST * range).max(width - moved.abs())
            && MORE * moved.abs() > fastest * part.len() as f64;
        let stays = is_pause || moved.abs() < least && !is_step;
        if !stays {
            let presses = moved > 0.0;
            if pressed_before == Some(!presses) {
                number += 1;
            }
            pressed_before = Some(presses);
        }
        segments
            .numbers
            .extend(std::iter::repeat_n(number, part.len()));
        segments
            .is_still
            .extend(std::iter::repeat_n(stays, part.len()));
    }
    if number == 0 {
        return None;
    }
    Some(segments)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An approach is a segment even if it is much shorter than the retraction. A part in
    /// which the displacement goes back and forth by the same distance is not a segment.
    #[test]
    fn points_that_are_dense_near_a_turn_are_no_pause() {
        let far: Vec<f64> = (0..100)
            .map(|index| 0.01 * f64::from(index) - 1.0)
            .collect();
        let dense: Vec<f64> = (0..300).map(|index| 5e-5 * f64::from(index)).collect();
        let mut moving: Vec<f64> = far.iter().chain(&dense).copied().collect();
        moving.extend(dense.iter().rev().chain(far.iter().rev()));
        let segments = Segments::of(&moving, &[]);
        assert!(!segments.is_still.contains(&true));
        // The same number of points that stay at one displacement, exactly or with a little noise,
        // are a pause.
        for noise in [0.0, 1e-4, 2e-3] {
            let mut pausing = far.clone();
            let noisy = |index: usize| noise * ((7 * index) as f64).sin();
            pausing.extend((0..300).map(noisy));
            pausing.extend(far.iter().rev());
            let still = Segments::of(&pausing, &[]).is_still;
            let count = still.iter().filter(|is_still| **is_still).count();
            assert!((290..=310).contains(&count), "{noise}: {count}");
        }
    }

    #[test]
    fn a_short_approach_before_a_long_retraction_is_a_segment() {
        let mut displacement: Vec<f64> = (0..50).map(f64::from).collect();
        displacement.extend((0..3000).map(|index| 49.0 - f64::from(index)));
        let numbers = by_turning_points(&displacement);
        let first = numbers.partition_point(|number| *number == 0);
        assert!(
            numbers.last() == Some(&1) && first.abs_diff(50) <= 2,
            "{first}"
        );
        let shaking = |(index, at): (usize, &f64)| at + 20.0 * (0.4 * index as f64).sin();
        let shaken: Vec<f64> = displacement.iter().enumerate().map(shaking).collect();
        assert_eq!(by_turning_points(&shaken).last(), Some(&0));
    }
}
