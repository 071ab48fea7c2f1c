//! Contact at all indentations of one leg, kept after the body has moved on.

use super::adhesive::{ContactTree, EdgeModel, GridEdges, Ground, Held, Run, SubCellEdges};
use super::fragments::runs;
use super::{ContactError, resized};
use crate::scene::Edges;

/// The contact at any indentation of one leg, copied from a [`Solver`](super::Solver) when the leg was done.
///
/// A copy holds the runs of an adhesive contact, nothing where the gaps decide, and a number for each spring of the
/// stepwise solver. Its memory serves for other legs and lines.
#[derive(Clone, Debug, Default)]
pub struct LegContact {
    kind: Kind,
    runs: Vec<Run>,
    thresholds: Vec<f64>,
}

/// Data that define the contact.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
enum Kind {
    /// Nothing touches on this leg.
    #[default]
    Apart,
    /// Each spring touches at its own gap.
    Gaps,
    /// The runs of an adhesive contact; `stretch` is the largest one of a fragment of unit length on the leg, m.
    Runs { unloading: bool, stretch: f64, edges: Edges, pins: bool },
    /// A threshold for each spring along the line.
    Line,
}

impl LegContact {
    /// First and last spring of each fragment in contact at `indentation` (m), in ascending order.
    ///
    /// `gaps` and `tree` are those of the run from which this leg comes; a tree is asked for only where adhesion was
    /// solved exactly, and without one nothing touches there. With a tree this takes as long as there are runs, else as
    /// long as there are springs.
    #[must_use]
    pub fn fragments_at(
        &self,
        indentation: f64,
        gaps: &[f64],
        tree: Option<&ContactTree>,
    ) -> Vec<(usize, usize)> {
        let touching =
            |thresholds: &[f64]| runs(thresholds.iter().map(|&threshold| threshold <= indentation));
        match (self.kind, tree) {
            (Kind::Apart, _) => Vec::new(),
            (Kind::Gaps, _) => touching(gaps),
            (Kind::Line, _) => touching(&self.thresholds),
            (Kind::Runs { .. }, tree) => {
                let held = tree.map_or_else(Vec::new, |tree| self.held_at(indentation, gaps, tree));
                held.iter().map(|held| (held.first as usize, held.last as usize)).collect()
            }
        }
    }

    /// See [`Solver::rises`](super::Solver::rises); arguments as in [`LegContact::fragments_at`].
    #[must_use]
    pub fn rises_at(&self, indentation: f64, gaps: &[f64], tree: Option<&ContactTree>) -> Vec<f64> {
        let held = tree.map_or_else(Vec::new, |tree| self.held_at(indentation, gaps, tree));
        held.iter().filter_map(|held| held.pin).collect()
    }

    /// The fragments of the runs of an adhesive contact at an indentation, m; none of another contact.
    fn held_at(&self, indentation: f64, gaps: &[f64], tree: &ContactTree) -> Vec<Held> {
        let Kind::Runs { unloading, stretch, edges, pins } = self.kind else { return Vec::new() };
        match edges {
            Edges::Grid => {
                let ground = Ground { gaps, tree, edges: GridEdges::with_stretch(stretch) };
                ground.held_at(&self.runs, unloading, indentation, pins).collect()
            }
            Edges::SubCell => {
                let ground = Ground { gaps, tree, edges: SubCellEdges::with_stretch(stretch) };
                ground.held_at(&self.runs, unloading, indentation, pins).collect()
            }
        }
    }

    /// Bytes this copy holds on to, for those who keep many.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.thresholds.capacity() * size_of::<f64>() + self.runs.capacity() * size_of::<Run>()
    }

    /// Nothing touches on the leg.
    pub(in crate::contact) fn keep_nothing(&mut self) {
        self.kind = Kind::Apart;
    }

    /// Each spring touches at its own gap.
    pub(super) fn keep_gaps(&mut self) {
        self.kind = Kind::Gaps;
    }

    /// The runs of an adhesive contact under these edges of the leg; `pins`: they are pinned where the next leg begins.
    pub(super) fn keep_runs<E: EdgeModel>(
        &mut self,
        runs: &[Run],
        unloading: bool,
        edges: E,
        pins: bool,
    ) -> Result<(), ContactError> {
        self.kind = Kind::Apart;
        self.runs.clear();
        let springs = runs.len();
        self.runs.try_reserve_exact(springs).map_err(|_| ContactError::OutOfMemory { springs })?;
        self.runs.extend_from_slice(runs);
        self.kind = Kind::Runs { unloading, stretch: edges.stretch(), edges: E::EDGES, pins };
        Ok(())
    }

    /// A threshold for each spring along the line, m.
    pub(super) fn keep_line_order(&mut self, thresholds: &[f64]) -> Result<(), ContactError> {
        self.kind = Kind::Apart;
        self.thresholds = resized(std::mem::take(&mut self.thresholds), thresholds.len(), 0.0)?;
        self.thresholds.copy_from_slice(thresholds);
        self.kind = Kind::Line;
        Ok(())
    }
}
