//! Power spectra of all surfaces together. From these spectra follow the observations for the fits,
//! and averaged spectra for figures.

use super::levelled::LevelledSurface;
use super::map_power::MapPower;
use super::nodes::WaveRange;
use super::observation::{self, Observation};
use super::options::AnalysisOptions;
use super::parts::Blocks;
use super::periodogram::{Along, Bin, ProfilePower, Wave, bins};
use super::point_results::SAME;
use super::weights::EqualWeights;
use crate::error::SurfaceError;
use crate::topography::surface::Topography;
use std::f64::consts::PI;

/// Smallest ratio of length to width of a map with which its longest waves are taken only from the
/// profiles along its longer side.
const NARROW: f64 = 2.0;

/// Power spectra of all surfaces. The spectra of profiles with equal numbers and distances of
/// points are added up.
#[derive(Default)]
pub(super) struct Powers {
    pub profiles: Vec<ProfilePower>,
    pub maps: Vec<MapPower>,
    strips: Vec<Strip>,
    /// Power spectra along the rows (first) and along the columns (second) of maps, for figures.
    axes: [Vec<ProfilePower>; 2],
}

/// Power spectrum of the profiles along a long and narrow map.
struct Strip {
    power: ProfilePower,
    /// Wave number in rad/m below which this spectrum is used instead of the spectrum of the map.
    end: f64,
}

impl Powers {
    /// Computes the power spectra of surfaces. `quarters` is 0 for the heights as they are. With 1,
    /// 2 or 3, the heights are first changed in one of three ways, by about as much as
    /// interpolation may have changed them ([`Topography::copied_heights`]).
    ///
    /// # Errors
    /// Returns an error if a Fourier transform fails, or if the memory does not suffice.
    pub fn of_reading(
        surfaces: &[Topography],
        options: &AnalysisOptions,
        quarters: usize,
    ) -> Result<Powers, SurfaceError> {
        let mut powers = Powers::default();
        for (index, surface) in surfaces.iter().enumerate() {
            let levelled = LevelledSurface::new(index, surface, options, quarters)?;
            let blocks = Blocks::new(&levelled)?;
            powers.add(&levelled, &blocks.weights(&blocks.spread()))?;
        }
        Ok(powers)
    }

    /// Adds the power spectra of a surface. Each power is first multiplied by its factor from
    /// `weights`. A periodic surface needs no factors: without a window function, all its parts
    /// count equally.
    ///
    /// # Errors
    /// Returns an error if a Fourier transform fails, or if the memory does not suffice.
    pub fn add(
        &mut self,
        surface: &LevelledSurface,
        weights: &EqualWeights,
    ) -> Result<(), SurfaceError> {
        let unchanged = EqualWeights::none();
        let weights = if surface.windowed {
            weights
        } else {
            &unchanged
        };
        if surface.rows == 1 {
            return group(&mut self.profiles, surface, 0).add(rows(surface), weights);
        }
        let [along_x, along_y] = &mut self.axes;
        group(along_x, surface, 0).add(rows(surface), weights)?;
        group(along_y, surface, 1).add(columns(surface), weights)?;

        let mut map = MapPower::new(surface)?;
        for wave in &mut map.waves {
            wave.power *= weights.factor(wave.wave_number);
        }
        if let Some(axis) = long_axis(surface, &map) {
            let mut power = new_power(surface, axis);
            if axis == 0 {
                power.add(rows(surface), weights)?;
            } else {
                power.add(columns(surface), weights)?;
            }
            let end = observation::least_of_map(&map);
            self.strips.push(Strip { power, end });
        }
        self.maps.push(map);
        Ok(())
    }

    /// Returns the observed powers of all waves up to the wave number `last` in rad/m.
    pub fn observations(&self, last: f64) -> Vec<Observation> {
        let mut observations = Vec::new();
        for profile in &self.profiles {
            observations.extend(observation::of_profiles(profile, last));
        }
        for strip in &self.strips {
            for mut observation in observation::of_profiles(&strip.power, strip.end) {
                // These waves are longer than the width of the map. All rows then have nearly the
                // same waves, and count as one profile.
                observation.waves /= strip.power.profiles as f64;
                observations.push(observation);
            }
        }
        for map in &self.maps {
            observations.extend(observation::of_map(map, last));
        }
        observations
    }

    /// Returns the range of wave numbers of the waves that are used. `count` returns how many waves
    /// of a spectrum are used, beginning with the longest wave. The range begins at the longest
    /// wave of all surfaces, and ends at the shortest used wave of all surfaces. For a profile, the
    /// range ends half a wave later: at n + ½ periods if n waves are used.
    pub fn range(&self, count: impl Fn(&[Wave]) -> usize) -> WaveRange {
        let mut first = f64::INFINITY;
        let mut last = 0.0_f64;
        for profile in &self.profiles {
            let waves = count(&profile.waves);
            first = first.min(profile.step);
            last = last.max((waves as f64 + 0.5) * profile.step);
        }
        for map in &self.maps {
            let step = map.steps[0].min(map.steps[1]);
            let last_of_map = match count(&map.waves) {
                0 => step,
                waves => map.waves[waves - 1].wave_number,
            };
            first = first.min(step);
            last = last.max(last_of_map);
        }
        WaveRange { first, last }
    }

    /// Returns the number of scans with known powers of all single waves. A scan is a map, or all
    /// profiles together, because the powers of profiles are averaged. Returns `None` if not all
    /// waves of the surfaces are known: if a surface is not periodic, if waves were left out
    /// because of offsets, or if the surfaces have different waves.
    pub fn periodic_scans(&self) -> Option<f64> {
        match (self.profiles.as_slice(), self.maps.as_slice()) {
            ([profiles], []) => (!profiles.windowed).then_some(1.0),
            ([], [first, ..]) => {
                let is_known = |map: &MapPower| {
                    let is_equal = map.steps == first.steps && map.sampling == first.sampling;
                    is_equal && !map.windowed && !map.offsets
                };
                let scans = self.maps.len() as f64;
                self.maps.iter().all(is_known).then_some(scans)
            }
            _ => None,
        }
    }

    /// Returns the largest difference, over all maps, between the waves parallel to an axis and the
    /// waves in neighbouring directions ([`MapPower::apart`]). It is a difference of squared
    /// gradients, as a share of the squared gradient of the map. It is 0 if it is negligible or may
    /// be chance.
    pub fn apart(&self) -> f64 {
        self.maps.iter().map(|map| map.apart).fold(0.0, f64::max)
    }

    /// Returns the measured spectra in bins of the wave number, one for each direction of the
    /// waves.
    pub fn spectra(&self) -> Vec<(Along, Vec<Bin>)> {
        let [along_x, along_y] = &self.axes;
        let mut spectra = vec![
            (Along::X, mean_bins(self.profiles.iter().chain(along_x))),
            (Along::Y, mean_bins(along_y.iter())),
            (Along::Radial, radial_bins(&self.maps)),
        ];
        spectra.retain(|(_, bins)| !bins.is_empty());
        spectra
    }
}

/// Returns the heights of each row.
fn rows(surface: &LevelledSurface) -> impl Iterator<Item = impl Iterator<Item = f64>> {
    surface
        .heights
        .chunks_exact(surface.columns)
        .map(|row| row.iter().copied())
}

/// Returns the heights of each column.
fn columns(surface: &LevelledSurface) -> impl Iterator<Item = impl Iterator<Item = f64>> {
    (0..surface.columns).map(|column| {
        let heights = surface.heights[column..].iter().copied();
        heights.step_by(surface.columns).take(surface.rows)
    })
}

/// Returns the axis along which a map is long and narrow: 0 for the rows, 1 for the columns. The
/// longest waves are taken only from profiles along this axis. Returns `None` for other maps.
fn long_axis(surface: &LevelledSurface, map: &MapPower) -> Option<usize> {
    if !surface.windowed {
        return None;
    }
    let [along_rows, along_columns] = map.steps;
    if along_columns >= NARROW * along_rows {
        return Some(0);
    }
    // Levelling of the rows has removed the long waves along the columns.
    if !surface.aligned && along_rows >= NARROW * along_columns {
        return Some(1);
    }
    None
}

/// Returns an empty power spectrum for the profiles along an axis of the surface.
fn new_power(surface: &LevelledSurface, axis: usize) -> ProfilePower {
    let points = [surface.columns, surface.rows];
    ProfilePower::new(points[axis], surface.distances[axis], surface.windowed)
}

/// Returns the power spectrum in `powers` to which the profiles along an axis of the surface
/// belong, because their number and spacing of points are the same. If there is none yet, an empty
/// spectrum is added.
fn group<'a>(
    powers: &'a mut Vec<ProfilePower>,
    surface: &LevelledSurface,
    axis: usize,
) -> &'a mut ProfilePower {
    let new = new_power(surface, axis);
    let is_equal = |power: &ProfilePower| {
        power.points == new.points && (power.spacing / new.spacing - 1.0).abs() < SAME
    };
    let index = match powers.iter().position(is_equal) {
        Some(index) => index,
        None => {
            powers.push(new);
            powers.len() - 1
        }
    };
    &mut powers[index]
}

/// Returns the mean power of profiles in bins of the wave number.
fn mean_bins<'a>(powers: impl Iterator<Item = &'a ProfilePower>) -> Vec<Bin> {
    let mut waves = Vec::new();
    for power in powers {
        for wave in &power.waves {
            waves.push(Bin {
                wave_number: wave.wave_number,
                power: wave.power / power.profiles as f64,
                waves: power.profiles,
            });
        }
    }
    bins(waves)
}

/// Returns the mean of q C2D/π over maps, in bins of the wave number q.
fn radial_bins(maps: &[MapPower]) -> Vec<Bin> {
    let waves = maps.iter().flat_map(|map| &map.waves).map(|wave| Bin {
        wave_number: wave.wave_number,
        power: wave.wave_number * wave.power / PI,
        waves: 1,
    });
    bins(waves)
}
