//! Preloads at equal distances.

use std::ops::RangeInclusive;

/// Numbers of preloads.
pub const PRELOADS: RangeInclusive<usize> = 2..=512;

/// Preloads at equal distances, N.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Preloads {
    from: f64,
    to: f64,
    count: usize,
}

impl Preloads {
    /// Preloads between two forces, N, the first at least 0 and below the second; `None` for other forces, or a number
    /// outside of [`PRELOADS`].
    #[must_use]
    pub fn new(from: f64, to: f64, count: usize) -> Option<Self> {
        let is_allowed = from >= 0.0 && to > from && to.is_finite() && PRELOADS.contains(&count);
        is_allowed.then_some(Preloads { from, to, count })
    }

    /// Smallest and largest preload, N.
    #[must_use]
    pub fn ends(&self) -> (f64, f64) {
        (self.from, self.to)
    }

    /// The forces, N, in ascending order.
    #[must_use]
    pub fn forces(&self) -> Vec<f64> {
        let last = (self.count - 1) as f64;
        let at = |index: usize| (self.from + (self.to - self.from) * (index as f64 / last)).min(self.to);
        (0..self.count).map(at).collect()
    }

    /// Name in a table of results.
    pub(super) fn name(&self) -> String {
        format!("{} preloads from {:?} to {:?} N", self.count, self.from, self.to)
    }

    /// Preloads of this name.
    pub(super) fn from_name(name: &str) -> Option<Self> {
        let (count, range) = name.strip_suffix(" N")?.split_once(" preloads from ")?;
        let (from, to) = range.split_once(" to ")?;
        Preloads::new(from.parse().ok()?, to.parse().ok()?, count.parse().ok()?)
    }
}
