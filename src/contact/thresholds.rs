//! The two passes over the tree that replace all stepping: when each spring joins, when it leaves.
//!
//! Each spring gets one threshold, whatever the direction of the leg: it is in contact at indentation
//! d exactly when its threshold is at most d.

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
        let shape = shapes[node];
        let mut closes = gaps[node];
        if already(thresholds[node]) {
            closes = f64::NEG_INFINITY;
        } else {
            if shape.right > 0 {
                let child = node - 1;
                closes = closes.min(thresholds[child].max(rule.grows_at(tree, child, node)));
            }
            if shape.left() > 0 {
                let child = node - 1 - shape.right as usize;
                closes = closes.min(thresholds[child].max(rule.grows_at(tree, child, node)));
            }
        }
        thresholds[node] = closes;
    }
    for node in (0..thresholds.len()).rev() {
        let joins = thresholds[node];
        for child in children_or_self(node, shapes[node]) {
            thresholds[child] = thresholds[child].min(joins);
        }
    }
    thresholds.last().copied().unwrap_or(f64::NEG_INFINITY)
}

/// Thresholds of an unloading leg that begins at indentation `from`, overwriting those of the leg
/// before.
///
/// A subtree opens, and its largest spring leaves, as soon as one that contains it has opened or its
/// own rule no longer holds it: t_v = min(t_parent, `holds_to`(v)). Springs that are not in contact
/// get +∞. Returns the smallest threshold: below it nothing is in contact.
pub(crate) fn unload<R: EdgeRule>(tree: &ContactTree, rule: &R, thresholds: &mut [f64], from: f64) -> f64 {
    let shapes = &tree.shapes()[..thresholds.len()];
    let mut separates = f64::INFINITY;
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
        // What was in contact is so here, also where rounding puts joining and leaving at one number.
        thresholds[root] = from;
        for node in (start..end).rev() {
            // Handed down to it: when the subtree around its own opens.
            let leaves = thresholds[node].min(rule.holds_to(tree, node));
            thresholds[node] = leaves;
            for child in children_or_self(node, shapes[node]) {
                thresholds[child] = leaves;
            }
            separates = separates.min(leaves);
        }
        end = start;
    }
    separates
}

/// Right and left child of a node; the node itself in place of one it does not have, to which the passes
/// from parents to children do no harm. A branch on whether there is a child would often be mispredicted
/// on a rough line.
#[inline]
fn children_or_self(node: usize, shape: Shape) -> [usize; 2] {
    let right = usize::from(shape.right > 0);
    let left = if shape.left() > 0 { 1 + shape.right as usize } else { 0 };
    [node - right, node - left]
}
