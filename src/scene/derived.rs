//! Quantities that follow from the values of a scene by one formula.

use super::model::{Adhesion, Form, Material, Scene};
use std::ops::Range;

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

impl Adhesion {
    /// The same adhesion with this work of adhesion γ, J/m², in place of κ or e_el/γ.
    #[must_use]
    pub fn with_work(mut self, work: f64) -> Self {
        (self.work, self.kappa, self.elastic_energy_ratio) = (Some(work), None, None);
        self
    }
}

impl Scene {
    /// Distance Δx = L/N of the springs, m.
    pub fn spacing(&self) -> f64 {
        self.length / self.numerics.points as f64
    }

    /// Indices of the springs under the body: all of them but those beside a punch.
    pub fn springs_under_body(&self) -> Range<u64> {
        let points = self.numerics.points;
        self.form.map_or(0..points, |form| form.springs_under(self.length, points))
    }
}

impl Form {
    /// Index of the spring on the axis of every form, ⌊N/2⌋ of N = `points` springs. With its axis between two springs
    /// a form would be blunt by half a cell, an error of first order in force, indentation and energy.
    pub fn spring_on_axis(points: u64) -> u64 {
        points / 2
    }

    /// Displacement of the body along the foundation, in cells, that puts its axis from L/2 onto a spring: ½ for an even
    /// number of springs, 0 for an odd one. Form and roughness are displaced together, so that their relative position
    /// does not depend on the number of springs. A punch has no tip and is not displaced.
    pub fn shift(&self, points: u64) -> f64 {
        if points.is_multiple_of(2) && !matches!(self, Form::Punch { .. }) { 0.5 } else { 0.0 }
    }

    /// Indices of the springs under the form, of `points` springs on `length` m: all of them, except under a punch.
    /// A punch covers its diameter rounded to whole cells, centred on the axis to half a cell; below half a cell none.
    pub fn springs_under(&self, length: f64, points: u64) -> Range<u64> {
        let Form::Punch { radius } = *self else { return 0..points };
        let cells = (2.0 * radius / (length / points as f64)).round() as u64;
        let cells = cells.min(points);
        let first = Form::spring_on_axis(points) - cells / 2;
        first..first + cells
    }
}

#[cfg(test)]
mod tests {
    use super::super::strategies::sound;
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
    fn a_punch_covers_the_nearest_number_of_whole_cells() {
        let under = |radius, points| Form::Punch { radius }.springs_under(1.0, points);
        // Whole cells, also those that the axis cannot halve.
        assert_eq!((under(0.2, 10), under(0.25, 10), under(0.3, 10)), (3..7, 3..8, 2..8));
        assert_eq!((under(0.2, 5), under(0.3, 5)), (1..3, 1..4));
        // A quarter of a cell on either side of the axis is the least.
        assert_eq!((under(0.026, 10).count(), under(0.024, 10).count()), (1, 0));
        for points in 1..20 {
            assert_eq!(under(0.5, points), 0..points);
            assert_eq!(under(9.0, points), 0..points);
            let sphere = Form::Paraboloid { radius: 1.0 };
            assert_eq!(sphere.springs_under(1.0, points), 0..points);
            for cells in 1..=points {
                let springs = under(0.5 * cells as f64 / points as f64, points);
                assert_eq!(springs.end - springs.start, cells);
                assert!(
                    springs.contains(&Form::spring_on_axis(points)) || cells == 0,
                    "{springs:?} of {points}"
                );
            }
        }
    }

    #[test]
    fn springs_share_the_length() {
        assert_eq!(sound().spacing(), 1e-4 / 4096.0);
    }
}
