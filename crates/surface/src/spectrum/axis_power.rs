//! Waves of a map that run parallel to an axis. Offsets of whole rows or columns against each other
//! appear only in these waves.

use super::periodogram::Wave;
use std::ops::RangeInclusive;

/// Smallest number of a wave, divided by the number of points along the axis, from which on the
/// wave is compared with its neighbours.
const COMPARED: f64 = 1.0 / 8.0;

/// Smallest number of a wave, divided by the number of points along the axis, from which on the
/// wave may be left out. The surface has more power in longer waves than offsets have.
const LEFT_OUT: f64 = 1.0 / 32.0;

/// Limit of chance for the relative difference between the mean power of n waves along an axis and
/// that of their neighbours, times √n. The limit is about four standard deviations under a window.
const NO_CHANCE: f64 = 12.0;

/// Distances from the axis, in waves, of the near group of neighbouring waves.
const NEAR: RangeInclusive<f64> = 3.0..=5.0;

/// Distances from the axis, in waves, of the farther group of neighbouring waves.
const FARTHER: RangeInclusive<f64> = 6.0..=8.0;

/// Factor for the extrapolation of the power to the axis. The power is an even function a + bx² of
/// the distance x from the axis, also on an anisotropic surface. So its value at the axis is the
/// mean of the near group plus this factor times the mean of the near group less that of the
/// farther group.
const EXTRAPOLATED: f64 = 0.486;

/// Share of the squared gradient of the map above which the difference between waves along an axis
/// and their neighbours is not negligible.
const NEGLIGIBLE_OFFSETS: f64 = 1e-3;

/// Share of the squared gradient of the map above which this difference is attributed to the
/// surface itself, and not to offsets of rows or columns.
const LARGEST_OFFSETS: f64 = 0.25;

/// Place of a wave in the plane of wave numbers, with respect to one axis.
#[derive(Clone, Copy)]
pub(super) struct AxisPlace {
    /// Number of the wave across the axis, which is its distance from the axis.
    pub across: f64,
    /// Number of the wave along the axis, divided by the number of points.
    pub along: f64,
}

/// Sum over several waves.
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

/// Waves parallel to one axis, in which offsets of rows or columns appear, and sums over their
/// neighbours, in which such offsets do not appear.
#[derive(Default)]
struct AxisPower {
    waves: Vec<Wave>,
    /// Sum over the short waves parallel to the axis.
    parallel: GradientSum,
    near: GradientSum,
    farther: GradientSum,
}

impl AxisPower {
    /// Adds a wave to the sums of its group. Waves up to the distance `reach` are parallel to the
    /// axis.
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

    /// Returns by how much the squared gradient of the waves parallel to the axis differs from the
    /// value expected from their neighbours; zero if the difference may be chance.
    fn departure(&self) -> f64 {
        let near = self.near.mean();
        let farther = self.farther.mean();
        let count = self.parallel.waves;
        let expected = (near + EXTRAPOLATED * (near - farther)) * count;
        let departure = (self.parallel.squared_gradient - expected).abs();
        // Without neighbours `expected` is NaN, the comparison is false, and the result is 0.
        if departure * count.sqrt() > NO_CHANCE * expected.abs() {
            departure
        } else {
            0.0
        }
    }
}

/// Waves of a map: those parallel to one of its axes, and all others.
pub(super) struct WavesByAxis {
    /// Largest distance in waves from an axis to which a wave counts as parallel.
    reach: f64,
    others: Vec<Wave>,
    axes: [AxisPower; 2],
}

/// The waves of a map, without the waves that offsets of rows or columns falsify.
pub(super) struct TrueWaves {
    pub waves: Vec<Wave>,
    /// True if waves parallel to an axis are left out.
    pub offsets: bool,
    /// Largest departure of the remaining waves parallel to an axis from neighbouring waves, as a
    /// share of the squared gradient.
    pub apart: f64,
}

impl WavesByAxis {
    /// Creates an empty collection. `memory` receives the waves that are parallel to no axis.
    pub fn new(reach: f64, memory: Vec<Wave>) -> Self {
        WavesByAxis {
            reach,
            others: memory,
            axes: Default::default(),
        }
    }

    /// Adds a wave with its places with respect to both axes.
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

    /// Leaves out the short waves parallel to an axis if they differ from their neighbours by as
    /// much as offsets of rows or columns can cause.
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

    /// Returns all waves, also those parallel to an axis.
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
