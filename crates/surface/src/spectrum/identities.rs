//! Identities between the moments of a spectrum and the statistics of the points of which it was
//! computed.

use super::isotropic::IsotropicSpectrum;
use super::moments::{Moment, line_moments};
use super::statistics::PointStatistics;
use std::f64::consts::{FRAC_PI_2, SQRT_2};

/// Departures of the moments of the line from the measured points, relative to the squares of the
/// moments.
pub(super) struct Departures {
    pub squared_height: f64,
    pub squared_gradient: f64,
}

/// Compares the rms height of the line with the measured height, if this is known. Also compares
/// its rms gradient with the gradient of the measured points: a spike that the window hides is seen
/// only there. Departures within three standard errors are zero.
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
    // Differences of neighbours reduce the slope of a wave of two points by π/2.
    let squared_gradient = departure(line.rms_gradient, gradient, FRAC_PI_2 * gradient);
    Departures {
        squared_height,
        squared_gradient,
    }
}

/// Returns by how much a moment lies outside the range that the points give. The result is relative
/// to the square of the moment.
fn departure(moment: Moment, least: f64, most: f64) -> f64 {
    let beyond = (least - moment.value).max(moment.value - most);
    if beyond > 3.0 * moment.error {
        // The squares have twice the relative error.
        2.0 * beyond / moment.value
    } else {
        0.0
    }
}
