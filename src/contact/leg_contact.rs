//! Contact at all indentations of one leg, seen in a solver or kept after the body has moved on.

use super::adhesive::{ContactTree, EdgeModel, GridEdges, Ground, Held, Run, SubCellEdges};
use super::fragments::runs;
use super::{ContactError, HessRule, resized};
use crate::scene::Edges;

/// Contact at any indentation of one leg.
#[derive(Clone, Copy, Debug)]
pub struct LegView<'a> {
    gaps: &'a [f64],
    contact: Contact<'a>,
}

/// Data that define the contact.
#[derive(Clone, Copy, Debug)]
enum Contact<'a> {
    /// Nothing touches on this leg.
    Apart,
    /// Each spring touches at its own gap.
    Gaps,
    /// A threshold for each spring along the line, m.
    Line(&'a [f64]),
    /// The runs of an adhesive contact.
    Runs(&'a ContactTree, &'a [Run], RunsOf),
}

/// Leg and rule of some runs.
#[derive(Clone, Copy, Debug, PartialEq)]
struct RunsOf {
    unloading: bool,
    /// Rule of Hess on this leg.
    rule: HessRule,
    edges: Edges,
    /// True if the edges are pinned where the next leg begins.
    pins: bool,
}

impl<'a> LegView<'a> {
    /// Nothing touches.
    pub(super) fn apart(self) -> Self {
        LegView { contact: Contact::Apart, ..self }
    }

    /// Each spring touches at its own gap, m.
    pub(super) fn of_gaps(gaps: &'a [f64]) -> Self {
        LegView { gaps, contact: Contact::Gaps }
    }

    /// Each spring, in its order along the line, touches at a threshold of this leg, m.
    pub(super) fn of_thresholds(gaps: &'a [f64], thresholds: &'a [f64]) -> Self {
        LegView { gaps, contact: Contact::Line(thresholds) }
    }

    /// The runs of a leg under its rule; `pins`: edges are pinned where the next leg begins.
    pub(super) fn of_runs<E: EdgeModel>(
        ground: Ground<'a, E>,
        runs: &'a [Run],
        unloading: bool,
        pins: bool,
    ) -> Self {
        let of = RunsOf { unloading, rule: ground.edges.rule(), edges: E::EDGES, pins };
        LegView { gaps: ground.gaps, contact: Contact::Runs(ground.tree, runs, of) }
    }

    /// First and last spring of each fragment in contact at `indentation` (m), in ascending order.
    ///
    /// Takes O(runs) for an adhesive contact, else O(springs).
    #[must_use]
    pub fn fragments(&self, indentation: f64) -> Vec<(usize, usize)> {
        let touching =
            |thresholds: &[f64]| runs(thresholds.iter().map(|&threshold| threshold <= indentation));
        match self.contact {
            Contact::Apart => Vec::new(),
            Contact::Gaps => touching(self.gaps),
            Contact::Line(thresholds) => touching(thresholds),
            Contact::Runs(tree, runs, of) => {
                let held = self.held(tree, runs, RunsOf { pins: false, ..of }, indentation);
                held.iter().map(|held| (held.first as usize, held.last as usize)).collect()
            }
        }
    }

    /// Height of the level of the edges above the largest gap of each of these fragments, m, in order, where edges can
    /// be pinned: between springs and under two works of adhesion. Empty elsewhere.
    #[must_use]
    pub fn rises(&self, indentation: f64) -> Vec<f64> {
        match self.contact {
            Contact::Runs(tree, runs, of) => {
                self.held(tree, runs, of, indentation).iter().filter_map(|held| held.pin).collect()
            }
            _ => Vec::new(),
        }
    }

    /// Writes, for each spring in its order along the line, the smallest indentation at which it is in
    /// contact (−∞ always, +∞ never), m.
    pub fn thresholds(&self, out: &mut Vec<f64>) {
        out.clear();
        let LegView { gaps, contact } = *self;
        match contact {
            Contact::Apart => out.resize(gaps.len(), f64::INFINITY),
            Contact::Gaps => out.extend_from_slice(gaps),
            Contact::Line(thresholds) => out.extend_from_slice(thresholds),
            Contact::Runs(tree, runs, RunsOf { unloading, rule, edges, .. }) => match edges {
                Edges::Grid => {
                    Ground { gaps, tree, edges: GridEdges::new(rule) }.thresholds(runs, unloading, out);
                }
                Edges::SubCell => {
                    Ground { gaps, tree, edges: SubCellEdges::new(rule) }.thresholds(runs, unloading, out);
                }
            },
        }
    }

    /// The fragments of runs at an indentation, m.
    fn held(&self, tree: &ContactTree, runs: &[Run], of: RunsOf, indentation: f64) -> Vec<Held> {
        let RunsOf { unloading, rule, edges, pins } = of;
        let gaps = self.gaps;
        match edges {
            Edges::Grid => {
                let ground = Ground { gaps, tree, edges: GridEdges::new(rule) };
                ground.held_at(runs, unloading, indentation, pins).collect()
            }
            Edges::SubCell => {
                let ground = Ground { gaps, tree, edges: SubCellEdges::new(rule) };
                ground.held_at(runs, unloading, indentation, pins).collect()
            }
        }
    }
}

/// The contact at any indentation of one leg, copied from a [`Solver`](super::Solver) after the leg.
///
/// A copy holds the runs of an adhesive contact, nothing where the gaps alone define the contact, and a number for each
/// spring of the stepwise solver. Its memory serves for other legs and lines.
#[derive(Clone, Debug, Default)]
pub struct LegContact {
    kind: Kind,
    runs: Vec<Run>,
    thresholds: Vec<f64>,
}

/// Kind of a copied [`Contact`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
enum Kind {
    #[default]
    Apart,
    Gaps,
    Line,
    Runs(RunsOf),
}

impl LegContact {
    /// The contact of the leg. `gaps` and `tree` are those of its run; only an exact solution of adhesion needs a tree,
    /// and without one the view shows no contact.
    #[must_use]
    pub fn view<'a>(&'a self, gaps: &'a [f64], tree: Option<&'a ContactTree>) -> LegView<'a> {
        let contact = match (self.kind, tree) {
            (Kind::Gaps, _) => Contact::Gaps,
            (Kind::Line, _) => Contact::Line(&self.thresholds),
            (Kind::Runs(of), Some(tree)) => Contact::Runs(tree, &self.runs, of),
            (Kind::Apart | Kind::Runs(_), _) => Contact::Apart,
        };
        LegView { gaps, contact }
    }

    /// Bytes held, for a caller that keeps many copies.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.thresholds.capacity() * size_of::<f64>() + self.runs.capacity() * size_of::<Run>()
    }

    /// Copies the contact of a leg.
    ///
    /// # Errors
    /// [`ContactError::OutOfMemory`]; the copy then holds no contact.
    pub(super) fn copy(&mut self, leg: LegView<'_>) -> Result<(), ContactError> {
        self.kind = Kind::Apart;
        self.kind = match leg.contact {
            Contact::Apart => Kind::Apart,
            Contact::Gaps => Kind::Gaps,
            Contact::Line(thresholds) => {
                self.thresholds = resized(std::mem::take(&mut self.thresholds), thresholds.len(), 0.0)?;
                self.thresholds.copy_from_slice(thresholds);
                Kind::Line
            }
            Contact::Runs(_, runs, of) => {
                self.runs.clear();
                let springs = runs.len();
                self.runs.try_reserve_exact(springs).map_err(|_| ContactError::OutOfMemory { springs })?;
                self.runs.extend_from_slice(runs);
                Kind::Runs(of)
            }
        };
        Ok(())
    }
}
