//! What was in contact on a leg, told after the body has gone on.

use super::{ContactError, ContactTree};

/// The contact at any indentation of one leg, copied from a [`Solver`](super::Solver) as it then stood.
///
/// The copy is in the order in which the solver keeps its springs, so it costs no more than copying a number
/// for each of them, and nothing where the gaps already tell. Its memory serves for other legs and lines.
#[derive(Clone, Debug, Default)]
pub struct LegContact {
    order: Order,
    thresholds: Vec<f64>,
}

/// What the thresholds belong to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Order {
    /// Nothing touches on this leg.
    #[default]
    Apart,
    /// Each spring touches at its own gap.
    Gaps,
    /// One for each node of the tree.
    Tree,
    /// One for each spring along the line.
    Line,
}

impl LegContact {
    /// First and last spring of each fragment in contact at `indentation` (m), in ascending order.
    ///
    /// `gaps` and `tree` are those of the run from which this leg comes: a tree is asked for only where
    /// adhesion was solved exactly, and without one of as many springs nothing is told to touch. With a tree
    /// this takes as long as there are free springs and fragments, else as long as there are springs.
    #[must_use]
    pub fn fragments_at(
        &self,
        indentation: f64,
        gaps: &[f64],
        tree: Option<&ContactTree>,
    ) -> Vec<(usize, usize)> {
        let touching = |thresholds: &[f64]| {
            super::springs::runs(thresholds.iter().map(|&threshold| threshold <= indentation))
        };
        match self.order {
            Order::Apart => Vec::new(),
            Order::Gaps => touching(gaps),
            Order::Line => touching(&self.thresholds),
            Order::Tree => tree
                .filter(|tree| tree.len() == self.thresholds.len())
                .map_or_else(Vec::new, |tree| tree.fragments(&self.thresholds, indentation)),
        }
    }

    /// Bytes this copy holds on to, for those who keep many.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.thresholds.capacity() * size_of::<f64>()
    }

    /// Nothing touches on the leg.
    pub(in crate::contact) fn keep_nothing(&mut self) {
        self.order = Order::Apart;
    }

    /// Each spring touches at its own gap.
    pub(super) fn keep_gaps(&mut self) {
        self.order = Order::Gaps;
    }

    pub(super) fn keep_tree_order(&mut self, thresholds: &[f64]) -> Result<(), ContactError> {
        self.keep(Order::Tree, thresholds)
    }

    pub(super) fn keep_line_order(&mut self, thresholds: &[f64]) -> Result<(), ContactError> {
        self.keep(Order::Line, thresholds)
    }

    fn keep(&mut self, order: Order, thresholds: &[f64]) -> Result<(), ContactError> {
        self.order = Order::Apart;
        self.thresholds = super::resized(std::mem::take(&mut self.thresholds), thresholds.len(), 0.0)?;
        self.thresholds.copy_from_slice(thresholds);
        self.order = order;
        Ok(())
    }
}
