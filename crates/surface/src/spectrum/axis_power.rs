//! Waves of a map that are parallel to an axis. Offsets of rows or columns against each other
//! appear in them alone.

use super::periodogram::Wave;
use std::ops::RangeInclusive;

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

/// Distances from the axis, in waves, of the near group of neighbouring waves.
const NEAR: RangeInclusive<f64> = 3.0..=5.0;

/// Distances from the axis, in waves, of the farther group of neighbouring waves.
const FARTHER: RangeInclusive<f64> = 6.0..=8.0;

/// The power is an even function a + bx² of the distance x from the axis, also on an anisotropic
/// surface. Its value at the axis is the mean of the near group plus this factor times the
/// difference of the near and the farther group.
const EXTRAPOLATED: f64 = 0.486;

/// Share of the squared gradient above which the difference matters.
const NEGLIGIBLE_OFFSETS: f64 = 1e-3;

/// Share of the squared gradient above which the difference is attributed to the surface itself.
const LARGEST_OFFSETS: f64 = 0.25;

/// Place of a wave with respect to an axis of the plane of waves.
#[derive(Clone, Copy)]
pub(super) struct AxisPlace {
    /// Distance from the axis in waves.
    pub across: f64,
    /// Number of the wave along the axis, over the number of points.
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
/// neighbours, in which they do not.
#[derive(Default)]
struct AxisPower {
    waves: Vec<Wave>,
    /// The short waves parallel to the axis.
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

    /// Returns the excess of the squared gradient of the waves parallel to the axis over their
    /// neighbours; zero if it may be chance.
    fn departure(&self) -> f64 {
        let near = self.near.mean();
        let farther = self.farther.mean();
        let count = self.parallel.waves;
        let expected = (near + EXTRAPOLATED * (near - farther)) * count;
        let departure = (self.parallel.squared_gradient - expected).abs();
        // Without neighbours nothing is expected, and the comparison with NaN is false.
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

/// The waves of a map without those that offsets of its rows or columns falsify.
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

    /// Leaves out the waves parallel to an axis that differ from their neighbours as offsets of
    /// rows or columns make them differ.
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

    /// Returns all waves.
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
