//! Adhesive contact: the exact loop over turning points.
//!
//! The gaps of a line give a [`ContactTree`] of their local maxima. A loading pass closes its nodes from below, an
//! unloading pass opens them from above; both list the *runs* of the leg, fragments whose edges move without a jump.
//! Curves, extremes and energies are sums over these runs. How the length of a fragment is read is the business of an
//! [`EdgeModel`] alone.

mod curve;
mod dissipation;
mod edge_model;
mod grid_edges;
mod loading;
mod reversing;
mod run;
mod search;
mod span;
mod sub_cell_edges;
mod tree;
mod unloading;

pub(in crate::contact) use dissipation::AtOnce;
pub(in crate::contact) use edge_model::{Boundary, Edge};
pub use edge_model::{EdgeCells, EdgeModel};
pub use grid_edges::GridEdges;
pub(in crate::contact) use run::{Ground, Held, Run};
pub(in crate::contact) use span::Span;
pub use sub_cell_edges::SubCellEdges;
pub use tree::ContactTree;
use tree::TWO_THREADS;
pub(in crate::contact) use tree::{Branch, Node};

use super::contact_model::{ContactModel, ContactState, Sampled};
use super::grid::Grid;
use super::{ContactError, ContactTotals, Direction, LegContact, Work};
use crate::parallel::in_parallel;
use dissipation::Range;
use loading::Closing;
use reversing::Reversing;
use search::Search;
use unloading::Opening;

/// Memory reused from body to body: fresh memory costs about as much as a pass.
#[derive(Clone, Debug, Default)]
pub struct AdhesiveMemory {
    closing: Closing,
    opening: Opening,
    runs: Vec<Run>,
    spare: Vec<Run>,
    held: Vec<Held>,
}

impl AdhesiveMemory {
    /// Bytes it holds on to.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.closing.bytes() + size_of::<Run>() * (self.runs.capacity() + self.spare.capacity())
    }
}

/// Springs under adhesion, loaded and unloaded leg by leg.
pub struct Adhesive<'a, E> {
    ground: Ground<'a, E>,
    memory: AdhesiveMemory,
    unloading: bool,
    /// True if the present leg forms the contact.
    forms: bool,
    reversing: Reversing,
    /// Squares of stretches on the way to and from the present turning point, m².
    squares: [f64; 2],
}

impl<'a, E: EdgeModel> Adhesive<'a, E> {
    /// Springs of these gaps (m, the smallest 0) and the tree of these gaps, separated.
    #[must_use]
    pub fn new(gaps: &'a [f64], tree: &'a ContactTree, edges: E, mut memory: AdhesiveMemory) -> Self {
        debug_assert_eq!(tree.edges(), E::EDGES, "the tree sums for other edges");
        memory.closing.forget();
        memory.runs.clear();
        let ground = Ground { gaps, tree, edges };
        let reversing = Reversing::default();
        Adhesive { ground, memory, unloading: false, forms: false, reversing, squares: [0.0; 2] }
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

    /// Memory of the contact, for the next one.
    pub(super) fn into_memory(self) -> AdhesiveMemory {
        self.memory
    }

    /// The runs `spare` hold as an unloading beside the present leg.
    fn spare(&self) -> Search<'_, E> {
        let runs = self.memory.spare.as_slice();
        Search { ground: self.ground.on(Direction::Unloading), runs, unloading: true }
    }

    /// The unloading from the present turning point.
    fn reversal(&self) -> Search<'_, E> {
        let spare = self.spare();
        if self.ground.edges.are_pinned() { spare } else { Search { runs: self.reversing.runs(), ..spare } }
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

    /// Smallest compression of the unloading from first touch, m, and the work counts of the search.
    pub(super) fn pull_off_at_touch(&mut self) -> Result<(f64, Work), ContactError> {
        let mut work = Work { zero_load_passes: 1, ..Work::default() };
        let separates = self.unload_aside(0.0, &mut work)?;
        let grid = Grid::new(separates.min(0.0), 0.0, Self::SEARCH_INTERVALS);
        let search = self.spare();
        let leg = search.ground.sample(search.runs, true, grid)?;
        Ok((search.smallest(&leg, &mut work.events_sorted).compression, work))
    }
}

impl<E: EdgeModel> ContactModel for Adhesive<'_, E> {
    // Each fragment is evaluated at each of their ends.
    const SEARCH_INTERVALS: usize = 256;

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

    fn begin_reversals(&mut self, turns: &[f64]) -> Result<(), ContactError> {
        let loading = self.ground.on(Direction::Loading);
        if self.ground.edges.are_pinned() {
            return Ok(());
        }
        self.reversing.begin(&loading, &self.memory.runs, turns)
    }

    fn reverse(&mut self, turn: (usize, f64), work: &mut Work) -> Result<f64, ContactError> {
        work.unloading_passes += 1;
        let [loading, unloading] = [Direction::Loading, Direction::Unloading].map(|leg| self.ground.on(leg));
        if !self.ground.edges.are_pinned() {
            let (runs, evaluations) = (&self.memory.runs, &mut work.hess_evaluations);
            let separates = self.reversing.turn([&loading, &unloading], runs, turn, evaluations)?;
            self.squares = self.reversing.squared_stretches();
            return Ok(separates);
        }
        // Edges that keep their place at first have another unloading from each turning point.
        let separates = self.unload_aside(turn.1, work)?;
        let range = |unloading| Range { low: f64::NEG_INFINITY, high: turn.1, unloading };
        self.squares = [
            loading.squared_stretch(&self.memory.runs, range(false)),
            unloading.squared_stretch(&self.memory.spare, range(true)),
        ];
        Ok(separates)
    }

    fn sample_reversal(&self, grid: Grid) -> Result<Sampled, ContactError> {
        let Search { ground, runs, unloading } = self.reversal();
        ground.sample(runs, unloading, grid)
    }

    fn smallest_of_reversal(&self, grid: &Grid, sorted: &mut u64) -> Result<ContactState, ContactError> {
        self.reversal().smallest_on(grid, sorted)
    }

    fn squared_stretches(&self) -> [f64; 2] {
        self.squares
    }

    fn sample(&self, grid: Grid) -> Result<Sampled, ContactError> {
        self.on_leg().sample(&self.memory.runs, self.unloading, grid)
    }

    fn sample_changes(&self, grid: Grid, separated: bool) -> Result<(Sampled, f64), ContactError> {
        // The springs that touch first attach at the first point itself; those held to it detach just below.
        let low = if separated { f64::NEG_INFINITY } else { grid.points()[0] };
        let range = Range { low, high: grid.high(), unloading: self.unloading };
        let (ground, runs) = (self.on_leg(), &self.memory.runs);
        let is_long = ground.gaps.len() >= TWO_THREADS;
        let (sampled, squared) = in_parallel(
            is_long,
            || ground.sample(runs, self.unloading, grid),
            || ground.squared_stretch(runs, range),
        );
        Ok((sampled?, squared))
    }

    fn smallest(&self, leg: &Sampled, sorted: &mut u64) -> ContactState {
        self.search().smallest(leg, sorted)
    }

    fn largest(&self, leg: &Sampled, sorted: &mut u64) -> ContactState {
        self.search().largest(leg, sorted)
    }

    fn first_at_least(&self, leg: &Sampled, wanted: f64, sorted: &mut u64) -> Option<f64> {
        self.search().first_at_least(leg, wanted, sorted)
    }

    fn last_at_most(&self, leg: &Sampled, wanted: f64, sorted: &mut u64) -> Option<f64> {
        self.search().last_at_most(leg, wanted, sorted)
    }

    fn straight(&self, totals: ContactTotals, compression: f64) -> Option<f64> {
        self.ground.edges.indentation_of(totals, compression, &self.ground.tree.scale())
    }

    fn thresholds_along_line(&self, out: &mut Vec<f64>) {
        self.on_leg().thresholds(&self.memory.runs, self.unloading, out);
    }

    fn copy_leg(&self, copy: &mut LegContact) -> Result<(), ContactError> {
        let pins = self.ground.edges.are_pinned();
        copy.keep_runs(&self.memory.runs, self.unloading, self.on_leg().edges, pins)
    }

    fn rises(&self, indentation: f64) -> Vec<f64> {
        let pins = self.ground.edges.are_pinned();
        let ground = self.on_leg();
        let held = ground.held_at(&self.memory.runs, self.unloading, indentation, pins);
        held.filter_map(|held| held.pin).collect()
    }

    fn fragments(&self, indentation: f64) -> Vec<(usize, usize)> {
        let ground = self.on_leg();
        let held = ground.held_at(&self.memory.runs, self.unloading, indentation, false);
        held.map(|held| (held.first as usize, held.last as usize)).collect()
    }
}
