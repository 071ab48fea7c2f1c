//! A queue of slots by key in which the key of any slot can change.

use crate::contact::{ContactError, reserve};

/// Slots 0, 1, … with a key each; the smallest key is known at any time.
///
/// Each node of a complete binary tree over the slots keeps the slot with the smallest key below it, the winner. Unlike
/// in a heap a slot is found by its number, so no outdated entries accumulate.
#[derive(Clone, Debug)]
pub struct WinnerTree {
    keys: Vec<f64>,
    /// Slot with the smallest key below nodes 1 … `width` − 1; the children of node i are 2i and 2i + 1.
    winners: Vec<u32>,
    /// Number of places in the lowest row, a power of two; slot s is node `width` + s there.
    width: usize,
}

impl WinnerTree {
    /// Returns a winner tree of slots with these keys; a slot with the key +∞ is empty.
    ///
    /// # Errors
    /// [`ContactError::OutOfMemory`].
    pub fn new(keys: Vec<f64>) -> Result<Self, ContactError> {
        let width = keys.len().next_power_of_two();
        let mut winners = reserve(width)?;
        winners.resize(width, 0);
        let mut tree = WinnerTree { keys, winners, width };
        for node in (1..width).rev() {
            tree.winners[node] = tree.decide(node);
        }
        Ok(tree)
    }

    #[inline]
    fn key(&self, slot: u32) -> f64 {
        // The lowest row is wider than there are slots.
        self.keys.get(slot as usize).copied().unwrap_or(f64::INFINITY)
    }

    #[inline]
    fn winner(&self, node: usize) -> u32 {
        if node < self.width { self.winners[node] } else { (node - self.width) as u32 }
    }

    #[inline]
    fn decide(&self, node: usize) -> u32 {
        let (left, right) = (self.winner(2 * node), self.winner(2 * node + 1));
        if self.key(right) < self.key(left) { right } else { left }
    }

    fn is_occupied(&self, node: usize) -> bool {
        self.key(self.winner(node)) < f64::INFINITY
    }

    /// The slot with the smallest key, and that key; `None` when all are empty.
    #[inline]
    pub fn first(&self) -> Option<(usize, f64)> {
        let slot = self.winner(1);
        let key = self.key(slot);
        (key < f64::INFINITY).then_some((slot as usize, key))
    }

    /// Sets the key of a slot, which takes effect with [`WinnerTree::settle`].
    #[inline]
    pub fn set(&mut self, slot: usize, key: f64) {
        self.keys[slot] = key;
    }

    /// Updates the winners above the slots `first ..= last`. Returns the number of nodes read: at most about twice the
    /// number of slots and two for each row.
    pub fn settle(&mut self, first: usize, last: usize) -> u64 {
        let (mut low, mut high) = (self.width + first, self.width + last);
        let mut looked_at = 0;
        while low > 1 {
            (low, high) = (low / 2, high / 2);
            let mut changed = false;
            for node in low..=high {
                let winner = self.decide(node);
                // A new key of the same slot is a change for the nodes above.
                changed |= winner != self.winners[node] || (first..=last).contains(&(winner as usize));
                self.winners[node] = winner;
            }
            looked_at += (high - low + 1) as u64;
            if !changed {
                break;
            }
        }
        looked_at
    }

    /// The first slot from `slot` on that is not empty.
    pub fn occupied_from(&self, slot: usize) -> Option<usize> {
        if slot >= self.keys.len() {
            return None;
        }
        let mut node = self.width + slot;
        // Up to a node with an occupied slot on its right, then down to the leftmost occupied one.
        while !self.is_occupied(node) {
            while node % 2 == 1 {
                node /= 2;
            }
            if node == 0 {
                return None;
            }
            node += 1;
        }
        while node < self.width {
            node = if self.is_occupied(2 * node) { 2 * node } else { 2 * node + 1 };
        }
        Some(node - self.width)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn key() -> impl Strategy<Value = f64> {
        prop_oneof![4 => (0_u8..20).prop_map(f64::from), 1 => Just(f64::INFINITY), 1 => -1.0..1.0_f64]
    }

    /// Compares all queries with a search of the keys.
    fn check(tree: &WinnerTree, keys: &[f64]) -> Result<(), TestCaseError> {
        let smallest = keys.iter().copied().fold(f64::INFINITY, f64::min);
        match tree.first() {
            Some((slot, key)) => prop_assert_eq!((keys[slot], key), (smallest, smallest)),
            None => prop_assert_eq!(smallest, f64::INFINITY),
        }
        for from in 0..keys.len() + 2 {
            let expected = (from..keys.len()).find(|&slot| keys[slot] < f64::INFINITY);
            prop_assert_eq!(tree.occupied_from(from), expected, "from {}", from);
        }
        Ok(())
    }

    proptest! {
        #[test]
        fn knows_the_smallest_key_after_any_change(
            mut keys in prop::collection::vec(key(), 0..70),
            changes in prop::collection::vec((any::<prop::sample::Index>(), prop::collection::vec(key(), 1..9)), 0..20),
        ) {
            let mut tree = WinnerTree::new(keys.clone()).unwrap();
            check(&tree, &keys)?;
            for (place, new) in changes {
                if keys.is_empty() {
                    break;
                }
                let first = place.index(keys.len());
                let last = (first + new.len() - 1).min(keys.len() - 1);
                for (slot, key) in (first..=last).zip(new) {
                    keys[slot] = key;
                    tree.set(slot, key);
                }
                let rows = tree.width.ilog2() as usize;
                let looked_at = tree.settle(first, last) as usize;
                prop_assert!(looked_at <= 2 * (last - first + 1) + 2 * rows);
                check(&tree, &keys)?;
            }
        }
    }
}
