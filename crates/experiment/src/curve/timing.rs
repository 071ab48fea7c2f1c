//! Time in a measured curve: the speed of the instrument, and its rest between approach and
//! retraction. Only a fit with relaxation needs them.

use crate::curve::motion::{Passage, Piece, pieces_of};
use crate::curve::numerics::{Extent, least_squares};
use crate::curve::points::Points;
use asperity_data::median;
use std::ops::Range;

/// Largest distance of a displacement during a rest from the median displacement of the rest, as a
/// share of the range of displacements.
const STILL: f64 = 0.002;
/// Distance from the turning point, as a share of the range of displacements, up to which points
/// are left out when a speed is computed.
const NEAR: f64 = 0.01;
/// Smallest share of the points of a pause that stay within the distance [`STILL`] of the median
/// displacement, if the pause is a rest.
const MOST_STAY: f64 = 0.5;
/// Largest number of points of a rest that a fit uses.
const MOST_POINTS: usize = 200;
/// Smallest number of points in contact from which a speed is determined.
const FEWEST: usize = 5;

/// Times of a curve of one approach and one retraction.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Timing {
    /// Speeds of the instrument in m/s on approach and retraction, computed from the times of the
    /// points; `None` without times.
    pub speeds: Option<Speeds>,
    /// Approach and retraction, each divided into pieces of constant speed; empty without times.
    pub motions: [Vec<Piece>; 2],
    /// Time in s for which the instrument rests between approach and retraction, computed from the
    /// times of the points; `None` without times.
    pub rest: Option<f64>,
    /// Points of this rest, in the order of time.
    pub points: Vec<RestingPoint>,
    /// True if the instrument also rests in contact at another time.
    pub has_other_rests: bool,
}

/// Part of a measured curve in which the body is in contact, determined without a model.
#[derive(Clone, Copy)]
pub(crate) struct InContact {
    /// Displacement in m at first touch.
    pub touch: f64,
    /// Index of the first point after the end of the contact.
    pub end: usize,
}

/// Speeds of the instrument in m/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Speeds {
    pub approach: f64,
    pub retraction: f64,
}

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct RestingPoint {
    pub displacement: f64,
    pub force: f64,
    /// Time in s since the beginning of the rest; `None` without times.
    pub seconds: Option<f64>,
    /// Contributions in N that were subtracted from the force at this point, such as a drift.
    pub lines: Vec<f64>,
}

impl Timing {
    /// Determines speeds and rests from the times of the points. `kept` has the indices of the
    /// points of the curve among all `points`. `lines` are the contributions that were subtracted
    /// from the force, at all points. `contact` states where the body is in contact.
    pub fn of(points: &Points, kept: &[usize], lines: &[Vec<f64>], contact: InContact) -> Self {
        let touch = contact.touch;
        let is_loop = points.begins_with_approach() && points.last_segment() == 1;
        let turn = kept.partition_point(|index| points.segment[*index] == 0);
        let (approach, retraction) = kept.split_at(turn);
        let (Some(&before), Some(&after)) = (approach.last(), retraction.first()) else {
            return Timing::default();
        };
        if !is_loop {
            return Timing::default();
        }
        let at_rest = resting(points, before + 1..after);
        let of_motions = [approach, retraction];
        let has_other_rests = of_motions
            .iter()
            .any(|motion| rests_within(points, motion, touch));
        let speeds = Speeds::of(points, of_motions, touch);
        // Near the turn, points of a short rest may count as points of the motions.
        let highest = Extent::of(kept.iter().map(|index| points.displacement[*index])).high;
        let far = highest - NEAR * Extent::of(points.displacement.iter().copied()).width();
        let is_far = |index: &&usize| points.displacement[**index] < far;
        let last_far = approach.iter().rev().find(is_far).copied();
        let first_far = retraction.iter().find(is_far).copied();

        let mut displacements: Vec<f64> = at_rest
            .iter()
            .map(|index| points.displacement[*index])
            .collect();
        let place = median(&mut displacements).unwrap_or(highest);
        let mut begin = None;
        let mut rest = None;
        let mut motions = [Vec::new(), Vec::new()];
        if let Some(speeds) = speeds {
            let way = |index: usize| (place - points.displacement[index]).max(0.0);
            let last = last_far.unwrap_or(before);
            let first = first_far.unwrap_or(after);
            let pressed = approach.iter().copied().filter(|index| *index <= last);
            let is_pulled = |index: &usize| (first..contact.end).contains(index);
            let pulled = retraction.iter().copied().filter(is_pulled);
            motions = [
                pieces_of(&passages(points, pressed, touch), speeds.approach),
                pieces_of(
                    &passages(points, pulled, f64::NEG_INFINITY),
                    speeds.retraction,
                ),
            ];
            let [begin_of_rest, end_of_rest] = [motions[0].last(), motions[1].first()];
            let speed = begin_of_rest.map_or(speeds.approach, |piece| piece.speed);
            let arrival = points.seconds[last] + way(last) / speed;
            let speed = end_of_rest.map_or(speeds.retraction, |piece| piece.speed);
            let departure = points.seconds[first] - way(first) / speed;
            begin = Some(arrival);
            rest = Some((departure - arrival).max(0.0));
        }
        let step = at_rest.len().div_ceil(MOST_POINTS).max(1);
        let mut of_rest = Vec::new();
        for index in at_rest.into_iter().step_by(step) {
            of_rest.push(RestingPoint {
                displacement: points.displacement[index],
                force: points.force[index],
                seconds: begin.map(|begin| (points.seconds[index] - begin).max(0.0)),
                lines: lines.iter().map(|line| line[index]).collect(),
            });
        }
        Timing {
            speeds,
            motions,
            rest,
            points: of_rest,
            has_other_rests,
        }
    }
}

/// Returns the passages of the instrument at the points `indices` of a motion, from the last point
/// before the displacement `touch` in m on.
fn passages(points: &Points, indices: impl Iterator<Item = usize>, touch: f64) -> Vec<Passage> {
    let mut passages = Vec::new();
    for index in indices {
        if points.displacement[index] <= touch {
            passages.clear();
        }
        passages.push(Passage {
            displacement: points.displacement[index],
            seconds: points.seconds[index],
        });
    }
    passages
}

/// Returns the indices of the points of a pause at which the displacement stays near its median;
/// none if most points do not, because the instrument then does not rest.
fn resting(points: &Points, pause: Range<usize>) -> Vec<usize> {
    let near = STILL * Extent::of(points.displacement.iter().copied()).width();
    let Some(middle) = median(&mut points.displacement[pause.clone()].to_vec()) else {
        return Vec::new();
    };
    let count = pause.len() as f64;
    let resting: Vec<usize> = pause
        .filter(|index| (points.displacement[*index] - middle).abs() <= near)
        .collect();
    if (resting.len() as f64) < MOST_STAY * count {
        return Vec::new();
    }
    resting
}

/// Returns true if points in contact between the points of a motion belong to a pause.
fn rests_within(points: &Points, motion: &[usize], touch: f64) -> bool {
    let (Some(&first), Some(&last)) = (motion.first(), motion.last()) else {
        return false;
    };
    let is_resting = |index: usize| points.is_still[index] && points.displacement[index] > touch;
    (first..=last).any(is_resting)
}

impl Speeds {
    /// Determines the speeds of the approach and of the retraction from the points of both motions.
    fn of(points: &Points, motions: [&[usize]; 2], touch: f64) -> Option<Self> {
        if points.seconds.is_empty() {
            return None;
        }
        let [approach, retraction] = motions.map(|motion| speed(points, motion, touch));
        Some(Speeds {
            approach: approach?,
            retraction: -retraction?,
        })
        .filter(|speeds| speeds.approach > 0.0 && speeds.retraction > 0.0)
    }
}

/// Returns the growth of the displacement over time in m/s, from the points of a motion in contact;
/// `None` for fewer than two points.
fn speed(points: &Points, motion: &[usize], touch: f64) -> Option<f64> {
    let extent = Extent::of(points.displacement.iter().copied());
    let far = extent.high - NEAR * extent.width();
    let counts = |index: &usize| (touch..far).contains(&points.displacement[*index]);
    let mut chosen: Vec<usize> = motion.iter().copied().filter(counts).collect();
    if chosen.len() < FEWEST {
        chosen = motion.to_vec();
    }
    let first = points.seconds[*chosen.first()?];
    let seconds = chosen.iter().map(|index| points.seconds[*index] - first);
    let columns = [vec![1.0; chosen.len()], seconds.collect()];
    let displacements: Vec<f64> = chosen
        .iter()
        .map(|index| points.displacement[*index])
        .collect();
    let coefficients = least_squares(&columns, &displacements)?;
    Some(coefficients[1].value).filter(|speed| speed.is_finite())
}
