//! Springs that touch one by one. They describe contact without adhesion, where a spring is in
//! contact exactly while its gap is closed, and the contact of the stepwise solver.
//!
//! Without adhesion the contact depends on the indentation alone, and the force does not decrease
//! with the indentation. A *cell*, the profile between two neighbouring springs, fills from its
//! smaller gap to its larger one. Full cells are summed exactly, as whole numbers of quanta. A
//! partly filled cell adds its part at each point inside it, which is accurate for any slope and
//! indentation.

use super::adhesive::levels::Edges;
use super::adhesive::levels::Slider;
use super::contact::Contact;
use super::contact_state::{ContactState, Grid, Tally};
use super::error::ContactError;
use super::interval::{Intervals, Piece};
use super::totals::{ContactTotals, GapScale};
use std::ops::Range;

/// Springs, each of which is in contact from its own indentation on.
#[derive(Clone, Copy, Debug)]
pub struct Thresholds<'a> {
    gaps: &'a [f64],
    /// Indentation in m from which each spring is in contact: −∞ always, +∞ never; the gaps where
    /// edges lie between springs. Empty for a body that touches nothing.
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

    pub fn sample(&self, grid: Grid) -> Result<Vec<ContactState>, ContactError> {
        let mut tally = Tally::new(grid, self.slides)?;
        let never = tally.grid.points.len();
        let (mut first, mut place_before) = (0, never);
        // Neighbouring springs that touch between the same two points are summed together.
        while let Some(&threshold) = self.thresholds.get(first) {
            let place = tally.place(threshold);
            let (below, at_most) = tally.ends_before(place);
            let together = |other: &&f64| below < **other && **other <= at_most;
            let end = first
                + 1
                + self.thresholds[first + 1..]
                    .iter()
                    .take_while(together)
                    .count();
            if place < never {
                tally.begin(place, self.totals(first..end));
            }
            if self.slides && first > 0 {
                let cell = Slider::of_cell(self.thresholds[first - 1], threshold);
                tally.slide(place.min(place_before)..place.max(place_before), &cell);
            }
            (first, place_before) = (end, place);
        }
        for (end, half_cell) in self.ends() {
            tally.slide(tally.place(end)..never, &half_cell);
        }
        tally.finish(&self.scale)
    }

    /// Adds the events and the partly filled cells to the intervals in which a crossing is
    /// searched.
    pub fn search(&self, intervals: &mut Intervals) {
        let (low, high) = intervals.ends();
        for (spring, &threshold) in self.thresholds.iter().enumerate() {
            if low < threshold && threshold <= high {
                intervals.add_events(threshold, f64::INFINITY, self.totals(spring..spring + 1));
            }
        }
        for cell in self.thresholds.windows(2).filter(|_| self.slides) {
            let (from, to) = if cell[0] < cell[1] {
                (cell[0], cell[1])
            } else {
                (cell[1], cell[0])
            };
            if from < to && from <= high && to > low {
                intervals.add_piece(Piece {
                    slider: Slider::of_cell(from, to),
                    from,
                    to,
                });
            }
        }
        for (from, slider) in self.ends() {
            intervals.add_piece(Piece {
                slider,
                from,
                to: f64::INFINITY,
            });
        }
    }

    /// Returns the half cells at both ends of the foundation, each with the gap of its spring in m;
    /// none for whole springs.
    fn ends(&self) -> impl Iterator<Item = (f64, Slider)> {
        let ends = [self.thresholds.first(), self.thresholds.last()]
            .into_iter()
            .flatten();
        ends.filter(|_| self.slides)
            .map(|&gap| (gap, Slider::half_cell(gap)))
    }

    /// Returns what a range of neighbouring springs adds to the totals once all of them are in
    /// contact.
    ///
    /// They add one patch, minus one for each neighbour that touches earlier. Of equal thresholds
    /// the left spring counts as the later. Where edges lie between springs, the range also adds
    /// the cells to these neighbours.
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
        let fragments = 1 - i64::from(left) - i64::from(right);
        let springs = (end - start) as i64;
        ContactTotals {
            springs,
            fragments,
            ..ContactTotals::of_patch(gaps, self.slides, self.scale)
        }
    }
}
