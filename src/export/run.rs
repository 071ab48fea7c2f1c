//! A computed scene: one JSON object, the force curve as a table and as a figure; and the table of a profile.

use super::loop_chart::force_figure;
use super::report::{Json, Report};
use super::summary::summary;
use crate::accuracy::{Choice, Estimate};
use crate::contact::CurvePoint;
use crate::draw::Figure;
use crate::io::{Table, object};
use crate::scene::{Move, Observer, Scene};
use crate::simulation::Outcome;
use crate::surface::Line;

/// Result of a scene.
#[derive(Clone, Copy, Debug)]
pub struct RunReport<'a> {
    /// Title of the figure.
    pub title: &'a str,
    /// The computed scene.
    pub scene: &'a Scene,
    /// Its outcome.
    pub outcome: &'a Outcome,
    /// Choice of springs for a tolerance, if one was given.
    pub choice: Option<&'a Choice>,
    /// Estimated error of the adhesion force, if it is known.
    pub estimate: Option<&'a Estimate>,
}

impl Report for RunReport<'_> {
    fn text(&self) -> Option<String> {
        Some(summary(self.scene, self.outcome, self.estimate, self.choice))
    }

    fn json(&self) -> Option<Box<dyn Json + '_>> {
        let RunReport { scene, outcome, choice, estimate, .. } = *self;
        let Outcome { line, governing, figures, history, .. } = outcome;
        let fragments = scene.observe.contains(&Observer::Fragments).then_some(outcome.fragments.as_slice());
        Some(Box::new(object! {
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
            "regime_after_zero_force": outcome.regime_after_zero_force,
            "ideal_adhesion_force": outcome.ideal_adhesion_force,
            "smooth_adhesion_force": outcome.smooth_adhesion_force,
            "zero_load_adhesion_force": outcome.zero_load_adhesion_force,
            "zero_force_adhesion_force": outcome.zero_force_adhesion_force,
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
            "curve": self.table(),
            "contacts": &history.contacts,
            "fragments": fragments,
            "histogram": outcome.histogram.as_ref().map(|histogram| object! {
                "low": histogram.low,
                "high": histogram.high,
                "counts": &histogram.counts,
            }),
            "work": history.work,
            "timings": outcome.timings,
        }))
    }

    fn table(&self) -> Option<Table<'_>> {
        let legs = || self.outcome.history.legs.iter().zip(0_u64..);
        Some(curve(move || {
            legs().flat_map(|(leg, number)| leg.curve.iter().map(move |point| (number, point)))
        }))
    }

    fn figure(&self) -> Option<Figure> {
        Some(force_figure(&[(self.title, self.outcome)]))
    }
}

/// The path of manual loading.
#[derive(Clone, Copy, Debug)]
pub struct PathReport<'a> {
    /// Its stages, from separation.
    pub loading: &'a [Move],
    /// Points of its curve.
    pub path: &'a [CurvePoint],
    /// Places of the stages of these points.
    pub stages: &'a [usize],
}

impl Report for PathReport<'_> {
    fn json(&self) -> Option<Box<dyn Json + '_>> {
        Some(Box::new(object! { "loading": self.loading, "curve": self.table() }))
    }

    fn table(&self) -> Option<Table<'_>> {
        Some(curve(|| self.stages.iter().map(|stage| *stage as u64).zip(self.path)))
    }
}

/// A force curve in SI units, its points with the numbers of their loading stages from 0.
fn curve<'a, I: Iterator<Item = (u64, &'a CurvePoint)> + 'a>(points: impl Fn() -> I + 'a) -> Table<'a> {
    Table::of(points)
        .whole("leg", |(number, _)| *number)
        .real("indentation", |(_, point)| point.indentation)
        .real("force", |(_, point)| point.force)
        .real("contact_length", |(_, point)| point.contact_length)
        .whole("fragments", |(_, point)| point.fragments)
        .real("stored_energy", |(_, point)| point.stored_energy)
        .done()
}

/// Position x and height z of every spring under the body, m.
impl Report for Line {
    fn table(&self) -> Option<Table<'_>> {
        let points = || self.heights().enumerate().map(|(index, height)| (self.position(index), height));
        Some(Table::of(points).real("x", |point| point.0).real("z", |point| point.1).done())
    }
}
