//! The piecewise-linear line through the springs, how long its fragments are at each level, and how deep.

use crate::contact::ledger::CompensatedSum;
use crate::contact::{ContactError, ContactTree, resized};
use std::sync::Arc;

/// The level sets {x : c(x) ≤ t} of the line that runs straight from spring to spring, and level for half a
/// cell beyond the first and the last.
///
/// A component that holds the springs of a subtree, but not that of its parent, has its level t between
/// the largest gap of the subtree and the gap of the parent; there its two edges move within one cell
/// each, so that its length is linear in t.
#[derive(Debug)]
pub struct LevelSets {
    tree: Arc<ContactTree>,
    nodes: Vec<Levels>,
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
    /// ∫ (c − c(x)) dx over it at level c, in cells times metres.
    pub depth: f64,
}

/// What of the line lies level with a spring and comes into contact together with it.
#[derive(Clone, Copy, Debug)]
pub struct Step {
    /// The spring's node.
    pub node: u32,
    /// Its length in cells.
    pub length: f64,
}

impl LevelSets {
    /// Those of the line of a tree, `gaps` in their order along the line.
    ///
    /// # Errors
    /// [`ContactError::OutOfMemory`].
    pub fn new(tree: Arc<ContactTree>, gaps: &[f64]) -> Result<Self, ContactError> {
        LevelSets { tree: Arc::clone(&tree), nodes: Vec::new(), steps: Vec::new() }.rebuild(tree, gaps)
    }

    /// Those of another line in the memory of these: fresh memory costs about as much as the level sets
    /// themselves.
    ///
    /// # Errors
    /// [`ContactError::OutOfMemory`].
    pub fn rebuild(self, tree: Arc<ContactTree>, gaps: &[f64]) -> Result<Self, ContactError> {
        let nothing = Levels { length: 0.0, growth: 0.0, top: f64::INFINITY, depth: 0.0 };
        let mut nodes = resized(self.nodes, tree.len(), nothing)?;
        let mut steps = self.steps;
        steps.clear();
        // Depths of the subtrees whose parents are still to come: each is a sum of what is not negative,
        // compensated, so that it is exact but for a few roundings however many springs there are.
        let mut depths: Vec<CompensatedSum> = Vec::new();
        for node in 0..tree.len() {
            let gap = tree.gap(node);
            let (left, right) = tree.children(node);
            let mut depth = CompensatedSum::default();
            for child in [right, left].into_iter().flatten() {
                let levels = &mut nodes[child];
                levels.top = gap;
                let rise = gap - tree.gap(child);
                depth.add_sum(depths.pop().unwrap_or_default());
                depth.add(rise * (levels.length + 0.5 * levels.growth * rise));
            }
            let (first, last) = tree.interval(node);
            let outside = |spring: Option<usize>| spring.and_then(|spring| gaps.get(spring)).copied();
            let cells = [
                EdgeCell { inside: gaps[first], outside: outside(first.checked_sub(1)) },
                EdgeCell { inside: gaps[last], outside: outside(last.checked_add(1)) },
            ];
            nodes[node] = Levels {
                length: (last - first) as f64 + cells[0].share(gap) + cells[1].share(gap),
                growth: cells[0].growth() + cells[1].growth(),
                top: f64::INFINITY,
                depth: depth.total(),
            };
            depths.push(depth);
            let length = level_length(gaps, tree.positions()[node] as usize);
            if length > 0.0 {
                steps.try_reserve(1).map_err(|_| ContactError::OutOfMemory { springs: gaps.len() })?;
                steps.push(Step { node: node as u32, length });
            }
        }
        Ok(LevelSets { tree, nodes, steps })
    }

    /// The tree of the line.
    pub fn tree(&self) -> &ContactTree {
        &self.tree
    }

    /// The tree of the line, to share.
    pub fn shared_tree(&self) -> Arc<ContactTree> {
        Arc::clone(&self.tree)
    }

    /// Levels of a node.
    #[inline]
    pub fn levels(&self, node: usize) -> Levels {
        self.nodes[node]
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
    inside: f64,
    /// `None` beyond the foundation's end, half a cell away.
    outside: Option<f64>,
}

impl EdgeCell {
    /// Share of the cell that lies at or below a level not below `inside`; a level cell lies there whole.
    #[inline]
    fn share(self, level: f64) -> f64 {
        match self.outside {
            None => 0.5,
            Some(outside) => {
                let share = (level - self.inside) / (outside - self.inside);
                // 0/0 where the cell is level.
                if share < 1.0 { share.max(0.0) } else { 1.0 }
            }
        }
    }

    /// By how much the share grows with the level, 1/m; zero where it does not, or all at once.
    #[inline]
    fn growth(self) -> f64 {
        let growth = self.outside.map_or(0.0, |outside| (outside - self.inside).recip());
        if growth.is_finite() { growth.max(0.0) } else { 0.0 }
    }
}
