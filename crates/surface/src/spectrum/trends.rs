//! Properties of the points that make the long waves of a spectrum doubtful: a trend of the heights
//! that was not removed, and opposite ends of a periodic surface that do not meet.

use super::levelled::LevelledSurface;
use crate::error::SurfaceError;
use crate::topography::surface::Detrend;
use asperity_data::{Trend, TrendOfScan, gathered};

/// Trends that may be left in the heights, the simplest one first.
const TRENDS: [(Trend, Detrend); 2] = [
    (Trend::Tilt, Detrend::Tilt),
    (Trend::Curvature, Detrend::Curvature),
];

/// Sums of squared heights about the mean height, over the points of all surfaces. One sum is that
/// of the heights as they are; the others are those after removal of a trend, a tilt or a
/// curvature.
#[derive(Default)]
pub(super) struct TrendSums {
    squares: f64,
    without: [f64; TRENDS.len()],
}

impl TrendSums {
    /// Adds the points of a surface.
    ///
    /// # Errors
    /// Returns an error if the memory does not suffice.
    pub fn add(&mut self, surface: &LevelledSurface) -> Result<(), SurfaceError> {
        if surface.removed == Detrend::Curvature {
            let squares = sum_of_squares(&surface.heights);
            self.squares += squares;
            self.without.iter_mut().for_each(|sum| *sum += squares);
            return Ok(());
        }
        let mut heights = gathered(surface.heights.len(), surface.heights.iter().copied())?;
        // Each polynomial contains the ones before it, so the removals add up.
        Detrend::Mean.remove(&mut heights, surface.columns);
        self.squares += sum_of_squares(&heights);
        for (sum, (_, polynomial)) in self.without.iter_mut().zip(TRENDS) {
            polynomial.remove(&mut heights, surface.columns);
            *sum += sum_of_squares(&heights);
        }
        Ok(())
    }

    /// Returns two trends of the heights, tilt and curvature, with the share by which the removal
    /// of the trend reduces the mean squared height.
    pub fn shares(&self) -> Vec<TrendOfScan> {
        let trends = TRENDS.into_iter().zip(self.without);
        let shares = trends.map(|((trend, _), without)| TrendOfScan {
            trend,
            share: 1.0 - without / self.squares,
        });
        shares.collect()
    }
}

fn sum_of_squares(heights: &[f64]) -> f64 {
    heights.iter().map(|height| height * height).sum()
}

/// Returns the ratio of the rms step between opposite ends of a surface to the largest rms step
/// between two neighbouring rows or columns of points. The ratio is computed along both axes, and
/// the larger one is returned. On a periodic surface the ends are neighbours like all others.
pub(super) fn step_of_ends(heights: &[f64], columns: usize) -> f64 {
    let rows = heights.len() / columns;
    let mut between_columns = vec![0.0; columns];
    let mut between_rows = vec![0.0; rows];
    for row in 0..rows {
        for column in 0..columns {
            let height = heights[row * columns + column];
            let next_column = heights[row * columns + (column + 1) % columns];
            let next_row = heights[(row + 1) % rows * columns + column];
            between_columns[column] += (next_column - height).powi(2);
            between_rows[row] += (next_row - height).powi(2);
        }
    }
    last_to_largest(&between_columns).max(last_to_largest(&between_rows))
}

/// Returns the root of the ratio of the last square to the largest one before it; 0 if there is
/// none before it.
fn last_to_largest(squares: &[f64]) -> f64 {
    let Some((last, before)) = squares.split_last() else {
        return 0.0;
    };
    let largest = before.iter().copied().fold(0.0, f64::max);
    if largest > 0.0 {
        (last / largest).sqrt()
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spectrum::analysis::analyse;
    use crate::spectrum::options::AnalysisOptions;
    use crate::topography::surface::Topography;
    use asperity_data::Warning;
    use std::f64::consts::TAU;

    const SIDE: usize = 64;

    /// Returns a periodic map with a sum of waves, to which `trend` is added. Its arguments are the
    /// places on the sides, from −½ to ½.
    fn map(trend: impl Fn(f64, f64) -> f64) -> Topography {
        let height = |index: usize| {
            let x = (index % SIDE) as f64 / SIDE as f64;
            let y = (index / SIDE) as f64 / SIDE as f64;
            let waves = (4..25).map(|wave| {
                let number = f64::from(wave);
                let [k, m] = [number.rem_euclid(9.0), (3.0 * number).rem_euclid(11.0)];
                (TAU * ((k + 3.0) * x + (m + 2.0) * y) + number * number).sin()
            });
            1e-8 * (waves.sum::<f64>() + trend(x - 0.5, y - 0.5))
        };
        let heights: Vec<f64> = (0..SIDE * SIDE).map(height).collect();
        Topography::from_map(&heights, SIDE, [1e-7; 2]).unwrap()
    }

    /// Returns the warnings on long waves and on ends of a map.
    fn warnings(map: &Topography, options: &AnalysisOptions) -> Vec<Warning> {
        let found = analyse(std::slice::from_ref(map), options).unwrap();
        let long = Warning::of_long_waves_of_scan(
            found.long_wave_share(),
            found.is_levelled,
            &found.trends,
        );
        long.into_iter()
            .chain(Warning::of_ends(found.step_of_ends))
            .collect()
    }

    /// Returns the trend that a warning advises to remove.
    fn advised(map: &Topography, detrend: Detrend) -> Option<Trend> {
        let options = AnalysisOptions {
            detrend: Some(detrend),
            ..AnalysisOptions::default()
        };
        match warnings(map, &options).as_slice() {
            [Warning::LongWavesOfScan { trend, .. }] => trend.map(|trend| trend.trend),
            _ => None,
        }
    }

    #[test]
    fn a_trend_that_was_not_removed_is_named() {
        let curved = map(|x, y| -200.0 * (x * x + y * y));
        assert_eq!(advised(&curved, Detrend::Tilt), Some(Trend::Curvature));
        assert_eq!(advised(&curved, Detrend::Mean), Some(Trend::Curvature));
        assert_eq!(advised(&curved, Detrend::Curvature), None);
        let tilted = map(|x, y| 50.0 * x - 70.0 * y);
        assert_eq!(advised(&tilted, Detrend::None), Some(Trend::Tilt));
        assert_eq!(advised(&tilted, Detrend::Mean), Some(Trend::Tilt));
        assert_eq!(advised(&tilted, Detrend::Tilt), None);
        // A long wave is no trend.
        let wavy = map(|x, y| 30.0 * (TAU * (2.0 * x + 2.0 * y)).sin());
        assert_eq!(advised(&wavy, Detrend::Tilt), None);
    }

    #[test]
    fn ends_that_do_not_meet_are_named() {
        let has_step = |map: &Topography, periodic: bool| {
            let options = AnalysisOptions {
                periodic,
                ..AnalysisOptions::default()
            };
            let warnings = warnings(map, &options);
            warnings
                .iter()
                .any(|warning| warning.name() == "ends_do_not_meet")
        };
        let flat = map(|_, _| 0.0);
        assert!(!has_step(&flat, true) && !has_step(&flat, false));
        for tilted in [map(|x, _| 200.0 * x), map(|_, y| 200.0 * y)] {
            assert!(has_step(&tilted, true) && !has_step(&tilted, false));
        }
        let profile = |points: u32, trend: f64| {
            let heights: Vec<f64> = (0..points)
                .map(|i| (f64::from(i) * TAU / 32.0).sin() + trend * f64::from(i))
                .collect();
            Topography::from_profile(&heights, 1.0).unwrap()
        };
        assert!(!has_step(&profile(256, 0.0), true) && has_step(&profile(256, 0.03), true));
        // A part of a periodic profile is not periodic.
        assert!(has_step(&profile(248, 0.0), true));
    }
}
