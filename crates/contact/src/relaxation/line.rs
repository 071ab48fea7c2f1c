//! The memories of all springs that are in contact when the body turns.

use super::field::{Field, Spring, Sums};
use super::peaks::{Bound, Peak, PeakTree, bound_of};
use crate::error::ContactError;
use asperity_data::gathered;
use std::ops::RangeInclusive;

/// The profile of a body that has turned from loading to unloading. The profile has the gap of each
/// spring, and the memory of each spring that was in contact at the turn.
#[derive(Debug)]
pub struct Line {
    springs: Vec<Spring>,
    /// Integrals from the first spring to each spring.
    sums: Vec<Sums>,
    peaks: PeakTree,
    /// Share of the instantaneous modulus that remains after a long time.
    pub remaining: f64,
    /// Time in s at which the body turned. The memories are those at this time.
    pub turned_at: f64,
}

impl Line {
    /// Creates the profile with its memories. `springs` has the gap of each spring, and its memory
    /// at the time `turned_at` in s. `is_in_contact` returns true for the index of a spring in
    /// contact. `remaining` is the share of the instantaneous modulus that remains after a long
    /// time.
    ///
    /// # Errors
    /// Returns [`ContactError::OutOfMemory`] if an array does not fit into memory.
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

    /// Returns the integrals over the profile between the springs with the indices `first` and
    /// `last`.
    #[inline]
    pub fn sums_between(&self, first: usize, last: usize) -> Sums {
        self.sums[last].minus(self.sums[first])
    }

    /// Returns the spring with the largest tension among the springs with the indices `springs` and
    /// the spring `known`. The returned tension in m lacks the part that is the same for all
    /// springs.
    #[inline]
    pub fn peak(&self, springs: RangeInclusive<usize>, known: Peak, field: &Field) -> Peak {
        self.peaks.largest(springs, known, field.decay, |index| {
            field.own_tension(self.springs[index])
        })
    }

    /// Returns an upper bound of the tension of the springs from `first` to `last`, which holds at
    /// any moment after the turn.
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
