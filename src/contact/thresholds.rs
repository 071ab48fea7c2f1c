//! The two passes over the tree that replace all stepping: when each spring joins, when it leaves.
//!
//! Each spring gets one threshold, whatever the direction of the leg: it is in contact at indentation
//! d exactly when its threshold is at most d.

use super::tree::Shape;
use super::{ContactTree, EdgeRule};
use crate::parallel::in_parallel;
use std::mem::take;
use std::ops::Range;

/// Thresholds of a loading leg, overwriting those of the leg before.
///
/// A subtree v closes when its own largest gap is closed or when a part of it, grown so far that only
/// that gap is left, may take it in:
/// s_v = min(c_v, min over children u of max(s_u, `grows_at`(u, v))).
/// A spring joins at the smallest s of its own subtree and all that contain it.
///
/// `already` tells from its old threshold whether a spring is in contact when the leg begins; such a
/// spring gets −∞. Returns the largest threshold: from there on everything is in contact.
pub(crate) fn load<R: EdgeRule>(
    tree: &ContactTree,
    rule: &R,
    thresholds: &mut [f64],
    already: impl Fn(f64) -> bool + Sync,
) -> f64 {
    let parts = thresholds.len().checked_sub(1).map(|root| Parts::of(tree, root, MANY_SPRINGS));
    load_parts(tree, rule, thresholds, already, &parts.unwrap_or_default())
}

fn load_parts<R: EdgeRule>(
    tree: &ContactTree,
    rule: &R,
    thresholds: &mut [f64],
    already: impl Fn(f64) -> bool + Sync,
    parts: &Parts,
) -> f64 {
    let path = Nodes::of(tree, 0, thresholds.len());
    parts.each(tree, thresholds, 0, &|nodes, part| {
        (0..part.len()).for_each(|node| nodes.close(rule, node, part, &already));
    });
    parts.path.iter().rev().for_each(|&node| path.close(rule, node, thresholds, &already));
    parts.path.iter().for_each(|&node| path.join(node, thresholds));
    parts.each(tree, thresholds, 0, &|nodes, part| {
        (0..part.len()).rev().for_each(|node| nodes.join(node, part));
    });
    thresholds.last().copied().unwrap_or(f64::NEG_INFINITY)
}

/// Nodes that follow each other, counted from the first.
#[derive(Clone, Copy)]
struct Nodes<'t> {
    tree: &'t ContactTree,
    start: usize,
    gaps: &'t [f64],
    shapes: &'t [Shape],
}

impl<'t> Nodes<'t> {
    fn of(tree: &'t ContactTree, start: usize, count: usize) -> Self {
        let nodes = start..start + count;
        Nodes { tree, start, gaps: &tree.gaps()[nodes.clone()], shapes: &tree.shapes()[nodes] }
    }

    /// Finds when the subtree of a node closes by itself, its children known.
    #[inline]
    fn close<R: EdgeRule>(
        self,
        rule: &R,
        node: usize,
        thresholds: &mut [f64],
        already: &impl Fn(f64) -> bool,
    ) {
        let own = if already(thresholds[node]) { f64::NEG_INFINITY } else { self.gaps[node] };
        thresholds[node] = own;
        let mut closes = own;
        // In place of a child that is not there the node takes itself in no earlier than on its own.
        for child in children_or_self(node, self.shapes[node]) {
            let grows_at = rule.grows_at(self.tree, self.start + child, self.start + node);
            closes = lesser(closes, greater(thresholds[child], grows_at));
        }
        thresholds[node] = closes;
    }

    /// Hands down to the children of a node that they join with it at the latest.
    #[inline]
    fn join(self, node: usize, thresholds: &mut [f64]) {
        let joins = thresholds[node];
        for child in children_or_self(node, self.shapes[node]) {
            thresholds[child] = lesser(thresholds[child], joins);
        }
    }

    /// Finds when the subtree of a node opens, to which it has been handed down when the one around it does.
    #[inline]
    fn open<R: EdgeRule>(self, rule: &R, node: usize, thresholds: &mut [f64]) -> f64 {
        let leaves = lesser(thresholds[node], rule.holds_to(self.tree, self.start + node));
        thresholds[node] = leaves;
        for child in children_or_self(node, self.shapes[node]) {
            thresholds[child] = leaves;
        }
        leaves
    }
}

/// What an unloading leg begins with and where it ends at the latest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Held {
    /// Springs in contact when it begins.
    pub springs: u64,
    /// The smallest threshold: below it nothing is in contact.
    pub separates: f64,
}

impl Held {
    /// Nothing in contact.
    pub const NOTHING: Held = Held { springs: 0, separates: f64::INFINITY };

    /// This and what else is in contact.
    pub fn and(self, other: Held) -> Held {
        Held { springs: self.springs + other.springs, separates: lesser(self.separates, other.separates) }
    }
}

/// Thresholds of an unloading leg that begins at indentation `from`, overwriting those of the leg
/// before. Springs that are not in contact get +∞.
pub(crate) fn unload<R: EdgeRule>(tree: &ContactTree, rule: &R, thresholds: &mut [f64], from: f64) -> Held {
    let shapes = &tree.shapes()[..thresholds.len()];
    let mut held = Held::NOTHING;
    let mut end = thresholds.len();
    while end > 0 {
        let root = end - 1;
        if thresholds[root] > from {
            thresholds[root] = f64::INFINITY;
            end = root;
            continue;
        }
        // A node in contact whose parent is not is the root of one whole fragment.
        let start = end - shapes[root].size as usize;
        held = held.and(open(tree, rule, root, &mut thresholds[start..end], from));
        end = start;
    }
    held
}

/// Thresholds at which the fragment that fills the subtree of `root` opens, on a leg from indentation
/// `from`; `thresholds` has one value for each node of this subtree and what it held does not matter.
///
/// A subtree opens, and its largest spring leaves, as soon as one that contains it has opened or its
/// own rule no longer holds it: t_v = min(t_parent, `holds_to`(v)).
pub(crate) fn open<R: EdgeRule>(
    tree: &ContactTree,
    rule: &R,
    root: usize,
    thresholds: &mut [f64],
    from: f64,
) -> Held {
    open_parts(tree, rule, root, thresholds, from, &Parts::of(tree, root, MANY_SPRINGS))
}

fn open_parts<R: EdgeRule>(
    tree: &ContactTree,
    rule: &R,
    root: usize,
    thresholds: &mut [f64],
    from: f64,
    parts: &Parts,
) -> Held {
    let start = root + 1 - thresholds.len();
    // What was in contact is so here, also where rounding puts joining and leaving at one number.
    if let Some(last) = thresholds.last_mut() {
        *last = from;
    }
    let whole = Nodes::of(tree, start, thresholds.len());
    let path = parts.path.iter().map(|&node| whole.open(rule, node - start, thresholds));
    let path = path.fold(f64::INFINITY, lesser);
    let aside = parts.each(tree, thresholds, start, &|nodes, part| {
        (0..part.len()).rev().map(|node| nodes.open(rule, node, part)).fold(f64::INFINITY, lesser)
    });
    let separates = aside.into_iter().fold(path, lesser);
    Held { springs: thresholds.len() as u64, separates }
}

/// From so many springs on a second thread pays.
const MANY_SPRINGS: usize = 1 << 15;
/// Longest way from the root to two parts of like size; a tree that is one chain has none.
const LONGEST_PATH: usize = 4096;

/// Parts of a tree that do not see each other, for two threads: the subtree of a node of middling size, and all
/// subtrees beside the path from the root to it.
#[derive(Default)]
struct Parts {
    /// From the root on; empty where the tree is one part.
    path: Vec<usize>,
    /// Nodes of the one subtree at the end of the path.
    end: Range<usize>,
}

impl Parts {
    /// Those of a subtree of at least `many` springs.
    fn of(tree: &ContactTree, root: usize, many: usize) -> Self {
        let size = |node: usize| tree.size(node) as usize;
        let (whole, half) = (size(root), size(root) / 2);
        let (mut path, mut node) = (Vec::new(), root);
        if whole < many {
            return Parts::default();
        }
        // The larger part of more than half is a quarter at least.
        while size(node) > half.max(1) {
            path.push(node);
            let (left, right) = tree.children(node);
            match left.into_iter().chain(right).max_by_key(|&child| size(child)) {
                Some(child) if path.len() < LONGEST_PATH => node = child,
                _ => return Parts::default(),
            }
        }
        Parts { path, end: node + 1 - size(node)..node + 1 }
    }

    /// Does `work` on all nodes but those of the path, by whole subtrees; the first of `thresholds` is that of
    /// node `start`.
    fn each<A: Send>(
        &self,
        tree: &ContactTree,
        thresholds: &mut [f64],
        start: usize,
        work: &(impl Fn(Nodes<'_>, &mut [f64]) -> A + Sync),
    ) -> Vec<A> {
        let on = |start, part: &mut [f64]| work(Nodes::of(tree, start, part.len()), part);
        if self.path.is_empty() {
            return vec![on(start, thresholds)];
        }
        let (before, rest) = thresholds.split_at_mut(self.end.start - start);
        let (end, after) = rest.split_at_mut(self.end.len());
        let beside = move || {
            let mut results = vec![on(start, before)];
            let (mut after, mut next) = (after, self.end.end);
            for &node in self.path.iter().rev() {
                let (part, others) = take(&mut after).split_at_mut(node - next);
                results.push(on(next, part));
                (after, next) = (&mut others[1..], node + 1);
            }
            results
        };
        let (mut results, end) = in_parallel(true, beside, || on(self.end.start, end));
        results.push(end);
        results
    }
}

/// The smaller of two numbers, neither of which is NaN: `f64::min` would look for that.
#[inline]
fn lesser(a: f64, b: f64) -> f64 {
    if b < a { b } else { a }
}

/// The larger of two numbers, neither of which is NaN.
#[inline]
fn greater(a: f64, b: f64) -> f64 {
    if b > a { b } else { a }
}

/// Right and left child of a node; the node itself in place of one it does not have, to which the passes
/// do no harm. A branch on whether there is a child would often be mispredicted on a rough line.
#[inline]
pub(crate) fn children_or_self(node: usize, shape: Shape) -> [usize; 2] {
    let right = usize::from(shape.right > 0);
    let left = if shape.left() > 0 { 1 + shape.right as usize } else { 0 };
    [node - right, node - left]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::{Foundation, GridEdges, HessRule};
    use proptest::prelude::*;

    /// Lines of several kinds: noise with ties, slopes whose trees are chains, and both.
    fn gaps() -> impl Strategy<Value = Vec<f64>> {
        (prop::collection::vec(0_u8..40, 1..200), -2.0..2.0_f64).prop_map(|(noise, slope)| {
            let heights = noise.iter().enumerate();
            let heights: Vec<f64> =
                heights.map(|(k, &noise)| 0.025 * f64::from(noise) + slope.round() * k as f64).collect();
            let lowest = heights.iter().copied().fold(f64::INFINITY, f64::min);
            heights.iter().map(|height| height - lowest).collect()
        })
    }

    proptest! {
        #[test]
        fn two_parts_give_what_one_gives(gaps in gaps(), work in 0.0..3.0_f64, share in 0.0..1.2_f64) {
            let tree = ContactTree::build(&gaps).unwrap();
            let rule = GridEdges::new(HessRule::new(Foundation { spacing: 0.05, effective_modulus: 1.0 }, work));
            let root = gaps.len() - 1;
            let (one, two) = (Parts::default(), Parts::of(&tree, root, 1));
            let bits = |values: &[f64]| values.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
            let [mut once, mut parted] = [vec![f64::INFINITY; gaps.len()], vec![f64::INFINITY; gaps.len()]];
            let never = |_: f64| false;
            let complete = load_parts(&tree, &rule, &mut once, never, &one);
            prop_assert_eq!(complete, load_parts(&tree, &rule, &mut parted, never, &two));
            prop_assert_eq!(bits(&once), bits(&parted));
            // From a contact that holds part of it on.
            let from = share * complete;
            let already = |threshold: f64| threshold <= from;
            load_parts(&tree, &rule, &mut once, already, &one);
            load_parts(&tree, &rule, &mut parted, already, &two);
            prop_assert_eq!(bits(&once), bits(&parted));
            let held = open_parts(&tree, &rule, root, &mut once, complete, &one);
            prop_assert_eq!(held, open_parts(&tree, &rule, root, &mut parted, complete, &two));
            prop_assert_eq!(bits(&once), bits(&parted));
        }
    }

    #[test]
    fn parts_are_of_like_size_where_the_tree_has_such() {
        let noise: Vec<f64> = (0_u32..5000).map(|k| f64::from(k.wrapping_mul(2_654_435_761) >> 8)).collect();
        let tree = ContactTree::build(&noise).unwrap();
        let Parts { path, end } = Parts::of(&tree, 4999, 1);
        assert!(!path.is_empty() && path.len() < 50, "{}", path.len());
        assert!((1250..=2500).contains(&end.len()), "{end:?}");
        assert!(Parts::of(&tree, 4999, 5001).path.is_empty());
        let slope: Vec<f64> = (0..20_000).map(f64::from).collect();
        assert!(Parts::of(&ContactTree::build(&slope).unwrap(), 19_999, 1).path.is_empty());
    }
}
