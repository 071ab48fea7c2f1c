//! Annealing: members of a population move at random, while the assumed noise falls to the noise of
//! the curve.

use super::{COARSE, Cooling, LARGE, SCAN, Search, SearchResult};
use crate::curve::numerics::{Extent, dot};
use crate::error::{ExperimentError, refused_with};
use crate::fit::agreement::MISFIT;
use crate::fit::parameter::Coordinate;
use crate::fit::population::{Member, Population, drawn};
use asperity_contact::ContactError;
use asperity_data::{Remedy, mean};
use rand::RngExt;
use rand::rngs::ChaCha8Rng;

/// Number of members of a population, to which [`FOR_EACH`] members for each free parameter are
/// added.
const MEMBERS: usize = 24;

/// Number of further members for each free parameter.
const FOR_EACH: usize = 8;

/// Smallest effective number of members after a step of the noise, as a share of all members. The
/// effective number is (Σw)²/Σw² for the weights w of the members.
const EFFECTIVE: f64 = 0.3;

/// Largest number of moves of the population at each step.
const MOVES: usize = 5;

/// Largest number of rounds of moves before the samples are drawn.
const ROUNDS: usize = 20;

/// Growth of the logarithm of the extent of a coordinate in a round, as a mean over the
/// coordinates, up to which no further round follows.
const GROWN: f64 = 0.05;

/// Growth of the logarithm of the extent of any one coordinate in a round. If the half-space
/// relaxes, a further round follows above this growth.
const GROWN_ALONG_ONE: f64 = 0.15;

/// Number of moves at the end, each of which adds all members to the samples.
const LAST_MOVES: usize = 32;

/// Number of moves at the end for a half-space that relaxes, whose curves take long to compute.
/// Fewer moves suffice, because its first population already has nearly the distribution of the
/// samples.
const LAST_MOVES_OF_RELAXATION: usize = 12;

/// Share of the moves that are random steps.
const RANDOM: f64 = 0.02;

/// Number of decades over which the lengths of random steps extend, from the whole range of a
/// parameter downwards.
const DECADES: f64 = 6.0;

/// Number of decades below the whole range over which the distances of members from a start extend.
const DECADES_OF_CLOUD: f64 = 4.0;

/// Factor by which the number of members is larger while the forces have low accuracy.
const MORE: usize = 2;

/// If the residual of the best member exceeds the noise of the curve, the noise is lowered only to
/// the residual divided by this number.
const DEEPER: f64 = 3.0;

/// Number of bisections that determine the next noise, on a logarithmic scale.
const HALVINGS: usize = 12;

/// Factor by which the noise is lowered in a step if no smaller factor leaves enough effective
/// members.
const SLOWEST: f64 = 0.99;

/// Coordinate of the work of adhesion in the search. If a sample lies below it, a scene without
/// adhesion is tried too. The value corresponds to a few times the work of adhesion whose pull-off
/// force equals the noise.
const CLOSE: f64 = 2.5;

impl Search<'_> {
    /// Draws samples of the coordinates from their probability distribution. The distribution
    /// assumes the noise of the curve, or a noise as large as the residual of the best member if
    /// the residual is larger.
    pub(super) fn sample(
        &mut self,
        mut population: Population,
        generator: &mut ChaCha8Rng,
    ) -> Result<SearchResult, ExperimentError> {
        let misfit = self.misfit(&population.best, population.noise);
        let noise = misfit.max(self.remaining_line(&population.best)).max(1.0);
        self.set_noise(&mut population, noise);
        self.spread_out(&mut population, generator)?;
        let mut samples = Vec::new();
        let mut blocks = Vec::new();
        let parts = self.blocks(&population.best);
        let moves = if self.space.relaxes() {
            LAST_MOVES_OF_RELAXATION
        } else {
            LAST_MOVES
        };
        for _ in 0..moves {
            self.move_all(&mut population, generator)?;
            for member in &population.members {
                samples.push(member.place.clone());
                if noise > MISFIT {
                    blocks.push(self.block_costs(member, noise, &parts));
                }
            }
        }
        if !population.has_spread() {
            let found = format!(
                "the search ends at {} values of the parameters",
                population.distinct()
            );
            let allowed = "more; other ranges of the parameters, or a larger noise";
            return refused_with(found, allowed, [Remedy::FreeRange, Remedy::Noise]);
        }
        let without_adhesion = self.without_adhesion(&population, &samples)?;
        let residuals = self.lines.refined(&population.best.residuals, noise);
        let residuals = population.best.contact_residuals(&residuals);
        Ok(SearchResult {
            best: population.best,
            residuals,
            noise,
            samples,
            alternatives: Vec::new(),
            blocks,
            without_adhesion,
        })
    }

    /// Returns the blocks of all curves. Each segment of a curve is divided into parts, and a block
    /// has the indices of the points of one part that are in contact.
    fn blocks(&self, member: &Member) -> Vec<Vec<usize>> {
        let mut blocks = self.space.blocks(&member.in_contact);
        let mut first = self.space.curve.force.len();
        for further in &self.further {
            for mut block in further.space.blocks(&member.in_contact[first..]) {
                for index in &mut block {
                    *index += first;
                }
                blocks.push(block);
            }
            first += further.space.curve.force.len();
        }
        blocks
    }

    /// Moves the members of a population until its extent grows no more. After a step of the noise,
    /// the extent of the population may be smaller than that of the probability distribution, above
    /// all if many members are copies of a start.
    fn spread_out(
        &mut self,
        population: &mut Population,
        generator: &mut ChaCha8Rng,
    ) -> Result<(), ExperimentError> {
        let mut extents = population.log_extents();
        for _ in 0..ROUNDS {
            for _ in 0..MOVES {
                self.move_all(population, generator)?;
            }
            let before = extents;
            extents = population.log_extents();
            let grown: Vec<f64> = extents
                .iter()
                .zip(&before)
                .map(|(now, then)| now - then)
                .collect();
            let largest = Extent::of(grown.iter().copied()).high;
            // Share and time of a relaxation may be on a long and narrow ridge, along which the
            // population grows slowly.
            let grows_along_one = self.space.relaxes() && largest > GROWN_ALONG_ONE;
            if mean(&grown) <= GROWN && !grows_along_one {
                break;
            }
        }
        Ok(())
    }

    /// Returns the smallest cost of a scene without adhesion minus the cost of the best member;
    /// infinite if no sample is close to zero adhesion.
    fn without_adhesion(
        &mut self,
        population: &Population,
        samples: &[Vec<f64>],
    ) -> Result<f64, ExperimentError> {
        let mut least = f64::INFINITY;
        let coordinates = &self.space.coordinates;
        let Some(work) = coordinates.iter().position(Coordinate::is_work_from_zero) else {
            return Ok(least);
        };
        if !samples.iter().any(|place| place[work] < CLOSE) {
            return Ok(least);
        }
        for member in &population.members {
            let mut place = member.place.clone();
            place[work] = 0.0;
            let member = self.member(place)?;
            least = least.min(self.cost(&member, population.noise) - population.cost);
        }
        Ok(least)
    }

    /// Returns a population whose noise was lowered to the noise of the curve, or to a part of the
    /// residual. While the noise is large, the population has more members and forces of low
    /// accuracy. The search ends early if the noise has reached the residual `rival` of an earlier
    /// population and the residual is still larger. `start` becomes one of the first members.
    pub(super) fn anneal(
        &mut self,
        attempt: usize,
        start: Option<&Member>,
        rival: f64,
        generator: &mut ChaCha8Rng,
    ) -> Result<Population, ExperimentError> {
        self.set_accuracy(COARSE);
        let mut population = self.first_members(attempt, start, generator)?;
        let count = self.count_of_members();
        loop {
            let misfit = self.misfit(&population.best, population.noise);
            let least = (misfit / DEEPER).max(1.0);
            let is_cool = population.noise <= least;
            let has_lost = population.noise <= rival && misfit > rival;
            if is_cool || has_lost {
                self.refine(&mut population)?;
                return Ok(population);
            }
            let Cooling { noise, weights } = self.cooler(&population, least);
            let count = if noise > COARSE { MORE * count } else { count };
            let share = generator.random();
            population.members = drawn(&population.members, &weights, count, share);
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

    pub(super) fn count_of_members(&self) -> usize {
        MEMBERS + FOR_EACH * self.space.coordinates.len()
    }

    /// Returns members around a start, at distances of all sizes. Copies of the start alone would
    /// have no extent.
    fn cloud(
        &mut self,
        start: &Member,
        generator: &mut ChaCha8Rng,
    ) -> Result<Vec<Member>, ExperimentError> {
        let count = SCAN * start.place.len();
        let mut members = Vec::with_capacity(count);
        for _ in 0..count {
            let scale = 10_f64.powf(-DECADES_OF_CLOUD * generator.random::<f64>());
            let mut place = Vec::with_capacity(start.place.len());
            for (coordinate, from) in self.space.coordinates.iter().zip(&start.place) {
                let (low, high) = coordinate.ends();
                let step = scale * (2.0 * generator.random::<f64>() - 1.0);
                place.push((from + (high - low) * step).clamp(low, high));
            }
            members.push(self.member(place)?);
        }
        Ok(members)
    }

    /// Returns the first population, at an infinite noise. It has scattered members and, if a start
    /// is given, the start and members around it.
    fn first_members(
        &mut self,
        attempt: usize,
        start: Option<&Member>,
        generator: &mut ChaCha8Rng,
    ) -> Result<Population, ExperimentError> {
        let mut members = self.scattered(attempt)?;
        if let Some(start) = start {
            members.extend(self.cloud(start, generator)?);
            members.push(start.clone());
        }
        let misfit = |member: &Member| self.misfit(member, f64::INFINITY);
        let best = members
            .iter()
            .min_by(|member, next| misfit(member).total_cmp(&misfit(next)))
            .cloned()
            .ok_or(ContactError::Internal("no values have been drawn"))?;
        Ok(Population {
            costs: vec![0.0; members.len()],
            members,
            noise: f64::INFINITY,
            best,
            cost: f64::INFINITY,
        })
    }

    /// Computes the forces of a population again with full accuracy, if they have low accuracy.
    fn refine(&mut self, population: &mut Population) -> Result<(), ExperimentError> {
        if self.model.noise > 1.0 {
            self.set_accuracy(1.0);
            for member in population.members.iter_mut().chain([&mut population.best]) {
                *member = self.member(std::mem::take(&mut member.place))?;
            }
            self.set_noise(population, population.noise);
        }
        Ok(())
    }

    /// Sets the noise of a population and computes its costs.
    pub(super) fn set_noise(&self, population: &mut Population, noise: f64) {
        population.costs = population
            .members
            .iter()
            .map(|member| self.cost(member, noise))
            .collect();
        population.noise = noise;
        population.cost = self.cost(&population.best, noise);
        let costs = population.costs.iter().enumerate();
        let best = costs.min_by(|(_, cost), (_, next)| cost.total_cmp(next));
        if let Some((best, &cost)) = best {
            population.keep(&population.members[best].clone(), cost);
        }
    }

    /// Returns the next lower noise, at least `least`, and the weights of the members at this
    /// noise.
    fn cooler(&self, population: &Population, least: f64) -> Cooling {
        let enough = EFFECTIVE * population.members.len() as f64;
        let is_enough =
            |weights: &[f64]| weights.iter().sum::<f64>().powi(2) >= enough * dot(weights, weights);
        let weights = self.weights(population, least);
        if is_enough(&weights) {
            return Cooling {
                noise: least,
                weights,
            };
        }
        let mut low = least;
        let mut high = population.noise.min(LARGE);
        for _ in 0..HALVINGS {
            let middle = (low * high).sqrt();
            if is_enough(&self.weights(population, middle)) {
                high = middle;
            } else {
                low = middle;
            }
        }
        // The noise has to decrease in each step, so that the search ends.
        let noise = if high < population.noise {
            high
        } else {
            SLOWEST * high
        };
        Cooling {
            noise,
            weights: self.weights(population, noise),
        }
    }

    /// Returns the weights of the members for a step of the population from its present noise to
    /// `noise`. The largest weight is 1.
    fn weights(&self, population: &Population, noise: f64) -> Vec<f64> {
        let members = population.members.iter().zip(&population.costs);
        let changes: Vec<f64> = members
            .map(|(member, cost)| cost - self.cost(member, noise))
            .collect();
        let largest = Extent::of(changes.iter().copied()).high;
        changes
            .iter()
            .map(|change| (change - largest).exp())
            .collect()
    }

    /// Proposes a move for each member. A member remains unchanged if its move is rejected.
    fn move_all(
        &mut self,
        population: &mut Population,
        generator: &mut ChaCha8Rng,
    ) -> Result<(), ExperimentError> {
        for index in 0..population.members.len() {
            let place = self.proposal(population, index, generator);
            let chance: f64 = generator.random();
            if place == population.members[index].place || !self.space.contains(&place) {
                continue;
            }
            let member = self.member(place)?;
            let cost = self.cost(&member, population.noise);
            if chance < (population.costs[index] - cost).exp() {
                population.keep(&member, cost);
                population.members[index] = member;
                population.costs[index] = cost;
            }
        }
        Ok(())
    }

    /// Returns new coordinates for a member. The member moves by the difference between two other
    /// members (ter Braak, Stat. Comput. 16, 239, 2006), or by a random step along one coordinate.
    fn proposal(
        &self,
        population: &Population,
        index: usize,
        generator: &mut ChaCha8Rng,
    ) -> Vec<f64> {
        let mut place = population.members[index].place.clone();
        let length: f64 = generator.random();
        if generator.random::<f64>() < RANDOM {
            let moved = generator.random_range(0..place.len());
            let (low, high) = self.space.coordinates[moved].ends();
            let scale = 10_f64.powf(-DECADES * generator.random::<f64>());
            place[moved] += (high - low) * (2.0 * length - 1.0) * scale;
            return place;
        }
        let usual = 2.38 / (2.0 * self.space.coordinates.len() as f64).sqrt();
        let count = population.members.len();
        let from = &population.members[generator.random_range(0..count)].place;
        let to = &population.members[generator.random_range(0..count)].place;
        for (coordinate, (start, end)) in place.iter_mut().zip(from.iter().zip(to)) {
            *coordinate += usual * (0.5 + length) * (start - end);
        }
        place
    }
}
