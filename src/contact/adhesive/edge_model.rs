//! Edge model of a contact fragment: its length, its next attachment and detachment, the force of its edge cells.

use super::levels::{EdgeCells, Levels};
use super::span::Span;
use crate::contact::contact_state::ContactState;
use crate::contact::totals::{ContactTotals, GapScale};
use crate::contact::{Direction, HessRule};
use crate::scene::Edges;

/// Length of a fragment, the only input of the rule of Hess, and the force of its edge cells.
///
/// A fragment grows from span to span. On each it has levels from its own largest gap up to that of its wall, and on
/// each level a length.
pub trait EdgeModel: Copy + Send + Sync + 'static {
    /// Name of this model in a scene; selects the sums of the contact tree.
    const EDGES: Edges;
    /// True for edges that slide between springs: the force is then curved between two events. Others have one length
    /// at all levels of a span, and no edge cells.
    const SLIDES: bool;

    /// The rule of Hess on which the model is built.
    fn rule(&self) -> HessRule;

    /// The same edges under the rule of one direction alone. All other functions belong to this direction.
    fn on(&self, direction: Direction) -> Self;

    /// Levels of a span.
    fn levels(&self, gaps: &[f64], span: &Span) -> Levels;

    /// Smallest length that a span has at its highest level, in cells, at least 1.
    fn least_length(&self, first: usize, last: usize) -> f64;

    /// Smallest indentation at which a span holds its most stretched spring, m; at most its gap.
    fn holds_to(&self, levels: &Levels) -> f64;

    /// ∫ (c − θ)² dx over the places passed while the edges move between two spans and levels, each place at its own
    /// indentation θ, in cells times m²: at an edge the stretch is s √ℓ.
    fn squared_stretch_sliding(&self, gaps: &[f64], between: [(Span, f64); 2], unloading: bool) -> f64;

    /// Largest stretch s of a fragment of unit length, m: Δl_max = s √ℓ, eq. (10).
    #[inline]
    fn stretch(&self) -> f64 {
        self.rule().largest_stretch(1)
    }

    /// Returns true for edges that keep their place at first when the direction turns, since the rules of loading and
    /// of unloading differ. Between springs alone an edge has a place of its own to keep.
    #[inline]
    fn are_pinned(&self) -> bool {
        Self::SLIDES && !self.rule().is_one()
    }

    /// Smallest indentation at which a span attaches its wall of this gap, m.
    #[inline]
    fn attaches_at(&self, levels: &Levels, wall: f64) -> f64 {
        let length = if Self::SLIDES { levels.length_at(wall - levels.gap) } else { levels.length };
        wall - self.stretch() * length.sqrt()
    }

    /// Height of the level of the edges at an indentation above the largest gap of the span, m.
    #[inline]
    fn rise(&self, levels: &Levels, indentation: f64) -> f64 {
        if Self::SLIDES { levels.rise(self.stretch(), indentation) } else { 0.0 }
    }

    /// Level of the edges at an indentation, m.
    #[inline]
    fn level(&self, levels: &Levels, indentation: f64) -> f64 {
        levels.gap + self.rise(levels, indentation)
    }

    /// Returns true if the edges pass from a span to the next larger one without a jump.
    #[inline]
    fn slides_on(&self, lower: &Levels, upper: &Levels) -> bool {
        !Self::SLIDES || lower.slide_on(self.stretch(), upper)
    }

    /// Number of whole springs or cells that carry.
    #[inline]
    fn whole(&self, totals: ContactTotals) -> i64 {
        if Self::SLIDES { totals.cells() } else { totals.springs }
    }

    /// The contact of whole springs or cells and of edge cells.
    #[inline]
    fn state(
        &self,
        indentation: f64,
        totals: ContactTotals,
        edges: EdgeCells,
        scale: &GapScale,
    ) -> ContactState {
        let whole = self.whole(totals);
        let mut state = ContactState {
            indentation,
            springs: totals.springs,
            fragments: totals.fragments,
            length: whole as f64,
            compression: totals.compression_of(whole, indentation, scale),
        };
        if Self::SLIDES {
            state.length += edges.length;
            state.compression += edges.compression;
        }
        state
    }

    /// Indentation at which whole springs alone carry a compression, m; `None` if edge cells carry too.
    fn indentation_of(&self, totals: ContactTotals, compression: f64, scale: &GapScale) -> Option<f64> {
        if Self::SLIDES { None } else { totals.indentation(compression, scale) }
    }
}
