//! The search for the parameters that describe a curve, with their errors. A population samples the
//! probability of the parameters (sequential Monte Carlo; Del Moral, Doucet, Jasra, J. R. Stat.
//! Soc. B 68, 411, 2006).
//!
//! The computed force is not a continuous function of the parameters, because the contact has
//! jumps. So neither derivatives nor a linearised fit can show how well a curve determines the
//! parameters. A population can: a set of members, each of which has a value for each parameter.
//! The members are drawn from the ranges of the parameters. At first they are weighted as if the
//! noise were so large that jumps have little influence. The noise is then lowered step by step to
//! the noise of the curve. At each step likely members are copied and unlikely members are dropped.
//! Each member then moves by the difference between two other members, so that the moves have the
//! extent and direction of the population. Some moves are random steps of any size, so that copies
//! separate again. At the end the distribution of the members is the probability distribution of
//! the parameters. The initial values are not made a member of the first population, because a
//! member close to the result would be copied to the whole population.

mod annealing;
mod local;

use crate::curve::MeasuredCurve;
use crate::error::ExperimentError;
use crate::fit::descent::descend;
use crate::fit::further::FurtherCurve;
use crate::fit::lines::Lines;
use crate::fit::model::Model;
use crate::fit::parameter::{Coordinate, Parameter, Values};
use crate::fit::population::{Member, Population, WRONG_SIDE, loss, share_of};
use crate::fit::space::Space;
use crate::fit::statistics::scale;
use crate::fit::two_spheres::exchanged;
use asperity_contact::ContactError;
use rand::SeedableRng;
use rand::rngs::ChaCha8Rng;

/// Seed of the random generator, so that the same curve and scene give the same result.
const SEED: u64 = 29;
/// Number of members drawn at first for each free parameter.
const SCAN: usize = 60;
/// Residual in contact, in units of the noise, above which the model does not describe the curve,
/// so that a further population is stopped early.
const SYSTEMATIC: f64 = 5.0;
/// Share of the residual of the first population that another population must fall below to count
/// as better.
const BETTER: f64 = 0.9;
/// Mean square residual in contact, in units of the squared noise, above which descents begin and
/// another population is drawn.
const EXPECTED: f64 = 1.2;
/// Number of standard deviations by which the cost may exceed its expected value by chance. This
/// limit replaces [`EXPECTED`] for curves with few points.
const CHANCE: f64 = 3.0;
/// Largest number of populations.
const ATTEMPTS: usize = 3;
/// Difference of two costs that matters. A population has missed the minimum if its cost exceeds
/// the cost of the initial values, or of the end of a descent, by more than this. The end of a
/// descent is an alternative if its cost exceeds the cost of the best member by less than this.
const MISSED: f64 = 3.0;
/// Step of the coordinates in the first simplex of a descent.
const FIRST_STEP: f64 = 0.3;
/// Factor by which the step of the first simplex becomes shorter from one descent to the next.
const SHORTER: f64 = 0.6;
/// Largest number of descents, each at a lower noise.
const DESCENTS: usize = 12;
/// Ratio of the residual after a descent to the noise that the descent assumed, below which the
/// descent has improved the residual.
const NO_BETTER: f64 = 0.97;
/// Largest number of curves that a descent computes for each coordinate.
const CURVES: usize = 40;
/// Largest noise divided by the noise of the curve.
const LARGE: f64 = 1e6;
/// Noise, divided by the noise of the curve, above which forces are computed coarsely.
const COARSE: f64 = 10.0;
/// Residual, in units of the noise, of a point whose computed force is not finite.
const FAR: f64 = 1e12;
/// Bases of the sequences of evenly scattered points, one for each coordinate.
const PRIMES: [usize; 32] = [
    2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37, 41, 43, 47, 53, 59, 61, 67, 71, 73, 79, 83, 89, 97,
    101, 103, 107, 109, 113, 127, 131,
];

/// Result of a search.
pub(crate) struct SearchResult {
    /// Member with the smallest residuals. A member is a set of values of the parameters.
    pub best: Member,
    /// Residuals of the best member at the points in contact, in units of the noise. Zero, drift
    /// and other contributions to the force have been fitted to them.
    pub residuals: Vec<f64>,
    /// Standard deviation of the noise that the probability distribution of the samples assumes,
    /// divided by the noise of the curve. It is above 1 if the residual of the best member exceeds
    /// the noise of the curve.
    pub noise: f64,
    /// Samples from the probability distribution of the parameters, each given by its coordinates.
    pub samples: Vec<Vec<f64>>,
    /// Other sets of parameters that describe the curve nearly as well as the best one, each given
    /// by its coordinates. They may be far from the best one.
    pub alternatives: Vec<Vec<f64>>,
    /// Cost of each sample in each block. A block is a part of the points of the curve. The list is
    /// empty if the model describes the curve.
    pub blocks: Vec<Vec<f64>>,
    /// Difference of two costs: the smallest cost of a scene without adhesion minus the cost of the
    /// best member. Infinite if no sample is close to zero adhesion.
    pub without_adhesion: f64,
}

/// Next, lower noise of a population, and the weights of its members for this noise.
struct Cooling {
    noise: f64,
    weights: Vec<f64>,
}

/// Search for the parameters that describe a curve, or several curves of one specimen together.
pub(crate) struct Search<'a> {
    pub space: &'a Space<'a>,
    pub model: Model<'a>,
    /// Contributions to the forces of all curves, such as zero and drift, that are fitted again for
    /// each model.
    pub lines: Lines,
    /// Further curves of the specimen, which are fitted together with the first one.
    pub further: Vec<FurtherCurve<'a>>,
    /// Function that receives the number of curves computed so far.
    pub report: &'a mut dyn FnMut(usize),
}

impl<'a> Search<'a> {
    /// Returns a search on one curve with the lines of its space.
    pub fn of_curve(
        space: &'a Space<'a>,
        model: Model<'a>,
        report: &'a mut dyn FnMut(usize),
    ) -> Self {
        Search {
            lines: space.lines(),
            space,
            model,
            further: Vec::new(),
            report,
        }
    }
}

impl Search<'_> {
    fn member(&mut self, place: Vec<f64>) -> Result<Member, ExperimentError> {
        if (self.space.stop)() {
            return Err(ContactError::Interrupted.into());
        }
        let computed = self.evaluations();
        (self.report)(computed);
        let mut member = Member {
            residuals: Vec::new(),
            in_contact: Vec::new(),
            place,
        };
        compare(self.space, &mut self.model, &mut member)?;
        for further in &mut self.further {
            let mut of_curve = further.member(&member.place);
            compare(further.space, &mut further.model, &mut of_curve)?;
            member.residuals.extend(of_curve.residuals);
            member.in_contact.extend(of_curve.in_contact);
        }
        Ok(member)
    }

    /// Returns the number of force curves that were computed.
    pub fn evaluations(&self) -> usize {
        let further = self.further.iter();
        let of_further: usize = further.map(|further| further.model.evaluations).sum();
        self.model.evaluations + of_further
    }

    /// Sets the accuracy of the computed forces, as a noise in units of the noise of the curve.
    fn set_accuracy(&mut self, noise: f64) {
        self.model.noise = noise;
        for further in &mut self.further {
            further.model.noise = noise;
        }
    }

    /// Returns all curves of the search, in the order in which their points follow each other.
    fn curves(&self) -> impl Iterator<Item = &MeasuredCurve> {
        let further = self.further.iter().map(|further| further.space.curve);
        [self.space.curve].into_iter().chain(further)
    }

    /// Computes the residuals at the coordinates `place`, with forces of full accuracy.
    ///
    /// # Errors
    /// Returns an error if a force curve cannot be computed, or if the fit is stopped.
    pub fn exact(&mut self, place: &[f64]) -> Result<Member, ExperimentError> {
        self.set_accuracy(1.0);
        self.member(place.to_vec())
    }

    /// Returns the residuals after a correction at jumps of the model. If a residual exceeds
    /// [`WRONG_SIDE`] and the model jumps at most one point away, the jump covers a range of
    /// forces. The corrected residual is the distance of the measured force from this range, so
    /// that a point inside the jump counts as described.
    ///
    /// # Errors
    /// Returns an error if a force curve cannot be computed, or if the fit is stopped.
    pub fn beyond_jumps(
        &mut self,
        place: &[f64],
        residuals: &[f64],
    ) -> Result<Vec<f64>, ExperimentError> {
        self.set_accuracy(1.0);
        let mut beyond = residuals.to_vec();
        let values = self.space.values(place);
        let count = self.space.curve.force.len();
        let (own, mut others) = beyond.split_at_mut(count);
        take_jumps_off(self.space.curve, &mut self.model, &values, own)?;
        for further in &mut self.further {
            let values = further.space.values(&further.place(place));
            let count = further.space.curve.force.len();
            let (own, after) = others.split_at_mut(count);
            take_jumps_off(further.space.curve, &mut further.model, &values, own)?;
            others = after;
        }
        Ok(beyond)
    }

    /// Returns the residual in contact, in units of the noise of the curve, after a fit of the
    /// lines at this noise; see [`scale`].
    fn misfit(&self, member: &Member, noise: f64) -> f64 {
        let residuals = self.lines.refined(&member.residuals, noise);
        scale(&member.contact_residuals(&residuals), WRONG_SIDE)
    }

    /// Returns the residual of the points without contact, in units of the noise of the curve, if a
    /// drift or a tilt remains in them; otherwise 0. The same drift or tilt is present in contact,
    /// where changes of the parameters can hide it.
    fn remaining_line(&self, member: &Member) -> f64 {
        let mut largest: f64 = 0.0;
        let mut first = 0;
        for curve in self.curves() {
            let range = first..first + curve.force.len();
            first = range.end;
            if curve.remaining[..2] == [0.0; 2] {
                continue;
            }
            let residuals = self.lines.refined(&member.residuals, 1.0);
            let free: Vec<f64> = range
                .filter(|index| !member.in_contact[*index])
                .map(|index| residuals[index])
                .collect();
            if !free.is_empty() {
                largest = largest.max(scale(&free, WRONG_SIDE));
            }
        }
        largest
    }

    /// Returns the cost of a member, a negative log-likelihood, for a noise in units of the noise
    /// of the curve. The cost is the sum of the [`loss`] of all points.
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

    /// Returns members that are evenly scattered over the ranges of the parameters. Each attempt
    /// has other members.
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

    /// Minimises the cost, and returns the set of parameters with the smallest cost. The search
    /// begins at the initial values. The assumed noise decreases together with the residuals, so
    /// that all points count at first, and points at jumps count little in the end. The descent can
    /// follow a narrow valley of the cost that random sets of parameters miss.
    ///
    /// # Errors
    /// Returns an error if a force curve cannot be computed, or if the fit is stopped.
    pub fn descended(&mut self) -> Result<Member, ExperimentError> {
        self.descended_from(self.space.start())
    }

    /// Does the same as [`Search::descended`], but begins at `place`.
    fn descended_from(&mut self, place: Vec<f64>) -> Result<Member, ExperimentError> {
        self.set_accuracy(1.0);
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

    /// Finds the member (set of parameters) with the smallest residuals, and samples of the
    /// coordinates. The search draws a population of members. It draws another population in three
    /// cases. First, the residuals exceed the noise: one population in thirty ends in a wrong
    /// minimum, and one in 200 does so twice. Second, the initial values, or the end of a descent,
    /// have a lower cost than the population; they then become a member of the next population.
    /// Third, the members of the population have not spread.
    ///
    /// The curves of a half-space that relaxes take long to compute. Descents from starts then
    /// replace the first population, unless they end at different places that do not describe the
    /// curve.
    ///
    /// # Errors
    /// Returns an error if a force curve cannot be computed, or if the fit is stopped.
    pub fn find(&mut self) -> Result<SearchResult, ExperimentError> {
        if self.space.relaxes() {
            let mut generator = ChaCha8Rng::seed_from_u64(SEED);
            let count = self.count_of_members();
            if let Some(population) = self.near_starts(count, &mut generator)? {
                return self.sample(population, &mut generator);
            }
        }
        let (population, generator) = self.first()?;
        self.find_from(population, generator)
    }

    /// Draws the first population of a search, and returns it with the random generator after this
    /// draw. A population is a number of sets of parameters.
    ///
    /// # Errors
    /// Returns an error if a force curve cannot be computed, or if the fit is stopped.
    pub fn first(&mut self) -> Result<(Population, ChaCha8Rng), ExperimentError> {
        let mut generator = ChaCha8Rng::seed_from_u64(SEED);
        let population = self.anneal(0, None, 0.0, &mut generator)?;
        Ok((population, generator))
    }

    /// Returns true if the residuals of a population are so large that noise does not explain them:
    /// the model does not describe the curve.
    pub fn is_systematic(&self, population: &Population) -> bool {
        self.misfit(&population.best, population.noise) > SYSTEMATIC
    }

    /// Completes the search of [`Search::find`] if the first population is already known.
    /// `generator` is the random generator with which this population was drawn.
    ///
    /// # Errors
    /// Returns an error if a force curve cannot be computed, or if the fit is stopped.
    pub fn find_from(
        &mut self,
        mut population: Population,
        mut generator: ChaCha8Rng,
    ) -> Result<SearchResult, ExperimentError> {
        self.set_accuracy(1.0);
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
            // If the model does not describe the curve, a further population is stopped as soon as
            // it has about the same residuals.
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

    /// Returns members that may be better than `best`, the best member of a population. They are
    /// the ends of descents. If the residuals of `best` exceed the noise, or if the body has two
    /// spheres, a descent begins at the initial values. For two spheres, descents also begin at
    /// further starts and at the values with exchanged spheres.
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

    /// Exchanges the two spheres of the member `best`, and returns the member that a descent from
    /// there reaches; `None` for a body without two spheres.
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
        // The cost of n points with normal noise has the expected value n/2 and about the standard
        // deviation √(n/2).
        let expected = 0.5 * residuals.len() as f64;
        Ok(cost > (EXPECTED * expected).max(expected + CHANCE * expected.sqrt()))
    }
}

/// Compares the curve of a space with its model at the place of a member, and adds the residuals
/// to the member.
fn compare(
    space: &Space<'_>,
    model: &mut Model<'_>,
    member: &mut Member,
) -> Result<(), ExperimentError> {
    let curve = space.curve;
    let values = space.values(&member.place);
    let zero = values[Parameter::Zero as usize];
    let forces = model.forces(&values)?;
    member.residuals.reserve(forces.len());
    member.in_contact = curve.in_contact();
    for (index, force) in forces.iter().enumerate() {
        let residual = (curve.force[index] - force) / curve.noise;
        member
            .residuals
            .push(if residual.is_finite() { residual } else { FAR });
        // The model gives a body without contact exactly the force before contact, so any other
        // force means contact.
        member.in_contact[index] |= *force != zero;
    }
    Ok(())
}

/// Corrects the residuals of a curve at jumps of the model with these values of the parameters, see
/// [`Search::beyond_jumps`].
fn take_jumps_off(
    curve: &MeasuredCurve,
    model: &mut Model<'_>,
    values: &Values,
    residuals: &mut [f64],
) -> Result<(), ExperimentError> {
    let noise = curve.noise;
    let jumps = model.jumps(values, WRONG_SIDE * noise)?;
    for (residual, jump) in residuals.iter_mut().zip(jumps) {
        if let Some(jump) = jump
            && residual.abs() > WRONG_SIDE
        {
            *residual -= residual.clamp(jump.low / noise, jump.high / noise);
        }
    }
    Ok(())
}

/// Returns a coordinate of a scattered member. `share`, from 0 to 1, is its place in the range.
fn scattered_coordinate(coordinate: &Coordinate, start: f64, share: f64) -> f64 {
    let (low, high) = coordinate.ends();
    match coordinate.parameter {
        // The offset is mostly smaller than the start, because a rough body touches before the
        // force exceeds the noise.
        Parameter::Offset => (start + 8.0 * share - 6.5).clamp(low, high),
        Parameter::Zero => start + 0.1 * (share - 0.5),
        _ => low + share * (high - low),
    }
}
