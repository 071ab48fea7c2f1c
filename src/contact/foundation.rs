//! The elastic foundation of the method of dimensionality reduction and the rule of Hess on it.

use super::{CurvePoint, Direction, Patch};
use serde::{Deserialize, Serialize};
use strum::IntoStaticStr;

/// Edge model of a contact patch.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, IntoStaticStr)]
pub enum Edges {
    /// The rule of the paper: a patch of n springs is n Δx long.
    Grid,
    /// The profile is straight from spring to spring, and a patch ends where the profile crosses the level of the
    /// patch: the error falls with Δx².
    SubCell,
}

impl Edges {
    /// Name in scene files.
    pub fn name(self) -> &'static str {
        self.into()
    }
}

/// A foundation of independent springs, equivalent to an elastic half-space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Foundation {
    /// Distance Δx between springs, m.
    pub spacing: f64,
    /// Effective modulus E*, Pa, eq. (2).
    pub effective_modulus: f64,
    /// Length L of the foundation, m; infinite if it extends beyond any contact.
    pub length: f64,
}

impl Foundation {
    /// Returns a foundation of this length (m) and number of springs for a half-space of this modulus (Pa).
    pub fn new(length: f64, springs: usize, effective_modulus: f64) -> Self {
        Foundation { spacing: length / springs as f64, effective_modulus, length }
    }

    /// Returns an endless foundation of springs at this distance (m) for a half-space of this modulus (Pa).
    pub const fn endless(spacing: f64, effective_modulus: f64) -> Self {
        Foundation { spacing, effective_modulus, length: f64::INFINITY }
    }

    /// Length in contact of this number of cells, m: never more than the length of the foundation, and exactly that
    /// length where the cells cover the foundation, which N times Δx may miss by a rounding.
    #[inline]
    pub fn contact_length(&self, cells: f64) -> f64 {
        let length = cells * self.spacing;
        if length > self.length * (1.0 - 2.0 * f64::EPSILON) { self.length } else { length }
    }

    /// Half the distance between the outermost edges of a contact in these patches, m; zero in separation. Gaps between
    /// patches are whole cells; the outermost edges may lie inside theirs.
    pub fn contact_radius(&self, patches: &[Patch], point: CurvePoint) -> f64 {
        let outermost = patches.first().zip(patches.last()).map(|(one, other)| other.last - one.first + 1);
        let between = outermost.map_or(0, |springs| springs as u64 - point.springs);
        0.5 * (point.contact_length + between as f64 * self.spacing)
    }

    /// Stiffness Δk = E* Δx of one spring, N/m, eq. (1).
    pub fn spring_stiffness(&self) -> f64 {
        self.effective_modulus * self.spacing
    }
}

/// The rule of Hess, eqs. (3) and (10): largest stretch of the springs of a contact fragment before they detach.
///
/// Where the work of adhesion is larger on opening than on closing, a fragment attaches springs by the closing rule and
/// detaches them by the opening one. In between its edges are pinned.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HessRule {
    /// Largest stretch of a single spring on detaching, m.
    opening: f64,
    /// Largest stretch of a single spring on attaching, m; at most `opening`.
    closing: f64,
}

impl HessRule {
    /// The rule without adhesion: no stretch.
    pub const NO_ADHESION: HessRule = HessRule { opening: 0.0, closing: 0.0 };

    /// The rule for a work of adhesion γ in J/m².
    pub fn new(foundation: Foundation, work_of_adhesion: f64) -> Self {
        Self::from_works(foundation, work_of_adhesion, work_of_adhesion)
    }

    /// The rule for a work of adhesion γ₁ on closing and γ₂ ≥ γ₁ on opening, both in J/m².
    ///
    /// A smaller γ₂ counts as γ₁: a spring would detach where it had just attached.
    pub fn from_works(foundation: Foundation, closing_work: f64, opening_work: f64) -> Self {
        let stretch = |work: f64| {
            // The quotient γ/E* first: scaling both by one power of two then changes no bit.
            let range = work / foundation.effective_modulus;
            (std::f64::consts::PI * foundation.spacing * range).sqrt()
        };
        let closing = stretch(closing_work);
        HessRule { opening: stretch(opening_work).max(closing), closing }
    }

    /// Largest stretch of a fragment of unit length, m, before it detaches, or as it attaches on a loading.
    pub fn stretch(&self, direction: Direction) -> f64 {
        match direction {
            Direction::Loading => self.closing,
            Direction::Unloading => self.opening,
        }
    }

    /// Returns true if springs attach and detach by one rule.
    pub fn is_one(&self) -> bool {
        self.opening == self.closing
    }

    /// Largest stretch Δl_max = sqrt(π n Δx γ/E*) of a fragment of `springs` springs, m, eq. (10).
    ///
    /// Rounding keeps the order: the value never falls with the number of springs.
    pub fn largest_stretch(&self, direction: Direction, springs: usize) -> f64 {
        self.stretch(direction) * (springs as f64).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// All cells are as long as the foundation, to the last bit; fewer have their own length, and more are no
        /// longer.
        #[test]
        fn no_contact_is_longer_than_the_foundation(springs in 2_usize..400, length in 1e-6..10.0_f64) {
            let foundation = Foundation::new(length, springs, 1.0);
            prop_assert_eq!(foundation.contact_length(springs as f64), length);
            prop_assert_eq!(foundation.contact_length(springs as f64 + 0.5), length);
            for cells in 0..springs {
                let own = cells as f64 * foundation.spacing;
                prop_assert_eq!(foundation.contact_length(cells as f64), own);
                prop_assert_eq!(Foundation::endless(foundation.spacing, 1.0).contact_length(cells as f64), own);
            }
        }
    }
}
