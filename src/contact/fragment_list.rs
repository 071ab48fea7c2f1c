//! The fragments of one leg, listed by the pass that finds them.

use super::{ContactError, resized};
use std::ops::Range;

/// The nodes that are fragments of their own at some indentation of a leg, each with the indentation from which
/// on it is part of a larger one, m; that from which on it is one is its threshold.
///
/// A pass finds them from the end of the post-order, and fills these arrays from their end: what lies before is
/// free for it to hand values up and down the tree.
#[derive(Debug, Default)]
pub struct FragmentList {
    nodes: Vec<u32>,
    ends: Vec<f64>,
    first: usize,
}

impl FragmentList {
    /// The same with room for those of so many springs.
    ///
    /// # Errors
    /// [`ContactError::OutOfMemory`].
    pub fn ready(self, springs: usize) -> Result<Self, ContactError> {
        let (nodes, ends) = (resized(self.nodes, springs, 0)?, resized(self.ends, springs, 0.0)?);
        Ok(FragmentList { first: springs, nodes, ends })
    }

    /// Forgets all of them.
    pub fn clear(&mut self) {
        self.first = self.nodes.len();
    }

    /// Lists a node whose place is below all that have been offered before, if it is a fragment of its own.
    #[inline]
    pub fn offer(&mut self, node: usize, end: f64, is_one: bool) {
        // Written also where it is none: a branch would often be mispredicted.
        let free = self.first - 1;
        (self.nodes[free], self.ends[free]) = (node as u32, end);
        self.first -= usize::from(is_one);
    }

    /// Hands a value to a node that has not been offered yet, or from it to others. Nodes count from the first
    /// of the subtree of the pass.
    #[inline]
    pub fn hand(&mut self, node: usize, value: f64) {
        self.ends[node] = value;
    }

    /// Hands values to several of them.
    #[inline]
    pub fn hand_each(&mut self, nodes: Range<usize>) -> &mut [f64] {
        &mut self.ends[nodes]
    }

    /// What was handed last.
    #[inline]
    pub fn handed(&self, node: usize) -> f64 {
        self.ends[node]
    }

    /// Their nodes in ascending order, and where each becomes part of a larger one, m.
    pub fn as_slices(&self) -> (&[u32], &[f64]) {
        (&self.nodes[self.first..], &self.ends[self.first..])
    }

    /// Makes it a copy of another with room for as many springs.
    pub fn copy_from(&mut self, other: &FragmentList) {
        self.first = other.first;
        let (nodes, ends) = other.as_slices();
        self.nodes[self.first..].copy_from_slice(nodes);
        self.ends[self.first..].copy_from_slice(ends);
    }
}
