//! Edge model of a contact fragment: its length, its next attachment and detachment, the force of its edge cells.

use super::span::Span;
use crate::contact::Direction;
use crate::contact::contact_model::ContactState;
use crate::contact::totals::{ContactTotals, GapScale};
use crate::scene::Edges;

/// Length of a fragment, on which alone the rule of Hess depends, and the force of its edge cells.
///
/// A fragment grows from span to span. On each it has levels from its own largest gap up to that of its wall, and on
/// each level a length.
pub trait EdgeModel: Copy + Send + Sync {
    /// Length of a span at each of its levels.
    type Length: Copy;
    /// The edge cells of a span as they slide with the indentation.
    type Slider: Copy + Send;

    /// Name of this model in a scene; selects the sums of the contact tree.
    const EDGES: Edges;
    /// True for edges that slide between springs: the force is then curved between two events.
    const SLIDES: bool;

    /// The same edges under the rule of one direction alone. All other functions belong to this direction.
    fn on(&self, direction: Direction) -> Self;

    /// Returns true for edges that keep their place at first when the direction turns, since the rules of loading and
    /// of unloading differ.
    fn are_pinned(&self) -> bool;

    /// Largest stretch s of a fragment of unit length, m: Δl_max = s √ℓ, eq. (10).
    fn stretch(&self) -> f64;

    /// Length of a span, in cells.
    fn length(&self, gaps: &[f64], span: &Span) -> Self::Length;

    /// Smallest length that a span has at its highest level, in cells, at least 1.
    fn least_length(&self, first: usize, last: usize) -> f64;

    /// Smallest indentation at which the span attaches its wall of this gap, m.
    fn attaches_at(&self, span: &Span, length: Self::Length, wall: f64) -> f64;

    /// Smallest indentation at which the span holds its most stretched spring, m; at most its gap.
    fn holds_to(&self, span: &Span, length: Self::Length) -> f64;

    /// Height of the level of the edges at an indentation above the largest gap of the span, m.
    fn rise(&self, span: &Span, length: Self::Length, indentation: f64) -> f64;

    /// Level of the edges at an indentation, m.
    #[inline]
    fn level(&self, span: &Span, length: Self::Length, indentation: f64) -> f64 {
        span.gap + self.rise(span, length, indentation)
    }

    /// Indentation at which edges pinned at this rise (m) begin to move, and true if they then slide instead of
    /// running away.
    fn release(&self, span: &Span, length: Self::Length, rise: f64) -> (f64, bool);

    /// Returns true if the edges pass from a span to the next larger one without a jump.
    fn slides_on(&self, lower: (&Span, Self::Length), upper: (&Span, Self::Length)) -> bool;

    /// The edge cells of a span.
    fn slider(&self, gaps: &[f64], span: &Span) -> Self::Slider;

    /// The same edge cells pinned at a rise, m.
    fn pin(&self, slider: Self::Slider, rise: f64) -> Self::Slider;

    /// Contribution of the edge cells at an indentation.
    fn edge_cells(&self, slider: &Self::Slider, indentation: f64) -> EdgeCells;

    /// By how much the compression that they add grows with the indentation, in cells.
    fn edge_stiffness(&self, slider: &Self::Slider, indentation: f64) -> f64;

    /// The contact of whole springs or cells and of edge cells.
    fn state(
        &self,
        indentation: f64,
        totals: ContactTotals,
        edges: EdgeCells,
        scale: &GapScale,
    ) -> ContactState;

    /// By how much the compression of these grows with the indentation, in cells.
    fn stiffness(&self, totals: ContactTotals) -> f64;

    /// Indentation at which these carry a compression, m, if nothing else does.
    fn indentation_of(&self, totals: ContactTotals, compression: f64, scale: &GapScale) -> Option<f64>;

    /// Three times ∫ (c − θ)² dx over the part of the line between two boundaries, in cells times m², where θ is
    /// the indentation `at`.
    fn squared_stretch(&self, gaps: &[f64], between: (Boundary, Boundary), at: f64) -> f64;

    /// ∫ (c − θ)² dx over the places passed while the edges slide between two spans and levels, each place
    /// at its own indentation θ, in cells times m²; nothing where springs attach one by one.
    fn squared_stretch_sliding(&self, gaps: &[f64], lower: (&Span, f64), upper: (&Span, f64)) -> f64;
}

/// Contribution of the two cells at the edges of a fragment, beside its full ones, at one indentation.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EdgeCells {
    /// Their length in contact, in cells.
    pub length: f64,
    /// The compression ∫ (d − c) dx over that, in cells times metres.
    pub compression: f64,
}

/// An edge of a fragment.
#[derive(Clone, Copy, Debug)]
pub struct Edge {
    /// Its outermost spring in contact.
    pub spring: usize,
    /// Its level, m.
    pub level: f64,
}

/// End of a stretch of the line that attaches at once.
#[derive(Clone, Copy, Debug)]
pub enum Boundary {
    /// At an edge of the fragment that forms: the stretch lies inside.
    Outer(Edge),
    /// At an edge of a fragment it is made of: the stretch lies outside.
    Part(Edge),
}
