//! Sub-cell edges: the line is straight between neighbouring springs, and a fragment ends at the crossing of the line
//! with the level of the fragment. The error falls with the square of the distance between springs.

use super::edge_model::EdgeModel;
use super::levels::Levels;
use super::span::Span;
use crate::contact::{Direction, HessRule};
use crate::scene::Edges;

/// Sub-cell edges under a rule of Hess.
///
/// A fragment at level t is in equilibrium with the indentation φ(t) = t − Δl_max(ℓ(t)): it grows while φ(t) ≤ d and
/// recedes while φ(t) ≥ d. Between the gap of its largest spring and that of its wall ℓ is linear in t, so φ is convex:
/// φ falls to its lowest value and then rises, and a fragment rests only where φ rises.
#[derive(Clone, Copy, Debug)]
pub struct SubCellEdges {
    hess: HessRule,
}

impl SubCellEdges {
    /// Edges under the rule of Hess.
    #[must_use]
    pub fn new(hess: HessRule) -> Self {
        SubCellEdges { hess }
    }
}

impl EdgeModel for SubCellEdges {
    const EDGES: Edges = Edges::SubCell;
    const SLIDES: bool = true;

    #[inline]
    fn rule(&self) -> HessRule {
        self.hess
    }

    #[inline]
    fn on(&self, direction: Direction) -> Self {
        Self::new(self.hess.on(direction))
    }

    #[inline]
    fn levels(&self, gaps: &[f64], span: &Span) -> Levels {
        Levels::between_springs(gaps, span).0
    }

    #[inline]
    fn least_length(&self, first: usize, last: usize) -> f64 {
        // One of the two edge cells is full at the highest level.
        (last - first).max(1) as f64
    }

    #[inline]
    fn holds_to(&self, levels: &Levels) -> f64 {
        let (gap, stretch) = (levels.gap, self.stretch());
        // At the smallest φ √ℓ is half of stretch × growth.
        let root = 0.5 * stretch * levels.growth;
        let excess = root * root - levels.length;
        // Without branches: they would often be mispredicted.
        let rise = excess / levels.growth;
        let most = levels.top - gap;
        let rise = if rise < most { rise } else { most };
        let rise = if excess > 0.0 { rise } else { 0.0 };
        let holds = (gap + rise) - stretch * levels.length_at(rise).sqrt();
        if holds < gap { holds } else { gap }
    }

    fn squared_stretch_sliding(&self, gaps: &[f64], [lower, upper]: [(Span, f64); 2], _: bool) -> f64 {
        // Twice the stretch of an edge times the change of the length, as the stretch is s √ℓ.
        let ([cells0, share0], [cells1, share1]) = (length_at(gaps, &lower), length_at(gaps, &upper));
        // Whole cells and shares are subtracted separately: as lengths they would lose digits.
        let grown = (cells1 - cells0) + (share1 - share0);
        let both = (cells0 + cells1) + (share0 + share1);
        0.5 * self.stretch() * self.stretch() * grown * both
    }
}

/// Whole cells of a span at a level, and the shares of its edge cells.
fn length_at(gaps: &[f64], (span, level): &(Span, f64)) -> [f64; 2] {
    let share = |inside: usize, outside: Option<&f64>| {
        outside.map_or(0.5, |outside| {
            let (above, height) = (level - gaps[inside], outside - gaps[inside]);
            if above < height { above / height } else { 1.0 }
        })
    };
    let left = share(span.first, span.first.checked_sub(1).map(|before| &gaps[before]));
    [(span.last - span.first) as f64, left + share(span.last, gaps.get(span.last + 1))]
}
