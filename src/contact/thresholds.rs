//! Springs that touch one by one: contact without adhesion, where a spring carries exactly while its gap is closed, and
//! that of the stepwise solver.
//!
//! Without adhesion the contact depends on the indentation alone and has no memory; the force does not decrease as the
//! indentation grows. A *cell*, the line between two neighbouring springs, then fills from its smaller gap to its larger
//! one. Full cells are summed exactly, as whole numbers of quanta; a partly filled cell adds its part at each point
//! inside it, which keeps every digit for any slope and any indentation.

use super::adhesive::Slider;
use super::contact_state::{Sampled, Tally};
use super::grid::Grid;
use super::interval::{Intervals, Piece};
use super::totals::{ContactTotals, GapScale, sums_of_few};
use super::{Contact, ContactError, Edges};

/// Springs in contact each from an indentation of its own on.
#[derive(Clone, Copy, Debug)]
pub struct Thresholds<'a> {
    gaps: &'a [f64],
    /// Indentations, m: −∞ always, +∞ never. With edges between springs they are the gaps. Empty for a body that touches
    /// nothing.
    thresholds: &'a [f64],
    slides: bool,
    scale: GapScale,
}

impl<'a> Thresholds<'a> {
    /// Creates the contact of these springs, whose thresholds are in m.
    pub fn new(contact: &'a Contact, thresholds: &'a [f64]) -> Self {
        let slides = contact.edges == Edges::SubCell;
        Thresholds { gaps: contact.gaps(), thresholds, slides, scale: contact.springs.scale() }
    }

    /// Contact along a grid.
    pub fn sample(&self, grid: Grid) -> Result<Sampled, ContactError> {
        let mut tally = Tally::new(grid, self.slides)?;
        let never = tally.grid.points().len();
        let mut place_before = never;
        self.each_spring(|totals, threshold, before| {
            let place = tally.place(threshold);
            tally.add(place..never, totals);
            if self.slides && place != place_before && before < f64::INFINITY {
                let cell = Slider::of_cell(before, threshold);
                tally.slide(place.min(place_before)..place.max(place_before), &cell);
            }
            place_before = place;
        });
        for (end, half_cell) in self.ends() {
            tally.slide(tally.place(end)..never, &half_cell);
        }
        tally.finish(&self.scale)
    }

    /// Adds the events and the partly filled cells to the intervals of a search.
    pub fn search(&self, intervals: &mut Intervals<'_>) {
        self.each_spring(|totals, threshold, before| {
            intervals.add_events(threshold, f64::INFINITY, totals);
            let (from, to) = if before < threshold { (before, threshold) } else { (threshold, before) };
            if self.slides && to < f64::INFINITY && from < to && intervals.overlap(from, to) {
                intervals.add_piece(Piece { slider: Slider::of_cell(from, to), from, to });
            }
        });
        for (from, slider) in self.ends() {
            intervals.add_piece(Piece { slider, from, to: f64::INFINITY });
        }
    }

    /// The half cells beyond the first and the last spring, as level as these springs, and their gaps, m.
    fn ends(&self) -> impl Iterator<Item = (f64, Slider)> {
        let ends = [self.thresholds.first(), self.thresholds.last()].into_iter().flatten();
        ends.filter(|_| self.slides).map(|&gap| (gap, Slider::half_cell(gap)))
    }

    /// Calls `see` with each spring: its contribution to the contact, its threshold and that of the spring before it.
    ///
    /// A spring adds a fragment, less one for each neighbour that touches earlier; among equals the left one counts as
    /// the later. With edges between springs it adds the cells to these neighbours.
    #[inline]
    fn each_spring(&self, mut see: impl FnMut(ContactTotals, f64, f64)) {
        let mut before = f64::INFINITY;
        for (index, &threshold) in self.thresholds.iter().enumerate() {
            let after = self.thresholds.get(index + 1).copied().unwrap_or(f64::INFINITY);
            let (left, right) = (before < threshold, after <= threshold);
            let ends = if self.slides { [left, right].map(usize::from) } else { [0, 0] };
            let springs = &self.gaps[index - ends[0]..=index + ends[1]];
            let [quanta, squares] = sums_of_few(springs, self.slides, self.scale);
            let fragments = 1 - i64::from(left) - i64::from(right);
            see(ContactTotals { springs: 1, fragments, quanta, squares }, threshold, before);
            before = threshold;
        }
    }
}
