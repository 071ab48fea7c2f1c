//! Spectra C2D(q) that are given as a table, in place of a measured surface.

use super::isotropic::IsotropicSpectrum;
use super::nodes::Nodes;
use crate::error::{Place, SurfaceError, refused};
use asperity_data::Cholesky;
use std::f64::consts::TAU;

/// Largest number of nodes of a given spectrum. A table with closer wave numbers is averaged.
const MOST_NODES: usize = 256;

/// Inverse of the squared standard error of ln C2D at each node. A given spectrum has no errors.
const CERTAIN: f64 = 1.0e30;

/// Relative difference up to which the steps of ln q count as equal.
const EQUAL_STEPS: f64 = 1.0e-6;

/// Piece of the table between two neighbouring wave numbers, in which C2D is a power law.
#[derive(Clone, Copy, Debug)]
struct PowerLaw {
    /// Natural logarithms of the first and the last wave number.
    ends: [f64; 2],
    /// ln C2D at the first wave number.
    value: f64,
    /// Derivative of ln C2D by ln q.
    slope: f64,
}

impl PowerLaw {
    fn at(&self, ln_q: f64) -> f64 {
        self.value + self.slope * (ln_q - self.ends[0])
    }

    /// Returns ∫ q C2D dq between two logarithms of wave numbers.
    fn integral(&self, low: f64, high: f64) -> f64 {
        let exponent = self.slope + 2.0;
        let width = high - low;
        // For an exponent of 0 the second factor is the width.
        let factor = if (exponent * width).abs() < 1.0e-12 {
            width
        } else {
            (exponent * width).exp_m1() / exponent
        };
        (self.at(low) + 2.0 * low).exp() * factor
    }
}

impl IsotropicSpectrum {
    /// Returns the rms height in m and the rms gradient of all waves from the first node to the end
    /// of the spectrum, which may lie beyond the last node. A node is a wave number at which the
    /// spectrum is given.
    pub fn rms_of_height_and_gradient(&self) -> [f64; 2] {
        let [first, _] = self.range();
        [1, 3].map(|power| (self.integral(power, first).value / TAU).sqrt())
    }

    /// Creates the spectrum of a surface from a table: `wave_numbers` in rad/m, which ascend, and
    /// the two-dimensional spectral density C2D in m⁴ at each of them. Between them ln C2D is
    /// linear in ln q, and there are no waves beyond them. The spectrum has no errors.
    ///
    /// The rms height h follows from h² = (1/2π) ∫ q C2D dq.
    ///
    /// ```
    /// use asperity_surface::EquivalentLine;
    /// use asperity_surface::spectra::IsotropicSpectrum;
    ///
    /// let wave_numbers: Vec<f64> = (0..40).map(|i| 1e5 * 1.2_f64.powi(i)).collect();
    /// let c2d: Vec<f64> = wave_numbers.iter().map(|q| 1e-11 * q.powf(-3.6)).collect();
    /// let spectrum = IsotropicSpectrum::from_table(&wave_numbers, &c2d)?;
    /// let line = EquivalentLine { faces: vec![spectrum] };
    /// let heights = line.heights(6e-5, 4096, 1)?;
    /// # assert_eq!(heights.len(), 4096);
    /// # Ok::<(), asperity_surface::SurfaceError>(())
    /// ```
    ///
    /// # Errors
    /// Returns an error for fewer than two wave numbers, for wave numbers that do not ascend from
    /// above 0, and for a density that is not above 0.
    pub fn from_table(wave_numbers: &[f64], c2d: &[f64]) -> Result<Self, SurfaceError> {
        check(wave_numbers, c2d)?;
        let mut pieces = Vec::with_capacity(wave_numbers.len());
        for (q, density) in wave_numbers.windows(2).zip(c2d.windows(2)) {
            let ends = [q[0].ln(), q[1].ln()];
            let rise = density[1].ln() - density[0].ln();
            pieces.push(PowerLaw {
                ends,
                value: density[0].ln(),
                slope: rise / (ends[1] - ends[0]),
            });
        }
        let nodes = nodes_of(&pieces);
        let mut values = Vec::with_capacity(nodes.count);
        for index in 0..nodes.count {
            let ln_q = nodes.first + index as f64 * nodes.step;
            values.push(value_near(&pieces, ln_q, 0.5 * nodes.step));
        }
        let mut information = vec![0.0; nodes.count * nodes.count];
        for index in 0..nodes.count {
            information[index * (nodes.count + 1)] = CERTAIN;
        }
        let information = Cholesky::new(information, nodes.count).ok_or_else(|| {
            refused(
                Place::File,
                "a table without a spectrum",
                "densities above 0",
            )
        })?;
        Ok(IsotropicSpectrum {
            nodes,
            values,
            information,
            method: [0.0; 3],
            missing: [0.0; 3],
            ratio_of_kinds: 1.0,
        })
    }
}

fn check(wave_numbers: &[f64], c2d: &[f64]) -> Result<(), SurfaceError> {
    if wave_numbers.len() < 2 || c2d.len() != wave_numbers.len() {
        let found = format!(
            "{} wave numbers and {} densities",
            wave_numbers.len(),
            c2d.len()
        );
        let allowed = "two or more wave numbers, and a density for each of them";
        return Err(refused(Place::File, found, allowed));
    }
    let mut before = 0.0;
    for (index, (&q, &density)) in wave_numbers.iter().zip(c2d).enumerate() {
        let place = Place::Point(index + 1);
        if !(q > before && q.is_finite()) {
            let found = format!("the wave number {q:e} rad/m");
            let allowed = format!("above {before:e} rad/m: wave numbers that ascend from above 0");
            return Err(refused(place, found, allowed));
        }
        if !(density.is_normal() && density > 0.0) {
            return Err(refused(
                place,
                format!("the density {density:e} m⁴"),
                "above 0 m⁴",
            ));
        }
        before = q;
    }
    Ok(())
}

/// Returns nodes that are equally spaced in ln q, and as close as the closest wave numbers of the
/// table, if these are not too many. Equal steps of the table are kept.
fn nodes_of(pieces: &[PowerLaw]) -> Nodes {
    let first = pieces[0].ends[0];
    let last = pieces[pieces.len() - 1].ends[1];
    let mut smallest = f64::INFINITY;
    for piece in pieces {
        smallest = smallest.min(piece.ends[1] - piece.ends[0]);
    }
    let steps = ((last - first) / smallest * (1.0 - EQUAL_STEPS)).ceil();
    let count = (steps as usize).saturating_add(1).clamp(2, MOST_NODES);
    Nodes {
        first,
        step: (last - first) / (count - 1) as f64,
        count,
        end: last.exp(),
    }
}

/// Returns ln C2D at a logarithm of a wave number. If several wave numbers of the table lie nearer
/// than `distance`, the result is the logarithm of the mean of C2D there, with the weight q dq, so
/// that noise of the table does not change the mean square height.
fn value_near(pieces: &[PowerLaw], ln_q: f64, distance: f64) -> f64 {
    let next = pieces.partition_point(|piece| piece.ends[0] <= ln_q);
    let interpolated = pieces[next.saturating_sub(1)].at(ln_q);
    let begin = pieces.partition_point(|piece| piece.ends[1] <= ln_q - distance);
    let end = pieces.partition_point(|piece| piece.ends[0] < ln_q + distance);
    // Of two neighbouring pieces, one wave number of the table lies nearer.
    if end < begin + 3 {
        return interpolated;
    }
    let mut power = 0.0;
    let mut weight = 0.0;
    for piece in &pieces[begin..end] {
        let low = (ln_q - distance).max(piece.ends[0]);
        let high = (ln_q + distance).min(piece.ends[1]);
        power += piece.integral(low, high);
        weight += 0.5 * ((2.0 * high).exp() - (2.0 * low).exp());
    }
    (power / weight).ln()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Densities q^(−2−2H) for H = 0.8.
    fn densities(wave_numbers: &[f64]) -> Vec<f64> {
        wave_numbers.iter().map(|q| 1e-11 * q.powf(-3.6)).collect()
    }

    /// Rms height and rms gradient of the power law, in closed form.
    fn moments(first: f64, last: f64) -> [f64; 2] {
        let integral = |power: f64| (last.powf(power) - first.powf(power)) / power;
        [integral(-1.6), integral(0.4)].map(|integral| (1e-11 * integral / TAU).sqrt())
    }

    #[test]
    fn a_power_law_has_the_moments_of_its_closed_form() {
        let even: Vec<f64> = (0..40).map(|i| 1e5 * 1.2_f64.powi(i)).collect();
        let uneven = vec![1e5, 3e5, 4e5, 2e6, 1e7];
        let close: Vec<f64> = (1..=4000).map(|i| 1e5 * f64::from(i)).collect();
        for (table, tolerance) in [(even, 1e-9), (uneven, 1e-9), (close, 2e-3)] {
            let spectrum = IsotropicSpectrum::from_table(&table, &densities(&table)).unwrap();
            let [first, last] = spectrum.range();
            assert!((first / table[0] - 1.0).abs() < 1e-12);
            assert!((last / table[table.len() - 1] - 1.0).abs() < 1e-12);
            let found = spectrum.rms_of_height_and_gradient();
            let expected = moments(table[0], table[table.len() - 1]);
            for (found, expected) in found.into_iter().zip(expected) {
                let error = found / expected - 1.0;
                assert!(error.abs() < tolerance, "{} waves: {error}", table.len());
            }
            for node in spectrum.nodes() {
                assert!(node.relative_error < 1e-14);
            }
        }
    }

    #[test]
    fn noise_of_close_wave_numbers_is_averaged() {
        let table: Vec<f64> = (1..=6000).map(|i| 1e5 * f64::from(i)).collect();
        let mut noisy = densities(&table);
        for (index, density) in noisy.iter_mut().enumerate() {
            *density *= if index % 2 == 0 { 1.9 } else { 0.1 };
        }
        let noisy = IsotropicSpectrum::from_table(&table, &noisy).unwrap();
        let smooth = IsotropicSpectrum::from_table(&table, &densities(&table)).unwrap();
        let far = TAU / 1e-7;
        let ratio = noisy.c2d(far) / smooth.c2d(far);
        // A power law between 1.9 and 0.1 has a mean of 1.8/ln 19 of the smooth density.
        assert!(
            (ratio / (1.8 / 19.0_f64.ln()) - 1.0).abs() < 0.05,
            "{ratio}"
        );
    }

    #[test]
    fn tables_that_are_no_spectrum_are_refused() {
        for (wave_numbers, c2d) in [
            (vec![1.0], vec![1.0]),
            (vec![1.0, 2.0], vec![1.0]),
            (vec![2.0, 1.0], vec![1.0, 1.0]),
            (vec![0.0, 1.0], vec![1.0, 1.0]),
            (vec![1.0, f64::INFINITY], vec![1.0, 1.0]),
            (vec![1.0, 2.0], vec![1.0, 0.0]),
            (vec![1.0, 2.0], vec![f64::NAN, 1.0]),
        ] {
            assert!(
                IsotropicSpectrum::from_table(&wave_numbers, &c2d).is_err(),
                "{wave_numbers:?} {c2d:?}"
            );
        }
    }
}
