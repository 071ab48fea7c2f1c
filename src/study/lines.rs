//! One scene on many random lines: the mean of what they give, and how far they differ.
//!
//! Heights of self-affine lines do not average themselves: long waves carry most of them, and there are few of
//! those however many springs a line has. So one line is one sample, and a mean needs many.

use super::height_shape::HeightShape;
use super::statistics::Statistics;
use crate::analysis::Regime;
use crate::parallel::on_this_thread;
use crate::scene::Scene;
use crate::simulation::{Outcome, RunError, Simulation};
use serde::Serialize;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use thiserror::Error;

/// What one line gave, in SI units.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct LineResult {
    /// Its seed.
    pub seed: u64,
    /// Adhesion force F_a, N.
    pub adhesion_force: Option<f64>,
    /// Indentation at the preload, m.
    pub preload_indentation: Option<f64>,
    /// Energy lost, J.
    pub dissipated_energy: Option<f64>,
    /// Largest length in contact over the length of the line.
    pub contact_fraction: f64,
    /// Regime of Fig. 4.
    pub regime: Option<Regime>,
    /// Shape of the distribution of its heights, without the form.
    pub heights: Option<HeightShape>,
}

/// Why an ensemble could not be computed.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum LinesError {
    /// There is but one line.
    #[error("several lines go with random roughness, which has seeds; this scene has one line")]
    OneLine,
    /// A line could not be computed.
    #[error("seed {seed}: {error}")]
    Run {
        /// Its seed.
        seed: u64,
        /// Why not.
        error: RunError,
    },
}

/// Runs a checked scene on `lines` lines: its seed and those that follow, after the last of all seeds the
/// first. `jobs` threads share them; no bit of a result depends on how many.
///
/// # Errors
/// [`LinesError`]; of several lines that fail, the first.
pub fn solve_lines(
    scene: &Scene,
    folder: &Path,
    lines: usize,
    jobs: usize,
) -> Result<Vec<LineResult>, LinesError> {
    let first = scene.seed().ok_or(LinesError::OneLine)?;
    let next = AtomicUsize::new(0);
    let done = Mutex::new(Vec::new());
    let work = || {
        let mut simulation = Simulation::new(folder.to_path_buf());
        loop {
            let index = next.fetch_add(1, Ordering::Relaxed);
            if index >= lines {
                return;
            }
            let seed = first.wrapping_add(index as u64);
            let result = one_line(&mut simulation, scene, seed);
            if result.is_err() {
                // Lines after it are of no use any more; those before it are being computed or done.
                next.fetch_max(lines, Ordering::Relaxed);
            }
            done.lock().unwrap_or_else(PoisonError::into_inner).push((index, seed, result));
        }
    };
    std::thread::scope(|scope| {
        // A system that gives no further thread has those do all that it gave.
        let threads = jobs.min(lines);
        for _ in 1..threads {
            let _ = std::thread::Builder::new().spawn_scoped(scope, || on_this_thread(work));
        }
        if threads > 1 { on_this_thread(work) } else { work() }
    });
    let mut done = done.into_inner().unwrap_or_else(PoisonError::into_inner);
    done.sort_by_key(|&(index, ..)| index);
    done.into_iter()
        .map(|(_, seed, result)| result.map_err(|error| LinesError::Run { seed, error }))
        .collect()
}

fn one_line(simulation: &mut Simulation, scene: &Scene, wanted: u64) -> Result<LineResult, RunError> {
    let mut scene = scene.clone();
    scene.set_seed(wanted);
    // The form is the same for all of them.
    let flat = Scene { form: None, ..scene.clone() };
    let heights = HeightShape::of(simulation.make_line(&flat)?.0.gaps.iter().map(|gap| -gap));
    let outcome = simulation.run(&scene, &|| false, &mut |_, _, _| Ok(()))?;
    Ok(LineResult::of(wanted, &outcome, heights))
}

impl LineResult {
    fn of(seed: u64, outcome: &Outcome, heights: Option<HeightShape>) -> Self {
        let lengths =
            outcome.history.legs.iter().flat_map(|leg| &leg.curve).map(|point| point.contact_length);
        let figures = &outcome.figures;
        LineResult {
            seed,
            adhesion_force: figures.adhesion_force,
            preload_indentation: figures.preload_indentation,
            dissipated_energy: figures.dissipated_energy,
            contact_fraction: lengths.fold(0.0, f64::max) / outcome.line.length,
            regime: outcome.regime,
            heights,
        }
    }
}

/// Statistics over lines; a figure that fewer than two of them have is `None`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct LinesSummary {
    /// Of the adhesion force, N.
    pub adhesion_force: Option<Statistics>,
    /// Of the indentation at the preload, m.
    pub preload_indentation: Option<Statistics>,
    /// Of the energy lost, J.
    pub dissipated_energy: Option<Statistics>,
    /// Of the largest length in contact over the length of the line.
    pub contact_fraction: Option<Statistics>,
    /// Lines of each regime.
    pub regimes: RegimeCounts,
    /// Root mean square over the lines of the skewness of their heights; zero if they averaged themselves.
    pub rms_skewness: Option<f64>,
    /// The same of the excess kurtosis.
    pub rms_excess_kurtosis: Option<f64>,
}

/// How many lines are of which regime.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct RegimeCounts {
    /// Pressure-insensitive adhesion.
    pub pressure_insensitive: usize,
    /// Pressure-sensitive adhesion.
    pub pressure_sensitive: usize,
    /// No adhesion.
    pub non_adhesive: usize,
    /// Nothing is pulled.
    pub none: usize,
}

impl LinesSummary {
    /// Of what the lines gave.
    #[must_use]
    pub fn of(lines: &[LineResult]) -> Self {
        let statistics = |figure: fn(&LineResult) -> Option<f64>| {
            Statistics::of(&lines.iter().filter_map(figure).collect::<Vec<_>>())
        };
        let rms = |figure: fn(&HeightShape) -> f64| {
            let squares: Vec<_> =
                lines.iter().filter_map(|line| Some(figure(line.heights.as_ref()?).powi(2))).collect();
            (!squares.is_empty()).then(|| (squares.iter().sum::<f64>() / squares.len() as f64).sqrt())
        };
        let mut regimes = RegimeCounts::default();
        for line in lines {
            *match line.regime {
                Some(Regime::PressureInsensitive) => &mut regimes.pressure_insensitive,
                Some(Regime::PressureSensitive) => &mut regimes.pressure_sensitive,
                Some(Regime::NonAdhesive) => &mut regimes.non_adhesive,
                None => &mut regimes.none,
            } += 1;
        }
        LinesSummary {
            adhesion_force: statistics(|line| line.adhesion_force),
            preload_indentation: statistics(|line| line.preload_indentation),
            dissipated_energy: statistics(|line| line.dissipated_energy),
            contact_fraction: statistics(|line| Some(line.contact_fraction)),
            regimes,
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
        // Each is the scene itself with that seed.
        scene.set_seed(0);
        let outcome =
            Simulation::new(document.resolve("")).run(&scene, &|| false, &mut |_, _, _| Ok(())).unwrap();
        assert_eq!(alone[3].adhesion_force, outcome.figures.adhesion_force);
        assert_eq!(alone[3].dissipated_energy, outcome.figures.dissipated_energy);
        let summary = LinesSummary::of(&alone);
        assert_eq!(summary.adhesion_force.unwrap().count, 7);
        let regimes = summary.regimes;
        assert_eq!(
            regimes.pressure_insensitive + regimes.pressure_sensitive + regimes.non_adhesive + regimes.none,
            7
        );
        let smooth = open("jkr-sphere").unwrap();
        assert_eq!(solve_lines(smooth.scene(), &smooth.resolve(""), 2, 1), Err(LinesError::OneLine));
    }
}
