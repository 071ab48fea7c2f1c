//! The contact of a leg: along a grid of indentations, and spring by spring.

use super::edge_model::EdgeModel;
use super::levels::EdgeSum;
use super::run::{Held, Run};
use super::search::Search;
use super::span::Span;
use crate::contact::contact_state::{ContactState, Sampled};
use crate::contact::grid::Grid;
use crate::contact::totals::ContactTotals;
use crate::contact::{ContactError, resized};
use std::ops::Range;

impl<E: EdgeModel> Search<'_, E> {
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
    pub fn sample(&self, grid: Grid) -> Result<Sampled, ContactError> {
        let (ground, points) = (&self.ground, grid.points());
        let count = points.len();
        let mut totals = resized(Vec::new(), count + 1, ContactTotals::default())?;
        let mut sums = resized(Vec::new(), if E::SLIDES { count } else { 0 }, EdgeSum::default())?;
        self.each_span_on(&grid, |run, span, filled| {
            let whole = ground.totals(span);
            totals[filled.start] += whole;
            totals[filled.end] += -whole;
            if E::SLIDES {
                let slider = ground.slider(run, span);
                for (sums, &point) in sums[filled.clone()].iter_mut().zip(&points[filled]) {
                    sums.add(slider.edge_cells(point));
                }
            }
        });
        totals.truncate(count);
        let mut total = ContactTotals::default();
        let mut states = resized(Vec::new(), count, ContactState::default())?;
        let scale = ground.tree.scale();
        for (index, (state, &point)) in states.iter_mut().zip(points).enumerate() {
            total += totals[index];
            totals[index] = total;
            let edges = sums.get(index).copied().unwrap_or_default();
            *state = ContactState::new(E::SLIDES, point, total, edges.total(), &scale);
        }
        Ok(Sampled { grid, totals, states })
    }

    /// Calls `see` with each run, each span of it, and the indices of the points of a grid at which the run fills it.
    #[inline]
    fn each_span_on(&self, grid: &Grid, mut see: impl FnMut(&Run, &Span, Range<usize>)) {
        let (ground, points) = (&self.ground, grid.points());
        let (low, high) = (points[0], grid.high());
        let place = |at: f64| if at > high { points.len() } else { grid.first_at_least(at) };
        for run in self.runs.iter().filter(|run| run.from <= high && run.to > low) {
            let (mut first, end) = (place(run.from), place(run.to));
            if first >= end {
                continue;
            }
            let mut span = ground.bottom(run);
            while first < end {
                span = ground.filled(run, span, points[first]);
                let next = place(ground.filled_up_to(run, &span)).min(end);
                see(run, &span, first..next);
                first = next;
            }
        }
    }
}
