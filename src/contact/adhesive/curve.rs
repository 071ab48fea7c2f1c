//! The contact along an even grid of indentations.

use super::edge_model::{EdgeCells, EdgeModel};
use super::run::{Ground, Run};
use crate::contact::contact_model::{ContactState, Sampled};
use crate::contact::grid::Grid;
use crate::contact::totals::ContactTotals;
use crate::contact::{ContactError, resized};

/// Edge cells of many fragments: length, its rounding errors, compression, and theirs.
type Sums = [f64; 4];

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
        let mut sums: Vec<Sums> = resized(Vec::new(), if E::SLIDES { count } else { 0 }, [0.0; 4])?;
        let (low, high) = (points[0], grid.high());
        for run in runs.iter().filter(|run| run.from <= high && run.to > low) {
            let (mut first, end) = (place(run.from), place(run.to));
            if first >= end {
                continue;
            }
            self.each_span(run, unloading, |span, _, to| {
                let next = place(to).min(end);
                if first < next {
                    let whole = self.totals(span);
                    totals[first] += whole;
                    totals[next] += -whole;
                    if E::SLIDES {
                        let slider = self.slider(run, span);
                        for (sums, &point) in sums[first..next].iter_mut().zip(&points[first..next]) {
                            add(sums, self.edges.edge_cells(&slider, point));
                        }
                    }
                    first = next;
                }
                next >= end
            });
        }
        totals.truncate(count);
        let mut total = ContactTotals::default();
        let mut states = resized(Vec::new(), count, ContactState::default())?;
        let scale = self.tree.scale();
        for (index, (state, &point)) in states.iter_mut().zip(points).enumerate() {
            total += totals[index];
            totals[index] = total;
            let cells =
                sums.get(index).map_or_else(EdgeCells::default, |[length, of_length, compression, rest]| {
                    EdgeCells { length: length + of_length, compression: compression + rest }
                });
            *state = self.edges.state(point, total, cells, &scale);
        }
        Ok(Sampled { grid, totals, states })
    }
}

#[inline]
fn add([length, of_length, compression, of_compression]: &mut Sums, cells: EdgeCells) {
    two_sum(length, of_length, cells.length);
    two_sum(compression, of_compression, cells.compression);
}

/// Adds a term and keeps the rounding error (Knuth).
#[inline]
fn two_sum(value: &mut f64, error: &mut f64, term: f64) {
    let sum = *value + term;
    let added = sum - *value;
    *error += (*value - (sum - added)) + (term - added);
    *value = sum;
}
