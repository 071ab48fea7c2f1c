//! The force of a body under manual loading, and the indentation of a force.

use super::fragments::Fragment;
use super::{Course, Manual};
use crate::contact::adhesive::{EdgeModel, Ground, Slider};
use crate::contact::steady::SteadyContact;

impl<E: EdgeModel> Manual<E> {
    /// The present contact, constant up to the next event.
    pub(super) fn steady(&self) -> SteadyContact<E> {
        let Ground { gaps, tree, edges } = self.contact.ground();
        let fragments = self.contact.fragments().take_while(|_| E::SLIDES);
        let slider = |Fragment { span, pin, .. }| Slider::new(gaps, &span, edges.stretch(), pin);
        let sliders = fragments.map(slider).collect();
        SteadyContact { edges, scale: tree.scale(), totals: self.contact.totals(), sliders }
    }

    /// Presses until the compression ∫ (d − c) dx is at least `wanted`, and returns the indentation; `None` if no
    /// finite one exists.
    pub(super) fn press_to_compression(&mut self, course: &mut Course, wanted: f64) -> Option<f64> {
        // Nothing touches below d = 0.
        let mut from = if self.is_separated() { self.indentation.max(0.0) } else { self.indentation };
        self.proceed(course, |next| next <= from);
        loop {
            let contact = self.steady();
            if contact.compression(from) >= wanted {
                return Some(from);
            }
            let Some(to) = self.contact.next_event() else { break };
            if let Some(found) = contact.rises_to((from, to), wanted) {
                if found < to {
                    return Some(found);
                }
                self.proceed(course, |next| next <= to);
                return Some(if self.steady().compression(to) >= wanted { to } else { to.next_down() });
            }
            from = to;
            self.proceed(course, |next| next <= from);
        }
        // Everything is in contact.
        Some(self.beyond(from, wanted)).filter(|indentation| indentation.is_finite())
    }

    /// Pulls until the compression ∫ (d − c) dx is at most `wanted`, and returns the indentation, or the smallest
    /// compression of the move when everything detaches before.
    pub(super) fn pull_to_compression(&mut self, course: &mut Course, wanted: f64) -> Result<f64, f64> {
        let mut to = self.indentation;
        let mut smallest = self.steady().compression(to);
        if smallest <= wanted {
            return Ok(to);
        }
        loop {
            // Below `to` only the springs held further are in contact.
            self.proceed(course, |next| next >= to);
            let Some(from) = self.contact.next_event() else { return Err(smallest) };
            match self.steady().falls_to((from, to.next_down().max(from)), wanted) {
                Ok(found) => return Ok(found),
                Err(compression) => smallest = smallest.min(compression),
            }
            to = from;
        }
    }

    /// The indentation beyond `from`, in full contact, with this compression.
    fn beyond(&self, from: f64, wanted: f64) -> f64 {
        let contact = self.steady();
        if E::SLIDES {
            // The force rises with the whole line.
            let end = contact.state(from);
            from + (wanted - end.compression) / end.length
        } else {
            contact.straight(wanted).map_or(f64::INFINITY, |found| found.max(from))
        }
    }
}
