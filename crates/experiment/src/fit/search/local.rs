//! Search near starts, for a model whose curves take long to compute: least squares from each
//! start, and a population that is drawn around the best place.

use super::{COARSE, LARGE, Search};
use crate::curve::numerics::{Extent, dot};
use crate::error::ExperimentError;
use crate::fit::agreement::MISFIT;
use crate::fit::parameter::{Coordinate, Parameter};
use crate::fit::population::{Member, Population, WRONG_SIDE, drawn};
use asperity_data::Cholesky;
use rand::RngExt;
use rand::rngs::ChaCha8Rng;
use std::f64::consts::TAU;

/// Largest number of steps of a descent.
const STEPS: usize = 40;
/// Largest number of lengths that are tried for a step.
const LENGTHS: usize = 5;
/// Damping of the first step of a descent (Levenberg and Marquardt), and its smallest value. A step
/// that lowers the cost multiplies the damping by `EASED`, and a step that does not lower it by
/// `TIGHTENED`.
const DAMPING: f64 = 1e-2;
const LEAST_DAMPING: f64 = 1e-6;
const EASED: f64 = 0.2;
const TIGHTENED: f64 = 5.0;
/// Fall of the cost in a step below which a descent ends, apart from the part [`SLOW`] that is in
/// proportion to the cost.
const FLAT: f64 = 0.02;
/// Part of the fall of the cost below which a descent ends, as a share of the cost. It is added to
/// [`FLAT`].
const SLOW: f64 = 1e-4;
/// Ratio of the noise to the lowest noise, up to which the noise counts as the lowest.
const LOWEST: f64 = 1.1;
/// Residual of the best member divided by the noise at which a descent ends, if the model does not
/// describe the curve.
const DEEPER: f64 = 3.0;
/// Step of a coordinate over which its effect on the residuals is computed. The coordinates of the
/// relaxation have the step `STEP_OF_RELAXATION`.
const STEP: f64 = 0.01;
const STEP_OF_RELAXATION: f64 = 0.05;
/// Change of the force over the step of a coordinate, as a share of the range of the force, above
/// which a point lies at a jump.
const LEAPS: f64 = 0.05;
/// Largest difference between the cost at the end of a descent and the smallest cost of all
/// descents, up to which members are drawn around this end too.
const ALSO_GOOD: f64 = 6.0;
/// Number of places drawn for each member that is wanted.
const CANDIDATES: f64 = 1.5;
/// Largest number of draws of a place until it lies inside the ranges.
const DRAWS: usize = 20;

/// Effects of the coordinates on the residuals at a place.
struct Slopes {
    /// Sums of the products of each pair of effects, row by row, in units of the noise.
    products: Vec<f64>,
    /// Sums of the products of the effects and the residuals.
    components: Vec<f64>,
}

impl Slopes {
    /// Returns the step to the lowest cost, if residuals changed linearly. With damping the step is
    /// shorter.
    fn step(&self, damping: f64) -> Option<Vec<f64>> {
        let count = self.components.len();
        let mut matrix = self.products.clone();
        for index in 0..count {
            matrix[index * (count + 1)] *= 1.0 + damping;
        }
        let right = self.components.iter().map(|component| -component).collect();
        Some(Cholesky::new(matrix, count)?.solve(right))
    }
}

/// Place that is drawn from a normal distribution.
struct DrawnPlace {
    place: Vec<f64>,
    /// Half of the squared distance from the centre in standard deviations.
    half_square: f64,
}

/// Place at which a descent ends.
struct Descended {
    member: Member,
    /// Noise of the last step, in units of the noise of the curve.
    noise: f64,
}

impl Search<'_> {
    /// Returns a population of `count` members around the best places that descents from the starts
    /// of the space find. Returns `None` if the best place does not describe the curve, and no
    /// other descent has ended as well, so that a better place may exist.
    pub(super) fn near_starts(
        &mut self,
        count: usize,
        generator: &mut ChaCha8Rng,
    ) -> Result<Option<Population>, ExperimentError> {
        let mut starts = vec![self.space.start()];
        for values in &self.space.relaxations {
            starts.push(self.space.place(values));
        }
        let mut descents = Vec::with_capacity(starts.len());
        for start in starts {
            descents.push(self.least_squares_from(start)?);
        }
        let noises = descents.iter().map(|descent| descent.noise);
        let noise = noises.fold(LARGE, f64::min);
        let mut members: Vec<(f64, Member)> = descents
            .into_iter()
            .map(|descent| (self.cost(&descent.member, noise), descent.member))
            .collect();
        members.sort_by(|(cost, _), (next, _)| cost.total_cmp(next));
        let least = members[0].0;
        let most = least + ALSO_GOOD;
        members.retain(|(cost, _)| *cost < most);
        let is_described = self.misfit(&members[0].1, noise) <= MISFIT;
        if !is_described && members.len() == 1 {
            return Ok(None);
        }
        let centres = members.into_iter().map(|(_, member)| member).collect();
        self.drawn_around(centres, count, generator).map(Some)
    }

    /// Lowers the cost from a place by least squares. The assumed noise falls with the residuals,
    /// and points beyond [`WRONG_SIDE`] times this noise have a smaller weight.
    fn least_squares_from(&mut self, place: Vec<f64>) -> Result<Descended, ExperimentError> {
        self.set_accuracy(COARSE);
        let mut best = self.member(self.space.inside(&place))?;
        let mut noise = self.misfit(&best, f64::INFINITY).clamp(1.0, LARGE);
        let mut damping = DAMPING;
        for _ in 0..STEPS {
            if noise < COARSE && self.model.noise > 1.0 {
                self.set_accuracy(1.0);
                best = self.member(best.place)?;
            }
            let slopes = self.slopes(&best, noise)?;
            let cost = self.cost(&best, noise);
            let mut fall = 0.0;
            for _ in 0..LENGTHS {
                let Some(step) = slopes.step(damping) else {
                    damping = TIGHTENED * damping.max(DAMPING);
                    continue;
                };
                let place: Vec<f64> = best
                    .place
                    .iter()
                    .zip(&step)
                    .map(|(position, change)| position + change)
                    .collect();
                let next = self.member(self.space.inside(&place))?;
                fall = cost - self.cost(&next, noise);
                if fall > 0.0 {
                    best = next;
                    damping = (EASED * damping).max(LEAST_DAMPING);
                    break;
                }
                damping *= TIGHTENED;
            }
            let misfit = self.misfit(&best, noise).clamp(1.0, LARGE);
            let least = (misfit / DEEPER).max(1.0);
            if fall < FLAT + SLOW * cost && noise <= LOWEST * least {
                break;
            }
            noise = misfit.min(0.5 * noise).max(least).min(noise);
        }
        if self.model.noise > 1.0 {
            self.set_accuracy(1.0);
            best = self.member(best.place)?;
        }
        Ok(Descended {
            member: best,
            noise,
        })
    }

    /// Computes the effects of all coordinates on the residuals at the place of a member, for an
    /// assumed noise in units of the noise of the curve.
    fn slopes(&mut self, member: &Member, noise: f64) -> Result<Slopes, ExperimentError> {
        let mut leaps = Vec::with_capacity(member.residuals.len());
        for curve in self.curves() {
            let range = Extent::of(curve.force.iter().copied()).width() / curve.noise;
            leaps.resize(leaps.len() + curve.force.len(), LEAPS * range);
        }
        let residuals = self.lines.refined(&member.residuals, noise);
        let mut weighted = Vec::with_capacity(residuals.len());
        for residual in &residuals {
            let beyond = (WRONG_SIDE * noise / residual.abs()).min(1.0);
            weighted.push(beyond * beyond / (noise * noise));
        }
        let count = member.place.len();
        let mut effects: Vec<Vec<f64>> = Vec::with_capacity(count);
        for index in 0..count {
            let coordinate = self.space.coordinates[index];
            let (low, high) = coordinate.ends();
            let mut step = step_of(&coordinate).min(0.5 * (high - low));
            if member.place[index] + step > high {
                step = -step;
            }
            let mut place = member.place.clone();
            place[index] += step;
            let moved = self.member(place)?;
            let moved = self.lines.refined(&moved.residuals, noise);
            let mut effect = Vec::with_capacity(residuals.len());
            for (point, after) in moved.iter().enumerate() {
                let change = after - residuals[point];
                let is_jump = change.is_nan() || change.abs() > leaps[point];
                effect.push(if is_jump { 0.0 } else { change / step });
            }
            effects.push(effect);
        }
        let mut products = vec![0.0; count * count];
        let mut components = vec![0.0; count];
        for row in 0..count {
            let effect = effects[row].iter().zip(&weighted);
            let effect: Vec<f64> = effect.map(|(effect, weight)| effect * weight).collect();
            components[row] = dot(&effect, &residuals);
            for column in 0..count {
                products[row * count + column] = dot(&effect, &effects[column]);
            }
            // The range of a coordinate counts as the knowledge before the measurement: a uniform
            // distribution over a range of the width w has the variance w²/12.
            let (low, high) = self.space.coordinates[row].ends();
            products[row * (count + 1)] += 12.0 / (high - low).powi(2);
        }
        Ok(Slopes {
            products,
            components,
        })
    }

    /// Draws a population from the normal distributions that the effects of the coordinates give at
    /// the places of some members, of which the first one is the best. Each place that is drawn has
    /// a weight, so that the members have about the probability distribution of the parameters.
    /// Share and time of a relaxation may lie on a long and bent ridge, on which several descents
    /// end at different places.
    fn drawn_around(
        &mut self,
        centres: Vec<Member>,
        count: usize,
        generator: &mut ChaCha8Rng,
    ) -> Result<Population, ExperimentError> {
        self.set_accuracy(1.0);
        let best = centres[0].clone();
        let noise = self
            .misfit(&best, self.misfit(&best, 1.0).max(1.0))
            .max(1.0);
        let least = self.cost(&best, noise);
        let draws = (CANDIDATES * count as f64) as usize / centres.len();
        let mut members = Vec::new();
        let mut weights = Vec::new();
        for centre in centres {
            let slopes = self.slopes(&centre, noise)?;
            let factor = Cholesky::new(slopes.products, centre.place.len());
            let excess = self.cost(&centre, noise) - least;
            for _ in 0..draws {
                let drawn = self.drawn_inside(&centre.place, factor.as_ref(), generator);
                let member = self.member(self.space.inside(&drawn.place))?;
                let excess = self.cost(&member, noise) - least;
                weights.push((drawn.half_square - excess).min(0.0).exp());
                members.push(member);
            }
            weights.push((-excess).min(0.0).exp());
            members.push(centre);
        }
        let share = generator.random();
        let members = drawn(&members, &weights, count, share);
        let mut population = Population {
            costs: vec![0.0; members.len()],
            members,
            noise,
            best,
            cost: least,
        };
        self.set_noise(&mut population, noise);
        Ok(population)
    }

    /// Draws a place from the normal distribution around a place. `factor` is the Cholesky factor
    /// of the inverse covariance matrix.
    fn drawn_inside(
        &self,
        centre: &[f64],
        factor: Option<&Cholesky>,
        generator: &mut ChaCha8Rng,
    ) -> DrawnPlace {
        let mut drawn = DrawnPlace {
            place: centre.to_vec(),
            half_square: 0.0,
        };
        for _ in 0..DRAWS {
            let normal = normal_numbers(centre.len(), generator);
            drawn.half_square = 0.5 * dot(&normal, &normal);
            let step = match factor {
                Some(factor) => factor.solve_transposed(normal),
                None => normal,
            };
            drawn.place = centre
                .iter()
                .zip(&step)
                .map(|(position, change)| position + change)
                .collect();
            if self.space.contains(&drawn.place) {
                break;
            }
        }
        drawn
    }
}

/// Returns the step of a coordinate with which the effect of the coordinate on the residuals is
/// computed.
fn step_of(coordinate: &Coordinate) -> f64 {
    match coordinate.parameter {
        Parameter::RelaxationShare | Parameter::RelaxationTime => STEP_OF_RELAXATION,
        _ => STEP,
    }
}

/// Returns numbers of the standard normal distribution.
fn normal_numbers(count: usize, generator: &mut ChaCha8Rng) -> Vec<f64> {
    let mut numbers = Vec::with_capacity(count);
    for _ in 0..count {
        let [radius, angle]: [f64; 2] = [generator.random(), generator.random()];
        let radius = (-2.0 * (1.0 - radius).ln()).sqrt();
        numbers.push(radius * (TAU * angle).cos());
    }
    numbers
}
