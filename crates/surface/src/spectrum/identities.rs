//! Comparison of the moments of a spectrum with the statistics of the points from which the
//! spectrum was computed. For exact data both are equal.

use super::isotropic::IsotropicSpectrum;
use super::moments::{Moment, line_moments};
use super::statistics::PointStatistics;
use std::f64::consts::{FRAC_PI_2, SQRT_2};

/// Differences between the squared moments of the line and those of the measured points, divided by
/// the squared moments.
pub(super) struct Departures {
    pub squared_height: f64,
    pub squared_gradient: f64,
}

/// Compares the rms height of the line with the measured rms height `height` in m, if it is known,
/// and the rms gradient of the line with the gradient of the measured points. The comparison finds,
/// for example, a spike that the window function hides from the spectrum. Differences within three
/// standard errors count as zero.
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
    // The slope from the difference of two neighbouring points is smaller than the true slope, for
    // a wave of two points by the factor π/2.
    let squared_gradient = departure(line.rms_gradient, gradient, FRAC_PI_2 * gradient);
    Departures {
        squared_height,
        squared_gradient,
    }
}

/// Returns by how much the square of a moment lies outside the range that the points give, divided
/// by the square of the moment.
fn departure(moment: Moment, least: f64, most: f64) -> f64 {
    let beyond = (least - moment.value).max(moment.value - most);
    if beyond > 3.0 * moment.error {
        // A square has twice the relative difference.
        2.0 * beyond / moment.value
    } else {
        0.0
    }
}
