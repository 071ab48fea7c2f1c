//! One leg: the contact at all indentations of a motion in one direction.

use super::adhesive::{
    Closing, EdgeCells, EdgeModel, GridEdges, Ground, Held, Opening, Run, Search, Slider, Span, SubCellEdges,
};
use super::contact_state::{ContactState, Extreme, Sampled};
use super::fragments::runs;
use super::grid::Grid;
use super::totals::ContactTotals;
use super::{Contact, ContactError, ContactTree, CurvePoint, Direction, Nonadhesive, TWO_THREADS, Work};
use crate::contact::Edges;
use crate::parallel::in_parallel;
use std::marker::PhantomData;
use std::mem::take;
use std::sync::Arc;

/// Intervals in which extremes are searched: each patch is evaluated at each of their ends.
pub(super) const SEARCH_INTERVALS: usize = 256;

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
    /// [`ContactError::OutOfMemory`].
    pub fn turn(&self, at: f64, workspace: &mut Workspace) -> Result<Self, ContactError> {
        let direction = match self.direction {
            Direction::Loading => Direction::Unloading,
            Direction::Unloading => Direction::Loading,
        };
        let turned = Leg { direction, ..self.clone() };
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

    /// Returns the point of the curve at an indentation, m.
    ///
    /// # Errors
    /// [`ContactError::OutOfMemory`].
    pub fn point(&self, indentation: f64) -> Result<CurvePoint, ContactError> {
        Ok(self.state(indentation)?.point(self.contact.foundation))
    }

    /// Returns the points of the curve at ascending indentations, m.
    ///
    /// # Errors
    /// [`ContactError::OutOfMemory`].
    pub fn curve(&self, indentations: &[f64]) -> Result<Vec<CurvePoint>, ContactError> {
        if indentations.is_empty() {
            return Ok(Vec::new());
        }
        let sampled = self.sample(Grid::at(indentations.to_vec()))?;
        Ok(sampled.states.iter().map(|state| state.point(self.contact.foundation)).collect())
    }

    /// Returns the first indentation of a loading from `from` on, or the last one of an unloading up to `from`, m, at which
    /// the force is `force`, N.
    ///
    /// # Errors
    /// [`ContactError::OutOfReach`], [`ContactError::DetachesBefore`], [`ContactError::OutOfMemory`].
    pub fn find_force(&self, force: f64, from: f64) -> Result<f64, ContactError> {
        self.reach_force(force, from, &mut Work::default())
    }

    /// Returns the points of the smallest and of the largest force between two indentations, m, exact to rounding.
    ///
    /// # Errors
    /// [`ContactError::OutOfMemory`].
    pub fn extremes(&self, low: f64, high: f64) -> Result<[CurvePoint; 2], ContactError> {
        let sampled = self.sample(self.search_grid(low, high))?;
        let of = |extreme| self.extreme(extreme, &sampled, &mut Work::default());
        Ok([Extreme::Smallest, Extreme::Largest].map(|extreme| of(extreme).point(self.contact.foundation)))
    }

    /// Returns the energy that springs release on the indentations from `low` to `high`, m, in J; see
    /// [`LegRecord::released_energy`](super::LegRecord::released_energy).
    #[must_use]
    pub fn released_energy(&self, low: f64, high: f64) -> f64 {
        let energy = 0.5 * self.contact.foundation.spring_stiffness() * self.squared_stretch(low, high);
        // Not −0 where nothing attaches with a stretch.
        if self.direction == Direction::Loading { 0.0 - energy } else { energy }
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

    /// Contact state at an indentation, m.
    pub(super) fn state(&self, indentation: f64) -> Result<ContactState, ContactError> {
        Ok(self.sample(Grid::at(vec![indentation]))?.first())
    }

    /// Grid of a search between two indentations, m: for springs with thresholds, between which the force is straight,
    /// each threshold and the number before it.
    fn search_grid(&self, low: f64, high: f64) -> Grid {
        let Patches::Thresholds(thresholds) = &self.patches else {
            return Grid::new(low, high, SEARCH_INTERVALS);
        };
        let inside = thresholds.iter().copied().filter(|at| low < *at && *at <= high);
        let mut points: Vec<f64> = inside.flat_map(|at| [at.next_down(), at]).chain([low, high]).collect();
        points.sort_by(f64::total_cmp);
        points.dedup();
        Grid::at(points)
    }

    /// Contact of whole springs at an indentation, m, patch by patch.
    fn totals(&self, indentation: f64) -> ContactTotals {
        let mut totals = ContactTotals::default();
        for ends in self.patches(indentation) {
            totals +=
                ContactTotals::of_patch(self.contact.gaps(), ends, Edges::Grid, self.contact.springs.scale());
        }
        totals
    }

    /// Finds the indentation of [`Leg::find_force`], m.
    pub(super) fn reach_force(&self, force: f64, from: f64, work: &mut Work) -> Result<f64, ContactError> {
        let Contact { springs, foundation, edges, .. } = &self.contact;
        let stiffness = foundation.spring_stiffness();
        let wanted = force / stiffness;
        work.springs_tallied += work.springs;
        if self.direction == Direction::Unloading {
            let sampled = self.sample(self.search_grid(self.end.min(from), from))?;
            return self.last_at_most(&sampled, wanted, work)?.ok_or_else(|| {
                let smallest = self.extreme(Extreme::Smallest, &sampled, work).compression;
                ContactError::DetachesBefore { smallest: stiffness * smallest }
            });
        }
        let complete = self.end.max(from);
        if let Some(found) = self.first_at_least(self.search_grid(from, complete), wanted, work)? {
            return Ok(found);
        }
        if matches!(self.patches, Patches::Thresholds(_)) {
            return Err(ContactError::OutOfReach);
        }
        // Beyond full contact the force rises with all springs.
        let full = self.sample(Grid::at(vec![complete]))?;
        let found = match edges {
            Edges::Grid => full.totals[0].indentation(wanted, &springs.scale()),
            Edges::SubCell => Some(complete + (wanted - full.first().compression) / full.first().length),
        };
        let found = found.filter(|found| found.is_finite()).map(|found| found.max(complete));
        found.ok_or(ContactError::OutOfReach)
    }

    /// Contact states along a grid.
    pub(super) fn sample(&self, grid: Grid) -> Result<Sampled, ContactError> {
        match &self.patches {
            Patches::Runs(tree, runs) => along_runs!(self, tree, runs, search => search.sample(grid)),
            Patches::Gaps => self.nonadhesive().sample(grid),
            Patches::Apart | Patches::Thresholds(_) => {
                let scale = self.contact.springs.scale();
                let totals: Vec<_> = grid.points().iter().map(|&at| self.totals(at)).collect();
                let whole = |(&at, totals): (&f64, &ContactTotals)| {
                    ContactState::new(false, at, *totals, EdgeCells::default(), &scale)
                };
                let states = grid.points().iter().zip(&totals).map(whole).collect();
                Ok(Sampled { grid, totals, states })
            }
        }
    }

    /// Contact states along a grid, and ∫ (c − θ)² dx over the parts of the line that attach or detach at an indentation
    /// θ above `low` (m) and up to the end of the grid, in cells times m².
    pub(super) fn sample_changes(&self, grid: Grid, low: f64) -> Result<(Sampled, f64), ContactError> {
        let (is_long, high) = (self.contact.gaps().len() >= TWO_THREADS, grid.high());
        let (sampled, squared) =
            in_parallel(is_long, || self.sample(grid), || self.squared_stretch(low, high));
        Ok((sampled?, squared))
    }

    /// ∫ (c − θ)² dx over the parts of the line that attach or detach at an indentation θ in a range, m, without its lower
    /// end, in cells times m².
    pub(super) fn squared_stretch(&self, low: f64, high: f64) -> f64 {
        match &self.patches {
            Patches::Runs(tree, runs) => {
                along_runs!(self, tree, runs, search => search.squared_stretch(low, high))
            }
            // No spring is stretched.
            _ => 0.0,
        }
    }

    /// Extreme force on the range of a grid.
    pub(super) fn extreme(&self, extreme: Extreme, sampled: &Sampled, work: &mut Work) -> ContactState {
        match &self.patches {
            Patches::Runs(tree, runs) => {
                along_runs!(self, tree, runs, search => search.extreme(extreme, sampled, &mut work.events_sorted))
            }
            // Without adhesion the force never falls; springs with thresholds are sampled at all of them.
            _ => extreme.of(sampled),
        }
    }

    /// Smallest force of an unloading on the range of a grid.
    pub(super) fn smallest(&self, grid: &Grid, work: &mut Work) -> Result<ContactState, ContactError> {
        match &self.patches {
            Patches::Runs(tree, runs) => {
                along_runs!(self, tree, runs, search => search.smallest(grid, &mut work.events_sorted))
            }
            _ => self.state(grid.points()[0]),
        }
    }

    /// Smallest indentation of a grid at which the compression is at least `wanted`.
    pub(super) fn first_at_least(
        &self,
        grid: Grid,
        wanted: f64,
        work: &mut Work,
    ) -> Result<Option<f64>, ContactError> {
        match &self.patches {
            Patches::Runs(tree, runs) => along_runs!(self, tree, runs, search => {
                search.first_at_least(&grid, wanted, &mut work.events_sorted)
            }),
            _ => self.nonadhesive().first_at_least(&self.sample(grid)?, wanted),
        }
    }

    /// Largest indentation of a grid at which the compression is at most `wanted`.
    pub(super) fn last_at_most(
        &self,
        sampled: &Sampled,
        wanted: f64,
        work: &mut Work,
    ) -> Result<Option<f64>, ContactError> {
        match &self.patches {
            Patches::Runs(tree, runs) => along_runs!(self, tree, runs, search => {
                Ok(search.last_at_most(sampled, wanted, &mut work.events_sorted))
            }),
            _ => self.nonadhesive().last_at_most(sampled, wanted),
        }
    }

    fn nonadhesive(&self) -> Nonadhesive<'_> {
        Nonadhesive::new(&self.contact.springs, self.contact.edges)
    }
}
