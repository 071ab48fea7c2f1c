//! Periodograms of profiles, which give the power of each wave of a profile.

use super::weights::EqualWeights;
use crate::error::SurfaceError;
use asperity_fourier::{Complex64, plan_real_forward};
use serde::Serialize;
use std::collections::BTreeMap;
use std::f64::consts::TAU;

/// Number of bins per decade of wave numbers in spectra that are shown to the user.
const BINS_PER_DECADE: f64 = 10.0;

/// Direction of the waves of a measured spectrum. Each direction has its own spectral density in
/// m³.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Along {
    /// Waves along a profile or along the rows of a map. Their spectral density is the
    /// one-dimensional density C1D.
    X,
    /// Waves along the columns of a map. Their spectral density is the one-dimensional density C1D.
    Y,
    /// Waves in all directions of a map. Their spectral density at the wave number q is q C2D/π,
    /// where C2D is the two-dimensional density.
    Radial,
}

/// Mean power spectral density of the waves within a range of wave numbers.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Bin {
    /// Mean wave number of the waves in rad/m.
    pub wave_number: f64,
    /// Mean power spectral density in m³.
    pub power: f64,
    /// Number of waves averaged in the bin.
    pub waves: u64,
}

/// A wave and its power spectral density: C1D in m³ for a profile, or C2D in m⁴ for a map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Wave {
    /// Wave number in rad/m.
    pub wave_number: f64,
    pub power: f64,
}

impl Wave {
    /// Returns the power of the wave times q^`exponent`, where q is the wave number.
    pub fn weighted_power(&self, exponent: i32) -> f64 {
        self.power * self.wave_number.powi(exponent)
    }

    /// Returns the contribution of the wave to the squared gradient of the surface, up to a
    /// constant factor.
    pub fn squared_gradient(&self) -> f64 {
        self.wave_number * self.wave_number * self.power
    }
}

/// Returns the contribution of several waves to the squared gradient, up to a constant factor.
pub(super) fn squared_gradient(waves: &[Wave]) -> f64 {
    waves.iter().map(Wave::squared_gradient).sum()
}

/// Power spectra of profiles with equal numbers and distances of points, added up over the
/// profiles.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct ProfilePower {
    pub points: usize,
    /// Distance between points in m.
    pub spacing: f64,
    pub windowed: bool,
    /// Number of profiles whose spectra were added up.
    pub profiles: u64,
    /// Wave number in rad/m of the wave with one period over the profile.
    pub step: f64,
    /// The waves with 1, 2, … periods over the profile, below half the number of points. Their
    /// powers are sums over the profiles.
    pub waves: Vec<Wave>,
}

impl ProfilePower {
    pub fn new(points: usize, spacing: f64, windowed: bool) -> Self {
        let step = TAU / (points as f64 * spacing);
        let waves = (1..=(points - 1) / 2).map(|number| Wave {
            wave_number: number as f64 * step,
            power: 0.0,
        });
        ProfilePower {
            points,
            spacing,
            windowed,
            profiles: 0,
            step,
            waves: waves.collect(),
        }
    }

    /// Adds the power spectra of the rows of one surface. Each power is first multiplied by its
    /// factor from `weights`.
    ///
    /// # Errors
    /// Returns an error if a Fourier transform fails, or if the memory does not suffice.
    pub fn add(
        &mut self,
        rows: impl Iterator<Item = impl Iterator<Item = f64>>,
        weights: &EqualWeights,
    ) -> Result<(), SurfaceError> {
        let spacing = self.spacing / self.points as f64;
        let scales: Vec<f64> = self
            .waves
            .iter()
            .map(|wave| spacing * weights.factor(wave.wave_number))
            .collect();
        transform_rows(rows, self.points, self.windowed, |coefficients| {
            let waves = self.waves.iter_mut().zip(&scales);
            for ((wave, scale), coefficient) in waves.zip(&coefficients[1..]) {
                wave.power += scale * coefficient.norm_sqr();
            }
            self.profiles += 1;
        })
    }
}

/// Computes the one-dimensional power spectral density C1D in m³ of a profile, averaged in bins of
/// the wave number. `heights` are in m, at equal distances of `spacing` in m. `windowed` is true
/// for heights that are not periodic, to which a window function is then applied.
///
/// ```
/// use asperity_surface::spectra::line_spectrum;
/// use std::f64::consts::TAU;
///
/// // A wave of 16 points has its power at q = 2π/16 per point.
/// let heights: Vec<f64> = (0..256).map(|i| (TAU * f64::from(i) / 16.0).sin()).collect();
/// let bins = line_spectrum(&heights, 1.0, false)?;
/// let largest = bins.iter().max_by(|one, other| one.power.total_cmp(&other.power)).expect("bins");
/// assert!((largest.wave_number / (TAU / 16.0) - 1.0).abs() < 0.15);
/// # Ok::<(), asperity_surface::SurfaceError>(())
/// ```
pub fn line_spectrum(
    heights: &[f64],
    spacing: f64,
    windowed: bool,
) -> Result<Vec<Bin>, SurfaceError> {
    let mut power = ProfilePower::new(heights.len(), spacing, windowed);
    // The mean height is subtracted: under a window function it would add power to the first waves.
    let mean = heights.iter().sum::<f64>() / heights.len() as f64;
    let differences = heights.iter().map(|height| height - mean);
    power.add(std::iter::once(differences), &EqualWeights::none())?;
    let waves = power.waves.into_iter().map(|wave| Bin {
        wave_number: wave.wave_number,
        power: wave.power,
        waves: 1,
    });
    Ok(bins(waves))
}

/// Calls `each` with the Fourier coefficients of each row. Each row has `points` heights.
pub(super) fn transform_rows(
    rows: impl Iterator<Item = impl Iterator<Item = f64>>,
    points: usize,
    windowed: bool,
    mut each: impl FnMut(&[Complex64]),
) -> Result<(), SurfaceError> {
    let plan = plan_real_forward(points);
    let mut input = plan.make_input_vec();
    let mut output = plan.make_output_vec();
    let mut scratch = plan.make_scratch_vec();
    let window = window(points, windowed);
    for row in rows {
        for ((value, height), weight) in input.iter_mut().zip(row).zip(&window) {
            *value = height * weight;
        }
        plan.process_with_scratch(&mut input, &mut output, &mut scratch)
            .map_err(|error| SurfaceError::Transform(error.to_string()))?;
        each(&output);
    }
    Ok(())
}

/// Returns a Hann window with a mean square of 1, or ones if the profile is periodic.
pub(super) fn window(points: usize, windowed: bool) -> Vec<f64> {
    if !windowed {
        return vec![1.0; points];
    }
    let hann = |index: usize| 0.5 - 0.5 * (TAU * index as f64 / points as f64).cos();
    let squares: f64 = (0..points).map(|index| hann(index).powi(2)).sum();
    let scale = (points as f64 / squares).sqrt();
    (0..points).map(|index| scale * hann(index)).collect()
}

/// Averages powers in bins of the wave number, 10 bins per decade. Each element of `waves` is one
/// wave, or the mean of several waves with the same wave number.
pub(super) fn bins(waves: impl IntoIterator<Item = Bin>) -> Vec<Bin> {
    // Sums over the waves in each bin, by the number of the bin on the logarithmic axis.
    let mut sums: BTreeMap<i64, Bin> = BTreeMap::new();
    for wave in waves {
        let number = (BINS_PER_DECADE * wave.wave_number.log10()).floor() as i64;
        let sum = sums.entry(number).or_insert(Bin {
            wave_number: 0.0,
            power: 0.0,
            waves: 0,
        });
        let weight = wave.waves as f64;
        sum.wave_number += weight * wave.wave_number;
        sum.power += weight * wave.power;
        sum.waves += wave.waves;
    }
    let means = sums.into_values().map(|sum| Bin {
        wave_number: sum.wave_number / sum.waves as f64,
        power: sum.power / sum.waves as f64,
        waves: sum.waves,
    });
    means.collect()
}
