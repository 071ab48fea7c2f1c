//! Moments of the heights and gradients of measured points, and the shortest wavelength that the
//! tip of an instrument resolves.

use super::levelled::LevelledSurface;
use serde::Serialize;

/// Statistics of the points of one or more surfaces after removal of a polynomial.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct PointStatistics {
    /// Number of measured points of all surfaces together. Points with interpolated heights are
    /// left out of this number and of the other statistics.
    pub points: usize,
    /// Root mean square height in m about the mean height, without a filter. In the notation of ISO
    /// it is Pq for profiles and Sq for maps.
    pub rms_height: f64,
    /// Root mean square slope of the surfaces along their rows, PΔq in the notation of ISO.
    pub rms_slope: f64,
    /// Root mean square gradient of maps, from the slopes along the rows and perpendicular to the
    /// rows, Sdq in the notation of ISO. `None` if any surface is a profile.
    pub rms_gradient: Option<f64>,
    /// Skewness of the heights: the cube of the height, as a mean over the points, divided by the
    /// cube of the rms height.
    pub skewness: f64,
    /// Kurtosis of the heights: the fourth power of the height, as a mean over the points, divided
    /// by the fourth power of the rms height. It is 3 for normally distributed heights.
    pub kurtosis: f64,
}

/// Sum of squared slopes, and their number.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct SlopeSum {
    squares: f64,
    count: usize,
}

impl SlopeSum {
    fn add(&mut self, slope: f64) {
        self.squares += slope * slope;
        self.count += 1;
    }

    fn mean_square(&self) -> f64 {
        self.squares / self.count.max(1) as f64
    }
}

/// Sums over the points of one or more surfaces.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Sums {
    points: usize,
    squares: f64,
    cubes: f64,
    fourths: f64,
    slopes_along: SlopeSum,
    slopes_between: SlopeSum,
    has_profile: bool,
}

impl Sums {
    /// Adds the measured points of a surface. Heights are taken relative to the mean of the
    /// measured points. A slope between two points counts only if both points were measured.
    pub fn add(&mut self, surface: &LevelledSurface) {
        let columns = surface.columns;
        let [along, between] = surface.distances;
        let points = surface.heights.len();
        let level = surface.heights[0];
        let mut sum = 0.0;
        let mut count = 0;
        for height in (0..points).filter_map(|index| surface.measured_height(index)) {
            sum += height - level;
            count += 1;
        }
        let mean = level + sum / count.max(1) as f64;
        self.points += count;
        for index in 0..points {
            let Some(height) = surface.measured_height(index) else {
                continue;
            };
            let z = height - mean;
            self.squares += z * z;
            self.cubes += z * z * z;
            self.fourths += (z * z) * (z * z);
            if index % columns > 0
                && let Some(before) = surface.measured_height(index - 1)
            {
                self.slopes_along.add((height - before) / along);
            }
            if index >= columns
                && let Some(before) = surface.measured_height(index - columns)
            {
                self.slopes_between.add((height - before) / between);
            }
        }
        self.has_profile |= surface.rows < 2;
    }

    pub fn statistics(&self) -> PointStatistics {
        let count = self.points as f64;
        let square = self.squares / count;
        let along = self.slopes_along.mean_square();
        let between = self.slopes_between.mean_square();
        let rms_gradient = if self.has_profile {
            None
        } else {
            Some((along + between).sqrt())
        };
        PointStatistics {
            points: self.points,
            rms_height: square.sqrt(),
            rms_slope: along.sqrt(),
            rms_gradient,
            skewness: self.cubes / count / square.powf(1.5),
            kurtosis: self.fourths / count / (square * square),
        }
    }
}

/// Share of the curvature of the tip, 1/R. Measured curvatures above this share count as artefacts
/// of the tip (Sanner et al., Appl. Surf. Sci. Adv. 7, 100190, 2022).
const SAFETY: f64 = 0.5;

/// Finds the reliability cut-off, a wavelength in m: shorter waves may be artefacts of the tip. The
/// cut-off is the smallest length 2sΔx (s whole) over which the curvature of all rows is at least
/// −1/(2R) for a tip of the radius R in m. Δx is the distance between points. The curvature at x is
/// (z(x − sΔx) − 2z(x) + z(x + sΔx))/(sΔx)².
///
/// Returns `None` if the curvatures fulfil this condition already for s = 1. If no s fulfils the
/// condition, no wave is reliable, and the function returns half the length of a row.
pub(crate) fn reliability_cutoff(
    heights: &[f64],
    columns: usize,
    spacing: f64,
    tip_radius: f64,
) -> Option<f64> {
    let limit = -SAFETY / tip_radius;
    let is_reliable = |scale: usize| smallest_curvature(heights, columns, scale, spacing) >= limit;
    if is_reliable(1) {
        return None;
    }
    // The scale s is increased by a fifth, but at least by one, until the curvature is reliable.
    // Bisection between the last unreliable and the first reliable scale then gives the smallest
    // reliable scale.
    let most = (columns - 1) / 4;
    let mut unreliable = 1;
    let mut reliable = None;
    while reliable.is_none() && unreliable < most {
        let next = (unreliable + unreliable / 5 + 1).min(most);
        if is_reliable(next) {
            reliable = Some(next);
        } else {
            unreliable = next;
        }
    }
    let Some(mut reliable) = reliable else {
        return Some(0.5 * columns as f64 * spacing);
    };
    while reliable - unreliable > 1 {
        let middle = unreliable + (reliable - unreliable) / 2;
        if is_reliable(middle) {
            reliable = middle;
        } else {
            unreliable = middle;
        }
    }
    Some(2.0 * reliable as f64 * spacing)
}

/// Returns the smallest curvature in 1/m in all rows. It is computed from three points, of which
/// neighbouring ones are `scale` points apart.
fn smallest_curvature(heights: &[f64], columns: usize, scale: usize, spacing: f64) -> f64 {
    let mut smallest = f64::INFINITY;
    for row in heights.chunks_exact(columns) {
        let middles = &row[scale.min(row.len())..];
        let rights = &row[(2 * scale).min(row.len())..];
        for ((left, middle), right) in row.iter().zip(middles).zip(rights) {
            let difference = (left - middle) + (right - middle);
            smallest = smallest.min(difference);
        }
    }
    let step = scale as f64 * spacing;
    smallest / (step * step)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::topography::surface::Detrend;

    #[test]
    fn moments_of_a_map_and_a_profile_are_those_by_hand() {
        let surface = |heights: &[f64], distances: [f64; 2]| LevelledSurface {
            heights: heights.to_vec(),
            columns: 3,
            rows: heights.len() / 3,
            measured: Vec::new(),
            distances,
            windowed: true,
            aligned: false,
            removed: Detrend::Tilt,
        };
        let mut sums = Sums::default();
        let map = surface(&[1.0, 2.0, 4.0, 1.0, 5.0, 5.0], [0.5, 2.0]);
        sums.add(&map);
        let found = sums.statistics();
        // The mean height is 3, and the deviations from it are −2, −1, 1, −2, 2 and 2.
        assert!((found.rms_height - 3.0_f64.sqrt()).abs() < 1e-15);
        assert!((found.skewness - 0.0).abs() < 1e-15);
        assert!((found.kurtosis - (66.0 / 6.0) / 9.0).abs() < 1e-15);
        // The slopes along the rows are 2, 4, 8 and 0. The slopes between the rows are 0, 1.5 and
        // 0.5.
        assert!((found.rms_slope.powi(2) - 84.0 / 4.0).abs() < 1e-13);
        assert!((found.rms_gradient.unwrap().powi(2) - (21.0 + 2.5 / 3.0)).abs() < 1e-13);
        // Without the point in the middle of the second row, the mean height is 2.6. The deviations
        // from it are −1.6, −0.6, 1.4, −1.6 and 2.4.
        let mut measured = Sums::default();
        measured.add(&LevelledSurface {
            measured: vec![true, true, true, true, false, true],
            ..map
        });
        let found = measured.statistics();
        assert_eq!(found.points, 5);
        assert!((found.rms_height.powi(2) - 13.2 / 5.0).abs() < 1e-14);
        // The slopes along the first row are 2 and 4. The slopes between the rows are 0 and 0.5.
        assert!((found.rms_slope.powi(2) - 20.0 / 2.0).abs() < 1e-13);
        assert!((found.rms_gradient.unwrap().powi(2) - (10.0 + 0.25 / 2.0)).abs() < 1e-13);
        sums.add(&surface(&[7.0, 7.0, 7.0], [1.0; 2]));
        assert_eq!(
            (sums.statistics().points, sums.statistics().rms_gradient),
            (9, None)
        );
    }

    #[test]
    fn a_parabola_is_reliable_for_sharper_tips_only() {
        let spacing = 0.5;
        // The curvature of this parabola is −2 at every scale.
        let heights: Vec<f64> = (0..101)
            .map(|i| -(0.5 * f64::from(i) - 25.0).powi(2))
            .collect();
        assert_eq!(reliability_cutoff(&heights, 101, spacing, 0.2), None);
        assert_eq!(
            reliability_cutoff(&heights, 101, spacing, 0.3),
            Some(0.5 * 101.0 * spacing)
        );
    }

    #[test]
    fn a_spike_is_unreliable_below_a_length() {
        let mut heights = vec![0.0; 1001];
        heights[500] = 1.0;
        // At the scale s the curvature at the spike is −2/(sΔx)². It exceeds −1/(2R) if sΔx is
        // larger than 2√R.
        let cutoff = reliability_cutoff(&heights, 1001, 0.1, 1.0);
        assert!((cutoff.unwrap() - 4.0).abs() < 1e-12, "{cutoff:?}");
    }
}
