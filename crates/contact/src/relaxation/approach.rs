//! The approach. Free springs have no memory, so that a relaxing contact attaches springs exactly
//! as an elastic contact does: the contact is that of the elastic loading at the largest
//! indentation so far.

use crate::contact::Contact;
use crate::contact_state::{ContactState, Grid};
use crate::error::ContactError;
use crate::relaxation::state::Load;
use crate::stage::Stage;
use crate::totals::GapScale;

/// Number of intervals of the table.
const INTERVALS: usize = 512;
/// Largest difference between the growth of the compression in an interval of the table and its
/// mean growth in the two neighbouring intervals, as a share of the largest compression. With a
/// larger difference the compression jumps in the interval, which is then not interpolated.
const JUMP: f64 = 1e-5;

/// Elastic loading from separation, with the modulus before any relaxation. Until the body turns, a
/// relaxing contact has the same springs in contact as this loading.
pub struct Approach {
    pub stage: Stage,
    /// Contacts at evenly spaced indentations from zero on.
    table: Vec<ContactState>,
    /// Largest indentation of the table in m.
    high: f64,
    /// Largest magnitude of the compression in the table in m.
    largest: f64,
}

impl Approach {
    pub fn new(contact: &Contact) -> Result<Self, ContactError> {
        Ok(Approach {
            stage: Stage::approach(contact)?,
            table: Vec::new(),
            high: 0.0,
            largest: 0.0,
        })
    }

    /// Computes the contacts at indentations from 0 to `indentation` in m, unless they are known
    /// already.
    ///
    /// # Errors
    /// Returns [`ContactError::OutOfMemory`] if an array does not fit into memory.
    pub fn prepare(&mut self, indentation: f64) -> Result<(), ContactError> {
        if indentation <= self.high {
            return Ok(());
        }
        self.table = self.stage.sample(Grid::new(0.0, indentation, INTERVALS))?;
        self.high = indentation;
        self.largest = 0.0;
        for state in &self.table {
            self.largest = self.largest.max(state.compression.abs());
        }
        Ok(())
    }

    /// Returns by how much, at most, the compression of the elastic loading deviates from a
    /// straight line between two indentations. The indentations and the result are in m.
    pub fn bend(&self, from: f64, to: f64) -> f64 {
        let first = self.table.partition_point(|state| state.indentation < from);
        let after = self.table.partition_point(|state| state.indentation <= to);
        if first + 2 >= after {
            return 0.0;
        }
        let low = self.table[first];
        let high = self.table[after - 1];
        let slope = (high.compression - low.compression) / (high.indentation - low.indentation);
        let mut largest: f64 = 0.0;
        for state in &self.table[first..after] {
            let way = state.indentation - low.indentation;
            let straight = low.compression + slope * way;
            largest = largest.max((state.compression - straight).abs());
        }
        largest
    }

    /// Returns the sums over the springs of the elastic loading at an indentation in m, in which
    /// nothing has relaxed yet.
    ///
    /// # Errors
    /// Returns [`ContactError::OutOfMemory`] if an array does not fit into memory.
    pub fn load(&self, indentation: f64) -> Result<Load, ContactError> {
        let intervals = self.table.len().saturating_sub(1) as f64;
        let place = indentation / self.high * intervals;
        let is_inside = place > 1.0 && place < intervals - 2.0;
        if !is_inside {
            return self.exact_load(indentation);
        }
        let below = place as usize;
        let growth =
            |index: usize| self.table[index + 1].compression - self.table[index].compression;
        let expected = 0.5 * (growth(below - 1) + growth(below + 1));
        if (growth(below) - expected).abs() > JUMP * self.largest {
            return self.exact_load(indentation);
        }
        let low = &self.table[below];
        let high = &self.table[below + 1];
        let share = (indentation - low.indentation) / (high.indentation - low.indentation);
        let between = |low: f64, high: f64| low + share * (high - low);
        let nearest = if share < 0.5 { low } else { high };
        let scale = self.scale();
        Ok(Load::of_approach(
            &nearest.totals,
            between(low.length, high.length),
            between(low.compression, high.compression),
            between(low.squares(&scale), high.squares(&scale)),
        ))
    }

    /// Does the same as [`Approach::load`] without interpolation.
    fn exact_load(&self, indentation: f64) -> Result<Load, ContactError> {
        let state = self.stage.state(indentation)?;
        let squares = state.squares(&self.scale());
        Ok(Load::of_approach(
            &state.totals,
            state.length,
            state.compression,
            squares,
        ))
    }

    fn scale(&self) -> GapScale {
        self.stage.contact().profile.springs.scale()
    }
}
