//! The self-affine spectrum of the equivalent profile, eqs. (4)–(9) of Popov and Filippov (2012),
//! and roughness amplitudes of profiles.

use asperity_data::{integral_of_power, sum_of_powers};
use std::f64::consts::TAU;

/// Self-affine spectrum of a profile: a sum of modes, which are waves with a whole number of
/// periods over the length L. Mode k, from `first` to `last`, has k periods and the wave number q_k
/// = 2πk/L. Its amplitude is A_k ∝ √k below the roll-off mode, eq. (8) of Popov and Filippov
/// (2012), and A_k ∝ k^(−H−1/2) above it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SelfAffine {
    /// Hurst exponent H, 0 < H < 1.
    pub hurst: f64,
    /// First mode: number of periods of the longest wave over the length; at least 1.
    pub first: u64,
    /// Last mode: number of periods of the shortest wave over the length; at least `first`.
    pub last: u64,
    /// Roll-off mode: the number of periods of the roll-off wavelength over the length L, which
    /// need not be a whole number. For any value up to `first`, such as 0, the spectrum has no
    /// roll-off.
    pub roll_off_mode: f64,
}

impl SelfAffine {
    /// Returns the amplitude A_k of mode k as a multiple of A₁. A₁ is the amplitude that mode 1
    /// would have without a roll-off.
    #[inline]
    pub fn relative_amplitude(&self, mode: u64) -> f64 {
        let mode = mode as f64;
        let decay = mode.max(self.roll_off_mode).powf(self.amplitude_exponent());
        if mode < self.roll_off_mode {
            decay * (mode / self.roll_off_mode).sqrt()
        } else {
            decay
        }
    }

    /// Returns the exponent −H − 1/2 with which the amplitude of a mode falls with its number of
    /// periods. H is the Hurst exponent.
    #[inline]
    pub(super) fn amplitude_exponent(&self) -> f64 {
        -self.hurst - 0.5
    }

    /// Returns the mean square height that one wave contributes to a surface with this spectrum.
    /// The unit is A₁², where A₁ is the amplitude that mode 1 would have without a roll-off.
    /// `waves` is the number of periods of the wave over the length, and need not be a whole
    /// number. Returns 0 if `waves` is more than ½ below `first` or more than ½ above `last`.
    pub fn relative_variance_of_surface(&self, waves: f64) -> f64 {
        if waves < self.first as f64 - 0.5 || waves > self.last as f64 + 0.5 {
            return 0.0;
        }
        let decay = waves
            .max(self.roll_off_mode)
            .powf(2.0 * self.amplitude_exponent());
        let square = if waves < self.roll_off_mode {
            decay * waves / self.roll_off_mode
        } else {
            decay
        };
        square / (4.0 * std::f64::consts::PI * waves)
    }

    /// Returns the rms height of the profile as a multiple of A₁: √(Σ A_k²/2)/A₁. A_k is the
    /// amplitude of mode k, and A₁ the amplitude that mode 1 would have without a roll-off.
    pub fn relative_rms(&self) -> f64 {
        (self.moment(0) / 2.0).sqrt()
    }

    /// Returns the ratio ⟨∇z⟩/h in 1/m of the rms gradient to the rms height, for a profile of the
    /// length L = `length` in m. The ratio is √(Σ A_k² q_k² / Σ A_k²), where A_k is the amplitude
    /// of mode k and q_k = 2πk/L is its wave number.
    ///
    /// ```
    /// use asperity_surface::SelfAffine;
    /// use std::f64::consts::TAU;
    ///
    /// // A single wave of 1 m: ⟨∇z⟩ = q h.
    /// let wave = SelfAffine { hurst: 0.8, first: 1, last: 1, roll_off_mode: 0.0 };
    /// assert!((wave.gradient_per_height(1.0) / TAU - 1.0).abs() < 1e-12);
    /// ```
    pub fn gradient_per_height(&self, length: f64) -> f64 {
        TAU / length * (self.moment(2) / self.moment(0)).sqrt()
    }

    /// Returns the rms height, gradient and curvature of a profile that has this spectrum, the rms
    /// height 1 m and the length L = `length` in m.
    ///
    /// ```
    /// let spectrum = asperity_surface::SelfAffine {
    ///     hurst: 0.8,
    ///     first: 1,
    ///     last: 512,
    ///     roll_off_mode: 0.0,
    /// };
    /// let amplitude = spectrum.unit_amplitude(1e-4).scaled(1e-7); // rms height 100 nm
    /// assert!(amplitude.rms_height == 1e-7 && amplitude.rms_gradient > 0.0);
    /// ```
    pub fn unit_amplitude(&self, length: f64) -> Amplitude {
        let unit = TAU / length;
        let height = self.moment(0);
        Amplitude {
            rms_height: 1.0,
            rms_gradient: self.gradient_per_height(length),
            rms_curvature: unit.powi(2) * (self.moment(4) / height).sqrt(),
            mean_wave_number: unit * (self.moment(1) / height),
        }
    }

    /// Returns the ratio ⟨∇z⟩/h in 1/m of the rms gradient to the rms height, for a continuous
    /// spectrum. Such a spectrum has waves at all wave numbers from the first to the last mode.
    /// Without a roll-off, the square of the ratio is ∫ q^(1−2H) dq / ∫ q^(−1−2H) dq over these
    /// wave numbers, eqs. (5)–(7) and (12) of Popov and Filippov (2012).
    ///
    /// Returns 0 for a single mode.
    pub fn continuum_gradient_per_height(&self, length: f64) -> f64 {
        let height = self.continuum_moment(0);
        if height == 0.0 {
            return 0.0;
        }
        TAU / length * (self.continuum_moment(2) / height).sqrt()
    }

    /// Computes ∫ k^power A_k² dk from the first to the last mode. A_k are amplitudes in units of
    /// A₁, see [`Self::relative_amplitude`].
    fn continuum_moment(&self, power: i32) -> f64 {
        let low = self.first as f64;
        let high = self.last as f64;
        let roll_off = self.roll_off_mode.max(low).min(high);
        let above = integral_of_power(self.exponent(power), roll_off, high);
        if roll_off == low {
            return above;
        }
        above + self.flat_level() * integral_of_power(f64::from(power) + 1.0, low, roll_off)
    }

    /// Computes Σ k^power A_k² over the modes, with a relative error of a few units in the last
    /// place. A_k are amplitudes in units of A₁, see [`Self::relative_amplitude`].
    fn moment(&self, power: i32) -> f64 {
        let first_above = (self.roll_off_mode.ceil() as u64)
            .max(self.first)
            .min(self.last.saturating_add(1));
        let above = sum_of_powers(self.exponent(power), first_above, self.last);
        if first_above == self.first {
            return above;
        }
        let below = sum_of_powers(f64::from(power) + 1.0, self.first, first_above - 1);
        above + self.flat_level() * below
    }

    /// Returns the exponent of k in the product k^power A_k², for modes above the roll-off.
    fn exponent(&self, power: i32) -> f64 {
        f64::from(power) - 1.0 - 2.0 * self.hurst
    }

    /// Returns A_k²/k for modes below the roll-off, where this ratio is constant.
    fn flat_level(&self) -> f64 {
        self.roll_off_mode.powf(-2.0 - 2.0 * self.hurst)
    }
}

/// The modes of a profile, from the first to the last one. Mode k is the wave with k periods over
/// the length of the profile.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ModeRange {
    /// First mode: number of periods of the longest wave.
    pub first: u64,
    /// Last mode: number of periods of the shortest wave.
    pub last: u64,
}

/// Mean square height that one mode contributes to a profile.
pub(crate) struct ModeSquare {
    pub mode: u64,
    /// Mean square height in m² of mode k: A_k²/2, where A_k is the amplitude of the mode.
    pub square: f64,
}

/// Roughness amplitude of a profile: rms height, gradient and curvature, and the mean wave number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Amplitude {
    /// Root mean square height h in m.
    pub rms_height: f64,
    /// Root mean square gradient ⟨∇z⟩.
    pub rms_gradient: f64,
    /// Root mean square curvature in 1/m.
    pub rms_curvature: f64,
    /// Mean wave number Σ q_k A_k²/Σ A_k² in rad/m; 0 for a flat profile. A_k are the amplitudes
    /// and q_k the wave numbers of the waves of the profile.
    pub mean_wave_number: f64,
}

impl Amplitude {
    /// Returns the roughness amplitude of the same profile after a multiplication of all its
    /// heights by `factor`.
    pub fn scaled(self, factor: f64) -> Self {
        Amplitude {
            rms_height: factor * self.rms_height,
            rms_gradient: factor * self.rms_gradient,
            rms_curvature: factor * self.rms_curvature,
            ..self
        }
    }

    /// Returns the roughness amplitude that the profile has after a stretch along x by the factor
    /// `times`. The stretch does not change the heights.
    pub fn stretched(self, times: f64) -> Self {
        Amplitude {
            rms_height: self.rms_height,
            rms_gradient: self.rms_gradient / times,
            rms_curvature: self.rms_curvature / times.powi(2),
            mean_wave_number: self.mean_wave_number / times,
        }
    }

    /// Computes the roughness amplitude of a profile with these modes on a length in m. The modes
    /// with the smallest mean squares have to come first, because a sum of ascending numbers has
    /// the smallest rounding error.
    pub(crate) fn from_modes(modes: impl Iterator<Item = ModeSquare>, length: f64) -> Self {
        let mut height = 0.0;
        let mut slope = 0.0;
        let mut gradient = 0.0;
        let mut curvature = 0.0;
        for ModeSquare { mode, square } in modes {
            let wave_number = TAU * mode as f64 / length;
            height += square;
            slope += square * wave_number;
            gradient += square * wave_number.powi(2);
            curvature += square * wave_number.powi(4);
        }
        let mean_wave_number = if height > 0.0 { slope / height } else { 0.0 };
        Amplitude {
            rms_height: height.sqrt(),
            rms_gradient: gradient.sqrt(),
            rms_curvature: curvature.sqrt(),
            mean_wave_number,
        }
    }

    /// Returns the elastic energy per area e_el in J/m² that flattens the roughness. By Persson and
    /// Tosatti (2001), e_el = (E*/8) Σ q_k A_k², where E* is the effective modulus in Pa. A_k and
    /// q_k are the amplitudes and the wave numbers of the waves of the profile.
    ///
    /// ```
    /// use asperity_surface::SelfAffine;
    /// use std::f64::consts::TAU;
    ///
    /// // A single wave: e_el = E* q h²/4.
    /// let wave = SelfAffine {
    ///     hurst: 0.5,
    ///     first: 1,
    ///     last: 1,
    ///     roll_off_mode: 0.0,
    /// }
    /// .unit_amplitude(1e-6)
    /// .scaled(1e-9);
    /// let expected = 1e6 * TAU / 1e-6 * 1e-18 / 4.0;
    /// assert!((wave.elastic_energy(1e6) / expected - 1.0).abs() < 1e-12);
    /// ```
    pub fn elastic_energy(&self, modulus: f64) -> f64 {
        modulus * self.rms_height.powi(2) * self.mean_wave_number / 4.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn integrals_stay_accurate_as_hurst_goes_to_one() {
        let spectrum = |hurst| SelfAffine {
            hurst,
            first: 1,
            last: 4096,
            roll_off_mode: 0.0,
        };
        let limit = spectrum(1.0).continuum_gradient_per_height(1.0);
        // For H = 1 the exact ratio follows from the integrals ∫dq/q = ln 4096 and ∫q⁻³dq = (1 −
        // 4096⁻²)/2.
        let exact =
            std::f64::consts::TAU * (4096_f64.ln() * 2.0 / (1.0 - 4096_f64.powi(-2))).sqrt();
        assert!((limit - exact).abs() < 4.0 * f64::EPSILON * exact);
        for distance in [1e-3, 1e-6, 1e-9, 1e-12, 1e-15] {
            let found = spectrum(1.0 - distance).continuum_gradient_per_height(1.0);
            // If H changes by 1, the logarithm of the ratio changes by about ln 4096.
            assert!(
                (found / limit - 1.0).abs() < 10.0 * distance + 1e-14,
                "{distance}: {found}"
            );
        }
    }

    #[test]
    fn the_elastic_energy_of_the_modes_is_that_of_the_spectrum() {
        let (modulus, height, length) = (2.0e6, 3.0e-7, 1.0e-3);
        for hurst in [0.1, 0.5, 0.9] {
            let spectrum = SelfAffine {
                hurst,
                first: 10_000,
                last: 400_000,
                roll_off_mode: 0.0,
            };
            let modes = spectrum
                .unit_amplitude(length)
                .scaled(height)
                .elastic_energy(modulus);
            // The energy of a surface is (E*/4) ∫ q C2D d²q, and its mean square height is ∫ C2D
            // d²q. Here C2D is proportional to q^(−2−2H).
            let q = |mode: u64| std::f64::consts::TAU * mode as f64 / length;
            let (low, high) = (q(spectrum.first), q(spectrum.last));
            let power = |exponent: f64| (high.powf(exponent) - low.powf(exponent)) / exponent;
            let expected = 0.25 * modulus * height.powi(2) * power(1.0 - 2.0 * hurst + 1e-9)
                / power(-2.0 * hurst);
            assert!(
                (modes / expected - 1.0).abs() < 2e-4,
                "H = {hurst}: {modes} against {expected}"
            );
            // The same elastic energy follows from κ. For waves that fit k times on the length,
            // e_el/γ = (κ²/4) S₁/√(S₀S₂) with S_j = Σ k^(j−1−2H) and κ² = E* h ⟨∇z⟩/γ.
            let sum = |j: i32| spectrum.moment(j);
            let kappa_squared = modulus * height.powi(2) * spectrum.gradient_per_height(length);
            let by_kappa = 0.25 * kappa_squared * sum(1) / (sum(0) * sum(2)).sqrt();
            assert!((modes / by_kappa - 1.0).abs() < 1e-14);
        }
    }

    #[test]
    fn below_the_roll_off_the_spectrum_of_the_surface_is_flat() {
        let (length, height) = (2e-4, 3e-7);
        for (hurst, first, last, roll_off) in [
            (0.3, 1, 500, 40.5),
            (0.8, 3, 4096, 700.0),
            (0.8, 3, 90, 90.0),
            (0.5, 7, 7, 7.4),
        ] {
            let spectrum = SelfAffine {
                hurst,
                first,
                last,
                roll_off_mode: roll_off,
            };
            // C2D is constant up to the roll-off q_r and proportional to q^(−2−2H) above it. The
            // squared amplitudes A² are proportional to C1D = π q C2D.
            let squares = (first..=last).rev().map(|mode| {
                let power = (mode as f64 / roll_off).max(1.0).powf(-2.0 - 2.0 * hurst);
                ModeSquare {
                    mode,
                    square: mode as f64 * power,
                }
            });
            let summed = Amplitude::from_modes(squares.clone(), length);
            let (expected, found) = (
                summed.scaled(height / summed.rms_height),
                spectrum.unit_amplitude(length).scaled(height),
            );
            let energies = [expected, found].map(|amplitude| amplitude.elastic_energy(2e6));
            for (one, other) in [
                (found.rms_gradient, expected.rms_gradient),
                (found.rms_curvature, expected.rms_curvature),
                (energies[1], energies[0]),
            ] {
                assert!(
                    (one / other - 1.0).abs() < 1e-12,
                    "{spectrum:?}: {one} {other}"
                );
            }
            let level = spectrum.relative_amplitude(first).powi(2) / (first as f64);
            for ModeSquare { mode, square } in squares {
                let square = square * level;
                let found = spectrum.relative_amplitude(mode).powi(2);
                let first_square = (first as f64 / roll_off).max(1.0).powf(-2.0 - 2.0 * hurst);
                assert!(
                    (found * first_square / square - 1.0).abs() < 1e-12,
                    "{spectrum:?}, mode {mode}"
                );
            }
            // The integrals over all wave numbers from the first to the last mode are computed by
            // the midpoint rule.
            let integral = |power: i32| -> f64 {
                let (low, step) = ((first as f64).ln(), (last as f64 / first as f64).ln() / 4e5);
                let values =
                    (0..400_000).map(|index| (low + (f64::from(index) + 0.5) * step).exp());
                values
                    .map(|q| q.powi(power + 2) * (q / roll_off).max(1.0).powf(-2.0 - 2.0 * hurst))
                    .sum()
            };
            let expected = TAU / length * (integral(2) / integral(0)).sqrt();
            let found = spectrum.continuum_gradient_per_height(length);
            assert!(
                first == last || (found / expected - 1.0).abs() < 1e-7,
                "{spectrum:?}: {found} {expected}"
            );
        }
        let flat = SelfAffine {
            hurst: 0.7,
            first: 4,
            last: 512,
            roll_off_mode: 4.0,
        };
        assert_eq!(
            flat.unit_amplitude(1.0),
            SelfAffine {
                roll_off_mode: 0.0,
                ..flat
            }
            .unit_amplitude(1.0)
        );
    }
}
