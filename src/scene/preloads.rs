//! Equally spaced preloads.

use std::ops::RangeInclusive;

/// Numbers of preloads.
pub const PRELOADS: RangeInclusive<usize> = 2..=512;

/// Equally spaced preloads, N.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Preloads {
    from: f64,
    to: f64,
    count: usize,
}

impl Preloads {
    /// Preloads between two forces, N, the first at least 0 and below the second; `None` for other forces, or a
    /// number outside [`PRELOADS`].
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
        format!("{}{PRELOADS_OF}{}", self.count, force_range(self.ends()))
    }

    /// Preloads of this name.
    pub(super) fn from_name(name: &str) -> Option<Self> {
        let (count, range) = name.split_once(PRELOADS_OF)?;
        let (from, to) = parse_force_range(range)?;
        Preloads::new(from, to, count.parse().ok()?)
    }
}

/// Words after a number of preloads.
const PRELOADS_OF: &str = " preloads";

/// Range of forces, N, in the name of a table's content.
pub(super) fn force_range((from, to): (f64, f64)) -> String {
    format!(" from {from:?} to {to:?} N")
}

/// Forces, N, of such a range.
pub(super) fn parse_force_range(text: &str) -> Option<(f64, f64)> {
    let (from, to) = text.strip_prefix(" from ")?.strip_suffix(" N")?.split_once(" to ")?;
    Some((from.parse().ok()?, to.parse().ok()?))
}
