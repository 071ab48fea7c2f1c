//! Heights of the roughness of a scene, random or measured.

use super::outcome::RunError;
use crate::analysis::premises::MeasuredFacts;
use crate::scene::fields::MOST_POINTS;
use crate::scene::model::{SPRINGS_PER_WAVE, Scene};
use asperity_surface::lines::{
    MeasuredOptions, MeasuredProfile, MeasuredRoughness, ModeRange, Synthesizer, read_faces,
};
use asperity_surface::{Amplitude, EquivalentLine, SelfAffine, SurfaceError};
use std::f64::consts::TAU;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The longest waves of a measured spectrum are the waves that together have this share of the mean
/// squared height.
const LONG_WAVES: f64 = 0.1;

/// Waves count as long if at most this number of them fits on a scan.
const LONG_WAVES_PER_SCAN: f64 = 4.0;

/// Key of a roughness: everything that determines its heights.
#[derive(Clone, PartialEq)]
pub(super) struct RoughnessKey {
    source: Source,
    seed: u64,
    points: usize,
    shift: f64,
}

/// Source of a roughness.
#[derive(Clone, PartialEq)]
enum Source {
    SelfAffine(SelfAffine),
    /// Paths of the files of each face of the contact (the rough body, and the opposite body if it
    /// has a file), and the length of the profile in m.
    Measured {
        faces: Vec<Vec<PathBuf>>,
        options: MeasuredOptions,
        length: f64,
    },
}

/// Heights of a roughness before they are scaled, with facts about the roughness.
pub(super) struct Rough {
    pub key: RoughnessKey,
    /// Heights of the roughness: in units of the rms height if the roughness is self-affine, and in
    /// m if it is measured. The list is empty if its memory has been reused for the gaps of the
    /// profile.
    pub heights: Vec<f64>,
    /// Rms height, gradient and curvature of the self-affine profile, after it is scaled to an rms
    /// height of 1 m and a length of 1 m; `None` for any other roughness.
    pub unit: Option<Amplitude>,
    /// Rms height, gradient and curvature of a measured surface; `None` for any other roughness.
    pub measured: Option<Amplitude>,
    /// First and last mode of a random profile, as numbers of waves on its length; `None` for a
    /// profile that is not random.
    pub modes: Option<ModeRange>,
    /// Facts about a measured surface and the profile made from it; `None` without a measured
    /// surface.
    pub facts: Option<MeasuredFacts>,
}

/// Spectrum that was estimated from measured files, with the files and options that determine it.
pub(super) struct KeptSpectrum {
    /// Paths of the files of each face of the contact: the rough body, and the opposite body if it
    /// has a file.
    faces: Vec<Vec<PathBuf>>,
    options: MeasuredOptions,
    pub surface: Arc<MeasuredRoughness>,
}

/// Makes the heights of roughnesses. Values that several roughnesses have in common are stored, so
/// that they are computed only once.
#[derive(Default)]
pub(super) struct RoughnessMaker {
    /// Folder to which the names of files in scenes are relative.
    pub folder: PathBuf,
    /// A measured surface in memory, which is used instead of the files that scenes name. `None` if
    /// these files are read.
    pub measured: Option<Arc<MeasuredRoughness>>,
    /// Spectrum of the measured files that were read last; `None` if no files have been read. It
    /// needs little memory and does not depend on the seed.
    pub equivalent: Option<KeptSpectrum>,
    pub synthesizer: Synthesizer,
    /// Number of random phases drawn so far.
    pub phases_drawn: u64,
}

impl RoughnessMaker {
    /// Returns all values on which the roughness of a scene depends. Two scenes with equal keys
    /// have the same roughness. Returns `None` without roughness.
    pub fn key(&self, scene: &Scene) -> Option<RoughnessKey> {
        let points = scene.numerics.points as usize;
        let shift = scene
            .form
            .as_ref()
            .map_or(0.0, |form| form.shift(points as u64));
        scene.roughness.as_ref()?;
        let source = match scene.spectrum() {
            Some(spectrum) => Source::SelfAffine(spectrum),
            None => Source::Measured {
                faces: scene.measured_paths(&self.folder),
                options: scene.measured_options(),
                length: scene.length,
            },
        };
        Some(RoughnessKey {
            source,
            seed: scene.seed().unwrap_or(0),
            points,
            shift,
        })
    }

    /// Makes the heights of the roughness with this key. Random heights are written into the memory
    /// `memory`.
    ///
    /// # Errors
    /// Returns an error if a measured file cannot be read or analysed, or if the memory does not
    /// suffice.
    pub fn make(&mut self, key: RoughnessKey, memory: Vec<f64>) -> Result<Rough, RunError> {
        match &key.source {
            Source::SelfAffine(spectrum) => {
                let spectrum = *spectrum;
                self.make_self_affine(key, spectrum, memory)
            }
            Source::Measured {
                faces,
                options,
                length,
            } => {
                let length = *length;
                let file = faces.iter().flatten().next().cloned().unwrap_or_default();
                let surface = self.surface(faces, options)?;
                match &*surface {
                    MeasuredRoughness::Profile(profile) => cut_profile(key, profile, length, &file),
                    MeasuredRoughness::Equivalent(line) => {
                        self.make_measured(key, line, length, &file, memory)
                    }
                }
            }
        }
    }

    fn make_self_affine(
        &mut self,
        key: RoughnessKey,
        spectrum: SelfAffine,
        memory: Vec<f64>,
    ) -> Result<Rough, RunError> {
        let heights = self
            .synthesizer
            .synthesize(spectrum, key.seed, key.points, key.shift, memory)?;
        self.phases_drawn += spectrum.last + 1 - spectrum.first;
        Ok(Rough {
            key,
            heights,
            unit: Some(spectrum.unit_amplitude(1.0)),
            measured: None,
            modes: Some(ModeRange {
                first: spectrum.first,
                last: spectrum.last,
            }),
            facts: None,
        })
    }

    /// Makes random heights with the spectrum of a measured surface. `file` is the first file of
    /// the surface.
    fn make_measured(
        &mut self,
        key: RoughnessKey,
        line: &EquivalentLine,
        length: f64,
        file: &Path,
        memory: Vec<f64>,
    ) -> Result<Rough, RunError> {
        let modes = line
            .modes(length, key.points)
            .map_err(|error| error.in_measured(file))?;
        let heights = self.synthesizer.synthesize_waves(
            &|mode| line.amplitude(mode, length),
            modes,
            key.seed,
            key.points,
            key.shift,
            memory,
        )?;
        self.phases_drawn += modes.last + 1 - modes.first;
        let amplitude = line.amplitude_of_modes(length, modes);
        let scan = TAU / line.range()[0];
        let facts = MeasuredFacts {
            scan,
            long_wave_share: long_wave_share(
                line,
                length,
                modes,
                amplitude.rms_height,
                LONG_WAVES_PER_SCAN * length / scan,
            ),
            rms_heights: [line.moments().rms_height.value, amplitude.rms_height],
            long_waves: Some(long_waves(line, length, modes, amplitude.rms_height)),
        };
        Ok(Rough {
            key,
            heights,
            unit: None,
            measured: Some(amplitude),
            modes: Some(modes),
            facts: Some(facts),
        })
    }

    /// Returns the measured surface of the files `faces`. If a measured surface is in memory,
    /// returns this surface. Otherwise, if the files are the same as in the last call, returns the
    /// surface of the last call. Otherwise reads the files.
    fn surface(
        &mut self,
        faces: &[Vec<PathBuf>],
        options: &MeasuredOptions,
    ) -> Result<Arc<MeasuredRoughness>, SurfaceError> {
        if let Some(measured) = &self.measured {
            return Ok(Arc::clone(measured));
        }
        if let Some(kept) = &self.equivalent
            && kept.faces == faces
            && kept.options == *options
        {
            return Ok(Arc::clone(&kept.surface));
        }
        let surface = Arc::new(MeasuredRoughness::new(&read_faces(faces)?, options)?);
        if let MeasuredRoughness::Equivalent(_) = *surface {
            self.equivalent = Some(KeptSpectrum {
                faces: faces.to_vec(),
                options: options.clone(),
                surface: Arc::clone(&surface),
            });
        }
        Ok(surface)
    }
}

/// Samples the heights of a scene from a measured profile. `file` is the file of the profile.
fn cut_profile(
    key: RoughnessKey,
    profile: &MeasuredProfile,
    length: f64,
    file: &Path,
) -> Result<Rough, RunError> {
    let heights = profile
        .sample(length, key.points, key.shift)
        .map_err(|error| error.in_measured(file))?;
    let amplitude = profile.amplitude()?;
    let facts = MeasuredFacts {
        scan: profile.length(),
        rms_heights: [amplitude.rms_height, root_mean_square_about_mean(&heights)],
        // The measured heights are at least as long as the profile, so the profile lacks no long
        // waves.
        long_wave_share: 0.0,
        long_waves: None,
    };
    Ok(Rough {
        key,
        heights,
        unit: None,
        measured: Some(amplitude),
        modes: None,
        facts: Some(facts),
    })
}

/// Returns the recommended number of springs for a profile of the length `length` in m with the
/// measured spectrum `line`. It is the smallest power of two for which the shortest wave has at
/// least twice [`SPRINGS_PER_WAVE`] springs. The number is at least 2^10 and at most 2^28.
pub fn equivalent_springs(line: &EquivalentLine, length: f64) -> u64 {
    let waves = length * line.range()[1] / TAU;
    ((2.0 * SPRINGS_PER_WAVE as f64 * waves) as u64)
        .next_power_of_two()
        .clamp(1024, MOST_POINTS)
}

/// Returns the share of the modes up to `most` in the mean squared height of a profile. `length` is
/// the length of the profile in m, `modes` are its modes, and `rms_height` is its rms height in m.
fn long_wave_share(
    line: &EquivalentLine,
    length: f64,
    modes: ModeRange,
    rms_height: f64,
    most: f64,
) -> f64 {
    let last = modes.last.min(most as u64);
    if last < modes.first {
        return 0.0;
    }
    let first = modes.first;
    let longest = line.amplitude_of_modes(length, ModeRange { first, last });
    (longest.rms_height / rms_height).powi(2)
}

/// Returns the smallest mode such that the waves up to this mode have together at least a tenth of
/// the mean squared height. `length` is the length of the profile in m, `modes` are its modes, and
/// `rms_height` is its rms height in m.
fn long_waves(line: &EquivalentLine, length: f64, modes: ModeRange, rms_height: f64) -> f64 {
    let mut squared_height = 0.0;
    for mode in modes.first..=modes.last {
        squared_height += 0.5 * line.amplitude(mode, length).powi(2);
        if squared_height >= LONG_WAVES * rms_height * rms_height {
            return mode as f64;
        }
    }
    modes.last as f64
}

/// Returns the root mean square of the differences between the heights in m and their mean.
fn root_mean_square_about_mean(heights: &[f64]) -> f64 {
    let mean = heights.iter().sum::<f64>() / heights.len() as f64;
    let squares: f64 = heights
        .iter()
        .map(|height| (height - mean) * (height - mean))
        .sum();
    (squares / heights.len() as f64).sqrt()
}
