//! Whole springs, as the paper counts them: a fragment of n springs is n Δx long.

use super::dissipation::squares;
use super::edge_model::{Boundary, EdgeCells, EdgeModel};
use super::span::Span;
use crate::contact::contact_model::ContactState;
use crate::contact::totals::{ContactTotals, GapScale};
use crate::contact::{Direction, HessRule};
use crate::scene::Edges;

/// The paper's rule for edges.
#[derive(Clone, Copy, Debug)]
pub struct GridEdges {
    hess: HessRule,
}

impl GridEdges {
    /// Whole springs under the rule of Hess.
    #[must_use]
    pub fn new(hess: HessRule) -> Self {
        GridEdges { hess }
    }

    /// Whole springs, one of which can be stretched by so much alone, m.
    pub(in crate::contact) fn with_stretch(stretch: f64) -> Self {
        GridEdges { hess: HessRule::with_stretch(stretch) }
    }
}

impl EdgeModel for GridEdges {
    /// √n of n springs.
    type Length = f64;
    type Slider = ();

    const EDGES: Edges = Edges::Grid;
    const SLIDES: bool = false;

    #[inline]
    fn on(&self, direction: Direction) -> Self {
        GridEdges::new(self.hess.on(direction))
    }

    #[inline]
    fn are_pinned(&self) -> bool {
        // Between springs an edge has no place of its own to keep.
        false
    }

    fn stretch(&self) -> f64 {
        self.hess.largest_stretch(1)
    }

    #[inline]
    fn length(&self, _: &[f64], span: &Span) -> f64 {
        f64::from(span.springs() as u32).sqrt()
    }

    #[inline]
    fn least_length(&self, first: usize, last: usize) -> f64 {
        (last + 1 - first) as f64
    }

    #[inline]
    fn attaches_at(&self, _: &Span, root: f64, wall: f64) -> f64 {
        wall - self.stretch() * root
    }

    #[inline]
    fn holds_to(&self, span: &Span, root: f64) -> f64 {
        // At this indentation the spring is stretched by just Δl_max and detaches, so the smallest that still holds it
        // is the next number above; but a spring whose gap is closed stays under any rule.
        (span.gap - self.stretch() * root).next_up().min(span.gap)
    }

    #[inline]
    fn rise(&self, _: &Span, _: f64, _: f64) -> f64 {
        0.0
    }

    #[inline]
    fn release(&self, span: &Span, root: f64, _: f64) -> (f64, bool) {
        (self.holds_to(span, root), false)
    }

    #[inline]
    fn slides_on(&self, _: (&Span, f64), _: (&Span, f64)) -> bool {
        true
    }

    #[inline]
    fn slider(&self, _: &[f64], _: &Span) {}

    #[inline]
    fn pin(&self, (): (), _: f64) {}

    #[inline]
    fn edge_cells(&self, (): &(), _: f64) -> EdgeCells {
        EdgeCells::default()
    }

    #[inline]
    fn edge_stiffness(&self, (): &(), _: f64) -> f64 {
        0.0
    }

    #[inline]
    fn state(&self, indentation: f64, totals: ContactTotals, _: EdgeCells, scale: &GapScale) -> ContactState {
        ContactState {
            indentation,
            springs: totals.springs,
            fragments: totals.fragments,
            length: totals.springs as f64,
            compression: totals.compression(indentation, scale),
        }
    }

    #[inline]
    fn stiffness(&self, totals: ContactTotals) -> f64 {
        totals.springs as f64
    }

    fn indentation_of(&self, totals: ContactTotals, compression: f64, scale: &GapScale) -> Option<f64> {
        totals.indentation(compression, scale)
    }

    fn squared_stretch(&self, gaps: &[f64], (from, to): (Boundary, Boundary), at: f64) -> f64 {
        let start = match from {
            Boundary::Outer(edge) => edge.spring,
            Boundary::Part(edge) => edge.spring + 1,
        };
        let end = match to {
            Boundary::Outer(edge) => edge.spring + 1,
            Boundary::Part(edge) => edge.spring,
        };
        3.0 * squares(&gaps[start..end.max(start)], |gap| (gap - at) * (gap - at))
    }

    fn squared_stretch_sliding(&self, _: &[f64], _: (&Span, f64), _: (&Span, f64)) -> f64 {
        0.0
    }
}
