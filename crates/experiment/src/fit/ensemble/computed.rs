//! Computed force curves of random profiles, reduced to their summaries.

use super::noise::Noise;
use super::summary::{Branches, Point, Protocol, Summaries, summaries};
use crate::error::ExperimentError;
use crate::fit::model::Sampling;
use asperity_contact::motion::{Body, MovingBody};
use asperity_contact::{ContactError, ForcePoint, Modulus, Move};
use asperity_data::on_threads;
use asperity_scene::instrument::DisplacementCurve;
use asperity_scene::{CheckedScene, Simulation};
use std::sync::atomic::{AtomicUsize, Ordering};

/// Number of points of a computed approach or retraction, without the points at jumps.
const SAMPLES: usize = 128;
/// Smallest jump of the force, in units of the noise, for which the curve gets a point at each end
/// of the jump.
const NOTABLE: f64 = 1.0;
/// Largest number of points that are added to a computed retraction until contact is lost, divided
/// by the number of points of the measured retraction.
const LONGEST: usize = 8;
/// First seed of the random profiles and of the noise. It is far from the seeds that users write in
/// scenes, so that no profile of the table is the profile of a scene.
const FIRST_SEED: u64 = 0x6173_7065_7269_7479;
/// Difference between the first seeds of two scenes whose seeds differ by 1. No table has so many
/// profiles, so the tables of two scenes have no profile in common.
const SEEDS_OF_SCENE: u64 = 1 << 32;
/// Smallest force at the turning point of a computed curve, divided by the measured preload. The
/// random error of the preload lowers the force no further.
const LEAST_TURN: f64 = 0.5;

/// Scene, instrument and preloads of the computed curves, and the function that stops their
/// computation.
#[derive(Clone, Copy)]
pub(crate) struct Specimen<'a> {
    pub scene: &'a CheckedScene,
    /// Stiffness of the instrument in N/m.
    pub stiffness: f64,
    /// Work of adhesion on closing, divided by the work of adhesion on opening.
    pub closing: f64,
    /// Preload, displacements and noise of each measured curve. The computed curves use the
    /// protocols in turn: the first curve the first protocol, and so on.
    pub protocols: &'a [Protocol],
    /// Function that returns true if the computation has to stop.
    pub stop: &'a (dyn Fn() -> bool + Sync),
}

impl Specimen<'_> {
    /// Returns the summaries of the curves of one random profile. A summary is a number computed
    /// from a curve, such as its pull-off force. There is a curve for each pair of a value ln(γ/E*)
    /// in `ranges` and a value ln E* in `moduli`, with γ and E* in SI units. All moduli of the
    /// first range come first. `moduli` has to ascend.
    ///
    /// Apart from the turning point and the instrument, the curve of the force divided by E* over
    /// the indentation depends only on γ/E*. Therefore one approach is computed for all moduli of a
    /// range.
    ///
    /// # Errors
    /// Returns an error if a force curve cannot be computed, or if the computation is stopped.
    pub fn curves(
        &self,
        simulation: &mut Simulation,
        profile: u64,
        ranges: &[f64],
        moduli: &[f64],
    ) -> Result<Vec<Summaries>, ExperimentError> {
        let seed = seed_of(self.scene, profile);
        let scene = self.scene.with_seed(seed);
        let (bare, _) = simulation.contact(&scene)?;
        let modulus = Modulus::effective(bare.modulus_in_pascals())?;
        let protocol = &self.protocols[profile as usize % self.protocols.len()];
        let mut noise = Noise::new(seed, protocol);
        let mut all = Vec::with_capacity(ranges.len() * moduli.len());
        for range in ranges {
            let work = range.exp() * bare.modulus_in_pascals();
            let contact = bare
                .with(modulus)
                .works_of_adhesion([self.closing * work, work])
                .build()?;
            let first = all.len();
            let mut approach = Body::new(&contact, 2);
            // The moduli are taken in descending order, because the largest modulus has the
            // smallest indentation, and the approach cannot go back.
            for modulus in moduli.iter().rev() {
                if (self.stop)() {
                    return Err(ContactError::Interrupted.into());
                }
                let scale = modulus.exp() / contact.modulus_in_pascals();
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
pub(super) fn seed_of(scene: &CheckedScene, profile: u64) -> u64 {
    let seed = scene.seed().unwrap_or_default();
    FIRST_SEED
        .wrapping_add(seed.wrapping_mul(SEEDS_OF_SCENE))
        .wrapping_add(profile)
}

/// Computation of one curve with approach and retraction. The computed forces and the stiffness of
/// the instrument are in units of `scale`.
struct ForceLoop<'a> {
    stiffness: f64,
    /// E* of the curve divided by E* of the computed contact.
    scale: f64,
    protocol: &'a Protocol,
}

/// Approach and retraction of one computed curve.
struct ComputedLoop {
    pressed: DisplacementCurve,
    pulled: DisplacementCurve,
    /// Displacement in m at the turning point.
    top: f64,
    /// Force in N at the turning point.
    turning_force: f64,
    /// Factor that turns the computed forces into forces in N.
    scale: f64,
}

impl ComputedLoop {
    /// Returns the displacement in m at the end of the retraction, relative to the turning point.
    fn end(&self) -> f64 {
        match self.pulled.points().last() {
            Some(point) => point.displacement - self.top,
            None => -self.top,
        }
    }

    /// Returns the force in N of the approach or of the retraction at a displacement in m relative
    /// to the turning point.
    fn force_at(&self, curve: &DisplacementCurve, displacement: f64) -> f64 {
        if let Some(point) = curve.at(self.top + displacement) {
            return self.scale * point.force;
        }
        // By rounding, the turning point may lie beyond the end of the computed curve.
        let is_turn = displacement > -1e-9 * self.top.abs();
        if is_turn { self.turning_force } else { 0.0 }
    }
}

impl ComputedLoop {
    /// Returns the points of the approach or of the retraction at displacements in m relative to
    /// the turning point.
    fn points_at(&self, curve: &DisplacementCurve, displacements: &[f64]) -> Vec<Point> {
        let mut points = Vec::with_capacity(displacements.len());
        for &displacement in displacements {
            points.push(Point {
                displacement,
                force: self.force_at(curve, displacement),
            });
        }
        points
    }

    /// Returns the points at both ends of each jump of the force of at least `least` in N.
    fn jump_ends(&self, curve: &DisplacementCurve, least: f64) -> Vec<Point> {
        let mut points = Vec::new();
        for ends in curve.jumps() {
            let change = self.scale * (ends[1].force - ends[0].force);
            if change.abs() < least {
                continue;
            }
            for end in ends {
                points.push(Point {
                    displacement: end.displacement - self.top,
                    force: self.scale * end.force,
                });
            }
        }
        points
    }
}

impl ForceLoop<'_> {
    /// Presses the body further up to the preload, and returns the forces with noise at the
    /// measured displacements of approach and retraction.
    fn branches(&self, body: &mut Body, noise: &mut Noise) -> Result<Branches, ContactError> {
        let protocol = self.protocol;
        let computed = self.compute(body, noise.of_preload)?;
        let mut approach = computed.points_at(&computed.pressed, &protocol.approach);
        let displacements = until_loss(&protocol.retraction, computed.end());
        let mut retraction = computed.points_at(&computed.pulled, &displacements);
        let least_jump = NOTABLE * protocol.noise;
        let [on_approach, on_retraction] = protocol.has_jump_ends;
        if on_approach {
            approach.extend(computed.jump_ends(&computed.pressed, least_jump));
            approach.sort_by(|point, next| point.displacement.total_cmp(&next.displacement));
        }
        if on_retraction {
            retraction.extend(computed.jump_ends(&computed.pulled, least_jump));
            retraction.sort_by(|point, next| next.displacement.total_cmp(&point.displacement));
        }
        for (index, point) in approach.iter_mut().chain(&mut retraction).enumerate() {
            point.force += noise.at(index);
        }
        Ok(Branches {
            approach,
            retraction,
            noise: protocol.noise,
            free: protocol.free,
        })
    }

    /// Presses the body further up to the preload, and computes the approach and the retraction
    /// from there. The body itself remains on the approach. The force at which the body turns
    /// differs from the measured preload by `preload_error` in N, because noise changes the
    /// measured preload.
    fn compute(&self, body: &mut Body, preload_error: f64) -> Result<ComputedLoop, ContactError> {
        let protocol = self.protocol;
        let least_force = LEAST_TURN * protocol.preload;
        let turning_force = (protocol.preload + preload_error).max(least_force);
        body.move_to(Move::ToForce(turning_force / self.scale))?;
        let approach = body.stage();
        let turn = body.point().indentation;
        let retraction = approach.turn(turn)?;
        let sampling = Sampling {
            stiffness: self.stiffness,
            points: SAMPLES,
            least_jump: NOTABLE * protocol.noise / self.scale,
        };
        let pressed = sampling.over(&approach, [0.0, turn], 1, Some(ForcePoint::default()))?;
        let pulled = sampling.pull(&retraction, turn)?;
        let top = match pressed.points().last() {
            Some(point) => point.displacement,
            None => turn,
        };
        Ok(ComputedLoop {
            pressed,
            pulled,
            top,
            turning_force,
            scale: self.scale,
        })
    }
}

/// Returns the displacements of a retraction in m, relative to the turning point. If the measured
/// displacements `retraction` end before the computed curve loses contact, at the displacement
/// `end`, further displacements are added.
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

/// Threads that compute the curves of a table.
#[derive(Clone, Copy)]
pub(crate) struct Workers<'a> {
    pub specimen: Specimen<'a>,
    /// Simulation that finds the measured files of the scene in their folder, or that already holds
    /// the measured roughness of the scene.
    pub simulation: &'a Simulation,
    /// Number of threads.
    pub jobs: usize,
    /// Number of curves computed so far.
    pub computed: &'a AtomicUsize,
    /// Function that receives the number of curves computed so far.
    pub report: &'a (dyn Fn(usize) + Sync),
}

impl Workers<'_> {
    /// Returns the summaries of the curves of each random profile at all nodes. A summary is a
    /// number computed from a curve. A node is a pair of a value ln(γ/E*) in `ranges` and a value
    /// ln E* in `moduli`. All moduli of the first range come first.
    ///
    /// # Errors
    /// Returns an error if a force curve cannot be computed, or if the computation is stopped.
    pub fn curves(
        &self,
        profiles: u64,
        ranges: &[f64],
        moduli: &[f64],
    ) -> Result<Vec<Vec<Summaries>>, ExperimentError> {
        let worker = || {
            let mut simulation = self.simulation.another();
            move |profile: u64| {
                let curves = self
                    .specimen
                    .curves(&mut simulation, profile, ranges, moduli)?;
                let before = self.computed.fetch_add(curves.len(), Ordering::Relaxed);
                (self.report)(before + curves.len());
                Ok(curves)
            }
        };
        on_threads(profiles, self.jobs, worker)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::common::bodies::{self, Body};
    use crate::fit::ensemble::summary::{Measurement, NAMES};
    use asperity_data::{mean, standard_deviation};

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
            let curve = |profile: u64| {
                (
                    profile.to_string(),
                    specimen.curve(&mut simulation, seed_of(&truth, profile)),
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
            let computed = |profile: u64| {
                table
                    .curves(&mut simulation, profile, &[range], &[modulus])
                    .unwrap()[0]
            };
            let computed: Vec<Summaries> = (0..LINES).map(computed).collect();
            for (index, name) in NAMES.into_iter().enumerate() {
                let pairs = computed.iter().zip(&measured.summaries);
                let differences: Vec<f64> = pairs
                    .map(|(first, second)| second[index] - first[index])
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
