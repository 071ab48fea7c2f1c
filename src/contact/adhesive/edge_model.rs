//! Edge models of a contact fragment: its length, its next attachment and detachment.

use super::levels::{EdgeCell, Levels};
use super::span::Span;

/// Length of a fragment, the only input of the rule of Hess.
///
/// A fragment grows from span to span. On each it has levels from its own largest gap up to that of its wall, and on
/// each level a length ℓ. Its largest stretch is Δl_max = s √ℓ, eq. (10), with the `stretch` s of a fragment of unit
/// length, m.
pub trait EdgeModel: Copy + Send + Sync + 'static {
    /// True for edges that slide between springs: the force is then curved between two events. Others have one length
    /// at all levels of a span, and no edge cells.
    const SLIDES: bool;

    /// Levels of a span.
    fn levels(gaps: &[f64], span: &Span) -> Levels;

    /// Smallest length that a span has at its highest level, in cells, at least 1.
    fn least_length(first: usize, last: usize) -> f64;

    /// Smallest indentation at which a span holds its most stretched spring, m; at most its gap.
    fn holds_to(levels: &Levels, stretch: f64) -> f64;

    /// ∫ (c − θ)² dx over the places passed while the edges move between two spans and levels, each place at its own
    /// indentation θ, in cells times ½ s².
    fn passed_squares(gaps: &[f64], between: [(Span, f64); 2], unloading: bool) -> f64;
}

/// Whole springs, as the paper counts them: a fragment of n springs is n Δx long.
#[derive(Clone, Copy, Debug)]
pub struct GridEdges;

impl EdgeModel for GridEdges {
    const SLIDES: bool = false;

    #[inline]
    fn levels(_: &[f64], span: &Span) -> Levels {
        let length = f64::from(span.springs() as u32);
        Levels { gap: span.gap, length, growth: 0.0, top: f64::INFINITY }
    }

    #[inline]
    fn least_length(first: usize, last: usize) -> f64 {
        (last + 1 - first) as f64
    }

    #[inline]
    fn holds_to(levels: &Levels, stretch: f64) -> f64 {
        // At this indentation the spring is stretched by just Δl_max and detaches, so the smallest that still holds it
        // is the next number above; but a spring whose gap is closed stays under any rule.
        (levels.gap - stretch * levels.length.sqrt()).next_up().min(levels.gap)
    }

    fn passed_squares(_: &[f64], between: [(Span, f64); 2], unloading: bool) -> f64 {
        let [fewer, more] = between.map(|(span, _)| span.springs() as f64);
        // Springs attach one by one to patches of `fewer` springs and more, and detach from those of `more` and fewer.
        let sign = if unloading { 1.0 } else { -1.0 };
        (more - fewer) * (more + fewer + sign)
    }
}

/// Edges between springs: the line is straight between neighbouring springs, and a fragment ends at the crossing of the
/// line with the level of the fragment. The error falls with the square of the distance between springs.
///
/// A fragment at level t is in equilibrium with the indentation φ(t) = t − Δl_max(ℓ(t)): it grows while φ(t) ≤ d and
/// recedes while φ(t) ≥ d. Between the gap of its largest spring and that of its wall ℓ is linear in t, so φ is convex:
/// φ falls to its lowest value and then rises, and a fragment rests only where φ rises.
#[derive(Clone, Copy, Debug)]
pub struct SubCellEdges;

impl EdgeModel for SubCellEdges {
    const SLIDES: bool = true;

    #[inline]
    fn levels(gaps: &[f64], span: &Span) -> Levels {
        Levels::between_springs(gaps, span).0
    }

    #[inline]
    fn least_length(first: usize, last: usize) -> f64 {
        // One of the two edge cells is full at the highest level.
        (last - first).max(1) as f64
    }

    #[inline]
    fn holds_to(levels: &Levels, stretch: f64) -> f64 {
        let gap = levels.gap;
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

    fn passed_squares(gaps: &[f64], [lower, upper]: [(Span, f64); 2], _: bool) -> f64 {
        // Twice the stretch s √ℓ of an edge times the change of the length ℓ.
        let length = |(span, level): (Span, f64)| {
            let [left, right] = EdgeCell::of(gaps, &span, level);
            [(span.last - span.first) as f64, left.share + right.share]
        };
        let ([cells0, share0], [cells1, share1]) = (length(lower), length(upper));
        // Whole cells and shares are subtracted separately: as lengths they would lose digits.
        ((cells1 - cells0) + (share1 - share0)) * ((cells0 + cells1) + (share0 + share1))
    }
}
