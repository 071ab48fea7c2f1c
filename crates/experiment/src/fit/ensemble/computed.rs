//! Summaries of curves of random profiles, computed at the points of a measured curve.

use super::branches::{Branches, Point};
use super::summary::{Summaries, summaries};
use crate::error::ExperimentError;
use crate::fit::model::Sampling;
use asperity_contact::motion::{Body, MovingBody};
use asperity_contact::{ContactError, CurvePoint, Modulus, Move};
use asperity_scene::instrument::DisplacementCurve;
use asperity_scene::{CheckedScene, Simulation};
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};

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

/// How a curve was measured.
pub(crate) struct Protocol {
    /// Measured force at the turning point, and the standard deviation of its error, N.
    pub preload: f64,
    pub preload_error: f64,
    pub noise: f64,
    /// Displacements relative to the turning point, m.
    pub approach: Vec<f64>,
    pub retraction: Vec<f64>,
    /// Number of points at the beginning of the approach that give the zero of the force.
    pub free: usize,
}

impl Protocol {
    pub fn of(branches: &Branches, preload: f64) -> Self {
        let places = |branch: &[Point]| branch.iter().map(|point| point.0).collect();
        Protocol {
            preload,
            preload_error: branches.preload_error(),
            noise: branches.noise,
            approach: places(&branches.approach),
            retraction: places(&branches.retraction),
            free: branches.free,
        }
    }
}

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
