//! Waves of a map that run parallel to one axis of the map. Only these waves change if whole rows
//! or columns are offset against each other.

use super::periodogram::Wave;
use std::ops::RangeInclusive;

/// Smallest number of a wave along the axis, divided by the number of points along the axis, with
/// which the wave is compared with its neighbours.
const COMPARED: f64 = 1.0 / 8.0;

/// Smallest number of a wave along the axis, divided by the number of points along the axis, with
/// which the wave may be left out. In longer waves the surface has more power than offsets have.
const LEFT_OUT: f64 = 1.0 / 32.0;

/// Largest relative difference, times √n, between the mean power of n waves along an axis and that
/// of their neighbours that counts as chance. It is about four standard deviations if a window
/// function is used.
const NO_CHANCE: f64 = 12.0;

/// Distances from the axis, counted in waves, of the nearer group of neighbouring waves.
const NEAR: RangeInclusive<f64> = 3.0..=5.0;

/// Distances from the axis, counted in waves, of the farther group of neighbouring waves.
const FARTHER: RangeInclusive<f64> = 6.0..=8.0;

/// Factor for the extrapolation of the power to the axis. The power is an even function a + bx² of
/// the distance x from the axis, even on an anisotropic surface. The value at the axis is the mean
/// of the nearer group plus this factor times the difference between the means of the nearer and
/// the farther group.
const EXTRAPOLATED: f64 = 0.486;

/// Largest difference between waves along an axis and their neighbours that is negligible, as a
/// share of the squared gradient of the map.
const NEGLIGIBLE_OFFSETS: f64 = 1e-3;

/// Largest such difference that is attributed to offsets of rows or columns, as a share of the
/// squared gradient of the map. A larger difference is attributed to the surface itself.
const LARGEST_OFFSETS: f64 = 0.25;

/// Place of a wave in the plane of its two wave numbers, relative to one axis of this plane.
#[derive(Clone, Copy)]
pub(super) struct AxisPlace {
    /// Distance of the wave from the axis in the plane of wave numbers: the number of periods of
    /// the wave over the map in the direction perpendicular to the axis.
    pub across: f64,
    /// Number of periods of the wave over the map, parallel to the axis, divided by the number of
    /// points in this direction.
    pub along: f64,
}

/// Sum of squared gradients over several waves, and the number of these waves.
#[derive(Clone, Copy, Default)]
struct GradientSum {
    squared_gradient: f64,
    waves: f64,
}

impl GradientSum {
    fn add(&mut self, wave: &Wave) {
        self.squared_gradient += wave.squared_gradient();
        self.waves += 1.0;
    }

    fn mean(&self) -> f64 {
        self.squared_gradient / self.waves
    }
}

/// Waves parallel to one axis, which offsets of rows or columns change, and sums over their
/// neighbours, which offsets do not change.
#[derive(Default)]
struct AxisPower {
    waves: Vec<Wave>,
    /// Sum over those waves parallel to the axis that are short.
    parallel: GradientSum,
    near: GradientSum,
    farther: GradientSum,
}

impl AxisPower {
    /// Adds a wave to the sum of its group, if it belongs to a group. Waves at a distance of at
    /// most `reach` from the axis are parallel to the axis.
    fn compare(&mut self, place: AxisPlace, reach: f64, wave: &Wave) {
        if place.along < COMPARED {
            return;
        }
        if place.across <= reach {
            self.parallel.add(wave);
        }
        if NEAR.contains(&place.across) {
            self.near.add(wave);
        }
        if FARTHER.contains(&place.across) {
            self.farther.add(wave);
        }
    }

    /// Returns the difference between the squared gradient of the waves parallel to the axis and
    /// the value expected from their neighbours. Returns 0 if the difference may be chance.
    fn departure(&self) -> f64 {
        let near = self.near.mean();
        let farther = self.farther.mean();
        let count = self.parallel.waves;
        let expected = (near + EXTRAPOLATED * (near - farther)) * count;
        let departure = (self.parallel.squared_gradient - expected).abs();
        // If there are no neighbours, `expected` is NaN, the comparison is false, and the result is
        // 0.
        if departure * count.sqrt() > NO_CHANCE * expected.abs() {
            departure
        } else {
            0.0
        }
    }
}

/// Waves of a map, divided into the waves parallel to an axis and all other waves.
pub(super) struct WavesByAxis {
    /// Largest distance from an axis, counted in waves, at which a wave still counts as parallel to
    /// it.
    reach: f64,
    others: Vec<Wave>,
    axes: [AxisPower; 2],
}

/// The waves of a map without those that offsets of rows or columns have changed.
pub(super) struct TrueWaves {
    pub waves: Vec<Wave>,
    /// True if short waves parallel to an axis are left out, because whole rows or columns are
    /// offset against each other.
    pub offsets: bool,
    /// Difference between the remaining waves parallel to an axis and the waves in neighbouring
    /// directions. It is the difference between the squared gradient of the waves parallel to the
    /// axis and the squared gradient that the neighbouring directions lead to expect, as a share of
    /// the squared gradient of the map. It is 0 if it is negligible or may be chance.
    pub apart: f64,
}

impl WavesByAxis {
    /// Creates an empty collection of waves. `reach` is the largest number of periods across an
    /// axis with which a wave counts as parallel to this axis. The vector `memory` will store all
    /// waves except short waves parallel to an axis.
    pub fn new(reach: f64, memory: Vec<Wave>) -> Self {
        WavesByAxis {
            reach,
            others: memory,
            axes: Default::default(),
        }
    }

    /// Adds a wave to the collection. `places` states where the wave lies relative to each of the
    /// two axes.
    pub fn add(&mut self, wave: Wave, places: [AxisPlace; 2]) {
        for (axis, place) in self.axes.iter_mut().zip(places) {
            axis.compare(place, self.reach, &wave);
        }
        for (axis, place) in self.axes.iter_mut().zip(places) {
            if place.across <= self.reach && place.along >= LEFT_OUT {
                axis.waves.push(wave);
                return;
            }
        }
        self.others.push(wave);
    }

    /// Returns the waves of the map, without short waves that offsets of rows or columns have
    /// changed. Short waves parallel to an axis are left out if they differ from the waves in
    /// neighbouring directions. A very large difference is attributed to the surface itself, and
    /// the waves are then not left out.
    pub fn without_offsets(self) -> TrueWaves {
        let gradient = self.squared_gradient();
        let mut waves = self.others;
        let mut offsets = false;
        let mut apart = 0.0_f64;
        for axis in self.axes {
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
        TrueWaves {
            waves,
            offsets,
            apart,
        }
    }

    /// Returns all waves, including those parallel to an axis.
    pub fn all(self) -> Vec<Wave> {
        let mut waves = self.others;
        for axis in self.axes {
            waves.extend(axis.waves);
        }
        waves
    }

    fn squared_gradient(&self) -> f64 {
        let parallel = self.axes.iter().flat_map(|axis| &axis.waves);
        let waves = self.others.iter().chain(parallel);
        waves.map(Wave::squared_gradient).sum()
    }
}
