//! The search for the least residuals: a coarse scan, trust regions from its best points, and the linearised fit.

use super::baseline::dot;
use super::curve::ends;
use super::error::refused;
use super::model::Model;
use super::parameter::{Coordinate, Parameter, Values};
use super::{ExperimentError, MeasuredCurve};
use crate::contact::ContactError;
use crate::spectrum::Cholesky;
use bobyqa::{Bobyqa, Config};

/// Points of the coarse scan for each free parameter, and searches that begin at the start and at the best of them.
const SCAN: usize = 60;
const STARTS: usize = 6;
/// Share of the range of the force that counts as noise in the scan, factor between the noise of two rounds of searches, and
/// number of the best searches of the first round that go on until one describes the curve.
const COARSE: f64 = 0.05;
const FINER: f64 = 4.0;
const KEPT: usize = 4;
/// Residual, in units of the noise, beyond which a point counts less: it is on the wrong side of a jump.
const WRONG_SIDE: f64 = 5.0;
/// Bases of evenly scattered points.
const PRIMES: [usize; 7] = [2, 3, 5, 7, 11, 13, 17];
/// Radii of the first and the last trust region: in the first round, and in standard errors.
const FIRST_ROUND: [f64; 2] = [0.5, 1e-2];
const IN_ERRORS: [f64; 2] = [1.0, 0.02];
/// Half the width of the box of a search in standard errors, and the largest number of such searches in a round.
const BOX: f64 = 20.0;
const MOST_SEARCHES: usize = 4;
/// Residual over the noise above which the last rounds are repeated, how often at most, and from points in a box of this
/// width in standard errors.
const EXPECTED: f64 = 1.05;
const SHAKES: usize = 6;
const FAR: f64 = 40.0;
/// Gain of a search that ends a round.
const SMALL: f64 = 0.05;

/// Coordinates with their cost.
type Found = (f64, Vec<f64>);

/// The fit close to the least residuals, in units of the noise, with zeros at points that are left out.
pub(super) struct Linear {
    pub residuals: Vec<f64>,
    /// Derivatives of the forces by each coordinate.
    pub derivatives: Vec<Vec<f64>>,
    pub information: Cholesky,
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

    /// Root mean square residual in contact over the noise; a point on the wrong side of a jump counts as [`WRONG_SIDE`].
    pub fn misfit(&self, forces: &[f64]) -> f64 {
        let rests = self.curve.force.iter().zip(forces).skip(self.curve.free);
        let square = |(measured, model): (&f64, &f64)| {
            ((measured - model) / self.curve.noise).abs().min(WRONG_SIDE).powi(2)
        };
        (rests.map(square).sum::<f64>() / (self.curve.force.len() - self.curve.free) as f64).sqrt()
    }
}

/// A search on one profile.
pub(super) struct Search<'a> {
    pub space: &'a Space<'a>,
    pub model: Model<'a>,
    /// Receives the number of computed curves.
    pub report: &'a mut dyn FnMut(usize),
    pub failed: Option<ExperimentError>,
}

impl Search<'_> {
    /// Forces at these coordinates, N; none after a failure.
    pub fn forces(&mut self, at: &[f64]) -> Vec<f64> {
        if (self.space.stop)() {
            self.failed = Some(ContactError::Interrupted.into());
        }
        if self.failed.is_some() {
            return Vec::new();
        }
        (self.report)(self.model.evaluations);
        self.model.forces(&self.space.values(at)).unwrap_or_else(|error| {
            self.failed = Some(error);
            Vec::new()
        })
    }

    /// Half the sum of the squared residuals in units of a noise, N. The square of a point on the wrong side of a jump
    /// continues as a straight line (Huber).
    fn cost(&mut self, at: &[f64], noise: f64) -> f64 {
        let forces = self.forces(at);
        let loss = |(measured, model): (&f64, &f64)| {
            let rest = ((measured - model) / noise).abs();
            if rest > WRONG_SIDE { WRONG_SIDE * (rest - 0.5 * WRONG_SIDE) } else { 0.5 * rest * rest }
        };
        let force = &self.space.curve.force;
        if forces.is_empty() { f64::INFINITY } else { force.iter().zip(&forces).map(loss).sum() }
    }

    /// Noise of the scan, N.
    fn coarse(&self) -> f64 {
        let (low, high) = ends(self.space.curve.force.iter().copied());
        self.space.curve.noise.max(COARSE * (high - low))
    }

    /// The start, and the best of evenly scattered points.
    pub fn scan(&mut self) -> Vec<Vec<f64>> {
        let Space { base, coordinates, .. } = self.space;
        let start: Vec<f64> = coordinates.iter().map(|one| one.of(one.start, base)).collect();
        let scattered = |number: usize| {
            let rows = coordinates.iter().zip(PRIMES).zip(&start);
            let of = rows.map(|((one, prime), start)| {
                match (one.parameter, one.ends(), share_of(number, prime)) {
                    // Rough bodies touch before the force exceeds the noise.
                    (Parameter::Offset, (low, high), share) => (start + 8.0 * share - 6.5).clamp(low, high),
                    (Parameter::Zero, ..) => *start,
                    (_, (low, high), share) => low + share * (high - low),
                }
            });
            of.collect::<Vec<f64>>()
        };
        let (noise, count) = (self.coarse(), SCAN * start.len());
        let mut scanned: Vec<Found> =
            (1..=count).map(scattered).map(|at| (self.cost(&at, noise), at)).collect();
        scanned.sort_by(|one, other| one.0.total_cmp(&other.0));
        let best = scanned.into_iter().take(STARTS - 1).map(|(_, at)| at);
        [start.clone()].into_iter().chain(best).collect()
    }

    /// Finds the least cost from some points on, in rounds with less and less noise: far from it jumps count little.
    pub fn descend(&mut self, starts: &[Vec<f64>]) -> Result<(Vec<f64>, Linear), ExperimentError> {
        let (low, high): (Vec<f64>, Vec<f64>) = self.space.coordinates.iter().map(Coordinate::ends).unzip();
        let coarse = self.coarse();
        let first =
            |start: &Vec<f64>| least(start.clone(), (&low, &high), FIRST_ROUND, |at| self.cost(at, coarse));
        let mut found: Vec<Found> = starts.iter().map(first).collect();
        found.sort_by(|one, other| one.0.total_cmp(&other.0));
        let mut best = (f64::INFINITY, starts[0].clone());
        for (_, mut at) in found.into_iter().take(KEPT) {
            let mut noise = coarse;
            let cost = loop {
                noise = (noise / FINER).max(self.space.curve.noise);
                let (cost, place) = self.polish(at, noise)?;
                at = place;
                if noise == self.space.curve.noise {
                    break cost;
                }
            };
            best = if cost < best.0 { (cost, at) } else { best };
            if self.is_described(&best.1) {
                break;
            }
        }
        self.shake(best, self.space.curve.noise)
    }

    /// Returns true where the residual is that of the noise.
    fn is_described(&mut self, at: &[f64]) -> bool {
        let forces = self.forces(at);
        self.space.misfit(&forces) < EXPECTED
    }

    /// Repeats the last rounds from points around a place, while its residual is larger than the noise, and returns the best
    /// place with the fit linearised there.
    fn shake(&mut self, mut best: Found, noise: f64) -> Result<(Vec<f64>, Linear), ExperimentError> {
        let mut linear = self.linearise(&best.1, noise)?;
        for number in 1..=SHAKES {
            if self.is_described(&best.1) {
                break;
            }
            let even = best.1.iter().zip(PRIMES).map(|(_, prime)| FAR * (share_of(number, prime) - 0.5));
            let place = self.moved(&best.1, &linear, even.collect());
            let (_, place) = self.polish(place, FINER * noise)?;
            let found = self.polish(place, noise)?;
            if found.0 < best.0 {
                linear = self.linearise(&found.1, noise)?;
                best = found;
            }
        }
        Ok((best.1, linear))
    }

    /// The point within the ranges at these coordinates around another one, in which the linearised cost grows evenly.
    fn moved(&self, at: &[f64], linear: &Linear, even: Vec<f64>) -> Vec<f64> {
        let change = linear.information.solve_transposed(even);
        let moved = at.iter().zip(change).zip(&self.space.coordinates);
        moved.map(|((at, change), one)| (at + change).clamp(one.ends().0, one.ends().1)).collect()
    }

    /// Least cost close to a point, in coordinates in which the linearised cost grows evenly.
    fn polish(&mut self, mut at: Vec<f64>, noise: f64) -> Result<Found, ExperimentError> {
        let (low, high) = (vec![-BOX; at.len()], vec![BOX; at.len()]);
        let mut cost = self.cost(&at, noise);
        for _ in 0..MOST_SEARCHES {
            let linear = self.linearise(&at, noise)?;
            let cost_at = |even: &[f64]| {
                let place = self.moved(&at, &linear, even.to_vec());
                self.cost(&place, noise)
            };
            let found = least(vec![0.0; at.len()], (&low, &high), IN_ERRORS, cost_at);
            let gain = cost - found.0;
            if gain > 0.0 {
                (cost, at) = (found.0, self.moved(&at, &linear, found.1));
            }
            if gain < SMALL {
                break;
            }
        }
        Ok((cost, at))
    }

    /// Derivatives by differences over about one standard error, in which small jumps average out. Points that cross a
    /// larger jump are left out.
    fn linearise(&mut self, at: &[f64], noise: f64) -> Result<Linear, ExperimentError> {
        let forces = self.forces(at);
        let measured = self.space.curve.force.iter().zip(&forces);
        let mut residuals: Vec<f64> = measured.map(|(measured, model)| (measured - model) / noise).collect();
        let mut sizes: Vec<f64> = residuals.iter().map(|rest| rest.abs()).collect();
        sizes.sort_by(f64::total_cmp);
        let usual = sizes.get(sizes.len() / 2).map_or(1.0, |median| 1.4826 * median).max(1.0);
        let mut used: Vec<bool> = residuals.iter().map(|rest| rest.abs() <= WRONG_SIDE * usual).collect();
        let mut derivatives = Vec::new();
        for (index, coordinate) in self.space.coordinates.iter().enumerate() {
            let (low, high) = coordinate.ends();
            let (mut step, mut column) = (1e-3_f64, Vec::new());
            for _ in 0..3 {
                let places = [(at[index] - step).max(low), (at[index] + step).min(high)];
                let [below, above] = places.map(|place| {
                    let mut moved = at.to_vec();
                    moved[index] = place;
                    self.forces(&moved)
                });
                self.failed.take().map_or(Ok(()), Err)?;
                let width = (places[1] - places[0]).max(f64::MIN_POSITIVE) * noise;
                let derivative = |point: usize| {
                    let change = above[point] - below[point];
                    let bend = (above[point] + below[point] - 2.0 * forces[point]).abs();
                    if bend > 0.5 * change.abs() && bend > noise { f64::NAN } else { change / width }
                };
                column = (0..forces.len()).map(derivative).collect::<Vec<f64>>();
                let square: f64 = column.iter().filter(|one| one.is_finite()).map(|one| one * one).sum();
                step = (usual / square.sqrt()).clamp(1e-7, 0.2);
            }
            used.iter_mut().zip(&column).for_each(|(used, one)| *used &= one.is_finite());
            derivatives.push(column);
        }
        for values in derivatives.iter_mut().chain([&mut residuals]) {
            values.iter_mut().zip(&used).for_each(|(value, used)| *value = if *used { *value } else { 0.0 });
        }
        let size = derivatives.len();
        let product = |place: usize| dot(&derivatives[place / size], &derivatives[place % size]);
        let mut matrix: Vec<f64> = (0..size * size).map(product).collect();
        let largest = (0..size).map(|index| matrix[index * size + index]).fold(1.0, f64::max);
        // A parameter without any effect keeps the matrix positive.
        (0..size).for_each(|index| matrix[index * size + index] += 1e-12 * largest + 1e-3);
        match Cholesky::new(matrix, size) {
            Some(information) => Ok(Linear { residuals, derivatives, information }),
            None => refused("the parameters have no effect on the curve", "fewer parameters in --free"),
        }
    }
}

/// Finds the least value of a function within bounds, in trust regions with the first and the last of these radii.
fn least(
    mut at: Vec<f64>,
    (low, high): (&[f64], &[f64]),
    [first, last]: [f64; 2],
    function: impl FnMut(&[f64]) -> f64,
) -> Found {
    let width = low.iter().zip(high).map(|(low, high)| high - low).fold(f64::INFINITY, f64::min);
    let first = first.min(0.25 * width);
    let mut config = Config::new(at.len());
    (config.rho_begin, config.rho_end, config.max_fun) = (first, last.min(first), 100 * (at.len() + 1));
    let cost = match Bobyqa::new(at.len(), config) {
        Ok(mut solver) => solver.minimize(function, &mut at, low, high).f,
        Err(_) => f64::INFINITY,
    };
    (cost, at)
}

/// Point from 0 to 1 of an evenly scattered sequence (van der Corput).
fn share_of(mut number: usize, base: usize) -> f64 {
    let (mut share, mut digit) = (0.0, 1.0);
    while number > 0 {
        digit /= base as f64;
        share += digit * (number % base) as f64;
        number /= base;
    }
    share
}
