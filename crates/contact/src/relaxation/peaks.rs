//! The largest tension of the springs in a range, at any later moment.
//!
//! Apart from a term that all springs share, the tension of a spring is a linear function of the
//! factor z = e^(−t/τ) by which memories have decayed. The largest of linear functions is convex,
//! so that its values at z = 1 and z = 0 bound it in between. A tree of these two values over
//! ranges of springs finds the largest tension without looking at each spring.

use super::field::Spring;
use crate::error::ContactError;
use asperity_data::resized;
use std::ops::RangeInclusive;

/// Number of springs that a leaf of the tree has. Springs of a leaf are examined one by one.
const LEAF: usize = 16;

/// Upper bound of the tension of a set of springs, without the part of the tension that is the same
/// for all springs.
#[derive(Clone, Copy, Debug)]
pub struct Bound {
    /// Bound in m at the turn of the body, when the memories of its springs have not decayed yet.
    pub fresh: f64,
    /// Bound in m after a long time, when the memories of the springs have decayed completely.
    pub relaxed: f64,
}

impl Bound {
    pub const NONE: Self = Bound {
        fresh: f64::NEG_INFINITY,
        relaxed: f64::NEG_INFINITY,
    };

    pub fn include(&mut self, other: Bound) {
        self.fresh = self.fresh.max(other.fresh);
        self.relaxed = self.relaxed.max(other.relaxed);
    }

    /// Returns the bound of the tension in m after memories have decayed by the factor `decay`.
    #[inline]
    pub fn at(&self, decay: f64) -> f64 {
        if self.relaxed == f64::NEG_INFINITY {
            return f64::NEG_INFINITY;
        }
        self.relaxed + decay * (self.fresh - self.relaxed)
    }
}

/// A spring and its tension in m, without the part of the tension that is the same for all springs.
#[derive(Clone, Copy, Debug)]
pub struct Peak {
    pub spring: usize,
    pub tension: f64,
}

impl Peak {
    /// No spring, with a tension below the tension of any spring. A search for the largest tension
    /// can begin with it.
    pub const NONE: Self = Peak {
        spring: 0,
        tension: f64::NEG_INFINITY,
    };

    /// Returns this spring or `other`, whichever has the larger tension.
    #[inline]
    pub fn larger(self, other: Peak) -> Peak {
        if other.tension > self.tension {
            other
        } else {
            self
        }
    }
}

/// Tree of upper bounds of the tension, each over a range of springs. The tree serves to find the
/// largest tension without a look at each spring.
#[derive(Clone, Debug)]
pub struct PeakTree {
    /// Bounds of the ranges: the children of the range `k` are `2 k` and `2 k + 1`.
    bounds: Vec<Bound>,
    leaves: usize,
}

impl PeakTree {
    pub fn new(springs: usize, bound_of: impl Fn(usize) -> Bound) -> Result<Self, ContactError> {
        let leaves = springs.div_ceil(LEAF).next_power_of_two();
        let mut bounds = resized(Vec::new(), 2 * leaves, Bound::NONE)?;
        for spring in 0..springs {
            bounds[leaves + spring / LEAF].include(bound_of(spring));
        }
        for range in (1..leaves).rev() {
            let mut bound = bounds[2 * range];
            bound.include(bounds[2 * range + 1]);
            bounds[range] = bound;
        }
        Ok(PeakTree { bounds, leaves })
    }

    /// Finds the spring with the largest tension among the springs with the indices `springs`.
    /// Returns `known` if none of them has a larger tension than `known`. `tension` returns the
    /// tension in m of the spring with a given index, after memories have decayed by the factor
    /// `decay`.
    pub fn largest(
        &self,
        springs: RangeInclusive<usize>,
        known: Peak,
        decay: f64,
        tension: impl Fn(usize) -> f64,
    ) -> Peak {
        let mut search = Search {
            first: *springs.start(),
            last: *springs.end(),
            decay,
            best: known,
            tension,
        };
        if search.last - search.first < 2 * LEAF {
            search.examine(search.first..=search.last);
        } else {
            self.visit(&mut search, 1, 0, self.leaves);
        }
        search.best
    }

    /// Visits the range `range` of the tree, which has the leaves `leaf..leaf + leaves`.
    fn visit<T: Fn(usize) -> f64>(
        &self,
        search: &mut Search<T>,
        range: usize,
        leaf: usize,
        leaves: usize,
    ) {
        let first = leaf * LEAF;
        let last = (leaf + leaves) * LEAF - 1;
        if last < search.first || search.last < first {
            return;
        }
        if self.bounds[range].at(search.decay) <= search.best.tension {
            return;
        }
        if leaves == 1 {
            search.examine(first.max(search.first)..=last.min(search.last));
            return;
        }
        let half = leaves / 2;
        self.visit(search, 2 * range, leaf, half);
        self.visit(search, 2 * range + 1, leaf + half, half);
    }
}

/// A search for the spring with the largest tension.
struct Search<T> {
    first: usize,
    last: usize,
    decay: f64,
    best: Peak,
    tension: T,
}

impl<T: Fn(usize) -> f64> Search<T> {
    fn examine(&mut self, springs: RangeInclusive<usize>) {
        for spring in springs {
            let tension = (self.tension)(spring);
            if tension > self.best.tension {
                self.best = Peak { spring, tension };
            }
        }
    }
}

/// Returns the upper bound of the tension of one spring. `remaining` is the share of the
/// instantaneous modulus that remains after a long time.
pub fn bound_of(spring: Spring, remaining: f64) -> Bound {
    Bound {
        fresh: remaining * spring.gap - (1.0 - remaining) * spring.memory,
        relaxed: remaining * spring.gap,
    }
}
