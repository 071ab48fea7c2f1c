//! The segments of a curve, in which the body is pressed and pulled in turn, and the pauses between
//! them.

use crate::curve::numerics::Extent;
use crate::read::points::Label;

/// Share of the range by which the displacement comes back after a turning point.
const TURN: f64 = 0.05;
/// Share of the range by which the displacement comes back after the turning point of two steady
/// motions, of which the retraction may be much longer than the approach.
const STEADY_TURN: f64 = 0.01;
/// Way from point to point of a steady motion, divided by the way from its begin to its end.
const STEADY: f64 = 1.05;
/// Smallest number of points of a steady motion.
const FEWEST_STEADY: usize = 20;
/// Share of the points that a smoothed displacement averages.
const SMOOTHING: f64 = 1e-3;
/// Share of the range of the displacement within which a pause stays.
const STILL: f64 = 0.01;
/// Share of the range of the displacement above which a part with one label is a motion, if it is
/// as fast as others.
const SHORTEST: f64 = 0.002;
/// Smallest number of points of a pause.
const FEWEST: usize = 10;
/// Least ratio of the points of a pause to the points of a motion over the same way.
const MORE: f64 = 8.0;
/// Mean step between points, over the range of the displacement, above which the rows are not in
/// the order of time.
const SHUFFLED: f64 = 0.2;

pub(crate) struct Segments {
    /// Index of the segment of each point, from 0.
    pub numbers: Vec<usize>,
    /// True for each point that belongs to a pause.
    pub is_still: Vec<bool>,
}

impl Segments {
    /// Finds segments by the labels of a column, or by the turning points of the displacement if
    /// there are no labels.
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

    /// Exchanges the first two segments, of which the first one has `first` points.
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

    /// Marks the points beside each turning point as a pause, if many more points stay there than
    /// pass by.
    fn find_pauses(&mut self, displacement: &[f64]) {
        let near = STILL * Extent::of(displacement.iter().copied()).width();
        let last_segment = self.numbers.last().copied().unwrap_or(0);
        for segment in 1..=last_segment {
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
            if staying >= FEWEST && staying as f64 > MORE * passing {
                self.is_still[first..=last].fill(true);
            }
        }
    }
}

/// Returns true if the displacement jumps back and forth from point to point, as it does for rows
/// in a wrong order.
pub(crate) fn are_shuffled(displacement: &[f64]) -> bool {
    let range = Extent::of(displacement.iter().copied());
    let way: f64 = displacement
        .windows(2)
        .map(|pair| (pair[1] - pair[0]).abs())
        .sum();
    way > SHUFFLED * range.width() * displacement.len() as f64
}

/// Returns running means over a share of the points.
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

/// Returns the index of the segment of each point. Segments end at turning points of the smoothed
/// displacement. After a turning point the displacement comes back by a share of its range.
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

/// Returns true for enough displacements that hardly move back.
fn is_steady(displacements: &[f64]) -> bool {
    let count = displacements.len();
    if count < FEWEST_STEADY {
        return false;
    }
    let steps = displacements.windows(2);
    let way: f64 = steps.map(|pair| (pair[1] - pair[0]).abs()).sum();
    way <= STEADY * (displacements[count - 1] - displacements[0]).abs()
}

/// Returns the index of the segment of each displacement, if it comes back by at least `least` m
/// after each turning point.
fn by_turns_of(smooth: &[f64], least: f64) -> Vec<usize> {
    let mut numbers = vec![0; smooth.len()];
    if least <= 0.0 {
        return numbers;
    }
    let mut number = 0;
    // Indices of the highest and the lowest value since the last turn.
    let mut highest = 0;
    let mut lowest = 0;
    // Whether the displacement grows; `None` at the beginning.
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

/// Returns the largest way from point to point in m, as a mean over a part with one label.
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

/// Finds segments by the labels of a file. Neighbouring parts in one direction are one segment, and
/// parts without motion are pauses. Returns `None` if the labels do not separate the directions.
fn by_labels(labels: &[Label], displacement: &[f64]) -> Option<Segments> {
    let range = Extent::of(displacement.iter().copied()).width();
    let least = TURN * range;
    let fastest = fastest_part(labels, displacement);
    let mut segments = Segments {
        numbers: Vec::with_capacity(labels.len()),
        is_still: Vec::with_capacity(labels.len()),
    };
    let mut number = 0;
    // Whether the part before pressed the body; `None` before the first motion.
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
        // A short step of a loading by steps moves as fast as its other parts.
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

    /// An approach that is a small part of a long retraction is a segment, and a displacement that
    /// moves back and forth by as much is not.
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
