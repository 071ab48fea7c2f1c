//! Where the thresholds of a leg come from: the tree with a rule for edges, or the gaps alone.

use super::ledger::{Spring, Springs};
use super::tally::GapScale;
use super::thresholds;
use super::{ContactError, ContactTree, EdgeRule, Work};

/// A set of springs that can be loaded and unloaded leg by leg.
pub trait Contact: Springs {
    /// Prepares a loading leg from indentation `from`, or from separation. Returns the indentation from
    /// which on everything is in contact.
    fn load(&mut self, from: Option<f64>, work: &mut Work) -> f64;
    /// Prepares an unloading leg from indentation `from`. Returns the smallest indentation with contact.
    fn unload(&mut self, from: f64, work: &mut Work) -> f64;
    /// Smallest indentation at which each spring is in contact on the present leg, in their order on
    /// the line.
    fn thresholds_along_line(&self, out: &mut Vec<f64>);
    /// First and last spring of each fragment in contact at `indentation`, in ascending order.
    fn fragments(&self, indentation: f64) -> Vec<(usize, usize)>;
}

/// Springs under adhesion: the tree decides, under a rule for the edges.
pub struct AdhesiveSprings<'a, R> {
    tree: &'a ContactTree,
    rule: R,
    thresholds: Vec<f64>,
    scale: GapScale,
    /// Springs in contact and their fragments when the present leg began.
    held: (u64, u64),
}

impl<'a, R: EdgeRule> AdhesiveSprings<'a, R> {
    pub fn new(tree: &'a ContactTree, rule: R) -> Result<Self, ContactError> {
        let mut thresholds = super::reserve(tree.len())?;
        thresholds.resize(tree.len(), f64::INFINITY);
        // The root is the largest gap.
        let largest = tree.gaps().last().copied().unwrap_or(0.0);
        Ok(AdhesiveSprings { tree, rule, thresholds, scale: GapScale::for_gaps_up_to(largest), held: (0, 0) })
    }

    fn count_held(&mut self, indentation: f64) {
        let (mut springs, mut fragments) = (0, 0);
        self.each_fragment(indentation, |node| {
            springs += u64::from(self.tree.size(node));
            fragments += 1;
        });
        self.held = (springs, fragments);
    }

    /// Calls `see` with the root of each fragment in contact, from the end of the post-order.
    fn each_fragment(&self, indentation: f64, mut see: impl FnMut(usize)) {
        let mut end = self.thresholds.len();
        while end > 0 {
            let node = end - 1;
            if self.thresholds[node] <= indentation {
                see(node);
                end -= self.tree.size(node) as usize;
            } else {
                end = node;
            }
        }
    }
}

impl<R: EdgeRule> Springs for AdhesiveSprings<'_, R> {
    #[inline]
    fn each(&self, mut see: impl FnMut(Spring)) {
        for ((&threshold, &gap), &shape) in
            self.thresholds.iter().zip(self.tree.gaps()).zip(self.tree.shapes())
        {
            see(Spring { threshold, gap, fragments: shape.fragments() });
        }
    }

    fn scale(&self) -> &GapScale {
        &self.scale
    }
}

impl<R: EdgeRule> Contact for AdhesiveSprings<'_, R> {
    fn load(&mut self, from: Option<f64>, work: &mut Work) -> f64 {
        let nodes = self.tree.len() as u64;
        work.loading_passes += 1;
        match from {
            None => {
                work.hess_evaluations += nodes.saturating_sub(1);
                thresholds::load(self.tree, &self.rule, &mut self.thresholds, |_| false)
            }
            Some(from) => {
                // Each part of a subtree that is still open asks the rule once.
                self.count_held(from);
                let (springs, fragments) = self.held;
                work.hess_evaluations += (nodes - springs + fragments).saturating_sub(1);
                thresholds::load(self.tree, &self.rule, &mut self.thresholds, |threshold| threshold <= from)
            }
        }
    }

    fn unload(&mut self, from: f64, work: &mut Work) -> f64 {
        work.unloading_passes += 1;
        self.count_held(from);
        work.hess_evaluations += self.held.0;
        thresholds::unload(self.tree, &self.rule, &mut self.thresholds, from)
    }

    fn thresholds_along_line(&self, out: &mut Vec<f64>) {
        out.clear();
        out.resize(self.thresholds.len(), f64::INFINITY);
        for (&threshold, &position) in self.thresholds.iter().zip(self.tree.positions()) {
            out[position as usize] = threshold;
        }
    }

    fn fragments(&self, indentation: f64) -> Vec<(usize, usize)> {
        let mut fragments = Vec::new();
        self.each_fragment(indentation, |node| fragments.push(self.tree.interval(node)));
        fragments.sort_unstable();
        fragments
    }
}

/// Springs without adhesion: each touches at its own gap, on the way in as on the way out. No tree,
/// no rule, no pass.
pub struct BareSprings<'a> {
    gaps: &'a [f64],
    largest: f64,
    scale: GapScale,
}

impl<'a> BareSprings<'a> {
    pub fn new(gaps: &'a [f64]) -> Self {
        let largest = gaps.iter().copied().fold(0.0, f64::max);
        BareSprings { gaps, largest, scale: GapScale::for_gaps_up_to(largest) }
    }
}

impl Springs for BareSprings<'_> {
    #[inline]
    fn each(&self, mut see: impl FnMut(Spring)) {
        let mut before = f64::INFINITY;
        for (index, &gap) in self.gaps.iter().enumerate() {
            let after = self.gaps.get(index + 1).copied().unwrap_or(f64::INFINITY);
            // One fragment more, less one for each neighbour that touches earlier; among equals the
            // one on the left counts as the later, as in the tree.
            let fragments = 1 - i64::from(before < gap) - i64::from(after <= gap);
            see(Spring { threshold: gap, gap, fragments });
            before = gap;
        }
    }

    fn scale(&self) -> &GapScale {
        &self.scale
    }
}

impl Contact for BareSprings<'_> {
    fn load(&mut self, _: Option<f64>, _: &mut Work) -> f64 {
        self.largest
    }

    fn unload(&mut self, _: f64, _: &mut Work) -> f64 {
        // The highest point of the line touches first and leaves last, at d = 0.
        0.0
    }

    fn thresholds_along_line(&self, out: &mut Vec<f64>) {
        out.clear();
        out.extend_from_slice(self.gaps);
    }

    fn fragments(&self, indentation: f64) -> Vec<(usize, usize)> {
        runs(self.gaps.iter().map(|&gap| gap <= indentation))
    }
}

/// First and last index of each run of springs in contact.
pub(crate) fn runs(contact: impl Iterator<Item = bool>) -> Vec<(usize, usize)> {
    let mut runs: Vec<(usize, usize)> = Vec::new();
    for index in contact.enumerate().filter_map(|(index, contact)| contact.then_some(index)) {
        match runs.last_mut() {
            Some((_, last)) if *last + 1 == index => *last = index,
            _ => runs.push((index, index)),
        }
    }
    runs
}
