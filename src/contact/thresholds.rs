//! The two passes over the tree that replace all stepping: when each spring joins, when it leaves.
//!
//! Each spring gets one threshold, whatever the direction of the leg: it is in contact at indentation
//! d exactly when its threshold is at most d.

use super::fragment_list::FragmentList;
use super::tree::Shape;
use super::{ContactTree, EdgeRule};

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
    already: impl Fn(f64) -> bool,
) -> f64 {
    let shapes = &tree.shapes()[..thresholds.len()];
    let gaps = &tree.gaps()[..thresholds.len()];
    for node in 0..thresholds.len() {
        let own = if already(thresholds[node]) { f64::NEG_INFINITY } else { gaps[node] };
        thresholds[node] = own;
        let mut closes = own;
        // In place of a child that is not there the node takes itself in no earlier than on its own.
        for child in children_or_self(node, shapes[node]) {
            let takes_in = greater(thresholds[child], rule.grows_at(tree, child, node));
            closes = lesser(closes, takes_in);
        }
        thresholds[node] = closes;
    }
    for node in (0..thresholds.len()).rev() {
        let joins = thresholds[node];
        for child in children_or_self(node, shapes[node]) {
            thresholds[child] = lesser(thresholds[child], joins);
        }
    }
    thresholds.last().copied().unwrap_or(f64::NEG_INFINITY)
}

/// Nodes for which a rule is evaluated at once.
const BLOCK: usize = 512;

/// The same, listing the fragments: the subtrees that close before one that contains them. `grows_on_at` is
/// the indentation at which the fragment of a node takes in the spring of its parent.
pub(crate) fn load_and_list(
    tree: &ContactTree,
    grows_on_at: impl Fn(usize) -> f64,
    thresholds: &mut [f64],
    fragments: &mut FragmentList,
    already: impl Fn(f64) -> bool,
) -> f64 {
    let shapes = &tree.shapes()[..thresholds.len()];
    let gaps = &tree.gaps()[..thresholds.len()];
    fragments.clear();
    for node in 0..thresholds.len() {
        let mut closes = if already(thresholds[node]) { f64::NEG_INFINITY } else { gaps[node] };
        // Handed up from the children; in place of one that is not there, from itself.
        fragments.hand(node, closes);
        for child in children_or_self(node, shapes[node]) {
            closes = lesser(closes, fragments.handed(child));
        }
        thresholds[node] = closes;
        fragments.hand(node, greater(closes, grows_on_at(node)));
    }
    if let Some(root) = thresholds.len().checked_sub(1) {
        fragments.hand(root, f64::INFINITY);
    }
    for node in (0..thresholds.len()).rev() {
        let (closes, taken_in) = (thresholds[node], fragments.handed(node));
        let joins = lesser(closes, taken_in);
        thresholds[node] = joins;
        for child in children_or_self(node, shapes[node]) {
            fragments.hand(child, joins);
        }
        fragments.offer(node, taken_in, closes < taken_in);
    }
    thresholds.last().copied().unwrap_or(f64::NEG_INFINITY)
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
/// before. Springs that are not in contact get +∞. Lists the fragments if their edges move.
pub(crate) fn unload<R: EdgeRule>(
    tree: &ContactTree,
    rule: &R,
    thresholds: &mut [f64],
    fragments: &mut FragmentList,
    from: f64,
) -> Held {
    let shapes = &tree.shapes()[..thresholds.len()];
    fragments.clear();
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
        held = held.and(rule.open(tree, root, &mut thresholds[start..end], fragments, from));
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
    let start = root + 1 - thresholds.len();
    let shapes = &tree.shapes()[start..=root];
    let mut separates = f64::INFINITY;
    // What was in contact is so here, also where rounding puts joining and leaving at one number.
    if let Some(last) = thresholds.last_mut() {
        *last = from;
    }
    for node in (0..thresholds.len()).rev() {
        // Handed down to it: when the subtree around its own opens.
        let leaves = lesser(thresholds[node], rule.holds_to(tree, start + node));
        thresholds[node] = leaves;
        for child in children_or_self(node, shapes[node]) {
            thresholds[child] = leaves;
        }
        separates = lesser(separates, leaves);
    }
    Held { springs: thresholds.len() as u64, separates }
}

/// The same, listing the fragments: the subtrees that stay when what contains them has opened. `hold_to` gives
/// the indentations to which the nodes from a first one on hold their springs.
pub(crate) fn open_and_list(
    tree: &ContactTree,
    hold_to: impl Fn(usize, &mut [f64]),
    root: usize,
    thresholds: &mut [f64],
    fragments: &mut FragmentList,
    from: f64,
) -> Held {
    let start = root + 1 - thresholds.len();
    let shapes = &tree.shapes()[start..=root];
    let mut separates = f64::INFINITY;
    if let Some(last) = thresholds.last_mut() {
        *last = from;
    }
    let mut end = thresholds.len();
    while end > 0 {
        let begin = end.saturating_sub(BLOCK);
        // In the same place each time, which stays in the caches; what is offered overwrites only what has
        // been looked at.
        hold_to(start + begin, fragments.hand_each(0..end - begin));
        for node in (begin..end).rev() {
            let (opened, holds) = (thresholds[node], fragments.handed(node - begin));
            let leaves = lesser(opened, holds);
            thresholds[node] = leaves;
            for child in children_or_self(node, shapes[node]) {
                thresholds[child] = leaves;
            }
            separates = lesser(separates, leaves);
            // The largest fragment is part of no other.
            let is_root = start + node == root;
            let end = if is_root { f64::INFINITY } else { opened };
            fragments.offer(start + node, end, is_root | (holds < opened));
        }
        end = begin;
    }
    Held { springs: thresholds.len() as u64, separates }
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

    /// By definition: whose threshold is below that of its parent, or is one at all without a parent; and the
    /// parent's.
    fn fragments_of(parents: &[Option<usize>], thresholds: &[f64]) -> Vec<(u32, f64)> {
        let end = |node: usize| match parents[node] {
            Some(parent) => thresholds[parent],
            None => f64::INFINITY,
        };
        let nodes = (0..thresholds.len()).filter(|&node| thresholds[node] < end(node));
        nodes.map(|node| (node as u32, end(node))).collect()
    }

    fn listed(fragments: &FragmentList) -> Vec<(u32, f64)> {
        let (nodes, ends) = fragments.as_slices();
        nodes.iter().copied().zip(ends.iter().copied()).collect()
    }

    proptest! {
        /// Many more springs than are evaluated at once, and fewer.
        #[test]
        fn fragments_are_listed_with_the_same_thresholds(
            levels in prop_oneof![
                prop::collection::vec(0_u16..400, 1..40),
                prop::collection::vec(0_u16..4000, 2 * BLOCK..3 * BLOCK),
                prop::collection::vec(0_u16..3, 2 * BLOCK..3 * BLOCK),
            ],
            work in prop_oneof![Just(0.0), 0.0..2.0_f64],
            depths in prop::collection::vec(0.0..=1.0_f64, 2),
        ) {
            let lowest = levels.iter().copied().min().unwrap_or(0);
            let gaps: Vec<f64> = levels.iter().map(|&level| f64::from(level - lowest) / 300.0).collect();
            let tree = ContactTree::build(&gaps).unwrap();
            let mut parents = vec![None; tree.len()];
            for parent in 0..tree.len() {
                let (left, right) = tree.children(parent);
                left.into_iter().chain(right).for_each(|child| parents[child] = Some(parent));
            }
            let rule = GridEdges::new(HessRule::new(Foundation { spacing: 0.01, effective_modulus: 2.0 }, work));
            let grows_on_at = |node: usize| parents[node].map_or(f64::NAN, |parent| rule.grows_at(&tree, node, parent));
            let hold_to = |first: usize, values: &mut [f64]| {
                for (node, value) in (first..).zip(values) {
                    *value = rule.holds_to(&tree, node);
                }
            };
            let mut plain = vec![f64::NAN; tree.len()];
            let mut thresholds = plain.clone();
            let mut fragments = FragmentList::default().ready(tree.len()).unwrap();

            let complete = load(&tree, &rule, &mut plain, |_| false);
            let found = load_and_list(&tree, grows_on_at, &mut thresholds, &mut fragments, |_| false);
            prop_assert_eq!((found, &thresholds), (complete, &plain));
            prop_assert_eq!(listed(&fragments), fragments_of(&parents, &thresholds));

            // Back from a part of the way, and in again.
            let from = depths[0] * complete;
            let held = unload(&tree, &rule, &mut plain, &mut FragmentList::default(), from);
            fragments.clear();
            let (mut end, mut found) = (tree.len(), Held::NOTHING);
            while end > 0 {
                let root = end - 1;
                if thresholds[root] > from {
                    thresholds[root] = f64::INFINITY;
                    end = root;
                    continue;
                }
                let start = end - tree.size(root) as usize;
                let part = &mut thresholds[start..end];
                found = found.and(open_and_list(&tree, hold_to, root, part, &mut fragments, from));
                end = start;
            }
            prop_assert_eq!((found, &thresholds), (held, &plain));
            prop_assert_eq!(listed(&fragments), fragments_of(&parents, &thresholds));

            let from = depths[1] * from;
            let already = |threshold: f64| threshold <= from;
            let complete = load(&tree, &rule, &mut plain, already);
            let found = load_and_list(&tree, grows_on_at, &mut thresholds, &mut fragments, already);
            prop_assert_eq!((found, &thresholds), (complete, &plain));
            prop_assert_eq!(listed(&fragments), fragments_of(&parents, &thresholds));
        }
    }
}
