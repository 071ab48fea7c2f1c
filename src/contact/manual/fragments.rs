//! The fragments in contact as a set that changes event by event, with the next event always known.

use super::start::whole_spans;
use super::winner_tree::WinnerTree;
use crate::contact::adhesive::{Branch, ContactTree, EdgeModel, Ground, Held, Node, Span};
use crate::contact::{ContactError, ContactTotals, reserve, resized};
use std::sync::Arc;

/// In place of the parent of the branch that fills the line.
const NO_PARENT: u32 = u32::MAX;

/// Key of a slot to which nothing can happen.
const NEVER: f64 = f64::INFINITY;

/// The fragments in contact, each a span of one branch of the contact tree.
///
/// No two fragments begin at the same leaf of the tree, a local minimum of the gap. So the leaves, in their order along
/// the line, are slots: a slot holds the fragment that begins at its leaf, or its leaf is inside of a fragment, or
/// free. Two winner trees over the slots give the next event: the one that attaches next when the indentation grows,
/// and the one that detaches next when it falls. Both hold at any time, so that a turn costs nothing.
pub struct FragmentSet<E> {
    gaps: Vec<f64>,
    tree: Arc<ContactTree>,
    edges: E,
    /// Node above each branch: that of node j at 2 j, that of leaf j at 2 j + 1.
    parents: Vec<u32>,
    slots: Vec<Slot>,
    /// Indentations at which a free leaf touches or a fragment attaches its wall, m.
    attaching: WinnerTree,
    /// Indentations, negated, to which fragments hold their most stretched springs.
    detaching: WinnerTree,
    totals: ContactTotals,
    /// Fragments that the last one to form was made of, or into which the last one to detach has parted.
    parts: Vec<Fragment>,
    /// Former contents of slots, in the order of their changes, while changes may be taken back.
    journal: Option<Vec<(u32, Slot)>>,
    /// Springs, slots and nodes of the winner trees looked at or changed so far.
    touched: u64,
}

/// The contact at a leaf.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Slot {
    /// Its spring is not in contact.
    Free,
    /// Part of a fragment that begins at an earlier leaf.
    Inside,
    /// The fragment that begins here.
    Fragment(Held),
}

/// A fragment and the slot in which it begins.
#[derive(Clone, Copy, Debug)]
pub struct Fragment {
    /// Slot.
    pub slot: usize,
    /// Its springs.
    pub span: Span,
}

/// One change of the contact, between a fragment and the parts it is made of ([`FragmentSet::parts`]).
#[derive(Clone, Copy, Debug)]
pub struct Event {
    /// The fragment that forms or that detaches a spring.
    pub whole: Fragment,
    /// Springs that attach or detach.
    pub springs: u64,
}

impl<E: EdgeModel> FragmentSet<E> {
    /// The largest spans that a fragment can fill with springs of these runs alone, given by first and last spring;
    /// O(N) and O(n log n) of n runs. Springs beyond the line are left out.
    ///
    /// # Errors
    /// [`ContactError::OutOfMemory`].
    pub fn new(
        gaps: &[f64],
        tree: Arc<ContactTree>,
        edges: E,
        runs: &[(usize, usize)],
    ) -> Result<Self, ContactError> {
        debug_assert_eq!(tree.edges(), E::EDGES, "the tree sums for other edges");
        let mut own: Vec<f64> = reserve(gaps.len())?;
        own.extend_from_slice(gaps);
        let leaves = tree.turns().len().div_ceil(2);
        let mut parents = resized(Vec::new(), 2 * leaves, NO_PARENT)?;
        for node in 0..tree.len() {
            for part in tree.parts(node) {
                parents[place_of(part)] = node as u32;
            }
        }
        let slots = resized(Vec::new(), leaves, Slot::Free)?;
        let keys = || resized(Vec::new(), leaves, NEVER);
        let (mut attaching, mut detaching) = (keys()?, keys()?);
        let mut set = FragmentSet {
            gaps: own,
            tree,
            edges,
            parents,
            slots,
            attaching: WinnerTree::new(Vec::new())?,
            detaching: WinnerTree::new(Vec::new())?,
            totals: ContactTotals::default(),
            parts: Vec::new(),
            journal: None,
            touched: 0,
        };
        for span in whole_spans(&set.gaps, runs)? {
            set.put_in_contact(&span);
        }
        for (slot, (attaches, detaches)) in attaching.iter_mut().zip(&mut detaching).enumerate() {
            (*attaches, *detaches) = set.keys(slot);
        }
        (set.attaching, set.detaching) = (WinnerTree::new(attaching)?, WinnerTree::new(detaching)?);
        Ok(set)
    }

    /// Fills the slots of a span.
    fn put_in_contact(&mut self, span: &Span) {
        let turns = self.tree.turns();
        // Minima are at the even places.
        let leaf_from = |spring: usize| turns.partition_point(|&turn| (turn as usize) < spring).div_ceil(2);
        let (first, end) = (leaf_from(span.first), leaf_from(span.last + 1));
        // The smallest branch from the first leaf on that reaches the last one.
        let mut branch = Branch::leaf(first);
        while self.leaves(branch).1 + 1 < end
            && let Some(node) = self.parent(branch)
        {
            branch = Branch::node(node);
        }
        debug_assert_eq!(self.leaves(branch), (first, end - 1), "a span holds whole subtrees");
        let [first_spring, last_spring] = span.ends();
        self.slots[first..end].fill(Slot::Inside);
        self.slots[first] = Slot::Fragment(Held { branch, first: first_spring, last: last_spring });
        self.totals += self.ground().totals(span);
    }

    /// The line under its rule.
    #[inline]
    pub fn ground(&self) -> Ground<'_, E> {
        Ground { gaps: &self.gaps, tree: &self.tree, edges: self.edges }
    }

    /// Whole springs or cells in contact.
    #[inline]
    pub fn totals(&self) -> ContactTotals {
        self.totals
    }

    /// Springs, slots and nodes looked at or changed so far.
    #[inline]
    pub fn touched(&self) -> u64 {
        self.touched
    }

    /// The fragments, in ascending order along the line.
    pub fn fragments(&self) -> impl Iterator<Item = Fragment> {
        let slots = std::iter::successors(self.detaching.occupied_from(0), |slot| {
            self.detaching.occupied_from(slot + 1)
        });
        slots.filter_map(|slot| match self.slots[slot] {
            Slot::Fragment(held) => Some(Fragment { slot, span: self.span(held) }),
            Slot::Free | Slot::Inside => None,
        })
    }

    /// Parts of the last event, in ascending order along the line.
    #[inline]
    pub fn parts(&self) -> &[Fragment] {
        &self.parts
    }

    /// Smallest indentation at which the next spring attaches, m.
    #[inline]
    pub fn attaches_next(&self) -> Option<f64> {
        self.attaching.first().map(|(_, key)| key)
    }

    /// Smallest indentation at which nothing in contact has detached, m.
    #[inline]
    pub fn detaches_next(&self) -> Option<f64> {
        self.detaching.first().map(|(_, key)| -key)
    }

    /// Attaches the next spring: a free leaf or the wall of a fragment. Where the wall is the node above the branch
    /// of the fragment, all of its subtree, no gap of which is larger, becomes one fragment.
    pub fn attach(&mut self) -> Option<Event> {
        let (slot, _) = self.attaching.first()?;
        let before = self.totals;
        self.parts.clear();
        let whole = match self.slots[slot] {
            Slot::Free => {
                let spring = self.tree.minimum(slot) as u32;
                self.replace(slot, Held { branch: Branch::leaf(slot), first: spring, last: spring })
            }
            Slot::Inside => return None,
            Slot::Fragment(held) => {
                let span = self.span(held);
                let wall = span.wall(&self.gaps)?;
                match self.parent(held.branch) {
                    Some(node) if self.tree.maximum(&self.tree.nodes()[node]) == wall => self.merge(node),
                    _ => {
                        self.take_part(Fragment { slot, span });
                        let [first, last] = span.with(&self.gaps, wall).ends();
                        self.replace(slot, Held { first, last, ..held })
                    }
                }
            }
        };
        self.totals += self.ground().totals(&whole.span);
        let springs = (self.totals.springs - before.springs).unsigned_abs();
        // One of them is in an entry of its slot.
        self.touched += springs - 1;
        Some(Event { whole, springs })
    }

    /// Makes all springs of the subtree of a node one fragment.
    fn merge(&mut self, node: usize) -> Fragment {
        let Node { gap, .. } = self.tree.nodes()[node];
        let branch = Branch::node(node);
        let (first, last) = self.leaves(branch);
        let mut known: Option<(usize, usize)> = None;
        // Slots that follow each other are settled together.
        let mut changed = first..first;
        let mut slot = first;
        while slot <= last {
            let (held, next) = match self.slots[slot] {
                Slot::Fragment(held) => {
                    self.take_part(Fragment { slot, span: self.span(held) });
                    ((held.first as usize, held.last as usize), self.leaves(held.branch).1 + 1)
                }
                Slot::Free | Slot::Inside => ((self.tree.minimum(slot), self.tree.minimum(slot)), slot + 1),
            };
            known = Some((known.map_or(held.0, |(first, _)| first), held.1));
            if slot != changed.end {
                self.settle(changed);
                changed = slot..slot;
            }
            self.set(slot, Slot::Inside);
            changed.end = slot + 1;
            slot = next;
        }
        self.settle(changed);
        let spring = self.tree.maximum(&self.tree.nodes()[node]);
        let [first_spring, last_spring] =
            Span::around(&self.gaps, known.unwrap_or((spring, spring)), gap).ends();
        self.replace(first, Held { branch, first: first_spring, last: last_spring })
    }

    /// Detaches the next spring, the most stretched one of a fragment: an outermost one as long as the fragment fills
    /// more than the lowest span of its branch, then that of the node from which the branch begins, between its two
    /// parts.
    pub fn detach(&mut self) -> Option<Event> {
        let (slot, _) = self.detaching.first()?;
        let Slot::Fragment(held) = self.slots[slot] else { return None };
        let span = self.span(held);
        self.parts.clear();
        self.totals += -self.ground().totals(&span);
        let [first, last] = span.ends();
        if self.is_lowest(held.branch, &span) {
            match held.branch.origin() {
                Err(_) => {
                    self.set(slot, Slot::Free);
                    self.settle(slot..slot + 1);
                }
                Ok(index) => {
                    let node = self.tree.nodes()[index];
                    let place = self.tree.maximum(&node) as u32;
                    let [left, right] = self.tree.parts(index);
                    self.part(slot, Held { branch: left, first, last: place - 1 });
                    self.part(node.rank as usize + 1, Held { branch: right, first: place + 1, last });
                }
            }
        } else if self.gaps[span.first] >= self.gaps[span.last] {
            self.part(slot, Held { first: first + 1, ..held });
        } else {
            self.part(slot, Held { last: last - 1, ..held });
        }
        Some(Event { whole: Fragment { slot, span }, springs: 1 })
    }

    /// Returns true for the span with which its branch begins. Among equal gaps the leftmost is the outermost.
    fn is_lowest(&self, branch: Branch, span: &Span) -> bool {
        let (left, right) = (self.gaps[span.first], self.gaps[span.last]);
        match branch.origin() {
            Ok(node) => {
                let gap = self.tree.nodes()[node].gap;
                left < gap && right <= gap
            }
            Err(_) => span.first == span.last,
        }
    }

    /// Notes a fragment that becomes part of another one.
    fn take_part(&mut self, part: Fragment) {
        self.totals += -self.ground().totals(&part.span);
        self.parts.push(part);
    }

    /// Lets a part of a fragment remain.
    fn part(&mut self, slot: usize, held: Held) {
        let part = self.replace(slot, held);
        self.totals += self.ground().totals(&part.span);
        self.parts.push(part);
    }

    /// Puts a fragment into a slot.
    fn replace(&mut self, slot: usize, held: Held) -> Fragment {
        self.set(slot, Slot::Fragment(held));
        self.settle(slot..slot + 1);
        Fragment { slot, span: self.span(held) }
    }

    /// From here on changes can be taken back.
    pub fn keep_journal(&mut self) {
        self.journal = Some(Vec::new());
    }

    /// Forgets the changes that could be taken back.
    pub fn drop_journal(&mut self) {
        self.journal = None;
    }

    /// Takes back all changes since the journal was begun, when these were the totals.
    pub fn take_back(&mut self, totals: ContactTotals) {
        for (slot, was) in self.journal.take().into_iter().flatten().rev() {
            self.set(slot as usize, was);
            self.settle(slot as usize..slot as usize + 1);
        }
        self.totals = totals;
    }

    #[inline]
    fn span(&self, held: Held) -> Span {
        self.ground().span(held.branch, [held.first, held.last])
    }

    #[inline]
    fn parent(&self, branch: Branch) -> Option<usize> {
        let parent = self.parents[place_of(branch)];
        (parent != NO_PARENT).then_some(parent as usize)
    }

    /// First and last leaf of a branch.
    fn leaves(&self, branch: Branch) -> (usize, usize) {
        match branch.origin() {
            Ok(index) => {
                let Node { rank, size, right, .. } = self.tree.nodes()[index];
                let left = size - 1 - right;
                ((rank - left) as usize, (rank + right) as usize + 1)
            }
            Err(rank) => (rank, rank),
        }
    }

    /// Keys of a slot in the winner trees of attaching and detaching.
    fn keys(&self, slot: usize) -> (f64, f64) {
        match self.slots[slot] {
            Slot::Free => (self.gaps[self.tree.minimum(slot)], NEVER),
            Slot::Inside => (NEVER, NEVER),
            Slot::Fragment(held) => {
                let span = self.span(held);
                let length = self.edges.length(&self.gaps, &span);
                let attaches = span
                    .wall(&self.gaps)
                    .map_or(NEVER, |wall| self.edges.attaches_at(&span, length, self.gaps[wall]));
                // A slot with a fragment must not seem empty, however far it holds.
                (attaches, (-self.edges.holds_to(&span, length)).min(f64::MAX))
            }
        }
    }

    /// Sets a slot and its keys, which count from [`FragmentSet::settle`] on.
    fn set(&mut self, slot: usize, becomes: Slot) {
        let was = std::mem::replace(&mut self.slots[slot], becomes);
        if let Some(journal) = &mut self.journal {
            journal.push((slot as u32, was));
        }
        let (attaches, detaches) = self.keys(slot);
        self.attaching.set(slot, attaches);
        self.detaching.set(slot, detaches);
        self.touched += 1;
    }

    /// Updates the winner trees above slots that were set.
    fn settle(&mut self, slots: std::ops::Range<usize>) {
        if !slots.is_empty() {
            let (first, last) = (slots.start, slots.end - 1);
            self.touched += self.attaching.settle(first, last) + self.detaching.settle(first, last);
        }
    }
}

/// Place of a branch among all.
#[inline]
fn place_of(branch: Branch) -> usize {
    match branch.origin() {
        Ok(node) => 2 * node,
        Err(rank) => 2 * rank + 1,
    }
}
