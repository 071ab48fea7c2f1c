//! Periodograms: the power of each wave of a profile or a map.

use crate::error::SurfaceError;
use asperity_data::{check_room, emptied};
use asperity_fourier::{Complex64, plan_forward, plan_real_forward};
use serde::Serialize;
use std::f64::consts::{PI, TAU};
use std::ops::RangeInclusive;

/// Number of bins per decade of wave numbers, for display.
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

/// Power spectrum of profiles of one length, summed over the profiles.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct ProfilePower {
    pub points: usize,
    pub spacing: f64,
    pub windowed: bool,
    /// Number of summed profiles.
    pub profiles: u64,
    /// Wave number of wave 1 in rad/m.
    pub step: f64,
    /// Wave number in rad/m and summed C1D in m³ of the waves 1, 2, … below half the number of
    /// points.
    pub waves: Vec<(f64, f64)>,
}

impl ProfilePower {
    pub fn new(points: usize, spacing: f64, windowed: bool) -> Self {
        let step = TAU / (points as f64 * spacing);
        let waves = (1..=(points - 1) / 2)
            .map(|wave| (wave as f64 * step, 0.0))
            .collect();
        ProfilePower {
            points,
            spacing,
            windowed,
            profiles: 0,
            step,
            waves,
        }
    }

    /// Adds the power spectra of profiles with equal points, which are the rows of one surface.
    pub fn add(
        &mut self,
        rows: impl Iterator<Item = impl Iterator<Item = f64>>,
    ) -> Result<(), SurfaceError> {
        let scale = self.spacing / self.points as f64;
        transform(rows, self.points, self.windowed, |coefficients| {
            for ((_, sum), coefficient) in self.waves.iter_mut().zip(&coefficients[1..]) {
                *sum += scale * coefficient.norm_sqr();
            }
            self.profiles += 1;
        })
    }
}

/// Computes the one-dimensional power spectral density C1D in m³ of heights (m) at equal distances
/// `spacing` (m), averaged in bins of the wave number. `windowed` is true for heights that are not
/// periodic; a window function is then applied.
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
    // The mean of windowed heights would leak into the first waves.
    let mean = heights.iter().sum::<f64>() / heights.len() as f64;
    power.add(std::iter::once(heights.iter().map(|height| height - mean)))?;
    Ok(bins(
        power
            .waves
            .into_iter()
            .map(|(wave_number, power)| (wave_number, power, 1)),
    ))
}

#[derive(Clone, Debug, PartialEq)]
pub(super) struct MapPower {
    pub windowed: bool,
    /// Wave number of wave 1 along and between the rows in rad/m.
    pub steps: [f64; 2],
    /// Wave number of the sampling along and between the rows in rad/m.
    pub sampling: [f64; 2],
    /// Wave number in rad/m and C2D in m⁴ of the waves in half of the plane, up to the smaller
    /// Nyquist wave number, sorted by wave number.
    pub waves: Vec<(f64, f64)>,
    /// True if the waves parallel to one axis are left out, because rows or columns are offset
    /// against each other or were levelled one by one.
    pub offsets: bool,
    /// Largest departure of waves parallel to an axis from neighbouring waves, as a share of the
    /// squared gradient. Waves that are left out do not count.
    pub apart: f64,
}

/// Smallest number of a wave along an axis that is compared with its neighbours, over the number of
/// points.
const COMPARED: f64 = 1.0 / 8.0;

/// Smallest number of a wave that may be left out, over the number of points. Longer waves have
/// more power than offsets.
const LEFT_OUT: f64 = 1.0 / 32.0;

/// Relative difference of the mean power of n waves along an axis from the mean power of their
/// neighbours, times √n, above which it is not chance: about four standard deviations under a
/// window.
const NO_CHANCE: f64 = 12.0;

/// Distances from the axis, in waves, of the two groups of neighbouring waves. The power is an even
/// function of the distance x, also on an anisotropic surface. Both groups together therefore
/// extrapolate it to the axis as a + bx².
const NEAR: [RangeInclusive<f64>; 2] = [3.0..=5.0, 6.0..=8.0];
const EXTRAPOLATED: f64 = 0.486;

/// Share of the squared gradient above which the difference matters, and above which it is
/// attributed to the surface itself.
const NEGLIGIBLE_OFFSETS: f64 = 1e-3;
const LARGEST_OFFSETS: f64 = 0.25;

/// Waves parallel to one axis, in which offsets of rows or columns appear, and their neighbours, in
/// which they do not.
#[derive(Default)]
struct AxisPower {
    waves: Vec<(f64, f64)>,
    /// Squared gradient and number of the short waves parallel to the axis, and of their neighbours
    /// in the plane.
    on: (f64, f64),
    near: [(f64, f64); 2],
}

/// Squared gradient of a wave (wave number, power), up to a constant factor.
pub(super) fn square((q, power): &(f64, f64)) -> f64 {
    q * q * power
}

impl AxisPower {
    fn compare(&mut self, across: f64, reach: f64, wave: (f64, f64)) {
        let ranges = [0.0..=reach].into_iter().chain(NEAR);
        let sums = [&mut self.on].into_iter().chain(&mut self.near).zip(ranges);
        for (sum, _) in sums.filter(|(_, range)| range.contains(&across)) {
            *sum = (sum.0 + square(&wave), sum.1 + 1.0);
        }
    }

    /// Returns the excess of the squared gradient of the waves parallel to the axis over their
    /// neighbours; zero if it may be chance.
    fn departure(&self) -> f64 {
        let [near, farther] = self.near.map(|(sum, waves)| sum / waves);
        let expected = (near + EXTRAPOLATED * (near - farther)) * self.on.1;
        let apart = (self.on.0 - expected).abs();
        if apart * self.on.1.sqrt() > NO_CHANCE * expected.abs() {
            apart
        } else {
            0.0
        }
    }
}

impl MapPower {
    /// Computes the power spectrum of heights (m) in rows of `columns` points. If the rows were
    /// levelled one by one (`aligned`), the waves between the rows are left out.
    pub fn new(
        heights: &[f64],
        columns: usize,
        [along, between]: [f64; 2],
        windowed: bool,
        aligned: bool,
    ) -> Result<Self, SurfaceError> {
        let rows = heights.len() / columns;
        let half = columns / 2 + 1;
        let points = heights.len();
        check_room(48 * points as u64)?;
        let mut coefficients: Vec<Complex64> = emptied(Vec::new(), half * rows)?;
        let in_rows = heights.chunks_exact(columns).map(|row| row.iter().copied());
        transform(in_rows, columns, windowed, |row| {
            coefficients.extend_from_slice(row)
        })?;
        let steps = [
            TAU / (columns as f64 * along),
            TAU / (rows as f64 * between),
        ];
        let largest = (PI / along).min(PI / between);
        let scale = along * between / points as f64;
        let plan = plan_forward(rows);
        let mut scratch = vec![Complex64::ZERO; plan.get_inplace_scratch_len()];
        let mut column = vec![Complex64::ZERO; rows];
        let row_window = window(rows, windowed);
        let mut waves = emptied(Vec::new(), half * rows)?;
        let mut axes = [0, 1].map(|_| AxisPower::default());
        let reach = if windowed { 1.0 } else { 0.0 };
        let levelled = if aligned { reach as usize + 1 } else { 0 };
        for x in levelled..half {
            for (y, value) in column.iter_mut().enumerate() {
                *value = coefficients[y * half + x] * row_window[y];
            }
            plan.process_with_scratch(&mut column, &mut scratch);
            for (y, value) in column.iter().enumerate() {
                let y = if 2 * y > rows {
                    y as f64 - rows as f64
                } else {
                    y as f64
                };
                // Waves and their mirror images have equal power: only one of them counts.
                let is_first = x > 0 || y > 0.0;
                let q = (x as f64 * steps[0]).hypot(y * steps[1]);
                if !is_first || q >= largest {
                    continue;
                }
                let wave = (q, scale * value.norm_sqr());
                let places = [
                    (x as f64, y.abs() / rows as f64),
                    (y.abs(), x as f64 / columns as f64),
                ];
                for (axis, (across, _)) in axes
                    .iter_mut()
                    .zip(places)
                    .filter(|(_, place)| place.1 >= COMPARED)
                {
                    axis.compare(across, reach, wave);
                }
                let is_on = |(across, along): (f64, f64)| across <= reach && along >= LEFT_OUT;
                match axes.iter_mut().zip(places).find(|(_, place)| is_on(*place)) {
                    Some((axis, _)) => axis.waves.push(wave),
                    None => waves.push(wave),
                }
            }
        }
        let gradient: f64 = waves
            .iter()
            .chain(axes.iter().flat_map(|axis| &axis.waves))
            .map(square)
            .sum();
        let (mut offsets, mut apart) = (false, 0.0_f64);
        for axis in axes {
            let share = axis.departure() / gradient;
            if (NEGLIGIBLE_OFFSETS..LARGEST_OFFSETS).contains(&share) {
                offsets = true;
                continue;
            }
            waves.extend(axis.waves);
            if share >= LARGEST_OFFSETS {
                apart = apart.max(share);
            }
        }
        waves.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        Ok(MapPower {
            windowed,
            steps,
            sampling: [TAU / along, TAU / between],
            waves,
            offsets,
            apart,
        })
    }
}

/// Calls `each` with the Fourier coefficients of each row of `points` heights.
fn transform(
    rows: impl Iterator<Item = impl Iterator<Item = f64>>,
    points: usize,
    windowed: bool,
    mut each: impl FnMut(&[Complex64]),
) -> Result<(), SurfaceError> {
    let plan = plan_real_forward(points);
    let (mut input, mut output) = (plan.make_input_vec(), plan.make_output_vec());
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

/// Returns a Hann window with a mean square of 1, or ones for a periodic profile.
fn window(points: usize, windowed: bool) -> Vec<f64> {
    if !windowed {
        return vec![1.0; points];
    }
    let hann = |index: usize| 0.5 - 0.5 * (TAU * index as f64 / points as f64).cos();
    let squares: f64 = (0..points).map(|index| hann(index).powi(2)).sum();
    let scale = (points as f64 / squares).sqrt();
    (0..points).map(|index| scale * hann(index)).collect()
}

/// Averages the powers of waves, given as (wave number, power, number of waves), in 10 bins per
/// decade of the wave number.
pub(super) fn bins(waves: impl Iterator<Item = (f64, f64, u64)>) -> Vec<Bin> {
    let mut bins: std::collections::BTreeMap<i64, (f64, f64, u64)> =
        std::collections::BTreeMap::new();
    for (wave_number, power, count) in waves {
        let bin = bins
            .entry((BINS_PER_DECADE * wave_number.log10()).floor() as i64)
            .or_default();
        let weight = count as f64;
        *bin = (
            bin.0 + weight * wave_number,
            bin.1 + weight * power,
            bin.2 + count,
        );
    }
    let mean = |(wave_number, power, waves): (f64, f64, u64)| Bin {
        wave_number: wave_number / waves as f64,
        power: power / waves as f64,
        waves,
    };
    bins.into_values().map(mean).collect()
}
