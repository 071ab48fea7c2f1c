//! Contact without adhesion: a spring carries exactly while its gap is closed, on any leg.
//!
//! The contact depends on the indentation alone and has no memory; the force does not decrease as the indentation grows.
//! One pass along the line yields a whole curve.
//!
//! A *cell*, the line between two neighbouring springs, fills from its smaller gap to its larger one. Full cells are
//! summed exactly, as whole numbers of quanta; a partly filled cell adds its part at each point of the curve inside it,
//! which keeps every digit for any slope and any indentation.

use super::adhesive::{EdgeCells, EdgeSum};
use super::contact_state::{ContactState, Sampled};
use super::grid::Grid;
use super::totals::{ContactTotals, FewSprings, GapScale};
use super::{ContactError, Springs, resized};
use crate::contact::Edges;

/// Intervals into which a search divides the one that encloses a force.
const DIVISIONS: usize = 256;

/// Springs of a line without adhesion.
#[derive(Clone, Copy, Debug)]
pub struct Nonadhesive<'a> {
    gaps: &'a [f64],
    edges: Edges,
    scale: GapScale,
}

impl<'a> Nonadhesive<'a> {
    /// Creates a contact of these springs.
    pub fn new(springs: &'a Springs, edges: Edges) -> Self {
        Nonadhesive { gaps: springs.gaps(), edges, scale: springs.scale() }
    }

    /// Contact along a grid.
    pub fn sample(&self, grid: Grid) -> Result<Sampled, ContactError> {
        let points = grid.points();
        let count = points.len();
        let mut totals = resized(Vec::new(), count + 1, ContactTotals::default())?;
        let mut partial = resized(Vec::new(), count, EdgeSum::default())?;
        let place = |gap: f64| if gap > grid.high() { count } else { grid.first_at_least(gap) };
        let mut place_before = count;
        self.each_spring(|adds, gap, before| {
            let here = place(gap);
            totals[here] += adds;
            if self.edges == Edges::SubCell && here != place_before && before < f64::INFINITY {
                let (low, high) = if before < gap { (before, gap) } else { (gap, before) };
                let inside = here.min(place_before)..here.max(place_before);
                for (partial, point) in partial[inside.clone()].iter_mut().zip(&points[inside]) {
                    let share = (point - low) / (high - low);
                    let compression = 0.5 * (point - low) * share;
                    let squares = compression * (point - low) * (2.0 / 3.0);
                    partial.add(EdgeCells { length: share, compression, squares });
                }
            }
            place_before = here;
        });
        totals.truncate(count);
        let mut total = ContactTotals::default();
        let mut longest = 0.0;
        let states = points.iter().zip(&mut totals).zip(partial).map(|((&point, totals), partial)| {
            total += *totals;
            *totals = total;
            let mut state = self.state(point, total, partial);
            // Rounding must not make the contact shrink.
            longest = state.length.max(longest);
            state.length = longest;
            state
        });
        let states = states.collect();
        Ok(Sampled { grid, totals, states })
    }

    /// Gaps of the half cells beyond the first and the last spring, as level as these springs.
    fn ends(&self) -> impl Iterator<Item = f64> {
        [self.gaps.first(), self.gaps.last()].into_iter().flatten().copied()
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
            let mut few = FewSprings::default();
            if !sub_cell {
                few.add_spring(gap, self.scale);
            }
            for neighbour in
                [(left, before), (right, after)].into_iter().filter(|(closes, _)| sub_cell && *closes)
            {
                few.add_cell(gap, neighbour.1, self.scale);
            }
            let [quanta, squares] = few.sums();
            let fragments = 1 - i64::from(left) - i64::from(right);
            see(ContactTotals { springs: 1, fragments, quanta, squares }, gap, before);
            before = gap;
        }
    }

    /// Contact state of the full springs or cells and of the partly filled cells.
    fn state(&self, indentation: f64, full: ContactTotals, mut partial: EdgeSum) -> ContactState {
        match self.edges {
            Edges::Grid => ContactState::new(false, indentation, full, EdgeCells::default(), &self.scale),
            Edges::SubCell => {
                for gap in self.ends().filter(|&gap| gap <= indentation) {
                    let compression = 0.5 * (indentation - gap);
                    let squares = compression * (indentation - gap);
                    partial.add(EdgeCells { length: 0.5, compression, squares });
                }
                let state = ContactState::new(true, indentation, full, partial.total(), &self.scale);
                ContactState { length: state.length.min(self.gaps.len() as f64), ..state }
            }
        }
    }

    /// Smallest indentation of a sampled leg at which the compression is at least `wanted`.
    pub fn first_at_least(&self, leg: &Sampled, wanted: f64) -> Result<Option<f64>, ContactError> {
        let at_least = |state: &ContactState| state.compression >= wanted;
        let past = |states: &[ContactState]| states.iter().position(at_least).unwrap_or(states.len());
        let found = self.enclose(leg, wanted, past)?;
        Ok(found.map(|[_, found]| found))
    }

    /// Largest indentation of a sampled leg at which the compression is at most `wanted`.
    pub fn last_at_most(&self, leg: &Sampled, wanted: f64) -> Result<Option<f64>, ContactError> {
        let at_most = |state: &ContactState| state.compression <= wanted;
        let past = |states: &[ContactState]| states.iter().rposition(at_most).map_or(0, |index| index + 1);
        Ok(match self.enclose(leg, wanted, past)? {
            Some([found, _]) => Some(found).filter(|found| found.is_finite()),
            None => leg.states.last().map(|last| last.indentation),
        })
    }

    /// Neighbouring indentations between which the compression passes a value, at the state of the index `past` and the one
    /// before. The lower one is −∞ before the leg; `None` beyond its end.
    fn enclose(
        &self,
        leg: &Sampled,
        wanted: f64,
        past: impl Fn(&[ContactState]) -> usize,
    ) -> Result<Option<[f64; 2]>, ContactError> {
        let Some(end) = leg.states.get(past(&leg.states)) else { return Ok(None) };
        let Some(before) = past(&leg.states).checked_sub(1) else {
            return Ok(Some([f64::NEG_INFINITY, end.indentation]));
        };
        let (mut low, mut high) = (leg.states[before].indentation, end.indentation);
        let mut totals = [leg.totals[before], leg.totals[before + 1]];
        while low.next_up() < high {
            if self.edges == Edges::Grid && totals[0] == totals[1] {
                // The same whole springs carry everywhere between: the force is a straight line.
                let straight = totals[0].indentation(wanted, &self.scale);
                return Ok(straight.map(|found| [found.clamp(low, high); 2]));
            }
            let even = Grid::new(low, high, DIVISIONS);
            let middle = low + 0.5 * (high - low);
            let leg = self.sample(if even.is_even() { even } else { Grid::at(vec![low, middle, high]) })?;
            let past = past(&leg.states).clamp(1, leg.states.len() - 1);
            (low, high) = (leg.states[past - 1].indentation, leg.states[past].indentation);
            totals = [leg.totals[past - 1], leg.totals[past]];
        }
        Ok(Some([low, high]))
    }
}
