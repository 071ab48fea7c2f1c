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
use crate::error::{ExperimentError, refused_with};
use crate::fit::agreement::MISFIT;
use crate::fit::descent::descend;
use crate::fit::lines::Lines;
use crate::fit::model::Model;
use crate::fit::parameter::{Coordinate, Parameter};
use crate::fit::population::{Member, Population, WRONG_SIDE, drawn, loss, share_of};
use crate::fit::space::Space;
use crate::fit::statistics::scale;
use crate::fit::two_spheres::exchanged;
use asperity_contact::ContactError;
use asperity_data::Remedy;
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};

const SEED: u64 = 29;
/// Number of members drawn at first for each free parameter.
const SCAN: usize = 60;
/// Number of members of a population, without those for each free parameter.
const MEMBERS: usize = 24;
/// Number of further members for each free parameter.
const FOR_EACH: usize = 8;
/// Share of the members that still count after a step of the noise.
const EFFECTIVE: f64 = 0.3;
/// Largest number of moves of the population at each step.
const MOVES: usize = 5;
/// Largest number of rounds of such moves before the end, and mean growth of the logarithm of the
/// extent of a coordinate in one round, up to which no further round follows.
const ROUNDS: usize = 20;
const GROWN: f64 = 0.05;
/// Number of moves at the end, each of which adds all members to the samples.
const LAST_MOVES: usize = 32;
/// Share of the moves that are random steps.
const RANDOM: f64 = 0.02;
/// Number of decades below the whole range over which the lengths of random steps extend.
const DECADES: f64 = 6.0;
/// Number of decades below the whole range over which the distances of members from a start extend.
const DECADES_OF_CLOUD: f64 = 4.0;
/// Noise, divided by the noise of the curve, above which forces are computed coarsely.
const COARSE: f64 = 10.0;
/// Factor of the number of members while forces are coarse.
const MORE: usize = 2;
/// Divisor of the residual of the best member. The noise is lowered to this part of the residual,
/// if the residual exceeds the noise of the curve.
const DEEPER: f64 = 3.0;
/// Residual in contact, in units of the noise, above which a population belongs to a model that
/// does not describe the curve.
const SYSTEMATIC: f64 = 5.0;
/// Share of this residual below which another population is better.
const BETTER: f64 = 0.9;
/// Mean square residual, in units of the noise, beyond which another population is made.
const EXPECTED: f64 = 1.2;
/// Standard deviations by which the cost of few points may exceed the expected one by chance.
const CHANCE: f64 = 3.0;
/// Largest number of populations.
const ATTEMPTS: usize = 3;
/// Difference of costs by which a start must be better than a population to count as missed.
const MISSED: f64 = 3.0;
/// Step of the coordinates in the first simplex of a descent.
const FIRST_STEP: f64 = 0.3;
/// Factor of this step from one descent to the next.
const SHORTER: f64 = 0.6;
/// Largest number of descents, each at a lower noise.
const DESCENTS: usize = 12;
/// Share of the residual that must be left after a descent for another one to be tried.
const NO_BETTER: f64 = 0.97;
/// Number of curves in a descent for each coordinate.
const CURVES: usize = 40;
/// Largest noise divided by the noise of the curve.
const LARGE: f64 = 1e6;
/// Number of halvings to determine a step of the logarithm of the noise.
const HALVINGS: usize = 12;
/// Factor of the noise in a step where no smaller factor leaves enough members.
const SLOWEST: f64 = 0.99;
/// Coordinate of the work of adhesion below which a scene without adhesion is tried. It is a few
/// times the work that the noise hides.
const CLOSE: f64 = 2.5;
/// Residual, in units of the noise, that replaces a force that is not finite.
const FAR: f64 = 1e12;
/// Bases of the sequences of evenly scattered points, one for each coordinate.
const PRIMES: [usize; 9] = [2, 3, 5, 7, 11, 13, 17, 19, 23];

/// Result of a search.
pub(crate) struct SearchResult {
    /// The member with the smallest residuals.
    pub best: Member,
    /// Residuals of the best member in contact after a fit of the lines, in units of the noise.
    pub residuals: Vec<f64>,
    /// Noise of the distribution of the samples, divided by the noise of the curve. It is above 1
    /// where the residual is.
    pub noise: f64,
    /// Coordinates, distributed as the noise allows.
    pub samples: Vec<Vec<f64>>,
    /// Other places that are nearly as good as the best one, and may be far from it.
    pub alternatives: Vec<Vec<f64>>,
    /// Costs of each sample for each block of the curve; empty if the model describes the curve.
    pub blocks: Vec<Vec<f64>>,
    /// Smallest cost of a scene without adhesion minus the cost of the best member; infinite if no
    /// sample is close to zero adhesion.
    pub without_adhesion: f64,
}

/// Lower noise of a population, and the weights of its members at this noise.
struct Cooling {
    noise: f64,
    weights: Vec<f64>,
}

/// Search on one random profile.
pub(crate) struct Search<'a> {
    pub space: &'a Space<'a>,
    pub model: Model<'a>,
    pub lines: Lines,
    /// Receives the number of curves computed so far.
    pub report: &'a mut dyn FnMut(usize),
}

impl Search<'_> {
    fn member(&mut self, place: Vec<f64>) -> Result<Member, ExperimentError> {
        if (self.space.stop)() {
            return Err(ContactError::Interrupted.into());
        }
        (self.report)(self.model.evaluations);
        let curve = self.space.curve;
        let values = self.space.values(&place);
        let zero = values[Parameter::Zero as usize];
        let forces = self.model.forces(&values)?;
        let mut residuals = Vec::with_capacity(forces.len());
        let mut in_contact = curve.in_contact();
        for (index, force) in forces.iter().enumerate() {
            let residual = (curve.force[index] - force) / curve.noise;
            residuals.push(if residual.is_finite() { residual } else { FAR });
            // The model of a separated body has exactly the force before contact.
            in_contact[index] |= *force != zero;
        }
        Ok(Member {
            place,
            residuals,
            in_contact,
        })
    }

    /// Computes the member at a place, with exact forces.
    pub fn exact(&mut self, place: &[f64]) -> Result<Member, ExperimentError> {
        self.model.noise = 1.0;
        self.member(place.to_vec())
    }

    /// Returns residuals in which points inside a jump count as described. A residual above
    /// [`WRONG_SIDE`] becomes the distance from the forces of a jump of the model, if the jump is
    /// within one point.
    pub fn beyond_jumps(
        &mut self,
        place: &[f64],
        residuals: &[f64],
    ) -> Result<Vec<f64>, ExperimentError> {
        let noise = self.space.curve.noise;
        self.model.noise = 1.0;
        let values = self.space.values(place);
        let jumps = self.model.jumps(&values, WRONG_SIDE * noise)?;
        let mut beyond = residuals.to_vec();
        for (residual, jump) in beyond.iter_mut().zip(jumps) {
            if let Some(jump) = jump
                && residual.abs() > WRONG_SIDE
            {
                *residual -= residual.clamp(jump.low / noise, jump.high / noise);
            }
        }
        Ok(beyond)
    }

    /// Returns the residual in contact, in units of the noise of the curve, after a fit of the
    /// lines at this noise; see [`scale`].
    fn misfit(&self, member: &Member, noise: f64) -> f64 {
        let residuals = self.lines.refined(&member.residuals, noise);
        scale(&member.contact_residuals(&residuals), WRONG_SIDE)
    }

    /// Returns the residual without contact, in units of the noise of the curve, if a drift or a
    /// tilt remains there; otherwise 0. It is as large in contact, where other parameters hide it.
    fn remaining_line(&self, member: &Member) -> f64 {
        let curve = self.space.curve;
        if curve.remaining[..2] == [0.0; 2] {
            return 0.0;
        }
        let residuals = self.lines.refined(&member.residuals, 1.0);
        let points = residuals.iter().zip(&member.in_contact);
        let free: Vec<f64> = points
            .filter(|(_, in_contact)| !**in_contact)
            .map(|(residual, _)| *residual)
            .collect();
        if free.is_empty() {
            0.0
        } else {
            scale(&free, WRONG_SIDE)
        }
    }

    /// Returns the cost of a member at this noise, in units of the noise of the curve: the sum of
    /// the [`loss`] of all points.
    fn cost(&self, member: &Member, noise: f64) -> f64 {
        self.lines
            .refined(&member.residuals, noise)
            .iter()
            .map(|residual| loss(residual / noise))
            .sum()
    }

    /// Returns the costs of a member at this noise, for each block of points.
    fn block_costs(&self, member: &Member, noise: f64, blocks: &[Vec<usize>]) -> Vec<f64> {
        let residuals = self.lines.refined(&member.residuals, noise);
        let mut costs = Vec::with_capacity(blocks.len());
        for block in blocks {
            let losses = block.iter().map(|index| loss(residuals[*index] / noise));
            costs.push(losses.sum());
        }
        costs
    }

    /// Returns points evenly scattered over the ranges, different ones in each attempt.
    fn scattered(&mut self, attempt: usize) -> Result<Vec<Member>, ExperimentError> {
        let coordinates = &self.space.coordinates;
        let start = self.space.start();
        let count = SCAN * start.len();
        let mut members = Vec::with_capacity(count + 1);
        for number in attempt * count + 1..=(attempt + 1) * count {
            let mut place = Vec::with_capacity(start.len());
            for (index, coordinate) in coordinates.iter().enumerate() {
                let share = share_of(number, PRIMES[index]);
                place.push(scattered_coordinate(coordinate, start[index], share));
            }
            members.push(self.member(place)?);
        }
        Ok(members)
    }

    /// Returns the member to which the costs fall from the start. The noise falls with the residuals,
    /// so that first all points count and in the end those at jumps count little. A descent is no
    /// sample, but it follows a narrow valley that a population may miss.
    pub fn descended(&mut self) -> Result<Member, ExperimentError> {
        self.descended_from(self.space.start())
    }

    /// Does the same as [`Search::descended`] from another place.
    fn descended_from(&mut self, place: Vec<f64>) -> Result<Member, ExperimentError> {
        self.model.noise = 1.0;
        let mut best = self.member(place)?;
        let mut noise = self.misfit(&best, f64::INFINITY).clamp(1.0, LARGE);
        let mut step = FIRST_STEP;
        for _ in 0..DESCENTS {
            let start = best.place.clone();
            let most = CURVES * start.len();
            let mut cost = |place: &[f64]| {
                let member = self.member(self.space.inside(place))?;
                Ok::<f64, ExperimentError>(self.cost(&member, noise))
            };
            let place = descend(&start, step, most, &mut cost)?;
            best = self.member(self.space.inside(&place))?;
            let misfit = self.misfit(&best, noise).clamp(1.0, LARGE);
            let is_lowest = noise <= 1.0;
            let has_improved = misfit < NO_BETTER * noise;
            noise = misfit.min(0.5 * noise).max(1.0);
            step *= SHORTER;
            if is_lowest || (!has_improved && step < FIRST_STEP * SHORTER.powi(3)) {
                break;
            }
        }
        Ok(best)
    }

    /// Finds the member with the smallest residuals, and samples of the coordinates. Another
    /// population is drawn in three cases. The residuals exceed the noise, as one population in
    /// thirty ends in another minimum and one in 200 twice. The population has missed a better
    /// start, which then becomes a member of the next one. The population has not spread.
    pub fn find(&mut self) -> Result<SearchResult, ExperimentError> {
        let (population, generator) = self.first()?;
        self.find_from(population, generator)
    }

    /// Returns the first population, and the generator that made it.
    pub fn first(&mut self) -> Result<(Population, ChaCha8Rng), ExperimentError> {
        let mut generator = ChaCha8Rng::seed_from_u64(SEED);
        let population = self.anneal(0, None, 0.0, &mut generator)?;
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
    ) -> Result<SearchResult, ExperimentError> {
        self.model.noise = 1.0;
        let mut start = self.member(self.space.start())?;
        let mut rivals = self.rivals(&population.best)?;
        for rival in &rivals {
            let noise = population.noise;
            if self.cost(rival, noise) < self.cost(&start, noise) {
                start = rival.clone();
            }
        }
        for attempt in 1..ATTEMPTS {
            let is_poor = self.is_poor(&population.best)?;
            let has_missed = self.cost(&start, population.noise) < population.cost - MISSED;
            let has_spread = population.has_spread();
            if has_spread && !has_missed && !is_poor {
                break;
            }
            // If the residuals are no noise, another population that comes to the same residuals
            // ends there.
            let misfit = self.misfit(&population.best, population.noise);
            let is_rival = has_spread && !has_missed && misfit > SYSTEMATIC;
            let rival = if is_rival { BETTER * misfit } else { 0.0 };
            let missed = has_missed.then_some(&start);
            let other = self.anneal(attempt, missed, rival, &mut generator)?;
            if rival > 0.0 && self.misfit(&other.best, other.noise) > rival {
                break;
            }
            let noise = population.noise.min(other.noise);
            if !has_spread || self.cost(&other.best, noise) < self.cost(&population.best, noise) {
                population = other;
            }
        }
        population.keep(&start, self.cost(&start, population.noise));
        let mut result = self.sample(population, &mut generator)?;
        rivals.extend(self.with_exchanged_spheres(&result.best)?);
        let least = self.cost(&result.best, result.noise);
        for rival in rivals {
            if self.cost(&rival, result.noise) < least + MISSED {
                result.alternatives.push(rival.place);
            }
        }
        Ok(result)
    }

    /// Returns members that may be better than the best one of a population: by descents from starts
    /// if its residuals exceed the noise, or if the body has two spheres, which may be exchanged.
    fn rivals(&mut self, best: &Member) -> Result<Vec<Member>, ExperimentError> {
        let has_two_spheres = !self.space.other_starts.is_empty();
        let mut rivals = Vec::new();
        if has_two_spheres || self.is_poor(best)? {
            rivals.push(self.descended()?);
        }
        for values in &self.space.other_starts {
            rivals.push(self.descended_from(self.space.place(values))?);
        }
        rivals.extend(self.with_exchanged_spheres(best)?);
        Ok(rivals)
    }

    /// Returns the member to which the costs fall if two spheres are exchanged; `None` for another
    /// body.
    fn with_exchanged_spheres(&mut self, best: &Member) -> Result<Option<Member>, ExperimentError> {
        if self.space.other_starts.is_empty() {
            return Ok(None);
        }
        let values = exchanged(&self.space.values(&best.place));
        let place = self.space.place(&values);
        self.descended_from(place).map(Some)
    }

    /// Returns true if the residuals of a member, apart from points inside jumps, exceed the noise.
    fn is_poor(&mut self, member: &Member) -> Result<bool, ExperimentError> {
        let residuals = self.lines.refined(&member.residuals, 1.0);
        let residuals = self.beyond_jumps(&member.place, &residuals)?;
        let residuals = member.contact_residuals(&residuals);
        let cost: f64 = residuals.iter().map(|residual| loss(*residual)).sum();
        // The cost of noise is half the number of points, with a standard deviation of the root of it.
        let expected = 0.5 * residuals.len() as f64;
        Ok(cost > (EXPECTED * expected).max(expected + CHANCE * expected.sqrt()))
    }

    /// Samples the coordinates at the noise of the curve, or at the residual if it is larger.
    fn sample(
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
        let parts = self.space.blocks(&population.best.in_contact);
        for _ in 0..LAST_MOVES {
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

    /// Moves the members of a population until its extent grows no more. After a step of the noise it
    /// may be smaller than that of the distribution, above all if a start was copied.
    fn spread_out(
        &mut self,
        population: &mut Population,
        generator: &mut ChaCha8Rng,
    ) -> Result<(), ExperimentError> {
        let mut extent = population.log_extent();
        for _ in 0..ROUNDS {
            for _ in 0..MOVES {
                self.move_all(population, generator)?;
            }
            let before = extent;
            extent = population.log_extent();
            if extent <= before + GROWN {
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
    /// residual. While the noise is large the population has more members and coarse forces. It
    /// ends early if its residual is above the residual `rival` at the noise of the rival. `start`
    /// becomes one of the first members.
    fn anneal(
        &mut self,
        attempt: usize,
        start: Option<&Member>,
        rival: f64,
        generator: &mut ChaCha8Rng,
    ) -> Result<Population, ExperimentError> {
        self.model.noise = COARSE;
        let mut population = self.first_members(attempt, start, generator)?;
        let count = MEMBERS + FOR_EACH * self.space.coordinates.len();
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

    /// Returns members around a start, at distances of all sizes. Copies of the start alone would have
    /// no extent.
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

    /// Returns a population of scattered members and a start, at an infinite noise.
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

    /// Recomputes a population exactly if its forces are coarse.
    fn refine(&mut self, population: &mut Population) -> Result<(), ExperimentError> {
        if self.model.noise > 1.0 {
            self.model.noise = 1.0;
            for member in population.members.iter_mut().chain([&mut population.best]) {
                *member = self.member(std::mem::take(&mut member.place))?;
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
        // The noise falls in each step, so that the search ends.
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

    /// Returns the weights of the members if the noise of a population falls to this noise; the
    /// largest is 1.
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

    /// Proposes a move for each member; rejected moves leave it where it is.
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

    /// Returns a new place for a member: moved by the difference of two others (ter Braak, Stat.
    /// Comput. 16, 239, 2006) or by a random step along one coordinate.
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

/// Returns a coordinate of an evenly scattered point, for a share of its range from 0 to 1.
fn scattered_coordinate(coordinate: &Coordinate, start: f64, share: f64) -> f64 {
    let (low, high) = coordinate.ends();
    match coordinate.parameter {
        // Rough bodies touch before the force exceeds the noise.
        Parameter::Offset => (start + 8.0 * share - 6.5).clamp(low, high),
        Parameter::Zero => start + 0.1 * (share - 0.5),
        _ => low + share * (high - low),
    }
}
