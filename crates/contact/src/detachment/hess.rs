//! The rule of Hess, whose largest stretch is proportional to the square root of the length of the
//! patch.

use super::{DetachmentRule, Levels, ROUNDING, Rules};
use crate::foundation::Foundation;
use std::f64::consts::PI;

/// The rule of Hess, eqs. (3) and (10) of Popov and Filippov (2012): a patch of ℓ cells bears the
/// stretch Δl = √(π ℓ Δx γ/E*) = s √ℓ.
///
/// With y = √ℓ all roots are those of quadratic equations, since ℓ is linear in the level.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HessRule {
    /// Largest stretch s in m of a patch one cell long.
    stretch: f64,
}

impl HessRule {
    /// Creates the rule for a work of adhesion γ in J/m².
    pub fn new(foundation: Foundation, work: f64) -> Self {
        // The quotient γ/E* first: scaling both by one power of two then changes no bit.
        let range = work / foundation.effective_modulus;
        HessRule {
            stretch: (PI * foundation.spacing * range).sqrt(),
        }
    }

    /// Returns √ℓ of a patch whose edges are free to move. `above` is the indentation minus the
    /// largest gap in m.
    ///
    /// The level is d + s y, and ℓ = length + growth (level − gap) is quadratic in y.
    #[inline]
    fn root(&self, levels: &Levels, above: f64) -> f64 {
        let half = 0.5 * self.stretch * levels.growth;
        let square = (half * half + levels.length) + levels.growth * above;
        // A square that is not a number results from growth without bound; then only `half` counts.
        half + if square > 0.0 { square.sqrt() } else { 0.0 }
    }
}

impl DetachmentRule for HessRule {
    #[inline]
    fn largest_stretch(&self, cells: f64) -> f64 {
        self.stretch * cells.sqrt()
    }

    #[inline]
    fn slope(&self, cells: f64) -> f64 {
        0.5 * self.stretch / cells.sqrt()
    }

    // Squares in place of roots: most springs ask only these bounds.
    #[inline]
    fn surely_bears(&self, stretch: f64, cells: f64) -> bool {
        stretch * stretch <= self.stretch * self.stretch * (1.0 - ROUNDING) * cells
    }

    #[inline]
    fn may_bear(&self, stretch: f64, cells: f64) -> bool {
        stretch * stretch < self.stretch * self.stretch * (1.0 + ROUNDING) * cells
    }

    #[inline]
    fn sure_stretch(&self, cells: f64) -> f64 {
        (self.stretch * self.stretch * (1.0 - ROUNDING) * cells).sqrt()
    }

    #[inline]
    fn turning_length(&self, growth: f64) -> f64 {
        let root = 0.5 * self.stretch * growth;
        root * root
    }

    #[inline]
    fn slides(&self, growth: f64) -> bool {
        self.stretch * growth > 0.0
    }

    #[inline]
    fn free_rise(&self, levels: &Levels, above: f64) -> f64 {
        above + self.stretch * self.root(levels, above)
    }

    /// With y = √ℓ and k = s × growth the derivative is ℓ (2y − 3k)/(2y − k).
    #[inline]
    fn stiffness(&self, levels: &Levels, above: f64, rise: f64) -> f64 {
        // The edges also slide at the ends of their levels, to one side at least.
        let root = self.root(levels, above);
        let fall = self.stretch * levels.growth;
        let rises = 2.0 * root - fall;
        if rises > 0.0 {
            levels.length_at(rise) * (2.0 * root - 3.0 * fall) / rises
        } else {
            // The edges of a patch that is about to detach recede without bound.
            f64::NEG_INFINITY
        }
    }

    #[inline]
    fn squares_up_to(&self, cells: f64) -> f64 {
        let length = self.stretch * cells;
        0.5 * length * length
    }

    #[inline]
    fn squares_between(&self, difference: f64, sum: f64) -> f64 {
        0.5 * self.stretch * self.stretch * (difference * sum)
    }

    #[inline]
    fn squares_of_patches(&self, first: f64, last: f64) -> f64 {
        0.5 * self.stretch * self.stretch * ((last - first + 1.0) * (first + last))
    }
}

impl Rules<HessRule> {
    /// The rules without adhesion: the largest stretch is zero.
    pub const NO_ADHESION: Self = Rules {
        closing: HessRule { stretch: 0.0 },
        opening: HessRule { stretch: 0.0 },
    };

    /// Creates the rules for the works of adhesion γ₁ on closing and γ₂ ≥ γ₁ on opening, both in
    /// J/m².
    ///
    /// A γ₂ smaller than γ₁ is replaced by γ₁. Otherwise a spring would detach where it had just
    /// attached.
    pub fn from_works(foundation: Foundation, closing: f64, opening: f64) -> Self {
        let closing = HessRule::new(foundation, closing);
        let opening = HessRule::new(foundation, opening);
        Rules {
            closing,
            opening: HessRule {
                stretch: opening.stretch.max(closing.stretch),
            },
        }
    }
}
