//! The elastic foundation of the method of dimensionality reduction.

use super::history::{CurvePoint, Patch};

/// A foundation of independent springs that is equivalent to an elastic half-space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Foundation {
    /// Distance Δx between springs in m.
    pub spacing: f64,
    /// Effective modulus E* in Pa, eq. (2) of Popov and Filippov (2012).
    pub modulus: f64,
    /// Length L of the foundation in m; infinite if it extends beyond any contact.
    pub length: f64,
}

impl Foundation {
    /// Returns the length in m of `cells` cells in contact. A cell has the length Δx, the distance
    /// between springs. If the cells cover the whole foundation, the length is exactly `length`,
    /// although the number of cells times Δx may differ from `length` by rounding.
    #[inline]
    pub fn contact_length(&self, cells: f64) -> f64 {
        let length = cells * self.spacing;
        if length > self.length * (1.0 - 2.0 * f64::EPSILON) {
            self.length
        } else {
            length
        }
    }

    /// Returns half the distance in m between the outermost edges of the contact; zero in
    /// separation. This distance is the contact length plus the length of the open springs between
    /// the patches. `patches` and `point` must belong to the same state of the body.
    pub fn contact_radius(&self, patches: &[Patch], point: CurvePoint) -> f64 {
        let separated_springs = match patches {
            [] => 0,
            [leftmost, ..] => {
                let rightmost = patches[patches.len() - 1];
                let springs = rightmost.last - leftmost.first + 1;
                springs as u64 - point.springs
            }
        };
        0.5 * (point.contact_length + separated_springs as f64 * self.spacing)
    }

    /// Returns the stiffness Δk = E* Δx of one spring in N/m, eq. (1) of Popov and Filippov (2012).
    pub fn spring_stiffness(&self) -> f64 {
        self.modulus * self.spacing
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// If all cells are in contact, the contact length equals the length of the foundation to
        /// the last bit. Fewer cells have their own length, and more cells are not longer than the
        /// foundation.
        #[test]
        fn no_contact_is_longer_than_the_foundation(springs in 2_usize..400, length in 1e-6..10.0_f64) {
            let spacing = length / springs as f64;
            let foundation = Foundation { spacing, modulus: 1.0, length };
            let endless = Foundation { length: f64::INFINITY, ..foundation };
            prop_assert_eq!(foundation.contact_length(springs as f64), length);
            prop_assert_eq!(foundation.contact_length(springs as f64 + 0.5), length);
            for cells in 0..springs {
                let own = cells as f64 * foundation.spacing;
                prop_assert_eq!(foundation.contact_length(cells as f64), own);
                prop_assert_eq!(endless.contact_length(cells as f64), own);
            }
        }
    }
}
