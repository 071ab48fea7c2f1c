//! Computed curves of random profiles at the nodes of a grid over ln(γ/E*) and ln E*, with the mean
//! and the scatter of their summaries, and the place around which the grid lies.

use super::summary::{Branches, Measured, Point, Protocol, SUMMARIES, Summaries, summaries};
use crate::error::ExperimentError;
use crate::fit::model::Sampling;
use asperity_contact::motion::{Body, MovingBody};
use asperity_contact::{ContactError, CurvePoint, Modulus, Move};
use asperity_data::on_threads;
use asperity_scene::instrument::DisplacementCurve;
use asperity_scene::{CheckedScene, Governing, Simulation};
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Number of points of a computed branch, without the points at jumps.
const SAMPLES: usize = 128;
/// Smallest jump of the force that gets points at both of its ends, in units of the noise.
const NOTABLE: f64 = 1.0;
/// Largest number of points that extend a retraction until contact is lost, divided by the number
/// of its own points.
const LONGEST: usize = 8;
/// First seed of profiles and of noise, far from the seeds that people write in scenes.
const FIRST_SEED: u64 = 0x6173_7065_7269_7479;
/// Difference of the first seeds of two scenes whose seeds differ by 1. No table has as many
/// profiles.
const SEEDS_OF_SCENE: u64 = 1 << 32;
/// Smallest force at a turning point, divided by the preload.
const LEAST_TURN: f64 = 0.5;
/// Number of random profiles of the coarse table, its steps in ln(γ/E*) and ln E*, and numbers of
/// nodes.
const LINES: u64 = 8;
const STEPS: [f64; 2] = [0.8, 0.7];
const NODES: [usize; 2] = [13, 7];
/// Number of places between two nodes, and number of coarse tables.
const FINE_STEPS: usize = 6;
const MOST_MOVES: usize = 4;
/// Largest κ = √(h⟨∇z⟩E*/γ) of the first table. The smallest is about 1.
const HIGHEST_KAPPA: f64 = 80.0;
/// Smallest standard deviation of a summary.
const LEAST_SCATTER: f64 = 0.1;

/// Place in the table: ln(γ/E*), with γ/E* in m, and ln E*, with E* in Pa.
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
    /// Returns the summaries of the curves of one random profile: for each ln(γ/E*) in `ranges`,
    /// for each ln E* in `moduli`, which ascend.
    ///
    /// The force divided by E* and the indentation depend on γ/E* only, except for the turning
    /// point and the instrument. All moduli therefore share one approach.
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
            // The largest modulus has the smallest indentation.
            for modulus in moduli.iter().rev() {
                if (self.stop)() {
                    return Err(ContactError::Interrupted.into());
                }
                let scale = modulus.exp() / contact.effective_modulus();
                let loop_ = Loop {
                    stiffness: self.stiffness / scale,
                    scale,
                    protocol,
                };
                let branches = loop_.branches(&mut approach, &mut noise)?;
                all.push(summaries(&branches, protocol.preload));
            }
            all[first..].reverse();
        }
        Ok(all)
    }
}

/// Returns the seed of a random profile of the table. Another seed of the scene gives other
/// profiles.
pub(super) fn seed_of(scene: &CheckedScene, line: u64) -> u64 {
    let of_scene = scene
        .seed()
        .unwrap_or_default()
        .wrapping_mul(SEEDS_OF_SCENE);
    FIRST_SEED.wrapping_add(of_scene).wrapping_add(line)
}

/// One computed curve. Forces and the stiffness of the instrument are in units of `scale`.
struct Loop<'a> {
    stiffness: f64,
    scale: f64,
    protocol: &'a Protocol,
}

impl Loop<'_> {
    /// Presses the body, which is on its approach, to the preload, where it stays. The measured
    /// preload has an error by the noise, and so the force at which the body turns differs from it.
    fn branches(&self, body: &mut Body, noise: &mut Noise) -> Result<Branches, ContactError> {
        let protocol = self.protocol;
        let turning_force =
            (protocol.preload + noise.of_preload).max(LEAST_TURN * protocol.preload);
        body.move_to(Move::ToForce(turning_force / self.scale))?;
        let (approach, turn) = (body.leg(), body.point().indentation);
        let retraction = approach.turn(turn)?;
        let sampling = Sampling {
            stiffness: self.stiffness,
            points: SAMPLES,
            least_jump: NOTABLE * protocol.noise / self.scale,
        };
        let pressed = sampling.over(&approach, [0.0, turn], 1, Some(CurvePoint::default()))?;
        let pulled = sampling.pull(&retraction, turn)?;
        let top = pressed
            .points()
            .last()
            .map_or(turn, |point| point.displacement);
        let force = |curve: &DisplacementCurve, place: f64| {
            curve.at(top + place).map_or_else(
                // At the turning point itself, by rounding.
                || {
                    if place > -1e-9 * top.abs() {
                        turning_force
                    } else {
                        0.0
                    }
                },
                |point| self.scale * point.force,
            )
        };
        let approach: Vec<Point> = protocol
            .approach
            .iter()
            .enumerate()
            .map(|(index, &place)| (place, force(&pressed, place) + noise.at(index)))
            .collect();
        let first = approach.len();
        let end = pulled
            .points()
            .last()
            .map_or(0.0, |point| point.displacement)
            - top;
        let (count, last) = (
            protocol.retraction.len(),
            protocol.retraction[protocol.retraction.len() - 1],
        );
        let step = (last - protocol.retraction[0]) / (count - 1) as f64;
        // A retraction that is too short for this curve goes on until contact is lost.
        let more = if end < last {
            (((end - last) / step) as usize + 4).min(LONGEST * count)
        } else {
            0
        };
        let beyond = (1..=more).map(|index| last + step * index as f64);
        let places = protocol
            .retraction
            .iter()
            .copied()
            .chain(beyond)
            .enumerate();
        let retraction = places
            .map(|(index, place)| (place, force(&pulled, place) + noise.at(first + index)))
            .collect();
        Ok(Branches {
            approach,
            retraction,
            noise: protocol.noise,
            free: protocol.free,
        })
    }
}

/// Normally distributed noise of a curve, the same for all places of the table. Its mean before
/// contact is subtracted, as the zero of the force is.
struct Noise {
    generator: ChaCha8Rng,
    deviation: f64,
    values: Vec<f64>,
    zero: f64,
    /// Error of the measured preload, N.
    of_preload: f64,
}

impl Noise {
    fn new(seed: u64, protocol: &Protocol) -> Self {
        let mut generator = ChaCha8Rng::seed_from_u64(seed);
        let of_preload = protocol.preload_error * normal_pair(&mut generator)[0];
        let mut noise = Noise {
            generator,
            deviation: protocol.noise,
            values: Vec::new(),
            zero: 0.0,
            of_preload,
        };
        let free = protocol.free.max(1);
        noise.zero = (0..free).map(|index| noise.at(index)).sum::<f64>() / free as f64;
        noise
    }

    fn at(&mut self, index: usize) -> f64 {
        while self.values.len() <= index {
            self.values
                .extend(normal_pair(&mut self.generator).map(|value| self.deviation * value));
        }
        self.values[index] - self.zero
    }
}

/// Returns two independent values with the standard normal distribution (Box and Muller).
fn normal_pair(generator: &mut ChaCha8Rng) -> [f64; 2] {
    let [one, other]: [f64; 2] = [generator.random(), generator.random()];
    let size = (-2.0 * (1.0 - one).ln()).sqrt();
    let (sine, cosine) = (std::f64::consts::TAU * other).sin_cos();
    [size * cosine, size * sine]
}

/// Threads that compute the curves of a table.
#[derive(Clone, Copy)]
pub(crate) struct Workers<'a> {
    pub specimen: Specimen<'a>,
    /// Folder of the files of the scene.
    pub folder: &'a Path,
    pub jobs: usize,
    /// Number of curves computed so far, and the function that is notified of it.
    pub computed: &'a AtomicUsize,
    pub report: &'a (dyn Fn(usize) + Sync),
}

impl Workers<'_> {
    /// Returns the summaries of the curves of each random profile at all nodes, with all moduli of
    /// one range together.
    pub fn curves(
        &self,
        lines: u64,
        ranges: &[f64],
        moduli: &[f64],
    ) -> Result<Vec<Vec<Summaries>>, ExperimentError> {
        let worker = || {
            let mut simulation = Simulation::new(self.folder.to_path_buf());
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

/// Evenly spaced nodes.
pub(crate) fn nodes(first: f64, step: f64, count: usize) -> Vec<f64> {
    (0..count)
        .map(|index| first + step * index as f64)
        .collect()
}

/// Grid of nodes, each with the summaries of the curves of all random profiles.
pub(crate) struct Table {
    /// ln(γ/E*), ascending and evenly spaced.
    pub ranges: Vec<f64>,
    /// ln E*, ascending and evenly spaced.
    pub moduli: Vec<f64>,
    /// Summaries of each random profile at all nodes, with all moduli of one range together.
    pub lines: Vec<Vec<Summaries>>,
}

/// An end of a table.
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

    /// Adds `count` nodes at an end.
    pub fn extend(
        &mut self,
        workers: &Workers<'_>,
        end: End,
        count: usize,
    ) -> Result<(), ExperimentError> {
        let axis = match end {
            End::LowRange | End::HighRange => &self.ranges,
            End::LowModulus | End::HighModulus => &self.moduli,
        };
        let (step, last) = (axis[1] - axis[0], axis[axis.len() - 1]);
        let added = match end {
            End::LowRange | End::LowModulus => nodes(axis[0] - step * count as f64, step, count),
            End::HighRange | End::HighModulus => nodes(last + step, step, count),
        };
        let lines = self.lines.len() as u64;
        match end {
            End::LowRange | End::HighRange => {
                let at = if end == End::LowRange {
                    0
                } else {
                    self.ranges.len()
                };
                let new = workers.curves(lines, &added, &self.moduli)?;
                let start = at * self.moduli.len();
                for (line, curves) in self.lines.iter_mut().zip(new) {
                    line.splice(start..start, curves);
                }
                self.ranges.splice(at..at, added);
            }
            End::LowModulus | End::HighModulus => {
                let at = if end == End::LowModulus {
                    0
                } else {
                    self.moduli.len()
                };
                let new = workers.curves(lines, &self.ranges, &added)?;
                for (line, curves) in self.lines.iter_mut().zip(new) {
                    let rows = line.chunks(self.moduli.len()).zip(curves.chunks(count));
                    *line = rows
                        .flat_map(|(old, new)| [&old[..at], new, &old[at..]].concat())
                        .collect();
                }
                self.moduli.splice(at..at, added);
            }
        }
        Ok(())
    }

    /// Nodes in the order of the curves of a line.
    pub fn places(&self) -> impl Iterator<Item = Place> {
        self.ranges.iter().flat_map(|&range| {
            self.moduli
                .iter()
                .map(move |&modulus| Place { range, modulus })
        })
    }
}

/// Mean and covariance of two values over the random profiles at a place.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Moments {
    pub mean: [f64; 2],
    /// Variance of the first value, covariance, variance of the second value.
    pub covariance: [f64; 3],
}

impl Moments {
    pub fn of(values: &[[f64; 2]]) -> Self {
        let count = values.len() as f64;
        let mean = [0, 1].map(|index| values.iter().map(|value| value[index]).sum::<f64>() / count);
        let product = |one: usize, other: usize| {
            let of = values
                .iter()
                .map(|value| (value[one] - mean[one]) * (value[other] - mean[other]));
            of.sum::<f64>() / (count - 1.0).max(1.0)
        };
        Moments {
            mean,
            covariance: [product(0, 0), product(0, 1), product(1, 1)],
        }
    }

    /// Returns the inverse of the covariance, in the order of the field `covariance`, and the
    /// logarithm of its determinant. A second value that does not vary is ignored.
    pub fn inverse(&self) -> ([f64; 3], f64) {
        let [one, both, other] = self.covariance;
        if other == 0.0 {
            let one = one.max(f64::MIN_POSITIVE);
            return ([1.0 / one, 0.0, 0.0], one.ln());
        }
        let determinant = (one * other - both * both).max(f64::MIN_POSITIVE);
        (
            [other / determinant, -both / determinant, one / determinant],
            determinant.ln(),
        )
    }
}

/// Returns (x − mean)ᵀ Σ⁻¹ (x − mean).
pub(crate) fn distance(mean: [f64; 2], inverse: [f64; 3], at: [f64; 2]) -> f64 {
    let [one, other] = [at[0] - mean[0], at[1] - mean[1]];
    inverse[0] * one * one + 2.0 * inverse[1] * one * other + inverse[2] * other * other
}

/// Mean and covariance over the random profiles at all nodes.
#[derive(Clone)]
pub(crate) struct Scatter {
    ranges: Vec<f64>,
    moduli: Vec<f64>,
    nodes: Vec<Moments>,
}

/// First of the nodes that surround a place, and their weights.
struct Weights<const COUNT: usize> {
    first: usize,
    of: [f64; COUNT],
}

/// Returns the weights of the polynomial through the `COUNT` nearest nodes of an axis, or through
/// all nodes of a shorter axis.
fn weights<const COUNT: usize>(axis: &[f64], at: f64) -> Weights<COUNT> {
    let count = COUNT.min(axis.len());
    let next = axis.partition_point(|node| *node < at);
    let first = next
        .saturating_sub(count.div_ceil(2))
        .min(axis.len() - count);
    let mut of = [0.0; COUNT];
    for (index, weight) in of.iter_mut().enumerate().take(count) {
        let node = axis[first + index];
        let others = (first..first + count).filter(|other| *other != first + index);
        *weight = others
            .map(|other| (at - axis[other]) / (node - axis[other]))
            .product();
    }
    Weights { first, of }
}

impl Scatter {
    /// Computes the moments of two values, which `value` returns for the number of a random profile
    /// and of a node.
    pub fn of(table: &Table, value: impl Fn(usize, usize) -> [f64; 2]) -> Self {
        let node = |node: usize| {
            Moments::of(
                &(0..table.lines.len())
                    .map(|line| value(line, node))
                    .collect::<Vec<_>>(),
            )
        };
        let nodes = (0..table.ranges.len() * table.moduli.len())
            .map(node)
            .collect();
        Scatter {
            ranges: table.ranges.clone(),
            moduli: table.moduli.clone(),
            nodes,
        }
    }

    /// Returns the moments at a place: the mean by cubic interpolation, the covariance by linear
    /// interpolation.
    pub fn at(&self, place: Place) -> Moments {
        let of = |one: usize, other: usize| &self.nodes[one * self.moduli.len() + other];
        let mut moments = Moments {
            mean: [0.0; 2],
            covariance: [0.0; 3],
        };
        let (range, modulus) = (
            weights::<4>(&self.ranges, place.range),
            weights::<4>(&self.moduli, place.modulus),
        );
        for (one, first) in range
            .of
            .iter()
            .enumerate()
            .filter(|(_, weight)| **weight != 0.0)
        {
            for (other, second) in modulus
                .of
                .iter()
                .enumerate()
                .filter(|(_, weight)| **weight != 0.0)
            {
                let node = of(range.first + one, modulus.first + other);
                (0..2).for_each(|index| moments.mean[index] += first * second * node.mean[index]);
            }
        }
        let inside = |axis: &[f64], at: f64| at.clamp(axis[0], axis[axis.len() - 1]);
        let range = weights::<2>(&self.ranges, inside(&self.ranges, place.range));
        let modulus = weights::<2>(&self.moduli, inside(&self.moduli, place.modulus));
        for (one, first) in range
            .of
            .iter()
            .enumerate()
            .filter(|(_, weight)| **weight != 0.0)
        {
            for (other, second) in modulus
                .of
                .iter()
                .enumerate()
                .filter(|(_, weight)| **weight != 0.0)
            {
                let node = of(range.first + one, modulus.first + other);
                (0..3).for_each(|index| {
                    moments.covariance[index] += first * second * node.covariance[index]
                });
            }
        }
        moments
    }
}

/// Finds the place, to about a step of the table, where the computed curves have the mean summaries
/// of the measured curves.
pub(crate) fn placed(
    workers: &Workers<'_>,
    measured: &Measured,
    governing: &Governing,
    known: Option<f64>,
) -> Result<Place, ExperimentError> {
    let target = measured.mean().summaries;
    let of_roughness = governing
        .amplitude
        .map_or(0.0, |of| of.rms_height * of.rms_gradient);
    let largest = of_roughness.max(f64::MIN_POSITIVE).ln();
    let modulus = governing.effective_modulus.ln();
    let width = |index: usize| (NODES[index] - 1) as f64 * STEPS[index];
    let (mut low, mut soft) = (
        largest - HIGHEST_KAPPA.powi(2).ln(),
        modulus - 0.5 * width(1),
    );
    let variance = 1.0 / measured.summaries.len() as f64 + 1.0 / LINES as f64;
    for last in (0..MOST_MOVES).rev() {
        let ranges = nodes(low, STEPS[0], NODES[0]);
        let moduli = known.map_or_else(|| nodes(soft, STEPS[1], NODES[1]), |modulus| vec![modulus]);
        let table = Table::new(workers, LINES, ranges, moduli)?;
        let of_summary =
            |index: usize| Scatter::of(&table, |line, node| [table.lines[line][node][index], 0.0]);
        let scatters: Vec<Scatter> = (0..SUMMARIES).map(of_summary).collect();
        let misfit = |place: Place| {
            let of = |(scatter, target): (&Scatter, f64)| {
                let moments = scatter.at(place);
                let square = moments.covariance[0] + LEAST_SCATTER.powi(2);
                (moments.mean[0] - target).powi(2) / square / variance + square.ln()
            };
            scatters.iter().zip(target).map(of).sum::<f64>()
        };
        let within = |axis: &[f64]| {
            let fine = FINE_STEPS * (axis.len() - 1);
            let (first, last) = (axis[0], axis[axis.len() - 1]);
            (0..=fine)
                .map(move |index| first + (last - first) * index as f64 / fine.max(1) as f64)
                .collect()
        };
        let (ranges, moduli): (Vec<f64>, Vec<f64>) = (within(&table.ranges), within(&table.moduli));
        let places = ranges
            .iter()
            .flat_map(|&range| moduli.iter().map(move |&modulus| Place { range, modulus }));
        let misfits = places.map(|place| (misfit(place), place));
        let Some((_, best)) = misfits.min_by(|one, other| one.0.total_cmp(&other.0)) else {
            break;
        };
        let is_at_end = |axis: &[f64], at: f64, step: f64| {
            axis.len() > 1 && (at - axis[0]).min(axis[axis.len() - 1] - at) < 0.5 * step
        };
        let moved = [
            is_at_end(&table.ranges, best.range, STEPS[0]),
            is_at_end(&table.moduli, best.modulus, STEPS[1]),
        ];
        if moved == [false; 2] || last == 0 {
            return Ok(best);
        }
        if moved[0] {
            low = best.range - 0.5 * width(0);
        }
        if moved[1] {
            soft = best.modulus - 0.5 * width(1);
        }
    }
    Ok(Place {
        range: low,
        modulus,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::common::bodies::{self, Body};
    use crate::common::specimens::{curve, scene};
    use crate::fit::ensemble::summary::NAMES;
    use asperity_data::{mean, standard_deviation};

    /// A table that was extended is the larger table from the beginning, by any number of threads.
    #[test]
    fn extended_tables_are_larger_tables() {
        let mut scene = scene("rough-sphere");
        scene.numerics.points = 1024;
        scene.set_seed(3);
        let branches = Branches::of(&curve(&mut Simulation::default(), &scene, 3, 0.01)).unwrap();
        let protocols = [Protocol::of(&branches, branches.preload())];
        let computed = AtomicUsize::new(0);
        let scene = scene.checked().unwrap();
        let workers = |jobs| Workers {
            specimen: Specimen {
                scene: &scene,
                stiffness: 200.0,
                closing: 0.5,
                protocols: &protocols,
                stop: &|| false,
            },
            folder: Path::new(""),
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

    /// A table whose first summary is a cubic of the place, with a scatter of 1 over two lines.
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
        let places: Vec<Place> = table.places().collect();
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
        let (inverse, determinant) = moments.inverse();
        // The squared distances of n values sum up to their dimension times n − 1.
        let sum: f64 = values
            .iter()
            .map(|value| distance(moments.mean, inverse, *value))
            .sum();
        assert!((sum - 6.0).abs() < 1e-12);
        let [one, both, other] = moments.covariance;
        assert!((determinant.exp() - (one * other - both * both)).abs() < 1e-12);
    }

    /// Measured curves and computed curves of the same profiles have the same summaries, up to their
    /// noise and a small part of the scatter over profiles.
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
            let measured = Measured::of(&(0..LINES).map(curve).collect::<Vec<_>>()).unwrap();
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
