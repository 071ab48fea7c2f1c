//! Fit of the parameters of a scene to a measured curve, with the errors of the parameters. The fit
//! also finds the parameters that the curve cannot separate.

pub(crate) mod agreement;
pub(crate) mod descent;
mod drag;
pub(crate) mod ensemble;
mod evaluation;
mod further;
pub(crate) mod instrument;
pub(crate) mod lengths;
pub(crate) mod lines;
pub(crate) mod model;
pub(crate) mod parameter;
pub(crate) mod population;
pub(crate) mod posterior;
pub(crate) mod reason;
pub(crate) mod relaxation;
pub(crate) mod result;
pub(crate) mod scene;
pub(crate) mod search;
mod searched;
pub(crate) mod space;
pub(crate) mod start;
pub(crate) mod statistics;
#[cfg(test)]
mod tests;
mod together;
mod touch;
pub(crate) mod two_spheres;

use crate::curve::MeasuredCurve;
use crate::error::ExperimentError;
use crate::fit::drag::with_drag_of_model;
use crate::fit::evaluation::fit_result;
use crate::fit::parameter::{Free, Parameter};
use crate::fit::relaxation::notes_on_time;
use crate::fit::result::FitResult;
use crate::fit::scene::wrong;
use crate::fit::searched::search;
use crate::fit::space::Space;
use crate::fit::touch::{fixed_contact_point, touch_of_best};
use asperity_data::{Control, Note};
use asperity_scene::{Document, Simulation};
use asperity_surface::lines::MeasuredRoughness;
use std::sync::Arc;

/// Largest number of times that the ranges of the parameters are widened.
const EXTENSIONS: usize = 4;

/// A fit that finds free parameters of a scene, such as the work of adhesion, by comparison of the
/// computed force with a [`MeasuredCurve`].
///
/// ```
/// use asperity_data::Control;
/// use asperity_experiment::{CurveOptions, Fit, Free, MeasuredCurve, Parameter};
/// use asperity_scene::{Document, open, run};
///
/// // The computed curve of a sphere with a work of adhesion of 0.05 J/m², by a rigid instrument.
/// let scene = open("jkr-sphere")?.set("numerics.points", "256")?;
/// let stages = run(&scene)?.history.stages;
/// let points = stages.iter().flat_map(|stage| {
///     stage.curve
///         .iter()
///         .map(|point| (point.indentation, point.force))
/// });
/// let free = (0..100).map(|i| (1e-8 * f64::from(i - 100), 0.0));
/// let (displacement, force): (Vec<f64>, Vec<f64>) = free.chain(points).unzip();
/// let curve = MeasuredCurve::from_columns(
///     &displacement,
///     &force,
///     &CurveOptions {
///         noise: Some(1e-8),
///         ..CurveOptions::default()
///     },
/// )?;
///
/// let start = scene.set("adhesion.work", "0.03")?;
/// let fit = Fit::of(&start)
///     .free(Parameter::Work)
///     .free(Free::within(Parameter::Offset, (-1e-7, 1e-7))?);
/// let found = fit.run(&curve, Control::default())?;
/// assert!((found.parameters[0].value / 0.05 - 1.0).abs() < 0.01);
/// assert!(
///     Fit::of(&start).run(&curve, Control::default()).is_err(),
///     "no free parameter"
/// );
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Fit<'a> {
    document: &'a Document,
    free: Vec<Free>,
    /// Measured roughness in place of the files that the scene names.
    measured: Option<Arc<MeasuredRoughness>>,
}

impl<'a> Fit<'a> {
    /// Creates a fit of a scene without free parameters. [`Fit::free`] adds free parameters.
    pub fn of(document: &'a Document) -> Self {
        Fit {
            document,
            free: Vec::new(),
            measured: None,
        }
    }

    /// Gives the fit a measured roughness that replaces the files that the scene names.
    #[must_use]
    pub fn with_measured(mut self, measured: Arc<MeasuredRoughness>) -> Self {
        self.measured = Some(measured);
        self
    }

    /// Adds a parameter that the fit searches. [`Free::within`] gives the range of the search. If a
    /// [`Parameter`] is given without a range, the fit chooses the range.
    #[must_use]
    pub fn free(mut self, free: impl Into<Free>) -> Self {
        self.free.push(free.into());
        self
    }

    /// Returns a simulation of the scene.
    fn simulation(&self) -> Simulation {
        let simulation = Simulation::new(self.document.resolve(""));
        match &self.measured {
            Some(measured) => simulation.with_measured(Arc::clone(measured)),
            None => simulation,
        }
    }

    /// Fits the free parameters to a curve on one thread, by a sequential Monte Carlo method.
    /// `control` reports the number of force curves computed so far, and can stop the fit.
    ///
    /// # Errors
    /// Returns an error if no parameter is free, if a parameter is given twice, or if the scene
    /// lacks a free parameter, such as the radius of its form. It also returns an error if
    /// `numerics.solver` of the scene is `Stepwise`, if a relaxation is fitted and neither the
    /// scene nor the file states a speed, if the curve turns before contact, if a computation
    /// fails, or if `control` stops the fit.
    pub fn run(
        &self,
        curve: &MeasuredCurve,
        mut control: Control<'_>,
    ) -> Result<FitResult, ExperimentError> {
        let stop = control.stop();
        let mut simulation = self.simulation();
        let mut report = |computed| control.report(computed as u64);
        find(
            curve,
            self.document,
            &self.free,
            &mut simulation,
            stop,
            &mut report,
        )
    }
}

/// Fits the parameters `free` of the scene `given` to a curve. `report` receives the number of
/// force curves computed so far.
///
/// If the best value lies at the end of a range that the user did not give, the fit is repeated
/// with a wider range, at most [`EXTENSIONS`] times.
fn find(
    curve: &MeasuredCurve,
    given: &Document,
    free: &[Free],
    simulation: &mut Simulation,
    stop: &(dyn Fn() -> bool + Sync),
    report: &mut dyn FnMut(usize),
) -> Result<FitResult, ExperimentError> {
    let (_, instrument) = curve.with_instrument(given).map_err(wrong)?;
    let mut ranges = free.to_vec();
    let measured = curve;
    let with_drag = with_drag_of_model(measured, given, free, simulation, stop)?;
    let curve = with_drag.as_ref().map_or(measured, |found| &found.curve);
    let touch = touch_of_best(curve, given, free, simulation, stop)?;
    let mut computed = touch.map_or(0, |touch| touch.evaluations);
    computed += with_drag.as_ref().map_or(0, |found| found.evaluations);
    let mut extensions = 0;
    loop {
        let (document, mut space) = Space::of(curve, given, simulation, &ranges, stop)?;
        if let Some(touch) = touch {
            space.base[Parameter::Offset as usize] = touch.displacement;
        }
        let mut report_all = |evaluations: usize| report(computed + evaluations);
        let mut searched = search(curve, &document, simulation, &space, &mut report_all)?;
        computed += searched.evaluations;
        if extensions < EXTENSIONS
            && let Some(wider) = space.extended(&searched.result.best.place, free, &ranges)
        {
            ranges = wider;
            extensions += 1;
            continue;
        }
        searched.evaluations = computed;
        let mut result = fit_result(&document, simulation, &space, searched)?;
        // The drag may have been fitted again since the curve was read. The forces of the model are
        // changed by as much, so that they can be compared with the curve as it was read.
        for (index, force) in result.model.iter_mut().enumerate() {
            *force += measured.force[index] - curve.force[index];
        }
        if let Some(touch) = touch {
            result
                .assumptions
                .push(fixed_contact_point(curve, touch.displacement));
        }
        if space.relaxes() {
            result
                .assumptions
                .splice(..0, notes_on_time(curve, given.scene()));
        }
        result.assumptions.splice(..0, instrument.map(Note::new));
        return Ok(result);
    }
}
