//! Moments of the equivalent line, such as the rms height, with their errors.

use super::isotropic::{Integral, IsotropicSpectrum};
use serde::Serialize;
use std::f64::consts::PI;

/// An estimated quantity: its value and its standard error, both in the unit of the quantity.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ValueWithError {
    /// Estimated value, in the unit of the quantity.
    pub value: f64,
    /// Standard error of the value, in the unit of the quantity.
    pub error: f64,
}

/// A moment of a spectrum, such as the rms height, with its errors. All values have the unit of the
/// moment.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Moment {
    /// Value in the unit of the moment, such as m for the rms height.
    pub value: f64,
    /// Standard error of the value in its unit: the root of the sum of the squares of `statistical`
    /// and `method`.
    pub error: f64,
    /// Standard error of the value, in its unit, that results from the finite number of measured
    /// waves.
    pub statistical: f64,
    /// Standard error of the value, in its unit, that results from the method of estimation.
    pub method: f64,
    /// Largest change of the value if the surface has shorter waves than the points resolve. These
    /// shorter waves are assumed to follow a power law down to a quarter of the shortest resolved
    /// wavelength. The change is zero if the value already includes shorter waves
    /// ([`End::Continues`](super::nodes::End::Continues)). It is also zero if the spectrum ends
    /// within the resolved waves, so that no shorter waves are expected.
    pub missing_short_waves: f64,
}

impl Moment {
    /// Creates a moment from its value and its relative errors.
    fn new(value: f64, relative: RelativeErrors) -> Self {
        let statistical = relative.statistical * value;
        let method = relative.method * value;
        Moment {
            value,
            error: statistical.hypot(method),
            statistical,
            method,
            missing_short_waves: relative.missing_short_waves * value,
        }
    }

    /// Returns the moment and its errors, multiplied by a factor.
    pub fn scaled(self, factor: f64) -> Self {
        let relative = RelativeErrors {
            statistical: self.statistical / self.value,
            method: self.method / self.value,
            missing_short_waves: self.missing_short_waves / self.value,
        };
        Moment::new(factor * self.value, relative)
    }

    /// Returns the square root of the moment, with the errors of this root.
    pub fn root(self) -> Self {
        let missing_short_waves = (1.0 + self.missing_short_waves / self.value).sqrt() - 1.0;
        let relative = RelativeErrors {
            statistical: 0.5 * self.statistical / self.value,
            method: 0.5 * self.method / self.value,
            missing_short_waves,
        };
        Moment::new(self.value.sqrt(), relative)
    }
}

/// Errors of a [`Moment`], divided by its value.
#[derive(Clone, Copy)]
struct RelativeErrors {
    statistical: f64,
    method: f64,
    missing_short_waves: f64,
}

/// Moments of the [equivalent line](crate::EquivalentLine), each with its errors.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct LineMoments {
    /// Rms height h in m.
    pub rms_height: Moment,
    /// Rms gradient ⟨∇z⟩.
    pub rms_gradient: Moment,
    /// Product of the rms height h and the rms gradient ⟨∇z⟩ in m.
    pub height_gradient: Moment,
    /// Ratio e_el/E* in m. e_el is the elastic energy per area in J/m² that flattens the roughness,
    /// and E* is the effective modulus in Pa.
    pub energy_per_modulus: Moment,
}

/// Computes the moments of the equivalent line of one or two faces, which are the surfaces that
/// touch each other. The spectrum of the line is the sum of the spectra of the faces. The errors of
/// the faces are independent.
///
/// The waves of the line begin at half of the first wave number that is known for all faces,
/// because the wave with one period over a length represents all waves from ½ to 1½ periods.
pub(crate) fn line_moments(faces: &[IsotropicSpectrum]) -> LineMoments {
    let integrals = LineIntegrals::new(faces);
    let [squared_height, energy, squared_gradient] = integrals.totals.map(|total| 0.5 / PI * total);
    let height = squared_height.sqrt();
    let gradient = squared_gradient.sqrt();
    LineMoments {
        rms_height: integrals.moment(height, [0.5, 0.0, 0.0]),
        rms_gradient: integrals.moment(gradient, [0.0, 0.0, 0.5]),
        height_gradient: integrals.moment(height * gradient, [0.5, 0.0, 0.5]),
        energy_per_modulus: integrals.moment(0.25 * energy, [0.0, 1.0, 0.0]),
    }
}

/// The integrals ∫ q^power C2D dq over the spectra of several faces, for power = 1, 2, 3.
struct LineIntegrals<'a> {
    faces: &'a [IsotropicSpectrum],
    /// The integrals of each face.
    of_faces: Vec<[Integral; 3]>,
    /// The integrals of all faces together.
    totals: [f64; 3],
}

impl<'a> LineIntegrals<'a> {
    fn new(faces: &'a [IsotropicSpectrum]) -> Self {
        let from = faces
            .iter()
            .map(|face| 0.5 * face.nodes.wave_number(0))
            .fold(0.0, f64::max);
        let of_faces: Vec<_> = faces
            .iter()
            .map(|face| [1, 2, 3].map(|power| face.integral(power, from)))
            .collect();
        let total = |index: usize| {
            of_faces
                .iter()
                .map(|integrals| integrals[index].value)
                .sum()
        };
        LineIntegrals {
            faces,
            totals: [0, 1, 2].map(total),
            of_faces,
        }
    }

    /// Returns the moment `value` with its errors. The moment must be proportional to the product
    /// of the three integrals, each raised to its power in `exponents`. The errors of several faces
    /// are independent.
    fn moment(&self, value: f64, exponents: [f64; 3]) -> Moment {
        let mut statistical_variance = 0.0;
        let mut method_variance = 0.0;
        let mut missing_ratios = [1.0; 3];
        for (face, integrals) in self.faces.iter().zip(&self.of_faces) {
            // Gradient of the logarithm of the moment with respect to ln C2D at the nodes.
            let mut gradient = vec![0.0; face.values.len()];
            let mut departure = 0.0;
            for (index, exponent) in exponents.into_iter().enumerate() {
                let integral = &integrals[index];
                let total = self.totals[index];
                for (sum, slope) in gradient.iter_mut().zip(&integral.gradient) {
                    *sum += exponent * slope / total;
                }
                departure += exponent * face.method[index] * integral.value / total;
                missing_ratios[index] += face.missing[index] * integral.value / total;
            }
            statistical_variance += face.information.variance(&gradient);
            method_variance += departure * departure;
        }
        let with_missing_waves: f64 = missing_ratios
            .into_iter()
            .zip(exponents)
            .map(|(ratio, exponent)| ratio.powf(exponent))
            .product();
        let relative = RelativeErrors {
            statistical: statistical_variance.sqrt(),
            method: method_variance.sqrt(),
            missing_short_waves: with_missing_waves - 1.0,
        };
        Moment::new(value, relative)
    }
}

#[cfg(test)]
mod tests {
    use super::super::isotropic::known;
    use super::super::nodes::{End, Nodes, WaveRange};
    use super::*;

    #[test]
    fn moments_of_a_power_law_are_those_of_its_integrals() {
        // C2D is q⁻³ above q = 1, and constant below q = 1.
        let range = WaveRange {
            first: 1.0,
            last: 100.0,
        };
        let spectrum = known(Nodes::new(range, 6.0, End::Ends), |q| q.powi(-3));
        let moments = line_moments(std::slice::from_ref(&spectrum));
        // The integral ∫ q C2D dq is 3/8 from ½ to 1, and 1 − 1/100 from 1 to 100.
        let expected = ((0.375 + 0.99) / (2.0 * PI)).sqrt();
        assert!(
            (moments.rms_height.value / expected - 1.0).abs() < 1e-8,
            "{moments:?}"
        );
        let expected = ((15.0 / 64.0 + 99.0) / (2.0 * PI)).sqrt();
        assert!((moments.rms_gradient.value / expected - 1.0).abs() < 1e-8);
        // The relative error of a product is at most the sum of the errors of its factors, and at
        // least the difference of these errors.
        let relative = |moment: Moment| moment.error / moment.value;
        let (height, gradient) = (relative(moments.rms_height), relative(moments.rms_gradient));
        let product = relative(moments.height_gradient);
        assert!(
            product <= height + gradient && product >= (height - gradient).abs(),
            "{moments:?}"
        );
        let values = moments.rms_height.value * moments.rms_gradient.value;
        assert_eq!(moments.height_gradient.value, values);
        let expected = (7.0 / 24.0 + 100.0_f64.ln()) / (8.0 * PI);
        assert!((moments.energy_per_modulus.value / expected - 1.0).abs() < 1e-8);
        assert_eq!((spectrum.c2d(200.0), spectrum.c2d(0.1)), (0.0, 1.0));
        assert!((spectrum.line(10.0) / 5e-3 - 1.0).abs() < 1e-12);
        let further = known(Nodes::new(range, 6.0, End::Continues(200.0)), |q| {
            q.powi(-3)
        });
        assert!((further.c2d(200.0) / 1.25e-7 - 1.0).abs() < 1e-12);
    }
}
