//! What the fragments come to at one moment, given where they are.

use super::edges::{Slider, SubCellEdges};
use super::sums::Sums;
use crate::contact::{CurvePoint, Foundation};

impl SubCellEdges {
    /// The point of the curve at an indentation, m, at which these fragments, given by first and last
    /// spring, are in contact.
    #[must_use]
    pub fn point(
        &self,
        foundation: Foundation,
        indentation: f64,
        fragments: &[(usize, usize)],
    ) -> CurvePoint {
        let mut sums = Sums::default();
        for &fragment in fragments {
            if let Some(root) = self.sets().tree().root_of(fragment) {
                sums.add(self, root, indentation);
            }
        }
        CurvePoint {
            indentation,
            force: foundation.spring_stiffness() * sums.compression(),
            contact_length: foundation.spacing * sums.length(),
            springs: sums.springs.unsigned_abs(),
            fragments: sums.fragments.unsigned_abs(),
        }
    }

    /// Largest stretch Δl_max, m, that a fragment of so many cells bears, eq. (10).
    #[must_use]
    pub fn largest_stretch(&self, cells: f64) -> f64 {
        self.stretch() * cells.sqrt()
    }

    /// How the fragment with these first and last springs slides; `None` where there can be no such
    /// fragment.
    #[must_use]
    pub fn slider_of(&self, fragment: (usize, usize)) -> Option<Slider> {
        self.sets().tree().root_of(fragment).map(|root| self.slider(root))
    }
}
