//! Where the thresholds of a leg come from: the tree with a rule for edges, or the gaps alone.

use super::fragment_list::FragmentList;
use super::ledger::{Spring, Springs};
use super::tally::GapScale;
use super::thresholds::{self, Held};
use super::{ContactError, ContactTree, EdgeRule, LegContact, Work};

/// Springs whose thresholds are those of the present leg.
pub trait Thresholds: Springs {
    /// Springs, in contact or not.
    fn count(&self) -> u64;
    /// Prepares a loading leg from indentation `from`, or from separation. Returns the indentation from
    /// which on everything is in contact.
    fn load(&mut self, from: Option<f64>, work: &mut Work) -> f64;
    /// Prepares an unloading leg from indentation `from`. Returns the smallest indentation with contact.
    fn unload(&mut self, from: f64, work: &mut Work) -> f64;
    /// Smallest indentation at which each spring is in contact on the present leg, in their order on
    /// the line.
    fn thresholds_along_line(&self, out: &mut Vec<f64>);
    /// Copies what tells the contact at any indentation of the present leg.
    ///
    /// # Errors
    /// [`ContactError::OutOfMemory`].
    fn copy_leg(&self, copy: &mut LegContact) -> Result<(), ContactError>;
    /// First and last spring of each fragment in contact at `indentation`, in ascending order.
    fn fragments(&self, indentation: f64) -> Vec<(usize, usize)>;
}

/// Memory that one body leaves to the next: fresh memory costs about as much as a pass.
#[derive(Debug, Default)]
pub struct BodyMemory {
    passed: Passed,
    first: Passed,
}

impl BodyMemory {
    /// The same with room for what a pass over so many springs gives, already cleared by the system; with their
    /// fragments if these are `listed`.
    ///
    /// # Errors
    /// [`ContactError::OutOfMemory`].
    pub fn ready(self, springs: usize, listed: bool) -> Result<Self, ContactError> {
        Ok(BodyMemory { passed: self.passed.ready(springs, listed)?, ..self })
    }
}

/// What a pass gives.
#[derive(Debug, Default)]
struct Passed {
    /// Thresholds of the springs of each subtree, one subtree after the other, each in post-order, m.
    thresholds: Vec<f64>,
    /// The fragments of these subtrees if their edges move, else none.
    fragments: FragmentList,
}

impl Passed {
    fn ready(self, springs: usize, listed: bool) -> Result<Self, ContactError> {
        let thresholds = super::resized(self.thresholds, springs, f64::INFINITY)?;
        let fragments = if listed { self.fragments.ready(springs)? } else { self.fragments };
        Ok(Passed { thresholds, fragments })
    }

    /// Makes it a copy of another over as many springs.
    fn copy_from(&mut self, other: &Passed, listed: bool) {
        self.thresholds.copy_from_slice(&other.thresholds);
        if listed {
            self.fragments.copy_from(&other.fragments);
        }
    }
}

/// What the loading gives that forms the contact: each time the body comes down again it is the same.
enum FirstLoading {
    /// Computed each time; the memory is not used.
    Forgotten(Passed),
    /// To be kept in this memory once it is computed.
    Awaited(Passed),
    /// This, and the largest threshold, m.
    Known(Passed, f64),
}

/// Springs under adhesion: the tree decides, under a rule for the edges.
pub struct AdhesiveSprings<'a, R> {
    tree: &'a ContactTree,
    rule: R,
    /// Roots of the subtrees looked at: of the whole tree, or of the fragments of first touch.
    roots: Vec<usize>,
    passed: Passed,
    first: FirstLoading,
    scale: GapScale,
    /// Whether the present leg presses a body that was separated before.
    forms: bool,
}

/// One of the subtrees looked at.
#[derive(Clone, Copy)]
pub struct Part<'s> {
    /// Its first node.
    pub start: usize,
    /// Thresholds of its nodes from there on, m.
    pub thresholds: &'s [f64],
}

/// The fragments of one of them.
#[derive(Clone, Copy)]
pub struct PartFragments<'s> {
    pub part: Part<'s>,
    /// Nodes that are fragments of their own somewhere, ascending.
    pub nodes: &'s [u32],
    /// Where each becomes part of a larger one, m.
    pub ends: &'s [f64],
}

impl<'a, R: EdgeRule> AdhesiveSprings<'a, R> {
    /// Keeps its thresholds in this memory; what it holds does not matter, as nothing asks for them before
    /// the first pass has written them.
    pub fn new(tree: &'a ContactTree, rule: R, memory: BodyMemory) -> Result<Self, ContactError> {
        let roots = tree.len().checked_sub(1).into_iter().collect();
        Self::of(tree, rule, roots, memory)
    }

    /// Only the springs of these subtrees, whole in contact when their unloading leg begins.
    pub fn of(
        tree: &'a ContactTree,
        rule: R,
        roots: Vec<usize>,
        memory: BodyMemory,
    ) -> Result<Self, ContactError> {
        let count = roots.iter().map(|&root| tree.size(root) as usize).sum();
        let BodyMemory { passed, first } = memory.ready(count, R::EDGES_MOVE)?;
        let first = FirstLoading::Forgotten(first);
        Ok(AdhesiveSprings { tree, rule, roots, passed, first, scale: tree.gap_scale(), forms: false })
    }

    /// The tree of the line.
    pub fn tree(&self) -> &'a ContactTree {
        self.tree
    }

    /// The rule for the edges.
    pub fn rule(&self) -> &R {
        &self.rule
    }

    pub fn into_memory(self) -> BodyMemory {
        let (FirstLoading::Forgotten(first) | FirstLoading::Awaited(first) | FirstLoading::Known(first, _)) =
            self.first;
        BodyMemory { passed: self.passed, first }
    }

    /// Computes the loading that forms the contact once, and keeps it for each time the body comes down again.
    pub fn keep_first_loading(&mut self) {
        let first = std::mem::replace(&mut self.first, FirstLoading::Forgotten(Passed::default()));
        self.first = match first {
            FirstLoading::Forgotten(memory) => FirstLoading::Awaited(memory),
            kept => kept,
        };
    }

    /// Begins the loading that forms the contact and returns the largest threshold.
    fn form(&mut self, work: &mut Work) -> f64 {
        if let FirstLoading::Known(passed, complete) = &self.first {
            self.passed.copy_from(passed, R::EDGES_MOVE);
            return *complete;
        }
        work.loading_passes += 1;
        work.hess_evaluations += (self.tree.len() as u64).saturating_sub(1);
        let complete = self.pass_loading(|_| false);
        if let FirstLoading::Awaited(memory) = &mut self.first {
            // Where there is no memory to keep it, it is computed again.
            let kept = std::mem::take(memory).ready(self.passed.thresholds.len(), R::EDGES_MOVE);
            self.first = kept.map_or(FirstLoading::Forgotten(Passed::default()), |mut kept| {
                kept.copy_from(&self.passed, R::EDGES_MOVE);
                FirstLoading::Known(kept, complete)
            });
        }
        complete
    }

    fn pass_loading(&mut self, already: impl Fn(f64) -> bool) -> f64 {
        let Passed { thresholds, fragments } = &mut self.passed;
        self.rule.load(self.tree, thresholds, fragments, already)
    }

    /// The subtrees looked at.
    pub fn parts(&self) -> impl Iterator<Item = Part<'_>> {
        let mut rest = self.passed.thresholds.as_slice();
        self.roots.iter().map(move |&root| {
            let (thresholds, after) = rest.split_at(self.tree.size(root) as usize);
            rest = after;
            Part { start: root + 1 - thresholds.len(), thresholds }
        })
    }

    /// Their fragments on the present leg, if their edges move.
    pub fn fragments_of_parts(&self) -> impl Iterator<Item = PartFragments<'_>> {
        // The subtrees stand from the end of the post-order, and so did the pass go.
        let (mut nodes, mut ends) = self.passed.fragments.as_slices();
        self.parts().map(move |part| {
            let first = nodes.partition_point(|&node| (node as usize) < part.start);
            let of_part = PartFragments { part, nodes: &nodes[first..], ends: &ends[first..] };
            (nodes, ends) = (&nodes[..first], &ends[..first]);
            of_part
        })
    }

    /// Roots of the fragments in contact at first touch, from the end of the post-order, on the leg that
    /// forms the contact.
    pub fn roots_at_touch(&self) -> Option<Vec<usize>> {
        self.forms.then(|| {
            let mut roots = Vec::new();
            self.tree.each_fragment(&self.passed.thresholds, 0.0, |root| roots.push(root));
            roots
        })
    }

    /// Begins the unloading leg of subtrees that are whole in contact at an indentation, m.
    pub fn open(&mut self, from: f64) -> Held {
        let mut held = Held::NOTHING;
        let Passed { thresholds, fragments } = &mut self.passed;
        fragments.clear();
        let mut rest = thresholds.as_mut_slice();
        for &root in &self.roots {
            let (fragment, after) = rest.split_at_mut(self.tree.size(root) as usize);
            held = held.and(self.rule.open(self.tree, root, fragment, fragments, from));
            rest = after;
        }
        held
    }
}

impl<R: EdgeRule> Springs for AdhesiveSprings<'_, R> {
    #[inline]
    fn each(&self, mut see: impl FnMut(Spring)) {
        for Part { start, thresholds } in self.parts() {
            let nodes = start..start + thresholds.len();
            let shapes = self.tree.gaps()[nodes.clone()].iter().zip(&self.tree.shapes()[nodes.clone()]);
            for ((&threshold, (&gap, &shape)), node) in thresholds.iter().zip(shapes).zip(nodes) {
                let quanta = self.rule.quanta(self.tree, &self.scale, node);
                see(Spring { threshold, gap, quanta, fragments: shape.fragments() });
            }
        }
    }

    /// No spring of a subtree has a larger threshold than its root.
    #[inline]
    fn each_between(&self, low: f64, high: f64, mut see: impl FnMut(Spring)) {
        for Part { start, thresholds } in self.parts() {
            let mut end = thresholds.len();
            while end > 0 {
                let (place, node) = (end - 1, start + end - 1);
                let (threshold, shape) = (thresholds[place], self.tree.shapes()[node]);
                end = if threshold <= low { end - shape.size as usize } else { place };
                if threshold <= low || threshold > high {
                    continue;
                }
                let quanta = self.rule.quanta(self.tree, &self.scale, node);
                see(Spring { threshold, gap: self.tree.gap(node), quanta, fragments: shape.fragments() });
            }
        }
    }

    fn scale(&self) -> &GapScale {
        &self.scale
    }
}

impl<R: EdgeRule> Thresholds for AdhesiveSprings<'_, R> {
    fn count(&self) -> u64 {
        self.passed.thresholds.len() as u64
    }

    fn load(&mut self, from: Option<f64>, work: &mut Work) -> f64 {
        self.forms = from.is_none();
        let Some(from) = from else { return self.form(work) };
        work.loading_passes += 1;
        // Each part of a subtree that is still open asks the rule once.
        let (mut springs, mut fragments) = (0, 0);
        self.tree.each_fragment(&self.passed.thresholds, from, |root| {
            springs += u64::from(self.tree.size(root));
            fragments += 1;
        });
        work.hess_evaluations += (self.tree.len() as u64 - springs + fragments).saturating_sub(1);
        self.pass_loading(|threshold| threshold <= from)
    }

    fn unload(&mut self, from: f64, work: &mut Work) -> f64 {
        work.unloading_passes += 1;
        self.forms = false;
        let Passed { thresholds, fragments } = &mut self.passed;
        let held = thresholds::unload(self.tree, &self.rule, thresholds, fragments, from);
        work.hess_evaluations += held.springs;
        held.separates
    }

    fn thresholds_along_line(&self, out: &mut Vec<f64>) {
        out.clear();
        out.resize(self.passed.thresholds.len(), f64::INFINITY);
        for (&threshold, &position) in self.passed.thresholds.iter().zip(self.tree.positions()) {
            out[position as usize] = threshold;
        }
    }

    fn copy_leg(&self, copy: &mut LegContact) -> Result<(), ContactError> {
        copy.keep_tree_order(&self.passed.thresholds)
    }

    fn fragments(&self, indentation: f64) -> Vec<(usize, usize)> {
        self.tree.fragments(&self.passed.thresholds, indentation)
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
