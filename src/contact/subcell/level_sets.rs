//! The piecewise-linear line through the springs, how long its fragments are at each level, and what their
//! edges carry.

use crate::contact::tally::GapScale;
use crate::contact::{ContactError, SpringTree, resized};
use crate::parallel::in_parallel;
use std::sync::Arc;

/// From so many springs on a second thread pays.
const MANY_SPRINGS: usize = 1 << 15;

/// The level sets {x : c(x) ≤ t} of the line that runs straight from spring to spring, and level for half a
/// cell beyond the first and the last.
///
/// A component that holds the springs of a subtree, but not that of its parent, has its level t between
/// the largest gap of the subtree and the gap of the parent; there its two edges move within one cell
/// each, so that its length is linear in t.
#[derive(Debug)]
pub struct LevelSets {
    tree: Arc<SpringTree>,
    lengths: Vec<Length>,
    /// Gaps of the parents, m, which the passes hardly ever ask for.
    tops: Vec<f64>,
    edge_compressions: Vec<f64>,
    /// Mean gaps of all cells before each spring along the line, as the sum of their quanta.
    cells_before: Vec<i128>,
    steps: Vec<Step>,
}

/// Memory of level sets that are no longer needed.
#[derive(Debug, Default)]
pub struct LevelMemory {
    lengths: Vec<Length>,
    tops: Vec<f64>,
    edge_compressions: Vec<f64>,
    cells_before: Vec<i128>,
    steps: Vec<Step>,
}

/// How long the component of a subtree is: `length + growth (t − c)` cells at level t, from its largest
/// gap c up to `top`.
#[derive(Clone, Copy, Debug)]
pub struct Levels {
    /// Its length at level c, in cells.
    pub length: f64,
    /// By how much it grows with the level, cells per metre.
    pub growth: f64,
    /// Gap of the parent, m; infinite at the root.
    pub top: f64,
}

/// What of [`Levels`] the passes over the tree need.
#[derive(Clone, Copy, Debug)]
struct Length {
    length: f64,
    growth: f64,
}

/// What of the line lies level with a spring and comes into contact together with it.
#[derive(Clone, Copy, Debug)]
pub struct Step {
    /// The spring's node.
    pub node: u32,
    /// Its length in cells.
    pub length: f64,
}

impl LevelMemory {
    /// The same with room for the level sets of so many springs, already cleared by the system.
    ///
    /// # Errors
    /// [`ContactError::OutOfMemory`].
    pub fn ready(self, springs: usize) -> Result<Self, ContactError> {
        let nothing = Length { length: 0.0, growth: 0.0 };
        Ok(LevelMemory {
            lengths: resized(self.lengths, springs, nothing)?,
            tops: resized(self.tops, springs, f64::INFINITY)?,
            edge_compressions: resized(self.edge_compressions, springs, 0.0)?,
            cells_before: resized(self.cells_before, springs, 0)?,
            steps: self.steps,
        })
    }
}

impl LevelSets {
    /// Those of the line of a tree, `gaps` in their order along the line.
    ///
    /// # Errors
    /// [`ContactError::OutOfMemory`].
    pub fn new(tree: Arc<SpringTree>, gaps: &[f64]) -> Result<Self, ContactError> {
        Self::new_in(LevelMemory::default(), tree, gaps)
    }

    /// The same in the memory that [`LevelSets::into_memory`] gave back: fresh memory costs about as much as
    /// the level sets themselves.
    ///
    /// # Errors
    /// [`ContactError::OutOfMemory`].
    pub fn new_in(memory: LevelMemory, tree: Arc<SpringTree>, gaps: &[f64]) -> Result<Self, ContactError> {
        let memory = memory.ready(tree.len())?;
        let LevelMemory { mut lengths, mut tops, mut edge_compressions, mut cells_before, mut steps } =
            memory;
        let half = tree.len() / 2;
        let (first_lengths, other_lengths) = lengths.split_at_mut(half);
        let (first_tops, other_tops) = tops.split_at_mut(half);
        let (first_edges, other_edges) = edge_compressions.split_at_mut(half);
        let measure = |start: usize, part: Part<'_>, mut steps: Vec<Step>| {
            let arrays = part.lengths.iter_mut().zip(part.tops).zip(part.edges);
            for (node, ((length, top), edge)) in (start..).zip(arrays) {
                let (levels, carries) = levels_between(gaps, tree.interval(node), tree.gap(node));
                *length = Length { length: levels.length, growth: levels.growth };
                (*top, *edge) = (levels.top, carries);
                let length = level_length(gaps, tree.positions()[node] as usize);
                if length > 0.0 {
                    steps.try_reserve(1).map_err(|_| ContactError::OutOfMemory { springs: gaps.len() })?;
                    steps.push(Step { node: node as u32, length });
                }
            }
            Ok(steps)
        };
        steps.clear();
        let (first, others) = in_parallel(
            tree.len() >= MANY_SPRINGS,
            || {
                sum_cells(gaps, &tree.gap_scale(), &mut cells_before);
                measure(0, Part { lengths: first_lengths, tops: first_tops, edges: first_edges }, steps)
            },
            || {
                measure(
                    half,
                    Part { lengths: other_lengths, tops: other_tops, edges: other_edges },
                    Vec::new(),
                )
            },
        );
        let (mut steps, others) = (first?, others?);
        steps.try_reserve(others.len()).map_err(|_| ContactError::OutOfMemory { springs: gaps.len() })?;
        steps.extend(others);
        Ok(LevelSets { tree, lengths, tops, edge_compressions, cells_before, steps })
    }

    /// Their memory, without the tree, for those of the next line.
    #[must_use]
    pub fn into_memory(self) -> LevelMemory {
        let LevelSets { lengths, tops, edge_compressions, cells_before, steps, .. } = self;
        LevelMemory { lengths, tops, edge_compressions, cells_before, steps }
    }

    /// The tree of the line.
    pub fn tree(&self) -> &SpringTree {
        &self.tree
    }

    /// The tree of the line, to share.
    pub fn shared_tree(&self) -> Arc<SpringTree> {
        Arc::clone(&self.tree)
    }

    /// Levels of a node.
    #[inline]
    pub fn levels(&self, node: usize) -> Levels {
        let Length { length, growth } = self.lengths[node];
        Levels { length, growth, top: self.tops[node] }
    }

    /// What the two edge cells of a node carry at the indentation and the level of its gap: ∫ (c − c(x)) dx over
    /// them, in cells times metres.
    #[inline]
    pub fn edge_compression(&self, node: usize) -> f64 {
        self.edge_compressions[node]
    }

    /// Mean gaps of the cells between a node's spring and those of its parts, which close when it joins them, as
    /// the sum of their quanta.
    #[inline]
    pub fn cell_quanta(&self, node: usize) -> i64 {
        let (position, shape) = (self.tree.positions()[node] as usize, self.tree.shapes()[node]);
        let (left, right) = (usize::from(shape.left() > 0), usize::from(shape.right > 0));
        // At most two cells.
        self.cells_between((position - left, position + right)) as i64
    }

    /// Mean gaps of the cells between all springs of a node's subtree, as the sum of their quanta.
    #[inline]
    pub fn subtree_quanta(&self, node: usize) -> i128 {
        self.cells_between(self.tree.interval(node))
    }

    #[inline]
    fn cells_between(&self, (first, last): (usize, usize)) -> i128 {
        self.cells_before[last] - self.cells_before[first]
    }

    /// All that lies level, in the order of the nodes.
    pub fn steps(&self) -> &[Step] {
        &self.steps
    }

    /// Cells that lie level with the spring of a node and come into contact together with it.
    pub fn step(&self, node: usize) -> f64 {
        let place = self.steps.binary_search_by_key(&node, |step| step.node as usize);
        place.ok().and_then(|place| self.steps.get(place)).map_or(0.0, |step| step.length)
    }
}

/// Arrays of the nodes that one thread measures.
struct Part<'s> {
    lengths: &'s mut [Length],
    tops: &'s mut [f64],
    edges: &'s mut [f64],
}

/// Sums the mean gaps of the cells between springs.
fn sum_cells(gaps: &[f64], scale: &GapScale, cells_before: &mut [i128]) {
    let mut sum = 0;
    let mut before = gaps.first().copied().unwrap_or(0.0);
    for (&gap, cells) in gaps.iter().zip(cells_before) {
        sum += i128::from(scale.mean_quanta(before, gap));
        *cells = sum;
        before = gap;
    }
}

/// Levels of the component that holds these springs, the largest of whose gaps is `gap`, and what its edges
/// carry.
#[inline]
pub(super) fn levels_between(gaps: &[f64], (first, last): (usize, usize), gap: f64) -> (Levels, f64) {
    let before = if first > 0 { gaps[first - 1] } else { f64::INFINITY };
    let after = gaps.get(last + 1).copied().unwrap_or(f64::INFINITY);
    let [left, right] = [EdgeCell::new(gaps[first], before, gap), EdgeCell::new(gaps[last], after, gap)];
    let levels = Levels {
        length: (last - first) as f64 + (left.share + right.share),
        growth: left.growth + right.growth,
        top: left.outside.min(right.outside),
    };
    (levels, 0.5 * (left.carries + right.carries))
}

/// Cells that lie level with a spring: half of one at an end of the foundation, and the one to its left
/// if that spring's gap is the same.
fn level_length(gaps: &[f64], position: usize) -> f64 {
    let half = |is_end: bool| if is_end { 0.5 } else { 0.0 };
    let before = position.checked_sub(1).and_then(|before| gaps.get(before));
    let is_level = before.is_some_and(|before| *before == gaps[position]);
    half(position == 0) + half(position + 1 == gaps.len()) + f64::from(u8::from(is_level))
}

/// The cell in which an edge moves: from the last spring that is held to the first that is not.
#[derive(Clone, Copy)]
struct EdgeCell {
    /// Gap of the first spring that is not held, m; infinite beyond the foundation's end, half a cell away.
    outside: f64,
    /// Share of the cell that lies at or below the level, which is not below the gap inside.
    share: f64,
    /// By how much the share grows with the level, 1/m; zero where it does not, or all at once.
    growth: f64,
    /// Twice what it carries at that level and indentation, m.
    carries: f64,
}

impl EdgeCell {
    #[inline]
    fn new(inside: f64, outside: f64, level: f64) -> Self {
        let (height, above) = (outside - inside, level - inside);
        if height == f64::INFINITY {
            // Half a cell as level as the spring it belongs to.
            return EdgeCell { outside, share: 0.5, growth: 0.0, carries: above };
        }
        let growth = height.recip();
        let growth = if growth < f64::INFINITY { growth } else { 0.0 };
        let share = if growth > 0.0 { above * growth } else { above / height };
        // 0/0 where the cell is level: then it lies there whole.
        let share = if above < height { share } else { 1.0 };
        EdgeCell { outside, share, growth, carries: above * share }
    }
}
