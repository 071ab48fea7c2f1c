//! The piecewise-linear line through the springs, and how long its fragments are at each level.

use crate::contact::tally::{GapScale, Tally};
use crate::contact::{ContactError, ContactTree, reserve};
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
    gaps: Vec<f64>,
    scale: GapScale,
    nodes: Vec<Levels>,
    /// Twice the trapezoid sum of the gaps from the first spring to each, in quanta.
    trapezoids: Vec<i128>,
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

/// A component at one level.
#[derive(Clone, Copy, Debug)]
pub struct Component {
    /// Its length in cells.
    pub length: f64,
    /// The compression ∫ (d − c) dx over it, in cells times metres: the force in units of the stiffness of
    /// one spring.
    pub compression: f64,
}

impl LevelSets {
    /// Those of the line of a tree, `gaps` in their order along the line.
    ///
    /// # Errors
    /// [`ContactError::OutOfMemory`].
    pub fn new(tree: Arc<ContactTree>, gaps: &[f64]) -> Result<Self, ContactError> {
        let scale = tree.gap_scale();
        let mut trapezoids = reserve(gaps.len())?;
        let mut sum = 0_i128;
        let mut before: Option<i64> = None;
        trapezoids.extend(gaps.iter().map(|&gap| {
            let quanta = scale.quanta(gap);
            sum += before.replace(quanta).map_or(0, |before| i128::from(before) + i128::from(quanta));
            sum
        }));
        let mut nodes = reserve(tree.len())?;
        nodes.resize(tree.len(), Levels { length: 0.0, growth: 0.0, top: f64::INFINITY });
        let mut kept = reserve(gaps.len())?;
        kept.extend_from_slice(gaps);
        let mut sets = LevelSets { tree, gaps: kept, scale, nodes, trapezoids };
        for node in 0..sets.tree.len() {
            let gap = sets.tree.gap(node);
            let (left, right) = sets.tree.children(node);
            for child in [left, right].into_iter().flatten() {
                sets.nodes[child].top = gap;
            }
            let (first, last) = sets.tree.interval(node);
            let [left, right] = sets.cells(first, last);
            let levels = &mut sets.nodes[node];
            levels.length = (last - first) as f64 + left.share(gap) + right.share(gap);
            levels.growth = left.growth() + right.growth();
        }
        Ok(sets)
    }

    /// The tree of the line.
    pub fn tree(&self) -> &ContactTree {
        &self.tree
    }

    /// The gaps along the line, m.
    pub fn gaps(&self) -> &[f64] {
        &self.gaps
    }

    /// Levels of a node.
    #[inline]
    pub fn levels(&self, node: usize) -> Levels {
        self.nodes[node]
    }

    /// The cells left and right of an interval of springs.
    #[inline]
    fn cells(&self, first: usize, last: usize) -> [EdgeCell; 2] {
        let outside = |spring: Option<usize>| spring.and_then(|spring| self.gaps.get(spring)).copied();
        [
            EdgeCell { inside: self.gaps[first], outside: outside(first.checked_sub(1)) },
            EdgeCell { inside: self.gaps[last], outside: outside(last.checked_add(1)) },
        ]
    }

    /// The component of a node at level `level`, under indentation `indentation`, m.
    ///
    /// The springs between its edges are summed as exactly as in [`Tally::compression`]; each edge adds one
    /// rounding of its own cell.
    pub fn component(&self, node: usize, level: f64, indentation: f64) -> Component {
        let (first, last) = self.tree.interval(node);
        let twice = Tally {
            springs: 2 * (last - first) as i64,
            fragments: 1,
            quanta: self.trapezoids[last] - self.trapezoids[first],
        };
        let mut length = (last - first) as f64;
        let mut compression = 0.5 * twice.compression(indentation, &self.scale);
        for cell in self.cells(first, last) {
            let share = cell.share(level);
            length += share;
            compression += share * (indentation - cell.mean(level));
        }
        Component { length, compression }
    }
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

    /// Mean gap of that share.
    #[inline]
    fn mean(self, level: f64) -> f64 {
        match self.outside {
            None => self.inside,
            Some(outside) => 0.5 * (self.inside + level.min(outside).max(self.inside)),
        }
    }

    /// By how much the share grows with the level, 1/m; zero where it does not, or all at once.
    #[inline]
    fn growth(self) -> f64 {
        let growth = self.outside.map_or(0.0, |outside| (outside - self.inside).recip());
        if growth.is_finite() { growth.max(0.0) } else { 0.0 }
    }
}
