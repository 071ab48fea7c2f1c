//! Parts of a surface, which are equal blocks of its points, and the powers of the waves in these
//! blocks. Differences between the blocks show that a surface is not uniform. They then give an
//! additional error of its moments and a correction of its spectrum. The correction is needed
//! because a window function gives the middle of the surface more weight than its borders.

use super::levelled::LevelledSurface;
use super::map_power::waves_of_map;
use super::observation::HANN_CORRELATED;
use super::periodogram::{ProfilePower, Wave, window};
use super::weights::EqualWeights;
use crate::error::SurfaceError;
use crate::topography::surface::Detrend;
use std::f64::consts::TAU;

/// Smallest number of points along a side of a block.
const LEAST_POINTS: usize = 16;

/// Largest number of blocks along a side of a map.
const MOST_OF_MAP: usize = 8;

/// Largest number of blocks of a profile.
const MOST_OF_PROFILE: usize = 16;

/// Number of the first wave of a block that is used. Longer waves are left out, because removal of
/// the tilt of the block reduces their power.
const FIRST_WAVE: f64 = 2.0;

/// Quantile of the standard normal distribution that chance exceeds once in a thousand times.
const NO_CHANCE: f64 = 3.09;

/// Powers of the waves in one block.
#[derive(Clone, Debug)]
struct Block {
    /// Sum of the powers of the waves in each octave of wave numbers.
    octaves: Vec<f64>,
    /// Sums of qⁿ times the power of each wave, for n = 0, 1, 2, where q is the wave number. Up to
    /// constant factors these sums are the mean square height, the elastic energy and the mean
    /// square gradient.
    moments: [f64; 3],
    /// Relative variances of these moments that result from the finite number of waves, on a
    /// surface with normally distributed heights.
    variances: [f64; 3],
}

/// Equal blocks of the points of a surface, row by row.
#[derive(Clone, Debug)]
pub(super) struct Blocks {
    columns: usize,
    rows: usize,
    /// Wave number in rad/m at which the first octave begins.
    first: f64,
    blocks: Vec<Block>,
    /// Weight of each block in the powers of the whole surface. The weights differ because of the
    /// window function.
    shares: Vec<f64>,
}

/// How much three moments of the heights differ between the parts of a surface, as relative
/// numbers. Up to constant factors, the moments are the mean square height, the elastic energy and
/// the mean square gradient.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Spread {
    /// Mean over the parts of the surface of three moments: mean square height, elastic energy and
    /// mean square gradient, up to constant factors.
    pub means: [f64; 3],
    /// Relative variances of the three moments in `means` that chance explains. Chance means here:
    /// the surface is uniform, and its heights are normally distributed.
    pub chance: [f64; 3],
    /// Relative variances of the three moments in `means` that chance does not explain; zero if
    /// chance explains all differences between the parts.
    pub excess: [f64; 3],
    /// Ratio of the largest to the smallest mean square gradient among the four quarters of a
    /// surface, or among its halves if there are no quarters. The ratio is 1 if chance explains the
    /// differences between them.
    pub ratio: f64,
    /// True if chance explains the differences between the parts.
    pub is_chance: bool,
}

/// Relative differences of one moment between the parts of a surface.
#[derive(Clone, Copy)]
struct MomentSpread {
    mean: f64,
    /// Relative variance of the mean that chance explains, on a uniform surface with normally
    /// distributed heights.
    chance: f64,
    /// Relative variance of the mean that follows from the differences between the parts. Parts of
    /// several sizes are compared, and the largest variance is used.
    variance: f64,
    /// True if chance explains the differences between the parts.
    is_chance: bool,
}

impl Spread {
    /// Returns the value for a surface whose parts differ by no more than chance explains, and for
    /// a surface that has only one part.
    pub fn by_chance() -> Self {
        Spread {
            ratio: 1.0,
            is_chance: true,
            ..Spread::default()
        }
    }
}

impl Blocks {
    /// Divides a surface into blocks and computes their powers.
    ///
    /// # Errors
    /// Returns an error if a Fourier transform fails, or if the memory does not suffice.
    pub fn new(surface: &LevelledSurface) -> Result<Self, SurfaceError> {
        let is_profile = surface.rows == 1;
        let most = if is_profile {
            MOST_OF_PROFILE
        } else {
            MOST_OF_MAP
        };
        let columns = block_count(surface.columns, most);
        let rows = if is_profile {
            1
        } else {
            block_count(surface.rows, most)
        };
        let width = surface.columns / columns;
        let height = surface.rows / rows;
        let [along, between] = surface.distances;
        let mut shortest = width as f64 * along;
        if !is_profile {
            shortest = shortest.min(height as f64 * between);
        }
        let first = FIRST_WAVE * (1.0 - 1e-9) * TAU / shortest;
        let mut blocks = Vec::with_capacity(columns * rows);
        for row in 0..rows {
            for column in 0..columns {
                let place = [column * width, row * height];
                let waves = waves_of(&copy_block(surface, place, [width, height]))?;
                blocks.push(Block::new(&waves, first, is_profile));
            }
        }
        let shares_of_columns = shares(surface.columns, columns, surface.windowed);
        let shares_of_rows = shares(surface.rows, rows, surface.windowed && !is_profile);
        let mut shares = Vec::with_capacity(columns * rows);
        for share_of_row in &shares_of_rows {
            for share_of_column in &shares_of_columns {
                shares.push(share_of_row * share_of_column);
            }
        }
        Ok(Blocks {
            columns,
            rows,
            first,
            blocks,
            shares,
        })
    }

    /// Returns how much the mean square height, the elastic energy and the mean square gradient
    /// differ between the blocks. If chance explains the differences of all moments, every
    /// [`Spread::excess`] is zero.
    pub fn spread(&self) -> Spread {
        let moments = [0, 1, 2].map(|index| self.spread_of_moment(index));
        let mut spread = Spread {
            means: moments.map(|moment| moment.mean),
            chance: moments.map(|moment| moment.chance),
            ..Spread::by_chance()
        };
        if moments.iter().any(|moment| !moment.is_chance) {
            spread.is_chance = false;
            spread.excess = moments.map(|moment| (moment.variance - moment.chance).max(0.0));
            spread.ratio = self.ratio();
        }
        spread
    }

    /// Returns the spread of one moment. The surface is divided into parts of 1, 2, 4, … blocks.
    /// For each size, the differences between the parts give a variance of the mean, which is
    /// multiplied by the square of Student's factor for the number of parts. The largest variance
    /// is returned, because small parts that are neighbours do not show differences over long
    /// distances.
    fn spread_of_moment(&self, index: usize) -> MomentSpread {
        let count = self.blocks.len() as f64;
        let moments: Vec<f64> = self
            .blocks
            .iter()
            .map(|block| block.moments[index])
            .collect();
        let mean = moments.iter().sum::<f64>() / count;
        let mut spread = MomentSpread {
            mean,
            chance: 0.0,
            variance: 0.0,
            is_chance: true,
        };
        if mean <= 0.0 {
            return spread;
        }
        for block in &self.blocks {
            let share = block.moments[index] / (count * mean);
            spread.chance += share * share * block.variances[index];
        }
        for parts in self.parts(&moments) {
            let variance = variance_of_mean(&parts, mean);
            let factor = chance_factor(parts.len(), spread.chance * parts.len() as f64);
            spread.is_chance &= variance <= spread.chance * factor;
            let with_student = student_factor(parts.len()).powi(2) * variance;
            spread.variance = spread.variance.max(with_student);
        }
        spread
    }

    /// Returns the means of `values` (one value per block) over parts of 1, 2, 4, … blocks. Each
    /// list belongs to one size of the parts, and the last list has two parts.
    fn parts(&self, values: &[f64]) -> Vec<Vec<f64>> {
        let mut all = Vec::new();
        let mut parts = values.to_vec();
        let mut columns = self.columns;
        let mut rows = self.rows;
        while parts.len() > 1 {
            all.push(parts.clone());
            parts = if columns >= rows {
                columns /= 2;
                parts.chunks_exact(2).map(mean).collect()
            } else {
                rows /= 2;
                let pairs = parts.chunks_exact(2 * columns);
                pairs.flat_map(|pair| mean_of_rows(pair, columns)).collect()
            };
        }
        all
    }

    fn ratio(&self) -> f64 {
        let gradients: Vec<f64> = self.blocks.iter().map(|block| block.moments[2]).collect();
        let parts = self.parts(&gradients);
        let Some(coarse) = parts
            .iter()
            .rfind(|parts| parts.len() >= 4)
            .or(parts.last())
        else {
            return 1.0;
        };
        let least = coarse.iter().copied().fold(f64::INFINITY, f64::min);
        let most = coarse.iter().copied().fold(0.0, f64::max);
        most / least
    }

    /// Returns factors for the powers of the whole surface. A window function gives the middle of
    /// the surface a larger weight; with these factors, all blocks count equally. The factors are 1
    /// if chance explains the differences `spread` between the blocks.
    pub fn weights(&self, spread: &Spread) -> EqualWeights {
        if spread.is_chance {
            EqualWeights::none()
        } else {
            self.equal_weights()
        }
    }

    fn equal_weights(&self) -> EqualWeights {
        let mut logarithms = Vec::new();
        let count = self.blocks.len() as f64;
        let octaves = self.blocks.first().map_or(0, |block| block.octaves.len());
        for octave in 0..octaves {
            let mut equal = 0.0;
            let mut windowed = 0.0;
            for (block, share) in self.blocks.iter().zip(&self.shares) {
                equal += block.octaves[octave] / count;
                windowed += block.octaves[octave] * share;
            }
            let is_known = equal > 0.0 && windowed > 0.0;
            let logarithm = if is_known {
                (equal / windowed).ln()
            } else {
                0.0
            };
            logarithms.push(logarithm);
        }
        EqualWeights {
            first: self.first,
            logarithms,
        }
    }
}

impl Block {
    /// Sums the powers of those waves of a block whose wave number is at least `first` in rad/m.
    fn new(waves: &[Wave], first: f64, is_profile: bool) -> Self {
        let mut block = Block {
            octaves: Vec::new(),
            moments: [0.0; 3],
            variances: [0.0; 3],
        };
        let correlated = if is_profile {
            HANN_CORRELATED
        } else {
            HANN_CORRELATED * HANN_CORRELATED
        };
        let last = waves
            .iter()
            .map(|wave| wave.wave_number)
            .fold(first, f64::max);
        let octaves = ((last / first).log2().floor() as usize).max(1);
        block.octaves.resize(octaves, 0.0);
        for wave in waves {
            if wave.wave_number < first {
                continue;
            }
            let octave = (wave.wave_number / first).log2() as usize;
            block.octaves[octave.min(octaves - 1)] += wave.power;
            for (index, moment) in block.moments.iter_mut().enumerate() {
                *moment += wave.power * wave.wave_number.powi(index as i32);
            }
        }
        for wave in waves {
            if wave.wave_number < first {
                continue;
            }
            for index in 0..3 {
                if block.moments[index] > 0.0 {
                    let term = wave.power * wave.wave_number.powi(index as i32);
                    let share = term / block.moments[index];
                    // The powers are exponentially distributed. The mean square of an exponentially
                    // distributed number is twice its variance, hence the factor 0.5.
                    block.variances[index] += 0.5 * correlated * share * share;
                }
            }
        }
        block
    }
}

/// Returns the number of blocks along a side of a surface, which is a power of two and at most
/// `most`.
fn block_count(points: usize, most: usize) -> usize {
    let mut blocks = 1;
    while 2 * blocks <= most && points / (2 * blocks) >= LEAST_POINTS {
        blocks *= 2;
    }
    blocks
}

/// Copies a block of a surface and removes its tilt. `first` are the first column and the first row
/// of the block, and `size` are its numbers of columns and rows.
fn copy_block(surface: &LevelledSurface, first: [usize; 2], size: [usize; 2]) -> LevelledSurface {
    let [first_column, first_row] = first;
    let [columns, rows] = size;
    let mut heights = Vec::with_capacity(columns * rows);
    for row in first_row..first_row + rows {
        let begin = row * surface.columns + first_column;
        heights.extend_from_slice(&surface.heights[begin..begin + columns]);
    }
    Detrend::Tilt.remove(&mut heights, columns);
    LevelledSurface {
        heights,
        columns,
        rows,
        measured: Vec::new(),
        distances: surface.distances,
        windowed: true,
        aligned: surface.aligned,
        removed: Detrend::Tilt,
    }
}

fn waves_of(block: &LevelledSurface) -> Result<Vec<Wave>, SurfaceError> {
    if block.rows > 1 {
        return waves_of_map(block);
    }
    let mut power = ProfilePower::new(block.columns, block.distances[0], true);
    let rows = std::iter::once(block.heights.iter().copied());
    power.add(rows, &EqualWeights::none())?;
    Ok(power.waves)
}

/// Returns the weight of each of `blocks` equal blocks in the power of a row of `points` points. It
/// is the share of the block in the sum of the squared window function.
fn shares(points: usize, blocks: usize, windowed: bool) -> Vec<f64> {
    let weights: Vec<f64> = window(points, windowed).iter().map(|w| w * w).collect();
    let size = points / blocks;
    let sums: Vec<f64> = weights
        .chunks_exact(size)
        .map(|block| block.iter().sum())
        .collect();
    let total: f64 = sums[..blocks].iter().sum();
    sums[..blocks].iter().map(|sum| sum / total).collect()
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Returns, for each column of two rows, the mean of the number in the first row and the number in
/// the second row.
fn mean_of_rows(pair: &[f64], columns: usize) -> impl Iterator<Item = f64> {
    let (first, second) = pair.split_at(columns);
    first
        .iter()
        .zip(second)
        .map(|(first, second)| 0.5 * (first + second))
}

/// Returns the relative variance of the mean of several parts, estimated from the differences
/// between the values `parts`.
pub(super) fn variance_of_mean(parts: &[f64], mean: f64) -> f64 {
    let count = parts.len() as f64;
    let squares: f64 = parts.iter().map(|part| (part / mean - 1.0).powi(2)).sum();
    squares / ((count - 1.0) * count)
}

/// Returns the largest ratio of two variances that counts as chance. Both are variances of the mean
/// of a moment over `parts` parts of a surface: the first is estimated from the differences between
/// the parts, the second is that on a uniform surface.
///
/// On a uniform surface, the ratio exceeds the result once in a thousand times. The result is a
/// quantile of the χ² distribution (Wilson and Hilferty 1931). `variance` is the relative variance
/// of one part on a uniform surface. A part is distributed like a sum of 1/`variance` exponentially
/// distributed numbers. If these numbers are few, the distribution is skewed, and the estimated
/// variance scatters more.
pub(super) fn chance_factor(parts: usize, variance: f64) -> f64 {
    let parts = parts as f64;
    let ninth = (2.0 / (parts - 1.0) + 6.0 * variance / parts) / 9.0;
    (1.0 - ninth + NO_CHANCE * ninth.sqrt()).powi(3)
}

/// Returns a factor for the standard error of a mean of `parts` parts. With this factor, the true
/// value lies within one standard error of the mean in about two thirds of all cases. The factor is
/// a quantile of Student's distribution, and nearly 1 if there are many parts.
pub(super) fn student_factor(parts: usize) -> f64 {
    let freedom = parts as f64 - 1.0;
    1.0 + 0.5 / freedom + 0.337 / (freedom * freedom)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn is_near(found: f64, expected: f64, tolerance: f64) -> bool {
        (found / expected - 1.0).abs() < tolerance
    }

    #[test]
    fn factors_are_quantiles_of_their_distributions() {
        // The expected values are quantiles of Student's distribution with 1, 3, 7 and 63 degrees
        // of freedom, within which 68.27 % of all cases lie.
        for (parts, expected) in [(2, 1.837), (4, 1.197), (8, 1.077), (64, 1.008)] {
            assert!(is_near(student_factor(parts), expected, 0.01), "{parts}");
        }
        // The expected values are quantiles of χ² for a probability of 99.9 %, divided by the
        // degrees of freedom.
        for (parts, expected) in [(2, 10.83), (4, 16.27 / 3.0), (65, 104.7 / 64.0)] {
            assert!(
                is_near(chance_factor(parts, 0.0), expected, 0.04),
                "{parts}"
            );
        }
        assert!(chance_factor(64, 0.5) > 1.1 * chance_factor(64, 0.0));
    }

    /// The relative spread is the same for heights of 1 m and of 1e-90 m.
    #[test]
    fn the_spread_does_not_depend_on_the_unit() {
        let spread = |scale: f64| {
            let height = |i: usize| (0.9 * i as f64 + (i * i % 97) as f64).sin();
            let heights = (0..64 * 64).map(|i| scale * height(i) * (1.0 + (i % 64) as f64));
            let surface = LevelledSurface {
                heights: heights.collect(),
                columns: 64,
                rows: 64,
                measured: Vec::new(),
                distances: [1.0; 2],
                windowed: true,
                aligned: false,
                removed: Detrend::Tilt,
            };
            Blocks::new(&surface).unwrap().spread()
        };
        let plain = spread(1.0);
        let tiny = spread(1e-90);
        assert!(!plain.is_chance && plain.ratio > 2.0, "{plain:?}");
        assert!(is_near(tiny.ratio, plain.ratio, 1e-6));
        for index in 0..3 {
            assert!(is_near(tiny.chance[index], plain.chance[index], 1e-6));
            assert!(is_near(tiny.excess[index], plain.excess[index], 1e-6));
        }
    }
}
