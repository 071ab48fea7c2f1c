//! Results of a loop as a list of numbers, in the same order for every engine.

use asperity::contact::{CurvePoint, LegRecord, Solver};
use asperity::scene::Leg;
use crc32fast::Hasher;

/// A recorded quantity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Quantity {
    /// Indentation, force and contact length of the points of curves.
    Point,
    /// Springs and patches at points.
    Count,
    /// Indentation, force and contact length at the largest force.
    Largest,
    /// Indentation, force and contact length at the smallest force.
    Smallest,
    /// Springs attached and detached.
    Change,
    /// First and last spring of each patch after a stage.
    Patch,
    /// Refusal of a stage, with the force of its message.
    Refusal,
    /// Smallest force of the unloading from first touch.
    ZeroLoad,
    /// Dissipated energy of a stage.
    Energy,
}

use Quantity::{Change, Count, Energy, Largest, Patch, Point, Refusal, Smallest, ZeroLoad};

impl Quantity {
    pub const ALL: [Quantity; 9] =
        [Point, Count, Largest, Smallest, Change, Patch, Refusal, ZeroLoad, Energy];
}

/// Quantities and the bits of their values.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Trace(pub Vec<(Quantity, u64)>);

impl Trace {
    /// Runs all legs, also those after a refused one. `refusal` returns the number of an error and the force of its
    /// message, `changes` the springs attached and detached.
    pub fn new<S: Solver, E>(
        solver: &mut S,
        legs: &[Leg],
        advance: impl Fn(&mut S, Leg) -> Result<LegRecord, E>,
        refusal: impl Fn(&E) -> [f64; 2],
        changes: impl Fn(&LegRecord) -> [u64; 2],
    ) -> Self {
        let mut trace = Trace::default();
        for &leg in legs {
            match advance(solver, leg) {
                Err(error) => trace.numbers(Refusal, refusal(&error)),
                Ok(record) => {
                    record.curve.iter().for_each(|point| trace.point(Point, point));
                    trace.point(Largest, &record.largest);
                    trace.point(Smallest, &record.smallest);
                    trace.counts(Change, changes(&record));
                    for (first, last) in solver.fragments(record.end()) {
                        trace.counts(Patch, [first as u64, last as u64]);
                    }
                    trace.numbers(Energy, [record.released_energy]);
                }
            }
        }
        trace
    }

    /// Adds the smallest force of the unloading from first touch, N.
    pub fn zero_load(&mut self, smallest: f64) {
        self.numbers(ZeroLoad, [smallest]);
    }

    fn point(&mut self, quantity: Quantity, point: &CurvePoint) {
        self.numbers(quantity, [point.indentation, point.force, point.contact_length]);
        if quantity == Point {
            self.counts(Count, [point.springs, point.fragments]);
        }
    }

    fn numbers<const N: usize>(&mut self, quantity: Quantity, values: [f64; N]) {
        self.counts(quantity, values.map(f64::to_bits));
    }

    fn counts<const N: usize>(&mut self, quantity: Quantity, values: [u64; N]) {
        self.0.extend(values.map(|bits| (quantity, bits)));
    }

    /// Checksum of all bits but those of energies and, with whole springs, of the largest forces.
    ///
    /// Where the force of whole springs falls at once, the former engine returned the force of the contact before at
    /// the indentation of the fall; the present one returns the force at the largest number below.
    pub fn checksum(&self, sub_cell: bool) -> u32 {
        let mut hasher = Hasher::new();
        for (quantity, bits) in &self.0 {
            if *quantity != Energy && (sub_cell || *quantity != Largest) {
                hasher.update(&bytes(*quantity, *bits));
            }
        }
        hasher.finalize()
    }

    /// Sum of the absolute energies of all stages, J.
    pub fn energy(&self) -> f64 {
        let energies = self.0.iter().filter(|(quantity, _)| *quantity == Energy);
        energies.map(|(_, bits)| f64::from_bits(*bits).abs()).sum()
    }

    /// Number of values and then, value by value, quantity and bits.
    pub fn to_bytes(&self) -> Vec<u8> {
        let values = self.0.iter().flat_map(|(quantity, bits)| bytes(*quantity, *bits));
        (self.0.len() as u32).to_le_bytes().into_iter().chain(values).collect()
    }
}

/// The quantity and the bits of a value.
fn bytes(quantity: Quantity, bits: u64) -> [u8; 9] {
    let mut bytes = [quantity as u8; 9];
    bytes[1..].copy_from_slice(&bits.to_le_bytes());
    bytes
}
