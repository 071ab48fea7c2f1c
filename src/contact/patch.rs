//! Contact patches.

use serde::Serialize;
use std::ops::Range;

/// A contact patch: springs in contact without a gap between them. In JSON the array `[first, last]`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(into = "(usize, usize)")]
pub struct Patch {
    /// Index of the leftmost spring.
    pub first: usize,
    /// Index of the rightmost spring.
    pub last: usize,
}

impl Patch {
    /// Returns the indices of the springs.
    pub fn springs(self) -> Range<usize> {
        self.first..self.last + 1
    }

    /// Returns the spring in the middle.
    pub fn middle(self) -> usize {
        self.first + (self.last - self.first) / 2
    }

    /// Returns the patches of a line that is in contact or not spring by spring, from left to right.
    pub fn of_springs(contact: impl Iterator<Item = bool>) -> Vec<Patch> {
        let mut patches: Vec<Patch> = Vec::new();
        for spring in contact.enumerate().filter_map(|(spring, contact)| contact.then_some(spring)) {
            match patches.last_mut() {
                Some(patch) if patch.last + 1 == spring => patch.last = spring,
                _ => patches.push(Patch { first: spring, last: spring }),
            }
        }
        patches
    }
}

impl From<Patch> for (usize, usize) {
    fn from(patch: Patch) -> (usize, usize) {
        (patch.first, patch.last)
    }
}
