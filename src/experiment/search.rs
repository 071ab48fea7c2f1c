//! The search for the parameters that describe a curve, and their errors: a population that samples their probability
//! (sequential Monte Carlo; Del Moral, Doucet, Jasra, J. R. Stat. Soc. B 68, 411, 2006).
//!
//! The forces jump with the parameters, so neither derivatives nor a linearised fit say how well a curve determines them. A
//! population can: its members are drawn over the ranges and weighted as if the noise were large, where jumps count little.
//! Then the noise falls step by step to that of the curve. At each step likely members are doubled, unlikely ones are left
//! out, and all move by differences of others, which have the extent and the directions of the population. In the end the
//! members are distributed as the parameters are by the noise.

use super::baseline::{dot, ends};
use super::model::Model;
use super::parameter::{Coordinate, Parameter, Values};
use super::{ExperimentError, MeasuredCurve};
use crate::contact::ContactError;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

const SEED: u64 = 29;
/// Members drawn at first for each free parameter.
const SCAN: usize = 60;
/// Members of a population beside those for each free parameter.
const MEMBERS: usize = 24;
const FOR_EACH: usize = 8;
/// Share of the members that count after a step of the noise.
const EFFECTIVE: f64 = 0.3;
/// Moves of the population at each step, and those at the end, after which all members are samples.
const MOVES: usize = 5;
const LAST_MOVES: usize = 16;
/// Noise in units of that of the curve down to which the forces are coarse, and factor of the members until then.
const COARSE: f64 = 10.0;
const MORE: usize = 2;
/// Mean square residual in units of the noise beyond which a second population is made.
const EXPECTED: f64 = 1.2;
/// Largest noise in units of that of the curve, and halvings of its logarithm in a step.
const LARGE: f64 = 1e6;
const HALVINGS: usize = 12;
/// Largest factor of the noise in a step.
const SLOWEST: f64 = 0.99;
/// Residual, in units of the noise, beyond which a point counts less: it is on the wrong side of a jump.
pub(super) const WRONG_SIDE: f64 = 5.0;
/// Residual in units of the noise of a force beyond all numbers.
const FAR: f64 = 1e12;
/// Bases of evenly scattered points.
const PRIMES: [usize; 7] = [2, 3, 5, 7, 11, 13, 17];

/// Coordinates with the residuals there, in units of the noise of the curve.
#[derive(Clone)]
pub(super) struct Member {
    pub at: Vec<f64>,
    pub rests: Vec<f64>,
}

/// Members with their costs at a noise, in units of that of the curve, and the best of all with its cost at that of the curve.
struct Population {
    members: Vec<Member>,
    costs: Vec<f64>,
    noise: f64,
    best: Member,
    cost: f64,
}

impl Population {
    /// Keeps a member with this cost at the noise of the curve, if it is the best.
    fn keep(&mut self, member: &Member, cost: f64) {
        if cost < self.cost {
            (self.best, self.cost) = (member.clone(), cost);
        }
    }
}

/// The coordinates in which a scene is fitted, from these values on.
pub(super) struct Space<'a> {
    pub base: Values,
    pub coordinates: Vec<Coordinate>,
    /// Largest work of adhesion on closing, J/m².
    pub most_on_closing: f64,
    pub curve: &'a MeasuredCurve,
    pub stop: &'a (dyn Fn() -> bool + Sync),
}

impl Space<'_> {
    /// Values of all parameters at these coordinates.
    pub fn values(&self, at: &[f64]) -> Values {
        let mut values = self.base;
        for (coordinate, &at) in self.coordinates.iter().zip(at) {
            values[coordinate.parameter as usize] = coordinate.value(at, &values);
            if coordinate.parameter == Parameter::Work {
                let work = values[Parameter::Work as usize];
                values[Parameter::ClosingWork as usize] = work.min(self.most_on_closing);
            }
        }
        values
    }

    /// Straight lines of the curve that are refined with each model, see [`MeasuredCurve::lines`].
    pub fn lines(&self) -> Vec<Vec<f64>> {
        let has_zero = self.coordinates.iter().any(|one| one.parameter == Parameter::Zero);
        self.curve.lines(has_zero)
    }

    /// Root mean square residual in contact, in units of the noise; a point on the wrong side of a jump counts as
    /// [`WRONG_SIDE`].
    pub fn misfit(&self, rests: &[f64]) -> f64 {
        let rests = &rests[self.curve.free..];
        let squares: f64 = rests.iter().map(|rest| rest.abs().min(WRONG_SIDE).powi(2)).sum();
        (squares / rests.len() as f64).sqrt()
    }
}

/// A search on one profile.
pub(super) struct Search<'a> {
    pub space: &'a Space<'a>,
    pub model: Model<'a>,
    pub lines: Vec<Vec<f64>>,
    /// Receives the number of computed curves.
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
        let rests = measured.map(rest).map(|rest| if rest.is_finite() { rest } else { FAR }).collect();
        Ok(Member { at, rests })
    }

    /// Residuals without the lines of zero and drift, where those beyond a limit count as that limit.
    pub fn refined(&self, rests: &[f64], limit: f64) -> Vec<f64> {
        let clamped: Vec<f64> = rests.iter().map(|rest| rest.clamp(-limit, limit)).collect();
        let mut refined = rests.to_vec();
        for line in &self.lines {
            let along = dot(&clamped, line);
            refined.iter_mut().zip(line).for_each(|(rest, line)| *rest -= along * line);
        }
        refined
    }

    /// Half the sum of the squared residuals over those of a noise in units of that of the curve. The square of a point
    /// on the wrong side of a jump continues as a logarithm: measured displacements are not exact to the edge of a jump.
    fn cost(&self, member: &Member, noise: f64) -> f64 {
        let loss = |rest: &f64| {
            let rest = (rest / noise).abs();
            if rest > WRONG_SIDE {
                WRONG_SIDE * WRONG_SIDE * (0.5 + (rest / WRONG_SIDE).ln())
            } else {
                0.5 * rest * rest
            }
        };
        self.refined(&member.rests, WRONG_SIDE * noise).iter().map(loss).sum()
    }

    /// The start and points evenly scattered over the ranges, others in each attempt.
    fn scattered(&mut self, attempt: usize) -> Result<Vec<Member>, ExperimentError> {
        let Space { base, coordinates, .. } = self.space;
        let start: Vec<f64> = coordinates.iter().map(|one| one.of(one.start, base)).collect();
        let mut members = vec![self.member(start.clone())?];
        let count = SCAN * start.len();
        for number in attempt * count + 1..=(attempt + 1) * count {
            let rows = coordinates.iter().zip(PRIMES).zip(&start);
            let of = rows.map(|((one, prime), start)| {
                match (one.parameter, one.ends(), share_of(number, prime)) {
                    // Rough bodies touch before the force exceeds the noise.
                    (Parameter::Offset, (low, high), share) => (start + 8.0 * share - 6.5).clamp(low, high),
                    (Parameter::Zero, _, share) => start + 0.1 * (share - 0.5),
                    (_, (low, high), share) => low + share * (high - low),
                }
            });
            let at = of.collect();
            members.push(self.member(at)?);
        }
        Ok(members)
    }

    /// Finds the member of the least residuals, and coordinates that are distributed as the noise has it: by the better of
    /// two populations if the residuals of the first one exceed the noise, as one in thirty ends in another minimum.
    pub fn find(&mut self) -> Result<(Member, Vec<Vec<f64>>), ExperimentError> {
        let mut generator = ChaCha8Rng::seed_from_u64(SEED);
        let mut population = self.anneal(0, &mut generator)?;
        if population.cost > EXPECTED * 0.5 * population.best.rests.len() as f64 {
            let second = self.anneal(1, &mut generator)?;
            population = if second.cost < population.cost { second } else { population };
        }
        let mut samples = Vec::new();
        for _ in 0..LAST_MOVES {
            self.move_all(&mut population, &mut generator)?;
            samples.extend(population.members.iter().map(|member| member.at.clone()));
        }
        Ok((population.best, samples))
    }

    /// Coordinates of small residuals: those of one population.
    pub fn roughly(&mut self) -> Result<Vec<f64>, ExperimentError> {
        Ok(self.anneal(0, &mut ChaCha8Rng::seed_from_u64(SEED))?.best.at)
    }

    /// A population at the noise of the curve: with more members and coarse forces while the noise is large.
    fn anneal(&mut self, attempt: usize, generator: &mut ChaCha8Rng) -> Result<Population, ExperimentError> {
        self.model.noise = COARSE;
        let members = self.scattered(attempt)?;
        let costs = vec![0.0; members.len()];
        let mut population = Population {
            best: members[0].clone(),
            members,
            costs,
            noise: f64::INFINITY,
            cost: f64::INFINITY,
        };
        let count = MEMBERS + FOR_EACH * self.space.coordinates.len();
        loop {
            let least = self.space.misfit(&self.refined(&population.best.rests, WRONG_SIDE)).max(1.0);
            if population.noise <= least {
                return Ok(population);
            }
            let (noise, weights) = self.cooler(&population, least);
            let count = if noise > COARSE { MORE * count } else { count };
            let mut members = drawn(&population.members, &weights, count, generator.random());
            if noise < self.model.noise {
                self.model.noise = 1.0;
                population.cost = f64::INFINITY;
                for member in &mut members {
                    *member = self.member(std::mem::take(&mut member.at))?;
                    population.keep(member, self.cost(member, 1.0));
                }
            }
            let costs = members.iter().map(|member| self.cost(member, noise)).collect();
            population = Population { members, costs, noise, ..population };
            for _ in 0..MOVES {
                self.move_all(&mut population, generator)?;
            }
        }
    }

    /// The next noise, at least `least`, and the weights of the members there.
    fn cooler(&self, population: &Population, least: f64) -> (f64, Vec<f64>) {
        let weights = |noise: f64| -> Vec<f64> {
            let pairs = population.members.iter().zip(&population.costs);
            let changes: Vec<f64> = pairs.map(|(member, cost)| cost - self.cost(member, noise)).collect();
            let largest = ends(changes.iter().copied()).1;
            changes.iter().map(|change| (change - largest).exp()).collect()
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
            *if is_enough(&weights(middle)) { &mut high } else { &mut low } = middle;
        }
        // Never the same again.
        let next = if high < population.noise { high } else { SLOWEST * high };
        (next, weights(next))
    }

    /// Moves each member by differences of two others, or leaves it where it is (ter Braak, Stat. Comput. 16, 239, 2006).
    fn move_all(
        &mut self,
        population: &mut Population,
        generator: &mut ChaCha8Rng,
    ) -> Result<(), ExperimentError> {
        let usual = 2.38 / (2.0 * self.space.coordinates.len() as f64).sqrt();
        let count = population.members.len();
        for index in 0..count {
            let [one, other] = [(); 2].map(|()| &population.members[generator.random_range(0..count)].at);
            let length = usual * (0.5 + generator.random::<f64>());
            let chance: f64 = generator.random();
            let here = &population.members[index].at;
            let moved =
                here.iter().zip(one.iter().zip(other)).map(|(at, (one, other))| at + length * (one - other));
            let at: Vec<f64> = moved.collect();
            let is_within = |(at, one): (&f64, &Coordinate)| (one.ends().0..=one.ends().1).contains(at);
            if at == *here || !at.iter().zip(&self.space.coordinates).all(is_within) {
                continue;
            }
            let member = self.member(at)?;
            let cost = self.cost(&member, population.noise);
            if chance < (population.costs[index] - cost).exp() {
                population.keep(&member, self.cost(&member, 1.0));
                (population.members[index], population.costs[index]) = (member, cost);
            }
        }
        Ok(())
    }
}

/// Draws members by their weights, evenly from a share of the first one on.
fn drawn(members: &[Member], weights: &[f64], count: usize, share: f64) -> Vec<Member> {
    let step = weights.iter().sum::<f64>() / count as f64;
    let (mut drawn, mut sum) = (Vec::with_capacity(count), 0.0);
    for (member, weight) in members.iter().zip(weights) {
        sum += weight;
        while drawn.len() < count && (drawn.len() as f64 + share) * step < sum {
            drawn.push(member.clone());
        }
    }
    drawn
}

/// Point from 0 to 1 of an evenly scattered sequence (van der Corput).
fn share_of(number: usize, base: usize) -> f64 {
    if number == 0 { 0.0 } else { ((number % base) as f64 + share_of(number / base, base)) / base as f64 }
}
