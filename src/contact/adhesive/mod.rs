//! Adhesive contact: the exact loop over turning points.
//!
//! The gaps of a line give a [`ContactTree`] of their local maxima. A loading pass closes its nodes from below, an
//! unloading pass opens them from above; both list the *runs* of the leg, fragments whose edges move without a jump.
//! Curves, extremes and energies are sums over these runs. Only the edge model defines the length of a fragment.

mod energy;
mod levels;
mod loading;
mod run;
mod tree;
mod unloading;
pub(in crate::contact) use levels::{EdgeCells, EdgeSum, Levels, Slider};
pub(in crate::contact) use loading::Closing;
pub(in crate::contact) use run::{Ground, Held, Run, Span};
pub use tree::ContactTree;
pub(in crate::contact) use tree::largest;

use crate::contact::ContactError;
use crate::contact::contact_state::{ContactState, Tally};
use crate::contact::grid::Grid;
use crate::contact::interval::{Intervals, Piece};

/// The runs of a leg.
pub struct Runs<'a, const SLIDES: bool> {
    pub ground: Ground<'a, SLIDES>,
    pub runs: &'a [Run],
}

impl<const SLIDES: bool> Runs<'_, SLIDES> {
    /// Patches in contact at an indentation (m), from left to right, with their pinned edges where the next leg `pins`
    /// them.
    pub fn held_at(&self, indentation: f64, pins: bool) -> impl Iterator<Item = Held> {
        let ground = &self.ground;
        self.runs.iter().rev().filter(move |run| run.is_at(indentation)).map(move |run| {
            let span = ground.span_at(run, indentation);
            let [first, last] = span.ends();
            let pin = pins.then(|| ground.rise(&span, run.pin(), indentation));
            Held { branch: run.branch, first, last, pin }
        })
    }

    /// The smallest indentation at which each spring is in contact, m, along the line: −∞ always, +∞ never.
    pub fn thresholds(&self) -> Vec<f64> {
        let mut thresholds = vec![f64::INFINITY; self.ground.gaps.len()];
        // Larger patches come first; those inside have smaller thresholds.
        for run in self.runs {
            let bottom = self.ground.bottom(run);
            thresholds[bottom.first..=bottom.last].fill(run.from);
            let mut below = bottom;
            self.ground.each_span(run, f64::NEG_INFINITY, |span, from, _| {
                thresholds[span.first..below.first].fill(from);
                thresholds[below.last + 1..=span.last].fill(from);
                below = *span;
                false
            });
        }
        thresholds
    }

    /// Contact along a grid.
    ///
    /// # Errors
    /// [`ContactError::OutOfMemory`].
    pub fn sample(&self, grid: Grid) -> Result<Vec<ContactState>, ContactError> {
        let (ground, low, high) = (&self.ground, grid.points()[0], grid.high());
        let mut tally = Tally::new(grid, SLIDES)?;
        for run in self.runs.iter().filter(|run| run.from <= high && run.to > low) {
            let (mut first, end) = (tally.place(run.from), tally.place(run.to));
            if first >= end {
                continue;
            }
            let mut span = ground.bottom(run);
            while first < end {
                span = ground.filled(run, span, tally.grid.points()[first]);
                let next = tally.place(ground.filled_up_to(run, &span)).min(end);
                tally.add(first..next, ground.totals(&span));
                if SLIDES {
                    tally.slide(first..next, &ground.slider(run, &span));
                }
                first = next;
            }
        }
        tally.finish(&ground.tree.scale())
    }

    /// Adds the events and the sliding edges of a leg to the intervals of a search.
    pub fn search(&self, intervals: &mut Intervals) {
        let (ground, (low, high)) = (&self.ground, intervals.ends());
        for run in self.runs {
            if !intervals.overlap(run.from, run.to) {
                continue;
            }
            ground.each_span(run, low, |span, from, to| {
                if low < to && from <= high {
                    intervals.add_events(from, to, ground.totals(span));
                    if SLIDES {
                        intervals.add_piece(Piece { slider: ground.slider(run, span), from, to });
                    }
                }
                from > high
            });
        }
    }
}
