//! Results of a computed scene as text and JSON, its force curve as a table and a figure, and the
//! table of a profile.

use crate::ensemble::{EnsembleJson, caption};
use crate::loop_chart::{LoopUnits, force_figure};
use crate::report::{Json, Report};
use crate::summary::Summary;
use crate::warnings::{outcome_warnings, warning_texts};
use asperity_contact::{CurvePoint, Move, Patch, StageRecord, Work};
use asperity_data::{Table, Warning, Wording};
use asperity_plot::Figure;
use asperity_scene::discretisation::Choice;
use asperity_scene::instrument::displacements;
use asperity_scene::theory::SteepWaves;
use asperity_scene::workload::Timings;
use asperity_scene::{Estimate, Observer, Outcome, Regime, Scene};
use asperity_study::Ensemble;
use asperity_study::trust::{Budget, Criterion, criteria};
use asperity_surface::lines::{Histogram, Line};
use serde::Serialize;

/// Report on all results of one computed scene, such as its force curve and pull-off force.
#[derive(Clone, Copy, Debug)]
pub struct RunReport<'a> {
    pub title: &'a str,
    pub scene: &'a Scene,
    /// Results on the profile of the scene.
    pub outcome: &'a Outcome,
    /// Choice of the number of springs with which the error is within a tolerance; `None` if no
    /// tolerance was given.
    pub choice: Option<&'a Choice>,
    /// Estimated error of the pull-off force due to the finite number of springs; `None` if it is
    /// unknown.
    pub estimate: Option<&'a Estimate>,
    /// Results on several random profiles of the same roughness; `None` if they were not computed.
    pub ensemble: Option<&'a Ensemble>,
    /// Standard deviation of the pull-off force due to errors of a measured spectrum, in N; `None`
    /// if it was not computed.
    pub deviation: Option<f64>,
    /// Function that states in words how the user takes a [`Remedy`](asperity_data::Remedy), a step
    /// that removes the cause of an error or a warning. The words name an option of the command
    /// line, a row of the explorer or an argument of Python.
    pub wording: Wording,
}

impl<'a> RunReport<'a> {
    /// Returns the estimate of the error; `None` if a premise of the model is not met, because the
    /// error is then unknown.
    fn known_estimate(&self) -> Option<&'a Estimate> {
        let mut warnings = self.outcome.warnings.iter();
        if warnings.any(Warning::leaves_errors_unknown) {
            return None;
        }
        self.estimate
    }
}

impl Report for RunReport<'_> {
    fn warnings(&self) -> Vec<String> {
        outcome_warnings(self.outcome, self.ensemble)
    }

    fn text(&self) -> Option<String> {
        let summary = Summary {
            scene: self.scene,
            outcome: self.outcome,
            estimate: self.known_estimate(),
            choice: self.choice,
            ensemble: self.ensemble,
            deviation: self.deviation,
            wording: self.wording,
        };
        Some(summary.text())
    }

    fn json(&self) -> Option<Box<dyn Json + '_>> {
        Some(Box::new(RunJson::new(self)))
    }

    fn table(&self) -> Option<Table<'_>> {
        let instrument = self.outcome.instrument;
        let stiffness = instrument.map(|instrument| instrument.stiffness);
        Some(table_of_curve(&self.outcome.history.stages, stiffness))
    }

    fn figure(&self) -> Option<Figure> {
        let figure = force_figure(&[(self.title, self.outcome)], LoopUnits::default());
        Some(Figure {
            notes: self.ensemble.and_then(caption).into_iter().collect(),
            ..figure
        })
    }
}

/// JSON object of a computed scene, in SI units.
#[derive(Serialize)]
pub(crate) struct RunJson<'a> {
    scene: &'a Scene,
    #[serde(skip_serializing_if = "Option::is_none")]
    choice: Option<&'a Choice>,
    ensemble: Option<EnsembleJson<'a>>,
    profile: ProfileJson,
    modulus: f64,
    work: Option<f64>,
    kappa: Option<f64>,
    elastic_energy: Option<f64>,
    elastic_energy_ratio: Option<f64>,
    regime: Option<Regime>,
    regime_after_zero_force: Option<Regime>,
    ideal_pull_off_force: Option<f64>,
    smooth_pull_off_force: Option<f64>,
    first_touch_pull_off_force: Option<f64>,
    zero_force_pull_off_force: Option<f64>,
    preload: Option<f64>,
    preload_indentation: Option<f64>,
    pull_off_force: Option<f64>,
    pull_off_force_error: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    curve_error: Option<f64>,
    /// Error of each force in N by the steps in time; left out without relaxation.
    #[serde(skip_serializing_if = "Option::is_none")]
    step_error: Option<f64>,
    pull_off_force_near_step: Option<bool>,
    adhesion_share: Option<f64>,
    adhesion_coefficient: Option<f64>,
    pull_off_indentation: Option<f64>,
    dissipated_energy: Option<f64>,
    /// Energy in J that relaxation dissipates; left out without relaxation.
    #[serde(skip_serializing_if = "Option::is_none")]
    relaxation_energy: Option<f64>,
    /// Loop area ∮F dD in J. The outer `None` leaves out the entry in the JSON object, for a scene
    /// without an instrument. The inner `None` is an unknown area.
    #[serde(skip_serializing_if = "Option::is_none")]
    loop_area: Option<Option<f64>>,
    /// Displacement in m of the instrument at pull-off. The outer `None` leaves out the entry in
    /// the JSON object, for a scene without an instrument. The inner `None` belongs to a loading
    /// without a pull-off.
    #[serde(skip_serializing_if = "Option::is_none")]
    pull_off_displacement: Option<Option<f64>>,
    tabor_number: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    steep_waves: Option<SteepWaves>,
    criteria: Vec<Criterion>,
    budget: Option<Budget>,
    warnings: Vec<String>,
    curve: Option<Table<'a>>,
    patches_at_end: &'a [Patch],
    patches_at_stage_ends: Option<&'a [Vec<Patch>]>,
    histogram: Option<HistogramJson<'a>>,
    counts: Work,
    timings: Timings,
}

/// Facts about the profile of a scene, in SI units.
#[derive(Serialize)]
struct ProfileJson {
    points: usize,
    length: f64,
    spacing: f64,
    rms_height: Option<f64>,
    rms_gradient: Option<f64>,
    modes: Option<(u64, u64)>,
    seed: Option<u64>,
}

#[derive(Serialize)]
struct HistogramJson<'a> {
    low: f64,
    high: f64,
    counts: &'a [u64],
}

impl<'a> RunJson<'a> {
    pub(crate) fn new(report: &'a RunReport<'a>) -> Self {
        let outcome = report.outcome;
        let governing = &outcome.governing;
        let figures = &outcome.figures;
        let instrument = outcome.instrument;
        let estimate = report.known_estimate();
        let has_patches = report.scene.observe.contains(&Observer::Patches);
        RunJson {
            scene: report.scene,
            choice: report.choice,
            ensemble: report.ensemble.map(EnsembleJson::new),
            profile: ProfileJson::new(outcome),
            modulus: governing.modulus,
            work: governing.work_of_adhesion,
            kappa: governing.kappa,
            elastic_energy: governing.elastic_energy(),
            elastic_energy_ratio: governing.elastic_energy_ratio,
            regime: outcome.regime,
            regime_after_zero_force: outcome.regime_after_zero_force,
            ideal_pull_off_force: outcome.ideal_pull_off_force,
            smooth_pull_off_force: outcome.smooth_pull_off_force,
            first_touch_pull_off_force: outcome.first_touch_pull_off_force,
            zero_force_pull_off_force: outcome.zero_force_pull_off_force,
            preload: figures.preload,
            preload_indentation: figures.preload_indentation,
            pull_off_force: figures.pull_off_force,
            pull_off_force_error: estimate.and_then(|estimate| estimate.of_pull_off_force(outcome)),
            curve_error: estimate.and_then(Estimate::of_curve),
            step_error: outcome.history.step_error(),
            pull_off_force_near_step: estimate.map(|estimate| estimate.near_step),
            adhesion_share: outcome.adhesion_share(),
            adhesion_coefficient: figures.adhesion_coefficient,
            pull_off_indentation: figures.pull_off_indentation,
            dissipated_energy: figures.dissipated_energy,
            relaxation_energy: relaxation_energy(report.scene, outcome),
            loop_area: instrument.map(|instrument| instrument.loop_area),
            pull_off_displacement: instrument.map(|instrument| instrument.pull_off_displacement),
            tabor_number: outcome.tabor_number,
            steep_waves: outcome.steep_waves,
            criteria: criteria(report.scene, outcome, report.ensemble),
            budget: Budget::of(outcome, estimate, report.ensemble, report.deviation),
            warnings: warning_texts(&outcome.warnings),
            curve: report.table(),
            patches_at_end: &outcome.history.contacts,
            patches_at_stage_ends: has_patches.then_some(outcome.patches.as_slice()),
            histogram: outcome.histogram.as_ref().map(HistogramJson::new),
            counts: outcome.history.work,
            timings: outcome.timings,
        }
    }
}

/// Returns the energy in J that relaxation dissipates; `None` without relaxation.
fn relaxation_energy(scene: &Scene, outcome: &Outcome) -> Option<f64> {
    let energies = outcome
        .history
        .stages
        .iter()
        .map(|stage| stage.dashpot_energy);
    scene.relaxes().then(|| energies.sum())
}

impl ProfileJson {
    fn new(outcome: &Outcome) -> Self {
        let line = &outcome.line;
        let amplitude = outcome.governing.amplitude;
        ProfileJson {
            points: line.points,
            length: line.length,
            spacing: line.spacing,
            rms_height: amplitude.map(|amplitude| amplitude.rms_height),
            rms_gradient: amplitude.map(|amplitude| amplitude.rms_gradient),
            modes: line.modes,
            seed: line.seed,
        }
    }
}

impl<'a> HistogramJson<'a> {
    fn new(histogram: &'a Histogram) -> Self {
        HistogramJson {
            low: histogram.low,
            high: histogram.high,
            counts: &histogram.counts,
        }
    }
}

/// Report on a force curve along which the user moved the body by hand in the explorer.
#[derive(Clone, Copy, Debug)]
pub struct PathReport<'a> {
    /// Scene of the body. The stages of the path take the place of the loading in this scene.
    pub scene: &'a Scene,
    /// Records of the stages of the path, beginning at separation.
    pub stages: &'a [StageRecord],
}

#[derive(Serialize)]
struct PathJson<'a> {
    scene: Scene,
    loading: Vec<Move>,
    curve: Option<Table<'a>>,
}

impl Report for PathReport<'_> {
    fn json(&self) -> Option<Box<dyn Json + '_>> {
        let loading: Vec<Move> = self.stages.iter().map(|record| record.target).collect();
        let scene = Scene {
            loading: loading.clone(),
            ..self.scene.clone()
        };
        Some(Box::new(PathJson {
            scene,
            loading,
            curve: self.table(),
        }))
    }

    fn table(&self) -> Option<Table<'_>> {
        Some(table_of_curve(self.stages, self.scene.loading_stiffness))
    }
}

/// Row of the table of a force curve.
struct CurveRow<'a> {
    /// Index of the loading stage.
    stage: u64,
    point: &'a CurvePoint,
    /// Displacement of the instrument in m.
    displacement: f64,
    /// Time in s since first touch; zero if time has no effect.
    seconds: f64,
}

/// Returns the table of a force curve in SI units. Each row has a point of the curve and the index
/// of its loading stage. `stiffness` is the stiffness of the instrument in N/m. If it is not
/// `None`, the table also has the displacement of the instrument. With relaxation the table also
/// has the time since first touch.
fn table_of_curve(stages: &[StageRecord], stiffness: Option<f64>) -> Table<'_> {
    let table = Table::of(move || curve_rows(stages, stiffness.unwrap_or(f64::INFINITY)))
        .whole("stage", |row| row.stage)
        .real("indentation", |row| row.point.indentation)
        .real("force", |row| row.point.force)
        .real("contact_length", |row| row.point.contact_length)
        .whole("patches", |row| row.point.patches)
        .real("stored_energy", |row| row.point.stored_energy);
    let has_time = stages.iter().any(|record| !record.seconds.is_empty());
    let table = if has_time {
        table.real("time", |row| row.seconds)
    } else {
        table
    };
    if stiffness.is_none() {
        return table.done();
    }
    table.real("displacement", |row| row.displacement).done()
}

/// Returns the time in s at each point of a stage. A stage in which the body keeps its place has
/// the time at the end of the stage before, `before`.
fn seconds_of(record: &StageRecord, before: f64) -> impl Iterator<Item = f64> {
    let rest = std::iter::repeat(before);
    record.seconds.iter().copied().chain(rest)
}

fn curve_rows(stages: &[StageRecord], stiffness: f64) -> impl Iterator<Item = CurveRow<'_>> {
    let mut reached = 0.0;
    stages.iter().zip(0_u64..).flat_map(move |(record, stage)| {
        let before = reached;
        reached = record.seconds.last().copied().unwrap_or(before);
        let points = record.curve.iter().zip(displacements(record, stiffness));
        let points = points.zip(seconds_of(record, before));
        points.map(move |((point, displacement), seconds)| CurveRow {
            stage,
            point,
            displacement,
            seconds,
        })
    })
}

/// Report on a profile. Its table has a row for each spring, with the position x and the height z
/// in m.
impl Report for Line {
    fn table(&self) -> Option<Table<'_>> {
        let table = Table::of(|| self.heights().enumerate())
            .real("x", |(spring, _)| self.position(*spring))
            .real("z", |(_, height)| *height);
        Some(table.done())
    }
}
