//! Isotropic spectra C2D(q), given at nodes, and the equivalent lines of these spectra.

use super::nodes::Nodes;
use super::quadrature::{GaussPoint, gauss};
use asperity_data::Cholesky;
use rand::rngs::ChaCha8Rng;
use rand::{Rng, SeedableRng};
use serde::Serialize;
use std::f64::consts::{PI, TAU};

#[cfg(test)]
pub(super) use tests::known;

/// Part of the key of the random generator. It makes the numbers independent of other random
/// numbers with the same seed.
const PURPOSE: &[u8; 24] = b"asperity-spectrum-draws\0";

/// Number of pieces per unit of u into which the quadrature of [`cut`] divides its range.
const CUT_PIECES: f64 = 8.0;

/// Computes the power spectral density in m³ of a cut, a profile measured across a surface with the
/// two-dimensional spectral density C2D: C_cut(k) = (1/π) ∫ C2D(√(k² + t²)) dt. The integral is
/// computed with the substitution t = k sinh u. The spectrum C2D ends at the wave number `end` in
/// rad/m.
pub(super) fn cut(c2d: impl Fn(f64) -> f64, wave_number: f64, end: f64) -> f64 {
    let last = (end / wave_number).max(1.0).acosh();
    let pieces = (CUT_PIECES * last).ceil();
    let bound = |piece: u32| last * f64::from(piece) / pieces;
    let points = (0..pieces as u32).flat_map(|piece| gauss(bound(piece), bound(piece + 1)));
    let term = |point: GaussPoint| {
        let cosh = point.place.cosh();
        point.weight * c2d(wave_number * cosh) * cosh
    };
    points.map(term).sum::<f64>() * wave_number / PI
}

/// Values of an [`IsotropicSpectrum`] at one node. A node is one of the wave numbers at which the
/// spectrum is given.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Node {
    /// Wave number q in rad/m.
    pub wave_number: f64,
    /// Two-dimensional spectral density C2D(q) of the surface in m⁴.
    pub c2d: f64,
    /// Standard error of ln C2D(q), about the relative standard error of the spectral density
    /// C2D(q).
    pub relative_error: f64,
    /// Power spectral density of the equivalent line in m³ at the wave number q.
    pub line: f64,
}

/// Isotropic two-dimensional power spectral density C2D(q) of a surface in m⁴. The density is given
/// at several wave numbers q, the [nodes](Node). Between the nodes, ln C2D is linear in ln q.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct IsotropicSpectrum {
    pub(super) nodes: Nodes,
    /// ln C2D at the nodes, the wave numbers at which the spectral density C2D is given.
    pub(super) values: Vec<f64>,
    /// Cholesky factor of the information matrix, the inverse covariance matrix, of `values`.
    pub(super) information: Cholesky,
    /// Relative standard errors of the integrals ∫ q^power C2D dq over the spectrum C2D, for power
    /// = 1, 2, 3, that result from the method of estimation.
    pub(super) method: [f64; 3],
    /// Relative changes of the integrals ∫ q^power C2D dq over the spectrum C2D, for power = 1, 2,
    /// 3, if the surface has shorter waves than the points resolve.
    pub(super) missing: [f64; 3],
    /// Ratio of the largest to the smallest rms height, or rms gradient, among several kinds of
    /// surfaces. The kinds, such as profiles and maps, are fitted together by this spectrum. The
    /// ratio is 1 if chance explains the differences between the kinds.
    pub(super) ratio_of_kinds: f64,
}

/// Value of an integral over a spectrum, and the derivatives of this value with respect to ln C2D
/// at the nodes, the wave numbers at which the spectral density C2D is given.
pub(super) struct Integral {
    pub value: f64,
    pub gradient: Vec<f64>,
}

impl IsotropicSpectrum {
    /// Returns the two-dimensional spectral density C2D in m⁴ at a wave number in rad/m. The
    /// density is constant below the first node, the smallest wave number at which the spectrum is
    /// given. The density is zero above the last wave number of the spectrum.
    pub fn c2d(&self, wave_number: f64) -> f64 {
        if wave_number > self.nodes.end {
            0.0
        } else {
            self.value(wave_number.ln())
        }
    }

    /// Returns the power spectral density q C2D(q)/2 of the equivalent line in m³, at a wave number
    /// q in rad/m.
    pub fn line(&self, wave_number: f64) -> f64 {
        0.5 * wave_number * self.c2d(wave_number)
    }

    /// Returns the power spectral density in m³ of a cut at a wave number in rad/m. A cut is a
    /// profile measured across the surface.
    pub fn cut(&self, wave_number: f64) -> f64 {
        cut(|q| self.c2d(q), wave_number, self.nodes.end)
    }

    /// Returns the largest wave number in rad/m at which the spectrum is given, its last node. It
    /// belongs to the shortest measured waves with significant power.
    pub fn last_node(&self) -> f64 {
        self.nodes.wave_number(self.nodes.count - 1)
    }

    /// Returns the first and the last wave number of the spectrum in rad/m. The last one may exceed
    /// the last node, if the spectrum continues beyond the measured waves.
    pub fn range(&self) -> [f64; 2] {
        [self.nodes.wave_number(0), self.nodes.end]
    }

    /// Returns the same spectrum without the waves whose wave numbers exceed `wave_number` in
    /// rad/m.
    pub(crate) fn up_to(&self, wave_number: f64) -> IsotropicSpectrum {
        let mut shorter = self.clone();
        shorter.nodes.end = self.nodes.end.min(wave_number);
        shorter
    }

    /// Returns the values of the spectrum at its nodes, the wave numbers at which it is given, in
    /// ascending order of the wave number.
    pub fn nodes(&self) -> impl Iterator<Item = Node> {
        self.values.iter().enumerate().map(|(index, value)| {
            let wave_number = self.nodes.wave_number(index);
            Node {
                wave_number,
                c2d: value.exp(),
                relative_error: self.information.standard_error(index),
                line: self.line(wave_number),
            }
        })
    }

    /// Returns the spectrum with a random error of the fit. The error of ln C2D, where C2D is the
    /// spectral density, is drawn from the normal distribution of the errors of the fit and
    /// multiplied by `share`. `number` is the seed: equal numbers give equal errors.
    pub(crate) fn drawn(&self, number: u64, share: f64) -> IsotropicSpectrum {
        let mut draws = NormalDraws::new(number);
        let independent = self.values.iter().map(|_| draws.next()).collect();
        let steps = self.information.solve_transposed(independent);
        // The error of the method is common to all nodes: it changes ln C2D at each of them by the
        // same amount.
        let common = draws.next() * self.method.into_iter().fold(0.0, f64::max);
        let mut drawn = self.clone();
        for (value, step) in drawn.values.iter_mut().zip(steps) {
            *value += share * (step + common);
        }
        drawn
    }

    fn value(&self, ln_q: f64) -> f64 {
        self.nodes.place(ln_q).interpolate(&self.values).exp()
    }

    /// Computes ∫ q^power C2D dq over the waves with wave numbers from `from` (in rad/m) on. C2D is
    /// the spectral density at the wave number q.
    pub(super) fn integral(&self, power: i32, from: f64) -> Integral {
        let mut value = 0.0;
        let mut gradient = vec![0.0; self.values.len()];
        for piece in self.nodes.pieces_from(from) {
            for point in piece.logarithms() {
                let ln_q = point.place;
                let factor = (f64::from(power + 1) * ln_q).exp();
                let term = point.weight * self.value(ln_q) * factor;
                value += term;
                self.nodes.place(ln_q).distribute(term, &mut gradient);
            }
        }
        Integral { value, gradient }
    }

    /// Computes the integrals ∫ q^power C2D dq over the spectrum C2D, power = 1, 2, 3, for the
    /// waves of the equivalent line. Up to constant factors, the three integrals are the mean
    /// square height, the elastic energy and the mean square gradient of the line.
    pub(super) fn integrals(&self) -> [f64; 3] {
        let from = 0.5 * self.nodes.wave_number(0);
        [1, 2, 3].map(|power| self.integral(power, from).value)
    }

    /// Returns the relative differences between `other` and this spectrum in the three integrals ∫
    /// q^power C2D dq over the spectrum C2D, power = 1, 2, 3.
    pub(super) fn changes(&self, other: &IsotropicSpectrum) -> [f64; 3] {
        let own = self.integrals();
        let others = other.integrals();
        [0, 1, 2].map(|index| others[index] / own[index] - 1.0)
    }

    /// Adds further errors of the method of estimation to the relative errors of the three
    /// integrals ∫ q^power C2D dq over the spectrum C2D, power = 1, 2, 3. The squares of the errors
    /// are added, because the errors are independent.
    pub(super) fn add_method_errors(&mut self, errors: [f64; 3]) {
        for (method, error) in self.method.iter_mut().zip(errors) {
            *method = method.hypot(error);
        }
    }
}

/// Random numbers with the standard normal distribution, by the method of Box and Muller.
struct NormalDraws {
    generator: ChaCha8Rng,
}

impl NormalDraws {
    fn new(number: u64) -> Self {
        let mut key = [0; 32];
        key[..8].copy_from_slice(&number.to_le_bytes());
        key[8..].copy_from_slice(PURPOSE);
        NormalDraws {
            generator: ChaCha8Rng::from_seed(key),
        }
    }

    fn next(&mut self) -> f64 {
        let radius = (-2.0 * self.uniform().ln()).sqrt();
        radius * (TAU * self.uniform()).cos()
    }

    /// Returns a random number above 0 and at most 1, whose logarithm is finite.
    fn uniform(&mut self) -> f64 {
        ((self.generator.next_u64() >> 11) + 1) as f64 / (1_u64 << 53) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::super::moments::line_moments;
    use super::super::nodes::{End, WaveRange};
    use super::*;

    /// Returns a spectrum without errors whose spectral density at the nodes, in m⁴, is given by
    /// `c2d`.
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
            ratio_of_kinds: 1.0,
        }
    }

    #[test]
    fn drawn_spectra_spread_as_the_standard_errors_say() {
        let range = WaveRange {
            first: 1.0,
            last: 100.0,
        };
        let nodes = Nodes::new(range, 6.0, End::Ends);
        let count = nodes.count;
        // In this information matrix the errors of neighbouring nodes are correlated.
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
            // The tolerance allows for terms of second order in the errors, and for chance.
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
