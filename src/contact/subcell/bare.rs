//! Edges without adhesion: each cell fills as the indentation passes it, on the way in as on the way out. No
//! tree, no rule, no pass.

use super::between::{EdgeSprings, Piece};
use super::edges::{EdgeSum, Edges};
use crate::contact::ledger::{CompensatedSum, Event, Grid, Ledger, Spring, Springs};
use crate::contact::springs::{BareSprings, Thresholds};
use crate::contact::tally::GapScale;
use crate::contact::{ContactError, LegContact, Work};
use crate::parallel::in_parallel;

/// The line through springs without adhesion.
pub struct BareLine<'a> {
    springs: BareSprings<'a>,
}

impl<'a> BareLine<'a> {
    /// The line through springs of these gaps, m, the smallest 0.
    pub fn new(gaps: &'a [f64]) -> Self {
        BareLine { springs: BareSprings::new(gaps) }
    }

    fn gaps(&self) -> &'a [f64] {
        self.springs.gaps()
    }
}

/// A cell between two springs, in contact in part while the indentation lies between their gaps, or the half
/// cell at an end of the foundation, which lies level with its spring.
#[derive(Clone, Copy, Debug)]
pub struct Cell {
    /// The smaller gap, m.
    low: f64,
    /// The larger one, m; infinite at an end.
    high: f64,
    /// What of it is in contact at the smaller gap, in cells.
    share: f64,
    /// By how much that grows with the indentation, 1/m.
    growth: f64,
}

impl Cell {
    /// The cell between two springs; `None` where it is level and fills all at once.
    #[inline]
    fn between(left: f64, right: f64) -> Option<Cell> {
        let (low, high) = if left < right { (left, right) } else { (right, left) };
        let growth = (high - low).recip();
        (growth < f64::INFINITY).then_some(Cell { low, high, share: 0.0, growth })
    }

    /// The half cell at an end of the foundation.
    fn end(gap: f64) -> Cell {
        Cell { low: gap, high: f64::INFINITY, share: 0.5, growth: 0.0 }
    }
}

impl Piece for Cell {
    fn from(&self) -> f64 {
        self.low
    }

    fn to(&self) -> f64 {
        self.high
    }

    #[inline]
    fn edges(&self, indentation: f64) -> Edges {
        let above = indentation - self.low;
        let grown = above * self.growth;
        Edges { length: self.share + grown, compression: above * (self.share + 0.5 * grown) }
    }

    fn stiffness(&self, indentation: f64) -> f64 {
        self.edges(indentation).length
    }
}

/// What cells add as a quadratic in the way from a point of the grid: `compression + length x + curvature x²`;
/// the length is its derivative.
#[derive(Clone, Copy, Default)]
struct Quadratic {
    compression: CompensatedSum,
    length: CompensatedSum,
    curvature: CompensatedSum,
}

impl Quadratic {
    /// Adds a cell, or takes it away, at a point.
    #[inline]
    fn add(&mut self, cell: &Cell, point: f64, sign: f64) {
        let Edges { length, compression } = cell.edges(point);
        self.compression.add(sign * compression);
        self.length.add(sign * length);
        self.curvature.add(sign * 0.5 * cell.growth);
    }

    fn add_all(&mut self, other: Quadratic) {
        self.compression.add_sum(other.compression);
        self.length.add_sum(other.length);
        self.curvature.add_sum(other.curvature);
    }

    /// The same from a point further on.
    fn shift(&mut self, way: f64) {
        let (length, bend) = (self.length.total(), way * self.curvature.total());
        self.compression.add(way * (length + bend));
        self.length.add(2.0 * bend);
    }
}

impl BareLine<'_> {
    /// The two halves of a cell at the ends of the foundation.
    fn ends(&self) -> impl Iterator<Item = Cell> {
        let gaps = self.gaps();
        gaps.first().into_iter().chain(gaps.last()).map(|&gap| Cell::end(gap))
    }

    /// What the cells add at one indentation, whatever leg leads there.
    fn edges_at(&self, indentation: f64) -> Edges {
        let mut sum = EdgeSum::default();
        self.ends().filter(|end| end.is_at(indentation)).for_each(|end| sum.add(end.edges(indentation)));
        for cell in self.gaps().windows(2) {
            let (left, right) = (cell[0], cell[1]);
            if (left <= indentation) == (right <= indentation) {
                continue;
            }
            if let Some(cell) = Cell::between(left, right) {
                sum.add(cell.edges(indentation));
            }
        }
        sum.total()
    }
}

impl Springs for BareLine<'_> {
    #[inline]
    fn each(&self, mut see: impl FnMut(Spring)) {
        let gaps = self.gaps();
        let scale = self.springs.scale();
        let mut before = f64::INFINITY;
        for (index, &gap) in gaps.iter().enumerate() {
            let after = gaps.get(index + 1).copied().unwrap_or(f64::INFINITY);
            // The cells to neighbours that touch earlier; among equals the one on the left counts as the
            // later.
            let (left, right) = (before < gap, after <= gap);
            let cell =
                |closes: bool, neighbour: f64| if closes { scale.mean_quanta(gap, neighbour) } else { 0 };
            let quanta = cell(left, before) + cell(right, after);
            let fragments = 1 - i64::from(left) - i64::from(right);
            see(Spring { threshold: gap, gap, quanta, fragments });
            before = gap;
        }
    }

    fn scale(&self) -> &GapScale {
        self.springs.scale()
    }
}

impl Thresholds for BareLine<'_> {
    fn count(&self) -> u64 {
        self.springs.count()
    }

    fn load(&mut self, from: Option<f64>, work: &mut Work) -> f64 {
        self.springs.load(from, work)
    }

    fn unload(&mut self, from: f64, work: &mut Work) -> f64 {
        self.springs.unload(from, work)
    }

    fn thresholds_along_line(&self, out: &mut Vec<f64>) {
        self.springs.thresholds_along_line(out);
    }

    fn copy_leg(&self, copy: &mut LegContact) -> Result<(), ContactError> {
        self.springs.copy_leg(copy)
    }

    fn fragments(&self, indentation: f64) -> Vec<(usize, usize)> {
        self.springs.fragments(indentation)
    }
}

impl EdgeSprings for BareLine<'_> {
    type Piece = Cell;

    fn each_piece(&self, low: f64, high: f64, mut see: impl FnMut(Cell)) {
        self.ends().filter(|end| end.low <= high).for_each(&mut see);
        for cell in self.gaps().windows(2) {
            let (left, right) = (cell[0], cell[1]);
            if (left <= high || right <= high)
                && (left > low || right > low)
                && let Some(cell) = Cell::between(left, right)
            {
                see(cell);
            }
        }
    }

    fn events(&self, ledger: &Ledger, chosen: &[bool]) -> Vec<Event> {
        ledger.events(self, chosen)
    }

    /// Whole cells and edges are summed side by side: neither sees the other.
    fn along(&self, grid: Grid) -> (Ledger, Vec<Edges>) {
        let of_edges = grid.clone();
        let (edges, ledger) =
            in_parallel(self.is_long(), move || self.edges_along(&of_edges), || Ledger::new(self, grid));
        (ledger, edges)
    }

    fn along_with_stretches(&self, grid: Grid, _: f64) -> (Ledger, Vec<Edges>, f64) {
        let (ledger, edges) = self.along(grid);
        (ledger, edges, 0.0)
    }

    fn is_monotone(&self) -> bool {
        true
    }
}

impl BareLine<'_> {
    /// What all edges add at each point of a grid.
    ///
    /// A cell enters at the first point it reaches and leaves at the first beyond it; between them the sum of
    /// all is one quadratic, so that no cell is looked at more often however many points it passes.
    fn edges_along(&self, grid: &Grid) -> Vec<Edges> {
        let points = grid.points();
        let last = points.len() - 1;
        let place = |gap: f64| if gap > points[last] { points.len() } else { grid.first_at_least(gap) };
        let mut changes = vec![Quadratic::default(); points.len()];
        for end in self.ends() {
            let enters = place(end.low);
            if enters <= last {
                changes[enters].add(&end, points[enters], 1.0);
            }
        }
        let mut before = self.gaps().first().map(|&gap| (gap, place(gap)));
        for &gap in self.gaps() {
            let here = (gap, place(gap));
            if let Some(before) = before.replace(here)
                && before.1 != here.1
                && let Some(cell) = Cell::between(before.0, here.0)
            {
                let (enters, leaves) = (before.1.min(here.1), before.1.max(here.1));
                changes[enters].add(&cell, points[enters], 1.0);
                if leaves <= last {
                    changes[leaves].add(&cell, points[leaves], -1.0);
                }
            }
        }
        let mut sum = Quadratic::default();
        let mut from = points[0];
        let mut edges: Vec<Edges> = points
            .iter()
            .zip(changes)
            .map(|(&point, change)| {
                sum.shift(point - from);
                from = point;
                sum.add_all(change);
                Edges { length: sum.length.total(), compression: sum.compression.total() }
            })
            .collect();
        // Where a leg begins and ends the next one goes on, so there the same is found whatever the grid.
        for index in [0, last] {
            edges[index] = self.edges_at(points[index]);
        }
        edges
    }
}
