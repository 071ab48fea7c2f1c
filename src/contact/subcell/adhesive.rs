//! Edges of the fragments of an adhesive contact: they slide while a fragment is one.

use super::between::{BetweenSprings, EdgeSprings, Piece};
use super::edges::{EdgeSum, Edges, Slider, SubCellEdges};
use crate::contact::exact::OverTree;
use crate::contact::ledger::{CompensatedSum, Grid};
use crate::contact::springs::{AdhesiveSprings, Part, Thresholds};
use crate::contact::thresholds::children_or_self;

/// The springs of an adhesive contact with edges between them.
type Springs<'a> = AdhesiveSprings<'a, SubCellEdges>;

/// A fragment and where it is one: from an indentation on, until it is part of a larger one.
#[derive(Clone, Copy, Debug)]
pub struct Sliding {
    slider: Slider,
    from: f64,
    to: f64,
}

impl Piece for Sliding {
    fn from(&self) -> f64 {
        self.from
    }

    fn to(&self) -> f64 {
        self.to
    }

    fn edges(&self, indentation: f64) -> Edges {
        self.slider.edges(indentation)
    }

    fn stiffness(&self, indentation: f64) -> f64 {
        self.slider.stiffness(indentation) - self.slider.cells()
    }
}

impl<'a> OverTree<'a> for BetweenSprings<Springs<'a>> {
    type Rule = SubCellEdges;

    fn over(springs: Springs<'a>) -> Self {
        BetweenSprings(springs)
    }

    fn springs(&self) -> &Springs<'a> {
        &self.0
    }

    fn springs_mut(&mut self) -> &mut Springs<'a> {
        &mut self.0
    }

    fn into_springs(self) -> Springs<'a> {
        self.0
    }
}

/// Each fragment that is one anywhere above `low`: a node, the indentation from which on it is one, and that
/// from which on it is part of a larger one. The others join or leave with their parents.
#[inline]
fn each_fragment(springs: &Springs<'_>, low: f64, mut see: impl FnMut(usize, f64, f64)) {
    each_fragment_placed(springs, low, |_, node, from, to| see(node, from, to));
}

/// The same with its place among the thresholds.
#[inline]
fn each_fragment_placed(springs: &Springs<'_>, low: f64, mut see: impl FnMut(usize, usize, f64, f64)) {
    let mut before = 0;
    for Part { start, thresholds } in springs.parts() {
        let shapes = &springs.tree().shapes()[start..start + thresholds.len()];
        let mut end = thresholds.len();
        while end > 0 {
            let parent = end - 1;
            let (shape, to) = (shapes[parent], thresholds[parent]);
            if to <= low {
                // So are all the thresholds in its subtree.
                end -= shape.size as usize;
                continue;
            }
            end = parent;
            let [right, left] = children_or_self(parent, shape);
            // Rarely so: a branch on whether there is a child would often be mispredicted.
            if (thresholds[right] < to) | (thresholds[left] < to) {
                for child in [right, left] {
                    let from = thresholds[child];
                    if from < to {
                        see(before + child, start + child, from, to);
                    }
                }
            }
        }
        if let Some(&root) = thresholds.last()
            && root < f64::INFINITY
        {
            let last = thresholds.len() - 1;
            see(before + last, start + last, root, f64::INFINITY);
        }
        before += thresholds.len();
    }
}

/// Nodes that are fragments of their own somewhere, a bit for each in the order of the thresholds.
struct Fragments(Vec<u64>);

impl Fragments {
    const BITS: usize = u64::BITS as usize;

    fn none(springs: usize) -> Self {
        Fragments(vec![0; springs.div_ceil(Self::BITS)])
    }

    fn mark(&mut self, place: usize) {
        self.0[place / Self::BITS] |= 1 << (place % Self::BITS);
    }
}

/// ∫ (c − θ)² dx over what is around the springs of all nodes that are no fragments and join or leave with
/// their parents between these indentations, in cells times m².
fn squared_stretch_of_parts(springs: &Springs<'_>, fragments: &Fragments, low: f64, high: f64) -> f64 {
    let (mut squared, mut block, mut place) = (CompensatedSum::default(), 0.0, 0);
    for Part { start, thresholds } in springs.parts() {
        let nodes = start..start + thresholds.len();
        let levels = springs.rule().sets().levels_of(nodes.clone());
        let nodes = thresholds.iter().zip(&springs.tree().gaps()[nodes]).zip(levels);
        for ((&at, &gap), levels) in nodes {
            if place % Fragments::BITS == 0 {
                // Sums of blocks are compensated: within one, rounding is small and nothing waits.
                squared.add(std::mem::take(&mut block));
            }
            let is_fragment = fragments.0[place / Fragments::BITS] >> (place % Fragments::BITS) & 1 == 1;
            // Also where it does not count: a branch would often be mispredicted.
            let term = levels.squared_stretch_at_once(gap, at);
            block += if (at > low) & (at <= high) & !is_fragment { term } else { 0.0 };
            place += 1;
        }
    }
    squared.add(block);
    squared.total()
}

/// Adds to the points of a grid what a fragment adds while it is one.
#[inline]
fn add(edges: &SubCellEdges, grid: &Grid, sums: &mut [EdgeSum], (node, from, to): (usize, f64, f64)) {
    let points = grid.points();
    if from > grid.high() || to <= points[0] {
        return;
    }
    let first = grid.first_at_least(from);
    let end = if to > grid.high() { points.len() } else { grid.first_at_least(to) };
    if first < end {
        let slider = edges.slider(node);
        for (sum, &point) in sums[first..end].iter_mut().zip(&points[first..end]) {
            sum.add(slider.edges(point));
        }
    }
}

impl EdgeSprings for Springs<'_> {
    type Piece = Sliding;

    fn each_piece(&self, low: f64, high: f64, mut see: impl FnMut(Sliding)) {
        each_fragment(self, low, |node, from, to| {
            if from <= high {
                see(Sliding { slider: self.rule().slider(node), from, to });
            }
        });
    }

    fn edges_along(&self, grid: &Grid) -> Vec<Edges> {
        let mut sums = vec![EdgeSum::default(); grid.points().len()];
        each_fragment(self, grid.points()[0], |node, from, to| {
            add(self.rule(), grid, &mut sums, (node, from, to))
        });
        sums.iter().map(EdgeSum::total).collect()
    }

    /// Between the threshold of a node and that of its parent its edges slide; at either of them they jump.
    fn edges_and_stretches(&self, grid: &Grid, low: f64) -> (Vec<Edges>, f64) {
        let (edges, high) = (self.rule(), grid.high());
        let mut sums = vec![EdgeSum::default(); grid.points().len()];
        let mut squared = CompensatedSum::default();
        let mut fragments = Fragments::none(self.count() as usize);
        each_fragment_placed(self, low.min(grid.points()[0]), |place, node, from, to| {
            fragments.mark(place);
            add(edges, grid, &mut sums, (node, from, to));
            if from <= high && to > low {
                squared.add(edges.slider(node).squared_stretch((from, to), (low, high)));
            }
        });
        squared.add(squared_stretch_of_parts(self, &fragments, low, high));
        for Part { start, thresholds } in self.parts() {
            let steps = edges.sets().steps();
            let first = steps.partition_point(|step| (step.node as usize) < start);
            let steps =
                steps[first..].iter().take_while(|step| (step.node as usize) < start + thresholds.len());
            for step in steps {
                let at = thresholds[step.node as usize - start];
                if at > low && at <= high {
                    let stretch = self.tree().gap(step.node as usize) - at;
                    squared.add(step.length * stretch * stretch);
                }
            }
        }
        (sums.iter().map(EdgeSum::total).collect(), squared.total())
    }

    fn is_monotone(&self) -> bool {
        self.rule().is_without_adhesion()
    }
}
