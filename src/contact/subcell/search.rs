//! Extremes and crossings of the force of a leg, exact to rounding.
//!
//! Between events, where a fragment forms, lets go or becomes part of a larger one, the force is convex
//! in the indentation. On any interval it is bounded by its value at one end and the length in contact at
//! the upper one, because what joins in between was stretched or is only just touched. So intervals are
//! parted, at an event each time, until they cannot hold what is sought or hold no event.

use super::edges::SubCellEdges;
use super::sums::{Piece, Sums};

/// Halvings that tell neighbouring numbers apart wherever they lie.
const HALVINGS: usize = 128;

/// A point of the curve.
#[derive(Clone, Copy, Debug)]
pub struct Found {
    pub indentation: f64,
    pub sums: Sums,
}

/// The fragments that matter on an interval, and what they come to.
#[derive(Clone, Copy)]
pub struct Search<'a> {
    pub edges: &'a SubCellEdges,
}

impl Search<'_> {
    /// What is in contact at an indentation.
    pub fn at(&self, pieces: &[Piece], indentation: f64) -> Sums {
        let mut sums = Sums::default();
        for piece in pieces.iter().filter(|piece| piece.is_at(indentation)) {
            sums.add(self.edges, piece.node as usize, indentation);
        }
        sums
    }

    /// The compression just below `indentation`, as that of what is in contact at `low`.
    fn below(&self, pieces: &[Piece], low: f64, indentation: f64) -> f64 {
        let mut sums = Sums::default();
        for piece in pieces.iter().filter(|piece| piece.is_at(low)) {
            sums.add(self.edges, piece.node as usize, indentation);
        }
        sums.compression()
    }

    /// By how much the compression grows with the indentation, for what is in contact at `low`.
    fn stiffness(&self, pieces: &[Piece], low: f64, indentation: f64) -> f64 {
        let standing = pieces.iter().filter(|piece| piece.is_at(low));
        standing.map(|piece| self.edges.slider(piece.node as usize).stiffness(indentation)).sum()
    }

    /// Parts an interval at an event inside it, the middle one of all.
    fn middle_event(pieces: &[Piece], low: f64, high: f64) -> Option<f64> {
        let inside = |value: f64| value > low && value < high;
        let ends = pieces.iter().flat_map(|piece| [piece.from, piece.to]);
        let mut events: Vec<f64> = ends.filter(|&value| inside(value)).collect();
        if events.is_empty() {
            return None;
        }
        let middle = events.len() / 2;
        Some(*events.select_nth_unstable_by(middle, f64::total_cmp).1)
    }

    /// The pieces of an interval that matter on a part of it.
    fn part(pieces: &[Piece], low: f64, high: f64) -> Vec<Piece> {
        pieces.iter().copied().filter(|piece| piece.from <= high && piece.to > low).collect()
    }

    /// Where between `low` and `high` the convex force of what is in contact at `low` is smallest.
    fn flat(&self, pieces: &[Piece], low: f64, high: f64) -> f64 {
        if self.stiffness(pieces, low, low) >= 0.0 {
            return low;
        }
        if self.stiffness(pieces, low, high) <= 0.0 {
            return high;
        }
        bisect(low, high, |at| self.stiffness(pieces, low, at) >= 0.0)
    }

    /// Makes `best` the smallest force between `low` and `high`, both of which it knows already.
    pub fn smallest(&self, pieces: &[Piece], low: f64, high: f64, at_high: Sums, best: &mut Found) {
        let bound = at_high.compression() - (high - low) * at_high.length();
        if bound >= best.sums.compression() || low.next_up() >= high {
            return;
        }
        match Self::middle_event(pieces, low, high) {
            None => {
                let at = self.flat(pieces, low, high).min(high.next_down());
                self.take_smaller(pieces, at, best);
            }
            Some(event) => {
                let at_event = self.take_smaller(pieces, event, best);
                let upper = Self::part(pieces, event, high);
                self.smallest(&upper, event, high, at_high, best);
                let lower = Self::part(pieces, low, event);
                self.smallest(&lower, low, event, at_event, best);
            }
        }
    }

    fn take_smaller(&self, pieces: &[Piece], at: f64, best: &mut Found) -> Sums {
        let sums = self.at(pieces, at);
        if sums.compression() < best.sums.compression() {
            *best = Found { indentation: at, sums };
        }
        sums
    }

    /// Makes `best` the largest force between `low` and `high`, both of which it knows already. Where the
    /// force falls at once, the largest number before counts.
    pub fn largest(
        &self,
        pieces: &[Piece],
        low: f64,
        high: f64,
        at_low: Sums,
        at_high: Sums,
        best: &mut Found,
    ) {
        let bound = at_low.compression() + (high - low) * at_high.length();
        if bound <= best.sums.compression() || low.next_up() >= high {
            return;
        }
        match Self::middle_event(pieces, low, high) {
            None => {
                self.take_larger(pieces, high.next_down(), best);
            }
            Some(event) => {
                let at_event = self.take_larger(pieces, event, best);
                let upper = Self::part(pieces, event, high);
                self.largest(&upper, event, high, at_event, at_high, best);
                let lower = Self::part(pieces, low, event);
                self.largest(&lower, low, event, at_low, at_event, best);
            }
        }
    }

    fn take_larger(&self, pieces: &[Piece], at: f64, best: &mut Found) -> Sums {
        let sums = self.at(pieces, at);
        if sums.compression() > best.sums.compression() {
            *best = Found { indentation: at, sums };
        }
        sums
    }

    /// The smallest indentation above `low`, up to `high`, with at least this compression; at `low` it is
    /// smaller.
    pub fn first_at_least(&self, pieces: &[Piece], low: f64, high: f64, wanted: f64) -> Option<f64> {
        let (at_low, at_high) = (self.at(pieces, low), self.at(pieces, high));
        if at_low.compression() + (high - low) * at_high.length() < wanted {
            return None;
        }
        let reaches = |compression: f64| compression >= wanted;
        match Self::middle_event(pieces, low, high) {
            None if reaches(self.below(pieces, low, high)) => {
                // Convex and below it at `low`: it gets there once.
                let found = bisect(low, high, |at| reaches(self.below(pieces, low, at)));
                Some(if found < high || reaches(at_high.compression()) { found } else { high.next_down() })
            }
            None => reaches(at_high.compression()).then_some(high),
            Some(event) => {
                let lower = Self::part(pieces, low, event);
                self.first_at_least(&lower, low, event, wanted).or_else(|| {
                    let upper = Self::part(pieces, event, high);
                    self.first_at_least(&upper, event, high, wanted)
                })
            }
        }
    }

    /// The largest indentation below `high`, down to `low`, with at most this compression; at `high` it is
    /// larger.
    pub fn last_at_most(&self, pieces: &[Piece], low: f64, high: f64, wanted: f64) -> Option<f64> {
        let at_high = self.at(pieces, high);
        if at_high.compression() - (high - low) * at_high.length() > wanted || low >= high {
            return None;
        }
        let reaches = |compression: f64| compression <= wanted;
        match Self::middle_event(pieces, low, high) {
            None => {
                let flat = self.flat(pieces, low, high);
                if reaches(self.below(pieces, low, flat)) {
                    // It rises from there on: the last place where it has not passed.
                    let passes = |at: f64| !reaches(self.below(pieces, low, at));
                    return Some(if passes(high) {
                        bisect(flat, high, passes).next_down().max(flat)
                    } else {
                        flat
                    });
                }
                reaches(self.at(pieces, low).compression()).then_some(low)
            }
            Some(event) => {
                let upper = Self::part(pieces, event, high);
                self.last_at_most(&upper, event, high, wanted).or_else(|| {
                    let lower = Self::part(pieces, low, event);
                    if reaches(self.at(&lower, event).compression()) {
                        return Some(event);
                    }
                    self.last_at_most(&lower, low, event, wanted)
                })
            }
        }
    }
}

/// The smallest number above `low`, up to `high`, of which `is_past` says so; it says so of `high`.
pub fn bisect(mut low: f64, mut high: f64, is_past: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..HALVINGS {
        let middle = low + 0.5 * (high - low);
        if middle <= low || middle >= high {
            break;
        }
        if is_past(middle) { high = middle } else { low = middle }
    }
    high
}
