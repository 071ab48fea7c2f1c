//! The contact along an even grid of indentations.

use super::edge_model::EdgeModel;
use super::levels::EdgeSum;
use super::run::{Ground, Run};
use crate::contact::contact_state::{ContactState, Sampled};
use crate::contact::grid::Grid;
use crate::contact::totals::ContactTotals;
use crate::contact::{ContactError, resized};

impl<E: EdgeModel> Ground<'_, E> {
    /// Samples a leg.
    ///
    /// # Errors
    /// [`ContactError::OutOfMemory`].
    pub fn sample(&self, runs: &[Run], unloading: bool, grid: Grid) -> Result<Sampled, ContactError> {
        let points = grid.points();
        let count = points.len();
        let place = |at: f64| if at > grid.high() { count } else { grid.first_at_least(at) };
        let mut totals = resized(Vec::new(), count + 1, ContactTotals::default())?;
        let mut sums = resized(Vec::new(), if E::SLIDES { count } else { 0 }, EdgeSum::default())?;
        let (low, high) = (points[0], grid.high());
        for run in runs.iter().filter(|run| run.from <= high && run.to > low) {
            let (mut first, end) = (place(run.from), place(run.to));
            if first >= end {
                continue;
            }
            let mut span = self.bottom(run);
            while first < end {
                span = self.filled(run, span, unloading, points[first]);
                let next = place(self.filled_up_to(run, &span, unloading)).min(end);
                let whole = self.totals(&span);
                totals[first] += whole;
                totals[next] += -whole;
                if E::SLIDES {
                    let slider = self.slider(run, &span);
                    for (sums, &point) in sums[first..next].iter_mut().zip(&points[first..next]) {
                        sums.add(slider.edge_cells(point));
                    }
                }
                first = next;
            }
        }
        totals.truncate(count);
        let mut total = ContactTotals::default();
        let mut states = resized(Vec::new(), count, ContactState::default())?;
        let scale = self.tree.scale();
        for (index, (state, &point)) in states.iter_mut().zip(points).enumerate() {
            total += totals[index];
            totals[index] = total;
            let edges = sums.get(index).copied().unwrap_or_default();
            *state = self.edges.state(point, total, edges.total(), &scale);
        }
        Ok(Sampled { grid, totals, states })
    }
}
