//! A computed scene as one JSON object: SI units, numbers that are finite or null.

use crate::accuracy::{Choice, Estimate};
use crate::analysis::{ApproximateJkr, ApproximatePoint, Regime};
use crate::contact::Work;
use crate::io::write_json_value;
use crate::scene::{Observer, Scene};
use crate::simulation::{Outcome, Timings};
use serde::{Serialize, Serializer};
use std::io::{self, Write};

/// Writes the result of a scene: the scene with its defaults filled in, the choice of its springs where they were chosen
/// for a tolerance, and the estimated error of the adhesion force where there is one.
///
/// # Errors
/// Those of `out`.
pub fn write_json(
    out: &mut (impl Write + ?Sized),
    scene: &Scene,
    outcome: &Outcome,
    choice: Option<&Choice>,
    estimate: Option<&Estimate>,
) -> io::Result<()> {
    let mut report = Report::new(scene, outcome, choice);
    report.adhesion_force_error = estimate.and_then(|estimate| estimate.of_adhesion_force(outcome));
    write_json_value(out, &report)
}

/// The object, with its keys in the order of these fields.
#[derive(Serialize)]
struct Report<'a> {
    scene: &'a Scene,
    #[serde(skip_serializing_if = "Option::is_none")]
    choice: Option<&'a Choice>,
    line: LineReport,
    effective_modulus: f64,
    work_of_adhesion: Option<f64>,
    kappa: Option<f64>,
    elastic_energy: Option<f64>,
    elastic_energy_ratio: Option<f64>,
    regime: Option<Regime>,
    ideal_adhesion_force: Option<f64>,
    smooth_adhesion_force: Option<f64>,
    zero_load_adhesion_force: Option<f64>,
    preload: Option<f64>,
    preload_indentation: Option<f64>,
    adhesion_force: Option<f64>,
    adhesion_force_error: Option<f64>,
    adhesion_coefficient: Option<f64>,
    pull_off_indentation: Option<f64>,
    dissipated_energy: Option<f64>,
    tabor_number: Option<f64>,
    #[serde(serialize_with = "curve")]
    curve: &'a Outcome,
    contacts: &'a [(usize, usize)],
    /// Those of each leg, where they are observed.
    fragments: Option<&'a [Vec<(usize, usize)>]>,
    histogram: Option<HistogramReport<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    approximate_jkr: Option<ApproximateReport>,
    work: Work,
    timings: Timings,
}

#[derive(Serialize)]
struct LineReport {
    points: usize,
    length: f64,
    spacing: f64,
    rms_height: Option<f64>,
    rms_gradient: Option<f64>,
    modes: Option<(u64, u64)>,
    seed: Option<u64>,
}

#[derive(Serialize)]
struct HistogramReport<'a> {
    low: f64,
    high: f64,
    counts: &'a [u64],
}

#[derive(Serialize)]
struct ApproximateReport {
    adhesion_force: Option<f64>,
    pull_off_indentation: Option<f64>,
    curve: Vec<ApproximateRow>,
}

#[derive(Serialize)]
struct ApproximateRow {
    indentation: f64,
    force: f64,
    nonadhesive_indentation: f64,
    nonadhesive_force: f64,
    contact_length: f64,
    growing_length: Option<f64>,
}

impl From<&ApproximateJkr> for ApproximateReport {
    fn from(of: &ApproximateJkr) -> Self {
        let row = |point: &ApproximatePoint| ApproximateRow {
            indentation: point.indentation,
            force: point.force,
            nonadhesive_indentation: point.nonadhesive.indentation,
            nonadhesive_force: point.nonadhesive.force,
            contact_length: point.nonadhesive.contact_length,
            growing_length: point.nonadhesive.growing_length,
        };
        ApproximateReport {
            adhesion_force: of.adhesion_force(),
            pull_off_indentation: of.pull_off().map(|point| point.indentation),
            curve: of.points.iter().map(row).collect(),
        }
    }
}

#[derive(Serialize)]
struct CurveReport {
    leg: usize,
    indentation: f64,
    force: f64,
    contact_length: f64,
    fragments: u64,
}

impl<'a> Report<'a> {
    fn new(scene: &'a Scene, outcome: &'a Outcome, choice: Option<&'a Choice>) -> Report<'a> {
        let Outcome { line, governing, figures, history, .. } = outcome;
        let amplitude = governing.amplitude;
        Report {
            scene,
            choice,
            line: LineReport {
                points: line.points,
                length: line.length,
                spacing: line.spacing,
                rms_height: amplitude.map(|amplitude| amplitude.rms_height),
                rms_gradient: amplitude.map(|amplitude| amplitude.rms_gradient),
                modes: line.modes,
                seed: line.seed,
            },
            effective_modulus: governing.effective_modulus,
            work_of_adhesion: governing.work_of_adhesion,
            kappa: governing.kappa,
            elastic_energy: governing.elastic_energy(),
            elastic_energy_ratio: governing.elastic_energy_ratio,
            regime: outcome.regime,
            ideal_adhesion_force: outcome.ideal_adhesion_force,
            smooth_adhesion_force: outcome.smooth_adhesion_force,
            zero_load_adhesion_force: outcome.zero_load_adhesion_force,
            preload: figures.preload,
            preload_indentation: figures.preload_indentation,
            adhesion_force: figures.adhesion_force,
            adhesion_force_error: None,
            adhesion_coefficient: figures.adhesion_coefficient,
            pull_off_indentation: figures.pull_off_indentation,
            dissipated_energy: figures.dissipated_energy,
            tabor_number: outcome.tabor_number,
            curve: outcome,
            contacts: &history.contacts,
            fragments: scene.observe.contains(&Observer::Fragments).then_some(outcome.fragments.as_slice()),
            histogram: outcome.histogram.as_ref().map(|histogram| HistogramReport {
                low: histogram.low,
                high: histogram.high,
                counts: &histogram.counts,
            }),
            approximate_jkr: outcome.approximate_jkr.as_ref().map(ApproximateReport::from),
            work: history.work,
            timings: outcome.timings,
        }
    }
}

/// The points of all legs, one after the other, without a copy of them all.
fn curve<S: Serializer>(outcome: &&Outcome, serializer: S) -> Result<S::Ok, S::Error> {
    let legs = outcome.history.legs.iter().enumerate();
    serializer.collect_seq(legs.flat_map(|(leg, record)| {
        record.curve.iter().map(move |point| CurveReport {
            leg,
            indentation: point.indentation,
            force: point.force,
            contact_length: point.contact_length,
            fragments: point.fragments,
        })
    }))
}
