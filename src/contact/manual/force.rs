//! The force of a body under manual loading, and the indentation of a force.

use super::{Course, Manual};
use crate::contact::adhesive::{EdgeCells, EdgeModel};
use crate::contact::contact_model::ContactState;
use crate::contact::crossing::{bisect, crossing, last_before};
use crate::contact::grid::CompensatedSum;

impl<E: EdgeModel> Manual<E> {
    /// The present contact as it carries at this indentation, m.
    pub(super) fn state_at(&self, indentation: f64) -> ContactState {
        let ground = self.contact.ground();
        let (mut length, mut compression) = (CompensatedSum::default(), CompensatedSum::default());
        if E::SLIDES {
            for fragment in self.contact.fragments() {
                let slider = ground.edges.slider(ground.gaps, &fragment.span);
                let cells = ground.edges.edge_cells(&slider, indentation);
                length.add(cells.length);
                compression.add(cells.compression);
            }
        }
        let cells = EdgeCells { length: length.total(), compression: compression.total() };
        ground.edges.state(indentation, self.contact.totals(), cells, &ground.tree.scale())
    }

    fn compression_at(&self, indentation: f64) -> f64 {
        self.state_at(indentation).compression
    }

    /// Growth of the compression with the indentation, in cells.
    fn stiffness_at(&self, indentation: f64) -> f64 {
        let ground = self.contact.ground();
        let of_edges = self.contact.fragments().map(|fragment| {
            ground.edges.edge_stiffness(&ground.edges.slider(ground.gaps, &fragment.span), indentation)
        });
        ground.edges.stiffness(self.contact.totals()) + of_edges.sum::<f64>()
    }

    /// Indentation at which the present contact of whole springs carries a compression, m.
    fn straight(&self, compression: f64) -> Option<f64> {
        let ground = self.contact.ground();
        ground.edges.indentation_of(self.contact.totals(), compression, &ground.tree.scale())
    }

    /// Presses until the compression ∫ (d − c) dx is at least `wanted`, and returns the indentation; `None` when there
    /// is no finite one.
    pub(super) fn press_to_compression(&mut self, course: &mut Course, wanted: f64) -> Option<f64> {
        // Nothing touches below d = 0.
        let mut from = if self.is_separated() { self.indentation.max(0.0) } else { self.indentation };
        self.press(course, from);
        loop {
            if self.compression_at(from) >= wanted {
                return Some(from);
            }
            let Some(to) = self.contact.attaches_next() else { break };
            if let Some(found) = self.rises_to((from, to), wanted) {
                if found < to {
                    return Some(found);
                }
                self.press(course, to);
                return Some(if self.compression_at(to) >= wanted { to } else { to.next_down() });
            }
            from = to;
            self.press(course, from);
        }
        // Everything is in contact.
        Some(self.beyond(from, wanted)).filter(|indentation| indentation.is_finite())
    }

    /// Pulls until the compression ∫ (d − c) dx is at most `wanted`, and returns the indentation, or the smallest
    /// compression of the move when everything detaches before.
    pub(super) fn pull_to_compression(&mut self, course: &mut Course, wanted: f64) -> Result<f64, f64> {
        let mut to = self.indentation;
        let mut smallest = self.compression_at(to);
        if smallest <= wanted {
            return Ok(to);
        }
        loop {
            // Below `to` only the springs held further are in contact.
            self.pull(course, |holds| holds >= to);
            let Some(from) = self.contact.detaches_next() else { return Err(smallest) };
            match self.falls_to((from, to.next_down().max(from)), wanted) {
                Ok(found) => return Ok(found),
                Err(compression) => smallest = smallest.min(compression),
            }
            to = from;
        }
    }

    /// The smallest indentation between two, neither of them passed by an event, at which the compression is at least
    /// `wanted`; at the lower one it is less.
    fn rises_to(&self, (from, to): (f64, f64), wanted: f64) -> Option<f64> {
        if !E::SLIDES {
            return self.straight(wanted).filter(|&found| found < to).map(|found| found.max(from));
        }
        // The force is convex and below it at first: it gets there once.
        let reaches = self.compression_at(to) >= wanted;
        reaches.then(|| crossing(from, to, |at| self.compression_at(at) - wanted))
    }

    /// The largest indentation between two, from which nothing detaches above the lower one, at which the compression
    /// is at most `wanted`, or the smallest compression there; at the higher one it is more.
    fn falls_to(&self, (from, last): (f64, f64), wanted: f64) -> Result<f64, f64> {
        let flat = if !E::SLIDES || self.stiffness_at(from) >= 0.0 {
            from
        } else if self.stiffness_at(last) <= 0.0 {
            last
        } else {
            bisect(from, last, |at| self.stiffness_at(at) >= 0.0)
        };
        let compression = self.compression_at(flat);
        if compression > wanted {
            return Err(compression);
        }
        if !E::SLIDES {
            return Ok(self.straight(wanted).unwrap_or(last).clamp(from, last));
        }
        let passes = |at: f64| self.compression_at(at) - wanted;
        Ok(if passes(last) > 0.0 { last_before(flat, last, passes) } else { last })
    }

    /// The indentation beyond `from`, where everything is in contact, with this compression.
    fn beyond(&self, from: f64, wanted: f64) -> f64 {
        if E::SLIDES {
            // The force rises with the whole line.
            let end = self.state_at(from);
            from + (wanted - end.compression) / end.length
        } else {
            self.straight(wanted).map_or(f64::INFINITY, |found| found.max(from))
        }
    }
}
