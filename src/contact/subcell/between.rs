//! The contact of a line whose fragments have their edges between springs: whole cells from spring to spring, and
//! what the cells at the edges add to them.

use super::edges::Edges;
use super::search::{Interval, Step};
use crate::contact::law::{Contact, Standing};
use crate::contact::ledger::{Event, Grid, Ledger};
use crate::contact::springs::Thresholds;
use crate::contact::tally::{GapScale, Tally};
use crate::contact::{ContactError, LegContact, Work};
use crate::parallel::in_parallel;

/// From so many springs on a second thread pays.
const MANY_SPRINGS: u64 = 1 << 15;

/// Springs that sum the cells between them and know what the edges of their fragments add.
pub trait EdgeSprings: Thresholds + Sync {
    /// The edges of one fragment, or one edge.
    type Piece: Piece;

    /// Calls `see` for each piece that is one anywhere from `low` up to `high`, m.
    fn each_piece(&self, low: f64, high: f64, see: impl FnMut(Self::Piece));

    /// What joins or leaves in the chosen intervals of a grid, in any order.
    fn events(&self, ledger: &Ledger, chosen: &[bool]) -> Vec<Event>;

    /// What is in contact along a grid, and what all edges add at each of its points.
    fn along(&self, grid: Grid) -> (Ledger, Vec<Edges>);

    /// The same, and ∫ (c − θ)² dx over what joins or leaves above `low` and up to the end of the grid, θ
    /// being the indentation at which it does so, in cells times m².
    fn along_with_stretches(&self, grid: Grid, low: f64) -> (Ledger, Vec<Edges>, f64);

    /// Whether a second thread pays.
    fn is_long(&self) -> bool {
        self.count() >= MANY_SPRINGS
    }

    /// Whether the force never falls as the indentation grows.
    fn is_monotone(&self) -> bool;
}

/// What a fragment adds to its whole cells while it is one.
pub trait Piece: Copy + Send {
    /// The indentation from which on it is one, m.
    fn from(&self) -> f64;
    /// The indentation up to which, not itself, it is one, m.
    fn to(&self) -> f64;
    /// What it adds at an indentation.
    fn edges(&self, indentation: f64) -> Edges;
    /// By how much the compression it adds grows with the indentation, in cells. With its whole cells it only
    /// grows: between events the force is convex.
    fn stiffness(&self, indentation: f64) -> f64;

    /// Whether it is one at an indentation.
    fn is_at(&self, indentation: f64) -> bool {
        self.from() <= indentation && indentation < self.to()
    }
}

/// Springs with edges between them.
pub struct BetweenSprings<T>(pub T);

/// What is in contact along a grid.
pub struct BetweenLeg {
    ledger: Ledger,
    /// At each of its points.
    standings: Vec<Standing>,
}

impl Standing {
    /// What stands so at an indentation, whole cells and edges.
    pub(super) fn of_cells(indentation: f64, tally: Tally, edges: Edges, scale: &GapScale) -> Self {
        Standing {
            indentation,
            springs: tally.springs,
            fragments: tally.fragments,
            length: tally.cells() as f64 + edges.length,
            compression: tally.compression_of_cells(indentation, scale) + edges.compression,
        }
    }
}

impl BetweenLeg {
    fn new(ledger: Ledger, edges: Vec<Edges>, scale: &GapScale) -> Self {
        let points = ledger.grid.points().iter().zip(&ledger.tallies).zip(edges);
        let standings =
            points.map(|((&point, &tally), edges)| Standing::of_cells(point, tally, edges, scale)).collect();
        BetweenLeg { ledger, standings }
    }

    /// The intervals of the grid of which the values at their ends say so.
    fn choose(&self, may_lie: impl Fn(&Standing, &Standing) -> bool) -> Vec<usize> {
        let ends = self.standings.windows(2).enumerate();
        ends.filter(|(_, ends)| may_lie(&ends[0], &ends[1])).map(|(index, _)| index).collect()
    }

    /// What stands at the ends of an interval.
    fn ends(&self, interval: usize) -> (&Standing, &Standing) {
        (&self.standings[interval], &self.standings[interval + 1])
    }
}

impl<T: EdgeSprings> BetweenSprings<T> {
    /// What happens in each of these intervals, which ascend.
    fn intervals(&self, leg: &BetweenLeg, chosen: &[usize], sorted: &mut u64) -> Vec<Interval<T::Piece>> {
        let points = leg.ledger.grid.points();
        let mut marks = vec![None; leg.ledger.intervals()];
        let mut intervals: Vec<_> = chosen
            .iter()
            .enumerate()
            .map(|(place, &index)| {
                marks[index] = Some(place);
                let tally = leg.ledger.tallies[index];
                Interval::new(*self.0.scale(), Step { threshold: points[index], tally })
            })
            .collect();
        let (Some(&first), Some(&last)) = (chosen.first(), chosen.last()) else { return intervals };
        let (low, high) = (points[first], points[last + 1]);
        let pieces = || {
            let mut pieces = vec![Vec::new(); chosen.len()];
            self.0.each_piece(low, high, |piece| {
                // Intervals that reach from below its end to its beginning and above.
                let above = |value: f64| leg.ledger.grid.first_at_least(value.min(high));
                let from = above(piece.from()).saturating_sub(1).max(first);
                for place in marks[from..above(piece.to()).min(last + 1)].iter().flatten() {
                    pieces[*place].push(piece);
                }
            });
            pieces
        };
        let is_chosen: Vec<bool> = marks.iter().map(Option::is_some).collect();
        let (pieces, events) =
            in_parallel(self.0.is_long(), pieces, || self.0.events(&leg.ledger, &is_chosen));
        for (interval, pieces) in intervals.iter_mut().zip(pieces) {
            interval.pieces = pieces;
        }
        for event in events {
            if let Some(place) = marks[event.interval] {
                intervals[place].joins(event.threshold, event.joins);
                *sorted += 1;
            }
        }
        intervals.iter_mut().for_each(Interval::sort);
        intervals
    }
}

/// A bound below any force inside an interval: what joins there is stretched, or just touches and is
/// compressed by no more than the interval is wide.
fn lower_bound(low: &Standing, high: &Standing) -> f64 {
    let rise = (high.indentation - low.indentation) * high.length;
    high.compression - rise - slack(low, high, rise)
}

/// A bound above.
fn upper_bound(low: &Standing, high: &Standing) -> f64 {
    let rise = (high.indentation - low.indentation) * high.length;
    low.compression + rise + slack(low, high, rise)
}

/// What rounding may have done to a bound.
fn slack(low: &Standing, high: &Standing, rise: f64) -> f64 {
    8.0 * f64::EPSILON * (low.compression.abs() + high.compression.abs() + rise)
}

impl<T: EdgeSprings> Contact for BetweenSprings<T> {
    type Leg = BetweenLeg;

    // Fewer than for whole springs: each fragment is evaluated at each of their ends.
    const SEARCH_INTERVALS: usize = 256;

    fn count(&self) -> u64 {
        self.0.count()
    }

    fn load(&mut self, from: Option<f64>, work: &mut Work) -> f64 {
        self.0.load(from, work)
    }

    fn unload(&mut self, from: f64, work: &mut Work) -> f64 {
        self.0.unload(from, work)
    }

    fn sample(&self, grid: Grid) -> BetweenLeg {
        let (ledger, edges) = self.0.along(grid);
        BetweenLeg::new(ledger, edges, self.0.scale())
    }

    fn sample_joins(&self, grid: Grid, separated: bool) -> (BetweenLeg, f64) {
        // What touches at once when the contact forms joins at the first point itself.
        let above = if separated { f64::NEG_INFINITY } else { grid.points()[0] };
        let (ledger, edges, squared_stretch) = self.0.along_with_stretches(grid, above);
        (BetweenLeg::new(ledger, edges, self.0.scale()), squared_stretch)
    }

    fn sample_leaves(&self, grid: Grid, separates: bool) -> (BetweenLeg, f64) {
        // What is held to the last point leaves just below it.
        self.sample_joins(grid, separates)
    }

    fn grid<'l>(&self, leg: &'l BetweenLeg) -> &'l Grid {
        &leg.ledger.grid
    }

    fn at(&self, leg: &BetweenLeg, index: usize) -> Standing {
        leg.standings[index]
    }

    fn smallest(&self, leg: &BetweenLeg, sorted: &mut u64) -> Standing {
        let first = leg.standings[0];
        if self.0.is_monotone() {
            return first;
        }
        let smaller =
            |best: Standing, next: &Standing| if next.compression < best.compression { *next } else { best };
        let mut best = leg.standings.iter().fold(first, smaller);
        let chosen = leg.choose(|low, high| lower_bound(low, high) < best.compression);
        let intervals = self.intervals(leg, &chosen, sorted);
        for (&index, interval) in chosen.iter().zip(&intervals) {
            interval.smallest(leg.ends(index), &lower_bound, &mut best);
        }
        best
    }

    fn largest(&self, leg: &BetweenLeg, sorted: &mut u64) -> Standing {
        let last = leg.standings[leg.standings.len() - 1];
        if self.0.is_monotone() {
            return last;
        }
        let larger =
            |best: Standing, next: &Standing| if next.compression > best.compression { *next } else { best };
        let mut best = leg.standings.iter().rev().fold(last, larger);
        let chosen = leg.choose(|low, high| upper_bound(low, high) > best.compression);
        let intervals = self.intervals(leg, &chosen, sorted);
        for (&index, interval) in chosen.iter().zip(&intervals).rev() {
            interval.largest(leg.ends(index), &upper_bound, &mut best);
        }
        best
    }

    fn first_at_least(&self, leg: &BetweenLeg, wanted: f64, sorted: &mut u64) -> Option<f64> {
        // Behind the first point that has it nothing is sought.
        let reached = leg.standings.iter().position(|standing| standing.compression >= wanted);
        let reached = reached.map(|index| leg.standings[index].indentation);
        if reached == Some(leg.standings[0].indentation) {
            return reached;
        }
        let end = reached.unwrap_or(f64::INFINITY);
        let monotone = self.0.is_monotone();
        let chosen = leg.choose(|low, high| {
            high.indentation <= end
                && (if monotone { high.compression } else { upper_bound(low, high) }) >= wanted
        });
        let intervals = self.intervals(leg, &chosen, sorted);
        let mut ends = chosen.iter().map(|&index| leg.ends(index));
        let find = |interval: &Interval<T::Piece>| {
            ends.next().and_then(|ends| interval.first_at_least(ends, &upper_bound, wanted))
        };
        intervals.iter().find_map(find).or(reached)
    }

    fn last_at_most(&self, leg: &BetweenLeg, wanted: f64, sorted: &mut u64) -> Option<f64> {
        let reached = leg.standings.iter().rposition(|standing| standing.compression <= wanted);
        let reached = reached.map(|index| leg.standings[index].indentation);
        if reached == leg.standings.last().map(|last| last.indentation) {
            return reached;
        }
        let end = reached.unwrap_or(f64::NEG_INFINITY);
        let monotone = self.0.is_monotone();
        let chosen = leg.choose(|low, high| {
            low.indentation >= end
                && (if monotone { low.compression } else { lower_bound(low, high) }) <= wanted
        });
        let intervals = self.intervals(leg, &chosen, sorted);
        let mut ends = chosen.iter().rev().map(|&index| leg.ends(index));
        let find = |interval: &Interval<T::Piece>| {
            ends.next().and_then(|ends| interval.last_at_most(ends, &lower_bound, wanted))
        };
        intervals.iter().rev().find_map(find).or(reached)
    }

    fn beyond(&self, leg: &BetweenLeg, wanted: f64) -> Option<f64> {
        let end = leg.standings.last()?;
        Some(end.indentation + (wanted - end.compression) / end.length)
    }

    fn thresholds_along_line(&self, out: &mut Vec<f64>) {
        self.0.thresholds_along_line(out);
    }

    fn copy_leg(&self, copy: &mut LegContact) -> Result<(), ContactError> {
        self.0.copy_leg(copy)
    }

    fn fragments(&self, indentation: f64) -> Vec<(usize, usize)> {
        self.0.fragments(indentation)
    }
}
