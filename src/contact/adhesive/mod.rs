//! Adhesive contact: the exact loop over turning points.
//!
//! The gaps of a line give a [`ContactTree`] of their local maxima. A loading pass closes its nodes from below, an
//! unloading pass opens them from above; both list the *runs* of the leg, fragments whose edges move without a jump.
//! Curves, extremes and energies are sums over these runs. Only the [`EdgeModel`] defines the length of a fragment.

mod curve;
mod edge_model;
mod energy;
mod grid_edges;
mod levels;
mod loading;
mod memory;
mod run;
mod search;
mod span;
mod sub_cell_edges;
mod tree;
mod unloading;

pub use edge_model::EdgeModel;
pub(in crate::contact) use energy::SquaredStretch;
pub use grid_edges::GridEdges;
pub(in crate::contact) use levels::{EdgeCells, EdgeSum, Slider};
pub use memory::AdhesiveMemory;
pub(in crate::contact) use run::{Ground, Held, Run};
pub(in crate::contact) use span::Span;
pub use sub_cell_edges::SubCellEdges;
pub use tree::ContactTree;
use tree::TWO_THREADS;
pub(in crate::contact) use tree::{Branch, Node};

use super::contact_model::{ContactModel, Reversed, SEARCH_INTERVALS};
use super::contact_state::{ContactState, Extreme, Sampled};
use super::grid::Grid;
use super::{ContactError, ContactTotals, Direction, LegView, Work};
use crate::parallel::in_parallel;
use energy::Range;
use search::Search;

/// Springs under adhesion, loaded and unloaded leg by leg.
pub struct Adhesive<'a, E> {
    ground: Ground<'a, E>,
    memory: AdhesiveMemory,
    unloading: bool,
    /// True if the present leg forms the contact.
    forms: bool,
}

impl<'a, E: EdgeModel> Adhesive<'a, E> {
    /// Springs of these gaps (m, the smallest 0) and the tree of these gaps, separated.
    ///
    /// # Panics
    /// For a tree of other edges.
    #[must_use]
    pub fn new(gaps: &'a [f64], tree: &'a ContactTree, edges: E, mut memory: AdhesiveMemory) -> Self {
        assert_eq!(tree.edges(), E::EDGES, "the tree sums for other edges");
        memory.closing.forget();
        memory.runs.clear();
        let ground = Ground { gaps, tree, edges };
        Adhesive { ground, memory, unloading: false, forms: false }
    }

    /// The line under the rule of the present leg.
    fn on_leg(&self) -> Ground<'a, E> {
        self.ground.on(if self.unloading { Direction::Unloading } else { Direction::Loading })
    }

    fn hold(&mut self, indentation: f64) {
        let (ground, pins) = (self.on_leg(), self.ground.edges.are_pinned());
        let held = ground.held_at(&self.memory.runs, self.unloading, indentation, pins);
        self.memory.held.clear();
        self.memory.held.extend(held);
    }

    fn search(&self) -> Search<'_, E> {
        Search { ground: self.on_leg(), runs: &self.memory.runs, unloading: self.unloading }
    }

    /// The runs `spare` hold as an unloading beside the present leg.
    fn spare(&self) -> Search<'_, E> {
        let runs = self.memory.spare.as_slice();
        Search { ground: self.ground.on(Direction::Unloading), runs, unloading: true }
    }

    /// Lists the unloading from an indentation of the loading from separation beside the present leg. Returns the smallest
    /// indentation with contact, m.
    fn unload_aside(&mut self, from: f64, work: &mut Work) -> Result<f64, ContactError> {
        let [loading, unloading] = [Direction::Loading, Direction::Unloading].map(|leg| self.ground.on(leg));
        let AdhesiveMemory { closing, opening, runs, spare, held } = &mut self.memory;
        if !self.forms {
            work.hess_evaluations += closing.close(&loading)?;
            closing.list(&loading, &[], spare, &mut work.hess_evaluations)?;
        }
        held.clear();
        let pins = self.ground.edges.are_pinned();
        held.extend(loading.held_at(if self.forms { runs } else { spare }, false, from, pins));
        let opened = opening.list(&unloading, held, from, spare)?;
        work.hess_evaluations += opened.evaluations;
        work.springs_tallied += opened.springs;
        Ok(opened.separates)
    }
}

impl<E: EdgeModel> ContactModel for Adhesive<'_, E> {
    fn count(&self) -> u64 {
        self.ground.gaps.len() as u64
    }

    fn load(&mut self, from: Option<f64>, work: &mut Work) -> Result<f64, ContactError> {
        self.memory.held.clear();
        if let Some(from) = from {
            self.hold(from);
        }
        let AdhesiveMemory { closing, runs, spare, held, .. } = &mut self.memory;
        // A contact that forms again closes as it did the first time.
        work.loading_passes += u64::from(from.is_some() || !closing.is_ready());
        let ground = self.ground.on(Direction::Loading);
        work.hess_evaluations += closing.close_around(&ground, held)?;
        let complete = closing.list(&ground, held, spare, &mut work.hess_evaluations)?;
        std::mem::swap(runs, spare);
        (self.unloading, self.forms) = (false, from.is_none());
        Ok(complete)
    }

    fn unload(&mut self, from: f64, work: &mut Work) -> Result<f64, ContactError> {
        self.hold(from);
        let AdhesiveMemory { opening, runs, spare, held, .. } = &mut self.memory;
        work.unloading_passes += 1;
        let opened = opening.list(&self.ground.on(Direction::Unloading), held, from, spare)?;
        work.hess_evaluations += opened.evaluations;
        std::mem::swap(runs, spare);
        (self.unloading, self.forms) = (true, false);
        Ok(opened.separates)
    }

    fn reverse(&mut self, at: f64, work: &mut Work) -> Result<Reversed, ContactError> {
        work.unloading_passes += 1;
        let separates = self.unload_aside(at, work)?;
        let [loading, unloading] = [Direction::Loading, Direction::Unloading].map(|leg| self.ground.on(leg));
        let range = |unloading| Range { low: f64::NEG_INFINITY, high: at, unloading };
        let squared_stretches = [
            loading.squared_stretch(&self.memory.runs, range(false)),
            unloading.squared_stretch(&self.memory.spare, range(true)),
        ];
        Ok(Reversed { separates, squared_stretches })
    }

    fn sample_reversal(&self, grid: Grid) -> Result<Sampled, ContactError> {
        self.spare().sample(grid)
    }

    fn smallest_of_reversal(
        &self,
        grid: &Grid,
        turn: ContactState,
        sorted: &mut u64,
    ) -> Result<ContactState, ContactError> {
        self.spare().smallest_below(turn, grid, sorted)
    }

    fn sample(&self, grid: Grid) -> Result<Sampled, ContactError> {
        self.search().sample(grid)
    }

    fn sample_changes(&self, grid: Grid, separated: bool) -> Result<(Sampled, f64), ContactError> {
        // The springs that touch first attach at the first point itself; those held to it detach just below.
        let low = if separated { f64::NEG_INFINITY } else { grid.points()[0] };
        let range = Range { low, high: grid.high(), unloading: self.unloading };
        let leg = self.search();
        let is_long = leg.ground.gaps.len() >= TWO_THREADS;
        let (sampled, squared) =
            in_parallel(is_long, || leg.sample(grid), || leg.ground.squared_stretch(leg.runs, range));
        Ok((sampled?, squared))
    }

    fn extreme(&self, extreme: Extreme, leg: &Sampled, sorted: &mut u64) -> ContactState {
        self.search().extreme(extreme, leg, sorted)
    }

    fn sample_coarsely(&self, grid: &Grid) -> Result<Sampled, ContactError> {
        self.search().sample_coarsely(grid)
    }

    fn first_at_least(
        &self,
        grid: &Grid,
        coarse: &Sampled,
        wanted: f64,
        sorted: &mut u64,
    ) -> Result<Option<f64>, ContactError> {
        self.search().first_at_least(grid, coarse, wanted, sorted)
    }

    fn last_at_most(&self, leg: &Sampled, wanted: f64, sorted: &mut u64) -> Option<f64> {
        self.search().last_at_most(leg, wanted, sorted)
    }

    fn straight(&self, totals: ContactTotals, compression: f64) -> Option<f64> {
        self.ground.edges.indentation_of(totals, compression, &self.ground.tree.scale())
    }

    fn leg(&self) -> LegView<'_> {
        LegView::of_runs(self.on_leg(), &self.memory.runs, self.unloading, self.ground.edges.are_pinned())
    }

    fn pull_off_at_touch(&mut self) -> Result<(f64, Work), ContactError> {
        let mut work = Work { zero_load_passes: 1, ..Work::default() };
        let separates = self.unload_aside(0.0, &mut work)?;
        let grid = Grid::new(separates.min(0.0), 0.0, SEARCH_INTERVALS);
        let search = self.spare();
        let leg = search.sample(grid)?;
        Ok((search.extreme(Extreme::Smallest, &leg, &mut work.events_sorted).compression, work))
    }

    fn give_back(self: Box<Self>, memory: &mut AdhesiveMemory) {
        *memory = self.memory;
    }
}
