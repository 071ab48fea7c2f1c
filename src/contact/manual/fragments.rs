//! The fragments in contact as a set that changes event by event, with the next event always known.

use super::start::whole_spans;
use super::winner_tree::WinnerTree;
use crate::contact::adhesive::{Branch, ContactTree, EdgeModel, Ground, Held, Node, Span};
use crate::contact::{ContactError, ContactTotals, Direction, reserve, resized};
use std::sync::Arc;

/// In place of the parent of the branch that fills the line.
const NO_PARENT: u32 = u32::MAX;

/// Key of a slot without a next event.
const NEVER: f64 = f64::INFINITY;

/// The fragments in contact, each a span of one branch of the contact tree.
///
/// No two fragments begin at the same leaf of the tree, a local minimum of the gap. So the leaves, in their order along
/// the line, are slots: a slot holds the fragment that begins at its leaf, or its leaf lies inside a fragment, or is
/// free. Two winner trees over the slots yield the next event: the one that attaches next when the indentation grows,
/// and the one that detaches next when it falls. Both hold at any time, so that a turn costs nothing.
pub struct FragmentSet<E> {
    gaps: Vec<f64>,
    tree: Arc<ContactTree>,
    /// Edges under the rule by which springs attach.
    closing: E,
    /// Edges under the rule by which springs detach.
    opening: E,
    /// True where edges keep their place at first when the direction turns.
    pins: bool,
    direction: Direction,
    /// Node above each branch: that of node j at 2 j, that of leaf j at 2 j + 1.
    parents: Vec<u32>,
    slots: Vec<Slot>,
    /// Indentations at which a free leaf touches or a fragment attaches its wall, m.
    attaching: WinnerTree,
    /// Indentations, negated, to which fragments hold their most stretched springs.
    detaching: WinnerTree,
    totals: ContactTotals,
    /// Fragments merged by the last event, or left by it.
    parts: Vec<Fragment>,
    /// Present while changes can be undone: the former direction, and former contents of slots in the order of their
    /// changes.
    journal: Option<(Direction, Vec<(u32, Slot)>)>,
    /// Springs, slots and nodes of the winner trees read or changed so far.
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
    /// Height of the level of pinned edges above its largest gap, m; `None` where the edges slide.
    pub pin: Option<f64>,
}

/// One change of the contact, between a fragment and its parts ([`FragmentSet::parts`]).
#[derive(Clone, Copy, Debug)]
pub struct Event {
    /// The fragment that forms or that detaches a spring.
    pub whole: Fragment,
    /// Springs that attach or detach; none where pinned edges begin to slide.
    pub springs: u64,
}

impl<E: EdgeModel> FragmentSet<E> {
    /// Returns the largest spans that a fragment can fill with springs of these runs alone, given by first and last
    /// spring; O(N) and O(n log n) of n runs. Springs beyond the line are left out. Edges that can be pinned are
    /// pinned, each fragment at the rise `rise_of` its span, m.
    ///
    /// # Errors
    /// [`ContactError::OutOfMemory`].
    pub fn new(
        gaps: &[f64],
        tree: Arc<ContactTree>,
        edges: E,
        runs: &[(usize, usize)],
        rise_of: impl Fn(Ground<'_, E>, &Span) -> f64,
    ) -> Result<Self, ContactError> {
        assert_eq!(tree.edges(), E::EDGES, "the tree sums for other edges");
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
            closing: edges.on(Direction::Loading),
            opening: edges.on(Direction::Unloading),
            pins: edges.are_pinned(),
            direction: Direction::Loading,
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
            let pin = set.pins.then(|| rise_of(set.ground(), &span));
            set.put_in_contact(&span, pin);
        }
        for (slot, (attaches, detaches)) in attaching.iter_mut().zip(&mut detaching).enumerate() {
            (*attaches, *detaches) = set.keys(slot);
        }
        (set.attaching, set.detaching) = (WinnerTree::new(attaching)?, WinnerTree::new(detaching)?);
        Ok(set)
    }

    /// Fills the slots of a span.
    fn put_in_contact(&mut self, span: &Span, pin: Option<f64>) {
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
        self.slots[first] = Slot::Fragment(Held { branch, first: first_spring, last: last_spring, pin });
        self.totals += self.ground().totals(span);
    }

    /// The line under the rule of the present direction.
    #[inline]
    pub fn ground(&self) -> Ground<'_, E> {
        let edges = match self.direction {
            Direction::Loading => self.closing,
            Direction::Unloading => self.opening,
        };
        Ground { gaps: &self.gaps, tree: &self.tree, edges }
    }

    /// Continues in a direction from an indentation, m: a turn pins sliding edges.
    pub fn turn(&mut self, direction: Direction, indentation: f64) {
        if direction != self.direction && self.pins {
            let sliding: Vec<Fragment> = self.fragments().filter(|fragment| fragment.pin.is_none()).collect();
            for fragment in sliding {
                let Slot::Fragment(held) = self.slots[fragment.slot] else { continue };
                let pin = Some(self.rise(&fragment, indentation));
                self.replace(fragment.slot, Held { pin, ..held });
            }
        }
        self.direction = direction;
    }

    /// Returns true if a spring can be stretched before it detaches.
    #[inline]
    pub fn adheres(&self) -> bool {
        self.opening.stretch() > 0.0
    }

    /// Whole springs or cells in contact.
    #[inline]
    pub fn totals(&self) -> ContactTotals {
        self.totals
    }

    /// Springs, slots and nodes read or changed so far.
    #[inline]
    pub fn touched(&self) -> u64 {
        self.touched
    }

    /// Height of the level of the edges of a fragment above its largest gap at an indentation, m.
    fn rise(&self, Fragment { span, pin, .. }: &Fragment, indentation: f64) -> f64 {
        self.ground().rise(span, *pin, indentation)
    }

    /// Heights of these levels for all fragments, in their order along the line; empty unless edges can be pinned.
    pub fn rises(&self, indentation: f64) -> Vec<f64> {
        let fragments = self.fragments().filter(|_| self.pins);
        fragments.map(|fragment| self.rise(&fragment, indentation)).collect()
    }

    /// The fragments, in ascending order along the line.
    pub fn fragments(&self) -> impl Iterator<Item = Fragment> {
        let slots = std::iter::successors(self.detaching.occupied_from(0), |slot| {
            self.detaching.occupied_from(slot + 1)
        });
        slots.filter_map(|slot| match self.slots[slot] {
            Slot::Fragment(held) => Some(self.fragment(slot, held)),
            Slot::Free | Slot::Inside => None,
        })
    }

    /// Parts of the last event, in ascending order along the line.
    #[inline]
    pub fn parts(&self) -> &[Fragment] {
        &self.parts
    }

    /// Indentation of the next event in the present direction, m: the smallest one at which a spring attaches, or the
    /// smallest one that holds all springs in contact.
    #[inline]
    pub fn next_event(&self) -> Option<f64> {
        match self.direction {
            Direction::Loading => self.attaching.first().map(|(_, key)| key),
            Direction::Unloading => self.detaching.first().map(|(_, key)| -key),
        }
    }

    /// Performs the next event.
    pub fn change(&mut self) -> Option<Event> {
        match self.direction {
            Direction::Loading => self.attach(),
            Direction::Unloading => self.detach(),
        }
    }

    /// Attaches the next spring: a free leaf or the wall of a fragment. Where the wall is the node above the branch
    /// of the fragment, all of its subtree, no gap of which is larger, becomes one fragment.
    fn attach(&mut self) -> Option<Event> {
        let (slot, _) = self.attaching.first()?;
        let before = self.totals;
        self.parts.clear();
        let whole = match self.slots[slot] {
            Slot::Free => {
                let spring = self.tree.minimum(slot) as u32;
                self.replace(
                    slot,
                    Held { branch: Branch::leaf(slot), first: spring, last: spring, pin: None },
                )
            }
            Slot::Inside => return None,
            Slot::Fragment(held) if held.pin.is_some() => return Some(self.release(slot, held)),
            Slot::Fragment(held) => {
                let span = self.span(held);
                let wall = span.wall(&self.gaps)?;
                match self.parent(held.branch) {
                    Some(node) if self.tree.maximum(&self.tree.nodes()[node]) == wall => self.merge(node),
                    _ => {
                        self.take_part(self.fragment(slot, held));
                        let [first, last] = span.with(&self.gaps, wall).ends();
                        self.replace(slot, Held { first, last, ..held })
                    }
                }
            }
        };
        self.totals += self.ground().totals(&whole.span);
        let springs = (self.totals.springs - before.springs).unsigned_abs();
        // One of the springs is already counted with its slot.
        self.touched += springs - 1;
        Some(Event { whole, springs })
    }

    /// Merges all springs of the subtree of a node into one fragment.
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
                    self.take_part(self.fragment(slot, held));
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
        self.replace(first, Held { branch, first: first_spring, last: last_spring, pin: None })
    }

    /// Detaches the next spring, the most stretched one of a fragment: an outermost one as long as the fragment fills
    /// more than the lowest span of its branch, then that of the node from which the branch begins, between its two
    /// parts.
    fn detach(&mut self) -> Option<Event> {
        let (slot, _) = self.detaching.first()?;
        let Slot::Fragment(held) = self.slots[slot] else { return None };
        self.parts.clear();
        let whole = self.fragment(slot, held);
        let span = whole.span;
        if let Some(rise) = held.pin {
            let (_, slides) = self.opening.levels(&self.gaps, &span).release(self.opening.stretch(), rise);
            if slides {
                return Some(self.release(slot, held));
            }
        }
        self.totals += -self.ground().totals(&span);
        let held = Held { pin: None, ..held };
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
                    self.part(slot, Held { branch: left, last: place - 1, ..held });
                    self.part(node.rank as usize + 1, Held { branch: right, first: place + 1, ..held });
                }
            }
        } else if self.gaps[span.first] >= self.gaps[span.last] {
            self.part(slot, Held { first: first + 1, ..held });
        } else {
            self.part(slot, Held { last: last - 1, ..held });
        }
        Some(Event { whole, springs: 1 })
    }

    /// Releases pinned edges, which then slide.
    fn release(&mut self, slot: usize, held: Held) -> Event {
        let whole = self.fragment(slot, held);
        self.replace(slot, Held { pin: None, ..held });
        Event { whole, springs: 0 }
    }

    /// Returns true for the lowest span of its branch. Among equal gaps the leftmost is the outermost.
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

    /// Moves a fragment that becomes part of another one from the totals to the parts.
    fn take_part(&mut self, part: Fragment) {
        self.totals += -self.ground().totals(&part.span);
        self.parts.push(part);
    }

    /// Keeps a part of a fragment in contact.
    fn part(&mut self, slot: usize, held: Held) {
        let part = self.replace(slot, held);
        self.totals += self.ground().totals(&part.span);
        self.parts.push(part);
    }

    /// Puts a fragment into a slot.
    fn replace(&mut self, slot: usize, held: Held) -> Fragment {
        self.set(slot, Slot::Fragment(held));
        self.settle(slot..slot + 1);
        self.fragment(slot, held)
    }

    #[inline]
    fn fragment(&self, slot: usize, held: Held) -> Fragment {
        Fragment { slot, span: self.span(held), pin: held.pin }
    }

    /// Makes later changes undoable.
    pub fn keep_journal(&mut self) {
        self.journal = Some((self.direction, Vec::new()));
    }

    /// Makes the changes so far permanent.
    pub fn drop_journal(&mut self) {
        self.journal = None;
    }

    /// Undoes all changes since the beginning of the journal, to these totals.
    pub fn take_back(&mut self, totals: ContactTotals) {
        if let Some((direction, changes)) = self.journal.take() {
            for (slot, was) in changes.into_iter().rev() {
                self.set(slot as usize, was);
                self.settle(slot as usize..slot as usize + 1);
            }
            self.direction = direction;
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
                let (closing, opening) = (self.closing, self.opening);
                let levels = opening.levels(&self.gaps, &span);
                let wall = span.wall(&self.gaps).map(|wall| self.gaps[wall]);
                let (attaches, holds) = match held.pin {
                    Some(rise) => {
                        let released = |edges: E| levels.release(edges.stretch(), rise).0;
                        (wall.map(|_| released(closing)), released(opening))
                    }
                    None => (wall.map(|wall| closing.attaches_at(&levels, wall)), opening.holds_to(&levels)),
                };
                // A slot with a fragment must not seem empty, however far it holds.
                (attaches.unwrap_or(NEVER), (-holds).min(f64::MAX))
            }
        }
    }

    /// Sets a slot and its keys, which take effect with [`FragmentSet::settle`].
    fn set(&mut self, slot: usize, becomes: Slot) {
        let was = std::mem::replace(&mut self.slots[slot], becomes);
        if let Some((_, changes)) = &mut self.journal {
            changes.push((slot as u32, was));
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

/// Index of a branch among all.
#[inline]
fn place_of(branch: Branch) -> usize {
    match branch.origin() {
        Ok(node) => 2 * node,
        Err(rank) => 2 * rank + 1,
    }
}
