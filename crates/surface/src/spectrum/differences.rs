//! Differences between the parts of a surface, and between several measurements of the same
//! roughness. Only the part of a difference that chance does not explain is used.

use super::levelled::LevelledSurface;
use super::parts::{Spread, chance_factor, student_factor, variance_of_mean};
use super::point_results::SAME;

/// Surfaces with equal numbers and distances of points. Only the moments of such surfaces can be
/// compared.
struct Group {
    points: [usize; 2],
    spacing: f64,
    spreads: Vec<Spread>,
}

/// Collects how much the heights and gradients differ between the parts of a surface, and between
/// surfaces with equal numbers and distances of points.
#[derive(Default)]
pub(super) struct Differences {
    groups: Vec<Group>,
}

/// Errors of the spectrum, and ratios of rms values. They follow from how much the heights and
/// gradients differ between the parts of a surface, and between surfaces.
#[derive(Clone, Copy, Debug)]
pub(super) struct Unevenness {
    /// Relative errors of the integrals ∫ q^p C2D dq over the spectrum C2D, for p = 1, 2, 3. These
    /// errors follow from how much the integrals differ between parts and between surfaces.
    pub errors: [f64; 3],
    /// Ratio of the largest to the smallest rms gradient among the parts of a surface. The largest
    /// ratio of all surfaces is given; 1 if chance explains the differences between the parts.
    pub ratio_of_parts: f64,
    /// Ratio of the largest to the smallest rms height among surfaces with equal numbers and
    /// distances of points, or the same ratio of the rms gradients if it is larger; 1 if chance
    /// explains the differences between the surfaces.
    pub ratio_of_surfaces: f64,
}

impl Differences {
    /// Adds a surface. `spread` states how much the parts of this surface differ.
    pub fn add(&mut self, surface: &LevelledSurface, spread: Spread) {
        let points = [surface.columns, surface.rows];
        let spacing = surface.distances[0];
        let is_equal = |group: &&mut Group| {
            group.points == points && (group.spacing / spacing - 1.0).abs() < SAME
        };
        match self.groups.iter_mut().find(is_equal) {
            Some(group) => group.spreads.push(spread),
            None => self.groups.push(Group {
                points,
                spacing,
                spreads: vec![spread],
            }),
        }
    }

    /// Returns the errors of the spectrum, and the ratios of rms values, that follow from all
    /// surfaces added so far. Only surfaces with equal numbers and distances of points are compared
    /// with each other. If there are several such groups of surfaces, each error and each ratio is
    /// the largest one of all groups.
    pub fn unevenness(&self) -> Unevenness {
        let mut unevenness = Unevenness {
            errors: [0.0; 3],
            ratio_of_parts: 1.0,
            ratio_of_surfaces: 1.0,
        };
        for group in &self.groups {
            let between = group.between();
            for (index, error) in unevenness.errors.iter_mut().enumerate() {
                let variance = group.within(index) + between.excess[index];
                *error = error.max(variance.sqrt());
            }
            let ratio = between.ratio.sqrt();
            unevenness.ratio_of_surfaces = unevenness.ratio_of_surfaces.max(ratio);
            for spread in &group.spreads {
                unevenness.ratio_of_parts = unevenness.ratio_of_parts.max(spread.ratio.sqrt());
            }
        }
        unevenness
    }
}

impl Group {
    /// Returns the relative variance of the mean of a moment over all surfaces, as far as it is due
    /// to differences between the parts of each surface that chance does not explain.
    fn within(&self, index: usize) -> f64 {
        let count = self.spreads.len() as f64;
        let sum: f64 = self.spreads.iter().map(|spread| spread.excess[index]).sum();
        sum / (count * count)
    }

    /// Returns the spread of the moments between the surfaces. The spread expected by chance
    /// follows from the differences between the parts of each surface and from the finite number of
    /// waves.
    fn between(&self) -> Spread {
        let mut between = Spread::by_chance();
        let count = self.spreads.len();
        if count < 2 {
            return between;
        }
        let mut is_chance = true;
        let mut ratio = 1.0_f64;
        for index in 0..3 {
            let means: Vec<f64> = self
                .spreads
                .iter()
                .map(|spread| spread.means[index])
                .collect();
            let mean = means.iter().sum::<f64>() / count as f64;
            if mean <= 0.0 {
                return between;
            }
            let mut chance = 0.0;
            for spread in &self.spreads {
                let share = spread.means[index] / (mean * count as f64);
                chance += share * share * (spread.chance[index] + spread.excess[index]);
            }
            let variance = variance_of_mean(&means, mean);
            is_chance &= variance <= chance * chance_factor(count, chance * count as f64);
            let student = student_factor(count).powi(2) * variance;
            between.excess[index] = (student - chance).max(0.0);
            let least = means.iter().copied().fold(f64::INFINITY, f64::min);
            let most = means.iter().copied().fold(0.0, f64::max);
            ratio = ratio.max(most / least);
        }
        if is_chance {
            between.excess = [0.0; 3];
        } else {
            between.ratio = ratio;
        }
        between
    }
}
