//! The rule of Hess. The largest stretch that a patch bears is proportional to the square root of
//! the length of the patch.

use super::{DetachmentRule, Levels, ROUNDING, Rules};
use crate::foundation::Foundation;
use std::f64::consts::PI;

/// The rule of Hess, eqs. (3) and (10) of Popov and Filippov (2012): a patch of ℓ cells bears at
/// most the stretch Δl = √(π ℓ Δx γ/E*) = s √ℓ.
///
/// The length ℓ is a linear function of the level of the patch, the gap at which the edges of the
/// patch lie. All values that the solver searches are therefore roots of quadratic equations for y
/// = √ℓ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HessRule {
    /// Largest stretch s in m of a patch one cell long.
    stretch: f64,
}

impl HessRule {
    /// Creates the rule for a work of adhesion γ in J/m².
    pub fn new(foundation: Foundation, work: f64) -> Self {
        // The quotient γ/E* is computed first: if γ and E* are both multiplied by the same power of
        // two, no bit of the result changes.
        let range = work / foundation.modulus;
        HessRule {
            stretch: (PI * foundation.spacing * range).sqrt(),
        }
    }

    /// Returns √ℓ of a patch whose edges are free to move. `above` is the indentation d minus the
    /// largest gap of the patch in m.
    ///
    /// With y = √ℓ the level is d + s y. Since ℓ = length + growth (level − gap), the equation for
    /// y is quadratic.
    #[inline]
    fn root(&self, levels: &Levels, above: f64) -> f64 {
        let half = 0.5 * self.stretch * levels.growth;
        let square = (half * half + levels.length) + levels.growth * above;
        // If the growth is too large, the square is not a number, and only `half` counts.
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

    // `surely_bears` and `may_bear` compare squares, which is faster than to compute square roots.
    // For most springs these two bounds decide, and no root is computed.
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

    /// With y = √ℓ and k = s × growth, the derivative of the compression with respect to the
    /// indentation is ℓ (2y − 3k)/(2y − k).
    #[inline]
    fn stiffness(&self, levels: &Levels, above: f64, rise: f64) -> f64 {
        // The formula for sliding edges also holds at the lowest and at the highest level, where
        // the edges can slide to at least one side.
        let root = self.root(levels, above);
        let fall = self.stretch * levels.growth;
        let rises = 2.0 * root - fall;
        if rises > 0.0 {
            levels.length_at(rise) * (2.0 * root - 3.0 * fall) / rises
        } else {
            // When a patch is about to detach, its edges recede infinitely fast.
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
    /// The rules of a contact without adhesion, which allow no stretch of the springs.
    pub const NO_ADHESION: Self = Rules {
        closing: HessRule { stretch: 0.0 },
        opening: HessRule { stretch: 0.0 },
    };

    /// Creates the rules from two works of adhesion in J/m²: γ₁ = `closing` where the interface
    /// closes, and γ₂ = `opening` where it opens.
    ///
    /// If γ₂ is smaller than γ₁, it is replaced by γ₁. Otherwise a spring would detach as soon as
    /// it has attached.
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
