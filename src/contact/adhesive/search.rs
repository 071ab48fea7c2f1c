//! Extremes and crossings of the force along a leg, exact for any number of samples.
//!
//! Between two events the force is convex; at an event, read upwards in d, it falls or stays. From the contact at two
//! indentations follow bounds of the force between them: springs that attach there are stretched, or just touch and are
//! then compressed by no more than the width of the interval. Only intervals of a grid with suitable bounds are
//! searched.

use super::edge_model::EdgeModel;
use super::run::{Ground, Run};
use crate::contact::ContactError;
use crate::contact::contact_state::{ContactState, Extreme, Sampled, lower_bound, upper_bound};
use crate::contact::grid::Grid;
use crate::contact::interval::{Interval, Piece};

/// Points of a grid from one to the next of those evaluated first.
const STRIDE: usize = 16;

/// Most times that a range is cut where the force is above zero, each time by this part at least.
const MOST_CUTS: usize = 8;
const LEAST_CUT: usize = 8;
/// Share of the way to the zero of a bound that rounding leaves certain.
const CERTAIN: f64 = 1.0 - 1e-6;

/// The runs of a leg.
pub struct Search<'a, E> {
    pub ground: Ground<'a, E>,
    pub runs: &'a [Run],
}

impl<E: EdgeModel> Search<'_, E> {
    /// The smallest or largest force on the range of a grid.
    pub fn extreme(&self, extreme: Extreme, leg: &Sampled, sorted: &mut u64) -> ContactState {
        let best_of = |best: ContactState, next: &ContactState| {
            if extreme.is_beyond(next, &best) { *next } else { best }
        };
        let is_largest = extreme == Extreme::Largest;
        // Of equals, the smallest force is taken at its first place, the largest one at its last.
        let mut best = if is_largest {
            leg.states.iter().rev().fold(leg.last(), best_of)
        } else {
            leg.states.iter().fold(leg.first(), best_of)
        };
        let chosen = leg.choose(|low, high| extreme.may_lie(low, high, &best));
        let intervals = self.intervals(leg, &chosen, sorted);
        let mut places: Vec<usize> = (0..chosen.len()).collect();
        if is_largest {
            places.reverse();
        }
        for place in places {
            let interval = &intervals[place];
            interval.search(extreme, &interval.pieces, leg.ends(chosen[place]), &mut best);
        }
        best
    }

    /// The smallest force of an unloading to separation, on the range of a grid from there to the turning point, the
    /// state at which is `turn`. Most points of the grid are left out: those where the force is certain to be above
    /// zero, and those between two neighbours of a coarser grid whose bounds exclude a smaller force.
    pub fn smallest_below(
        &self,
        turn: ContactState,
        grid: &Grid,
        sorted: &mut u64,
    ) -> Result<ContactState, ContactError> {
        let grid = grid.part(0..self.pulling(grid.points(), turn)?);
        let points = grid.points();
        let last = points.len() - 1;
        let leg = self.sample(grid.coarser(STRIDE))?;
        let smallest = leg.states.iter().map(|state| state.compression).fold(f64::INFINITY, f64::min);
        let chosen = leg.choose(|low, high| lower_bound(low, high) < smallest);
        let between = |&interval: &usize| STRIDE * interval + 1..(STRIDE * (interval + 1)).min(last);
        let fine: Vec<f64> = chosen.iter().flat_map(between).map(|index| points[index]).collect();
        if fine.is_empty() {
            return Ok(self.extreme(Extreme::Smallest, &leg, sorted));
        }
        let fine = self.sample(Grid::at(fine))?;
        Ok(self.extreme(Extreme::Smallest, &leg.merged(fine), sorted))
    }

    /// Number of points of an unloading, from separation on, beyond which the force is above zero.
    ///
    /// On the way back a contact only shrinks, and detaching springs are stretched: the force falls no faster than with
    /// the length of a contact further up. Just before separation the force is not above zero, so that the smallest
    /// force lies among these points.
    fn pulling(&self, points: &[f64], turn: ContactState) -> Result<usize, ContactError> {
        let (mut points, mut state) = (points, turn);
        for _ in 0..MOST_CUTS {
            if !(state.compression > 0.0 && state.length > 0.0) {
                break;
            }
            let crossing = state.indentation - CERTAIN * state.compression / state.length;
            let end = (points.partition_point(|&point| point < crossing) + 1).min(points.len());
            let is_worth = points.len() - end >= (points.len() / LEAST_CUT).max(1);
            points = &points[..end];
            if !is_worth {
                break;
            }
            let at = Grid::at(vec![points[end - 1]]);
            state = self.sample(at)?.states[0];
        }
        Ok(points.len())
    }

    /// Contact at those points of a grid from which [`Search::first_at_least`] proceeds.
    pub fn sample_coarsely(&self, grid: &Grid) -> Result<Sampled, ContactError> {
        self.sample(grid.coarser(STRIDE))
    }

    /// The smallest indentation of a grid, m, at which the compression is at least `wanted`.
    pub fn first_at_least(
        &self,
        grid: &Grid,
        coarse: &Sampled,
        wanted: f64,
        sorted: &mut u64,
    ) -> Result<Option<f64>, ContactError> {
        let (chosen, end) = first_intervals(coarse, wanted);
        let (Some(first), Some(last)) = (chosen.first(), chosen.last()) else { return Ok(end) };
        let end = (STRIDE * (last + 1) + 1).min(grid.points().len());
        let leg = &self.sample(grid.part(STRIDE * first..end))?;
        let (chosen, end) = first_intervals(leg, wanted);
        let intervals = self.intervals(leg, &chosen, sorted);
        let mut found = chosen.iter().zip(&intervals);
        Ok(found
            .find_map(|(&index, interval)| interval.first_of(&interval.pieces, leg.ends(index), wanted))
            .or(end))
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
            self.ground.each_span(run, low, |span, from, to| {
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

/// The intervals in which the compression may first be at least `wanted`, and the first point at which it is, m.
fn first_intervals(leg: &Sampled, wanted: f64) -> (Vec<usize>, Option<f64>) {
    let reached = leg.states.iter().find(|state| state.compression >= wanted).map(|state| state.indentation);
    // Behind the first point that has it nothing is sought.
    let last = reached.unwrap_or(f64::INFINITY);
    let may_lie = |low: &ContactState, high: &ContactState| {
        high.indentation <= last && upper_bound(low, high) >= wanted
    };
    (leg.choose(may_lie), reached)
}
