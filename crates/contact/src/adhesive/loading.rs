//! Loading: finds the indentation at which each node of the contact tree closes, and lists the runs
//! between these events. A run is a patch over a range of indentations in which the edges of the
//! patch do not jump. A held patch is a patch that is in contact at the beginning of the loading.

use super::levels::{Span, larger, smaller};
use super::run::{Ground, HeldPatch, Run, RunList};
use super::tree::{Branch, Node};
use crate::detachment::{DetachmentRule, Levels};
use crate::error::ContactError;
use asperity_data::{gathered, push, resized};
use std::borrow::Cow;
use std::ops::Range;

/// Closing thresholds of the nodes of a contact tree: the indentations in m at which the nodes
/// close on a loading from separation.
///
/// A node of the tree is a local maximum of the gap. The node closes when one of the two patches
/// beside the node attaches the spring of the node. From then on all springs of the subtree of the
/// node belong to one patch. The threshold of node v is s_v = min over its two branches u of
/// max(s_u, all φ of the patch while the patch grows from u to v). φ is the indentation at which a
/// patch with its edges at a given gap is in equilibrium; see the module `run`.
#[derive(Debug)]
pub struct Closing {
    /// Indentation in m at which each node closes: all springs of its subtree then belong to one
    /// patch.
    closes: Vec<f64>,
    /// First and last spring that certainly attach when each node closes. The range widens while
    /// the branches above the node are followed.
    known: Vec<[u32; 2]>,
    pub evaluations: u64,
}

/// A loading that begins with patches in contact.
struct Loading<'a, const SLIDES: bool, R> {
    ground: &'a Ground<'a, SLIDES, R>,
    held: &'a [HeldPatch],
    closes: Cow<'a, [f64]>,
    known: &'a [[u32; 2]],
    listed: RunList,
}

/// The beginning of a branch of the contact tree, from which the walk up the branch starts.
#[derive(Clone, Copy)]
struct BranchStart {
    /// Indentation in m at which the branch begins.
    closes: f64,
    /// First and last spring that certainly attach at the indentation `closes`.
    known: [u32; 2],
    gap: f64,
}

/// Result of a walk up a branch to the spring at which the branch merges with another branch.
struct Reached {
    /// Indentation in m at which the branch attaches the spring at which it merges.
    closes: f64,
    /// First and last spring that certainly belong to the branch from its beginning on.
    known: [u32; 2],
}

/// A branch that the walk down from the root of the tree visits.
#[derive(Clone, Debug)]
struct Visit {
    branch: Branch,
    /// Indentation in m at which the branch becomes part of a larger patch.
    merges: f64,
    /// Spring at which the branch merges with another branch.
    parent: usize,
    /// Indices of those held patches that lie on this branch or on a branch below.
    held: Range<usize>,
}

/// A walk up one branch of the contact tree, on which the patch grows spring by spring.
struct Ascent {
    branch: Branch,
    /// Indentation in m at which the branch becomes part of a larger patch.
    merges: f64,
    span: Span,
    /// Smallest indentation in m at which the springs of `span` are in contact.
    closes: f64,
    /// Height in m of the pinned edges of a held patch above its largest gap; `None` unless the
    /// walk begins with a held patch whose edges are pinned.
    pin: Option<f64>,
    /// Length of the patch as a function of its level, before the patch attached its last spring;
    /// `None` if the present springs begin a new run.
    below: Option<Levels>,
}

impl Closing {
    pub fn new<const SLIDES: bool, R: DetachmentRule>(
        ground: &Ground<'_, SLIDES, R>,
    ) -> Result<Self, ContactError> {
        let count = ground.tree.node_count();
        let mut closing = Closing {
            closes: resized(Vec::new(), count, 0.0)?,
            known: resized(Vec::new(), count, [0; 2])?,
            evaluations: 0,
        };
        for index in 0..count {
            let node = ground.tree.nodes[index];
            let left_end = index.saturating_sub(1 + node.right as usize);
            let right_end = index.saturating_sub(1);
            let left = closing.close_part(ground, &node, 0, left_end);
            let right = closing.close_part(ground, &node, 1, right_end);
            closing.closes[index] = smaller(left.closes, right.closes);
            closing.known[index] = [left.known[0], right.known[1]];
        }
        Ok(closing)
    }

    /// Finds the indentation at which one of the two branches that merge at a node attaches the
    /// spring of the node. `side` is 0 for the left branch and 1 for the right one. `child` is the
    /// node at which the branch begins; if the branch begins at a local minimum, `child` may be any
    /// node.
    #[inline]
    fn close_part<const SLIDES: bool, R: DetachmentRule>(
        &mut self,
        ground: &Ground<'_, SLIDES, R>,
        node: &Node,
        side: usize,
        child: usize,
    ) -> Reached {
        let size_of_parts = node.size - 1;
        let size = if side == 0 {
            size_of_parts - node.right
        } else {
            node.right
        };
        let is_leaf = size == 0;
        // The code reads the values of a leaf and of a node and then chooses, because the processor
        // would often mispredict a branch.
        let place = ground.tree.turns[2 * (node.rank as usize + side)];
        let lowest = ground.gaps[place as usize];
        let closes_of_child = self.closes[child];
        let known_of_child = self.known[child];
        let closes = if is_leaf { lowest } else { closes_of_child };
        let known = if is_leaf { [place; 2] } else { known_of_child };
        let need = node.gap - closes;
        let sure_length = ground.least_length(known[0] as usize, known[1] as usize);
        if ground.rule.surely_bears(need, sure_length) {
            return Reached { closes, known };
        }
        let gap = if is_leaf {
            closes
        } else {
            ground.tree.nodes[child].gap
        };
        let start = BranchStart { closes, known, gap };
        let parent = ground.tree.maximum(node);
        let reached = ground.climb(start, parent, &mut self.evaluations);
        if !is_leaf {
            self.known[child] = reached.known;
        }
        reached
    }

    /// Lists the runs of a loading from right to left, in the order that [`Run`] describes. A run
    /// is a patch over a range of indentations in which the edges of the patch do not jump. `held`
    /// are the patches that are in contact at the beginning of the loading.
    ///
    /// # Errors
    /// Returns [`ContactError::OutOfMemory`] if an array does not fit into memory.
    pub fn list<const SLIDES: bool, R: DetachmentRule>(
        &self,
        ground: &Ground<'_, SLIDES, R>,
        held: &[HeldPatch],
    ) -> Result<RunList, ContactError> {
        let mut closes = Cow::Borrowed(self.closes.as_slice());
        if !held.is_empty() {
            closes = Cow::Owned(gathered(self.closes.len(), self.closes.iter().copied())?);
        }
        let mut loading = Loading {
            ground,
            held,
            closes,
            known: &self.known,
            listed: RunList {
                runs: Vec::new(),
                end: f64::NEG_INFINITY,
                evaluations: 0,
            },
        };
        loading.close_around()?;
        loading.list()?;
        Ok(loading.listed)
    }
}

impl<const SLIDES: bool, R: DetachmentRule> Loading<'_, SLIDES, R> {
    /// Splits a range of indices of held patches into the patches to the left and to the right of a
    /// spring.
    fn split(&self, held: &Range<usize>, spring: usize) -> [Range<usize>; 2] {
        let inside = &self.held[held.clone()];
        let left_count = inside.partition_point(|patch| (patch.first as usize) < spring);
        let middle = held.start + left_count;
        [held.start..middle, middle..held.end]
    }

    /// Returns the held patch of a range if it lies on the branch `branch` itself, and not on a
    /// branch below.
    fn held_on(&self, held: &Range<usize>, branch: Branch) -> Option<&HeldPatch> {
        if held.len() != 1 {
            return None;
        }
        let patch = self.held.get(held.start)?;
        (patch.branch == branch).then_some(patch)
    }

    /// Finds the indentations at which the nodes around held patches close. All other nodes close
    /// as on a loading from separation.
    fn close_around(&mut self) -> Result<(), ContactError> {
        let tree = self.ground.tree;
        let all = 0..self.held.len();
        let mut waiting = vec![(tree.root(), all)];
        let mut around = Vec::new();
        // The walk adds each node to `around` before the nodes in its two parts.
        while let Some((branch, held)) = waiting.pop() {
            let Ok(node) = branch.origin() else {
                continue;
            };
            if held.is_empty() || self.held_on(&held, branch).is_some() {
                continue;
            }
            let held_in_parts = self.split(&held, tree.maximum(&tree.nodes[node]));
            for part in tree.parts(node).into_iter().zip(held_in_parts) {
                push(&mut waiting, part)?;
            }
            push(&mut around, (node, held))?;
        }
        for (node, held) in around.into_iter().rev() {
            let spring = tree.maximum(&tree.nodes[node]);
            let held_in_parts = self.split(&held, spring);
            let mut closes = f64::INFINITY;
            for (part, held) in tree.parts(node).into_iter().zip(held_in_parts) {
                let start = self.start(part, self.held_on(&held, part));
                let reached = self
                    .ground
                    .climb(start, spring, &mut self.listed.evaluations);
                closes = smaller(closes, reached.closes);
            }
            self.closes.to_mut()[node] = closes;
        }
        Ok(())
    }

    /// Returns the beginning of a branch: the patch held on the branch, if there is one, otherwise
    /// the springs that are in contact when the branch closes.
    fn start(&self, branch: Branch, held: Option<&HeldPatch>) -> BranchStart {
        let ground = self.ground;
        if let Some(patch) = held {
            let known = [patch.first, patch.last];
            return BranchStart {
                closes: f64::NEG_INFINITY,
                known,
                gap: ground.span(branch, known).gap,
            };
        }
        match branch.origin() {
            Ok(node) => BranchStart {
                closes: self.closes[node],
                known: self.known[node],
                gap: ground.tree.nodes[node].gap,
            },
            Err(rank) => {
                let spring = ground.tree.minimum(rank);
                let gap = ground.gaps[spring];
                BranchStart {
                    closes: gap,
                    known: [spring as u32; 2],
                    gap,
                }
            }
        }
    }

    /// Lists the runs of the loading. Also finds the smallest indentation of full contact in m.
    fn list(&mut self) -> Result<(), ContactError> {
        let tree = self.ground.tree;
        let mut visits = vec![Visit {
            branch: tree.root(),
            merges: f64::INFINITY,
            parent: usize::MAX,
            held: 0..self.held.len(),
        }];
        while let Some(visit) = visits.pop() {
            let held = self.held_on(&visit.held, visit.branch).copied();
            let start = self.start(visit.branch, held.as_ref());
            let node = visit.branch.origin().ok();
            let lowest = node.map_or(start.gap, |node| tree.nodes[node].lowest);
            // A branch with held patches is always visited, because on a loading springs in contact
            // stay in contact under any stretch.
            if lowest >= visit.merges && visit.held.is_empty() {
                continue;
            }
            if start.closes < visit.merges {
                self.climb(&visit, start, held.and_then(|patch| patch.pin))?;
            }
            // A held patch contains the springs of both parts of its branch, so these parts have no
            // runs of their own.
            let (Some(node), None) = (node, held) else {
                continue;
            };
            let parent = tree.maximum(&tree.nodes[node]);
            let held_in_parts = self.split(&visit.held, parent);
            for (branch, held) in tree.parts(node).into_iter().zip(held_in_parts) {
                let part = Visit {
                    branch,
                    merges: smaller(start.closes, visit.merges),
                    parent,
                    held,
                };
                push(&mut visits, part)?;
            }
        }
        Ok(())
    }

    /// Lists the runs of one branch, the largest run first. `pin` is the height in m of pinned
    /// edges above the largest gap if the branch begins with a held patch that is pinned.
    fn climb(
        &mut self,
        visit: &Visit,
        start: BranchStart,
        pin: Option<f64>,
    ) -> Result<(), ContactError> {
        let ground = self.ground;
        let gaps = ground.gaps;
        let runs_before = self.listed.runs.len();
        let mut ascent = Ascent {
            branch: visit.branch,
            merges: visit.merges,
            span: ground.lowest(start),
            closes: start.closes,
            pin,
            below: None,
        };
        loop {
            let Some(wall) = ascent.span.wall(gaps) else {
                self.list_full_contact(&ascent)?;
                break;
            };
            let Span { first, last, .. } = ascent.span;
            let need = gaps[wall] - ascent.closes;
            let mut attaches = ascent.closes;
            if ground
                .rule
                .surely_bears(need, ground.least_length(first, last))
            {
                ascent.below = None;
            } else {
                attaches = self.list_span(&mut ascent, gaps[wall])?;
            }
            if wall == visit.parent || attaches >= visit.merges {
                break;
            }
            ascent.span = ascent.span.with(gaps, wall);
            ascent.closes = attaches;
        }
        self.listed.runs[runs_before..].reverse();
        Ok(())
    }

    /// Adds the run of the patch that fills the whole profile to the list.
    fn list_full_contact(&mut self, ascent: &Ascent) -> Result<(), ContactError> {
        self.listed.end = ascent.closes;
        if ascent.closes < ascent.merges {
            let run = Run::new(ascent.branch, &ascent.span, ascent.closes, ascent.merges);
            push(&mut self.listed.runs, run)?;
        }
        Ok(())
    }

    /// Adds the patch with the present springs of a walk to the list of runs. Returns the
    /// indentation in m at which the patch attaches the next spring, whose gap is `wall_gap` in m.
    #[inline]
    fn list_span(&mut self, ascent: &mut Ascent, wall_gap: f64) -> Result<f64, ContactError> {
        let ground = self.ground;
        let RunList {
            runs, evaluations, ..
        } = &mut self.listed;
        *evaluations += 1;
        let Ascent {
            branch,
            merges,
            span,
            ..
        } = *ascent;
        let levels = ground.levels(&span);
        let attaches = larger(ascent.closes, ground.attachment(&levels, wall_gap));
        let end = smaller(attaches, merges);
        if let Some(rise) = ascent.pin.take() {
            let (released, _) = levels.release(ground.rule, rise);
            let released = smaller(released, end);
            let mut pinned = Run::new(branch, &span, ascent.closes, released);
            pinned.pin = rise;
            push(runs, pinned)?;
            ascent.closes = released;
        }
        if ascent.closes >= end {
            ascent.below = None;
            return Ok(attaches);
        }
        match (runs.last_mut(), ascent.below) {
            (Some(run), Some(lower)) if ground.slides_on(&lower, &levels) => {
                run.to = end;
                run.top = span.ends();
            }
            _ => push(runs, Run::new(branch, &span, ascent.closes, end))?,
        }
        ascent.below = Some(levels);
        Ok(attaches)
    }
}

impl<const SLIDES: bool, R: DetachmentRule> Ground<'_, SLIDES, R> {
    /// Follows a branch from its beginning up to the spring `parent`. φ in m is the indentation at
    /// which the patch attaches its next spring. The branch attaches `parent` at the largest φ on
    /// its way, but not before the branch begins.
    ///
    /// If a patch contains at least n cells, φ at the gap b is at most b − Δl_max(n). With this
    /// bound, φ needs no evaluation for most springs on the way.
    #[inline(never)]
    fn climb(&self, start: BranchStart, parent: usize, evaluations: &mut u64) -> Reached {
        let gaps = self.gaps;
        let mut span = self.lowest(start);
        let known = span.ends();
        let mut closes = start.closes;
        // The largest patch of the branch is evaluated first, because φ is mostly largest there.
        let top = self.below(&span, parent);
        if self.may_rise(closes, gaps[parent], &top) {
            *evaluations += 1;
            closes = larger(closes, self.attaches_at(&top, gaps[parent]));
        }
        if !self.may_rise(closes, top.gap, &span) {
            return Reached { closes, known };
        }
        span = span.up_to(gaps, self.sure_level(&span, closes), top.ends());
        while let Some(wall) = span.wall(gaps).filter(|&wall| wall != parent) {
            if self.may_rise(closes, gaps[wall], &span) {
                *evaluations += 1;
                closes = larger(closes, self.attaches_at(&span, gaps[wall]));
            }
            span = span.with(gaps, wall);
        }
        Reached { closes, known }
    }

    /// Returns true if a patch may attach a spring of this gap only above the indentation `closes`.
    /// Returns false if it certainly attaches the spring at `closes`. Both values are in m.
    #[inline]
    fn may_rise(&self, closes: f64, gap: f64, span: &Span) -> bool {
        let need = gap - closes;
        need > 0.0
            && !self
                .rule
                .surely_bears(need, self.least_length(span.first, span.last))
    }

    /// Returns the smallest patch of a branch: the springs that attach at the beginning of the
    /// branch, and their neighbours with smaller gaps.
    #[inline]
    fn lowest(&self, start: BranchStart) -> Span {
        let gap = start.gap;
        let mut first = start.known[0] as usize;
        let mut last = start.known[1] as usize;
        while first > 0 && self.gaps[first - 1] < gap {
            first -= 1;
        }
        while last + 1 < self.gaps.len() && self.gaps[last + 1] <= gap {
            last += 1;
        }
        Span { gap, first, last }
    }

    /// Returns the largest patch of a branch, which reaches up to the spring `parent`.
    fn below(&self, span: &Span, parent: usize) -> Span {
        let parent_gap = self.gaps[parent];
        let mut beside = *span;
        if parent > span.last {
            beside.last = parent - 1;
            beside.up_to(self.gaps, parent_gap, [0, parent as u32 - 1])
        } else {
            beside.first = parent + 1;
            let last_spring = self.gaps.len() as u32 - 1;
            beside.up_to(self.gaps, parent_gap, [parent as u32 + 1, last_spring])
        }
    }
}

/// A node fits into half a cache line, so that one access to memory reads its gap and its lowest
/// gap.
const _: () = assert!(size_of::<Node>() == 32);
