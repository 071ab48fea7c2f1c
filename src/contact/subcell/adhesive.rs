//! Edges of the fragments of an adhesive contact: they slide while a fragment is one.

use super::between::{BetweenSprings, EdgeSprings, Piece};
use super::edges::{EdgeSum, Edges, Slider, SubCellEdges};
use crate::contact::exact::OverTree;
use crate::contact::ledger::{CompensatedSum, Event, Grid, Ledger};
use crate::contact::springs::{AdhesiveSprings, Part, PartFragments};
use crate::contact::tally::Tally;
use crate::parallel::in_parallel;

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

/// Each node that is a fragment of its own, the indentation from which on it is one, and that from which on it is
/// part of a larger one. The others join or leave with their parents.
#[inline]
fn each_fragment(springs: &Springs<'_>, mut see: impl FnMut(usize, f64, f64)) {
    for PartFragments { part: Part { start, thresholds }, nodes, ends } in springs.fragments_of_parts() {
        for (&node, &end) in nodes.iter().zip(ends).rev() {
            let node = node as usize;
            see(node, thresholds[node - start], end);
        }
    }
}

/// What stands at a point of a grid, together in memory: fragments come in no order of theirs.
#[derive(Clone, Copy, Default)]
struct AtPoint {
    whole: Tally,
    edges: EdgeSum,
}

/// All that a fragment holds, whole cells without its edges.
#[inline]
fn whole(springs: &Springs<'_>, node: usize) -> Tally {
    Tally {
        springs: i64::from(springs.tree().size(node)),
        fragments: 1,
        quanta: springs.rule().sets().subtree_quanta(node),
    }
}

/// ∫ (c − θ)² dx over what joins or leaves between these indentations around the springs of fragments, in cells
/// times m²: between the threshold of a node and that of its parent its edges slide; at either of them they jump.
fn squared_stretch_of_fragments(springs: &Springs<'_>, low: f64, high: f64) -> CompensatedSum {
    let mut squared = CompensatedSum::default();
    each_fragment(springs, |node, from, to| {
        if from <= high && to > low {
            squared.add(springs.rule().slider(node).squared_stretch((from, to), (low, high)));
        }
    });
    squared
}

/// The same around those of all nodes that are no fragments and join or leave with their parents.
fn squared_stretch_of_others(springs: &Springs<'_>, low: f64, high: f64) -> f64 {
    let mut squared = CompensatedSum::default();
    for PartFragments { part: Part { start, thresholds }, nodes: fragments, .. } in
        springs.fragments_of_parts()
    {
        let (gaps, sets) = (springs.tree().gaps(), springs.rule().sets());
        let (mut block, mut left) = (0.0, BLOCK);
        let mut from = start;
        for &fragment in fragments {
            let fragment = fragment as usize;
            let nodes = from..fragment;
            from = fragment + 1;
            let at = &thresholds[nodes.start - start..nodes.end - start];
            for ((&at, &gap), levels) in at.iter().zip(&gaps[nodes.clone()]).zip(sets.levels_of(nodes)) {
                // Also where it does not count: a branch would often be mispredicted.
                let term = levels.squared_stretch_at_once(gap, at);
                block += if (at > low) & (at <= high) { term } else { 0.0 };
                left -= 1;
                if left == 0 {
                    // Sums of blocks are compensated: within one, rounding is small and nothing waits.
                    squared.add(std::mem::take(&mut block));
                    left = BLOCK;
                }
            }
        }
        // What is behind the last fragment touches nowhere on this leg.
        squared.add(block);
    }
    squared.total()
}

/// Terms that are summed without compensation.
const BLOCK: usize = 64;

/// The same of what lies level with springs.
fn squared_stretch_of_steps(springs: &Springs<'_>, low: f64, high: f64) -> f64 {
    let mut squared = CompensatedSum::default();
    for Part { start, thresholds } in springs.parts() {
        let steps = springs.rule().sets().steps();
        let first = steps.partition_point(|step| (step.node as usize) < start);
        for step in steps[first..].iter().take_while(|step| (step.node as usize) < start + thresholds.len()) {
            let at = thresholds[step.node as usize - start];
            if at > low && at <= high {
                let stretch = springs.tree().gap(step.node as usize) - at;
                squared.add(step.length * stretch * stretch);
            }
        }
    }
    squared.total()
}

impl EdgeSprings for Springs<'_> {
    type Piece = Sliding;

    fn each_piece(&self, low: f64, high: f64, mut see: impl FnMut(Sliding)) {
        each_fragment(self, |node, from, to| {
            if from <= high && to > low {
                see(Sliding { slider: self.rule().slider(node), from, to });
            }
        });
    }

    fn events(&self, ledger: &Ledger, chosen: &[bool]) -> Vec<Event> {
        let grid = &ledger.grid;
        let (low, high) = (grid.points()[0], grid.high());
        let mut events = Vec::new();
        each_fragment(self, |node, from, to| {
            for (threshold, forms) in [(from, true), (to, false)] {
                if threshold > low && threshold <= high {
                    let interval = grid.first_at_least(threshold) - 1;
                    if chosen[interval] {
                        let whole = whole(self, node);
                        events.push(Event { threshold, joins: if forms { whole } else { -whole }, interval });
                    }
                }
            }
        });
        events
    }

    fn along(&self, grid: Grid) -> (Ledger, Vec<Edges>) {
        let points = grid.points();
        let place = |at: f64| if at > grid.high() { points.len() } else { grid.first_at_least(at) };
        let mut standing = vec![AtPoint::default(); points.len()];
        each_fragment(self, |node, from, to| {
            let (first, end) = (place(from), place(to));
            if first < end {
                let (whole, slider) = (whole(self, node), self.rule().slider(node));
                for (at, &point) in standing[first..end].iter_mut().zip(&points[first..end]) {
                    at.whole += whole;
                    at.edges.add(slider.edges(point));
                }
            }
        });
        let edges = standing.iter().map(|at| at.edges.total()).collect();
        let tallies = standing.iter().map(|at| at.whole).collect();
        (Ledger { grid, tallies }, edges)
    }

    fn along_with_stretches(&self, grid: Grid, low: f64) -> (Ledger, Vec<Edges>, f64) {
        let high = grid.high();
        let squared = || {
            let mut squared = squared_stretch_of_fragments(self, low, high);
            squared.add(squared_stretch_of_others(self, low, high));
            squared.add(squared_stretch_of_steps(self, low, high));
            squared.total()
        };
        let (squared, (ledger, edges)) = in_parallel(self.is_long(), squared, || self.along(grid));
        (ledger, edges, squared)
    }

    fn is_monotone(&self) -> bool {
        self.rule().is_without_adhesion()
    }
}
