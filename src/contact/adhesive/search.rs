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

/// The runs of a leg.
pub struct Search<'a, E> {
    pub ground: Ground<'a, E>,
    pub runs: &'a [Run],
}

impl<E: EdgeModel> Search<'_, E> {
    /// The smallest or largest force on the range of a grid.
    pub fn extreme(&self, extreme: Extreme, leg: &Sampled, sorted: &mut u64) -> ContactState {
        let mut best = extreme.of(leg);
        let chosen = leg.choose(|low, high| extreme.may_lie(low, high, &best));
        for (interval, &place) in self.intervals(leg, &chosen, sorted).iter().zip(&chosen) {
            interval.search(extreme, &interval.pieces, leg.ends(place), &mut best);
        }
        best
    }

    /// The smallest force on the range of a grid. Most points of the grid are left out: those between two neighbours of a
    /// coarser grid whose bounds exclude a smaller force.
    pub fn smallest(&self, grid: &Grid, sorted: &mut u64) -> Result<ContactState, ContactError> {
        let coarse = self.sample(grid.coarser(STRIDE))?;
        let smallest = coarse.states.iter().map(|state| state.compression).fold(f64::INFINITY, f64::min);
        let leg = self.refined(grid, coarse, |low, high| lower_bound(low, high) < smallest)?;
        Ok(self.extreme(Extreme::Smallest, &leg, sorted))
    }

    /// The smallest indentation of a grid, m, at which the compression is at least `wanted`.
    pub fn first_at_least(
        &self,
        grid: &Grid,
        wanted: f64,
        sorted: &mut u64,
    ) -> Result<Option<f64>, ContactError> {
        let coarse = self.sample(grid.coarser(STRIDE))?;
        let reached = |leg: &Sampled| {
            let reached = leg.states.iter().find(|state| state.compression >= wanted);
            reached.map(|state| state.indentation)
        };
        // Behind the first point that has it nothing is sought.
        let may_lie = |end: Option<f64>| {
            let last = end.unwrap_or(f64::INFINITY);
            move |low: &ContactState, high: &ContactState| {
                high.indentation <= last && upper_bound(low, high) >= wanted
            }
        };
        let coarse_end = reached(&coarse);
        let leg = self.refined(grid, coarse, may_lie(coarse_end))?;
        let end = reached(&leg);
        let chosen = leg.choose(may_lie(end));
        let intervals = self.intervals(&leg, &chosen, sorted);
        let mut found = chosen.iter().zip(&intervals);
        let found =
            found.find_map(|(&index, interval)| interval.first_of(&interval.pieces, leg.ends(index), wanted));
        Ok(found.or(end))
    }

    /// Adds those points of a grid to a coarser one that lie in intervals whose contact at both ends passes `may_lie`.
    fn refined(
        &self,
        grid: &Grid,
        coarse: Sampled,
        may_lie: impl Fn(&ContactState, &ContactState) -> bool,
    ) -> Result<Sampled, ContactError> {
        let (points, last) = (grid.points(), grid.points().len() - 1);
        let between = |interval: usize| STRIDE * interval + 1..(STRIDE * (interval + 1)).min(last);
        let chosen = coarse.choose(may_lie).into_iter();
        let fine: Vec<f64> = chosen.flat_map(between).map(|index| points[index]).collect();
        if fine.is_empty() { Ok(coarse) } else { Ok(coarse.merged(self.sample(Grid::at(fine))?)) }
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
    fn intervals(&self, leg: &Sampled, chosen: &[usize], sorted: &mut u64) -> Vec<Interval> {
        let points = leg.grid.points();
        let mut marks = vec![None; points.len() - 1];
        let mut intervals: Vec<_> = chosen
            .iter()
            .enumerate()
            .map(|(place, &index)| {
                marks[index] = Some(place);
                Interval::new(E::SLIDES, self.ground.tree.scale(), points[index], leg.totals[index])
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
