//! One leg: the contact at all indentations of a motion in one direction.

use super::adhesive::{
    Closing, EdgeCells, EdgeModel, GridEdges, Ground, Held, Opening, Run, Search, Slider, Span, SubCellEdges,
};
use super::contact_state::ContactState;
use super::fragments::runs;
use super::totals::ContactTotals;
use super::{Contact, ContactError, ContactTree, Direction, Work};
use crate::contact::Edges;
use std::marker::PhantomData;
use std::mem::take;
use std::sync::Arc;

/// Contact at all indentations of a motion in one direction.
///
/// A leg is a value: it stays valid after the body has moved on, and its copies share their memory.
#[derive(Clone, Debug)]
pub struct Leg {
    contact: Contact,
    direction: Direction,
    patches: Patches,
    end: f64,
}

/// Data from which the patches in contact follow.
#[derive(Clone, Debug)]
enum Patches {
    /// Nothing touches on this leg.
    Apart,
    /// Each spring touches at its own gap.
    Gaps,
    /// Each spring touches at a threshold, m.
    Thresholds(Arc<Vec<f64>>),
    /// The patches of an adhesive contact, each as long as its edges move without a jump.
    Runs(Arc<ContactTree>, Arc<Vec<Run>>),
}

/// Length, load and stretch of one patch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PatchState {
    /// Length, m.
    pub length: f64,
    /// Force, N.
    pub force: f64,
    /// Largest stretch Δl_max at this length, m, eq. (10).
    pub largest_stretch: f64,
    /// Stretch of its edges, or of its most stretched spring, m.
    pub most_stretched: f64,
}

/// Memory reused from leg to leg, and the work done: fresh memory costs about as much as a pass.
#[derive(Debug, Default)]
pub struct Workspace {
    closing: Closing,
    opening: Opening,
    spare: Vec<Run>,
    held: Vec<Held>,
    /// Work counts.
    pub work: Work,
}

/// Evaluates an expression with the search along the runs of a leg, under the edge model of its contact.
macro_rules! along_runs {
    ($leg:expr, $tree:expr, $runs:expr, $search:ident => $value:expr) => {{
        let (leg, tree, runs): (&Leg, &ContactTree, &[Run]) = ($leg, $tree, $runs);
        match leg.contact.edges {
            Edges::Grid => {
                let $search = Search { ground: leg.ground::<GridEdges>(tree), runs };
                $value
            }
            Edges::SubCell => {
                let $search = Search { ground: leg.ground::<SubCellEdges>(tree), runs };
                $value
            }
        }
    }};
}

mod forces;

pub(super) use forces::SEARCH_INTERVALS;

impl Workspace {
    /// Forgets the springs and the rule, and the work done.
    pub(super) fn forget(&mut self) {
        self.closing.forget();
        self.work = Work::default();
    }

    /// Number of springs in contact where the last leg begins.
    pub(super) fn springs_held(&self) -> u64 {
        self.held.iter().map(|held| u64::from(held.last + 1 - held.first)).sum()
    }

    /// Takes the memory of a leg that nothing else uses.
    pub(super) fn recycle(&mut self, leg: Leg) {
        if let Patches::Runs(_, runs) = leg.patches
            && let Some(runs) = Arc::into_inner(runs)
            && runs.capacity() > self.spare.capacity()
        {
            self.spare = runs;
        }
    }
}

impl Leg {
    /// Creates the leg of a body that touches nothing.
    #[must_use]
    pub fn apart(contact: &Contact, direction: Direction) -> Self {
        Leg { contact: contact.clone(), direction, patches: Patches::Apart, end: 0.0 }
    }

    /// Creates a leg on which each spring touches at a threshold, m, −∞ always, +∞ never, known up to the indentation
    /// `end`, m.
    pub(super) fn of_thresholds(
        contact: &Contact,
        direction: Direction,
        end: f64,
        thresholds: Vec<f64>,
    ) -> Self {
        let patches = Patches::Thresholds(Arc::new(thresholds));
        Leg { patches, end, ..Leg::apart(contact, direction) }
    }

    /// Starts a loading from separation.
    ///
    /// # Errors
    /// [`ContactError::OutOfMemory`].
    pub fn approach(contact: &Contact, workspace: &mut Workspace) -> Result<Self, ContactError> {
        workspace.held.clear();
        let leg = Leg::apart(contact, Direction::Loading);
        if contact.hess.is_none() {
            return Ok(Leg { patches: Patches::Gaps, end: contact.springs.deepest(), ..leg });
        }
        let tree = Arc::clone(contact.springs.tree(contact.edges)?);
        leg.list(tree, workspace, f64::NEG_INFINITY)
    }

    /// Starts the motion in the opposite direction at an indentation of this leg, m.
    ///
    /// # Errors
    /// [`ContactError::Stepwise`], [`ContactError::OutOfMemory`].
    pub fn turn(&self, at: f64, workspace: &mut Workspace) -> Result<Self, ContactError> {
        let direction = match self.direction {
            Direction::Loading => Direction::Unloading,
            Direction::Unloading => Direction::Loading,
        };
        let turned = Leg { direction, ..self.clone() };
        if self.is_stepwise() {
            return Err(ContactError::Stepwise);
        }
        let Patches::Runs(tree, runs) = &self.patches else {
            let end = if direction == Direction::Loading { self.contact.springs.deepest() } else { 0.0 };
            return Ok(Leg { end, ..turned });
        };
        workspace.held.clear();
        along_runs!(self, tree, runs, search => workspace.held.extend(search.held_at(at, self.pins())));
        turned.list(Arc::clone(tree), workspace, at)
    }

    /// Lists the runs of this leg from the patches held by the workspace at an indentation, m.
    fn list(
        self,
        tree: Arc<ContactTree>,
        workspace: &mut Workspace,
        from: f64,
    ) -> Result<Self, ContactError> {
        let Workspace { closing, opening, spare, held, work } = workspace;
        let mut runs = take(spare);
        work.tree_nodes = tree.node_count() as u64;
        let direction = self.direction;
        let end = along_runs!(&self, &tree, &[], search => match direction {
            Direction::Loading => {
                let ground = &search.ground;
                // A contact that forms again closes as it did the first time.
                work.loading_passes += u64::from(!held.is_empty() || !closing.is_ready());
                work.hess_evaluations += closing.close_around(ground, held)?;
                closing.list(ground, held, &mut runs, &mut work.hess_evaluations)?
            }
            Direction::Unloading => {
                let opened = opening.list(&search.ground, held, from, &mut runs)?;
                work.unloading_passes += 1;
                work.hess_evaluations += opened.evaluations;
                opened.separates
            }
        });
        Ok(Leg { patches: Patches::Runs(tree, Arc::new(runs)), end, ..self })
    }

    /// Returns true for a leg of the stepwise solver, which is known where the solver has been.
    pub(super) fn is_stepwise(&self) -> bool {
        matches!(self.patches, Patches::Thresholds(_))
    }

    /// Contact of which this is a leg.
    #[must_use]
    pub fn contact(&self) -> &Contact {
        &self.contact
    }

    /// Direction of the motion.
    #[must_use]
    pub fn direction(&self) -> Direction {
        self.direction
    }

    /// Smallest indentation of full contact of a loading, or the smallest one with contact of an unloading, m; of the
    /// stepwise solver, the indentation that it has reached.
    #[must_use]
    pub fn end(&self) -> f64 {
        self.end
    }

    /// Bytes of its own.
    #[must_use]
    pub fn bytes(&self) -> usize {
        match &self.patches {
            Patches::Apart | Patches::Gaps => 0,
            Patches::Thresholds(thresholds) => size_of::<f64>() * thresholds.capacity(),
            Patches::Runs(_, runs) => size_of::<Run>() * runs.capacity(),
        }
    }

    /// Returns first and last spring of each patch in contact at an indentation, m, from left to right.
    #[must_use]
    pub fn patches(&self, indentation: f64) -> Vec<(usize, usize)> {
        let touching =
            |thresholds: &[f64]| runs(thresholds.iter().map(|&threshold| threshold <= indentation));
        match &self.patches {
            Patches::Apart => Vec::new(),
            Patches::Gaps => touching(self.contact.gaps()),
            Patches::Thresholds(thresholds) => touching(thresholds),
            Patches::Runs(tree, runs) => along_runs!(self, tree, runs, search => {
                search.held_at(indentation, false).map(|held| (held.first as usize, held.last as usize)).collect()
            }),
        }
    }

    /// Returns the smallest indentation at which each spring along the line is in contact, m: −∞ always, +∞ never.
    #[must_use]
    pub fn thresholds(&self) -> Vec<f64> {
        match &self.patches {
            Patches::Apart => vec![f64::INFINITY; self.contact.gaps().len()],
            Patches::Gaps => self.contact.gaps().to_vec(),
            Patches::Thresholds(thresholds) => thresholds.to_vec(),
            Patches::Runs(tree, runs) => along_runs!(self, tree, runs, search => search.thresholds()),
        }
    }

    /// Evaluates the patch of this number, from the left, at an indentation, m; `None` without such a patch.
    #[must_use]
    pub fn patch_state(&self, indentation: f64, number: usize) -> Option<PatchState> {
        let Contact { springs, foundation, edges, .. } = &self.contact;
        let (first, last) = *self.patches(indentation).get(number)?;
        let (rule, gaps, scale) = (self.contact.rule(), springs.gaps(), springs.scale());
        let slides = *edges == Edges::SubCell;
        let stretch = rule.stretch(self.direction);
        let span = Span { gap: gaps[first..=last].iter().copied().fold(0.0, f64::max), first, last };
        let pin = match &self.patches {
            Patches::Runs(tree, runs) => along_runs!(self, tree, runs, search => {
                search.held_at(indentation, self.pins()).nth(number)?.pin
            }),
            _ => None,
        };
        let totals = ContactTotals::of_patch(gaps, (first, last), *edges, scale);
        let cells = || Slider::new(gaps, &span, stretch, pin).edge_cells(indentation);
        let cells = if slides { cells() } else { EdgeCells::default() };
        let state = ContactState::new(slides, indentation, totals, cells, &scale);
        let free = || if slides { SubCellEdges::levels(gaps, &span).rise(stretch, indentation) } else { 0.0 };
        let point = state.point(*foundation);
        Some(PatchState {
            length: point.contact_length,
            force: point.force,
            largest_stretch: rule.largest_stretch(1) * state.length.sqrt(),
            most_stretched: span.gap + pin.unwrap_or_else(free) - indentation,
        })
    }

    /// Returns true where the edges of patches keep their place at first when the direction turns, since the rules of
    /// loading and of unloading differ. Between springs alone an edge has a place of its own to keep.
    fn pins(&self) -> bool {
        self.contact.edges == Edges::SubCell && !self.contact.rule().is_one()
    }

    fn ground<'a, E: EdgeModel>(&'a self, tree: &'a ContactTree) -> Ground<'a, E> {
        let unloading = self.direction == Direction::Unloading;
        Ground {
            gaps: self.contact.gaps(),
            tree,
            edges: PhantomData,
            stretch: self.contact.rule().stretch(self.direction),
            unloading,
        }
    }
}
