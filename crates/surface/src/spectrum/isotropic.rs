//! Isotropic spectra C2D(q), given at nodes, and the equivalent lines of these spectra.

use super::statistics::PointStatistics;
use asperity_data::Cholesky;
use rand::rngs::ChaCha8Rng;
use rand::{Rng, SeedableRng};
use serde::Serialize;
use std::f64::consts::{FRAC_PI_2, PI, SQRT_2, TAU};

#[cfg(test)]
pub(super) use tests::known;

/// Separates this use of the random generator from other uses.
const PURPOSE: &[u8; 24] = b"asperity-spectrum-draws\0";

/// The positive nodes of Gauss-Legendre quadrature on (−1, 1) with six nodes, and their weights.
/// Errors are below 1e-9 for the pieces used here.
const GAUSS: [(f64, f64); 3] = [
    (0.238_619_186_083_196_9, 0.467_913_934_572_691),
    (0.661_209_386_466_264_5, 0.360_761_573_048_138_6),
    (0.932_469_514_203_152, 0.171_324_492_379_170_36),
];

/// Number of quadrature pieces per unit of u in [`cut`].
const CUT_PIECES: f64 = 8.0;

/// Returns the points and weights of the quadrature from `low` to `high`.
pub(super) fn gauss(low: f64, high: f64) -> impl Iterator<Item = (f64, f64)> {
    let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
    GAUSS.into_iter().flat_map(move |(place, weight)| {
        [-place, place].map(|place| (middle + half * place, half * weight))
    })
}

/// Computes C_cut(k) = (1/π) ∫ C2D(√(k² + t²)) dt in m³ by the substitution t = k sinh u. The
/// spectrum ends at the wave number `end` in rad/m.
pub(super) fn cut(c2d: impl Fn(f64) -> f64, wave_number: f64, end: f64) -> f64 {
    let last = (end / wave_number).max(1.0).acosh();
    let pieces = (CUT_PIECES * last).ceil();
    let bound = |piece: u32| last * f64::from(piece) / pieces;
    let places = (0..pieces as u32).flat_map(|piece| gauss(bound(piece), bound(piece + 1)));
    let terms = places.map(|(u, weight)| weight * c2d(wave_number * u.cosh()) * u.cosh());
    terms.sum::<f64>() * wave_number / PI
}

/// Whether a spectrum continues beyond the last resolved wave, the shortest wave that the measured
/// points resolve.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum End {
    /// The surface has no waves shorter than the last resolved one.
    #[default]
    Ends,
    /// Waves continue up to this wave number in rad/m. Their spectrum is the power law through the
    /// last two [nodes](Node).
    Continues(f64),
}

/// An estimated quantity: its value and its standard error, both in the unit of the quantity.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ValueWithError {
    /// Estimated value of the quantity.
    pub value: f64,
    /// Standard error of the value.
    pub error: f64,
}

/// A moment of a spectrum, such as the rms height, with its errors. All values have the unit of the
/// moment.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Moment {
    /// Value of the moment.
    pub value: f64,
    /// Standard error of the value, from `statistical` and `method` together.
    pub error: f64,
    /// Standard error that results from the finite number of measured waves.
    pub statistical: f64,
    /// Standard error that results from the method of estimation.
    pub method: f64,
    /// Largest change of the value if the surface has shorter waves than the points resolve: a
    /// power law down to a quarter of the shortest resolved wavelength. The change is zero with
    /// [`End::Continues`], and if the spectrum ends before the last resolved wave.
    pub missing_short_waves: f64,
}

impl Moment {
    fn new(value: f64, statistical: f64, method: f64, missing_short_waves: f64) -> Self {
        let [statistical, method, missing_short_waves] =
            [statistical, method, missing_short_waves].map(|error| error * value);
        Moment {
            value,
            error: statistical.hypot(method),
            statistical,
            method,
            missing_short_waves,
        }
    }

    /// Returns the moment multiplied by a factor, with its errors.
    pub fn scaled(self, factor: f64) -> Self {
        let relative = |error: f64| error / self.value;
        let [statistical, method, missing] =
            [self.statistical, self.method, self.missing_short_waves].map(relative);
        Moment::new(factor * self.value, statistical, method, missing)
    }

    /// Returns the square root of the moment, with its errors.
    pub fn root(self) -> Self {
        let relative = |error: f64| 0.5 * error / self.value;
        let missing = (1.0 + self.missing_short_waves / self.value).sqrt() - 1.0;
        Moment::new(
            self.value.sqrt(),
            relative(self.statistical),
            relative(self.method),
            missing,
        )
    }
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
    /// Elastic energy per area that flattens the roughness, divided by the effective modulus:
    /// e_el/E* in m.
    pub energy_per_modulus: Moment,
}

/// Nodes equally spaced in ln q.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Nodes {
    /// ln q of the first node.
    pub first: f64,
    /// Distance between nodes in ln q.
    pub step: f64,
    pub count: usize,
    /// Largest wave number of the spectrum in rad/m; beyond the last node for a spectrum that is
    /// continued.
    pub end: f64,
}

impl Nodes {
    /// Creates nodes between two wave numbers in rad/m, `per_decade` of them in a decade, for a
    /// spectrum with this end.
    pub fn new(low: f64, high: f64, per_decade: f64, end: End) -> Self {
        let decades = (high / low).log10();
        let pieces = (per_decade * decades).ceil().max(2.0);
        let first = low.ln();
        let end = match end {
            End::Ends => high,
            End::Continues(end) => end.max(high),
        };
        Nodes {
            first,
            step: (high / low).ln() / pieces,
            count: pieces as usize + 1,
            end,
        }
    }

    /// Returns the wave number of a node in rad/m.
    pub fn wave_number(&self, index: usize) -> f64 {
        (self.first + index as f64 * self.step).exp()
    }

    /// Returns the index of the node below ln q, and the share of the way to the next node. A
    /// spectrum is constant below the first node and extrapolated beyond the last.
    pub fn place(&self, ln_q: f64) -> (usize, f64) {
        let place = ((ln_q - self.first) / self.step).max(0.0);
        let index = (place as usize).min(self.count - 2);
        (index, place - index as f64)
    }

    /// Returns the intervals of the wave number in rad/m, from `low` to the end of the spectrum, in
    /// each of which it is a power law.
    pub fn pieces_from(self, low: f64) -> impl Iterator<Item = (f64, f64)> {
        let index = |wave_number: f64| (wave_number.ln() - self.first) / self.step;
        // The logarithm of zero is below all nodes.
        let (first, last) = (
            (index(low).floor() + 1.0).max(0.0) as usize,
            index(self.end).ceil() as usize,
        );
        let node = move |index: usize| self.wave_number(index).min(self.end);
        let mut begin = low.min(self.end);
        (first..=last)
            .map(node)
            .chain([self.end])
            .filter_map(move |bound| {
                let piece = (begin, bound);
                begin = begin.max(bound);
                (piece.1 > piece.0).then_some(piece)
            })
    }

    /// Returns the term `weight` × C2D(q) of a sum over the spectrum, at a wave number q in rad/m.
    pub fn term(&self, q: f64, weight: f64) -> Term {
        let ln_q = q.ln();
        let (index, share) = self.place(ln_q);
        Term {
            weight,
            ln_q,
            index,
            share,
        }
    }
}

/// A weight times C2D at ln q, which lies between a node and the next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Term {
    pub weight: f64,
    pub ln_q: f64,
    pub index: usize,
    pub share: f64,
}

impl Term {
    /// Returns the value of the term for these values of ln C2D at the nodes.
    pub fn value(&self, values: &[f64]) -> f64 {
        self.weight
            * ((1.0 - self.share) * values[self.index] + self.share * values[self.index + 1]).exp()
    }
}

/// Values of an [`IsotropicSpectrum`] at one of the wave numbers by which the spectrum is given.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Node {
    /// Wave number q of the node in rad/m.
    pub wave_number: f64,
    /// Two-dimensional spectral density C2D(q) of the surface in m⁴.
    pub c2d: f64,
    /// Standard error of ln C2D(q). It is about the relative standard error of C2D(q).
    pub relative_error: f64,
    /// Power spectral density of the equivalent line at q in m³.
    pub line: f64,
}

/// Isotropic two-dimensional power spectral density C2D(q) of a surface in m⁴. It is given at
/// several wave numbers, the [nodes](Node). Between them ln C2D is linear in ln q.
#[derive(Clone, Debug, PartialEq)]
pub struct IsotropicSpectrum {
    pub(super) nodes: Nodes,
    /// ln C2D at the nodes.
    pub(super) values: Vec<f64>,
    /// Information matrix of `values`.
    pub(super) information: Cholesky,
    /// Relative errors of ∫ q^power C2D dq, for power = 1, 2, 3, that come from the method.
    pub(super) method: [f64; 3],
    /// Relative changes of the same integrals if short waves are missing.
    pub(super) missing: [f64; 3],
}

impl IsotropicSpectrum {
    /// Returns the two-dimensional spectral density C2D in m⁴ at a wave number in rad/m. It is
    /// constant below the first node and zero beyond the last wave number of the spectrum.
    pub fn c2d(&self, wave_number: f64) -> f64 {
        if wave_number > self.nodes.end {
            0.0
        } else {
            self.value(wave_number.ln())
        }
    }

    /// Returns the power spectral density of the equivalent line, q C2D/2 in m³, at a wave number q
    /// in rad/m.
    pub fn line(&self, wave_number: f64) -> f64 {
        0.5 * wave_number * self.c2d(wave_number)
    }

    /// Returns the power spectral density in m³ of a cut, a profile across the surface, at a wave
    /// number in rad/m.
    pub fn cut(&self, wave_number: f64) -> f64 {
        cut(|q| self.c2d(q), wave_number, self.nodes.end)
    }

    /// Returns the wave number in rad/m of the last node: that of the shortest wave that the
    /// measured points resolve.
    pub fn last_node(&self) -> f64 {
        self.nodes.wave_number(self.nodes.count - 1)
    }

    /// Returns the first and the last wave number of the spectrum in rad/m.
    pub fn range(&self) -> [f64; 2] {
        [self.nodes.wave_number(0), self.nodes.end]
    }

    /// Returns the same spectrum without the waves beyond a wave number in rad/m.
    pub(crate) fn up_to(&self, wave_number: f64) -> IsotropicSpectrum {
        let nodes = Nodes {
            end: self.nodes.end.min(wave_number),
            ..self.nodes
        };
        IsotropicSpectrum {
            nodes,
            ..self.clone()
        }
    }

    /// Returns the spectrum and its error at each node, in the order of the wave numbers.
    pub fn nodes(&self) -> impl Iterator<Item = Node> {
        self.values.iter().enumerate().map(|(index, value)| {
            let wave_number = self.nodes.wave_number(index);
            let relative_error = self.information.standard_error(index);
            Node {
                wave_number,
                c2d: value.exp(),
                relative_error,
                line: self.line(wave_number),
            }
        })
    }

    /// Changes ln C2D at the nodes by `share` of a random step, drawn from the normal distribution
    /// of the errors of the fit. `number` selects the step: equal numbers give equal steps.
    pub(crate) fn drawn(&self, number: u64, share: f64) -> IsotropicSpectrum {
        let mut key = [0; 32];
        key[..8].copy_from_slice(&number.to_le_bytes());
        key[8..].copy_from_slice(PURPOSE);
        let mut generator = ChaCha8Rng::from_seed(key);
        // From above 0 to 1, by Box and Muller.
        let mut uniform = || ((generator.next_u64() >> 11) + 1) as f64 / (1_u64 << 53) as f64;
        let mut normal = || (-2.0 * uniform().ln()).sqrt() * (TAU * uniform()).cos();
        let steps = self
            .information
            .solve_transposed(self.values.iter().map(|_| normal()).collect());
        // The error of the method moves all values alike.
        let common = normal() * self.method.into_iter().fold(0.0, f64::max);
        let values = self
            .values
            .iter()
            .zip(steps)
            .map(|(value, step)| value + share * (step + common))
            .collect();
        IsotropicSpectrum {
            values,
            ..self.clone()
        }
    }

    fn value(&self, ln_q: f64) -> f64 {
        let (index, share) = self.nodes.place(ln_q);
        ((1.0 - share) * self.values[index] + share * self.values[index + 1]).exp()
    }

    /// Computes ∫ q^power C2D dq over the waves from a wave number (rad/m) on, and its derivatives
    /// with respect to the values at the nodes.
    pub(super) fn moment(&self, power: i32, from: f64) -> (f64, Vec<f64>) {
        let (mut sum, mut gradient) = (0.0, vec![0.0; self.values.len()]);
        for (low, high) in self.nodes.pieces_from(from) {
            for (ln_q, weight) in gauss(low.ln(), high.ln()) {
                let term = weight * self.value(ln_q) * (f64::from(power + 1) * ln_q).exp();
                let (index, share) = self.nodes.place(ln_q);
                sum += term;
                gradient[index] += (1.0 - share) * term;
                gradient[index + 1] += share * term;
            }
        }
        (sum, gradient)
    }

    /// Computes ∫ q^power C2D dq for power = 1, 2, 3 over the waves of the equivalent line.
    pub(super) fn integrals(&self) -> [f64; 3] {
        [1, 2, 3].map(|power| self.moment(power, 0.5 * self.nodes.wave_number(0)).0)
    }

    /// Returns the relative differences of these integrals in another spectrum.
    pub(super) fn changes(&self, other: &IsotropicSpectrum) -> [f64; 3] {
        let (here, there) = (self.integrals(), other.integrals());
        [0, 1, 2].map(|index| there[index] / here[index] - 1.0)
    }

    /// Adds to the errors of the method the departure of the rms height of the line from the
    /// measured height, if this is known. Also adds the departure of its rms gradient from the
    /// gradient of the measured points beyond three standard errors, as after a spike that the
    /// window hides.
    pub(super) fn check_identities(&mut self, height: Option<f64>, measured: &PointStatistics) {
        let resolved = line_moments(std::slice::from_ref(self));
        let gradient = measured.rms_gradient.unwrap_or(SQRT_2 * measured.rms_slope);
        let departure = |moment: Moment, least: f64, most: f64| {
            let beyond = (least - moment.value).max(moment.value - most);
            // The squares have twice the relative error.
            if beyond > 3.0 * moment.error {
                2.0 * beyond / moment.value
            } else {
                0.0
            }
        };
        let height = height.map_or(0.0, |height| departure(resolved.rms_height, height, height));
        // Differences of neighbours reduce the slope of a wave of two points by π/2.
        let gradient = departure(resolved.rms_gradient, gradient, FRAC_PI_2 * gradient);
        for (error, departure) in
            self.method
                .iter_mut()
                .zip([height, height.max(gradient), gradient])
        {
            *error = error.hypot(departure);
        }
    }
}

/// Computes the moments of the equivalent line of faces with independent spectra, whose sum is its
/// spectrum. Its waves begin at half the first wave number known for all faces, because wave 1 of a
/// length represents the range from ½ to 1½.
pub(crate) fn line_moments(faces: &[IsotropicSpectrum]) -> LineMoments {
    let from = faces
        .iter()
        .map(|face| 0.5 * face.nodes.wave_number(0))
        .fold(0.0, f64::max);
    let moments = |power: i32| {
        faces
            .iter()
            .map(|face| face.moment(power, from))
            .collect::<Vec<_>>()
    };
    let sum = |moments: &[(f64, Vec<f64>)]| moments.iter().map(|(sum, _)| sum).sum::<f64>();
    let all = [1, 2, 3].map(moments);
    let totals = [0, 1, 2].map(|index| sum(&all[index]));
    // A value proportional to the product of powers of the integrals; faces are independent.
    let moment = |value: f64, exponents: [f64; 3]| {
        let (mut statistical, mut method, mut missing) = (0.0, 0.0, [1.0; 3]);
        for (number, face) in faces.iter().enumerate() {
            let (mut logarithm, mut departure) = (vec![0.0; face.values.len()], 0.0);
            for (index, exponent) in exponents.into_iter().enumerate() {
                let (integral, gradient) = &all[index][number];
                for (sum, slope) in logarithm.iter_mut().zip(gradient) {
                    *sum += exponent * slope / totals[index];
                }
                departure += exponent * face.method[index] * integral / totals[index];
                missing[index] += face.missing[index] * integral / totals[index];
            }
            statistical += face.information.variance(&logarithm);
            method += departure * departure;
        }
        let changed: f64 = missing
            .into_iter()
            .zip(exponents)
            .map(|(change, power)| change.powf(power))
            .product();
        Moment::new(value, statistical.sqrt(), method.sqrt(), changed - 1.0)
    };
    let two_pi = 0.5 / PI;
    let (height, gradient) = ((two_pi * totals[0]).sqrt(), (two_pi * totals[2]).sqrt());
    LineMoments {
        rms_height: moment(height, [0.5, 0.0, 0.0]),
        rms_gradient: moment(gradient, [0.0, 0.0, 0.5]),
        height_gradient: moment(height * gradient, [0.5, 0.0, 0.5]),
        energy_per_modulus: moment(0.25 * two_pi * totals[1], [0.0, 1.0, 0.0]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Spectrum with these values of ln C2D, known exactly.
    pub fn known(nodes: Nodes, c2d: impl Fn(f64) -> f64) -> IsotropicSpectrum {
        let values = (0..nodes.count)
            .map(|index| c2d(nodes.wave_number(index)).ln())
            .collect();
        let mut identity = vec![0.0; nodes.count * nodes.count];
        (0..nodes.count).for_each(|index| identity[index * (nodes.count + 1)] = 1.0);
        let information = Cholesky::new(identity, nodes.count).unwrap();
        IsotropicSpectrum {
            nodes,
            values,
            information,
            method: [0.0; 3],
            missing: [0.0; 3],
        }
    }

    #[test]
    fn moments_of_a_power_law_are_those_of_its_integrals() {
        // C2D = q⁻³ from 1 on, constant below.
        let spectrum = known(Nodes::new(1.0, 100.0, 6.0, End::Ends), |q| q.powi(-3));
        let moments = line_moments(std::slice::from_ref(&spectrum));
        // ∫ q C2D from ½ to 1 is 3/8, from 1 to 100 it is 1 − 1/100.
        let expected = ((0.375 + 0.99) / (2.0 * PI)).sqrt();
        assert!(
            (moments.rms_height.value / expected - 1.0).abs() < 1e-8,
            "{moments:?}"
        );
        let expected = ((15.0 / 64.0 + 99.0) / (2.0 * PI)).sqrt();
        assert!((moments.rms_gradient.value / expected - 1.0).abs() < 1e-8);
        // The error of a product is at most the sum of those of its factors, and at least their
        // difference.
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
        let further = known(Nodes::new(1.0, 100.0, 6.0, End::Continues(200.0)), |q| {
            q.powi(-3)
        });
        assert!((further.c2d(200.0) / 1.25e-7 - 1.0).abs() < 1e-12);
    }

    #[test]
    fn drawn_spectra_spread_as_the_standard_errors_say() {
        let nodes = Nodes::new(1.0, 100.0, 6.0, End::Ends);
        let count = nodes.count;
        // Neighbours are correlated.
        let mut information = vec![0.0; count * count];
        for row in 0..count {
            information[row * count + row] = 30.0;
            if row > 0 {
                information[row * count + row - 1] = -10.0;
            }
        }
        let information = Cholesky::new(information, count).unwrap();
        let spectrum = IsotropicSpectrum {
            information,
            ..known(nodes, |q| q.powi(-3))
        };
        assert_eq!(spectrum.drawn(7, 1.0), spectrum.drawn(7, 1.0));
        assert_eq!(spectrum.drawn(7, 0.0), spectrum);
        assert_ne!(spectrum.drawn(7, 1.0).values, spectrum.drawn(8, 1.0).values);
        let stated = line_moments(std::slice::from_ref(&spectrum));
        let draws = 4000;
        let (mut mean, mut square) = ([0.0; 3], [0.0; 3]);
        for number in 0..draws {
            let drawn = line_moments(&[spectrum.drawn(number, 1.0)]);
            let logarithms = [
                drawn.rms_gradient.value / stated.rms_gradient.value,
                drawn.height_gradient.value / stated.height_gradient.value,
                drawn.energy_per_modulus.value / stated.energy_per_modulus.value,
            ]
            .map(f64::ln);
            for (moment, logarithm) in logarithms.into_iter().enumerate() {
                mean[moment] += logarithm / draws as f64;
                square[moment] += logarithm * logarithm / draws as f64;
            }
        }
        let errors = [
            stated.rms_gradient,
            stated.height_gradient,
            stated.energy_per_modulus,
        ];
        for (moment, estimate) in errors.into_iter().enumerate() {
            let spread = (square[moment] - mean[moment].powi(2)).sqrt();
            let expected = estimate.error / estimate.value;
            // To second order in the errors, and a hundredth for chance.
            assert!(
                (spread / expected - 1.0).abs() < 0.1,
                "{moment}: {spread} {expected}"
            );
            assert!(
                mean[moment].abs() < 0.3 * expected,
                "{moment}: {}",
                mean[moment]
            );
        }
    }
}
