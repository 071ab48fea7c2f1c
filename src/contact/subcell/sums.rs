//! What all fragments of a leg come to at given indentations.

use super::edges::{Slider, SubCellEdges};
use crate::contact::ledger::{CompensatedSum, Grid};

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
        self.springs += i64::from(edges.sets().tree().size(node));
        self.fragments += 1;
        self.add_fragment(&edges.slider(node), indentation);
    }

    #[inline]
    fn add_fragment(&mut self, slider: &Slider, indentation: f64) {
        let fragment = slider.at(indentation);
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

/// Each node of the tree with its own threshold and that of its parent; it is a fragment between them.
#[inline]
pub fn each_node(edges: &SubCellEdges, thresholds: &[f64], mut see: impl FnMut(usize, f64, f64)) {
    let tree = edges.sets().tree();
    let shapes = &tree.shapes()[..thresholds.len()];
    for (parent, (&shape, &to)) in shapes.iter().zip(thresholds).enumerate() {
        if shape.right > 0 {
            see(parent - 1, thresholds[parent - 1], to);
        }
        if shape.left() > 0 {
            let left = parent - 1 - shape.right as usize;
            see(left, thresholds[left], to);
        }
    }
    if let Some(root) = tree.len().checked_sub(1) {
        see(root, thresholds[root], f64::INFINITY);
    }
}

/// The sums at each point of a grid.
///
/// This takes O(N) time and one evaluation for each fragment at each point.
pub fn sums_at(edges: &SubCellEdges, thresholds: &[f64], grid: &Grid) -> Vec<Sums> {
    let mut sums = vec![Sums::default(); grid.points().len()];
    let mut adder = Adder { edges, grid, sums: &mut sums };
    each_node(edges, thresholds, |node, from, to| adder.add(node, from, to));
    adder.finish();
    sums
}

/// The same, and ∫ (c − θ)² dx over what joins or leaves between `low` and the end of the grid, θ being the
/// indentation at which it does so, in cells times m².
///
/// Between the threshold of a node and that of its parent its edges slide; at either of them they jump.
pub fn sums_and_stretches(
    edges: &SubCellEdges,
    thresholds: &[f64],
    grid: &Grid,
    low: f64,
) -> (Vec<Sums>, f64) {
    let high = grid.high();
    let mut sums = vec![Sums::default(); grid.points().len()];
    let mut squared = CompensatedSum::default();
    let mut adder = Adder { edges, grid, sums: &mut sums };
    each_node(edges, thresholds, |node, from, to| {
        if from >= to {
            // No fragment of its own: all around its springs joins or leaves with them.
            if from > low && from <= high {
                squared.add(edges.squared_stretch_at_once(node, from));
            }
            return;
        }
        adder.add(node, from, to);
        if from <= high && to > low {
            squared.add(edges.slider(node).squared_stretch((from, to), (low, high)));
        }
    });
    adder.finish();
    for step in edges.sets().steps() {
        let at = thresholds[step.node as usize];
        if at > low && at <= high {
            let stretch = edges.sets().tree().gap(step.node as usize) - at;
            squared.add(step.length * stretch * stretch);
        }
    }
    (sums, squared.total())
}

/// Adds the fragments up along a grid.
struct Adder<'a> {
    edges: &'a SubCellEdges,
    grid: &'a Grid,
    sums: &'a mut [Sums],
}

impl Adder<'_> {
    #[inline]
    fn add(&mut self, node: usize, from: f64, to: f64) {
        let points = self.grid.points();
        if from >= to || from > self.grid.high() || to <= points[0] {
            return;
        }
        let first = self.grid.first_at_least(from);
        let end = if to > self.grid.high() { points.len() } else { self.grid.first_at_least(to) };
        if first == end {
            return;
        }
        let slider = self.edges.slider(node);
        // Numbers of springs and fragments as steps, to be summed up at the end.
        let springs = i64::from(self.edges.sets().tree().size(node));
        self.sums[first].springs += springs;
        self.sums[first].fragments += 1;
        if let Some(after) = self.sums.get_mut(end) {
            after.springs -= springs;
            after.fragments -= 1;
        }
        for (sums, &point) in self.sums[first..end].iter_mut().zip(&points[first..end]) {
            sums.add_fragment(&slider, point);
        }
    }

    fn finish(self) {
        let (mut springs, mut fragments) = (0, 0);
        for sums in self.sums {
            springs += sums.springs;
            fragments += sums.fragments;
            (sums.springs, sums.fragments) = (springs, fragments);
        }
    }
}
