//! How the length of a fragment is read, and so when it grows and when it lets go.

use super::fragment_list::FragmentList;
use super::tally::GapScale;
use super::thresholds::{self, Held};
use super::{ContactTree, HessRule};

/// Thresholds of a node of the tree: the one place where the length of a fragment enters.
///
/// A node's `holds_to` must not exceed its gap, nor the `grows_at` by which a part of it took it in by
/// more than one rounding: what has just joined must not leave at once.
pub trait EdgeRule {
    /// Whether the edges of a fragment move while it is one, so that the passes list the fragments.
    const EDGES_MOVE: bool = false;

    /// Smallest indentation, m, at which the fragment that fills the subtree `fragment` takes in the
    /// spring of its parent `wall`.
    fn grows_at(&self, tree: &ContactTree, fragment: usize, wall: usize) -> f64;

    /// Smallest indentation, m, at which the fragment that fills the subtree `node` still holds the
    /// spring of `node`, its most stretched one.
    fn holds_to(&self, tree: &ContactTree, node: usize) -> f64;

    /// Thresholds of a loading leg, and its fragments if their edges move, overwriting those of the leg before.
    /// `already` tells from its old threshold whether a spring is in contact when the leg begins. Returns the
    /// largest threshold.
    fn load(
        &self,
        tree: &ContactTree,
        thresholds: &mut [f64],
        _: &mut FragmentList,
        already: impl Fn(f64) -> bool,
    ) -> f64
    where
        Self: Sized,
    {
        thresholds::load(tree, self, thresholds, already)
    }

    /// Thresholds at which the fragment that fills the subtree of `root` opens, on a leg from indentation
    /// `from`, and the fragments that it leaves if their edges move; `thresholds` has one value for each node of
    /// this subtree and what it held does not matter.
    fn open(
        &self,
        tree: &ContactTree,
        root: usize,
        thresholds: &mut [f64],
        _: &mut FragmentList,
        from: f64,
    ) -> Held
    where
        Self: Sized,
    {
        thresholds::open(tree, self, root, thresholds, from)
    }

    /// What joins and leaves with the spring of `node`, as a gap in quanta of this scale: its own, unless the
    /// rule counts otherwise.
    #[inline]
    fn quanta(&self, tree: &ContactTree, scale: &GapScale, node: usize) -> i64 {
        scale.quanta(tree.gap(node))
    }
}

/// The paper's rule: a fragment of n springs is n Δx long.
#[derive(Clone, Copy, Debug)]
pub struct GridEdges {
    hess: HessRule,
}

impl GridEdges {
    /// Whole springs under the rule of Hess.
    #[must_use]
    pub fn new(hess: HessRule) -> Self {
        GridEdges { hess }
    }
}

impl EdgeRule for GridEdges {
    #[inline]
    fn grows_at(&self, tree: &ContactTree, fragment: usize, wall: usize) -> f64 {
        tree.gap(wall) - self.hess.largest_stretch(tree.size(fragment))
    }

    #[inline]
    fn holds_to(&self, tree: &ContactTree, node: usize) -> f64 {
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
    fn grows_at(&self, tree: &ContactTree, _: usize, wall: usize) -> f64 {
        tree.gap(wall)
    }

    #[inline]
    fn holds_to(&self, tree: &ContactTree, node: usize) -> f64 {
        tree.gap(node)
    }
}
