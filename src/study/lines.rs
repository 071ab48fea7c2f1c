//! One scene on many random profiles: mean results and their spread.
//!
//! Heights of a self-affine profile do not average out: a few long waves carry most of them, on any number of
//! springs. So one profile is one sample, and a mean needs many.

use super::cells::Cells;
use super::height_shape::HeightShape;
use super::plan::Plan;
use super::quantity::Quantity;
use super::recorder::Recorder;
use super::solve::{Case, Next, SharedWork, Sink};
use super::statistics::Statistics;
use crate::analysis::Regime;
use crate::parallel::{begin_threads, on_this_thread};
use crate::scene::Scene;
use crate::simulation::{RunError, Simulation};
use serde::Serialize;
use std::ops::ControlFlow;
use std::path::Path;
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
    #[error(
        "several lines go with roughness: SelfAffine or an equivalent line, which have seeds; this scene has but one line"
    )]
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
    let solved = solve_profiles(&plan, jobs, || {
        let mut recorder = Recorder::new(&plan, Simulation::new(folder.to_path_buf()), &|| false);
        move |scene: &mut Scene, seed| recorder.record(scene, seed)
    })?;
    Ok(solved.into_iter().map(|(seed, records)| LineResult::new(seed, &records.concat())).collect())
}

/// Solves the only cell of a plan on all of its profiles: the seed of each with its result, in the order of the
/// profiles. `jobs` threads share the profiles, each with its own solver.
///
/// # Errors
/// [`LinesError`]; of several profiles that fail, the first.
pub(super) fn solve_profiles<R, C>(
    plan: &Plan,
    jobs: usize,
    of_case: impl Fn() -> C + Sync,
) -> Result<Vec<(u64, R)>, LinesError>
where
    R: Send,
    C: FnMut(&mut Scene, u64) -> Result<R, RunError>,
{
    if plan.scene.seed().is_none() {
        return Err(LinesError::OneLine);
    }
    let cells = Cells::of(plan);
    let work = &SharedWork::new(plan, &cells, (0..cells.units()).map(|unit| cells.unit(unit)));
    let solved: &Solved<R> = &Mutex::new(Vec::new());
    let solve = || work.solve(of_case(), &mut &*solved);
    let solve = &solve;
    let threads = usize::try_from(plan.lines).map_or(jobs, |lines| jobs.min(lines));
    std::thread::scope(|scope| {
        // Without further threads this one does all the work.
        let _ = begin_threads(scope, threads.saturating_sub(1), solve);
        on_this_thread(solve);
    });
    let mut solved = std::mem::take(&mut *solved.lock().unwrap_or_else(PoisonError::into_inner));
    solved.sort_by_key(|&(line, _)| line);
    let result = |(line, record): (u64, Result<R, RunError>)| {
        let seed = plan.seed_of(line);
        record.map(|record| (seed, record)).map_err(|error| LinesError::Run { seed, error })
    };
    solved.into_iter().map(result).collect()
}

/// Solved profiles, by their numbers.
type Solved<R> = Mutex<Vec<(u64, Result<R, RunError>)>>;

impl<R> Sink<R> for &Solved<R> {
    fn next(&mut self, _: Case) -> Next {
        Next::Solve
    }

    fn take(&mut self, case: Case, records: Result<R, RunError>) -> ControlFlow<()> {
        // After a failure the profiles that follow are not needed; those before are under way or done.
        let flow = if records.is_err() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) };
        self.lock().unwrap_or_else(PoisonError::into_inner).push((case.line, records));
        flow
    }
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
            regime: value(Quantity::Regime).and_then(|place| Regime::ALL.get(place as usize).copied()),
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
        LinesSummary {
            adhesion_force: statistics(|line| line.adhesion_force),
            preload_indentation: statistics(|line| line.preload_indentation),
            dissipated_energy: statistics(|line| line.dissipated_energy),
            contact_fraction: statistics(|line| Some(line.contact_fraction)),
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
        let regimes = summary.regimes;
        assert_eq!(
            regimes.pressure_insensitive + regimes.pressure_sensitive + regimes.non_adhesive + regimes.none,
            7
        );
        let smooth = open("jkr-sphere").unwrap();
        assert_eq!(solve_lines(smooth.scene(), &smooth.resolve(""), 2, 1), Err(LinesError::OneLine));
    }
}
