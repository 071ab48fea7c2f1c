//! The memories of all springs that are in contact when the body turns.

use super::field::{Field, Spring, Sums};
use super::peaks::{Bound, Peak, PeakTree, bound_of};
use crate::error::ContactError;
use asperity_data::gathered;
use std::ops::RangeInclusive;

/// The profile with the memory of each spring that was in contact when the body turned.
#[derive(Debug)]
pub struct Line {
    springs: Vec<Spring>,
    /// Integrals from the first spring to each spring.
    sums: Vec<Sums>,
    peaks: PeakTree,
    /// Share of the modulus that remains after a long time.
    pub remaining: f64,
    /// Time in s of the turn. Memories are those of this time.
    pub turned_at: f64,
}

impl Line {
    /// Creates the line. `springs` are the springs with their memories at the time `turned_at` in s.
    /// `is_in_contact` is true for the index of a spring in contact, and `remaining` the share of
    /// the modulus that remains.
    pub fn new(
        springs: Vec<Spring>,
        is_in_contact: impl Fn(usize) -> bool,
        remaining: f64,
        turned_at: f64,
    ) -> Result<Self, ContactError> {
        let peaks = PeakTree::new(springs.len(), |index| {
            if is_in_contact(index) {
                bound_of(springs[index], remaining)
            } else {
                Bound::NONE
            }
        })?;
        Ok(Line {
            sums: sums_before(&springs)?,
            springs,
            peaks,
            remaining,
            turned_at,
        })
    }

    #[inline]
    pub fn spring(&self, index: usize) -> Spring {
        self.springs[index]
    }

    /// Returns the integrals from one spring to another one.
    #[inline]
    pub fn sums_between(&self, first: usize, last: usize) -> Sums {
        self.sums[last].minus(self.sums[first])
    }

    /// Returns the spring with the largest tension among `springs` and `known`, and its tension in
    /// m apart from the term that all springs share.
    #[inline]
    pub fn peak(&self, springs: RangeInclusive<usize>, known: Peak, field: &Field) -> Peak {
        self.peaks.largest(springs, known, field.decay, |index| {
            field.own_tension(self.springs[index])
        })
    }

    /// Returns an upper bound of the tension of the springs of a range at any later moment.
    pub fn bound(&self, first: usize, last: usize) -> Bound {
        let fresh = Field {
            remaining: self.remaining,
            decay: 1.0,
            indentation: 0.0,
            memory: 0.0,
        };
        let relaxed = Field {
            decay: 0.0,
            ..fresh
        };
        Bound {
            fresh: self.peak(first..=last, Peak::NONE, &fresh).tension,
            relaxed: self.peak(first..=last, Peak::NONE, &relaxed).tension,
        }
    }
}

fn sums_before(springs: &[Spring]) -> Result<Vec<Sums>, ContactError> {
    let mut sum = Sums::default();
    let sums = springs.iter().enumerate().map(|(index, &spring)| {
        let before = springs[index.saturating_sub(1)];
        let length = if index > 0 { 1.0 } else { 0.0 };
        sum = sum.plus(Sums::of_piece(before, spring, length));
        sum
    });
    Ok(gathered(springs.len(), sums)?)
}
