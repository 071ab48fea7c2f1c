//! Heights of the roughness of a scene, random or measured.

use super::outcome::RunError;
use crate::analysis::premises::MeasuredFacts;
use crate::scene::fields::MOST_POINTS;
use crate::scene::model::{SPRINGS_PER_WAVE, Scene};
use asperity_surface::lines::{
    MeasuredOptions, MeasuredRoughness, ModeRange, Synthesizer, read_faces,
};
use asperity_surface::{Amplitude, EquivalentLine, SelfAffine, SurfaceError};
use std::f64::consts::TAU;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Share of the squared height that the longest waves of a measured spectrum carry together.
const LONG_WAVES: f64 = 0.1;

/// Everything that determines the heights of a roughness.
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
    /// Paths of the files of each face, and the length of the profile in m.
    Measured {
        faces: Vec<Vec<PathBuf>>,
        options: MeasuredOptions,
        length: f64,
    },
}

/// Heights of a roughness before scaling, with what is known about them.
pub(super) struct Rough {
    pub key: RoughnessKey,
    /// Heights; empty once their memory has become the gaps of the profile.
    pub heights: Vec<f64>,
    /// Amplitude of the self-affine profile for an rms height of 1 m on a length of 1 m.
    pub unit: Option<Amplitude>,
    /// Amplitude of a measured surface.
    pub measured: Option<Amplitude>,
    /// First and last mode of a random profile.
    pub modes: Option<(u64, u64)>,
    /// Facts about a measured surface and the profile made from it.
    pub facts: Option<MeasuredFacts>,
}

/// Maker of heights. It keeps what several roughnesses share.
#[derive(Default)]
pub(super) struct RoughnessMaker {
    /// Folder of the files that scenes name.
    pub folder: PathBuf,
    /// A measured surface in memory that replaces the files of all scenes.
    pub measured: Option<Arc<MeasuredRoughness>>,
    /// Spectrum of the files that were read last. It is small and serves all seeds.
    pub equivalent: Option<(Vec<Vec<PathBuf>>, MeasuredOptions, Arc<MeasuredRoughness>)>,
    pub synthesizer: Synthesizer,
    /// Number of random phases drawn so far.
    pub phases_drawn: u64,
}

impl RoughnessMaker {
    /// Returns everything that determines the roughness of a scene; `None` without roughness.
    pub fn key(&self, scene: &Scene) -> Option<RoughnessKey> {
        let points = scene.numerics.points as usize;
        let shift = scene
            .form
            .as_ref()
            .map_or(0.0, |form| form.shift(points as u64));
        let source = match (scene.spectrum(), &scene.roughness) {
            (Some(spectrum), _) => Source::SelfAffine(spectrum),
            (None, roughness) => {
                roughness.as_ref()?;
                let faces = scene.measured_paths(&self.folder);
                Source::Measured {
                    faces,
                    options: scene.measured_options(),
                    length: scene.length,
                }
            }
        };
        Some(RoughnessKey {
            source,
            seed: scene.seed().unwrap_or(0),
            points,
            shift,
        })
    }

    /// Makes the heights of a roughness. Random heights use the memory `memory`.
    pub fn make(&mut self, key: RoughnessKey, memory: Vec<f64>) -> Result<Rough, RunError> {
        let RoughnessKey {
            ref source,
            seed,
            points,
            shift,
        } = key;
        let (faces, options, length) = match source {
            Source::SelfAffine(spectrum) => {
                let heights = self
                    .synthesizer
                    .synthesize(*spectrum, seed, points, shift, memory)?;
                self.phases_drawn += spectrum.last + 1 - spectrum.first;
                let (unit, modes) = (
                    spectrum.unit_amplitude(1.0),
                    (spectrum.first, spectrum.last),
                );
                return Ok(Rough {
                    key,
                    heights,
                    unit: Some(unit),
                    measured: None,
                    modes: Some(modes),
                    facts: None,
                });
            }
            Source::Measured {
                faces,
                options,
                length,
            } => (faces, options, *length),
        };
        let file = faces
            .iter()
            .flatten()
            .next()
            .map_or(Path::new(""), PathBuf::as_path);
        let refused = |error: SurfaceError| error.in_measured(file);
        let surface = self.surface(faces, options)?;
        match &*surface {
            MeasuredRoughness::Profile(profile) => {
                let heights = profile.sample(length, points, shift).map_err(refused)?;
                let amplitude = profile.amplitude()?;
                let rms_heights = [amplitude.rms_height, root_mean_square_about_mean(&heights)];
                let facts = MeasuredFacts {
                    scan: profile.length(),
                    rms_heights,
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
            MeasuredRoughness::Equivalent(line) => {
                let modes = line.modes(length, points).map_err(refused)?;
                let of_mode = |mode: u64| line.amplitude(mode, length);
                let heights = self
                    .synthesizer
                    .synthesize_waves(&of_mode, modes, seed, points, shift, memory)?;
                self.phases_drawn += modes.last + 1 - modes.first;
                let amplitude = line.amplitude_of_modes(length, modes);
                let facts = MeasuredFacts {
                    scan: TAU / line.range()[0],
                    rms_heights: [line.moments().rms_height.value, amplitude.rms_height],
                    long_waves: Some(long_waves(line, length, modes, amplitude.rms_height)),
                };
                Ok(Rough {
                    key,
                    heights,
                    unit: None,
                    measured: Some(amplitude),
                    modes: Some((modes.first, modes.last)),
                    facts: Some(facts),
                })
            }
        }
    }

    /// Returns the measured surface of the faces: the given one, the spectrum kept from the last
    /// call, or a new one.
    fn surface(
        &mut self,
        faces: &[Vec<PathBuf>],
        options: &MeasuredOptions,
    ) -> Result<Arc<MeasuredRoughness>, SurfaceError> {
        let last = self
            .equivalent
            .as_ref()
            .filter(|(of, with, _)| of == faces && with == options);
        if let Some(known) = self.measured.as_ref().or(last.map(|(.., surface)| surface)) {
            return Ok(Arc::clone(known));
        }
        let surface = Arc::new(MeasuredRoughness::new(&read_faces(faces)?, options)?);
        if let MeasuredRoughness::Equivalent(_) = *surface {
            self.equivalent = Some((faces.to_vec(), options.clone(), Arc::clone(&surface)));
        }
        Ok(surface)
    }
}

/// Returns a recommended number of springs for a profile of this length in m with this measured
/// spectrum: the smallest power of two with twice [`SPRINGS_PER_WAVE`] springs on the shortest
/// wave, but at least 2^10 and at most 2^28.
pub fn equivalent_springs(line: &EquivalentLine, length: f64) -> u64 {
    let waves = length * line.range()[1] / TAU;
    ((2.0 * SPRINGS_PER_WAVE as f64 * waves) as u64)
        .next_power_of_two()
        .clamp(1024, MOST_POINTS)
}

/// Returns the mode whose wave and all longer waves carry a tenth of the squared height of a
/// profile of this length in m, with these modes and this rms height in m.
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

/// Returns the root mean square of heights in m about their mean.
fn root_mean_square_about_mean(heights: &[f64]) -> f64 {
    let mean = heights.iter().sum::<f64>() / heights.len() as f64;
    let squares: f64 = heights
        .iter()
        .map(|height| (height - mean) * (height - mean))
        .sum();
    (squares / heights.len() as f64).sqrt()
}
