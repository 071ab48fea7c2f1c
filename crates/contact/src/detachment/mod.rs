//! Rules of detachment: how far the springs of a patch may be stretched, as a function of the
//! length of the patch alone.
//!
//! A rule states the largest stretch Δl(ℓ) of a patch of the length ℓ, and the slope of Δl. From
//! these two functions the trait computes everything else that the exact solver needs, by searches
//! and numerical integration. A further rule therefore needs only one further file. A rule with
//! closed-form results, such as the rule of Hess, replaces the searches.

mod hess;

pub use hess::HessRule;

use crate::crossing::{bisect, crossing};
use crate::history::Direction;
use asperity_data::gauss_nodes_on_quarter_circle;
use std::fmt::Debug;

/// Rule of detachment that all contacts use.
pub type ContactRule = HessRule;

/// Relative margin for rounding errors by which bounds of stretches and gaps are widened or
/// narrowed.
pub const ROUNDING: f64 = 1e-12;

/// Number of nodes of the numerical integration of squared stretches along a slide of the edges.
const NODES: usize = 16;

/// Largest number of doublings or halvings until a search has enclosed the sought length.
const MOST_DOUBLINGS: usize = 1000;

/// Length of a patch in cells, as a function of the level t in m: `length + growth (t − gap)`. The
/// level is the gap at which the edges of the patch lie. While the springs of the patch remain the
/// same, the level is between `gap` and `top`.
#[derive(Clone, Copy, Debug)]
pub struct Levels {
    /// Largest gap of the patch in m, which is its lowest level.
    pub gap: f64,
    /// Length of the patch in cells when its edges lie at the largest gap of the patch.
    pub length: f64,
    /// Growth of the length in cells for each metre of the level.
    pub growth: f64,
    /// Highest level in m: the gap of the spring that attaches next. Infinite if the patch fills
    /// the profile.
    pub top: f64,
}

impl Levels {
    /// Returns the length of the patch in cells when the edges of the patch lie `rise` (m) above
    /// the largest gap of the patch.
    #[inline]
    pub fn length_at(&self, rise: f64) -> f64 {
        self.length + self.growth * rise
    }
}

/// Rule of detachment: the largest stretch Δl(ℓ) that a patch of the length ℓ bears.
///
/// The solver relies on three properties:
///
/// 1. Δl never falls while ℓ grows.
/// 2. The slope of Δl never grows while ℓ grows. Therefore φ(t) = t − Δl(ℓ(t)), the indentation at
///    which a patch with its edges at the gap t is in equilibrium, first falls and then rises.
/// 3. Δl to the power 5/4 is concave, so that the force is convex between two events. For Δl = s
///    ℓ^p this holds if p is at most 4/5.
pub trait DetachmentRule: Copy + Debug + PartialEq {
    /// Returns the largest stretch Δl in m of a patch of the length `cells` in cells. The returned
    /// value must never fall while the length grows, not even by rounding.
    fn largest_stretch(&self, cells: f64) -> f64;

    /// Returns the derivative of the largest stretch with respect to the length, in m per cell.
    fn slope(&self, cells: f64) -> f64;

    /// Returns true if no patch bears any stretch, because the contact has no adhesion.
    #[inline]
    fn bears_no_stretch(&self) -> bool {
        self.largest_stretch(1.0) == 0.0
    }

    /// Returns true only if a patch certainly bears a stretch, whatever the rounding. `stretch` is
    /// in m, at least zero, and `cells` is the length of the patch in cells. An answer of true
    /// saves an evaluation of the rule.
    #[inline]
    fn surely_bears(&self, stretch: f64, cells: f64) -> bool {
        stretch <= self.sure_stretch(cells)
    }

    /// Returns false only if a patch of the length `cells` in cells certainly does not bear the
    /// stretch `stretch` in m, whatever the rounding.
    #[inline]
    fn may_bear(&self, stretch: f64, cells: f64) -> bool {
        stretch < self.largest_stretch(cells) * (1.0 + ROUNDING)
    }

    /// Returns a stretch in m that a patch of the length `cells` in cells certainly bears, whatever
    /// the rounding.
    #[inline]
    fn sure_stretch(&self, cells: f64) -> f64 {
        self.largest_stretch(cells) * (1.0 - ROUNDING)
    }

    /// Returns the smallest length in cells at which the equilibrium of a patch is stable. φ(t) is
    /// the indentation at which a patch with its edges at the gap t is in equilibrium. The
    /// equilibrium is stable where φ rises with t. `growth` is the growth of the length with t, in
    /// cells per metre. At the returned length, slope × growth is 1.
    fn turning_length(&self, growth: f64) -> f64 {
        let rises = |cells: f64| self.slope(cells) * growth <= 1.0;
        let mut high = 1.0;
        for _ in 0..MOST_DOUBLINGS {
            if rises(high) {
                break;
            }
            high *= 2.0;
        }
        let mut low = 0.5 * high;
        for _ in 0..MOST_DOUBLINGS {
            if !rises(low) {
                return bisect(low, high, rises);
            }
            high = low;
            low *= 0.5;
        }
        0.0
    }

    /// Returns true if the edges of a patch move with the indentation. This requires that the patch
    /// bears a stretch, and that the length of the patch grows with the gap at its edges. `growth`
    /// is this growth in cells per metre.
    #[inline]
    fn slides(&self, growth: f64) -> bool {
        growth > 0.0 && !self.bears_no_stretch()
    }

    /// Returns how far free edges in equilibrium lie above the largest gap of a patch, in m.
    /// `above` is the indentation minus the largest gap in m. If the equilibrium is outside the
    /// range of `levels`, the edges lie at the nearest end of this range.
    fn free_rise(&self, levels: &Levels, above: f64) -> f64 {
        if levels.growth <= 0.0 {
            return above + self.largest_stretch(levels.length);
        }
        // `excess` is φ minus the indentation. φ falls up to the turning length, where no patch is
        // stable.
        let excess = |rise: f64| (rise - above) - self.largest_stretch(levels.length_at(rise));
        let turning = (self.turning_length(levels.growth) - levels.length) / levels.growth;
        let lowest = turning.max(0.0);
        let highest = levels.top - levels.gap;
        if lowest >= highest || excess(highest) <= 0.0 {
            return highest;
        }
        if excess(lowest) >= 0.0 {
            return lowest;
        }
        crossing(lowest, highest, excess)
    }

    /// Returns the derivative, in cells, of the compression of a patch with respect to the
    /// indentation. The edges of the patch are free. `above` is the indentation minus the largest
    /// gap, and `rise` the height of the edges above the largest gap, both in m.
    ///
    /// The gap t at the edges changes with the indentation d by dt/dd = 1/(1 − Δl′ growth), and
    /// each edge that moves attaches springs with the stretch Δl.
    fn stiffness(&self, levels: &Levels, _above: f64, rise: f64) -> f64 {
        let length = levels.length_at(rise);
        let steepness = self.slope(length) * levels.growth;
        if steepness >= 1.0 {
            // When a patch is about to detach, its edges recede infinitely fast.
            return f64::NEG_INFINITY;
        }
        length - levels.growth * self.largest_stretch(length) / (1.0 - steepness)
    }

    /// Computes ∫ Δl² dℓ in cells times m², from ℓ = 0 to ℓ = `cells`. Δl is the largest stretch of
    /// a patch of ℓ cells.
    fn squares_up_to(&self, cells: f64) -> f64 {
        self.squares_between(cells, cells)
    }

    /// Computes ∫ Δl² dℓ in cells times m² between two lengths ℓ. Δl is the largest stretch of a
    /// patch of ℓ cells. The arguments are the difference and the sum of the two lengths in cells,
    /// so that a small difference is as accurate as possible.
    fn squares_between(&self, difference: f64, sum: f64) -> f64 {
        let shorter = 0.5 * (sum - difference);
        let mut integral = 0.0;
        // The substitution ℓ = shorter + difference sin⁴ θ keeps the integral accurate although Δl
        // may have no derivative at zero length.
        for (angle, weight) in gauss_nodes_on_quarter_circle::<NODES>() {
            let (sine, cosine) = angle.sin_cos();
            let stretch = self.largest_stretch(shorter + difference * sine.powi(4));
            integral += weight * 4.0 * sine.powi(3) * cosine * stretch * stretch;
        }
        difference * integral
    }

    /// Computes Σ Δl(n)² in m² from n = `first` to n = `last`, where Δl(n) is the largest stretch
    /// of a patch of n springs. The sum is zero if `last` is smaller than `first`.
    fn squares_of_patches(&self, first: f64, last: f64) -> f64 {
        let mut sum = 0.0;
        let mut springs = first;
        while springs <= last {
            let stretch = self.largest_stretch(springs);
            sum += stretch * stretch;
            springs += 1.0;
        }
        sum
    }
}

/// Two rules of the same kind: `closing` for attachment and `opening` for detachment. The rule for
/// detachment allows at least the stretch that the rule for attachment allows. While the stretch at
/// the edges of a patch is between the two limits, the edges do not move.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rules<R> {
    closing: R,
    opening: R,
}

impl<R: DetachmentRule> Rules<R> {
    /// Returns the rule for a direction of motion. On loading the rule limits the stretch with
    /// which a spring attaches. On unloading it limits the stretch that a spring bears before it
    /// detaches.
    pub fn rule(&self, direction: Direction) -> R {
        match direction {
            Direction::Loading => self.closing,
            Direction::Unloading => self.opening,
        }
    }

    /// Returns true if the rules for attachment and for detachment are equal.
    pub fn is_one(&self) -> bool {
        self.opening == self.closing
    }
}

#[cfg(test)]
mod tests;
