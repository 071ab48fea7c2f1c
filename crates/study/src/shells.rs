//! Roughness of random square surfaces. The waves of a square surface are grouped in shells by
//! their wave number. Each shell has the variance of one mode of the profile (line).

use asperity_surface::{EquivalentLine, SelfAffine};
use serde::Serialize;
use std::f64::consts::TAU;

/// Roughness of the profiles or of the square surfaces of a comparison, computed from their waves.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ComparedRoughness {
    /// Root mean square height h in m.
    pub rms_height: f64,
    /// Root mean square gradient ⟨∇z⟩, a number without a unit.
    pub rms_gradient: f64,
    /// Elastic energy e_el per area in J/m² that flattens the roughness.
    pub elastic_energy: f64,
}

impl ComparedRoughness {
    /// Returns the roughness after all heights are multiplied by a factor.
    pub fn scaled(self, factor: f64) -> ComparedRoughness {
        ComparedRoughness {
            rms_height: factor * self.rms_height,
            rms_gradient: factor * self.rms_gradient,
            elastic_energy: factor * factor * self.elastic_energy,
        }
    }
}

/// Spectrum of the roughness of a scene.
#[derive(Clone, Debug)]
pub(super) enum Spectrum {
    /// Self-affine spectrum.
    SelfAffine {
        spectrum: SelfAffine,
        /// Amplitude A₁ in m of the longest wave that fits on the side, if the spectrum had no
        /// roll-off.
        amplitude: f64,
    },
    /// Spectrum of a measured surface, given by its equivalent line (profile).
    Measured(EquivalentLine),
}

impl Spectrum {
    /// Returns the mean square height A_k²/2, in m², of mode k of a line with the length `side` in
    /// m.
    fn variance_of_line(&self, mode: u64, side: f64) -> f64 {
        let amplitude = match self {
            Spectrum::SelfAffine {
                spectrum,
                amplitude,
            } => amplitude * spectrum.relative_amplitude(mode),
            Spectrum::Measured(line) => line.amplitude(mode, side),
        };
        0.5 * amplitude * amplitude
    }

    /// Returns the mean square height, in m², of one wave of a surface with this spectrum. `waves`
    /// is the number of periods of the wave over the side of the surface.
    fn variance_of_surface(&self, waves: f64, side: f64) -> f64 {
        match self {
            Spectrum::SelfAffine {
                spectrum,
                amplitude,
            } => amplitude * amplitude * spectrum.relative_variance_of_surface(waves),
            Spectrum::Measured(line) => line.variance_of_surface(waves, side),
        }
    }
}

/// Waves of a random square surface. A square of the side L has waves with whole numbers of periods
/// along both sides, so only few waves have nearly the wave number of a mode of the line (profile).
/// Shell k consists of the waves that have k − ½ to k + ½ periods over a length L in their own
/// direction. Within a shell, the variances of the spectrum are multiplied by a factor with which
/// their sum equals the variance A_k²/2 of mode k. Square and line then have the same rms height.
///
/// Within a shell the variances are also multiplied by 1/|k|, where |k| is the wave number. The
/// reason is that most waves of the first shells are shorter than the mode of their shell, and
/// 1/|k| reduces their share. With this factor, the elastic energy that flattens modes 1 to 8
/// exceeds that of the line by 4 to 5 %; without it, by 4 to 7 %.
#[derive(Clone, Debug)]
pub(super) struct Shells {
    spectrum: Spectrum,
    /// Side of the square in m.
    side: f64,
    /// Numbers of the first and the last mode of the line.
    modes: (u64, u64),
    /// Factor of the variances in each shell, from the first mode to the last.
    factors: Vec<f64>,
}

impl Shells {
    pub fn new(spectrum: Spectrum, side: f64, modes: (u64, u64)) -> Shells {
        let mut shells = Shells {
            spectrum,
            side,
            modes,
            factors: Vec::new(),
        };
        let mut sums = vec![0.0; (modes.1 - modes.0 + 1) as usize];
        shells.for_each_wave(|shell, waves, shells| {
            sums[shell] += shells.variance_before_scaling(waves);
        });
        for (mode, sum) in (modes.0..=modes.1).zip(sums) {
            let variance = shells.spectrum.variance_of_line(mode, side);
            // If the spectrum has no wave in a shell, this shell remains empty.
            let factor = if sum > 0.0 { variance / sum } else { 0.0 };
            shells.factors.push(factor);
        }
        shells
    }

    /// Calls a function for each wave with two numbers: the index of its shell, counted from the
    /// first mode, and the number of its periods over the side.
    fn for_each_wave(&self, mut call: impl FnMut(usize, f64, &Shells)) {
        let most = self.modes.1 as i64 + 1;
        // The loops pass a quarter of all waves. The other waves are found by turning this quarter
        // by 90°.
        for y in 0..=most {
            for x in 1..=most {
                let waves = (x as f64).hypot(y as f64);
                if let Some(shell) = self.shell(waves) {
                    for _ in 0..4 {
                        call(shell, waves, self);
                    }
                }
            }
        }
    }

    /// Returns the index of the shell of a wave, counted from the first mode; `None` if the square
    /// surface does not have this wave.
    fn shell(&self, waves: f64) -> Option<usize> {
        // No wave lies exactly between two shells: the square of k + ½ is not a whole number, but
        // the squared number of periods is.
        let mode = waves.round() as u64;
        let (first, last) = self.modes;
        (first..=last)
            .contains(&mode)
            .then(|| (mode - first) as usize)
    }

    /// Returns the mean square height in m² that one wave contributes to the square surface.
    /// `waves` is the number of periods of this wave over the side of the square.
    pub fn variance(&self, waves: f64) -> f64 {
        match self.shell(waves) {
            Some(shell) => self.factors[shell] * self.variance_before_scaling(waves),
            None => 0.0,
        }
    }

    fn variance_before_scaling(&self, waves: f64) -> f64 {
        self.spectrum.variance_of_surface(waves, self.side) / waves
    }

    /// Returns the roughness of the square surface. `modulus` is the effective modulus in Pa.
    pub fn roughness(&self, modulus: f64) -> ComparedRoughness {
        let mut height = 0.0;
        let mut slope = 0.0;
        let mut gradient = 0.0;
        self.for_each_wave(|_, waves, shells| {
            let variance = shells.variance(waves);
            let wave_number = TAU * waves / shells.side;
            height += variance;
            slope += variance * wave_number;
            gradient += variance * wave_number * wave_number;
        });
        ComparedRoughness {
            rms_height: height.sqrt(),
            rms_gradient: gradient.sqrt(),
            elastic_energy: 0.25 * modulus * slope,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use asperity_half_space::random_map;

    const SIDE: f64 = 3e-4;
    const MODULUS: f64 = 2e6;

    fn self_affine(hurst: f64, first: u64, last: u64, roll_off_mode: f64) -> SelfAffine {
        SelfAffine {
            hurst,
            first,
            last,
            roll_off_mode,
        }
    }

    /// A square surface has the same rms height as the line, and nearly the same rms gradient and
    /// elastic energy.
    #[test]
    fn a_square_is_as_rough_as_the_line() {
        let height = 4e-7;
        let spectra = [
            self_affine(0.2, 1, 4, 0.0),
            self_affine(0.3, 1, 8, 0.0),
            self_affine(0.5, 2, 8, 0.0),
            self_affine(0.5, 3, 3, 0.0),
            self_affine(0.8, 1, 8, 0.0),
            self_affine(0.8, 1, 16, 0.0),
            self_affine(0.8, 4, 8, 0.0),
            self_affine(0.98, 2, 5, 0.0),
            self_affine(0.98, 1, 16, 0.0),
            self_affine(0.7, 1, 64, 6.5),
            self_affine(0.4, 4, 4, 0.0),
            self_affine(0.6, 30, 128, 0.0),
        ];
        for spectrum in spectra {
            let amplitude = height / spectrum.relative_rms();
            let modes = (spectrum.first, spectrum.last);
            let shells = Shells::new(
                Spectrum::SelfAffine {
                    spectrum,
                    amplitude,
                },
                SIDE,
                modes,
            );
            let line = spectrum.unit_amplitude(SIDE).scaled(height);
            let square = shells.roughness(MODULUS);
            assert!(
                (square.rms_height / height - 1.0).abs() < 1e-12,
                "{spectrum:?}: {square:?}"
            );
            let gradient = square.rms_gradient / line.rms_gradient;
            assert!(
                (0.99..1.055).contains(&gradient),
                "{spectrum:?}: gradient {gradient}"
            );
            let energy = square.elastic_energy / line.elastic_energy(MODULUS);
            assert!(
                (0.985..1.06).contains(&energy),
                "{spectrum:?}: energy {energy}"
            );
        }
    }

    /// The computed roughness agrees with the roughness of the heights. The gradients of the
    /// heights are taken as differences on a fine grid.
    #[test]
    fn the_heights_have_the_stated_roughness() {
        let cells = 256;
        for (hurst, first, last) in [(0.3, 1, 8), (0.8, 1, 4), (0.8, 2, 8), (0.5, 3, 3)] {
            let spectrum = self_affine(hurst, first, last, 0.0);
            let amplitude = 1e-7;
            let shells = Shells::new(
                Spectrum::SelfAffine {
                    spectrum,
                    amplitude,
                },
                SIDE,
                (first, last),
            );
            let heights = random_map(cells, |waves| shells.variance(waves), 11).unwrap();
            let mut square_height = 0.0;
            let mut square_gradient = 0.0;
            for row in 0..cells {
                for column in 0..cells {
                    let here = heights[row * cells + column];
                    let beside = heights[row * cells + (column + 1) % cells];
                    let below = heights[(row + 1) % cells * cells + column];
                    square_height += here * here;
                    square_gradient += (beside - here).powi(2) + (below - here).powi(2);
                }
            }
            let count = (cells * cells) as f64;
            let rms_height = (square_height / count).sqrt();
            let rms_gradient = (square_gradient / count).sqrt() * cells as f64 / SIDE;
            let stated = shells.roughness(MODULUS);
            let line = amplitude * spectrum.relative_rms();
            assert!(
                (rms_height / line - 1.0).abs() < 1e-9,
                "{hurst}: {rms_height} {line}"
            );
            assert!(
                (stated.rms_height / line - 1.0).abs() < 1e-12,
                "{hurst}: {stated:?}"
            );
            assert!(
                (rms_gradient / stated.rms_gradient - 1.0).abs() < 4e-3,
                "{rms_gradient} {stated:?}"
            );
        }
    }

    #[test]
    fn a_square_has_no_other_waves() {
        let spectrum = self_affine(0.8, 2, 5, 0.0);
        let shells = Shells::new(
            Spectrum::SelfAffine {
                spectrum,
                amplitude: 1e-7,
            },
            SIDE,
            (2, 5),
        );
        assert!(
            [1.0, 2.0_f64.sqrt(), 30.5_f64.sqrt(), 6.0]
                .iter()
                .all(|waves| shells.variance(*waves) == 0.0)
        );
        assert!(
            [2.0, 8.0_f64.sqrt(), 5.0, 29.0_f64.sqrt()]
                .iter()
                .all(|waves| shells.variance(*waves) > 0.0)
        );
        let halved = shells.roughness(MODULUS).scaled(0.5);
        assert_eq!(
            halved.elastic_energy,
            0.25 * shells.roughness(MODULUS).elastic_energy
        );
    }
}
