//! Heights of the roughness of a scene, synthesised or measured.

use super::RunError;
use super::cached::Cached;
use crate::scene::{Roughness, Scene};
use crate::spectrum::{Detrend, End, Options};
use crate::surface::{
    Amplitude, EquivalentLine, MeasuredOptions, MeasuredProfile, MeasuredRoughness, SelfAffine, SurfaceError,
    Synthesizer, read_faces,
};
use crate::topography::{Cut, ReadOptions, Unit, content};
use std::f64::consts::TAU;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Parameters of the heights of a roughness at some points.
#[derive(Clone, PartialEq)]
pub(super) struct RoughnessKey {
    source: Source,
    points: usize,
    shift: f64,
}

/// Origin of a roughness.
#[derive(Clone, PartialEq)]
enum Source {
    SelfAffine {
        spectrum: SelfAffine,
        seed: u64,
    },
    /// Files of each face; the seed is that of an equivalent line.
    Measured {
        faces: Vec<Vec<PathBuf>>,
        options: MeasuredOptions,
        seed: Option<u64>,
        length: f64,
    },
}

/// Heights of the roughness before scaling.
pub(super) struct Rough {
    /// Empty once they have become the gaps of the profile.
    pub heights: Vec<f64>,
    /// Amplitude of the self-affine profile of rms height 1 on a length of 1 m.
    pub unit: Option<Amplitude>,
    /// Amplitude of a measured surface.
    pub measured: Option<Amplitude>,
    /// First and last mode of a random profile.
    pub modes: Option<(u64, u64)>,
}

/// Maker of heights, with what serves several of them.
#[derive(Default)]
pub(super) struct RoughnessMaker {
    folder: PathBuf,
    /// A measured surface in place of the scenes' files.
    pub measured: Option<Arc<MeasuredRoughness>>,
    /// The equivalent line of the last files: it is small, and serves all seeds.
    equivalent: Cached<(Vec<Vec<PathBuf>>, MeasuredOptions), EquivalentLine>,
    pub synthesizer: Synthesizer,
    /// Number of random phases drawn so far.
    pub phases_drawn: u64,
}

impl RoughnessKey {
    /// Returns true for heights in metres.
    pub fn is_measured(&self) -> bool {
        matches!(self.source, Source::Measured { .. })
    }
}

impl RoughnessMaker {
    /// Creates a maker for files in a folder, or for a measured surface in memory.
    pub fn new(folder: PathBuf, measured: Option<Arc<MeasuredRoughness>>) -> Self {
        RoughnessMaker { folder, measured, ..RoughnessMaker::default() }
    }

    /// Releases the memory of former roughness.
    pub fn emptied(self) -> Self {
        RoughnessMaker::new(self.folder, self.measured)
    }

    /// Returns the parameters of the roughness of a scene; `None` without roughness.
    pub fn key(&self, scene: &Scene) -> Option<RoughnessKey> {
        let points = scene.numerics.points as usize;
        let shift = scene.form.map_or(0.0, |form| form.shift(points as u64));
        let source = match (spectrum(scene), &scene.roughness) {
            (Some((spectrum, seed)), _) => Source::SelfAffine { spectrum, seed },
            (None, Some(Roughness::Measured { .. })) => Source::Measured {
                faces: scene.measured_paths(&self.folder),
                options: measured_options(scene),
                seed: scene.seed(),
                length: scene.length,
            },
            _ => return None,
        };
        Some(RoughnessKey { source, points, shift })
    }

    /// Makes heights and their known values; synthesised ones in this memory.
    ///
    /// # Errors
    /// An unreadable measured surface, waves that do not fit the points, insufficient memory.
    pub fn make(&mut self, key: &RoughnessKey, memory: Vec<f64>) -> Result<Rough, RunError> {
        let RoughnessKey { source, points, shift } = key;
        let (faces, options, seed, length) = match source {
            Source::SelfAffine { spectrum, seed } => {
                let heights = self.synthesizer.synthesize(*spectrum, *seed, *points, *shift, memory)?;
                self.phases_drawn += spectrum.last + 1 - spectrum.first;
                return Ok(Rough {
                    heights,
                    unit: Some(spectrum.unit_amplitude(1.0)),
                    measured: None,
                    modes: Some((spectrum.first, spectrum.last)),
                });
            }
            Source::Measured { faces, options, seed, length } => (faces, options, seed, *length),
        };
        let refused = |reason: &dyn std::fmt::Display| SurfaceError::measured(first(faces), reason);
        let Some(seed) = seed else {
            let read;
            let profile = match self.measured.as_deref() {
                Some(MeasuredRoughness::Profile(known)) => known,
                _ => {
                    let profile =
                        content(first(faces)).and_then(|bytes| MeasuredProfile::new(&bytes, options));
                    read = profile.map_err(|error| refused(&error))?;
                    &read
                }
            };
            let heights = profile.sample(length, *points, *shift).map_err(|reason| refused(&reason))?;
            let measured = Some(profile.amplitude()?);
            return Ok(Rough { heights, unit: None, measured, modes: None });
        };
        let line = self.equivalent_line(faces, options)?;
        let modes = line.modes(length, *points).map_err(|reason| refused(&reason))?;
        let amplitude = |mode: u64| line.amplitude(mode, length);
        let heights = self.synthesizer.synthesize_waves(&amplitude, modes, *seed, *points, *shift, memory)?;
        self.phases_drawn += modes.1 + 1 - modes.0;
        let measured = Some(line.amplitude_of_modes(length, modes));
        Ok(Rough { heights, unit: None, measured, modes: Some(modes) })
    }

    /// The equivalent line of the faces: the given one, the last one, or a new one.
    fn equivalent_line(
        &mut self,
        faces: &[Vec<PathBuf>],
        options: &MeasuredOptions,
    ) -> Result<EquivalentLine, SurfaceError> {
        if let Some(MeasuredRoughness::Equivalent(known)) = self.measured.as_deref() {
            return Ok(known.clone());
        }
        let key = (faces.to_vec(), *options);
        if let Some(line) = self.equivalent.get(&key) {
            return Ok(line.clone());
        }
        let line = EquivalentLine::new(&read_faces(faces)?, options)?;
        self.equivalent.keep(key, line.clone());
        Ok(line)
    }
}

/// Spectrum and seed of a self-affine roughness.
pub(super) fn spectrum(scene: &Scene) -> Option<(SelfAffine, u64)> {
    match scene.roughness {
        Some(Roughness::SelfAffine { hurst, modes: (first, last), seed, .. }) => {
            Some((SelfAffine { hurst, first, last }, seed))
        }
        _ => None,
    }
}

/// File of the first face, the name in errors about all of them.
fn first(faces: &[Vec<PathBuf>]) -> &Path {
    faces.iter().flatten().next().map_or(Path::new(""), PathBuf::as_path)
}

/// Options of a checked scene for its measured surface.
#[must_use]
pub fn measured_options(scene: &Scene) -> MeasuredOptions {
    let of_roughness = |roughness| measured_roughness_options(roughness, scene.measured_as_line());
    scene.roughness.as_ref().map_or_else(MeasuredOptions::default, of_roughness)
}

/// Options of a checked roughness, whose measured profile is the line itself or not.
#[must_use]
pub fn measured_roughness_options(roughness: &Roughness, as_line: bool) -> MeasuredOptions {
    let Roughness::Measured {
        unit,
        height_unit,
        spacing,
        interpolate,
        resample,
        channel,
        row,
        column,
        detrend,
        periodic,
        continue_to,
        ..
    } = roughness
    else {
        return MeasuredOptions::default();
    };
    let end = continue_to.map_or(End::Ends, |wavelength| End::Continues(TAU / wavelength));
    // A plane fitted to a periodic surface would leave a step at its borders.
    let default = if *periodic { Detrend::Mean } else { Detrend::Tilt };
    MeasuredOptions {
        as_line: as_line.then(|| detrend.unwrap_or(Detrend::None)),
        reading: ReadOptions {
            unit: unit.parse().ok(),
            height_unit: height_unit.parse().ok(),
            convention: as_line.then_some(Unit::METRE),
            spacing: *spacing,
            interpolate: *interpolate,
            channel: channel.and_then(|channel| channel.try_into().ok()),
            cut: row.map(Cut::Row).or(column.map(Cut::Column)),
            resample: *resample,
        },
        spectrum: Options { detrend: detrend.unwrap_or(default), periodic: *periodic, end, tip_radius: None },
    }
}
