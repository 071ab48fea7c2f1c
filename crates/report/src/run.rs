//! A computed scene as JSON, its force curve as a table and a figure, and the table of a profile.

use crate::ensemble::{caption, ensemble_value};
use crate::loop_chart::{LoopUnits, force_figure};
use crate::report::{Json, Report};
use crate::summary::summary;
use crate::warnings::warning_texts;
use asperity_contact::{CurvePoint, Move};
use asperity_data::{Table, TableOf, Warning, object};
use asperity_plot::Figure;
use asperity_scene::discretisation::Choice;
use asperity_scene::instrument::displacements;
use asperity_scene::{Estimate, Observer, Outcome, Scene};
use asperity_study::Ensemble;
use asperity_study::trust::{Budget, criteria};
use asperity_surface::lines::Line;

/// Report on all results of one computed scene, such as its force curve and adhesion force.
#[derive(Clone, Copy, Debug)]
pub struct RunReport<'a> {
    /// Title of the scene.
    pub title: &'a str,
    /// Scene that was computed.
    pub scene: &'a Scene,
    /// Results on the profile of the scene.
    pub outcome: &'a Outcome,
    /// How the number of springs was chosen so that the error is within a tolerance; `None` if no
    /// tolerance was given.
    pub choice: Option<&'a Choice>,
    /// Estimated error of the adhesion force due to the finite number of springs; `None` if it is
    /// unknown.
    pub estimate: Option<&'a Estimate>,
    /// Results on several random profiles of the same roughness; `None` if they were not computed.
    pub ensemble: Option<&'a Ensemble>,
    /// Standard deviation of the adhesion force due to errors of a measured spectrum, in N; `None`
    /// if it was not computed.
    pub deviation: Option<f64>,
}

impl RunReport<'_> {
    /// Returns the estimate of the error; `None` if a premise does not hold, so that no error is
    /// known.
    fn known_estimate(&self) -> Option<&Estimate> {
        let is_known = !self
            .outcome
            .warnings
            .iter()
            .any(Warning::leaves_errors_unknown);
        self.estimate.filter(|_| is_known)
    }
}

impl Report for RunReport<'_> {
    fn text(&self) -> Option<String> {
        Some(summary(
            self.scene,
            self.outcome,
            self.known_estimate(),
            self.choice,
            self.ensemble,
            self.deviation,
        ))
    }

    fn json(&self) -> Option<Box<dyn Json + '_>> {
        let RunReport {
            scene,
            outcome,
            choice,
            ensemble,
            ..
        } = *self;
        let estimate = self.known_estimate();
        let Outcome {
            line,
            governing,
            figures,
            history,
            ..
        } = outcome;
        let fragments = scene
            .observe
            .contains(&Observer::Fragments)
            .then_some(outcome.fragments.as_slice());
        Some(Box::new(object! {
            "scene": scene,
            "choice"?: choice,
            "ensemble": ensemble.map(ensemble_value),
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
            "first_touch_adhesion_force": outcome.first_touch_adhesion_force,
            "zero_force_adhesion_force": outcome.zero_force_adhesion_force,
            "preload": figures.preload,
            "preload_indentation": figures.preload_indentation,
            "adhesion_force": figures.adhesion_force,
            "adhesion_force_error": estimate.and_then(|estimate| estimate.of_adhesion_force(outcome)),
            "curve_error"?: estimate.and_then(Estimate::of_curve),
            "adhesion_force_near_step": estimate.map(|estimate| estimate.near_step),
            "adhesion_share": outcome.adhesion_share(),
            "adhesion_coefficient": figures.adhesion_coefficient,
            "pull_off_indentation": figures.pull_off_indentation,
            "dissipated_energy": figures.dissipated_energy,
            "loop_area"?: outcome.instrument.map(|one| one.loop_area),
            "pull_off_displacement"?: outcome.instrument.map(|one| one.pull_off_displacement),
            "tabor_number": outcome.tabor_number,
            "steep_waves"?: outcome.steep_waves,
            "criteria": criteria(scene, outcome, ensemble),
            "budget": Budget::of(outcome, estimate, ensemble, self.deviation),
            "warnings": warning_texts(&outcome.warnings),
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
        let stiffness = self
            .outcome
            .instrument
            .map(|instrument| instrument.stiffness);
        let legs = || self.outcome.history.legs.iter().zip(0_u64..);
        let table = curve(move || {
            legs().flat_map(move |(leg, number)| {
                let displacements = displacements(leg, stiffness.unwrap_or(f64::INFINITY));
                leg.curve
                    .iter()
                    .zip(displacements)
                    .map(move |(point, at)| (number, point, at))
            })
        });
        Some(match stiffness {
            Some(_) => table
                .real("displacement", |(.., displacement)| *displacement)
                .done(),
            None => table.done(),
        })
    }

    fn figure(&self) -> Option<Figure> {
        let figure = force_figure(&[(self.title, self.outcome)], LoopUnits::default());
        Some(Figure {
            notes: self.ensemble.and_then(caption).into_iter().collect(),
            ..figure
        })
    }
}

/// Report on a force curve along which the user moved the body by hand in the explorer.
#[derive(Clone, Copy, Debug)]
pub struct PathReport<'a> {
    /// Scene of the body. The loading in the scene is replaced by [`Self::loading`].
    pub scene: &'a Scene,
    /// Stages of the loading, which begins at separation.
    pub loading: &'a [Move],
    /// Points of the force curve along the stages of [`Self::loading`].
    pub path: &'a [CurvePoint],
    /// For each point, the index of its stage in `loading`.
    pub stages: &'a [usize],
}

impl Report for PathReport<'_> {
    fn json(&self) -> Option<Box<dyn Json + '_>> {
        let scene = Scene {
            loading: self.loading.to_vec(),
            ..self.scene.clone()
        };
        Some(Box::new(
            object! { "scene": scene, "loading": self.loading, "curve": self.table() },
        ))
    }

    fn table(&self) -> Option<Table<'_>> {
        let points = || self.stages.iter().zip(self.path);
        Some(
            curve(move || points().map(|(stage, point)| (*stage as u64, point, point.indentation)))
                .done(),
        )
    }
}

/// Returns the table of a force curve in SI units: points, index of the loading stage of each
/// point, and displacement of the instrument.
fn curve<'a, I: Iterator<Item = CurveRow<'a>> + 'a>(
    rows: impl Fn() -> I + 'a,
) -> TableOf<'a, CurveRow<'a>> {
    Table::of(rows)
        .whole("leg", |(number, ..)| *number)
        .real("indentation", |(_, point, _)| point.indentation)
        .real("force", |(_, point, _)| point.force)
        .real("contact_length", |(_, point, _)| point.contact_length)
        .whole("fragments", |(_, point, _)| point.fragments)
        .real("stored_energy", |(_, point, _)| point.stored_energy)
}

/// Index of a loading stage, a point of its curve, and the displacement of the instrument in m.
type CurveRow<'a> = (u64, &'a CurvePoint, f64);

/// A profile can be written as a table: a row has the position x and the height z of a spring in m.
impl Report for Line {
    fn table(&self) -> Option<Table<'_>> {
        let points = || {
            self.heights()
                .enumerate()
                .map(|(index, height)| (self.position(index), height))
        };
        Some(
            Table::of(points)
                .real("x", |point| point.0)
                .real("z", |point| point.1)
                .done(),
        )
    }
}
