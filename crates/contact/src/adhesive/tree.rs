//! The contact tree: which patches of a profile can merge, and at which local maximum of the gap.

use super::levels::{Edges, smaller};
use crate::totals::{GapScale, sums_of_few};
use asperity_data::{OutOfMemory, emptied, in_parallel, push, reserve};

/// Number of springs of a profile from which a second thread saves more time than it costs.
pub const TWO_THREADS: usize = 1 << 17;
/// Distance, in springs, between two stored prefix sums.
const BLOCK: usize = 4;
/// Number of springs whose gaps are compared at the same time.
const LANES: usize = 64;

/// Tree of the local maxima of the gap inside the profile, at which patches can merge. Each local
/// maximum is one node. For random profiles of N springs whose roughness has a shortest wavelength,
/// the tree has 0.11 N to 0.26 N nodes.
// Think of a level that rises from the smallest gap to the largest. The springs with gaps below the
// level form patches. A patch appears where the level passes a local minimum of the gap, and two
// patches merge where the level passes a local maximum. Nodes are in post-order: the subtree of
// node j, which has `size` nodes, consists of the nodes `j + 1 − size ..= j`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ContactTree {
    /// Indices of the springs at the local minima and maxima of the gap, from left to right. Minima
    /// and maxima alternate, and the first and the last are minima.
    pub(super) turns: Vec<u32>,
    pub(super) nodes: Vec<Node>,
    /// Prefix sums before each `BLOCK`-th spring, of the gaps in quanta and of their squares. If
    /// `of_cells` is true, the sums are over the mean gaps of cells.
    sums: Vec<[i128; 2]>,
    /// True if the sums are over the cells between springs; false if they are over springs.
    of_cells: bool,
    pub(crate) scale: GapScale,
}

/// A local maximum of the gap, where two patches merge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Node {
    pub gap: f64,
    /// Smallest gap in m of all springs of the patch that forms at this local maximum.
    pub lowest: f64,
    /// Index of this local maximum among all local maxima, from left to right, from 0.
    pub rank: u32,
    /// Number of local maxima in the subtree of this one, including this one.
    pub size: u32,
    /// Number of local maxima in the part of the subtree on the right of this one.
    pub right: u32,
}

/// A branch of the contact tree: one patch from its appearance to its merger with another patch.
/// The patch appears at a local minimum of the gap, or at the merger of two smaller patches. Along
/// the branch the level of the patch rises: the gap at which the edges of the patch lie.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Branch(u32);

impl Branch {
    /// Returns the branch that begins at the local minimum with the index `rank`, counted from the
    /// left end of the profile.
    #[inline]
    pub fn leaf(rank: usize) -> Self {
        Branch((rank as u32) << 1 | 1)
    }

    #[inline]
    pub fn node(node: usize) -> Self {
        Branch((node as u32) << 1)
    }

    /// Returns the index of the node at which the branch begins. A node is a local maximum of the
    /// gap. If the branch begins at a local minimum of the gap instead, returns `Err` with the
    /// index of this minimum among all minima.
    #[inline]
    pub fn origin(self) -> Result<usize, usize> {
        let index = (self.0 >> 1) as usize;
        if self.0 & 1 == 1 {
            Err(index)
        } else {
            Ok(index)
        }
    }
}

/// A node whose right part is not complete yet.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Pending {
    gap: f64,
    lowest: f64,
    rank: u32,
    /// Index of the first node of the subtree.
    start: u32,
    /// Index of the first node of the right part.
    right_start: u32,
}

impl Pending {
    /// Returns the finished node at the index `index` after its right part is complete.
    /// `lowest_on_right` is the smallest gap of the right part in m.
    #[inline]
    fn finished(&self, lowest_on_right: f64, index: usize) -> Node {
        let index = index as u32;
        Node {
            gap: self.gap,
            lowest: smaller(lowest_on_right, self.lowest),
            rank: self.rank,
            size: index + 1 - self.start,
            right: index - self.right_start,
        }
    }
}

impl ContactTree {
    /// Builds a new tree from `gaps` in the memory of the old tree `self`. `edges` states where the
    /// edges of patches may lie, and so which sums the tree needs. There must be 1 to 2^28 gaps, in
    /// m, finite and at least zero. `deepest` is the largest gap.
    pub(crate) fn rebuild(
        mut self,
        gaps: &[f64],
        deepest: f64,
        edges: Edges,
    ) -> Result<Self, OutOfMemory> {
        let scale = GapScale::for_gaps_up_to(deepest);
        self.scale = scale;
        self.of_cells = edges == Edges::SubCell;
        let sums = std::mem::take(&mut self.sums);
        let is_long = gaps.len() >= TWO_THREADS;
        let (merged, sums) = in_parallel(
            is_long,
            || self.find_turns(gaps).and_then(|()| self.merge(gaps)),
            || sums_along(sums, gaps, edges, scale),
        );
        merged?;
        self.sums = sums?;
        Ok(self)
    }

    /// Returns the number of nodes: the local maxima of the gap inside the profile.
    pub fn node_count(&self) -> usize {
        self.nodes.len()
    }

    /// Returns the branch of the patch that fills the whole profile when all patches have merged.
    pub(crate) fn root(&self) -> Branch {
        match self.nodes.len() {
            0 => Branch::leaf(0),
            count => Branch::node(count - 1),
        }
    }

    /// Returns the index of the spring at the local minimum with the index `rank` among all minima.
    #[inline]
    pub(crate) fn minimum(&self, rank: usize) -> usize {
        self.turns[2 * rank] as usize
    }

    /// Returns the index of the spring at the local maximum of a node.
    #[inline]
    pub(crate) fn maximum(&self, node: &Node) -> usize {
        self.turns[2 * node.rank as usize + 1] as usize
    }

    /// Returns the left and the right branch that merge at the node with this index.
    #[inline]
    pub(crate) fn parts(&self, index: usize) -> [Branch; 2] {
        let node = &self.nodes[index];
        let rank = node.rank as usize;
        let right_size = node.right as usize;
        let left_size = node.size as usize - 1 - right_size;
        let left = if left_size == 0 {
            Branch::leaf(rank)
        } else {
            Branch::node(index - 1 - right_size)
        };
        let right = if right_size == 0 {
            Branch::leaf(rank + 1)
        } else {
            Branch::node(index - 1)
        };
        [left, right]
    }

    /// Returns the sum of the gaps and the sum of the squared gaps over all springs to the left of
    /// `spring`. If `of_cells` is true, the sums are over the cells to the left of `spring`
    /// instead. The units are the quanta and the squares of
    /// [`ContactTotals`](crate::totals::ContactTotals).
    #[inline]
    pub(super) fn sums_before(&self, gaps: &[f64], spring: usize) -> [i128; 2] {
        let block = spring / BLOCK;
        let end = if self.of_cells {
            gaps.len().min(spring + 1)
        } else {
            spring
        };
        let rest = sums_of_few(&gaps[block * BLOCK..end], self.of_cells, self.scale);
        let sums = self.sums[block];
        [sums[0] + rest[0], sums[1] + rest[1]]
    }

    /// Finds the local minima and maxima of the gap. If neighbours have equal gaps, the right one
    /// counts as lower.
    fn find_turns(&mut self, gaps: &[f64]) -> Result<(), OutOfMemory> {
        let count = gaps.len();
        debug_assert!(u32::try_from(count).is_ok_and(|count| count < 1 << 31));
        self.turns = emptied(std::mem::take(&mut self.turns), count / 4)?;
        // `rises` has one bit for each spring: 1 if the gap rises from this spring to the next. The
        // gap counts as falling before the first spring and rising after the last one.
        let mut rose = 0_u64;
        for base in (0..count).step_by(LANES) {
            let springs = LANES.min(count - base);
            let rises = match gaps[base..].first_chunk::<{ LANES + 1 }>() {
                Some(gaps) => rises_of(gaps),
                None => rises_at_end(&gaps[base..]),
            };
            let mut turns = rises ^ ((rises << 1) | rose);
            if springs < LANES {
                turns &= (1 << springs) - 1;
            }
            rose = rises >> (LANES - 1);
            reserve(&mut self.turns, LANES + 4)?;
            let found = turns.count_ones() as usize;
            let place = self.turns.len();
            // The loop stores four turning points at a time, because the processor cannot predict
            // the number of turning points well.
            for _ in 0..found.div_ceil(4) {
                let mut four = [0_u32; 4];
                for turn in &mut four {
                    *turn = (base as u32).wrapping_add(turns.trailing_zeros());
                    turns &= turns.wrapping_sub(1);
                }
                self.turns.extend_from_slice(&four);
            }
            self.turns.truncate(place + found);
        }
        Ok(())
    }

    /// Builds the nodes in one pass along the local maxima.
    fn merge(&mut self, gaps: &[f64]) -> Result<(), OutOfMemory> {
        let count = self.turns.len() / 2;
        let mut nodes = emptied(std::mem::take(&mut self.nodes), count)?;
        let mut pending: Vec<Pending> = Vec::new();
        let gap_at = |turn: usize| gaps[self.turns[turn] as usize];
        // Smallest gap since the local maximum that was added to `pending` last.
        let mut lowest = match self.turns.first() {
            Some(&spring) => gaps[spring as usize],
            None => 0.0,
        };
        for rank in 0..count {
            let gap = gap_at(2 * rank + 1);
            let mut start = nodes.len() as u32;
            while let Some(top) = pending.pop_if(|top| top.gap < gap) {
                let node = top.finished(lowest, nodes.len());
                start = top.start;
                lowest = node.lowest;
                nodes.push(node);
            }
            let waiting = Pending {
                gap,
                lowest,
                rank: rank as u32,
                start,
                right_start: nodes.len() as u32,
            };
            push(&mut pending, waiting)?;
            lowest = gap_at(2 * rank + 2);
        }
        while let Some(top) = pending.pop() {
            let node = top.finished(lowest, nodes.len());
            lowest = node.lowest;
            nodes.push(node);
        }
        self.nodes = nodes;
        Ok(())
    }
}

/// Computes prefix sums before each `BLOCK`-th spring, in quanta of the scale.
fn sums_along(
    mut sums: Vec<[i128; 2]>,
    gaps: &[f64],
    edges: Edges,
    scale: GapScale,
) -> Result<Vec<[i128; 2]>, OutOfMemory> {
    let count = gaps.len() / BLOCK + 1;
    sums = emptied(sums, count)?;
    let mut sum = [0_i128; 2];
    sums.push(sum);
    match edges {
        Edges::Grid => {
            let (blocks, _) = gaps.as_chunks::<BLOCK>();
            for springs in blocks {
                let few = sums_of_few(springs, false, scale);
                sum = [sum[0] + few[0], sum[1] + few[1]];
                sums.push(sum);
            }
        }
        Edges::SubCell => {
            for springs in gaps.windows(BLOCK + 1).step_by(BLOCK) {
                let few = sums_of_few(springs, true, scale);
                sum = [sum[0] + few[0], sum[1] + few[1]];
                sums.push(sum);
            }
        }
    }
    Ok(sums)
}

/// Returns one bit for each of the last springs of a profile, at most `LANES`: 1 if the gap rises
/// after the spring. The bit of the last spring is 1.
fn rises_at_end(gaps: &[f64]) -> u64 {
    let mut rises = 0;
    for lane in 0..gaps.len() {
        let rises_here = lane + 1 == gaps.len() || gaps[lane + 1] > gaps[lane];
        rises |= u64::from(rises_here) << lane;
    }
    rises
}

/// Returns one bit for each spring: 1 if the gap rises from this spring to the next.
#[inline]
fn rises_of(gaps: &[f64; LANES + 1]) -> u64 {
    let mut rises = 0;
    for byte in 0..LANES / 8 {
        let mut bits = [0_u8; 8];
        for (lane, bit) in bits.iter_mut().enumerate() {
            *bit = u8::from(gaps[8 * byte + lane + 1] > gaps[8 * byte + lane]);
        }
        // Collects the lowest bits of eight bytes in one byte.
        let packed = u64::from_le_bytes(bits).wrapping_mul(0x0102_0408_1020_4080) >> 56;
        rises |= packed << (8 * byte);
    }
    rises
}
