//! Results that are computed from the points of the surfaces, without a spectrum.

use super::identities::departures;
use super::interlaced;
use super::isotropic::IsotropicSpectrum;
use super::levelled::LevelledSurface;
use super::statistics::{Sums, reliability_cutoff};

/// Relative difference up to which two lengths of surfaces, or two distances between points, count
/// as equal.
pub(super) const SAME: f64 = 1e-6;

#[derive(Default)]
pub(super) struct PointResults {
    pub sums: Sums,
    /// Sums over the longest surfaces. Only these surfaces have the long waves that determine the
    /// rms height of the equivalent line.
    pub longest: LargestSums,
    /// Sums over the surfaces with the smallest distance between points. Only these surfaces have
    /// the short waves that determine the rms gradient of the equivalent line.
    pub finest: LargestSums,
    /// Rms height of each surface in m.
    pub rms_heights: Vec<f64>,
    /// Largest reliability cut-off of all surfaces: the shortest wavelength in m that the tip of
    /// the instrument resolves. `None` if the tip resolves all waves, or if no tip radius is known.
    pub reliability_cutoff: Option<f64>,
    /// Largest displacement in m of odd rows against even rows of a map; `None` if no map has such
    /// a displacement.
    pub displaced: Option<f64>,
}

impl PointResults {
    /// Adds the points of a surface. `tip_radius` is the radius in m of the tip of the instrument,
    /// if it is known.
    pub fn add(&mut self, surface: &LevelledSurface, tip_radius: Option<f64>) {
        let heights = &surface.heights;
        let columns = surface.columns;
        let spacing = surface.distances[0];
        self.sums.add(surface);
        let mut own_sums = Sums::default();
        own_sums.add(surface);
        self.rms_heights.push(own_sums.statistics().rms_height);

        let row_length = columns as f64 * spacing;
        self.longest.add(row_length, surface);
        self.finest.add(1.0 / spacing, surface);

        let displaced = interlaced::displacement(heights, columns).map(|points| points * spacing);
        self.displaced = larger_of(self.displaced, displaced);
        if let Some(radius) = tip_radius {
            let cutoff = reliability_cutoff(heights, columns, spacing, radius);
            self.reliability_cutoff = larger_of(self.reliability_cutoff, cutoff);
        }
    }

    /// Compares the rms gradient of the spectrum with the rms gradient of the points, and adds the
    /// difference between the two to the errors of the spectrum. If `has_height` is true, also
    /// compares the rms heights in this way.
    pub fn check_identities(&self, isotropic: &mut IsotropicSpectrum, has_height: bool) {
        let height = self.longest.sums.statistics().rms_height;
        let height = has_height.then_some(height);
        let departures = departures(isotropic, height, &self.finest.sums.statistics());
        let squared_height = departures.squared_height;
        let squared_gradient = departures.squared_gradient;
        let energy = squared_height.max(squared_gradient);
        isotropic.add_method_errors([squared_height, energy, squared_gradient]);
    }
}

/// Sums over those surfaces that have the largest size, such as the largest length. Sizes with a
/// relative difference of at most [`SAME`] count as equal.
#[derive(Default)]
pub(super) struct LargestSums {
    pub size: f64,
    sums: Sums,
}

impl LargestSums {
    fn add(&mut self, size: f64, surface: &LevelledSurface) {
        if size > self.size * (1.0 + SAME) {
            self.size = size;
            self.sums = Sums::default();
        }
        if size >= self.size * (1.0 - SAME) {
            self.sums.add(surface);
        }
    }
}

fn larger_of(first: Option<f64>, second: Option<f64>) -> Option<f64> {
    match (first, second) {
        (Some(first), Some(second)) => Some(first.max(second)),
        (first, second) => first.or(second),
    }
}
