//! Random-phase synthesis of a self-affine line of rms height 1 by one inverse real Fourier transform.

use super::{SelfAffine, SurfaceError, phases};
use realfft::RealFftPlanner;
use rustfft::num_complex::Complex64;

/// Heights of a self-affine line of rms height 1 at x = (i + ½)L/N, eqs. (8) and (9).
///
/// They depend on spectrum, seed and number of points alone; length and rms height only scale them.
#[derive(Clone, Debug, PartialEq)]
pub struct UnitRoughness {
    /// Heights in units of the rms height.
    pub heights: Vec<f64>,
    /// Random phases drawn.
    pub random_phases: u64,
}

impl UnitRoughness {
    /// The line of a spectrum and a seed on `points` springs; `spectrum.last` must not exceed
    /// `points`/2.
    ///
    /// The rms height is that of the sum of cosines over the whole length. Two grids sample the same
    /// line, to the rounding of the transform.
    ///
    /// # Errors
    /// [`SurfaceError::OutOfMemory`], [`SurfaceError::Transform`].
    pub fn synthesize(spectrum: SelfAffine, seed: u64, points: usize) -> Result<Self, SurfaceError> {
        let reserve = |_| SurfaceError::OutOfMemory { points };
        let mut coefficients: Vec<Complex64> = Vec::new();
        coefficients.try_reserve_exact(points / 2 + 1).map_err(reserve)?;
        coefficients.resize(points / 2 + 1, Complex64::ZERO);
        let mut heights: Vec<f64> = Vec::new();
        heights.try_reserve_exact(points).map_err(reserve)?;
        heights.resize(points, 0.0);

        let scale = spectrum.relative_rms().recip();
        let half_cell = std::f64::consts::PI / points as f64;
        for (mode, phase) in (spectrum.first..=spectrum.last).zip(phases(seed, spectrum.first)) {
            // x = (i + ½)Δx adds half a cell to the phase. Each cosine is a pair of exponentials, so a
            // coefficient is half its amplitude, save at the grid's Nyquist wave vector, where both of
            // the pair fall together.
            let amplitude = scale * spectrum.relative_amplitude(mode);
            let angle = phase + half_cell * mode as f64;
            let Some(coefficient) = coefficients.get_mut(mode as usize) else { break };
            *coefficient = if 2 * mode == points as u64 {
                Complex64::new(amplitude * angle.cos(), 0.0)
            } else {
                Complex64::from_polar(0.5 * amplitude, angle)
            };
        }
        RealFftPlanner::<f64>::new()
            .plan_fft_inverse(points)
            .process(&mut coefficients, &mut heights)
            .map_err(|error| SurfaceError::Transform(error.to_string()))?;
        Ok(UnitRoughness { heights, random_phases: spectrum.last + 1 - spectrum.first })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn direct(spectrum: SelfAffine, seed: u64, position: f64) -> f64 {
        let sum: f64 = (spectrum.first..=spectrum.last)
            .zip(phases(seed, spectrum.first))
            .map(|(k, phase)| {
                spectrum.relative_amplitude(k) * (std::f64::consts::TAU * k as f64 * position + phase).cos()
            })
            .sum();
        sum / spectrum.relative_rms()
    }

    #[test]
    fn is_the_sum_of_cosines_on_every_grid() {
        for (points, first, last) in [(64, 1, 32), (100, 3, 50), (101, 1, 50), (97, 2, 40), (2, 1, 1)] {
            let spectrum = SelfAffine { hurst: 0.6, first, last };
            let line = UnitRoughness::synthesize(spectrum, 42, points).unwrap();
            assert_eq!(line.random_phases, last + 1 - first);
            for (i, &height) in line.heights.iter().enumerate() {
                let expected = direct(spectrum, 42, (i as f64 + 0.5) / points as f64);
                assert!((height - expected).abs() < 1e-12, "N = {points}, i = {i}: {height} {expected}");
            }
        }
    }

    #[test]
    fn has_rms_one_and_refines_to_the_same_line() {
        let spectrum = SelfAffine { hurst: 0.8, first: 1, last: 100 };
        let coarse = UnitRoughness::synthesize(spectrum, 3, 1000).unwrap().heights;
        // Three times the points: every third, from the second on, lies where one of the coarse lies.
        let fine = UnitRoughness::synthesize(spectrum, 3, 3000).unwrap().heights;
        for (i, &height) in coarse.iter().enumerate() {
            assert!((height - fine[3 * i + 1]).abs() < 1e-12);
        }
        let rms = (coarse.iter().map(|z| z * z).sum::<f64>() / 1000.0).sqrt();
        assert!((rms - 1.0).abs() < 1e-12, "{rms}");
        let gradient =
            (0..1000).map(|i| (fine[3 * i + 2] - fine[3 * i]) * 1500.0).map(|g| g * g).sum::<f64>();
        let rms_gradient = (gradient / 1000.0).sqrt();
        let expected = spectrum.gradient_per_height(1.0);
        assert!((rms_gradient / expected - 1.0).abs() < 3e-3, "{rms_gradient} {expected}");
    }
}
