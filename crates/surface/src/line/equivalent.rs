//! The equivalent line of measured surfaces: its modes, their amplitudes, and its moments.

use super::measured::{Face, MeasuredOptions, MeasuredProfile, TRANSFORM_BYTES};
use super::roughness::Synthesizer;
use super::spectrum::{Amplitude, ModeRange, ModeSquare};
use crate::error::{Place, SurfaceError, refused};
use crate::spectrum::analysis::Analysis;
use crate::spectrum::isotropic::IsotropicSpectrum;
use crate::spectrum::moments::{LineMoments, line_moments};
use asperity_data::check_room;
use std::f64::consts::TAU;

/// Relative excess of a wavelength over the length of the line up to which it counts as a rounding
/// error.
const ROUNDING: f64 = 1.0e-9;

/// Equivalent line of measured surfaces: a random rigid profile whose spectrum follows from the
/// measured spectra. A contact has two faces, the surfaces that touch each other. If both faces are
/// measured, the line has the sum of their spectra.
///
/// ```
/// use asperity_surface::{AnalysisOptions, EquivalentLine, Topography, analyse};
///
/// let height = |i: u32| {
///     (1..60)
///         .map(|k| f64::from(i * k * k + 7 * k).sin() / f64::from(k))
///         .sum::<f64>()
/// };
/// let heights: Vec<f64> = (0..256).map(|i| 3e-8 * height(i)).collect();
/// let surface = Topography::from_profile(&heights, 1e-6)?;
/// let line = EquivalentLine::from(&analyse(&[surface], &AnalysisOptions::default())?);
/// // A random profile has the rms height of the line.
/// let square = line
///     .heights(2.56e-4, 1024, 7)?
///     .iter()
///     .map(|z| z * z)
///     .sum::<f64>()
///     / 1024.0;
/// assert!((square.sqrt() / line.moments().rms_height.value - 1.0).abs() < 0.05);
/// # Ok::<(), asperity_surface::SurfaceError>(())
/// ```
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct EquivalentLine {
    /// Spectrum of each measured [face](crate::lines::Face). A face is one of the two surfaces that
    /// touch each other in the contact.
    pub faces: Vec<IsotropicSpectrum>,
}

impl From<&Analysis> for EquivalentLine {
    fn from(face: &Analysis) -> Self {
        EquivalentLine {
            faces: vec![face.isotropic.clone()],
        }
    }
}

impl EquivalentLine {
    /// Creates the equivalent line from measured files, by an analysis of the surfaces in these
    /// files. `faces` has the files of one or two [faces](crate::lines::Face), which are the
    /// surfaces that touch each other.
    ///
    /// # Errors
    /// Returns [`SurfaceError`] for a face without a file, and for a file that holds no surface or
    /// has no spectrum.
    pub fn new(faces: &[Face], options: &MeasuredOptions) -> Result<Self, SurfaceError> {
        let mut spectra = Vec::new();
        for face in faces {
            spectra.push(options.analyse(face)?.isotropic);
        }
        Ok(EquivalentLine { faces: spectra })
    }

    /// Computes the heights in m of a random profile of the length `length` in m. The heights are
    /// at the middles of `points` equal cells. `seed` determines the random phases of the waves.
    ///
    /// # Errors
    /// Returns an error if no wave of the spectrum fits the length and is resolved by the points,
    /// or if the memory is too small.
    pub fn heights(&self, length: f64, points: usize, seed: u64) -> Result<Vec<f64>, SurfaceError> {
        let modes = self.modes(length, points)?;
        check_room(TRANSFORM_BYTES * points as u64).map_err(SurfaceError::of_springs)?;
        let amplitude = |mode: u64| self.amplitude(mode, length);
        Synthesizer::default().synthesize_waves(&amplitude, modes, seed, points, 0.0, Vec::new())
    }

    /// Returns an equivalent line whose spectrum is changed at random by about its errors. For each
    /// face, an error of the spectrum is drawn from the distribution of the errors of the fit, and
    /// multiplied by `share`. `number` is the seed of the random numbers: equal seeds give equal
    /// errors.
    pub fn drawn(&self, number: u64, share: f64) -> EquivalentLine {
        let mut faces = Vec::new();
        for (index, spectrum) in (0_u64..).zip(&self.faces) {
            // Each face gets a seed of its own, because the errors of two faces are independent.
            let number_of_face = number ^ index.rotate_right(1);
            faces.push(spectrum.drawn(number_of_face, share));
        }
        EquivalentLine { faces }
    }

    /// Computes the moments of this equivalent line, such as the rms height, with their standard
    /// errors.
    pub fn moments(&self) -> LineMoments {
        line_moments(&self.faces)
    }

    /// Returns the power spectral density (PSD) in m³ of this equivalent line at a wave number in
    /// rad/m.
    pub fn power(&self, wave_number: f64) -> f64 {
        self.faces.iter().map(|face| face.line(wave_number)).sum()
    }

    /// Returns the first and the last wave number of this equivalent line in rad/m. Each face, one
    /// of the two surfaces that touch each other, has a spectrum over its own range of wave
    /// numbers. The first wave number is the smallest one that all these ranges contain. The last
    /// one is the largest wave number of any face.
    pub fn range(&self) -> [f64; 2] {
        let mut first = 0.0_f64;
        let mut last = 0.0_f64;
        for face in &self.faces {
            let [low, high] = face.range();
            first = first.max(low);
            last = last.max(high);
        }
        [first, last]
    }

    /// Returns the first and the last mode of a line of the length L = `length` in m on `points`
    /// springs. Mode k is the wave with k periods on the length and the wave number q = 2πk/L. The
    /// modes are those waves of the spectrum that are no longer than the line and that the springs
    /// resolve. Returns an error if there is no such wave.
    pub fn modes(&self, length: f64, points: usize) -> Result<ModeRange, SurfaceError> {
        let [low, high] = self.range();
        let waves = length / TAU;
        let first = (low * waves * (1.0 - ROUNDING)).ceil().max(1.0);
        let last = (high * waves * (1.0 + ROUNDING))
            .floor()
            .min((points / 2) as f64);
        if first > last {
            let longest = TAU / low;
            let shortest = TAU / high;
            let found = format!(
                "no wave of the spectrum, from {shortest:e} to {longest:e} m, fits on length = \
                 {length:e} m with numerics.points = {points}"
            );
            let allowed = "at least 2 springs for each of at least one wave";
            return Err(refused(Place::File, found, allowed));
        }
        Ok(ModeRange {
            first: first as u64,
            last: last as u64,
        })
    }

    /// Returns the same line without its short waves. These are the waves whose wave numbers exceed
    /// `wave_number` in rad/m.
    pub fn up_to(&self, wave_number: f64) -> EquivalentLine {
        EquivalentLine {
            faces: self
                .faces
                .iter()
                .map(|face| face.up_to(wave_number))
                .collect(),
        }
    }

    /// Returns the amplitude A_k in m of mode k = `mode` on a line of the length L = `length` in m.
    /// Mode k is the wave with k periods on this length. A_k² = 4 C(q_k)/L, where C is the result
    /// of [`EquivalentLine::power`] and q_k = 2πk/L is the wave number.
    pub fn amplitude(&self, mode: u64, length: f64) -> f64 {
        self.squared_amplitude(mode as f64, length).sqrt()
    }

    /// Returns the mean square height in m² that one wave contributes to a square surface with the
    /// measured spectra. `side` is the side of the square in m. `waves` is the number of periods of
    /// the wave on this side, and need not be a whole number. Returns 0 if the wave lies outside
    /// the measured spectra.
    pub fn variance_of_surface(&self, waves: f64, side: f64) -> f64 {
        let [first, last] = self.range().map(|wave_number| wave_number * side / TAU);
        if waves < first - 0.5 || waves > last + 0.5 {
            return 0.0;
        }
        self.squared_amplitude(waves.min(last), side) / (2.0 * TAU * waves)
    }

    fn squared_amplitude(&self, waves: f64, length: f64) -> f64 {
        let wave_number = TAU * waves / length;
        let mut power = 0.0;
        for face in &self.faces {
            let [_, end] = face.range();
            // Because of a rounding error, the last wave number of a line may exceed the end of the
            // spectrum.
            let is_at_end = wave_number <= end * (1.0 + ROUNDING);
            power += if is_at_end {
                face.line(wave_number.min(end))
            } else {
                face.line(wave_number)
            };
        }
        4.0 * power / length
    }

    /// Computes the rms height, the rms gradient and the rms curvature of a line of the length
    /// `length` in m that has only the modes `modes`. A mode is a wave with a whole number of
    /// periods on this length.
    pub fn amplitude_of_modes(&self, length: f64, modes: ModeRange) -> Amplitude {
        let square = |mode: u64| ModeSquare {
            mode,
            square: 0.5 * self.amplitude(mode, length).powi(2),
        };
        // The sum starts with the smallest amplitudes, so that its rounding error is small.
        let modes = (modes.first..=modes.last).rev();
        Amplitude::from_modes(modes.map(square), length)
    }
}

/// Roughness of a rigid profile that comes from measured surfaces.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub enum MeasuredRoughness {
    /// Profile in the file that is used unchanged as the rigid profile, because the profile is
    /// already an equivalent line.
    Profile(MeasuredProfile),
    /// Equivalent line of the measured surfaces, which is used as the rigid profile.
    Equivalent(EquivalentLine),
}

impl MeasuredRoughness {
    /// Reads measured files and, if needed, analyses their surfaces. `faces` has the files of one
    /// or two [faces](crate::lines::Face), the surfaces that touch each other.
    ///
    /// If [`MeasuredOptions::as_line`] is given and there is only one file, the profile in this
    /// file is the rigid profile. Otherwise the rigid profile is the equivalent line of the faces.
    ///
    /// # Errors
    /// Returns an error if a file holds no surface, or if its surface has no spectrum.
    pub fn new(faces: &[Face], options: &MeasuredOptions) -> Result<Self, SurfaceError> {
        if let [face] = faces
            && let [(path, content)] = &face[..]
            && options.as_line.is_some()
        {
            let profile = MeasuredProfile::new(content, options);
            let profile = profile.map_err(|error| error.in_measured(path))?;
            return Ok(MeasuredRoughness::Profile(profile));
        }
        EquivalentLine::new(faces, options).map(MeasuredRoughness::Equivalent)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spectrum::moments::Moment;
    use crate::spectrum::nodes::End;
    use crate::spectrum::options::AnalysisOptions;
    use std::path::PathBuf;

    fn face() -> Face {
        let height = |i: u32| {
            (0..120)
                .map(|k| f64::from(i * k * k + 7 * k).sin() / f64::from(1 + k))
                .sum::<f64>()
        };
        let text: String = (0..256).map(|i| format!("{i} {}\n", height(i))).collect();
        vec![(
            PathBuf::new(),
            format!("x [um] z [nm]\n{text}").into_bytes(),
        )]
    }

    fn continued() -> MeasuredOptions {
        let spectrum = AnalysisOptions {
            end: End::Continues(TAU / 0.5e-6),
            ..AnalysisOptions::default()
        };
        MeasuredOptions {
            spectrum,
            ..MeasuredOptions::default()
        }
    }

    fn line_with(options: &MeasuredOptions) -> EquivalentLine {
        EquivalentLine::new(&[face()], options).unwrap()
    }

    /// The mean squares of the waves of a surface, added over all directions, give the mean square
    /// height of its equivalent line.
    #[test]
    fn a_surface_has_the_rms_height_of_its_line() {
        let side = 256e-6;
        let line = line_with(&continued()).up_to(64.0 * TAU / side);
        let modes = line.modes(side, 4096).unwrap();
        assert_eq!((modes.first, modes.last), (1, 64));
        let of_line = line.amplitude_of_modes(side, modes).rms_height.powi(2);
        let waves = (-70..=70_i32)
            .flat_map(|x| (-70..=70_i32).map(move |y| f64::from(x).hypot(f64::from(y))));
        let of_surface: f64 = waves
            .filter(|k| *k > 0.0)
            .map(|k| line.variance_of_surface(k, side))
            .sum();
        assert!(
            (of_surface / of_line - 1.0).abs() < 0.1,
            "{of_surface} {of_line}"
        );
    }

    #[test]
    fn the_line_has_the_waves_that_scan_and_springs_resolve() {
        let line = line_with(&MeasuredOptions::default());
        let scan = 256e-6;
        let modes = |first: u64, last: u64| ModeRange { first, last };
        assert_eq!(line.modes(scan, 1024).unwrap(), modes(1, 127));
        assert_eq!(line.modes(scan, 64).unwrap(), modes(1, 32));
        assert_eq!(line.modes(4.0 * scan, 4096).unwrap().first, 4);
        assert!(
            line.modes(scan, 1)
                .unwrap_err()
                .to_string()
                .contains("allowed: at least 2 springs")
        );
        assert!(
            line.modes(1e-6, 64)
                .unwrap_err()
                .to_string()
                .contains("no wave of the spectrum")
        );
        let further = continued();
        let longer = line_with(&further);
        assert_eq!(longer.modes(scan, 1024).unwrap(), modes(1, 512));
    }

    #[test]
    fn spectra_of_two_faces_add() {
        let further = continued();
        let one = line_with(&MeasuredOptions::default());
        let other = line_with(&further);
        let faces = |one: &EquivalentLine, other: &EquivalentLine| EquivalentLine {
            faces: [one.faces.as_slice(), &other.faces].concat(),
        };
        let both = faces(&one, &other);
        let length = 256e-6;
        let modes = both.modes(length, 4096).unwrap();
        assert_eq!((modes.first, modes.last), (1, 512));
        for mode in [1, 127, 128, 512] {
            let [a, b, sum] =
                [&one, &other, &both].map(|line| line.amplitude(mode, length).powi(2));
            assert!(
                (sum - a - b).abs() <= 1e-12 * sum && sum > 0.0,
                "{mode}: {a} {b} {sum}"
            );
            assert_eq!(a == 0.0, mode > 127, "{mode}");
        }
        // The squares of the moments of two scans add up, over the waves that both scans have.
        let [one, other, both] = [&one, &other, &both].map(|line| line.moments());
        let squares = |a: Moment, b: Moment, sum: Moment| {
            assert!(
                (sum.value.powi(2) / (a.value.powi(2) + b.value.powi(2)) - 1.0).abs() < 1e-12,
                "{sum:?}"
            );
            let error = (a.value * a.error).hypot(b.value * b.error) / sum.value;
            assert!((sum.error / error - 1.0).abs() < 1e-9, "{sum:?} {error}");
        };
        squares(one.rms_height, other.rms_height, both.rms_height);
        squares(one.rms_gradient, other.rms_gradient, both.rms_gradient);
        let energies = [one, other, both].map(|moments| moments.energy_per_modulus);
        assert!((energies[2].value / (energies[0].value + energies[1].value) - 1.0).abs() < 1e-12);
        assert!(
            (energies[2].error / energies[0].error.hypot(energies[1].error) - 1.0).abs() < 1e-9
        );
        assert!(EquivalentLine::new(&[Vec::new()], &further).is_err());
    }
}
