//! Springs that touch independently of each other. They describe two contacts: the contact without
//! adhesion, in which a spring is in contact exactly while its gap is closed, and the contact of
//! the stepwise solver.
//!
//! Without adhesion the contact depends on the indentation alone, and the force never falls while
//! the indentation grows. A *cell* is the part of the profile between two neighbouring springs.
//! While the indentation grows from the smaller gap of these springs to the larger one, the cell
//! comes into contact from one side to the other. Cells in full contact are summed exactly, as
//! integers. A cell in partial contact adds its part at each point of the curve, which is accurate
//! for any slope of the cell and any indentation.

use super::adhesive::levels::{Edges, Slider, larger, smaller};
use super::contact::Contact;
use super::contact_state::{ContactState, Grid, Tally};
use super::detachment::{ContactRule, Rules};
use super::error::ContactError;
use super::history::Direction;
use super::interval::{Intervals, Piece};
use super::totals::{ContactTotals, GapScale};
use std::ops::Range;

/// The springs of a contact in which each spring attaches on its own. The threshold of a spring is
/// the smallest indentation at which the spring is in contact.
#[derive(Clone, Copy, Debug)]
pub struct Thresholds<'a> {
    gaps: &'a [f64],
    /// Smallest indentation in m at which each spring is in contact: −∞ if it is always in contact,
    /// +∞ if never. With edges between springs, the thresholds are the gaps. Empty for a body that
    /// touches nothing.
    thresholds: &'a [f64],
    slides: bool,
    scale: GapScale,
}

impl<'a> Thresholds<'a> {
    pub fn new(contact: &'a Contact, thresholds: &'a [f64]) -> Self {
        let slides = contact.edges == Edges::SubCell;
        Thresholds {
            gaps: contact.gaps(),
            thresholds,
            slides,
            scale: contact.profile.springs.scale(),
        }
    }

    /// Computes the contact at each point of a grid of indentations.
    ///
    /// # Errors
    /// Returns [`ContactError::OutOfMemory`] if an array does not fit into memory.
    pub fn sample(&self, grid: Grid) -> Result<Vec<ContactState>, ContactError> {
        let mut tally = Tally::new(grid, self.slides)?;
        let never = tally.grid.points.len();
        let mut first = 0;
        let mut place_before = never;
        // Neighbouring springs that touch between the same two points of the grid are summed
        // together.
        while let Some(&threshold) = self.thresholds.get(first) {
            let place = tally.place(threshold);
            let (below, at_most) = tally.ends_before(place);
            let mut end = first + 1;
            while end < self.thresholds.len()
                && below < self.thresholds[end]
                && self.thresholds[end] <= at_most
            {
                end += 1;
            }
            if place < never {
                tally.begin(place, self.totals(first..end));
            }
            if self.slides && first > 0 {
                let cell = Slider::of_cell(self.thresholds[first - 1], threshold, no_stretch());
                let filling = place.min(place_before)..place.max(place_before);
                tally.slide(filling, &cell);
            }
            first = end;
            place_before = place;
        }
        for end in self.half_cells() {
            let place = tally.place(end.from);
            tally.slide(place..never, &end.slider);
        }
        tally.finish(&self.scale)
    }

    /// Adds the springs that attach, and the cells in partial contact, to `intervals`. The
    /// intervals are the parts of a motion in which a crossing of the force is searched.
    pub fn search(&self, intervals: &mut Intervals<ContactRule>) {
        let (low, high) = intervals.ends();
        for (spring, &threshold) in self.thresholds.iter().enumerate() {
            if low < threshold && threshold <= high {
                intervals.add_events(threshold, f64::INFINITY, self.totals(spring..spring + 1));
            }
        }
        if !self.slides {
            return;
        }
        for cell in self.thresholds.windows(2) {
            let from = smaller(cell[1], cell[0]);
            let to = larger(cell[0], cell[1]);
            if from < to && from <= high && to > low {
                intervals.add_piece(Piece {
                    slider: Slider::of_cell(from, to, no_stretch()),
                    from,
                    to,
                });
            }
        }
        for half_cell in self.half_cells() {
            intervals.add_piece(half_cell);
        }
    }

    /// Returns the half cells at both ends of the foundation. With whole springs there are no half
    /// cells.
    fn half_cells(&self) -> Vec<Piece<ContactRule>> {
        let mut half_cells = Vec::new();
        if self.slides {
            let ends = [self.thresholds.first(), self.thresholds.last()];
            for &gap in ends.into_iter().flatten() {
                half_cells.push(Piece {
                    slider: Slider::half_cell(gap, no_stretch()),
                    from: gap,
                    to: f64::INFINITY,
                });
            }
        }
        half_cells
    }

    /// Returns the change of the totals when all springs of a range of neighbouring springs attach.
    ///
    /// The number of patches grows by one, minus one for each neighbour of the range that is
    /// already in contact. If two neighbours have equal thresholds, the left spring counts as
    /// attached later. If edges lie between springs, the totals also grow by the cells between the
    /// range and these neighbours.
    #[inline]
    fn totals(&self, springs: Range<usize>) -> ContactTotals {
        let Range { start, end } = springs;
        let left = start > 0 && self.thresholds[start - 1] < self.thresholds[start];
        let right = self
            .thresholds
            .get(end)
            .is_some_and(|&after| after <= self.thresholds[end - 1]);
        let gaps = if self.slides {
            &self.gaps[start - usize::from(left)..end + usize::from(right)]
        } else {
            &self.gaps[start..end]
        };
        ContactTotals {
            springs: (end - start) as i64,
            patches: 1 - i64::from(left) - i64::from(right),
            ..ContactTotals::of_patch(gaps, self.slides, self.scale)
        }
    }
}

/// Returns the rule for a cell without adhesion, which allows no stretch.
fn no_stretch() -> ContactRule {
    Rules::<ContactRule>::NO_ADHESION.rule(Direction::Loading)
}
