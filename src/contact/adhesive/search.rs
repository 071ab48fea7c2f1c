//! Extremes and crossings of the force along a leg, exact whatever the number of samples.
//!
//! Between two events the force is convex; at an event, read upwards in d, it falls or stays. From the contact at two
//! indentations follow bounds of the force between them: what attaches there is stretched, or just touches and is then
//! compressed by no more than the interval is wide. Only intervals of a grid whose bounds allow it are looked into.

use super::edge_model::EdgeModel;
use super::run::{Ground, Run};
use crate::contact::ContactError;
use crate::contact::contact_model::{ContactState, Sampled};
use crate::contact::grid::Grid;
use crate::contact::interval::{Interval, Piece, lower_bound, upper_bound};

/// Points of a grid from one to the next of those that are looked at first.
const STRIDE: usize = 16;

/// A leg that is searched.
pub struct Search<'a, E> {
    pub ground: Ground<'a, E>,
    pub runs: &'a [Run],
    pub unloading: bool,
}

impl<E: EdgeModel> Search<'_, E> {
    /// The smallest force on the range of a grid.
    pub fn smallest(&self, leg: &Sampled, sorted: &mut u64) -> ContactState {
        let smaller = |best: ContactState, next: &ContactState| {
            if next.compression < best.compression { *next } else { best }
        };
        let mut best = leg.states.iter().fold(leg.states[0], smaller);
        let chosen = leg.choose(|low, high| lower_bound(low, high) < best.compression);
        for (&index, interval) in chosen.iter().zip(&self.intervals(leg, &chosen, sorted)) {
            interval.smallest(&interval.pieces, leg.ends(index), &mut best);
        }
        best
    }

    /// The smallest force on the range of a grid, most points of which are left out: those between two neighbours of a
    /// coarser grid whose bounds exclude a smaller force.
    pub fn smallest_on(&self, grid: &Grid, sorted: &mut u64) -> Result<ContactState, ContactError> {
        let points = grid.points();
        let last = points.len() - 1;
        let coarse = (0..last).step_by(STRIDE).chain([last]).map(|index| points[index]).collect();
        let leg = self.ground.sample(self.runs, self.unloading, Grid::at(coarse))?;
        let smallest = leg.states.iter().map(|state| state.compression).fold(f64::INFINITY, f64::min);
        let chosen = leg.choose(|low, high| lower_bound(low, high) < smallest);
        let between = |&interval: &usize| STRIDE * interval + 1..(STRIDE * (interval + 1)).min(last);
        let fine: Vec<f64> = chosen.iter().flat_map(between).map(|index| points[index]).collect();
        if fine.is_empty() {
            return Ok(self.smallest(&leg, sorted));
        }
        let fine = self.ground.sample(self.runs, self.unloading, Grid::at(fine))?;
        Ok(self.smallest(&leg.merged(fine), sorted))
    }

    /// The largest force on the range of a grid.
    pub fn largest(&self, leg: &Sampled, sorted: &mut u64) -> ContactState {
        let last = leg.states[leg.states.len() - 1];
        let larger = |best: ContactState, next: &ContactState| {
            if next.compression > best.compression { *next } else { best }
        };
        let mut best = leg.states.iter().rev().fold(last, larger);
        let chosen = leg.choose(|low, high| upper_bound(low, high) > best.compression);
        for (&index, interval) in chosen.iter().zip(&self.intervals(leg, &chosen, sorted)).rev() {
            interval.largest(&interval.pieces, leg.ends(index), &mut best);
        }
        best
    }

    /// The smallest indentation of a grid, m, at which the compression is at least `wanted`.
    pub fn first_at_least(&self, leg: &Sampled, wanted: f64, sorted: &mut u64) -> Option<f64> {
        // Behind the first point that has it nothing is sought.
        let reached = leg.states.iter().position(|state| state.compression >= wanted);
        if reached == Some(0) {
            return Some(leg.states[0].indentation);
        }
        let end = reached.map(|index| leg.states[index].indentation);
        let last = end.unwrap_or(f64::INFINITY);
        let chosen = leg.choose(|low, high| high.indentation <= last && upper_bound(low, high) >= wanted);
        let intervals = self.intervals(leg, &chosen, sorted);
        let mut found = chosen.iter().zip(&intervals);
        found
            .find_map(|(&index, interval)| interval.first_of(&interval.pieces, leg.ends(index), wanted))
            .or(end)
    }

    /// The largest indentation of a grid, m, at which the compression is at most `wanted`.
    pub fn last_at_most(&self, leg: &Sampled, wanted: f64, sorted: &mut u64) -> Option<f64> {
        let reached = leg.states.iter().rposition(|state| state.compression <= wanted);
        let start = reached.map(|index| leg.states[index].indentation);
        if reached == Some(leg.states.len() - 1) {
            return start;
        }
        let first = start.unwrap_or(f64::NEG_INFINITY);
        let chosen = leg.choose(|low, high| low.indentation >= first && lower_bound(low, high) <= wanted);
        let intervals = self.intervals(leg, &chosen, sorted);
        let mut found = chosen.iter().zip(&intervals).rev();
        found
            .find_map(|(&index, interval)| interval.last_of(&interval.pieces, leg.ends(index), wanted))
            .or(start)
    }

    /// Events in each of these ascending intervals.
    fn intervals(&self, leg: &Sampled, chosen: &[usize], sorted: &mut u64) -> Vec<Interval<E>> {
        let points = leg.grid.points();
        let mut marks = vec![None; points.len() - 1];
        let mut intervals: Vec<_> = chosen
            .iter()
            .enumerate()
            .map(|(place, &index)| {
                marks[index] = Some(place);
                let (edges, scale) = (self.ground.edges, self.ground.tree.scale());
                Interval::new(edges, scale, points[index], leg.totals[index])
            })
            .collect();
        let (Some(&first), Some(&last)) = (chosen.first(), chosen.last()) else { return intervals };
        let (low, high) = (points[first], points[last + 1]);
        let above = |value: f64| leg.grid.first_at_least(value.min(high));
        for run in self.runs.iter().filter(|run| run.from <= high && run.to > low) {
            let range = above(run.from).saturating_sub(1).max(first)..above(run.to).min(last + 1);
            if marks[range].iter().all(Option::is_none) {
                continue;
            }
            self.ground.each_span(run, self.unloading, |span, from, to| {
                if from > high || to <= low {
                    return from > high;
                }
                let totals = self.ground.totals(span);
                for (threshold, totals) in [(from, totals), (to, -totals)] {
                    if threshold > low
                        && threshold <= high
                        && let Some(place) = marks[above(threshold) - 1]
                    {
                        intervals[place].add(threshold, totals);
                        *sorted += 1;
                    }
                }
                if E::SLIDES {
                    let piece = Piece { slider: self.ground.slider(run, span), from, to };
                    // Intervals from below its beginning to above its end.
                    let from = above(from).saturating_sub(1).max(first);
                    for place in marks[from..above(to).min(last + 1)].iter().flatten() {
                        intervals[*place].pieces.push(piece);
                    }
                }
                false
            });
        }
        intervals.iter_mut().for_each(Interval::sort);
        intervals
    }
}
