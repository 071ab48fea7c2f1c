//! A computed scene as one JSON object: SI units, numbers that are finite or null.

use super::scene_tables::{CURVE, curve};
use super::table::Record;
use crate::accuracy::{Choice, Estimate};
use crate::io::{object, write_json_value};
use crate::scene::{Observer, Scene};
use crate::simulation::Outcome;
use serde::{Serialize, Serializer};
use std::io::{self, Write};

/// Writes the result of a scene: the scene including its defaults, the choice of its springs for a tolerance, and
/// the estimated error of the adhesion force, if there are such.
///
/// # Errors
/// Errors of `out`.
pub fn write_json(
    out: &mut (impl Write + ?Sized),
    scene: &Scene,
    outcome: &Outcome,
    choice: Option<&Choice>,
    estimate: Option<&Estimate>,
) -> io::Result<()> {
    let Outcome { line, governing, figures, history, .. } = outcome;
    let fragments = scene.observe.contains(&Observer::Fragments).then_some(outcome.fragments.as_slice());
    let report = object! {
        "scene": scene,
        "choice"?: choice,
        "line": object! {
            "points": line.points,
            "length": line.length,
            "spacing": line.spacing,
            "rms_height": governing.amplitude.map(|amplitude| amplitude.rms_height),
            "rms_gradient": governing.amplitude.map(|amplitude| amplitude.rms_gradient),
            "modes": line.modes,
            "seed": line.seed,
        },
        "effective_modulus": governing.effective_modulus,
        "work_of_adhesion": governing.work_of_adhesion,
        "kappa": governing.kappa,
        "elastic_energy": governing.elastic_energy(),
        "elastic_energy_ratio": governing.elastic_energy_ratio,
        "regime": outcome.regime,
        "ideal_adhesion_force": outcome.ideal_adhesion_force,
        "smooth_adhesion_force": outcome.smooth_adhesion_force,
        "zero_load_adhesion_force": outcome.zero_load_adhesion_force,
        "preload": figures.preload,
        "preload_indentation": figures.preload_indentation,
        "adhesion_force": figures.adhesion_force,
        "adhesion_force_error": estimate.and_then(|estimate| estimate.of_adhesion_force(outcome)),
        "adhesion_force_near_step": estimate.map(|estimate| estimate.near_step),
        "adhesion_coefficient": figures.adhesion_coefficient,
        "pull_off_indentation": figures.pull_off_indentation,
        "dissipated_energy": figures.dissipated_energy,
        "tabor_number": outcome.tabor_number,
        "steep_waves"?: outcome.steep_waves,
        "curve": Curve(outcome),
        "contacts": &history.contacts,
        "fragments": fragments,
        "histogram": outcome.histogram.as_ref().map(|histogram| object! {
            "low": histogram.low,
            "high": histogram.high,
            "counts": &histogram.counts,
        }),
        "work": history.work,
        "timings": outcome.timings,
    };
    write_json_value(out, &report)
}

/// The points of all loading stages in sequence, without a copy of them.
struct Curve<'a>(&'a Outcome);

impl Serialize for Curve<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(curve(self.0).map(|point| Record(CURVE, point)))
    }
}
