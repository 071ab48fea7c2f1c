//! Table of the summaries of computed curves. The curves belong to random profiles and to the nodes
//! of a grid over ln(γ/E*) and ln E*. The file also computes the mean and the scatter of the
//! summaries over the profiles, and finds the place around which the grid has to lie.

use super::summary::{Branches, Measurement, Point, Protocol, SUMMARIES, Summaries, summaries};
use crate::error::ExperimentError;
use crate::fit::model::Sampling;
use asperity_contact::motion::{Body, MovingBody};
use asperity_contact::{ContactError, CurvePoint, Modulus, Move};
use asperity_data::on_threads;
use asperity_scene::instrument::DisplacementCurve;
use asperity_scene::{CheckedScene, Governing, Simulation};
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use std::sync::atomic::{AtomicUsize, Ordering};

/// Number of points of a computed approach or retraction, without the points at jumps.
const SAMPLES: usize = 128;
/// Smallest jump of the force that gets points at both of its ends, in units of the noise.
const NOTABLE: f64 = 1.0;
/// Largest number of points that are added to a retraction until contact is lost, divided by the
/// number of points of the measured retraction.
const LONGEST: usize = 8;
/// First seed of the random profiles and of the noise. It is far from the seeds that users write in
/// scenes, so that no profile of the table is the profile of a scene.
const FIRST_SEED: u64 = 0x6173_7065_7269_7479;
/// Difference between the first seeds of two scenes whose seeds differ by 1. No table has so many
/// profiles, so the tables of two scenes have no profile in common.
const SEEDS_OF_SCENE: u64 = 1 << 32;
/// Smallest force at the turning point of a computed curve, divided by the preload, whatever the
/// noise.
const LEAST_TURN: f64 = 0.5;
/// Number of random profiles of the coarse table.
const COARSE_LINES: u64 = 8;
/// Nodes of the coarse table in ln(γ/E*).
const COARSE_RANGES: Axis = Axis {
    step: 0.8,
    nodes: 13,
};
/// Nodes of the coarse table in ln E*.
const COARSE_MODULI: Axis = Axis {
    step: 0.7,
    nodes: 7,
};
/// Number of steps into which a step of the coarse table is divided in the search for the best
/// place.
const FINE_STEPS: usize = 6;
/// Largest number of coarse tables, each of which may lie around another place.
const MOST_MOVES: usize = 4;
/// Largest adhesion parameter κ = √(h⟨∇z⟩E*/γ) in the first coarse table. The smallest κ in this
/// table is about 1.
const HIGHEST_KAPPA: f64 = 80.0;
/// Standard deviation that is added in quadrature to the scatter of each summary, so that no
/// summary has too large a weight.
const LEAST_SCATTER: f64 = 0.1;

/// A pair of parameters in the table: `range` is ln(γ/E*), with γ/E* in m, and `modulus` is ln E*,
/// with E* in Pa.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Place {
    pub range: f64,
    pub modulus: f64,
}

impl Place {
    /// Returns ln γ and ln E*.
    pub fn parameters(self) -> [f64; 2] {
        [self.range + self.modulus, self.modulus]
    }
}

/// Data that all computed curves share.
#[derive(Clone, Copy)]
pub(crate) struct Specimen<'a> {
    pub scene: &'a CheckedScene,
    pub stiffness: f64,
    /// Work of adhesion on closing divided by the work of adhesion on opening.
    pub closing: f64,
    pub protocols: &'a [Protocol],
    pub stop: &'a (dyn Fn() -> bool + Sync),
}

impl Specimen<'_> {
    /// Returns the summaries of the curves of one random profile. There is a curve for each pair of
    /// a value ln(γ/E*) in `ranges` and a value ln E* in `moduli`; all moduli of the first range
    /// come first. `moduli` has to ascend.
    ///
    /// Apart from the turning point and the instrument, the curve of the force divided by E* over
    /// the indentation depends only on γ/E*. So one approach is computed for all moduli of a range.
    pub fn curves(
        &self,
        simulation: &mut Simulation,
        line: u64,
        ranges: &[f64],
        moduli: &[f64],
    ) -> Result<Vec<Summaries>, ExperimentError> {
        let seed = seed_of(self.scene, line);
        let scene = self.scene.with_seed(seed);
        let (bare, _) = simulation.contact(&scene)?;
        let modulus = Modulus::effective(bare.effective_modulus())?;
        let protocol = &self.protocols[line as usize % self.protocols.len()];
        let mut noise = Noise::new(seed, protocol);
        let mut all = Vec::with_capacity(ranges.len() * moduli.len());
        for range in ranges {
            let work = range.exp() * bare.effective_modulus();
            let contact = bare
                .with(modulus)
                .works_of_adhesion([self.closing * work, work])
                .build()?;
            let first = all.len();
            let mut approach = Body::new(&contact, 2);
            // The moduli are taken in descending order, because the largest modulus has the
            // smallest indentation, and the approach can only go on.
            for modulus in moduli.iter().rev() {
                if (self.stop)() {
                    return Err(ContactError::Interrupted.into());
                }
                let scale = modulus.exp() / contact.effective_modulus();
                let force_loop = ForceLoop {
                    stiffness: self.stiffness / scale,
                    scale,
                    protocol,
                };
                let branches = force_loop.branches(&mut approach, &mut noise)?;
                all.push(summaries(&branches, protocol.preload));
            }
            all[first..].reverse();
        }
        Ok(all)
    }
}

/// Returns the seed of a random profile of the table. Scenes with different seeds have different
/// profiles.
pub(super) fn seed_of(scene: &CheckedScene, line: u64) -> u64 {
    let seed = scene.seed().unwrap_or_default();
    FIRST_SEED
        .wrapping_add(seed.wrapping_mul(SEEDS_OF_SCENE))
        .wrapping_add(line)
}

/// Computation of one curve with approach and retraction. The computed forces and the stiffness of
/// the instrument are in units of `scale`.
struct ForceLoop<'a> {
    stiffness: f64,
    scale: f64,
    protocol: &'a Protocol,
}

impl ForceLoop<'_> {
    /// Presses the body further up to the preload, and computes the points of the approach and of
    /// the retraction from there. The body itself remains on the approach. The force at which it
    /// turns differs from the measured preload by the error of the preload, which results from
    /// noise.
    fn branches(&self, body: &mut Body, noise: &mut Noise) -> Result<Branches, ContactError> {
        let protocol = self.protocol;
        let least_force = LEAST_TURN * protocol.preload;
        let turning_force = (protocol.preload + noise.of_preload).max(least_force);
        body.move_to(Move::ToForce(turning_force / self.scale))?;
        let approach = body.leg();
        let turn = body.point().indentation;
        let retraction = approach.turn(turn)?;
        let sampling = Sampling {
            stiffness: self.stiffness,
            points: SAMPLES,
            least_jump: NOTABLE * protocol.noise / self.scale,
        };
        let pressed = sampling.over(&approach, [0.0, turn], 1, Some(CurvePoint::default()))?;
        let pulled = sampling.pull(&retraction, turn)?;

        let top = match pressed.points().last() {
            Some(point) => point.displacement,
            None => turn,
        };
        let end = match pulled.points().last() {
            Some(point) => point.displacement - top,
            None => -top,
        };
        let force_at = |curve: &DisplacementCurve, displacement: f64| {
            if let Some(point) = curve.at(top + displacement) {
                return self.scale * point.force;
            }
            // By rounding, the turning point may lie beyond the end of the computed curve.
            let is_turn = displacement > -1e-9 * top.abs();
            if is_turn { turning_force } else { 0.0 }
        };
        let mut branches = Branches {
            approach: Vec::with_capacity(protocol.approach.len()),
            retraction: Vec::with_capacity(protocol.retraction.len()),
            noise: protocol.noise,
            free: protocol.free,
        };
        for &displacement in &protocol.approach {
            let force = force_at(&pressed, displacement) + noise.at(branches.approach.len());
            branches.approach.push(Point {
                displacement,
                force,
            });
        }
        let first = branches.approach.len();
        for displacement in until_loss(&protocol.retraction, end) {
            let index = first + branches.retraction.len();
            let force = force_at(&pulled, displacement) + noise.at(index);
            branches.retraction.push(Point {
                displacement,
                force,
            });
        }
        Ok(branches)
    }
}

/// Returns the displacements of a retraction. If they do not reach the loss of contact of the
/// computed curve, at the displacement `end`, further displacements are added.
fn until_loss(retraction: &[f64], end: f64) -> Vec<f64> {
    let mut displacements = retraction.to_vec();
    let count = retraction.len();
    let last = retraction[count - 1];
    if end < last {
        let step = (last - retraction[0]) / (count - 1) as f64;
        let more = (((end - last) / step) as usize + 4).min(LONGEST * count);
        displacements.extend((1..=more).map(|index| last + step * index as f64));
    }
    displacements
}

/// Normally distributed noise of a computed curve. All nodes of the table have the same noise, so
/// that summaries change smoothly with the parameters. The mean of the noise before contact is
/// subtracted, because a measured curve loses it with the zero of its force.
struct Noise {
    generator: ChaCha8Rng,
    deviation: f64,
    values: Vec<f64>,
    zero: f64,
    /// Error in N of the measured preload.
    of_preload: f64,
}

impl Noise {
    fn new(seed: u64, protocol: &Protocol) -> Self {
        let mut generator = ChaCha8Rng::seed_from_u64(seed);
        let [of_preload, _] = normal_pair(&mut generator);
        let mut noise = Noise {
            generator,
            deviation: protocol.noise,
            values: Vec::new(),
            zero: 0.0,
            of_preload: protocol.preload_error * of_preload,
        };
        let free = protocol.free.max(1);
        let sum: f64 = (0..free).map(|index| noise.at(index)).sum();
        noise.zero = sum / free as f64;
        noise
    }

    fn at(&mut self, index: usize) -> f64 {
        while self.values.len() <= index {
            let pair = normal_pair(&mut self.generator);
            self.values.extend(pair.map(|value| self.deviation * value));
        }
        self.values[index] - self.zero
    }
}

/// Returns two independent values with the standard normal distribution (Box and Muller).
fn normal_pair(generator: &mut ChaCha8Rng) -> [f64; 2] {
    let [for_radius, for_angle]: [f64; 2] = [generator.random(), generator.random()];
    let radius = (-2.0 * (1.0 - for_radius).ln()).sqrt();
    let (sine, cosine) = (std::f64::consts::TAU * for_angle).sin_cos();
    [radius * cosine, radius * sine]
}

/// Threads that compute the curves of a table.
#[derive(Clone, Copy)]
pub(crate) struct Workers<'a> {
    pub specimen: Specimen<'a>,
    /// Simulation that finds the measured files of the scene in their folder, or that already holds
    /// the measured roughness of the scene.
    pub simulation: &'a Simulation,
    pub jobs: usize,
    /// Number of curves computed so far.
    pub computed: &'a AtomicUsize,
    /// Function that receives the number of curves computed so far.
    pub report: &'a (dyn Fn(usize) + Sync),
}

impl Workers<'_> {
    /// Returns the summaries of the curves of each random profile at all nodes. All moduli of the
    /// first range come first.
    pub fn curves(
        &self,
        lines: u64,
        ranges: &[f64],
        moduli: &[f64],
    ) -> Result<Vec<Vec<Summaries>>, ExperimentError> {
        let worker = || {
            let mut simulation = self.simulation.another();
            move |line: u64| {
                let curves = self
                    .specimen
                    .curves(&mut simulation, line, ranges, moduli)?;
                let before = self.computed.fetch_add(curves.len(), Ordering::Relaxed);
                (self.report)(before + curves.len());
                Ok(curves)
            }
        };
        on_threads(lines, self.jobs, worker)
    }
}

/// Returns `count` evenly spaced nodes.
pub(crate) fn nodes(first: f64, step: f64, count: usize) -> Vec<f64> {
    (0..count)
        .map(|index| first + step * index as f64)
        .collect()
}

/// Step and number of the nodes of an axis of a table.
pub(crate) struct Axis {
    pub step: f64,
    pub nodes: usize,
}

impl Axis {
    fn width(&self) -> f64 {
        (self.nodes - 1) as f64 * self.step
    }

    /// Returns the first node of an axis whose middle is at `centre`.
    fn first_around(&self, centre: f64) -> f64 {
        centre - 0.5 * self.width()
    }

    fn nodes_from(&self, first: f64) -> Vec<f64> {
        nodes(first, self.step, self.nodes)
    }

    pub fn nodes_around(&self, centre: f64) -> Vec<f64> {
        self.nodes_from(self.first_around(centre))
    }
}

/// Summaries of the curves of all random profiles at the nodes of a grid over ln(γ/E*) and ln E*.
pub(crate) struct Table {
    /// ln(γ/E*), ascending and evenly spaced.
    pub ranges: Vec<f64>,
    /// ln E*, ascending and evenly spaced.
    pub moduli: Vec<f64>,
    /// Summaries of each random profile at all nodes. All moduli of the first range come first.
    pub lines: Vec<Vec<Summaries>>,
}

/// An end of one of the two axes of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum End {
    LowRange,
    HighRange,
    LowModulus,
    HighModulus,
}

impl End {
    /// Returns true for an end of the axis of E*.
    pub fn is_of_modulus(self) -> bool {
        matches!(self, End::LowModulus | End::HighModulus)
    }

    fn is_low(self) -> bool {
        matches!(self, End::LowRange | End::LowModulus)
    }

    /// Returns `count` further nodes beyond this end of an axis.
    fn nodes_beyond(self, axis: &[f64], count: usize) -> Vec<f64> {
        let step = axis[1] - axis[0];
        if self.is_low() {
            nodes(axis[0] - step * count as f64, step, count)
        } else {
            nodes(axis[axis.len() - 1] + step, step, count)
        }
    }

    /// Returns the index in an axis at which further nodes are inserted.
    fn place_in(self, axis: &[f64]) -> usize {
        if self.is_low() { 0 } else { axis.len() }
    }
}

impl Table {
    pub fn new(
        workers: &Workers<'_>,
        lines: u64,
        ranges: Vec<f64>,
        moduli: Vec<f64>,
    ) -> Result<Self, ExperimentError> {
        let lines = workers.curves(lines, &ranges, &moduli)?;
        Ok(Table {
            ranges,
            moduli,
            lines,
        })
    }

    /// Adds `count` nodes beyond an end of the table, and computes their curves.
    pub fn extend(
        &mut self,
        workers: &Workers<'_>,
        end: End,
        count: usize,
    ) -> Result<(), ExperimentError> {
        if end.is_of_modulus() {
            self.extend_moduli(workers, end, count)
        } else {
            self.extend_ranges(workers, end, count)
        }
    }

    fn extend_ranges(
        &mut self,
        workers: &Workers<'_>,
        end: End,
        count: usize,
    ) -> Result<(), ExperimentError> {
        let added = end.nodes_beyond(&self.ranges, count);
        let place = end.place_in(&self.ranges);
        let new = workers.curves(self.lines.len() as u64, &added, &self.moduli)?;
        let start = place * self.moduli.len();
        for (line, curves) in self.lines.iter_mut().zip(new) {
            line.splice(start..start, curves);
        }
        self.ranges.splice(place..place, added);
        Ok(())
    }

    fn extend_moduli(
        &mut self,
        workers: &Workers<'_>,
        end: End,
        count: usize,
    ) -> Result<(), ExperimentError> {
        let added = end.nodes_beyond(&self.moduli, count);
        let place = end.place_in(&self.moduli);
        let new = workers.curves(self.lines.len() as u64, &self.ranges, &added)?;
        for (line, curves) in self.lines.iter_mut().zip(new) {
            let mut extended = Vec::with_capacity(line.len() + curves.len());
            let rows = line.chunks(self.moduli.len()).zip(curves.chunks(count));
            for (old, new) in rows {
                extended.extend_from_slice(&old[..place]);
                extended.extend_from_slice(new);
                extended.extend_from_slice(&old[place..]);
            }
            *line = extended;
        }
        self.moduli.splice(place..place, added);
        Ok(())
    }

    /// Returns the nodes in the order in which [`Self::lines`] has the summaries of a profile.
    pub fn places(&self) -> Vec<Place> {
        places(&self.ranges, &self.moduli)
    }
}

/// Returns all pairs of a range and a modulus. All moduli of the first range come first.
fn places(ranges: &[f64], moduli: &[f64]) -> Vec<Place> {
    let mut places = Vec::with_capacity(ranges.len() * moduli.len());
    for &range in ranges {
        for &modulus in moduli {
            places.push(Place { range, modulus });
        }
    }
    places
}

/// Mean and covariance of two values over the random profiles at a place.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Moments {
    pub mean: [f64; 2],
    /// Variance of the first value, covariance, variance of the second value.
    pub covariance: [f64; 3],
}

/// Inverse of a covariance matrix of two values.
#[derive(Clone, Copy, Debug)]
pub(crate) struct InverseCovariance {
    /// Elements of the inverse matrix, in the order of [`Moments::covariance`].
    elements: [f64; 3],
    /// Logarithm of the determinant of the covariance matrix.
    pub log_determinant: f64,
}

impl Moments {
    pub fn of(values: &[[f64; 2]]) -> Self {
        let count = values.len() as f64;
        let mean = [0, 1].map(|index| values.iter().map(|value| value[index]).sum::<f64>() / count);
        let product = |first: usize, second: usize| {
            let products = values
                .iter()
                .map(|value| (value[first] - mean[first]) * (value[second] - mean[second]));
            products.sum::<f64>() / (count - 1.0).max(1.0)
        };
        Moments {
            mean,
            covariance: [product(0, 0), product(0, 1), product(1, 1)],
        }
    }

    /// Returns the inverse of the covariance matrix. If the second value does not vary, as for a
    /// given E*, the inverse ignores it.
    pub fn inverse(&self) -> InverseCovariance {
        let [first, both, second] = self.covariance;
        if second == 0.0 {
            let first = first.max(f64::MIN_POSITIVE);
            return InverseCovariance {
                elements: [1.0 / first, 0.0, 0.0],
                log_determinant: first.ln(),
            };
        }
        let determinant = (first * second - both * both).max(f64::MIN_POSITIVE);
        InverseCovariance {
            elements: [
                second / determinant,
                -both / determinant,
                first / determinant,
            ],
            log_determinant: determinant.ln(),
        }
    }
}

impl InverseCovariance {
    /// Returns the squared Mahalanobis distance (x − mean)ᵀ Σ⁻¹ (x − mean).
    pub fn squared_distance(&self, mean: [f64; 2], values: [f64; 2]) -> f64 {
        let [first, both, second] = self.elements;
        let x = values[0] - mean[0];
        let y = values[1] - mean[1];
        first * x * x + 2.0 * both * x * y + second * y * y
    }

    /// Returns the product Σ⁻¹ x.
    pub fn times(&self, values: [f64; 2]) -> [f64; 2] {
        let [first, both, second] = self.elements;
        let [x, y] = values;
        [first * x + both * y, both * x + second * y]
    }
}

/// Mean and covariance of two values over the random profiles, at each node of a table.
#[derive(Clone)]
pub(crate) struct Scatter {
    ranges: Vec<f64>,
    moduli: Vec<f64>,
    nodes: Vec<Moments>,
}

/// Weights for the interpolation along an axis. `first` is the index of the first node with a
/// weight.
struct Weights<const COUNT: usize> {
    first: usize,
    weights: [f64; COUNT],
}

impl<const COUNT: usize> Weights<COUNT> {
    /// Returns the weights of the polynomial through the `COUNT` nearest nodes of an axis, or
    /// through all nodes of a shorter axis.
    fn new(axis: &[f64], place: f64) -> Self {
        let count = COUNT.min(axis.len());
        let next = axis.partition_point(|node| *node < place);
        let first = next
            .saturating_sub(count.div_ceil(2))
            .min(axis.len() - count);
        let mut weights = [0.0; COUNT];
        for (index, weight) in weights.iter_mut().enumerate().take(count) {
            let node = axis[first + index];
            let others = (first..first + count).filter(|other| *other != first + index);
            *weight = others
                .map(|other| (place - axis[other]) / (node - axis[other]))
                .product();
        }
        Weights { first, weights }
    }
}

impl Scatter {
    /// Computes the moments of two values at each node. `value` returns these values from the index
    /// of a random profile and the index of a node.
    pub fn of(table: &Table, value: impl Fn(usize, usize) -> [f64; 2]) -> Self {
        let count = table.ranges.len() * table.moduli.len();
        let mut nodes = Vec::with_capacity(count);
        for node in 0..count {
            let lines = 0..table.lines.len();
            let values: Vec<[f64; 2]> = lines.map(|line| value(line, node)).collect();
            nodes.push(Moments::of(&values));
        }
        Scatter {
            ranges: table.ranges.clone(),
            moduli: table.moduli.clone(),
            nodes,
        }
    }

    /// Computes the moments of one summary; the second value is 0.
    pub fn of_summary(table: &Table, index: usize) -> Self {
        Scatter::of(table, |line, node| [table.lines[line][node][index], 0.0])
    }

    /// Returns the moments at a place between the nodes. The mean is interpolated by cubic
    /// polynomials, and the covariance linearly.
    pub fn at(&self, place: Place) -> Moments {
        let mut moments = Moments {
            mean: [0.0; 2],
            covariance: [0.0; 3],
        };
        self.interpolate::<4>(place, |weight, node| {
            for (sum, mean) in moments.mean.iter_mut().zip(node.mean) {
                *sum += weight * mean;
            }
        });
        let inside = Place {
            range: clamp_to(&self.ranges, place.range),
            modulus: clamp_to(&self.moduli, place.modulus),
        };
        self.interpolate::<2>(inside, |weight, node| {
            for (sum, covariance) in moments.covariance.iter_mut().zip(node.covariance) {
                *sum += weight * covariance;
            }
        });
        moments
    }

    /// Calls `add` with the weight and the moments of each node around a place. There are `COUNT`
    /// such nodes along each axis.
    fn interpolate<const COUNT: usize>(&self, place: Place, mut add: impl FnMut(f64, &Moments)) {
        let ranges = Weights::<COUNT>::new(&self.ranges, place.range);
        let moduli = Weights::<COUNT>::new(&self.moduli, place.modulus);
        for (range, of_range) in ranges.weights.iter().enumerate() {
            if *of_range == 0.0 {
                continue;
            }
            let row = (ranges.first + range) * self.moduli.len();
            for (modulus, of_modulus) in moduli.weights.iter().enumerate() {
                if *of_modulus != 0.0 {
                    let node = &self.nodes[row + moduli.first + modulus];
                    add(of_range * of_modulus, node);
                }
            }
        }
    }
}

fn clamp_to(axis: &[f64], place: f64) -> f64 {
    place.clamp(axis[0], axis[axis.len() - 1])
}

/// Finds the place at which the computed curves have the mean summaries of the measured curves,
/// with an accuracy of about a step of the first table. `known` is ln E* if E* is given.
pub(crate) fn placed(
    workers: &Workers<'_>,
    measured: &Measurement,
    governing: &Governing,
    known: Option<f64>,
) -> Result<Place, ExperimentError> {
    let largest_range = match governing.amplitude {
        Some(amplitude) => amplitude.rms_height * amplitude.rms_gradient,
        None => 0.0,
    };
    let largest_range = largest_range.max(f64::MIN_POSITIVE).ln();
    let modulus = governing.effective_modulus.ln();
    let mut low = largest_range - HIGHEST_KAPPA.powi(2).ln();
    let mut soft = COARSE_MODULI.first_around(modulus);
    for moves_left in (0..MOST_MOVES).rev() {
        let ranges = COARSE_RANGES.nodes_from(low);
        let moduli = match known {
            Some(modulus) => vec![modulus],
            None => COARSE_MODULI.nodes_from(soft),
        };
        let table = Table::new(workers, COARSE_LINES, ranges, moduli)?;
        let Some(best) = best_place(&table, measured) else {
            break;
        };
        let is_range_at_end = is_at_end(&table.ranges, best.range, COARSE_RANGES.step);
        let is_modulus_at_end = is_at_end(&table.moduli, best.modulus, COARSE_MODULI.step);
        if moves_left == 0 || !(is_range_at_end || is_modulus_at_end) {
            return Ok(best);
        }
        if is_range_at_end {
            low = COARSE_RANGES.first_around(best.range);
        }
        if is_modulus_at_end {
            soft = COARSE_MODULI.first_around(best.modulus);
        }
    }
    Ok(Place {
        range: low,
        modulus,
    })
}

/// Returns the place, on a fine grid over the table, at which the mean summaries agree best with
/// those of the measured curves.
fn best_place(table: &Table, measured: &Measurement) -> Option<Place> {
    let target = measured.mean().summaries;
    let variance = 1.0 / measured.summaries.len() as f64 + 1.0 / COARSE_LINES as f64;
    let scatters: Vec<Scatter> = (0..SUMMARIES)
        .map(|index| Scatter::of_summary(table, index))
        .collect();
    let mut best: Option<(f64, Place)> = None;
    for place in places(&refined(&table.ranges), &refined(&table.moduli)) {
        let terms = scatters.iter().zip(target).map(|(scatter, target)| {
            let moments = scatter.at(place);
            let square = moments.covariance[0] + LEAST_SCATTER.powi(2);
            (moments.mean[0] - target).powi(2) / square / variance + square.ln()
        });
        let misfit: f64 = terms.sum();
        if best.is_none_or(|(least, _)| misfit.total_cmp(&least).is_lt()) {
            best = Some((misfit, place));
        }
    }
    best.map(|(_, place)| place)
}

/// Returns the values of an axis and [`FINE_STEPS`] − 1 further values between each pair of its
/// nodes.
fn refined(axis: &[f64]) -> Vec<f64> {
    let count = FINE_STEPS * (axis.len() - 1);
    let first = axis[0];
    let last = axis[axis.len() - 1];
    (0..=count)
        .map(|index| first + (last - first) * index as f64 / count.max(1) as f64)
        .collect()
}

/// Returns true for a place within half a step of an end of an axis with several nodes.
fn is_at_end(axis: &[f64], place: f64, step: f64) -> bool {
    let first = axis[0];
    let last = axis[axis.len() - 1];
    axis.len() > 1 && (place - first).min(last - place) < 0.5 * step
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::common::bodies::{self, Body};
    use crate::common::specimens::{curve, scene};
    use crate::fit::ensemble::summary::{Measurement, NAMES};
    use asperity_data::{mean, standard_deviation};

    /// An extended table equals a table that had the larger size from the beginning, for any number
    /// of threads.
    #[test]
    fn extended_tables_are_larger_tables() {
        let mut scene = scene("rough-sphere");
        scene.numerics.points = 1024;
        scene.set_seed(3);
        let branches = Branches::of(&curve(&mut Simulation::default(), &scene, 3, 0.01)).unwrap();
        let protocols = [Protocol::of(&branches, branches.preload())];
        let computed = AtomicUsize::new(0);
        let scene = scene.checked().unwrap();
        let simulation = Simulation::default();
        let workers = |jobs| Workers {
            specimen: Specimen {
                scene: &scene,
                stiffness: 200.0,
                closing: 0.5,
                protocols: &protocols,
                stop: &|| false,
            },
            simulation: &simulation,
            jobs,
            computed: &computed,
            report: &|_| (),
        };
        let (one, three) = (workers(1), workers(3));
        let mut grown = Table::new(&one, 3, nodes(-18.0, 0.5, 2), nodes(14.5, 0.5, 2)).unwrap();
        for end in [
            End::LowRange,
            End::HighModulus,
            End::HighRange,
            End::LowModulus,
        ] {
            grown.extend(&three, end, 1).unwrap();
        }
        assert_eq!(computed.load(Ordering::Relaxed), 3 * 16);
        let whole = Table::new(&three, 3, nodes(-18.5, 0.5, 4), nodes(14.0, 0.5, 4)).unwrap();
        assert_eq!(
            (&grown.ranges, &grown.moduli),
            (&whole.ranges, &whole.moduli)
        );
        assert_eq!(grown.lines, whole.lines);
        let stopped = Workers {
            specimen: Specimen {
                stop: &|| true,
                ..one.specimen
            },
            ..one
        };
        assert!(stopped.curves(1, &[-18.0], &[14.5]).is_err());
    }

    /// Returns a first summary that is a cubic polynomial of the place. The two profiles differ by
    /// the range.
    fn cubic(place: Place, line: usize) -> f64 {
        place.range.powi(3) - 2.0 * place.range * place.modulus.powi(2)
            + [-0.5, 0.5][line] * place.range
    }

    #[test]
    fn means_are_exact_for_cubics_and_covariances_lie_between_nodes() {
        let (ranges, moduli): (Vec<f64>, Vec<f64>) = (
            (0..7).map(|at| 0.5 * f64::from(at)).collect(),
            (0..4).map(|at| 1.0 + 0.3 * f64::from(at)).collect(),
        );
        let mut table = Table {
            ranges,
            moduli,
            lines: Vec::new(),
        };
        let places: Vec<Place> = table.places();
        table.lines = (0..2)
            .map(|line| {
                places
                    .iter()
                    .map(|place| [cubic(*place, line); SUMMARIES])
                    .collect()
            })
            .collect();
        let scatter = Scatter::of(&table, |line, node| [table.lines[line][node][0], 0.0]);
        for (range, modulus) in [(0.1, 1.05), (1.3, 1.6), (2.9, 1.9), (1.5, 1.3)] {
            let place = Place { range, modulus };
            let found = scatter.at(place);
            let expected = range.powi(3) - 2.0 * range * modulus * modulus;
            assert!(
                (found.mean[0] - expected).abs() < 1e-12,
                "{place:?}: {found:?}"
            );
            let node = (2.0 * range).floor() / 2.0;
            let square = |at: f64| 0.5 * at * at;
            let between = square(node) + (range - node) / 0.5 * (square(node + 0.5) - square(node));
            assert!(
                (found.covariance[0] - between).abs() < 1e-12,
                "{place:?}: {found:?}"
            );
            assert_eq!((found.mean[1], found.covariance[2]), (0.0, 0.0));
        }
    }

    #[test]
    fn the_distance_is_that_of_the_covariance() {
        let values = [[1.0, 2.0], [3.0, 1.0], [2.0, 6.0], [6.0, 3.0]];
        let moments = Moments::of(&values);
        assert_eq!(moments.mean, [3.0, 3.0]);
        let inverse = moments.inverse();
        // The squared Mahalanobis distances of n points sum up to (n − 1) times their dimension.
        let sum: f64 = values
            .iter()
            .map(|value| inverse.squared_distance(moments.mean, *value))
            .sum();
        assert!((sum - 6.0).abs() < 1e-12);
        let [one, both, other] = moments.covariance;
        assert!((inverse.log_determinant.exp() - (one * other - both * both)).abs() < 1e-12);
    }

    /// Measured and computed curves of the same profiles have the same summaries. They differ only
    /// by the noise and by a small part of the scatter over the profiles.
    #[test]
    fn computed_curves_have_the_summaries_of_measured_ones() {
        const LINES: u64 = 32;
        for body in [Body::Cone, Body::Sphere, Body::Flat] {
            let specimen = bodies::Specimen {
                noise: 0.003,
                ..bodies::Specimen::new(body, 0)
            };
            let truth = specimen.truth.clone().checked().unwrap();
            let mut simulation = Simulation::default();
            let curve = |line: u64| {
                (
                    line.to_string(),
                    specimen.curve(&mut simulation, seed_of(&truth, line)),
                )
            };
            let measured = Measurement::of(&(0..LINES).map(curve).collect::<Vec<_>>()).unwrap();
            let table = Specimen {
                scene: &truth,
                stiffness: truth.loading_stiffness.unwrap_or(f64::INFINITY),
                closing: 1.0,
                protocols: &measured.protocols,
                stop: &|| false,
            };
            let [range, modulus] = [
                (specimen.work() / specimen.modulus()).ln(),
                specimen.modulus().ln(),
            ];
            let computed = |line: u64| {
                table
                    .curves(&mut simulation, line, &[range], &[modulus])
                    .unwrap()[0]
            };
            let computed: Vec<Summaries> = (0..LINES).map(computed).collect();
            for (index, name) in NAMES.into_iter().enumerate() {
                let pairs = computed.iter().zip(&measured.summaries);
                let differences: Vec<f64> = pairs
                    .map(|(one, other)| other[index] - one[index])
                    .collect();
                let values: Vec<f64> = computed.iter().map(|summaries| summaries[index]).collect();
                let scatter = standard_deviation(&values, mean(&values));
                let difference = mean(&differences);
                let error = standard_deviation(&differences, difference) / (LINES as f64).sqrt();
                assert!(
                    difference.abs() < 0.05 * scatter + 4.0 * error,
                    "{body:?}, {name}: {difference} ± {error}, scatter {scatter}"
                );
            }
        }
    }
}
