//! The contact of a line whose fragments have their edges between springs: whole cells from spring to spring, and
//! what the cells at the edges add to them.

use super::edges::Edges;
use super::search::{Interval, Step};
use crate::contact::law::{Contact, Standing};
use crate::contact::ledger::{Grid, Ledger};
use crate::contact::springs::Thresholds;
use crate::contact::tally::Tally;
use crate::contact::{ContactError, LegContact, Work};

/// Springs that sum the cells between them and know what the edges of their fragments add.
pub trait EdgeSprings: Thresholds {
    /// The edges of one fragment, or one edge.
    type Piece: Piece;

    /// Calls `see` for each piece that is one anywhere from `low` up to `high`, m.
    fn each_piece(&self, low: f64, high: f64, see: impl FnMut(Self::Piece));

    /// What all edges add at each point of a grid.
    fn edges_along(&self, grid: &Grid) -> Vec<Edges>;

    /// The same, and ∫ (c − θ)² dx over what joins or leaves above `low` and up to the end of the grid, θ
    /// being the indentation at which it does so, in cells times m².
    fn edges_and_stretches(&self, grid: &Grid, low: f64) -> (Vec<Edges>, f64);

    /// Whether the force never falls as the indentation grows.
    fn is_monotone(&self) -> bool;
}

/// What a fragment adds to its whole cells while it is one.
pub trait Piece: Copy {
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
    edges: Vec<Edges>,
}

impl<T: EdgeSprings> BetweenSprings<T> {
    fn standing(&self, indentation: f64, tally: Tally, edges: Edges) -> Standing {
        Standing {
            indentation,
            springs: tally.springs,
            fragments: tally.fragments,
            length: tally.cells() as f64 + edges.length,
            compression: tally.compression_of_cells(indentation, self.0.scale()) + edges.compression,
        }
    }

    /// The intervals of the grid of which the values at their ends say so.
    fn choose(&self, leg: &BetweenLeg, may_lie: impl Fn(&Standing, &Standing) -> bool) -> Vec<usize> {
        let intervals = 0..leg.ledger.intervals();
        intervals.filter(|&index| may_lie(&self.at(leg, index), &self.at(leg, index + 1))).collect()
    }

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
        let is_chosen: Vec<bool> = marks.iter().map(Option::is_some).collect();
        for event in leg.ledger.events(&self.0, &is_chosen) {
            if let Some(place) = marks[event.interval] {
                intervals[place].joins(event.threshold, event.joins);
                *sorted += 1;
            }
        }
        let (low, high) = (points[first], points[last + 1]);
        self.0.each_piece(low, high, |piece| {
            // Intervals that reach from below its end to its beginning and above.
            let above = |value: f64| leg.ledger.grid.first_at_least(value.min(high));
            for mark in
                &marks[above(piece.from()).saturating_sub(1).max(first)..above(piece.to()).min(last + 1)]
            {
                if let Some(place) = *mark {
                    intervals[place].pieces.push(piece);
                }
            }
        });
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
        let edges = self.0.edges_along(&grid);
        BetweenLeg { ledger: Ledger::new(&self.0, grid), edges }
    }

    fn sample_joins(&self, grid: Grid, separated: bool) -> (BetweenLeg, f64) {
        // What touches at once when the contact forms joins at the first point itself.
        let above = if separated { f64::NEG_INFINITY } else { grid.points()[0] };
        let (edges, squared_stretch) = self.0.edges_and_stretches(&grid, above);
        (BetweenLeg { ledger: Ledger::new(&self.0, grid), edges }, squared_stretch)
    }

    fn sample_leaves(&self, grid: Grid, separates: bool) -> (BetweenLeg, f64) {
        // What is held to the last point leaves just below it.
        self.sample_joins(grid, separates)
    }

    fn grid<'l>(&self, leg: &'l BetweenLeg) -> &'l Grid {
        &leg.ledger.grid
    }

    fn at(&self, leg: &BetweenLeg, index: usize) -> Standing {
        self.standing(leg.ledger.grid.points()[index], leg.ledger.tallies[index], leg.edges[index])
    }

    fn smallest(&self, leg: &BetweenLeg, sorted: &mut u64) -> Standing {
        let points = (1..leg.edges.len()).map(|index| self.at(leg, index));
        let first = self.at(leg, 0);
        if self.0.is_monotone() {
            return first;
        }
        let smaller =
            |best: Standing, next: Standing| if next.compression < best.compression { next } else { best };
        let mut best = points.fold(first, smaller);
        let chosen = self.choose(leg, |low, high| lower_bound(low, high) < best.compression);
        let intervals = self.intervals(leg, &chosen, sorted);
        for (&index, interval) in chosen.iter().zip(&intervals) {
            interval.smallest((&self.at(leg, index), &self.at(leg, index + 1)), &lower_bound, &mut best);
        }
        best
    }

    fn largest(&self, leg: &BetweenLeg, sorted: &mut u64) -> Standing {
        let last = self.at(leg, leg.edges.len() - 1);
        if self.0.is_monotone() {
            return last;
        }
        let larger =
            |best: Standing, next: Standing| if next.compression > best.compression { next } else { best };
        let mut best = (0..leg.edges.len() - 1).rev().map(|index| self.at(leg, index)).fold(last, larger);
        let chosen = self.choose(leg, |low, high| upper_bound(low, high) > best.compression);
        let intervals = self.intervals(leg, &chosen, sorted);
        for (&index, interval) in chosen.iter().zip(&intervals).rev() {
            interval.largest((&self.at(leg, index), &self.at(leg, index + 1)), &upper_bound, &mut best);
        }
        best
    }

    fn first_at_least(&self, leg: &BetweenLeg, wanted: f64, sorted: &mut u64) -> Option<f64> {
        if self.at(leg, 0).compression >= wanted {
            return Some(leg.ledger.grid.points()[0]);
        }
        // Behind the first point that has it nothing is sought.
        let reached = (0..leg.edges.len()).find(|&index| self.at(leg, index).compression >= wanted);
        let end = reached.map_or(f64::INFINITY, |index| leg.ledger.grid.points()[index]);
        let monotone = self.0.is_monotone();
        let chosen = self.choose(leg, |low, high| {
            high.indentation <= end
                && (if monotone { high.compression } else { upper_bound(low, high) }) >= wanted
        });
        let intervals = self.intervals(leg, &chosen, sorted);
        let mut ends = chosen.iter().map(|&index| (self.at(leg, index), self.at(leg, index + 1)));
        let find = |interval: &Interval<T::Piece>| {
            ends.next().and_then(|(low, high)| interval.first_at_least((&low, &high), &upper_bound, wanted))
        };
        intervals.iter().find_map(find).or(reached.map(|index| leg.ledger.grid.points()[index]))
    }

    fn last_at_most(&self, leg: &BetweenLeg, wanted: f64, sorted: &mut u64) -> Option<f64> {
        let points = leg.ledger.grid.points();
        let last = leg.edges.len() - 1;
        if self.at(leg, last).compression <= wanted {
            return Some(points[last]);
        }
        let reached = (0..last).rev().find(|&index| self.at(leg, index).compression <= wanted);
        let end = reached.map_or(f64::NEG_INFINITY, |index| points[index]);
        let monotone = self.0.is_monotone();
        let chosen = self.choose(leg, |low, high| {
            low.indentation >= end
                && (if monotone { low.compression } else { lower_bound(low, high) }) <= wanted
        });
        let intervals = self.intervals(leg, &chosen, sorted);
        let mut ends = chosen.iter().map(|&index| (self.at(leg, index), self.at(leg, index + 1))).rev();
        let find = |interval: &Interval<T::Piece>| {
            ends.next().and_then(|(low, high)| interval.last_at_most((&low, &high), &lower_bound, wanted))
        };
        intervals.iter().rev().find_map(find).or(reached.map(|index| points[index]))
    }

    fn beyond(&self, leg: &BetweenLeg, wanted: f64) -> Option<f64> {
        let end = self.at(leg, leg.edges.len() - 1);
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
