//! What follows from a scene's values by one formula.

use super::model::{Material, Scene};

impl Material {
    /// Material given by its effective modulus E*, Pa.
    #[must_use]
    pub fn effective(modulus: f64) -> Self {
        Material { youngs_modulus: None, poisson_ratio: None, effective_modulus: Some(modulus) }
    }

    /// Isotropic material under a rigid body, given by Young's modulus E (Pa) and Poisson's ratio ν: E* = E/(1 − ν²).
    #[must_use]
    pub fn isotropic(youngs_modulus: f64, poisson_ratio: f64) -> Self {
        Material {
            youngs_modulus: Some(youngs_modulus),
            poisson_ratio: Some(poisson_ratio),
            effective_modulus: None,
        }
    }

    /// Effective modulus E* of eq. (2), Pa. NaN where the material is not determined, which
    /// [`check`](super::check()) refuses.
    pub fn effective_modulus(&self) -> f64 {
        match (self.effective_modulus, self.youngs_modulus, self.poisson_ratio) {
            (Some(modulus), None, None) => modulus,
            // (1 − ν)(1 + ν) keeps its digits where ν is close to −1; 1 − ν² does not.
            (None, Some(modulus), Some(ratio)) => modulus / ((1.0 - ratio) * (1.0 + ratio)),
            _ => f64::NAN,
        }
    }
}

impl Scene {
    /// Distance Δx = L/N of the springs, m.
    pub fn spacing(&self) -> f64 {
        self.length / self.numerics.points as f64
    }
}

#[cfg(test)]
mod tests {
    use super::super::samples::sound;
    use super::*;

    #[test]
    fn the_effective_modulus_is_that_of_equation_2() {
        let modulus = |youngs_modulus, poisson_ratio, effective_modulus| {
            Material { youngs_modulus, poisson_ratio, effective_modulus }.effective_modulus()
        };
        assert_eq!(modulus(Some(3e6), Some(0.5), None), 4e6);
        assert_eq!(modulus(Some(3e6), Some(0.0), None), 3e6);
        assert_eq!(modulus(None, None, Some(2.5e6)), 2.5e6);
        for undetermined in [
            modulus(None, None, None),
            modulus(Some(3e6), None, None),
            modulus(None, Some(0.5), None),
            modulus(Some(3e6), Some(0.5), Some(4e6)),
        ] {
            assert!(undetermined.is_nan());
        }
    }

    #[test]
    fn springs_share_the_length() {
        assert_eq!(sound().spacing(), 1e-4 / 4096.0);
    }
}
