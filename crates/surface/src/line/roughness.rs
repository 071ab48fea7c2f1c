//! Synthesis of a self-affine profile with the rms height 1 and random phases, by one inverse
//! Fourier transform.

use super::modes::{Modes, phases};
use super::spectrum::{ModeRange, SelfAffine};
use crate::error::SurfaceError;
use asperity_data::{in_parallel, memory};
use asperity_fourier::{Complex64, ComplexToReal, plan_real_inverse};
use std::f64::consts::TAU;
use std::sync::Arc;

/// Smallest number of modes for which a second thread saves more time than it takes to start.
const MANY_MODES: usize = 1 << 16;

/// Largest number of springs with which the plan of the transform is kept for the next profile. The
/// plan takes 20 bytes per spring. For longer profiles this memory is more important than the time
/// that the plan saves.
const LONGEST_KEPT: usize = 1 << 22;

/// Computes random self-affine profiles one after another. The plan and the memory of the Fourier
/// transform are used again for the next profile.
#[derive(Default)]
pub struct Synthesizer {
    transform: Option<Transform>,
}

struct Transform {
    points: usize,
    plan: Arc<dyn ComplexToReal<f64>>,
    coefficients: Vec<Complex64>,
    scratch: Vec<Complex64>,
}

impl Transform {
    fn planned(points: usize) -> Result<Self, SurfaceError> {
        let plan = plan_real_inverse(points);
        let coefficients = memory::resized(Vec::new(), points / 2 + 1, Complex64::ZERO)?;
        let scratch = memory::resized(Vec::new(), plan.get_scratch_len(), Complex64::ZERO)?;
        Ok(Transform {
            points,
            plan,
            coefficients,
            scratch,
        })
    }
}

impl Synthesizer {
    /// Computes a random profile like [`SelfAffine::heights`], but displaced along the springs by
    /// `shift` spring spacings. The height at spring i is the height that the profile without
    /// displacement has at x = (i + ½ − `shift`)L/N, for the length L and N = `points` springs. The
    /// result reuses the memory of `memory`.
    ///
    /// # Errors
    /// Returns an error if the memory does not suffice.
    pub fn synthesize(
        &mut self,
        spectrum: SelfAffine,
        seed: u64,
        points: usize,
        shift: f64,
        memory: Vec<f64>,
    ) -> Result<Vec<f64>, SurfaceError> {
        let modes = Modes::new(spectrum, seed, points, 0.5 - shift);
        let range = ModeRange {
            first: spectrum.first,
            last: spectrum.last,
        };
        self.transform(range, points, memory, |first, coefficients| {
            let is_worth_a_thread = coefficients.len() >= MANY_MODES;
            let middle = coefficients.len() / 2;
            let (lower, upper) = coefficients.split_at_mut(middle);
            // Another thread computes the upper half of the modes.
            in_parallel(
                is_worth_a_thread,
                || modes.draw((first + middle) as u64, upper),
                || modes.draw(first as u64, lower),
            );
        })
    }

    /// Computes the heights in m of a sum of cosine waves, one wave with k periods over the length
    /// L for each k in `modes`. The amplitude of a wave is `amplitude`(k) in m, and `seed`
    /// determines its phase. The last mode must be at most N/2, where N is `points`. The height at
    /// spring i is that at x = (i + ½ − `shift`)L/N.
    ///
    /// # Errors
    /// Returns an error if the memory does not suffice.
    pub fn synthesize_waves(
        &mut self,
        amplitude: &dyn Fn(u64) -> f64,
        modes: ModeRange,
        seed: u64,
        points: usize,
        shift: f64,
        memory: Vec<f64>,
    ) -> Result<Vec<f64>, SurfaceError> {
        // Phase of mode 1 at the first point of the grid minus its phase at the beginning of the
        // profile, in rad.
        let advance = TAU * (0.5 - shift) / points as f64;
        let first = modes.first;
        self.transform(modes, points, memory, |_, coefficients| {
            let with_phases = coefficients.iter_mut().zip(phases(seed, first));
            for (mode, (coefficient, phase)) in (first..).zip(with_phases) {
                let phase = phase + advance * mode as f64;
                *coefficient = Complex64::from_polar(0.5 * amplitude(mode), phase);
            }
        })
    }

    /// Computes the heights of a sum of these modes. `draw` fills in the coefficients ½ A_k e^(iφ)
    /// of the modes; its first argument is the first mode to be filled in.
    fn transform(
        &mut self,
        modes: ModeRange,
        points: usize,
        memory: Vec<f64>,
        draw: impl FnOnce(usize, &mut [Complex64]),
    ) -> Result<Vec<f64>, SurfaceError> {
        let mut transform = match self.transform.take() {
            Some(kept) if kept.points == points => kept,
            _ => Transform::planned(points)?,
        };
        let mut heights = memory::resized(memory, points, 0.0)?;

        let coefficients = transform.coefficients.as_mut_slice();
        let end = (modes.last as usize).saturating_add(1);
        let end = end.min(coefficients.len());
        let first = (modes.first as usize).min(end);
        coefficients[..first].fill(Complex64::ZERO);
        coefficients[end..].fill(Complex64::ZERO);
        draw(first, &mut coefficients[first..end]);
        let has_nyquist = 2 * modes.last == points as u64;
        if has_nyquist {
            // A wave with a wavelength of two points has the Nyquist wave number of the grid. The
            // two exponentials of such a cosine wave coincide, and their coefficients add up to a
            // real number.
            coefficients[end - 1] = Complex64::new(2.0 * coefficients[end - 1].re, 0.0);
        }

        transform
            .plan
            .process_with_scratch(
                &mut transform.coefficients,
                &mut heights,
                &mut transform.scratch,
            )
            .map_err(|error| SurfaceError::Transform(error.to_string()))?;
        if points <= LONGEST_KEPT {
            self.transform = Some(transform);
        }
        Ok(heights)
    }
}

impl SelfAffine {
    /// Computes the heights of a random profile with this spectrum, by eqs. (8) and (9) of Popov
    /// and Filippov (2012). The heights are in units of the rms height, at x = (i + ½)L/N on N =
    /// `points` springs along the length L. `points` has to be at least twice the last mode.
    ///
    /// The rms height is that of the continuous profile, which is a sum of cosine waves. The rms of
    /// the N heights differs from this rms height only if the last mode is exactly N/2.
    ///
    /// ```
    /// let spectrum = asperity_surface::SelfAffine {
    ///     hurst: 0.8,
    ///     first: 1,
    ///     last: 128,
    ///     roll_off_mode: 0.0,
    /// };
    /// let heights = spectrum.heights(7, 1024)?;
    /// assert!((heights.iter().map(|z| z * z).sum::<f64>() / 1024.0 - 1.0).abs() < 1e-9);
    /// assert_eq!(
    ///     heights,
    ///     spectrum.heights(7, 1024)?,
    ///     "the same seed gives the same profile"
    /// );
    /// # Ok::<(), asperity_surface::SurfaceError>(())
    /// ```
    pub fn heights(self, seed: u64, points: usize) -> Result<Vec<f64>, SurfaceError> {
        Synthesizer::default().synthesize(self, seed, points, 0.0, Vec::new())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::line::modes::phases;
    use asperity_data::on_this_thread;

    fn direct(spectrum: SelfAffine, seed: u64, position: f64) -> f64 {
        let sum: f64 = (spectrum.first..=spectrum.last)
            .zip(phases(seed, spectrum.first))
            .map(|(k, phase)| {
                spectrum.relative_amplitude(k)
                    * (std::f64::consts::TAU * k as f64 * position + phase).cos()
            })
            .sum();
        sum / spectrum.relative_rms()
    }

    #[test]
    fn is_the_sum_of_cosines_on_every_grid() {
        for (points, first, last, roll_off) in [
            (64, 1, 32, 0.0),
            (100, 3, 50, 0.0),
            (101, 1, 50, 11.5),
            (97, 2, 40, 0.0),
            (2, 1, 1, 0.0),
            (1400, 2, 700, 600.0),
        ] {
            let spectrum = SelfAffine {
                hurst: 0.6,
                first,
                last,
                roll_off_mode: roll_off,
            };
            for shift in [0.0, 0.5] {
                let line = Synthesizer::default()
                    .synthesize(spectrum, 42, points, shift, Vec::new())
                    .unwrap();
                for (i, &height) in line.iter().enumerate() {
                    let expected = direct(spectrum, 42, (i as f64 + 0.5 - shift) / points as f64);
                    assert!(
                        (height - expected).abs() < 1e-14 * last.max(100) as f64,
                        "N = {points}, i = {i}: {height} {expected}"
                    );
                }
            }
        }
        // The profile has the rms height 1, which is the mean square 1.
        let heights = SelfAffine {
            hurst: 0.8,
            first: 1,
            last: 100,
            roll_off_mode: 0.0,
        }
        .heights(3, 1000)
        .unwrap();
        let rms = (heights.iter().map(|z| z * z).sum::<f64>() / 1000.0).sqrt();
        assert!((rms - 1.0).abs() < 1e-12, "{rms}");
    }

    #[test]
    fn what_is_kept_changes_no_bit() {
        let mut synthesizer = Synthesizer::default();
        let mut memory = Vec::new();
        let many = 2 * MANY_MODES as u64 + 3;
        for (points, hurst, first, last, seed) in [
            (100, 0.6, 3, 50, 1),
            (100, 0.6, 3, 50, 2),
            (100, 0.6, 3, 20, 2),
            (101, 0.6, 5, 20, 2),
            (300_000, 0.7, 2, many, 3),
            (300_000, 0.8, 2, many, 3),
            (2 * many as usize, 0.8, 1, many, 3),
            (64, 0.8, 1, 32, 3),
        ] {
            let spectrum = SelfAffine {
                hurst,
                first,
                last,
                roll_off_mode: 0.0,
            };
            let kept = synthesizer
                .synthesize(spectrum, seed, points, 0.0, memory)
                .unwrap();
            assert_eq!(kept, spectrum.heights(seed, points).unwrap());
            // On one thread and with another plan of the transform, the heights have the same bits.
            let alone = on_this_thread(|| spectrum.heights(seed, points).unwrap());
            assert_eq!(kept, alone);
            memory = kept;
        }
    }
}
