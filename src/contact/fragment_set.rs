//! The fragments in contact as a set that changes event by event, with the next event always known.

use super::grid::CompensatedSum;
use super::tournament::Tournament;
use super::{ContactError, EdgeRule, GapScale, SpringTree, Tally, reserve};
use std::sync::Arc;

/// In place of the parent of the whole line.
const NO_PARENT: u32 = u32::MAX;

/// Whole subtrees of a tree that are in contact, none inside another, each one fragment.
///
/// The first node of any subtree in post-order is a leaf, and no two fragments begin at the same one. So
/// the leaves, in their order, are the slots of all there is to know: a slot holds the fragment that
/// begins at its leaf, or its leaf is inside of a fragment, or free. Two queues over the slots give the
/// next event: what joins next when the indentation grows, and what leaves next when it falls. Both are
/// true at any time, so a turn costs nothing.
pub struct FragmentSet<R> {
    tree: Arc<SpringTree>,
    rule: R,
    scale: GapScale,
    parents: Vec<u32>,
    /// Number of leaves before each node: of a leaf, its slot.
    leaves_before: Vec<u32>,
    leaves: Vec<u32>,
    slots: Vec<Slot>,
    /// Indentations at which a free leaf touches or a fragment takes in its parent.
    joining: Tournament,
    /// Indentations, negated, to which fragments hold their most stretched springs.
    leaving: Tournament,
    tally: Tally,
    /// What slots were, in the order of their changes, while they may have to be put back.
    journal: Option<Vec<(u32, Slot)>>,
    /// Springs, slots and nodes of the queues looked at or changed so far.
    touched: u64,
}

/// What is at a leaf.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Slot {
    /// A spring without contact.
    Free,
    /// Part of a fragment that begins at an earlier leaf.
    Inside,
    /// The fragment that fills the subtree of this node begins here.
    Fragment(u32),
}

/// Springs that joined or left in one event.
#[derive(Clone, Copy, Debug)]
pub struct Event {
    pub springs: u64,
    /// Σ of their squared stretches, m².
    pub squared_stretch: CompensatedSum,
}

/// What becomes part of a fragment.
#[derive(Clone, Copy, Debug)]
pub enum Joined {
    /// The spring of a node; the last of all is the root of the fragment.
    Spring(usize),
    /// The fragment that filled the subtree of a node.
    Fragment(usize),
}

impl<R: EdgeRule> FragmentSet<R> {
    /// The largest whole subtrees all of whose springs are in these runs, given by first and last
    /// spring; O(N). What lies beyond the line is not looked at.
    ///
    /// # Errors
    /// [`ContactError::OutOfMemory`].
    pub fn new(tree: Arc<SpringTree>, rule: R, runs: &[(usize, usize)]) -> Result<Self, ContactError> {
        let count = tree.len();
        let mut parents = filled(count, NO_PARENT)?;
        let mut leaves_before = reserve(count)?;
        let mut leaves = reserve(tree.shapes().iter().filter(|shape| shape.size == 1).count())?;
        for node in 0..count {
            leaves_before.push(leaves.len() as u32);
            let (left, right) = tree.children(node);
            if (left, right) == (None, None) {
                leaves.push(node as u32);
            }
            for child in left.into_iter().chain(right) {
                parents[child] = node as u32;
            }
        }
        let scale = GapScale::for_gaps_up_to(tree.gaps().last().copied().unwrap_or(0.0));
        let slots = filled(leaves.len(), Slot::Free)?;
        let (joining, leaving) = (filled(leaves.len(), 0.0)?, filled(leaves.len(), 0.0)?);
        let mut set = FragmentSet {
            tree,
            rule,
            scale,
            parents,
            leaves_before,
            leaves,
            slots,
            joining: Tournament::new(Vec::new())?,
            leaving: Tournament::new(Vec::new())?,
            tally: Tally::default(),
            journal: None,
            touched: 0,
        };
        set.put_in_contact(runs)?;
        set.open_queues(joining, leaving)?;
        Ok(set)
    }

    /// Fills the slots and the tally of these runs.
    fn put_in_contact(&mut self, runs: &[(usize, usize)]) -> Result<(), ContactError> {
        if runs.is_empty() {
            return Ok(());
        }
        let count = self.tree.len();
        let mut held = filled(count, false)?;
        for &(first, last) in runs {
            if let Some(run) = held.get_mut(first..last.saturating_add(1).min(count)) {
                run.fill(true);
            }
        }
        // Whether the whole subtree of a node is in contact.
        let mut whole: Vec<bool> = reserve(count)?;
        for (node, &position) in self.tree.positions().iter().enumerate() {
            let (left, right) = self.tree.children(node);
            let parts_are = left.into_iter().chain(right).all(|child| whole[child]);
            whole.push(held[position as usize] && parts_are);
        }
        let mut end = count;
        while end > 0 {
            let root = end - 1;
            if !whole[root] {
                end = root;
                continue;
            }
            let start = end - self.tree.size(root) as usize;
            let slot = self.leaves_before[start] as usize;
            let leaves = (start..end).filter(|&node| self.tree.size(node) == 1).count();
            self.slots[slot..slot + leaves].fill(Slot::Inside);
            self.slots[slot] = Slot::Fragment(root as u32);
            let quanta = (start..end).map(|node| self.quanta(node)).sum();
            self.tally += Tally { springs: (end - start) as i64, fragments: 1, quanta };
            end = start;
        }
        Ok(())
    }

    /// Builds both queues, in this memory.
    fn open_queues(&mut self, mut joining: Vec<f64>, mut leaving: Vec<f64>) -> Result<(), ContactError> {
        for (slot, (joins, leaves)) in joining.iter_mut().zip(&mut leaving).enumerate() {
            (*joins, *leaves) = self.keys(slot);
        }
        self.joining = Tournament::new(joining)?;
        self.leaving = Tournament::new(leaving)?;
        Ok(())
    }

    pub fn tally(&self) -> Tally {
        self.tally
    }

    pub fn scale(&self) -> &GapScale {
        &self.scale
    }

    pub fn touched(&self) -> u64 {
        self.touched
    }

    /// First and last spring of each fragment, in ascending order along the line.
    pub fn intervals(&self) -> impl Iterator<Item = (usize, usize)> {
        self.roots().map(|root| self.tree.interval(root))
    }

    /// Root of the subtree that each fragment fills, in ascending order along the line.
    pub fn roots(&self) -> impl Iterator<Item = usize> {
        let slots =
            std::iter::successors(self.leaving.occupied_from(0), |slot| self.leaving.occupied_from(slot + 1));
        slots.filter_map(|slot| match self.slots[slot] {
            Slot::Fragment(root) => Some(root as usize),
            Slot::Free | Slot::Inside => None,
        })
    }

    /// Smallest indentation at which the next spring joins.
    #[inline]
    pub fn joins_next(&self) -> Option<f64> {
        self.joining.first().map(|(_, key)| key)
    }

    /// Smallest indentation at which all that is in contact still is.
    #[inline]
    pub fn leaves_next(&self) -> Option<f64> {
        self.leaving.first().map(|(_, key)| -key)
    }

    /// Lets join what joins next, at indentation `level`: a free leaf, or the parent of a fragment with
    /// the whole of its subtree, no gap of which is larger.
    pub fn join(&mut self, level: f64) -> Option<Event> {
        self.join_seen(level, |_| {})
    }

    /// The same, and tells of each node that joins and each fragment that is taken in, in post-order.
    pub fn join_seen(&mut self, level: f64, see: impl FnMut(Joined)) -> Option<Event> {
        let (slot, _) = self.joining.first()?;
        let root = match self.slots[slot] {
            Slot::Free => self.leaves[slot],
            Slot::Fragment(part) => self.parents[part as usize],
            // Neither has a key.
            Slot::Inside => return None,
        };
        Some(self.fill(root as usize, level, see))
    }

    fn fill(&mut self, root: usize, level: f64, mut see: impl FnMut(Joined)) -> Event {
        let start = root + 1 - self.tree.size(root) as usize;
        let mut event = Event { springs: 0, squared_stretch: CompensatedSum::default() };
        let mut joins = Tally { springs: 0, fragments: 1, quanta: 0 };
        // Slots that follow each other are settled together.
        let first = self.leaves_before[start] as usize;
        let mut run = first..first;
        let mut becomes = Slot::Fragment(root as u32);
        let mut node = start;
        while node <= root {
            self.touched += 1;
            let mut follows = node + 1;
            let mut is_free = true;
            if self.tree.size(node) == 1 {
                let slot = self.leaves_before[node] as usize;
                if slot != run.end {
                    self.settle(run);
                    run = slot..slot;
                }
                run.end = slot + 1;
                if let Slot::Fragment(part) = self.set(slot, becomes) {
                    (follows, is_free) = (part as usize + 1, false);
                    joins.fragments -= 1;
                    see(Joined::Fragment(part as usize));
                }
                becomes = Slot::Inside;
            }
            if is_free {
                see(Joined::Spring(node));
                joins.springs += 1;
                joins.quanta += self.quanta(node);
                event.squared_stretch.add(squared_stretch(self.tree.gap(node), level));
            }
            node = follows;
        }
        self.settle(run);
        self.tally += joins;
        event.springs = joins.springs.unsigned_abs();
        event
    }

    /// Root of the fragment whose spring leaves next: that spring's node.
    pub fn leaves_from(&self) -> Option<usize> {
        let (slot, _) = self.leaving.first()?;
        match self.slots[slot] {
            Slot::Fragment(root) => Some(root as usize),
            Slot::Free | Slot::Inside => None,
        }
    }

    /// The rule for the edges.
    pub fn rule(&self) -> &R {
        &self.rule
    }

    /// Lets the next spring leave, at indentation `level`: the most stretched one of a fragment, of which
    /// its two parts remain.
    pub fn leave(&mut self, level: f64) -> Option<Event> {
        let (slot, _) = self.leaving.first()?;
        let Slot::Fragment(root) = self.slots[slot] else { return None };
        let root = root as usize;
        let (left, right) = self.tree.children(root);
        // The first leaf of the fragment is that of its first part.
        let (first, second) = (left.or(right), left.and(right));
        self.set(slot, first.map_or(Slot::Free, |part| Slot::Fragment(part as u32)));
        self.settle(slot..slot + 1);
        if let (Some(left), Some(right)) = (left, second) {
            let slot = self.leaves_before[left + 1] as usize;
            self.set(slot, Slot::Fragment(right as u32));
            self.settle(slot..slot + 1);
        }
        self.touched += 1;
        let fragments = -self.tree.shapes()[root].fragments();
        self.tally += Tally { springs: -1, fragments, quanta: -self.quanta(root) };
        let mut event = Event { springs: 1, squared_stretch: CompensatedSum::default() };
        event.squared_stretch.add(squared_stretch(self.tree.gap(root), level));
        Some(event)
    }

    /// From here on changes can be taken back.
    pub fn keep_journal(&mut self) {
        self.journal = Some(Vec::new());
    }

    /// Changes so far are for good.
    pub fn drop_journal(&mut self) {
        self.journal = None;
    }

    /// Takes back all changes since the journal was begun, when this was the tally.
    pub fn take_back(&mut self, tally: Tally) {
        for (slot, was) in self.journal.take().into_iter().flatten().rev() {
            self.set(slot as usize, was);
            self.settle(slot as usize..slot as usize + 1);
        }
        self.tally = tally;
    }

    #[inline]
    fn quanta(&self, node: usize) -> i128 {
        i128::from(self.rule.quanta(&self.tree, &self.scale, node))
    }

    /// Keys of a slot in the queues of what joins and what leaves.
    fn keys(&self, slot: usize) -> (f64, f64) {
        const NEVER: f64 = f64::INFINITY;
        match self.slots[slot] {
            Slot::Free => (self.tree.gap(self.leaves[slot] as usize), NEVER),
            Slot::Inside => (NEVER, NEVER),
            Slot::Fragment(root) => {
                let (root, parent) = (root as usize, self.parents[root as usize]);
                let joins = match parent {
                    NO_PARENT => NEVER,
                    // A wall whose gap is closed touches, whatever the rule says.
                    wall => {
                        let wall = wall as usize;
                        self.tree.gap(wall).min(self.rule.grows_at(&self.tree, root, wall))
                    }
                };
                // A slot with a fragment must not seem empty, however far it holds.
                (joins, (-self.rule.holds_to(&self.tree, root)).min(f64::MAX))
            }
        }
    }

    /// Sets a slot and its keys, and returns what it was. Its keys count when it is settled.
    fn set(&mut self, slot: usize, becomes: Slot) -> Slot {
        let was = std::mem::replace(&mut self.slots[slot], becomes);
        if let Some(journal) = &mut self.journal {
            journal.push((slot as u32, was));
        }
        let (joins, leaves) = self.keys(slot);
        self.joining.set(slot, joins);
        self.leaving.set(slot, leaves);
        self.touched += 1;
        was
    }

    fn settle(&mut self, slots: std::ops::Range<usize>) {
        if !slots.is_empty() {
            let (first, last) = (slots.start, slots.end - 1);
            self.touched += self.joining.settle(first, last) + self.leaving.settle(first, last);
        }
    }
}

/// Squared stretch of a spring of this gap that joins or leaves at indentation `level`; 0 where the level
/// says only that it was in contact from the beginning.
#[inline]
fn squared_stretch(gap: f64, level: f64) -> f64 {
    let stretch = gap - level;
    if stretch < f64::INFINITY { stretch * stretch } else { 0.0 }
}

/// A vector of so many equal values, or an error instead of an abort.
fn filled<T: Clone>(count: usize, value: T) -> Result<Vec<T>, ContactError> {
    let mut values = reserve(count)?;
    values.resize(count, value);
    Ok(values)
}
