//! A contact that stays the same over a range of indentations: its force and the crossings of a value.

use super::adhesive::{EdgeSum, Slider};
use super::contact_state::ContactState;
use super::crossing::{bisect, crossing, last_before};
use super::totals::{ContactTotals, GapScale};

/// Whole springs or cells and the edge cells of some fragments, none of which jumps, merges or parts.
///
/// The force is convex in the indentation.
pub struct SteadyContact {
    pub slides: bool,
    pub scale: GapScale,
    pub totals: ContactTotals,
    pub sliders: Vec<Slider>,
}

impl SteadyContact {
    /// The contact at an indentation, m.
    pub fn state(&self, indentation: f64) -> ContactState {
        state(self.slides, &self.scale, self.totals, self.sliders.iter().copied(), indentation)
    }

    /// Compression ∫ (d − c) dx at an indentation, in cells times metres.
    pub fn compression(&self, indentation: f64) -> f64 {
        self.state(indentation).compression
    }

    /// Growth of the compression with the indentation, in cells.
    fn stiffness(&self, indentation: f64) -> f64 {
        let of_edges = self.sliders.iter().map(|slider| slider.stiffness(indentation));
        self.totals.whole(self.slides) as f64 + of_edges.sum::<f64>()
    }

    /// Indentation of a compression where the force is a straight line.
    pub fn straight(&self, compression: f64) -> Option<f64> {
        if self.slides { None } else { self.totals.indentation(compression, &self.scale) }
    }

    /// Indentation of the smallest force between two others, m.
    pub fn flattest(&self, low: f64, high: f64) -> f64 {
        if self.stiffness(low) >= 0.0 {
            return low;
        }
        if self.stiffness(high) <= 0.0 {
            return high;
        }
        bisect(low, high, |at| self.stiffness(at) >= 0.0)
    }

    /// The smallest indentation between two, the higher one included, at which the compression is at least `wanted`; at
    /// the lower one it is smaller.
    pub fn rises_to(&self, (from, to): (f64, f64), wanted: f64) -> Option<f64> {
        if let Some(straight) = self.straight(wanted) {
            return Some(straight.max(from)).filter(|&found| found < to);
        }
        // Convex and below `wanted` at first: one crossing.
        let reaches = self.compression(to) >= wanted;
        reaches.then(|| crossing(from, to, |at| self.compression(at) - wanted))
    }

    /// The largest indentation between two, both included, at which the compression is at most `wanted`, or the
    /// smallest compression there.
    pub fn falls_to(&self, (from, last): (f64, f64), wanted: f64) -> Result<f64, f64> {
        let flattest = self.flattest(from, last);
        let smallest = self.compression(flattest);
        if smallest > wanted {
            return Err(smallest);
        }
        if let Some(straight) = self.straight(wanted) {
            return Ok(straight.clamp(from, last));
        }
        // The compression rises from there on: the last number at which it has not passed `wanted`.
        let passes = |at: f64| self.compression(at) - wanted;
        Ok(if passes(last) > 0.0 { last_before(flattest, last, passes) } else { last })
    }
}

/// The contact of whole springs or cells and of these edge cells at an indentation, m.
pub fn state(
    slides: bool,
    scale: &GapScale,
    totals: ContactTotals,
    sliders: impl Iterator<Item = Slider>,
    indentation: f64,
) -> ContactState {
    let mut cells = EdgeSum::default();
    if slides {
        sliders.for_each(|slider| cells.add(slider.edge_cells(indentation)));
    }
    ContactState::new(slides, indentation, totals, cells.total(), scale)
}
