//! Adhesion against preload: the adhesion force of one profile for many preloads, and its mean over random profiles.

use super::error::StudyError;
use super::plan::ONE_PROFILE;
use super::quantity::Quantity;
use super::statistics::Statistics;
use crate::contact::Reversal;
use crate::parallel::on_threads;
use crate::scene::{Move, Scene};
use crate::simulation::{RunError, Simulation};
use serde::Serialize;
use std::ops::RangeInclusive;
use std::path::Path;

/// Numbers of preloads.
pub const PRELOADS: RangeInclusive<usize> = 2..=512;

/// Equally spaced preloads, N.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Preloads {
    from: f64,
    to: f64,
    count: usize,
}

impl Preloads {
    /// Preloads between two forces, N, the first at least 0 and below the second; `None` for other forces, or a
    /// number outside [`PRELOADS`].
    pub fn new(from: f64, to: f64, count: usize) -> Option<Self> {
        let is_allowed = from >= 0.0 && to > from && to.is_finite() && PRELOADS.contains(&count);
        is_allowed.then_some(Preloads { from, to, count })
    }

    /// Smallest and largest preload, N.
    pub fn ends(&self) -> (f64, f64) {
        (self.from, self.to)
    }

    /// The forces, N, in ascending order.
    pub fn forces(&self) -> Vec<f64> {
        let last = (self.count - 1) as f64;
        let at = |index: usize| (self.from + (self.to - self.from) * (index as f64 / last)).min(self.to);
        (0..self.count).map(at).collect()
    }
}

/// The unloading from one preload to separation, in SI units.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Preloaded {
    /// Preload F_n, N.
    pub preload: f64,
    /// Indentation at the preload, m.
    pub preload_indentation: f64,
    /// Adhesion force F_a, N.
    pub adhesion_force: Option<f64>,
    /// Indentation at the smallest force, m.
    pub pull_off_indentation: f64,
    /// Energy dissipated from separation to separation, J.
    pub dissipated_energy: f64,
}

impl Preloaded {
    /// Figures of a reversal at this preload, N.
    pub fn new(preload: f64, reversal: &Reversal) -> Self {
        Preloaded {
            preload,
            preload_indentation: reversal.turn.indentation,
            adhesion_force: reversal.adhesion_force(),
            pull_off_indentation: reversal.smallest.indentation,
            dissipated_energy: reversal.dissipated_energy,
        }
    }
}

/// Solves a checked scene for these preloads, N, in place of its own loading: one loading, one unloading from each.
/// `see` receives each result as soon as it is ready, in the order of ascending preloads.
///
/// # Errors
/// Those of [`Simulation::reverse`].
pub fn solve_preloads(
    simulation: &mut Simulation,
    scene: &Scene,
    forces: &[f64],
    stop: &dyn Fn() -> bool,
    see: &mut dyn FnMut(Preloaded),
) -> Result<(), RunError> {
    let ends: Vec<Move> = forces.iter().map(|&force| Move::ToForce(force)).collect();
    simulation.reverse(scene, (&ends, &[]), stop, &mut |index, reversal| {
        see(Preloaded::new(forces[index], &reversal));
        Ok(())
    })
}

/// Solves a checked scene for these preloads, N, on `lines` profiles: its seed and the seeds that follow. `jobs` threads
/// share the profiles; no bit of a result depends on their number. The seed of each profile comes with its results.
///
/// # Errors
/// A scene with a single profile, or the first profile that fails.
pub fn solve_preloads_on_lines(
    scene: &Scene,
    folder: &Path,
    forces: &[f64],
    lines: u64,
    jobs: usize,
) -> Result<Vec<(u64, Vec<Preloaded>)>, StudyError> {
    let first = scene.seed().ok_or_else(|| StudyError::Records(ONE_PROFILE.into()))?;
    on_threads(lines, jobs, || {
        let (mut simulation, mut scene) = (Simulation::new(folder.to_path_buf()), scene.clone());
        move |line| {
            let (seed, mut found) = (first.wrapping_add(line), Vec::with_capacity(forces.len()));
            scene.set_seed(seed);
            solve_preloads(&mut simulation, &scene, forces, &|| false, &mut |one| found.push(one))
                .map_err(|error| StudyError::profile(seed, error))?;
            Ok((seed, found))
        }
    })
}

/// Statistics of the adhesion force over profiles for each preload; a profile without a tensile force counts as 0
/// N, so that the mean is the mean adhesion force. `None` for fewer than two profiles.
pub fn preload_statistics(lines: &[Vec<Preloaded>]) -> Vec<Option<Statistics>> {
    let count = lines.iter().map(Vec::len).min().unwrap_or(0);
    let forces = |index: usize| lines.iter().map(move |line| line[index].adhesion_force.unwrap_or(0.0));
    let statistics =
        |index| Statistics::of(&forces(index).collect::<Vec<_>>(), Quantity::AdhesionForce.bounds());
    (0..count).map(statistics).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::open;

    #[test]
    fn adhesion_grows_with_the_preload_over_sixteen_profiles() {
        let document = open("pressure-sensitive").unwrap();
        let forces = Preloads::new(0.0, 2e-5, 9).unwrap().forces();
        assert_eq!((forces[0], forces[8], forces.len()), (0.0, 2e-5, 9));
        let of = |jobs| {
            solve_preloads_on_lines(document.scene(), &document.resolve(""), &forces, 16, jobs).unwrap()
        };
        let lines = of(2);
        // One profile is the scene itself, loaded to one of the forces.
        let mut scene = document.scene().clone();
        scene.set_seed(lines[3].0);
        scene.loading = vec![Move::ToForce(forces[4]), Move::ToSeparation];
        let outcome = Simulation::default().run(&scene, &|| false, &mut |_, _, _| Ok(())).unwrap();
        assert_eq!(lines[3].1[4].adhesion_force, outcome.figures.adhesion_force);
        assert_eq!(lines[3].1[4].dissipated_energy, outcome.figures.dissipated_energy.unwrap());
        let curves: Vec<_> = lines.iter().map(|(_, line)| line.clone()).collect();
        for curve in &curves {
            assert!(
                curve.windows(2).all(|pair| pair[0].adhesion_force <= pair[1].adhesion_force),
                "{curve:?}"
            );
        }
        let means: Vec<f64> = preload_statistics(&curves).iter().map(|one| one.unwrap().mean).collect();
        assert!(means.windows(2).all(|pair| pair[0] < pair[1]), "{means:?}");
        // Twice the preload about doubles the mean.
        assert!(means[8] > 1.5 * means[4] && means[4] > 1.5 * means[2], "{means:?}");
        assert!(means[0] < 0.1 * means[8], "{means:?}");
        assert_eq!(of(1), lines);
    }

    #[test]
    fn smooth_bodies_have_but_one_profile() {
        let smooth = open("jkr-sphere").unwrap();
        let failed = solve_preloads_on_lines(smooth.scene(), &smooth.resolve(""), &[1e-6], 2, 1);
        assert_eq!(failed.unwrap_err().to_string(), ONE_PROFILE);
        assert_eq!(preload_statistics(&[vec![]]), vec![]);
    }
}
