//! How the length of a fragment is read, and so when it grows and when it lets go.

use super::tally::GapScale;
use super::{HessRule, SpringTree};

/// Thresholds of a node of the tree: the one place where the length of a fragment enters.
///
/// A node's `holds_to` must not exceed its gap, nor the `grows_at` by which a part of it took it in by
/// more than one rounding: what has just joined must not leave at once.
pub trait EdgeRule {
    /// Smallest indentation, m, at which the fragment that fills the subtree `fragment` takes in the
    /// spring of its parent `wall`.
    fn grows_at(&self, tree: &SpringTree, fragment: usize, wall: usize) -> f64;

    /// Smallest indentation, m, at which the fragment that fills the subtree `node` still holds the
    /// spring of `node`, its most stretched one.
    fn holds_to(&self, tree: &SpringTree, node: usize) -> f64;

    /// What joins and leaves with the spring of `node`, as a gap in quanta of this scale: its own, unless the
    /// rule counts otherwise.
    #[inline]
    fn quanta(&self, tree: &SpringTree, scale: &GapScale, node: usize) -> i64 {
        scale.quanta(tree.gap(node))
    }
}

/// The paper's rule: a fragment of n springs is n Δx long.
#[derive(Clone, Copy, Debug)]
pub struct GridRule {
    hess: HessRule,
}

impl GridRule {
    /// Whole springs under the rule of Hess.
    #[must_use]
    pub fn new(hess: HessRule) -> Self {
        GridRule { hess }
    }
}

impl EdgeRule for GridRule {
    #[inline]
    fn grows_at(&self, tree: &SpringTree, fragment: usize, wall: usize) -> f64 {
        tree.gap(wall) - self.hess.largest_stretch(tree.size(fragment))
    }

    #[inline]
    fn holds_to(&self, tree: &SpringTree, node: usize) -> f64 {
        let gap = tree.gap(node);
        // At this indentation the spring is stretched by just Δl_max and leaves, so the smallest that
        // still holds it is the next number above; but a spring whose gap is closed stays whatever
        // the rule says.
        let leaves_at = gap - self.hess.largest_stretch(tree.size(node));
        leaves_at.next_up().min(gap)
    }
}

/// No adhesion: nothing is stretched, each spring touches and leaves at its own gap.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoAdhesion;

impl EdgeRule for NoAdhesion {
    #[inline]
    fn grows_at(&self, tree: &SpringTree, _: usize, wall: usize) -> f64 {
        tree.gap(wall)
    }

    #[inline]
    fn holds_to(&self, tree: &SpringTree, node: usize) -> f64 {
        tree.gap(node)
    }
}
