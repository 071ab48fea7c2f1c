//! Comparison of the moments of a fitted spectrum with the statistics of the measured points. For
//! exact data the moments and the statistics are equal.

use super::isotropic::IsotropicSpectrum;
use super::moments::{Moment, line_moments};
use super::statistics::PointStatistics;
use std::f64::consts::{FRAC_PI_2, SQRT_2};

/// How much the squared rms height and the squared rms gradient of the equivalent line differ from
/// those of the measured points, divided by those of the line.
pub(super) struct Departures {
    pub squared_height: f64,
    pub squared_gradient: f64,
}

/// Compares the moments of the equivalent line with the measured points. The rms gradient of the
/// line is compared with the slopes between points. The rms height of the line is compared with
/// `height` in m, if this height is known. Such a comparison finds, for example, a spike that the
/// window function hides from the spectrum. A difference between a moment and its measured value
/// within three standard errors counts as zero.
pub(super) fn departures(
    isotropic: &IsotropicSpectrum,
    height: Option<f64>,
    measured: &PointStatistics,
) -> Departures {
    let line = line_moments(std::slice::from_ref(isotropic));
    let gradient = measured.rms_gradient.unwrap_or(SQRT_2 * measured.rms_slope);
    let squared_height = match height {
        Some(height) => departure(line.rms_height, height, height),
        None => 0.0,
    };
    // A slope computed from two neighbouring points is smaller than the true slope. For a wave of
    // two points the factor is π/2, which is the largest one.
    let squared_gradient = departure(line.rms_gradient, gradient, FRAC_PI_2 * gradient);
    Departures {
        squared_height,
        squared_gradient,
    }
}

/// Returns by how much the square of a moment lies outside the range that the points allow, divided
/// by the square of the moment.
fn departure(moment: Moment, least: f64, most: f64) -> f64 {
    let beyond = (least - moment.value).max(moment.value - most);
    if beyond > 3.0 * moment.error {
        // The relative difference of a square is twice that of the number itself.
        2.0 * beyond / moment.value
    } else {
        0.0
    }
}
