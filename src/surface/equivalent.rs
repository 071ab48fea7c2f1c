//! Equivalent line of a measured surface: its own spectrum, random phases.

use super::SurfaceError;
use super::{Amplitude, MeasuredProfile};
use crate::spectrum::{End, IsotropicSpectrum, Options, SpectrumError, analyse};
use crate::topography::{ReadOptions, Topography, Unit, read_observed};
use std::f64::consts::TAU;
use std::path::Path;

/// Share by which a wave may be longer than the scan, for want of digits.
const ROUNDING: f64 = 1.0e-9;

/// Choices of a scene for its measured surface.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MeasuredOptions {
    /// The profile itself is the line.
    pub as_line: bool,
    /// Unit of lengths where the file states none.
    pub unit: Option<Unit>,
    /// Shortest wavelength, m, down to which the spectrum continues as a power law.
    pub continue_to: Option<f64>,
}

/// A measured surface as the roughness of a line.
#[derive(Clone, Debug, PartialEq)]
pub enum MeasuredRoughness {
    /// The profile itself.
    Profile(MeasuredProfile),
    /// The equivalent line.
    Equivalent(EquivalentLine),
}

impl MeasuredRoughness {
    /// Reads a measured surface, with all bytes of the file shown to `seen`.
    ///
    /// # Errors
    /// [`SurfaceError::Measured`] when the file cannot be read, is no surface, or has no spectrum.
    pub fn read(
        path: &Path,
        options: &MeasuredOptions,
        seen: &mut dyn FnMut(&[u8]),
    ) -> Result<Self, SurfaceError> {
        Ok(if options.as_line {
            MeasuredRoughness::Profile(MeasuredProfile::read_observed(path, options.unit, seen)?)
        } else {
            MeasuredRoughness::Equivalent(EquivalentLine::read(path, options, seen)?)
        })
    }

    /// Checks that a line of a length (m) on so many springs can be made.
    ///
    /// # Errors
    /// The reason, in one line.
    pub fn check(&self, length: f64, points: usize) -> Result<(), String> {
        match self {
            MeasuredRoughness::Profile(profile) => profile.sample(length, 1, 0.0).map(drop),
            MeasuredRoughness::Equivalent(line) => line.modes(length, points).map(drop),
        }
    }
}

/// Equivalent line of a measured surface.
#[derive(Clone, Debug, PartialEq)]
pub struct EquivalentLine {
    spectrum: IsotropicSpectrum,
}

impl EquivalentLine {
    /// Line of a surface, tilt removed, whose spectrum ends at the last resolved wave or continues down to a wavelength,
    /// m.
    ///
    /// # Errors
    /// The reason for which the surface has no spectrum.
    pub fn new(surface: Topography, continue_to: Option<f64>) -> Result<Self, SpectrumError> {
        let end = continue_to.map_or(End::Ends, |wavelength| End::Continues(TAU / wavelength));
        let analysis = analyse(&[surface], &Options { end, ..Options::default() })?;
        Ok(EquivalentLine { spectrum: analysis.isotropic })
    }

    /// Reads a surface for its equivalent line, with all bytes of the file shown to `seen`.
    ///
    /// # Errors
    /// [`SurfaceError::Measured`] when the file cannot be read, is no surface, or has no spectrum.
    pub fn read(
        path: &Path,
        options: &MeasuredOptions,
        seen: &mut dyn FnMut(&[u8]),
    ) -> Result<Self, SurfaceError> {
        let reading = ReadOptions { unit: options.unit, ..ReadOptions::default() };
        let surface =
            read_observed(path, &reading, seen).map_err(|error| SurfaceError::measured(path, &error))?;
        EquivalentLine::new(surface, options.continue_to)
            .map_err(|error| SurfaceError::measured(path, &error))
    }

    /// First and last mode k, q = 2πk/L, of a line of a length (m) on so many springs: the waves of the spectrum that the
    /// line holds and the springs resolve. Waves longer than the scan are unknown and left out.
    ///
    /// # Errors
    /// When there is none.
    pub fn modes(&self, length: f64, points: usize) -> Result<(u64, u64), String> {
        let [low, high] = self.spectrum.range();
        let waves = length / TAU;
        let first = (low * waves * (1.0 - ROUNDING)).ceil().max(1.0);
        let last = (high * waves * (1.0 + ROUNDING)).floor().min((points / 2) as f64);
        if first > last {
            return Err(format!(
                "no wave of the spectrum, from {:e} to {:e} m, fits on length = {length:e} m with numerics.points = \
                 {points}; allowed: at least 2 springs for each of at least one wave",
                TAU / high,
                TAU / low
            ));
        }
        Ok((first as u64, last as u64))
    }

    /// Amplitude A_k, m, of a mode of a line of a length (m): A_k² = 4 C_line(q_k)/L.
    #[must_use]
    pub fn amplitude(&self, mode: u64, length: f64) -> f64 {
        // The last wave may be beyond the end by rounding alone.
        let wave_number = (TAU * mode as f64 / length).min(self.spectrum.range()[1]);
        2.0 * (self.spectrum.line(wave_number) / length).sqrt()
    }

    /// Amplitude of the modes from a first to a last one on a length (m).
    #[must_use]
    pub fn amplitude_of_modes(&self, length: f64, (first, last): (u64, u64)) -> Amplitude {
        let squares = |mode: u64| (mode, 0.5 * self.amplitude(mode, length).powi(2));
        // From the smallest amplitudes on.
        Amplitude::from_modes((first..=last).rev().map(squares), length)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::Synthesizer;
    use crate::topography::parse;

    fn surface() -> Topography {
        let height =
            |i: u32| (0..60).map(|k| f64::from(i * k * k + 7 * k).sin() / f64::from(1 + k)).sum::<f64>();
        let text: String = (0..256).map(|i| format!("{i} {}\n", height(i))).collect();
        parse(format!("x [um] z [nm]\n{text}").as_bytes(), &ReadOptions::default()).unwrap()
    }

    #[test]
    fn the_line_has_the_waves_that_scan_and_springs_resolve() {
        let line = EquivalentLine::new(surface(), None).unwrap();
        let scan = 256e-6;
        assert_eq!(line.modes(scan, 1024).unwrap(), (1, 127));
        assert_eq!(line.modes(scan, 64).unwrap(), (1, 32));
        assert_eq!(line.modes(4.0 * scan, 4096).unwrap().0, 4);
        assert!(line.modes(scan, 1).unwrap_err().contains("allowed: at least 2 springs"));
        assert!(line.modes(1e-6, 64).unwrap_err().contains("no wave of the spectrum"));
        let longer = EquivalentLine::new(surface(), Some(0.5e-6)).unwrap();
        assert_eq!(longer.modes(scan, 1024).unwrap(), (1, 512));
    }

    #[test]
    fn the_line_has_the_moments_of_its_spectrum() {
        let line = EquivalentLine::new(surface(), None).unwrap();
        let analysis = analyse(&[surface()], &Options::default()).unwrap();
        let length = 256e-6;
        let modes = line.modes(length, 4096).unwrap();
        let Amplitude { rms_height: height, rms_gradient: gradient, .. } =
            line.amplitude_of_modes(length, modes);
        // Sums of modes for integrals.
        assert!((height / analysis.line.rms_height.value - 1.0).abs() < 0.02, "{height}");
        assert!((gradient / analysis.line.rms_gradient.value - 1.0).abs() < 0.02, "{gradient}");
        let amplitude = |mode: u64| line.amplitude(mode, length);
        let waves =
            Synthesizer::default().synthesize_waves(&amplitude, modes, 5, 4096, 0.0, Vec::new()).unwrap();
        let rms = (waves.iter().map(|z| z * z).sum::<f64>() / 4096.0).sqrt();
        assert!((rms / height - 1.0).abs() < 1e-12, "{rms} {height}");
    }
}
