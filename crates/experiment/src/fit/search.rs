//! The search for the parameters that describe a curve, with their errors. A population samples the
//! probability of the parameters (sequential Monte Carlo; Del Moral, Doucet, Jasra, J. R. Stat.
//! Soc. B 68, 411, 2006).
//!
//! The forces jump with the parameters. Neither derivatives nor a linearised fit can therefore show
//! how well a curve determines the parameters, but a population can. Its members are drawn from the
//! ranges and weighted as if the noise were large, so that jumps count little. The noise is then
//! lowered step by step to the noise of the curve. At each step likely members are copied and
//! unlikely members are dropped. Each member then moves by the difference of two others, which has
//! the extent and direction of the population. Some moves are random steps of any size, so that
//! copies separate again. In the end the members are distributed as the noise allows. The start is
//! no member, because a start close to the result would be copied to the whole population.

use crate::curve::numerics::{Extent, dot};
use crate::error::{ExperimentError, refused};
use crate::fit::model::Model;
use crate::fit::parameter::{Coordinate, Parameter};
use crate::fit::population::{Member, Population, WRONG_SIDE, drawn, loss, share_of};
use crate::fit::space::Space;
use asperity_contact::ContactError;
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use std::ops::Range;

const SEED: u64 = 29;
/// Number of members drawn at first for each free parameter.
const SCAN: usize = 60;
/// Number of members of a population, and number of further members for each free parameter.
const MEMBERS: usize = 24;
const FOR_EACH: usize = 8;
/// Share of the members that still count after a step of the noise.
const EFFECTIVE: f64 = 0.3;
/// Largest number of moves of the population at each step, and number of moves at the end, each of
/// which adds all members to the samples.
const MOVES: usize = 5;
const LAST_MOVES: usize = 16;
/// Share of the moves that are random steps, and number of decades below the whole range over which
/// their lengths extend.
const RANDOM: f64 = 0.02;
const DECADES: f64 = 6.0;
/// Noise, divided by the noise of the curve, above which forces are computed coarsely, and the
/// factor of the number of members until then.
const COARSE: f64 = 10.0;
const MORE: usize = 2;
/// Divisor of the residual of the best member. The noise is lowered to this part of the residual,
/// if the residual exceeds the noise of the curve.
const DEEPER: f64 = 3.0;
/// Residual in contact, in units of the noise, above which a population belongs to a model that
/// does not describe the curve, and the share of this residual below which another population is
/// better.
const SYSTEMATIC: f64 = 5.0;
const BETTER: f64 = 0.9;
/// Mean square residual, in units of the noise, beyond which another population is made.
const EXPECTED: f64 = 1.2;
/// Largest number of populations, and the difference of costs by which a start must be better than
/// a population to count as missed.
const ATTEMPTS: usize = 3;
const MISSED: f64 = 3.0;
/// Largest noise divided by the noise of the curve, and number of halvings to determine a step of
/// its logarithm.
const LARGE: f64 = 1e6;
const HALVINGS: usize = 12;
/// Factor of the noise in a step where no smaller factor leaves enough members.
const SLOWEST: f64 = 0.99;
/// Residual in contact, in units of the noise, above which a model does not describe the curve.
pub(crate) const MISFIT: f64 = 1.5;
/// Coordinate of the work of adhesion below which a scene without adhesion is tried. It is a few
/// times the work that the noise hides.
const CLOSE: f64 = 2.5;
/// Residual, in units of the noise, that replaces a force that is not finite.
const FAR: f64 = 1e12;
/// Bases of the sequences of evenly scattered points, one for each coordinate.
const PRIMES: [usize; 7] = [2, 3, 5, 7, 11, 13, 17];

pub(crate) struct Found {
    /// The member with the smallest residuals.
    pub best: Member,
    /// Residuals of the best member after a fit of the lines, in units of the noise.
    pub rests: Vec<f64>,
    /// Noise of the distribution of the samples, divided by the noise of the curve. It is above 1
    /// where the residual is.
    pub noise: f64,
    /// Coordinates, distributed as the noise allows.
    pub samples: Vec<Vec<f64>>,
    /// Costs of each sample for each block of the curve; empty if the model describes the curve.
    pub blocks: Vec<Vec<f64>>,
    /// Smallest cost of a scene without adhesion minus the cost of the best member; infinite if no
    /// sample is close to zero adhesion.
    pub without_adhesion: f64,
}

/// Search on one random profile.
pub(crate) struct Search<'a> {
    pub space: &'a Space<'a>,
    pub model: Model<'a>,
    pub lines: Vec<Vec<f64>>,
    /// Receives the number of curves computed so far.
    pub report: &'a mut dyn FnMut(usize),
}

impl Search<'_> {
    fn member(&mut self, at: Vec<f64>) -> Result<Member, ExperimentError> {
        if (self.space.stop)() {
            return Err(ContactError::Interrupted.into());
        }
        (self.report)(self.model.evaluations);
        let forces = self.model.forces(&self.space.values(&at))?;
        let measured = self.space.curve.force.iter().zip(&forces);
        let rest = |(measured, model): (&f64, &f64)| (measured - model) / self.space.curve.noise;
        let rests = measured
            .map(rest)
            .map(|rest| if rest.is_finite() { rest } else { FAR })
            .collect();
        Ok(Member { at, rests })
    }

    /// Returns the residuals after a fit of the lines of zero and drift. In this fit residuals
    /// above `limit` count as `limit`.
    fn refined(&self, rests: &[f64], limit: f64) -> Vec<f64> {
        let clamped: Vec<f64> = rests.iter().map(|rest| rest.clamp(-limit, limit)).collect();
        let mut refined = rests.to_vec();
        for line in &self.lines {
            let along = dot(&clamped, line);
            refined
                .iter_mut()
                .zip(line)
                .for_each(|(rest, line)| *rest -= along * line);
        }
        refined
    }

    /// Computes the residuals at these coordinates after a fit of the lines, in units of the noise.
    pub fn rests(&mut self, at: &[f64], limit: f64) -> Result<Vec<f64>, ExperimentError> {
        self.model.noise = 1.0;
        let member = self.member(at.to_vec())?;
        Ok(self.refined(&member.rests, limit))
    }

    /// Returns residuals in which points inside a jump count as described. A residual above
    /// [`WRONG_SIDE`] becomes the distance from the forces of a jump of the model, if the jump is
    /// within one point.
    pub fn eased(&mut self, at: &[f64], rests: &[f64]) -> Result<Vec<f64>, ExperimentError> {
        let noise = self.space.curve.noise;
        self.model.noise = 1.0;
        let jumps = self
            .model
            .jumps(&self.space.values(at), WRONG_SIDE * noise)?;
        let ease = |(rest, jump): (&f64, Option<[f64; 2]>)| match jump {
            Some([low, high]) if rest.abs() > WRONG_SIDE => {
                rest - rest.clamp(low / noise, high / noise)
            }
            _ => *rest,
        };
        Ok(rests.iter().zip(jumps).map(ease).collect())
    }

    /// Returns the residual in contact, in units of the noise of the curve, after a fit of the
    /// lines at this noise; see [`Space::misfit`].
    fn misfit(&self, member: &Member, noise: f64) -> f64 {
        self.space
            .misfit(&self.refined(&member.rests, WRONG_SIDE * noise))
    }

    /// Returns the cost of a member at this noise, in units of the noise of the curve: the sum of
    /// the [`loss`] of all points.
    fn cost(&self, member: &Member, noise: f64) -> f64 {
        self.refined(&member.rests, WRONG_SIDE * noise)
            .iter()
            .map(|rest| loss(rest / noise))
            .sum()
    }

    /// Returns the costs of a member at this noise, for each block of the curve.
    fn block_costs(&self, member: &Member, noise: f64) -> Vec<f64> {
        let rests = self.refined(&member.rests, WRONG_SIDE * noise);
        let cost = |block: Range<usize>| rests[block].iter().map(|rest| loss(rest / noise)).sum();
        self.space.blocks().into_iter().map(cost).collect()
    }

    /// Returns points evenly scattered over the ranges, different ones in each attempt.
    fn scattered(&mut self, attempt: usize) -> Result<Vec<Member>, ExperimentError> {
        let coordinates = &self.space.coordinates;
        let start = self.space.start();
        let count = SCAN * start.len();
        let mut members = Vec::with_capacity(count + 1);
        for number in attempt * count + 1..=(attempt + 1) * count {
            let rows = coordinates.iter().zip(PRIMES).zip(&start);
            let of = rows.map(|((one, prime), start)| {
                match (one.parameter, one.ends(), share_of(number, prime)) {
                    // Rough bodies touch before the force exceeds the noise.
                    (Parameter::Offset, (low, high), share) => {
                        (start + 8.0 * share - 6.5).clamp(low, high)
                    }
                    (Parameter::Zero, _, share) => start + 0.1 * (share - 0.5),
                    (_, (low, high), share) => low + share * (high - low),
                }
            });
            let at = of.collect();
            members.push(self.member(at)?);
        }
        Ok(members)
    }

    /// Finds the member with the smallest residuals, and samples of the coordinates. Another
    /// population is drawn in three cases. The residuals exceed the noise, as one population in
    /// thirty ends in another minimum and one in 200 twice. The population has missed a better
    /// start, which then becomes a member of the next one. The population has not spread.
    pub fn find(&mut self) -> Result<Found, ExperimentError> {
        let (population, generator) = self.first()?;
        self.find_from(population, generator)
    }

    /// Returns the first population, and the generator that made it.
    pub fn first(&mut self) -> Result<(Population, ChaCha8Rng), ExperimentError> {
        let mut generator = ChaCha8Rng::seed_from_u64(SEED);
        let population = self.anneal(0, (None, 0.0), &mut generator)?;
        Ok((population, generator))
    }

    /// Returns true for a population whose residuals are no noise.
    pub fn is_systematic(&self, population: &Population) -> bool {
        self.misfit(&population.best, population.noise) > SYSTEMATIC
    }

    /// Does the same as [`Search::find`] from the first population.
    pub fn find_from(
        &mut self,
        mut population: Population,
        mut generator: ChaCha8Rng,
    ) -> Result<Found, ExperimentError> {
        self.model.noise = 1.0;
        let start = self.member(self.space.start())?;
        for attempt in 1..ATTEMPTS {
            let rests = self.refined(&population.best.rests, WRONG_SIDE);
            let rests = self.eased(&population.best.at, &rests)?;
            let cost: f64 = rests.iter().map(|rest| loss(*rest)).sum();
            let is_poor = cost > EXPECTED * 0.5 * rests.len() as f64;
            let has_missed = self.cost(&start, population.noise) < population.cost - MISSED;
            let has_spread = population.has_spread();
            if has_spread && !has_missed && !is_poor {
                break;
            }
            // Where the residuals are no noise, another population that comes to the same ones ends
            // there.
            let rival = self.misfit(&population.best, population.noise);
            let rival = if has_spread && !has_missed && rival > SYSTEMATIC {
                BETTER * rival
            } else {
                0.0
            };
            let other = self.anneal(
                attempt,
                (has_missed.then_some(&start), rival),
                &mut generator,
            )?;
            if self.misfit(&other.best, other.noise) > rival && rival > 0.0 {
                break;
            }
            let noise = population.noise.min(other.noise);
            if !has_spread || self.cost(&other.best, noise) < self.cost(&population.best, noise) {
                population = other;
            }
        }
        population.keep(&start, self.cost(&start, population.noise));
        let noise = self.misfit(&population.best, population.noise).max(1.0);
        self.set_noise(&mut population, noise);
        for _ in 0..MOVES {
            self.move_all(&mut population, &mut generator)?;
        }
        let (mut samples, mut blocks) = (Vec::new(), Vec::new());
        for _ in 0..LAST_MOVES {
            self.move_all(&mut population, &mut generator)?;
            samples.extend(population.members.iter().map(|member| member.at.clone()));
            if noise > MISFIT {
                blocks.extend(
                    population
                        .members
                        .iter()
                        .map(|member| self.block_costs(member, noise)),
                );
            }
        }
        if !population.has_spread() {
            let fault = format!(
                "the search ends at {} values of the parameters",
                population.distinct()
            );
            return refused(
                fault,
                "more; other ranges of the parameters by --free NAME=A..B, or a larger --noise",
            );
        }
        let without_adhesion = self.without_adhesion(&population, &samples)?;
        let rests = self.refined(&population.best.rests, WRONG_SIDE * noise);
        Ok(Found {
            best: population.best,
            rests,
            noise,
            samples,
            blocks,
            without_adhesion,
        })
    }

    /// Returns the smallest cost of a scene without adhesion minus the cost of the best member;
    /// infinite if no sample is close to zero adhesion.
    fn without_adhesion(
        &mut self,
        population: &Population,
        samples: &[Vec<f64>],
    ) -> Result<f64, ExperimentError> {
        let is_work = |one: &Coordinate| one.parameter == Parameter::Work && one.range.0 == 0.0;
        let mut least = f64::INFINITY;
        if let Some(work) = self.space.coordinates.iter().position(is_work)
            && samples.iter().any(|at| at[work] < CLOSE)
        {
            for member in &population.members {
                let mut at = member.at.clone();
                at[work] = 0.0;
                let member = self.member(at)?;
                least = least.min(self.cost(&member, population.noise) - population.cost);
            }
        }
        Ok(least)
    }

    /// Returns a population whose noise was lowered to the noise of the curve, or to a part of the
    /// residual. While the noise is large the population has more members and coarse forces. It
    /// ends early if its residual is above the residual of a rival at the noise of the rival.
    fn anneal(
        &mut self,
        attempt: usize,
        (start, rival): (Option<&Member>, f64),
        generator: &mut ChaCha8Rng,
    ) -> Result<Population, ExperimentError> {
        self.model.noise = COARSE;
        let mut members = self.scattered(attempt)?;
        members.extend(start.cloned());
        let of_member = |member: &&Member| self.misfit(member, f64::INFINITY);
        let best = members
            .iter()
            .min_by(|one, other| of_member(one).total_cmp(&of_member(other)));
        let best = best
            .cloned()
            .ok_or(ContactError::Internal("no values have been drawn"))?;
        let (costs, noise) = (vec![0.0; members.len()], f64::INFINITY);
        let mut population = Population {
            members,
            costs,
            noise,
            best,
            cost: f64::INFINITY,
        };
        let count = MEMBERS + FOR_EACH * self.space.coordinates.len();
        loop {
            let misfit = self.misfit(&population.best, population.noise);
            let least = (misfit / DEEPER).max(1.0);
            if population.noise <= least.max(rival) && (population.noise <= least || misfit > rival)
            {
                self.refine(&mut population)?;
                return Ok(population);
            }
            let (noise, weights) = self.cooler(&population, least);
            let count = if noise > COARSE { MORE * count } else { count };
            population.members = drawn(&population.members, &weights, count, generator.random());
            if noise < COARSE {
                self.refine(&mut population)?;
            }
            self.set_noise(&mut population, noise);
            for _ in 0..MOVES {
                self.move_all(&mut population, generator)?;
                if population.has_moved() {
                    break;
                }
            }
        }
    }

    /// Recomputes a population exactly if its forces are coarse.
    fn refine(&mut self, population: &mut Population) -> Result<(), ExperimentError> {
        if self.model.noise > 1.0 {
            self.model.noise = 1.0;
            for member in population.members.iter_mut().chain([&mut population.best]) {
                *member = self.member(std::mem::take(&mut member.at))?;
            }
            self.set_noise(population, population.noise);
        }
        Ok(())
    }

    /// Sets the noise of a population and computes its costs.
    fn set_noise(&self, population: &mut Population, noise: f64) {
        population.costs = population
            .members
            .iter()
            .map(|member| self.cost(member, noise))
            .collect();
        (population.noise, population.cost) = (noise, self.cost(&population.best, noise));
        let best = (0..population.costs.len())
            .min_by(|&one, &other| population.costs[one].total_cmp(&population.costs[other]));
        if let Some(best) = best {
            population.keep(&population.members[best].clone(), population.costs[best]);
        }
    }

    /// Returns the next lower noise, at least `least`, and the weights of the members at this
    /// noise.
    fn cooler(&self, population: &Population, least: f64) -> (f64, Vec<f64>) {
        let weights = |noise: f64| -> Vec<f64> {
            let pairs = population.members.iter().zip(&population.costs);
            let changes: Vec<f64> = pairs
                .map(|(member, cost)| cost - self.cost(member, noise))
                .collect();
            let largest = Extent::of(changes.iter().copied()).high;
            changes
                .iter()
                .map(|change| (change - largest).exp())
                .collect()
        };
        let enough = EFFECTIVE * population.members.len() as f64;
        let is_enough =
            |weights: &[f64]| weights.iter().sum::<f64>().powi(2) >= enough * dot(weights, weights);
        let found = weights(least);
        if is_enough(&found) {
            return (least, found);
        }
        let (mut low, mut high) = (least, population.noise.min(LARGE));
        for _ in 0..HALVINGS {
            let middle = (low * high).sqrt();
            *if is_enough(&weights(middle)) {
                &mut high
            } else {
                &mut low
            } = middle;
        }
        // Never the same again.
        let next = if high < population.noise {
            high
        } else {
            SLOWEST * high
        };
        (next, weights(next))
    }

    /// Moves each member by the difference of two others (ter Braak, Stat. Comput. 16, 239, 2006)
    /// or by a random step along one coordinate; rejected moves leave it where it is.
    fn move_all(
        &mut self,
        population: &mut Population,
        generator: &mut ChaCha8Rng,
    ) -> Result<(), ExperimentError> {
        let usual = 2.38 / (2.0 * self.space.coordinates.len() as f64).sqrt();
        let count = population.members.len();
        for index in 0..count {
            let here = &population.members[index].at;
            let mut at = here.clone();
            let length: f64 = generator.random();
            if generator.random::<f64>() < RANDOM {
                let moved = generator.random_range(0..at.len());
                let (low, high) = self.space.coordinates[moved].ends();
                at[moved] += (high - low)
                    * (2.0 * length - 1.0)
                    * 10_f64.powf(-DECADES * generator.random::<f64>());
            } else {
                let [one, other] =
                    [(); 2].map(|()| &population.members[generator.random_range(0..count)].at);
                let differences = one.iter().zip(other).map(|(one, other)| one - other);
                at.iter_mut()
                    .zip(differences)
                    .for_each(|(at, by)| *at += usual * (0.5 + length) * by);
            }
            let chance: f64 = generator.random();
            let is_within =
                |(at, one): (&f64, &Coordinate)| (one.ends().0..=one.ends().1).contains(at);
            if at == *here || !at.iter().zip(&self.space.coordinates).all(is_within) {
                continue;
            }
            let member = self.member(at)?;
            let cost = self.cost(&member, population.noise);
            if chance < (population.costs[index] - cost).exp() {
                population.keep(&member, cost);
                (population.members[index], population.costs[index]) = (member, cost);
            }
        }
        Ok(())
    }
}
