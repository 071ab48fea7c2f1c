//! The max-Cartesian tree of the gaps: every fragment that can stand in equilibrium is one subtree.

use super::{ContactError, GapScale};

/// The max-Cartesian tree of the gaps c₀ … c₍N−1₎, in post-order.
///
/// The root is the largest gap; left and right of it stand the trees of what lies to its left and
/// right. Among equal gaps the leftmost is nearest the root. In post-order the subtree of node `j`
/// fills the indices `j + 1 − size(j) ..= j`, its right child (if any) stands at `j − 1` and its left
/// child (if any) at `j − 1 − right(j)`, so no pointers and no recursion are needed: a monotone line
/// makes the tree N deep.
#[derive(Clone, Debug, PartialEq)]
pub struct SpringTree {
    gap: Vec<f64>,
    shape: Vec<Shape>,
    position: Vec<u32>,
}

/// Sizes of a subtree and of its right part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Shape {
    /// Springs in the subtree, the node itself included.
    pub size: u32,
    /// Springs in its right part.
    pub right: u32,
}

impl Shape {
    /// Springs in the left part.
    #[inline]
    pub fn left(self) -> u32 {
        self.size - 1 - self.right
    }

    /// How many contact fragments this node adds when it comes into contact: one, less one for each
    /// child, because a subtree in contact is one fragment.
    #[inline]
    pub fn fragments(self) -> i64 {
        1 - i64::from(self.right > 0) - i64::from(self.left() > 0)
    }
}

/// A subtree that still waits for its right part, on the stack of [`SpringTree::build`].
struct Pending {
    gap: f64,
    position: u32,
    /// Index of the first node of its subtree.
    start: u32,
    /// Index after its left part: where its right part begins.
    right_start: u32,
}

impl SpringTree {
    /// Builds the tree of `gaps` (m, finite, at least zero) in one pass and O(N) memory.
    ///
    /// # Errors
    /// [`ContactError::OutOfMemory`] when the arrays cannot be had.
    pub fn build(gaps: &[f64]) -> Result<Self, ContactError> {
        SpringTree { gap: Vec::new(), shape: Vec::new(), position: Vec::new() }.rebuild(gaps)
    }

    /// Builds the tree of other gaps in the memory of this one: fresh memory costs about as much as the
    /// tree itself.
    ///
    /// # Errors
    /// [`ContactError::OutOfMemory`] when the arrays must grow and cannot.
    pub fn rebuild(self, gaps: &[f64]) -> Result<Self, ContactError> {
        debug_assert!(u32::try_from(gaps.len()).is_ok(), "lines are bounded to 2^28 springs");
        let count = gaps.len();
        let nothing = Shape { size: 0, right: 0 };
        let mut gap = super::resized(self.gap, count, 0.0)?;
        let mut shape = super::resized(self.shape, count, nothing)?;
        let mut position = super::resized(self.position, count, 0)?;
        let mut end: u32 = 0;
        let mut finish = |node: &Pending| {
            let index = end as usize;
            gap[index] = node.gap;
            shape[index] = Shape { size: end + 1 - node.start, right: end - node.right_start };
            position[index] = node.position;
            end += 1;
            end
        };
        let mut finished = 0;
        let mut pending: Vec<Pending> = Vec::new();
        for (place, &gap) in gaps.iter().enumerate() {
            let mut start = finished;
            while let Some(top) = pending.pop_if(|top| top.gap < gap) {
                finished = finish(&top);
                start = top.start;
            }
            pending.push(Pending { gap, position: place as u32, start, right_start: finished });
        }
        while let Some(top) = pending.pop() {
            finish(&top);
        }
        Ok(SpringTree { gap, shape, position })
    }

    /// Number of nodes, one for each spring.
    #[must_use]
    pub fn len(&self) -> usize {
        self.gap.len()
    }

    /// Whether there are no springs.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.gap.is_empty()
    }

    /// Gaps in post-order, m.
    #[must_use]
    pub fn gaps(&self) -> &[f64] {
        &self.gap
    }

    /// Gap of a node, m.
    #[inline]
    #[must_use]
    pub fn gap(&self, node: usize) -> f64 {
        self.gap[node]
    }

    /// Springs in a node's subtree.
    #[inline]
    #[must_use]
    pub fn size(&self, node: usize) -> u32 {
        self.shape[node].size
    }

    /// Where on the line each node stands, in post-order.
    #[must_use]
    pub fn positions(&self) -> &[u32] {
        &self.position
    }

    /// First and last spring of the interval that a node's subtree fills.
    #[must_use]
    pub fn interval(&self, node: usize) -> (usize, usize) {
        let position = self.position[node] as usize;
        let shape = self.shape[node];
        (position - shape.left() as usize, position + shape.right as usize)
    }

    /// The node whose subtree fills this interval of springs; `None` where none does.
    #[must_use]
    pub fn root_of(&self, (first, last): (usize, usize)) -> Option<usize> {
        let mut node = self.len().checked_sub(1)?;
        loop {
            if self.interval(node) == (first, last) {
                return Some(node);
            }
            let position = self.position[node] as usize;
            let (left, right) = self.children(node);
            node = match () {
                () if last < position => left?,
                () if first > position => right?,
                () => return None,
            };
        }
    }

    /// Left and right child of a node.
    #[must_use]
    pub fn children(&self, node: usize) -> (Option<usize>, Option<usize>) {
        let shape = self.shape[node];
        let left = (shape.left() > 0).then(|| node - 1 - shape.right as usize);
        (left, (shape.right > 0).then(|| node - 1))
    }

    /// The scale on which these gaps are summed.
    pub(crate) fn gap_scale(&self) -> GapScale {
        // The root is the largest gap.
        GapScale::for_gaps_up_to(self.gap.last().copied().unwrap_or(0.0))
    }

    #[inline]
    pub(crate) fn shapes(&self) -> &[Shape] {
        &self.shape
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The definition, by recursion over intervals: (position, size, right) in post-order.
    fn by_definition(gaps: &[f64], first: usize, out: &mut Vec<(u32, u32, u32)>) {
        let Some(root) = (0..gaps.len()).max_by(|&a, &b| gaps[a].total_cmp(&gaps[b]).then(b.cmp(&a))) else {
            return;
        };
        by_definition(&gaps[..root], first, out);
        by_definition(&gaps[root + 1..], first + root + 1, out);
        out.push(((first + root) as u32, gaps.len() as u32, (gaps.len() - 1 - root) as u32));
    }

    proptest! {
        #[test]
        fn is_the_cartesian_tree(levels in prop::collection::vec(0_u8..12, 0..80)) {
            let gaps: Vec<f64> = levels.iter().map(|&level| f64::from(level)).collect();
            let tree = SpringTree::build(&gaps).unwrap();
            let mut expected = Vec::new();
            by_definition(&gaps, 0, &mut expected);
            let found: Vec<_> = (0..tree.len())
                .map(|j| (tree.position[j], tree.shape[j].size, tree.shape[j].right))
                .collect();
            prop_assert_eq!(found, expected);
            for j in 0..tree.len() {
                prop_assert_eq!(tree.gap(j), gaps[tree.position[j] as usize]);
                let (first, last) = tree.interval(j);
                prop_assert_eq!(last + 1 - first, tree.size(j) as usize);
                prop_assert_eq!(tree.root_of((first, last)), Some(j));
                let (left, right) = tree.children(j);
                if let Some(left) = left {
                    prop_assert_eq!(tree.interval(left), (first, tree.position[j] as usize - 1));
                }
                if let Some(right) = right {
                    prop_assert_eq!(tree.interval(right), (tree.position[j] as usize + 1, last));
                }
            }
        }
    }
}
