//! Edge models of a contact fragment: its length, its next attachment and detachment.
//!
//! A fragment grows from span to span. On each it has levels from its own largest gap up to that of its wall, and on each
//! level a length ℓ, the only input of the rule of Hess: its largest stretch is Δl_max = s √ℓ, eq. (10), with the stretch s
//! of a fragment of unit length.
//!
//! * Whole springs, as the paper counts them: a fragment of n springs is n Δx long at all levels of its span.
//! * Edges that slide between springs: the line is straight between neighbouring springs, and a fragment ends at the crossing
//!   of the line with the level of the fragment. A fragment at level t is in equilibrium with the indentation φ(t) = t −
//!   Δl_max(ℓ(t)): it grows while φ(t) ≤ d and recedes while φ(t) ≥ d. Between the gap of its largest spring and that of its
//!   wall ℓ is linear in t, so φ is convex: φ falls to its lowest value and then rises, and a fragment rests only where φ
//!   rises.

use super::levels::{EdgeCell, Levels};
use super::run::Ground;
use super::span::Span;

impl<const SLIDES: bool> Ground<'_, SLIDES> {
    /// Levels of a span.
    #[inline]
    pub fn levels(&self, span: &Span) -> Levels {
        if SLIDES {
            return Levels::between_springs(self.gaps, span).0;
        }
        let length = f64::from(span.springs() as u32);
        Levels { gap: span.gap, length, growth: 0.0, top: f64::INFINITY }
    }

    /// Smallest length that a span has at its highest level, in cells.
    #[inline]
    pub fn least_length(&self, first: usize, last: usize) -> f64 {
        // One of two edge cells is full at the highest level.
        (last + usize::from(!SLIDES) - first).max(1) as f64
    }

    /// Smallest indentation at which a span of these levels attaches its wall of this gap, m.
    #[inline]
    pub fn attachment(&self, levels: &Levels, wall: f64) -> f64 {
        let length = if SLIDES { levels.length_at(wall - levels.gap) } else { levels.length };
        wall - self.stretch * length.sqrt()
    }

    /// Smallest indentation at which a span of these levels holds its most stretched spring, m; at most its gap.
    #[inline]
    pub fn holds_to(&self, levels: &Levels) -> f64 {
        let (gap, stretch) = (levels.gap, self.stretch);
        if !SLIDES {
            // At this indentation the spring is stretched by just Δl_max and detaches, so the smallest that still holds it
            // is the next number above; but a spring whose gap is closed stays under any rule.
            return (gap - stretch * levels.length.sqrt()).next_up().min(gap);
        }
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

    /// Returns true if the edges pass from a span to the next larger one without a jump.
    #[inline]
    pub fn slides_on(&self, lower: &Levels, upper: &Levels) -> bool {
        !SLIDES || lower.slide_on(self.stretch, upper)
    }

    /// ∫ (c − θ)² dx over the places passed while the edges move between two spans and levels, each place at its own
    /// indentation θ, in cells times ½ s².
    pub fn passed_squares(&self, [lower, upper]: [(Span, f64); 2]) -> f64 {
        if !SLIDES {
            let [fewer, more] = [lower, upper].map(|(span, _)| span.springs() as f64);
            // Springs attach one by one to patches of `fewer` springs and more, and detach from those of `more` and fewer.
            let sign = if self.unloading { 1.0 } else { -1.0 };
            return (more - fewer) * (more + fewer + sign);
        }
        // Twice the stretch s √ℓ of an edge times the change of the length ℓ.
        let length = |(span, level): (Span, f64)| {
            let [left, right] = EdgeCell::of(self.gaps, &span, level);
            [(span.last - span.first) as f64, left.share + right.share]
        };
        let ([cells0, share0], [cells1, share1]) = (length(lower), length(upper));
        // Whole cells and shares are subtracted separately: as lengths they would lose digits.
        ((cells1 - cells0) + (share1 - share0)) * ((cells0 + cells1) + (share0 + share1))
    }
}
