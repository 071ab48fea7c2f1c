//! Contact without adhesion: a spring carries exactly while its gap is closed, on any leg.
//!
//! The contact depends on the indentation alone, so there is no history and no threshold; the force is a convex
//! function of the indentation. One pass along the line yields a whole curve.
//!
//! A *cell*, the line between two neighbouring springs, fills from its smaller gap to its larger one. Full cells are
//! summed exactly, as whole numbers of quanta. Partly filled cells are summed one by one, which keeps every
//! digit for any slope and any indentation; only cells that are partly filled at
//! many points of a curve in a row add as quadratics, whose coefficients their height bounds there.

use super::HessRule;
use super::adhesive::{EdgeCells, EdgeModel, EdgeSum, GridEdges, SubCellEdges};
use super::contact_state::{ContactState, Sampled};
use super::crossing::bisect;
use super::grid::{CompensatedSum, Grid};
use super::interval::Interval;
use super::totals::{ContactTotals, GapScale};
use super::{ContactError, Springs, resized};
use crate::scene::Edges;
use std::ops::Range;

/// Most points of a curve in a row at which a partly filled cell is added point by point.
const FEW_POINTS: usize = 4;
/// Most Newton steps to a force; bisection does the rest.
const NEWTON_STEPS: usize = 200;

/// Springs of a line without adhesion.
#[derive(Clone, Copy, Debug)]
pub struct Nonadhesive<'a> {
    gaps: &'a [f64],
    edges: Edges,
    scale: GapScale,
}

/// A cell from `low` to `high` (m), filled up to an indentation between them.
#[inline]
fn partly_filled(low: f64, high: f64, indentation: f64) -> EdgeCells {
    let above = indentation - low;
    let share = above / (high - low);
    EdgeCells { length: share, compression: 0.5 * above * share }
}

/// Sum of cells as a quadratic in the distance x from a point: `compression + length x + curvature x²`.
#[derive(Clone, Copy, Debug, Default)]
struct Quadratic {
    partial: EdgeSum,
    curvature: CompensatedSum,
}

impl Quadratic {
    /// Adds (`sign` 1) or subtracts (−1) a cell at a point.
    #[inline]
    fn add(&mut self, low: f64, high: f64, point: f64, sign: f64) {
        let (above, growth) = (point - low, (high - low).recip());
        let share = above * growth;
        self.partial.length.add(sign * share);
        self.partial.compression.add(sign * 0.5 * above * share);
        self.curvature.add(sign * 0.5 * growth);
    }

    fn add_all(&mut self, other: Quadratic) {
        self.partial.length.add_sum(other.partial.length);
        self.partial.compression.add_sum(other.partial.compression);
        self.curvature.add_sum(other.curvature);
    }

    /// Shifts the point.
    fn shift(&mut self, way: f64) {
        let (length, bend) = (self.partial.length.total(), way * self.curvature.total());
        self.partial.compression.add(way * (length + bend));
        self.partial.length.add(2.0 * bend);
    }
}

/// Changes of the contact from one point of a grid to the next.
struct Changes {
    /// Most points at which a partly filled cell is added by itself.
    few: usize,
    whole: Vec<ContactTotals>,
    partial: Vec<EdgeSum>,
    quadratic: Vec<Quadratic>,
}

/// The contact in an interval of indentations.
struct Between<'s> {
    contact: &'s Nonadhesive<'s>,
    /// Full springs or cells.
    full: Interval<GridEdges>,
    /// Cells that are partly filled anywhere inside.
    cells: Vec<[f64; 2]>,
}

impl<'a> Nonadhesive<'a> {
    /// Creates a contact of these springs.
    pub fn new(springs: &'a Springs, edges: Edges) -> Self {
        Nonadhesive { gaps: springs.gaps(), edges, scale: springs.scale() }
    }

    /// Smaller and larger gap of each cell, m.
    fn cells(&self) -> impl Iterator<Item = [f64; 2]> {
        self.gaps
            .windows(2)
            .map(|cell| if cell[0] < cell[1] { [cell[0], cell[1]] } else { [cell[1], cell[0]] })
    }

    /// Gaps of the half cells beyond the first and the last spring, level with these springs.
    fn half_cells(&self) -> impl Iterator<Item = f64> {
        let ends =
            if self.edges == Edges::SubCell { [self.gaps.first(), self.gaps.last()] } else { [None, None] };
        ends.into_iter().flatten().copied()
    }

    /// Adds the half cells at an indentation, m.
    fn add_half_cells(&self, partial: &mut EdgeSum, indentation: f64) {
        for gap in self.half_cells().filter(|&gap| gap <= indentation) {
            partial.add(EdgeCells { length: 0.5, compression: 0.5 * (indentation - gap) });
        }
    }

    /// Contact state of the full springs or cells and of the partly filled cells.
    fn state(&self, indentation: f64, full: ContactTotals, partial: EdgeSum) -> ContactState {
        let (rule, cells) = (HessRule::NO_ADHESION, partial.total());
        match self.edges {
            Edges::Grid => GridEdges::new(rule).state(indentation, full, cells, &self.scale),
            Edges::SubCell => {
                let state = SubCellEdges::new(rule).state(indentation, full, cells, &self.scale);
                ContactState { length: state.length.min(self.gaps.len() as f64), ..state }
            }
        }
    }

    /// Calls `see` with each spring: its contribution to the contact, its gap and that of the spring before it.
    ///
    /// A spring adds a fragment, less one for each neighbour that touches earlier; among equals the left one counts as
    /// the later. With edges between springs it adds the cells to these neighbours.
    #[inline]
    fn each_spring(&self, mut see: impl FnMut(ContactTotals, f64, f64)) {
        let sub_cell = self.edges == Edges::SubCell;
        let mut before = f64::INFINITY;
        for (index, &gap) in self.gaps.iter().enumerate() {
            let after = self.gaps.get(index + 1).copied().unwrap_or(f64::INFINITY);
            let (left, right) = (before < gap, after <= gap);
            let cell = |closes, neighbour| if closes { self.scale.mean_quanta(gap, neighbour) } else { 0 };
            let quanta =
                if sub_cell { cell(left, before) + cell(right, after) } else { self.scale.quanta(gap) };
            let fragments = 1 - i64::from(left) - i64::from(right);
            see(ContactTotals { springs: 1, fragments, quanta: i128::from(quanta) }, gap, before);
            before = gap;
        }
    }

    /// The contact along a grid, by one pass along the line.
    pub fn sample(&self, grid: Grid) -> Result<Sampled, ContactError> {
        let points = grid.points();
        let count = points.len();
        // Points requested one by one have the same contact as each of them alone.
        let few = if grid.is_even() { FEW_POINTS } else { count };
        let mut changes = Changes {
            few,
            whole: resized(Vec::new(), count, ContactTotals::default())?,
            partial: resized(Vec::new(), count, EdgeSum::default())?,
            quadratic: resized(Vec::new(), count, Quadratic::default())?,
        };
        for (partial, &point) in changes.partial.iter_mut().zip(points) {
            self.add_half_cells(partial, point);
        }
        let place = |gap: f64| if gap > grid.high() { count } else { grid.first_at_least(gap) };
        let sub_cell = self.edges == Edges::SubCell;
        let mut place_before = count;
        self.each_spring(|adds, gap, before| {
            let here = place(gap);
            if here < count {
                changes.whole[here] += adds;
            }
            if sub_cell && here != place_before && before < f64::INFINITY {
                let (low, high) = if before < gap { (before, gap) } else { (gap, before) };
                changes.add_cell(low, high, here.min(place_before)..here.max(place_before), points);
            }
            place_before = here;
        });
        let (totals, states) = self.sum(points, changes);
        Ok(Sampled { grid, totals, states })
    }

    fn sum(&self, points: &[f64], changes: Changes) -> (Vec<ContactTotals>, Vec<ContactState>) {
        let (mut full, mut sum) = (ContactTotals::default(), Quadratic::default());
        let mut from = points[0];
        let changes = changes.whole.into_iter().zip(changes.partial).zip(changes.quadratic);
        let mut longest = 0.0;
        let last = points.len() - 1;
        points
            .iter()
            .zip(changes)
            .enumerate()
            .map(|(index, (&point, ((whole, mut partial), quadratic)))| {
                full += whole;
                sum.shift(point - from);
                sum.add_all(quadratic);
                from = point;
                if index > 0 && index < last {
                    partial.length.add_sum(sum.partial.length);
                    partial.compression.add_sum(sum.partial.compression);
                }
                let mut state = self.state(point, full, partial);
                // Rounding must not make the contact shrink.
                longest = state.length.max(longest);
                state.length = longest;
                (full, state)
            })
            .unzip()
    }

    /// Contact at any indentation in `low..=high` (m), from the totals at `low` and the changes in the interval.
    fn between(&self, low: f64, high: f64) -> Between<'_> {
        let mut touched = ContactTotals::default();
        let mut later = Vec::new();
        self.each_spring(|adds, gap, _| {
            if gap <= low {
                touched += adds;
            } else if gap <= high {
                later.push((gap, adds));
            }
        });
        let mut full = Interval::new(GridEdges::new(HessRule::NO_ADHESION), self.scale, low, touched);
        later.into_iter().for_each(|(gap, adds)| full.add(gap, adds));
        full.sort();
        let mut cells = Vec::new();
        if self.edges == Edges::SubCell {
            cells.extend(self.cells().filter(|&[from, to]| from <= high && to > low));
        }
        Between { contact: self, full, cells }
    }

    /// The contact at the two neighbouring points of a leg between which the compression passes a value: `is_past` is
    /// true at the higher one. The lower one is `None` before the leg; no pair beyond its end.
    fn ends(leg: &Sampled, is_past: impl Fn(f64) -> bool) -> Option<(Option<&ContactState>, &ContactState)> {
        let past = leg.states.partition_point(|state| !is_past(state.compression));
        Some((past.checked_sub(1).map(|index| &leg.states[index]), leg.states.get(past)?))
    }
}

impl Between<'_> {
    fn at(&self, indentation: f64) -> ContactState {
        let mut partial = EdgeSum::default();
        self.contact.add_half_cells(&mut partial, indentation);
        let cells = self.cells.iter().filter(|&&[low, high]| low <= indentation && indentation < high);
        cells.for_each(|&[low, high]| partial.add(partly_filled(low, high, indentation)));
        self.contact.state(indentation, self.full.totals(indentation), partial)
    }

    /// Neighbouring numbers (m) in `low..=high` between which the compression passes `wanted`: `is_past` is true at the
    /// higher end only.
    ///
    /// Newton's method from above: the compression is convex and the length is its derivative, so each step descends
    /// towards the crossing and not past it, until rounding ends the steps.
    fn crossing(
        &self,
        (mut low, mut high): (f64, f64),
        wanted: f64,
        is_past: impl Fn(f64) -> bool,
    ) -> [f64; 2] {
        let past = |indentation: f64| is_past(self.at(indentation).compression);
        for _ in 0..NEWTON_STEPS {
            let state = self.at(high);
            let next = high - (state.compression - wanted) / state.length;
            if next >= high || next <= low {
                break;
            }
            if !past(next) {
                low = next;
                break;
            }
            high = next;
        }
        let mut width = high - high.next_down();
        while high - width > low && past(high - width) {
            high -= width;
            width *= 2.0;
        }
        let found = bisect(low.max(high - width), high, past);
        [found.next_down().max(low), found]
    }
}

impl Changes {
    /// Adds a cell that is partly filled at these points.
    #[inline]
    fn add_cell(&mut self, low: f64, high: f64, at: Range<usize>, points: &[f64]) {
        let last = points.len() - 1;
        let Range { start, end } = at;
        if end - start <= self.few {
            for (partial, &point) in self.partial[start..end].iter_mut().zip(&points[start..end]) {
                partial.add(partly_filled(low, high, point));
            }
            return;
        }
        // Both ends of the curve are ends of other legs as well and must have the same contact there.
        for index in [0, last].into_iter().filter(|index| (start..end).contains(index)) {
            self.partial[index].add(partly_filled(low, high, points[index]));
        }
        let (start, end) = (start.max(1), end.min(last));
        self.quadratic[start].add(low, high, points[start], 1.0);
        self.quadratic[end].add(low, high, points[end], -1.0);
    }
}

impl Nonadhesive<'_> {
    /// Smallest indentation of a sampled leg at which the compression is at least `wanted`.
    pub fn first_at_least(&self, leg: &Sampled, wanted: f64) -> Option<f64> {
        let is_past = |compression| compression >= wanted;
        let (low, high) = Self::ends(leg, is_past)?;
        let end = high.indentation;
        let Some(low) = low else { return Some(end) };
        let between = self.between(low.indentation, end);
        match self.edges {
            Edges::Grid => between.full.first_of(&[], (low, high), wanted).or(Some(end)),
            Edges::SubCell => Some(between.crossing((low.indentation, end), wanted, is_past)[1]),
        }
    }

    /// Largest indentation of a sampled leg at which the compression is at most `wanted`.
    pub fn last_at_most(&self, leg: &Sampled, wanted: f64) -> Option<f64> {
        let is_past = |compression| compression > wanted;
        let Some((low, high)) = Self::ends(leg, is_past) else {
            return leg.states.last().map(|last| last.indentation);
        };
        let low = low?;
        let start = low.indentation;
        let between = self.between(start, high.indentation);
        match self.edges {
            Edges::Grid => between.full.last_of(&[], (low, high), wanted).or(Some(start)),
            // The compression rises from there on, though perhaps by less than a number can hold.
            Edges::SubCell if low.compression == wanted => Some(start),
            Edges::SubCell => Some(between.crossing((start, high.indentation), wanted, is_past)[0]),
        }
    }
}
