//! One scene on many random profiles: mean results and their spread.
//!
//! Heights of a self-affine profile do not average out: a few long waves carry most of them, on any number of
//! springs. So one profile is one sample, and a mean needs many.

use super::height_shape::HeightShape;
use super::plan::{ONE_PROFILE, Plan};
use super::quantity::{Quantity, regime_of};
use super::recorder::Recorder;
use super::statistics::Statistics;
use super::target::strip;
use crate::analysis::Regime;
use crate::parallel::{begin_threads, on_this_thread};
use crate::scene::Scene;
use crate::simulation::{RunError, Simulation};
use serde::Serialize;
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};
use thiserror::Error;

/// Result of one profile, in SI units.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct LineResult {
    /// Seed of the profile.
    pub seed: u64,
    /// Adhesion force F_a, N.
    pub adhesion_force: Option<f64>,
    /// Indentation at the preload, m.
    pub preload_indentation: Option<f64>,
    /// Dissipated energy, J.
    pub dissipated_energy: Option<f64>,
    /// Tabor number μ.
    pub tabor_number: Option<f64>,
    /// Largest length in contact over the length of the profile.
    pub contact_fraction: f64,
    /// Regime of Fig. 4.
    pub regime: Option<Regime>,
    /// Shape of the distribution of the heights, without the form.
    pub heights: Option<HeightShape>,
}

/// Reason why profiles could not be solved.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum LinesError {
    /// The scene has a single profile.
    #[error("{ONE_PROFILE}")]
    OneLine,
    /// A profile could not be computed.
    #[error("seed {seed}: {error}")]
    Run {
        /// Seed of the profile.
        seed: u64,
        /// Error of the run.
        error: RunError,
    },
}

/// Quantities of a profile, read by [`LineResult::new`].
const RECORD: [Quantity; 8] = [
    Quantity::AdhesionForce,
    Quantity::PreloadIndentation,
    Quantity::DissipatedEnergy,
    Quantity::TaborNumber,
    Quantity::ContactFraction,
    Quantity::Regime,
    Quantity::Skewness,
    Quantity::ExcessKurtosis,
];

/// Solves a checked scene on `lines` profiles: its seed and the seeds that follow, cyclically after the last of all
/// seeds. `jobs` threads share the profiles; no bit of a result depends on their number.
///
/// # Errors
/// [`LinesError`]; of several profiles that fail, the first.
pub fn solve_lines(
    scene: &Scene,
    folder: &Path,
    lines: usize,
    jobs: usize,
) -> Result<Vec<LineResult>, LinesError> {
    let plan = Plan::of_scene(scene, lines as u64, &RECORD);
    let solved = on_profiles(scene, lines, jobs, || {
        let mut recorder = Recorder::new(&plan, Simulation::new(folder.to_path_buf()), &|| false);
        move |mut scene| {
            strip(&mut scene);
            recorder.record(scene)
        }
    })?;
    Ok(solved.into_iter().map(|(seed, records)| LineResult::new(seed, &records.concat())).collect())
}

/// Solves a scene on `lines` random profiles: the seed of each with its result, in their order. `jobs` threads share the
/// profiles, each with its own solver.
///
/// # Errors
/// [`LinesError`]; of several profiles that fail, the first.
pub(super) fn on_profiles<R: Send, C>(
    scene: &Scene,
    lines: usize,
    jobs: usize,
    solver: impl Fn() -> C + Sync,
) -> Result<Vec<(u64, R)>, LinesError>
where
    C: FnMut(Scene) -> Result<R, RunError>,
{
    let first = scene.seed().ok_or(LinesError::OneLine)?;
    let (lines, next, solved) = (lines as u64, AtomicU64::new(0), Mutex::new(Vec::new()));
    let work = &|| {
        let mut solve = solver();
        loop {
            let line = next.fetch_add(1, Ordering::SeqCst);
            if line >= lines {
                return;
            }
            let (mut scene, seed) = (scene.clone(), first.wrapping_add(line));
            scene.set_seed(seed);
            let result = solve(scene);
            if result.is_err() {
                // The profiles that follow are not needed; those before are under way or done.
                next.store(lines, Ordering::SeqCst);
            }
            solved.lock().unwrap_or_else(PoisonError::into_inner).push((line, seed, result));
        }
    };
    let threads = jobs.min(lines as usize);
    std::thread::scope(|scope| {
        // Without further threads this one does all the work.
        let _ = begin_threads(scope, threads.saturating_sub(1), work);
        on_this_thread(work);
    });
    let mut solved = solved.into_inner().unwrap_or_else(PoisonError::into_inner);
    solved.sort_by_key(|(line, ..)| *line);
    let result = |(_, seed, result): (u64, u64, Result<R, RunError>)| match result {
        Ok(result) => Ok((seed, result)),
        Err(error) => Err(LinesError::Run { seed, error }),
    };
    solved.into_iter().map(result).collect()
}

impl LineResult {
    /// Result of a seed from the values of [`RECORD`].
    fn new(seed: u64, values: &[f64]) -> Self {
        let value = |quantity| {
            let column = RECORD.iter().position(|one| *one == quantity)?;
            values.get(column).copied().filter(|value| !value.is_nan())
        };
        let shape = value(Quantity::Skewness).zip(value(Quantity::ExcessKurtosis));
        LineResult {
            seed,
            adhesion_force: value(Quantity::AdhesionForce),
            preload_indentation: value(Quantity::PreloadIndentation),
            dissipated_energy: value(Quantity::DissipatedEnergy),
            tabor_number: value(Quantity::TaborNumber),
            contact_fraction: value(Quantity::ContactFraction).unwrap_or(0.0),
            regime: value(Quantity::Regime).and_then(|place| regime_of(Quantity::Regime, place)),
            heights: shape.map(|(skewness, excess_kurtosis)| HeightShape { skewness, excess_kurtosis }),
        }
    }
}

/// Statistics over profiles; `None` for a figure with values on fewer than two of them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct LinesSummary {
    /// Statistics of the adhesion force, N.
    pub adhesion_force: Option<Statistics>,
    /// Statistics of the indentation at the preload, m.
    pub preload_indentation: Option<Statistics>,
    /// Statistics of the dissipated energy, J.
    pub dissipated_energy: Option<Statistics>,
    /// Statistics of the largest length in contact over the length of the profile.
    pub contact_fraction: Option<Statistics>,
    /// Number of profiles in each regime.
    pub regimes: RegimeCounts,
    /// Root mean square over the profiles of the skewness of their heights; zero if the heights averaged out.
    pub rms_skewness: Option<f64>,
    /// Root mean square of the excess kurtosis.
    pub rms_excess_kurtosis: Option<f64>,
}

/// Number of profiles in each regime.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct RegimeCounts {
    /// Pressure-insensitive adhesion.
    pub pressure_insensitive: usize,
    /// Pressure-sensitive adhesion.
    pub pressure_sensitive: usize,
    /// No adhesion.
    pub non_adhesive: usize,
    /// Regime unknown: no tensile force.
    pub none: usize,
}

impl RegimeCounts {
    /// Counts the regimes of profiles.
    pub(super) fn of(regimes: impl Iterator<Item = Option<Regime>>) -> Self {
        let mut counts = RegimeCounts::default();
        for regime in regimes {
            *match regime {
                Some(Regime::PressureInsensitive) => &mut counts.pressure_insensitive,
                Some(Regime::PressureSensitive) => &mut counts.pressure_sensitive,
                Some(Regime::NonAdhesive) => &mut counts.non_adhesive,
                None => &mut counts.none,
            } += 1;
        }
        counts
    }

    /// Regimes that occur, by name, with their numbers of profiles.
    pub fn present(self) -> impl Iterator<Item = (&'static str, usize)> {
        let [insensitive, sensitive, none] = Regime::ALL.map(Regime::name);
        let rows = [
            (insensitive, self.pressure_insensitive),
            (sensitive, self.pressure_sensitive),
            (none, self.non_adhesive),
            ("not known", self.none),
        ];
        rows.into_iter().filter(|(_, count)| *count > 0)
    }
}

impl LinesSummary {
    /// Statistics of these results.
    pub fn of(lines: &[LineResult]) -> Self {
        let statistics = |quantity: Quantity, figure: fn(&LineResult) -> Option<f64>| {
            Statistics::of(&lines.iter().filter_map(figure).collect::<Vec<_>>(), quantity.bounds())
        };
        let rms = |figure: fn(&HeightShape) -> f64| {
            let squares: Vec<_> =
                lines.iter().filter_map(|line| Some(figure(line.heights.as_ref()?).powi(2))).collect();
            (!squares.is_empty()).then(|| (squares.iter().sum::<f64>() / squares.len() as f64).sqrt())
        };
        LinesSummary {
            adhesion_force: statistics(Quantity::AdhesionForce, |line| line.adhesion_force),
            preload_indentation: statistics(Quantity::PreloadIndentation, |line| line.preload_indentation),
            dissipated_energy: statistics(Quantity::DissipatedEnergy, |line| line.dissipated_energy),
            contact_fraction: statistics(Quantity::ContactFraction, |line| Some(line.contact_fraction)),
            regimes: RegimeCounts::of(lines.iter().map(|line| line.regime)),
            rms_skewness: rms(|shape| shape.skewness),
            rms_excess_kurtosis: rms(|shape| shape.excess_kurtosis),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::open;

    #[test]
    fn lines_do_not_depend_on_how_many_threads_share_them() {
        let document = open("rough-sphere").unwrap();
        let mut scene = document.scene().clone();
        scene.numerics.points = 1024;
        scene.set_seed(u64::MAX - 2);
        let of = |jobs| solve_lines(&scene, &document.resolve(""), 7, jobs).unwrap();
        let alone = of(1);
        assert_eq!(
            alone.iter().map(|line| line.seed).take(4).collect::<Vec<_>>(),
            [u64::MAX - 2, u64::MAX - 1, u64::MAX, 0]
        );
        assert_eq!(of(3), alone);
        assert_eq!(of(64), alone);
        // Each result is that of the scene itself with that seed.
        scene.set_seed(0);
        let outcome =
            Simulation::new(document.resolve("")).run(&scene, &|| false, &mut |_, _, _| Ok(())).unwrap();
        assert_eq!(alone[3].adhesion_force, outcome.figures.adhesion_force);
        assert_eq!(alone[3].dissipated_energy, outcome.figures.dissipated_energy);
        let summary = LinesSummary::of(&alone);
        assert_eq!(summary.adhesion_force.unwrap().count, 7);
        assert_eq!(summary.regimes.present().map(|(_, count)| count).sum::<usize>(), 7);
        let smooth = open("jkr-sphere").unwrap();
        assert_eq!(solve_lines(smooth.scene(), &smooth.resolve(""), 2, 1), Err(LinesError::OneLine));
    }
}
