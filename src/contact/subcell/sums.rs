//! What all fragments of a leg come to at given indentations.

use super::edges::SubCellEdges;
use crate::contact::ledger::CompensatedSum;

/// What is in contact at one indentation.
#[derive(Clone, Copy, Debug, Default)]
pub struct Sums {
    pub springs: i64,
    pub fragments: i64,
    length: CompensatedSum,
    compression: CompensatedSum,
}

impl Sums {
    /// Adds the fragment of a node.
    #[inline]
    pub fn add(&mut self, edges: &SubCellEdges, node: usize, indentation: f64) {
        let fragment = edges.fragment(node, indentation);
        self.springs += i64::from(edges.sets().tree().size(node));
        self.fragments += 1;
        self.length.add(fragment.length);
        self.compression.add(fragment.compression);
    }

    /// Length in contact, in cells.
    pub fn length(&self) -> f64 {
        self.length.total()
    }

    /// Compression ∫ (d − c) dx, in cells times metres.
    pub fn compression(&self) -> f64 {
        self.compression.total()
    }
}

/// A fragment and where it is one: from the indentation `from` on, until at `to` it is part of a larger
/// one.
#[derive(Clone, Copy, Debug)]
pub struct Piece {
    pub node: u32,
    pub from: f64,
    pub to: f64,
}

impl Piece {
    pub fn is_at(&self, indentation: f64) -> bool {
        self.from <= indentation && indentation < self.to
    }
}

/// The fragments of a leg: every node of the tree is one between its own threshold and that of its parent.
pub fn each_piece(edges: &SubCellEdges, thresholds: &[f64], mut see: impl FnMut(Piece)) {
    let tree = edges.sets().tree();
    let mut piece = |node: usize, to: f64| {
        let from = thresholds[node];
        if from < to {
            see(Piece { node: node as u32, from, to });
        }
    };
    for parent in 0..tree.len() {
        let (left, right) = tree.children(parent);
        for child in [left, right].into_iter().flatten() {
            piece(child, thresholds[parent]);
        }
    }
    if let Some(root) = tree.len().checked_sub(1) {
        piece(root, f64::INFINITY);
    }
}

/// The sums at each of some indentations in ascending order.
///
/// This takes O(N) time and one evaluation for each fragment at each indentation.
pub fn sums_at(edges: &SubCellEdges, thresholds: &[f64], indentations: &[f64]) -> Vec<Sums> {
    let mut sums = vec![Sums::default(); indentations.len()];
    let (Some(&low), Some(&high)) = (indentations.first(), indentations.last()) else { return sums };
    let per_metre = (indentations.len() - 1) as f64 / (high - low);
    let first_at_least = |value: f64| {
        // A guess that is exact on an even grid but for rounding, and then made exact.
        let guess = (value - low) * per_metre;
        let mut index = if guess > 0.0 { (guess as usize).min(indentations.len()) } else { 0 };
        while index < indentations.len() && indentations[index] < value {
            index += 1;
        }
        while index > 0 && indentations[index - 1] >= value {
            index -= 1;
        }
        index
    };
    each_piece(edges, thresholds, |piece| {
        if piece.from > high || piece.to <= low {
            return;
        }
        for index in first_at_least(piece.from)..first_at_least(piece.to) {
            sums[index].add(edges, piece.node as usize, indentations[index]);
        }
    });
    sums
}
