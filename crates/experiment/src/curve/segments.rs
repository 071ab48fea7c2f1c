//! The segments of a curve, in which the body is pressed and pulled in turn, and the pauses between
//! them.

use crate::curve::numerics::ends;
use crate::read::Label;

/// Share of the range by which the displacement comes back after a turning point, and share of the
/// points that a smoothed displacement averages.
const TURN: f64 = 0.05;
const SMOOTHING: f64 = 1e-3;
/// Share of the range of the displacement within which a pause stays, smallest number of points of
/// a pause, and least ratio of these points to the points of a motion.
const STILL: f64 = 0.01;
const FEWEST: usize = 10;
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
        let by_turning_points = || Segments {
            numbers: by_turning_points(displacement),
            is_still: vec![false; displacement.len()],
        };
        let mut segments = by_labels(labels, displacement).unwrap_or_else(by_turning_points);
        if !segments.is_still.contains(&true) {
            segments.find_pauses(displacement);
        }
        segments
    }

    /// Exchanges the first two segments, which begin at the ends of their ranges of points.
    pub fn exchange(&mut self, first: usize) {
        self.is_still.rotate_left(first);
        let second = self.numbers.len() - first;
        self.numbers[..second].fill(0);
        self.numbers[second..].fill(1);
    }

    /// Marks the points beside each turning point as a pause, if many more points stay there than
    /// pass by.
    fn find_pauses(&mut self, displacement: &[f64]) {
        let (low, high) = ends(displacement.iter().copied());
        let near = STILL * (high - low);
        let count = self.numbers.last().copied().unwrap_or(0);
        let start = |number: usize| self.numbers.partition_point(|segment| *segment < number);
        for turn in 1..=count {
            let [from, at, to] = [turn - 1, turn, turn + 1].map(start);
            let is_near = |index: &usize| (displacement[*index] - displacement[at]).abs() <= near;
            let first = (from..at).rev().take_while(is_near).last().unwrap_or(at);
            let last = (at..to).take_while(is_near).last().unwrap_or(at);
            let staying = last + 1 - first;
            let way = (displacement[from] - displacement[at]).abs()
                + (displacement[to - 1] - displacement[at]).abs();
            let passing = 2.0 * near * (to - from - staying) as f64 / way;
            if staying >= FEWEST && staying as f64 > MORE * passing {
                self.is_still[first..=last].fill(true);
            }
        }
    }
}

/// Returns true if the displacement jumps to and fro from point to point, as it does for rows in a
/// wrong order.
pub(crate) fn are_shuffled(displacement: &[f64]) -> bool {
    let (low, high) = ends(displacement.iter().copied());
    let way: f64 = displacement
        .windows(2)
        .map(|pair| (pair[1] - pair[0]).abs())
        .sum();
    way > SHUFFLED * (high - low) * displacement.len() as f64
}

/// Returns the index of the segment of each point. Segments end at turning points of the smoothed
/// displacement. After a turning point the displacement comes back by a share of its range.
fn by_turning_points(displacement: &[f64]) -> Vec<usize> {
    let last = displacement.len() - 1;
    let half = (0.5 * SMOOTHING * last as f64) as usize;
    let smooth = |index: usize| {
        let half = half.min(index).min(last - index);
        displacement[index - half..=index + half]
            .iter()
            .sum::<f64>()
            / (2 * half + 1) as f64
    };
    let smooth: Vec<f64> = (0..=last).map(smooth).collect();
    let (low, high) = ends(smooth.iter().copied());
    let least = TURN * (high - low);
    // Highest and lowest place since the last turn, and the direction, 0 at the beginning.
    let (mut places, mut direction, mut number) = ([0, 0], 0.0, 0);
    let mut numbers = vec![0; displacement.len()];
    for (index, &value) in smooth.iter().enumerate() {
        for (place, sign) in places.iter_mut().zip([1.0, -1.0]) {
            if sign * (value - smooth[*place]) > 0.0 {
                *place = index;
            }
        }
        let back = places.map(|place| (value - smooth[place]).abs() >= least && least > 0.0);
        let turned = if back[0] && direction >= 0.0 {
            0
        } else if back[1] && direction <= 0.0 {
            1
        } else {
            continue;
        };
        if direction != 0.0 {
            number += 1;
            numbers[places[turned] + 1..].fill(number);
        }
        direction = if turned == 0 { -1.0 } else { 1.0 };
        places = [index, index];
    }
    numbers
}

/// Finds segments by the labels of a file. Neighbouring parts in one direction are one segment, and
/// parts without motion are pauses. Returns `None` if the labels do not separate the directions.
fn by_labels(labels: &[Label], displacement: &[f64]) -> Option<Segments> {
    let (low, high) = ends(displacement.iter().copied());
    let (mut numbers, mut is_still) = (
        Vec::with_capacity(labels.len()),
        Vec::with_capacity(labels.len()),
    );
    let (mut number, mut before) = (0, None);
    for part in labels.chunk_by(|one, next| one == next) {
        let of = &displacement[numbers.len()..numbers.len() + part.len()];
        let (moved, of_ends) = (of[of.len() - 1] - of[0], ends(of.iter().copied()));
        let least = TURN * (high - low);
        if !part[0].is_pause && of_ends.1 - of_ends.0 > 2.0 * moved.abs().max(least) {
            return None;
        }
        let stays = part[0].is_pause || moved.abs() < least;
        if !stays {
            let presses = moved > 0.0;
            number += usize::from(
                before
                    .replace(presses)
                    .is_some_and(|before| before != presses),
            );
        }
        numbers.extend(std::iter::repeat_n(number, part.len()));
        is_still.extend(std::iter::repeat_n(stays, part.len()));
    }
    (number > 0).then_some(Segments { numbers, is_still })
}
