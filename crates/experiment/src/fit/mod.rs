//! Fit of the parameters of a scene to a measured curve, with the errors of the parameters. The fit
//! also finds the parameters that the curve cannot separate.

pub(crate) mod agreement;
pub(crate) mod descent;
pub(crate) mod ensemble;
pub(crate) mod instrument;
pub(crate) mod lengths;
pub(crate) mod lines;
pub(crate) mod model;
pub(crate) mod parameter;
pub(crate) mod population;
pub(crate) mod posterior;
pub(crate) mod reason;
pub(crate) mod result;
pub(crate) mod scene;
pub(crate) mod search;
pub(crate) mod space;
pub(crate) mod start;
pub(crate) mod statistics;
pub(crate) mod two_spheres;

use crate::curve::MeasuredCurve;
use crate::error::ExperimentError;
use crate::fit::agreement::{Compared, MISFIT};
use crate::fit::instrument::FittedStiffness;
use crate::fit::model::Model;
use crate::fit::parameter::{Free, Parameter};
use crate::fit::population::WRONG_SIDE;
use crate::fit::posterior::Posterior;
use crate::fit::reason::{Reason, reason, steeper_slope};
use crate::fit::result::{FitResult, FittedParameter, RangeEnd};
use crate::fit::scene::{with_values, wrong};
use crate::fit::search::{Search, SearchResult};
use crate::fit::space::Space;
use crate::fit::statistics::scale;
use asperity_data::{Control, Note, Remedy, format_rounded};
use asperity_scene::{CheckedScene, Document, Simulation};
use asperity_surface::lines::MeasuredRoughness;
use std::f64::consts::PI;
use std::sync::Arc;

/// Number of points that a search uses if the residuals exceed the noise. More points would not
/// reduce the residuals.
const ENOUGH: usize = 400;
/// Largest number of times that the ranges of the parameters are widened.
const EXTENSIONS: usize = 4;
/// Allowance for noise, in standard deviations, in the bound of the work of adhesion that follows
/// from the pull-off force.
const ALLOWED_NOISE: f64 = 3.0;

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
/// let legs = run(&scene)?.history.legs;
/// let points = legs.iter().flat_map(|leg| {
///     leg.curve
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

    /// Fits the free parameters to a curve on one thread, by a sequential Monte Carlo method.
    /// `control` reports the number of force curves computed so far, and can stop the fit.
    ///
    /// # Errors
    /// Returns an error if no parameter is free, if a parameter is given twice, or if the scene
    /// lacks a free parameter, such as the radius of its form. It also returns an error if
    /// `numerics.solver` of the scene is `Stepwise`, if the curve turns before contact, if a
    /// computation fails, or if `control` stops the fit.
    pub fn run(
        &self,
        curve: &MeasuredCurve,
        mut control: Control<'_>,
    ) -> Result<FitResult, ExperimentError> {
        let stop = control.stop();
        let mut simulation = Simulation::new(self.document.resolve(""));
        if let Some(measured) = &self.measured {
            simulation = simulation.with_measured(Arc::clone(measured));
        }
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

/// Fits parameters of a scene to a curve. `report` receives the number of curves computed so far.
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
    let touch = touch_of_best(curve, given, free, simulation, stop)?;
    let mut computed = touch.map_or(0, |touch| touch.evaluations);
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
        let mut result = result(&document, simulation, &space, searched)?;
        if let Some(touch) = touch {
            result
                .assumptions
                .push(fixed_contact_point(curve, touch.displacement));
        }
        result.assumptions.splice(..0, instrument.map(Note::new));
        return Ok(result);
    }
}

/// Creates the result of the fit from the result of a search.
fn result(
    document: &Document,
    simulation: &mut Simulation,
    space: &Space<'_>,
    searched: Searched,
) -> Result<FitResult, ExperimentError> {
    let curve = space.curve;
    let free = space.parameters();
    let has_other_profile = searched.misfit > MISFIT && document.scene().seed().is_some();
    let posterior = Posterior::new(space, &searched.result, has_other_profile);
    let best = &posterior.best;
    let is_free = |parameter| free.contains(&parameter);
    let fitted = with_values(document, best, is_free, curve)?;
    let scene = fitted.scene();
    let slope = steeper_slope(curve, best, &free);
    let mut parameters = posterior.parameters();
    let most_work = most_work_by_pull_off(curve, scene);
    limit_parameters(&mut parameters, most_work, slope.is_some());
    let work_at_most = posterior.work_at_most(&parameters);
    let tabor = match work_at_most {
        Some(_) => None,
        None => tabor_number(scene, simulation)?,
    };
    let stiffness = FittedStiffness {
        curve,
        values: best,
        free: &free,
        stated: document.scene().loading_stiffness,
    };
    let far_from_stated = stiffness.far_from_stated();
    let assumptions = match far_from_stated {
        Some(_) => Vec::new(),
        None => stiffness.sentences(&simulation.contact(scene)?.0)?,
    };
    let line_remains = curve.remaining[..2].iter().any(|change| *change != 0.0);
    let reason_of_misfit = match slope {
        Some(slope) => {
            let stiffness = best[Parameter::Stiffness as usize];
            Some(Reason::Stiffness(slope, stiffness))
        }
        None if far_from_stated.is_some() => far_from_stated,
        None if searched.misfit > MISFIT || line_remains => {
            let residuals = &searched.residuals;
            Some(reason(
                curve, scene, simulation, best, residuals, &free, tabor,
            )?)
        }
        None => None,
    };
    let comparison = searched.compared(curve).comparison();
    let has_reason = reason_of_misfit.is_some();
    let grade = comparison.agreement.grade(searched.misfit, has_reason);
    Ok(FitResult {
        work_at_most,
        parameters,
        residual: comparison.agreement.residual,
        misfit: searched.misfit,
        residual_over_noise: comparison.residual_over_noise,
        beyond_five_sigma: comparison.beyond_five_sigma,
        grade,
        agreement: comparison.agreement,
        tabor,
        reason: reason_of_misfit,
        warnings: simulation.compute(scene)?.warnings,
        correlations: posterior.correlations(),
        not_distinguished: posterior.not_distinguished(),
        assumptions,
        evaluations: searched.evaluations,
        model: searched.model_forces(curve),
        document: fitted,
    })
}

/// Returns the largest work of adhesion in J/m² that agrees with the largest tension of the curve,
/// for a smooth sphere (Johnson, Kendall and Roberts). The tension gets an allowance for the noise
/// and for the difference to the previous point. Returns `None` for another body, and for a curve
/// that does not show the pull-off.
fn most_work_by_pull_off(curve: &MeasuredCurve, scene: &CheckedScene) -> Option<f64> {
    let radius = scene.form.as_ref()?.sphere_radius()?;
    if scene.roughness.is_some() || !curve.detaches {
        return None;
    }
    let is_pulled = |index: &usize| curve.segment[*index] % 2 == 1;
    let lowest = (0..curve.force.len())
        .filter(is_pulled)
        .min_by(|index, next| curve.force[*index].total_cmp(&curve.force[*next]))?;
    let tension = -curve.force[lowest];
    let before = curve.force[lowest.saturating_sub(1)];
    let tension = tension.max(0.0) + (before + tension).abs() + ALLOWED_NOISE * curve.noise;
    Some(tension / (1.5 * PI * radius))
}

/// Returns the Tabor number of a scene. That of a curve without adhesion is one of the noise.
fn tabor_number(
    scene: &CheckedScene,
    simulation: &mut Simulation,
) -> Result<Option<f64>, ExperimentError> {
    let (_, governing) = simulation.contact(scene)?;
    Ok(governing.tabor_number(scene))
}

/// Limits the work of adhesion by what the pull-off allows, and states only a bound of the modulus
/// if the loading is steeper than the instrument.
fn limit_parameters(parameters: &mut [FittedParameter], most_work: Option<f64>, is_steep: bool) {
    for fitted in parameters {
        match fitted.parameter {
            Parameter::Work => limit_work(fitted, most_work),
            Parameter::Modulus if is_steep => fitted.set_at_end(RangeEnd::High),
            _ => {}
        }
    }
}

/// Limits the interval of the work of adhesion by what the pull-off allows.
fn limit_work(work: &mut FittedParameter, most: Option<f64>) {
    let Some(most) = most else {
        return;
    };
    if work.interval.1 > most && work.value <= most {
        work.interval.1 = most;
        work.noise_error = work.noise_error.min(most - work.interval.0);
    }
}

/// Returns the sentence on the first touch, if a fit does not search the offset. A displacement
/// that is off by half the distance of two points shifts the modulus by more than its interval if
/// the noise is small.
fn fixed_contact_point(curve: &MeasuredCurve, touch: f64) -> Note {
    let mut next = f64::INFINITY;
    for displacement in &curve.displacement {
        next = next.min((displacement - touch).abs());
    }
    let contact_point = format_rounded(touch, 3, "m");
    let next = format_rounded(next, 3, "m");
    let text = format!(
        "First touch was taken at {contact_point}, where it is best for the curve, and the nearest point is {next} away. The \
         offset was not fitted, so the intervals leave out this uncertainty."
    );
    Note::new(text).with(Remedy::Free(Parameter::Offset.name().to_owned()))
}

/// First touch of a fit that does not search it.
#[derive(Clone, Copy)]
struct Touch {
    /// Displacement, m.
    displacement: f64,
    /// Number of curves computed to find it.
    evaluations: usize,
}

/// Returns the displacement of first touch that is best for a curve together with the free
/// parameters; `None` if the offset is one of them. The touch that the curve shows by itself may be
/// off by the distance of two points, or by more if its contact is weak, and a work of adhesion for
/// a wrong touch is far from the true one.
fn touch_of_best(
    curve: &MeasuredCurve,
    document: &Document,
    free: &[Free],
    simulation: &mut Simulation,
    stop: &(dyn Fn() -> bool + Sync),
) -> Result<Option<Touch>, ExperimentError> {
    if free.is_empty() || free.iter().any(|free| free.parameter == Parameter::Offset) {
        return Ok(None);
    }
    let part = curve.thinned(ENOUGH);
    let curve = part.as_ref().unwrap_or(curve);
    let mut with_offset = free.to_vec();
    with_offset.push(Parameter::Offset.into());
    let (document, space) = Space::of(curve, document, simulation, &with_offset, stop)?;
    let mut search = Search {
        space: &space,
        model: Model::new(curve, document.scene(), simulation),
        report: &mut |_| {},
        lines: space.lines(),
    };
    let best = search.descended()?;
    Ok(Some(Touch {
        displacement: space.values(&best.place)[Parameter::Offset as usize],
        evaluations: search.model.evaluations,
    }))
}

/// Result of a search, compared with all points of the curve.
struct Searched {
    result: SearchResult,
    /// Residuals of all points of the curve, in units of the noise.
    residuals: Vec<f64>,
    /// True for each point at which the body is in contact in the measurement or in the model.
    in_contact: Vec<bool>,
    /// Distance in m from the jump of the model, for each point on the wrong side of a jump; `None`
    /// for other points.
    distances_from_jumps: Vec<Option<f64>>,
    /// [`FitResult::misfit`] of the residuals.
    misfit: f64,
    /// Number of force curves that the search has computed.
    evaluations: usize,
}

impl Searched {
    fn compared<'a>(&'a self, curve: &'a MeasuredCurve) -> Compared<'a> {
        Compared {
            curve,
            residuals: &self.residuals,
            in_contact: &self.in_contact,
            distances_from_jumps: &self.distances_from_jumps,
        }
    }

    /// Returns the forces of the model in N at the points of the curve.
    fn model_forces(&self, curve: &MeasuredCurve) -> Vec<f64> {
        curve
            .force
            .iter()
            .zip(&self.residuals)
            .map(|(measured, residual)| measured - residual * curve.noise)
            .collect()
    }
}

/// Searches the parameters. A first search uses a part of the points. If its residuals exceed the
/// noise, the result comes from this part alone, because further points would not reduce the
/// residuals.
fn search(
    curve: &MeasuredCurve,
    document: &Document,
    simulation: &mut Simulation,
    space: &Space<'_>,
    report: &mut dyn FnMut(usize),
) -> Result<Searched, ExperimentError> {
    let of_part = search_part(curve, document, simulation, space, report)?;
    let mut report_all = |evaluations: usize| report(of_part.evaluations + evaluations);
    let mut search = Search {
        space,
        model: Model::new(curve, document.scene(), simulation),
        report: &mut report_all,
        lines: space.lines(),
    };
    let result = match of_part.result {
        Some(result) => result,
        None => search.find()?,
    };
    let mut searched = compared_with_all(&mut search, result)?;
    searched.evaluations += of_part.evaluations;
    Ok(searched)
}

/// Search by a part of the points.
struct SearchOfPart {
    /// `None` if the residuals are noise, so that the search needs all points.
    result: Option<SearchResult>,
    /// Number of curves computed.
    evaluations: usize,
}

/// Searches the parameters by a part of many points. If the residuals are more than noise, further
/// points would not reduce them.
fn search_part(
    curve: &MeasuredCurve,
    document: &Document,
    simulation: &mut Simulation,
    space: &Space<'_>,
    report: &mut dyn FnMut(usize),
) -> Result<SearchOfPart, ExperimentError> {
    let Some(part) = curve.thinned(ENOUGH) else {
        return Ok(SearchOfPart {
            result: None,
            evaluations: 0,
        });
    };
    let space = Space {
        curve: &part,
        ..space.clone()
    };
    let mut search = Search {
        space: &space,
        model: Model::new(&part, document.scene(), simulation),
        report,
        lines: space.lines(),
    };
    let (population, generator) = search.first()?;
    let result = if search.is_systematic(&population) {
        Some(search.find_from(population, generator)?)
    } else {
        None
    };
    Ok(SearchOfPart {
        result,
        evaluations: search.model.evaluations,
    })
}

/// Compares the best values of a search with all points of its curve.
fn compared_with_all(
    search: &mut Search<'_>,
    result: SearchResult,
) -> Result<Searched, ExperimentError> {
    let curve = search.space.curve;
    let best = search.exact(&result.best.place)?;
    let residuals = search.lines.refined(&best.residuals, result.noise);
    let beyond_jumps = search.beyond_jumps(&best.place, &residuals)?;
    let misfit = scale(&best.contact_residuals(&beyond_jumps), WRONG_SIDE);
    let in_newtons: Vec<f64> = residuals
        .iter()
        .map(|residual| residual * curve.noise)
        .collect();
    let values = search.space.values(&best.place);
    let least_jump = WRONG_SIDE * curve.noise;
    let distances_from_jumps =
        search
            .model
            .distances_from_jumps(&values, &in_newtons, least_jump)?;
    Ok(Searched {
        residuals,
        in_contact: best.in_contact,
        distances_from_jumps,
        misfit,
        evaluations: search.model.evaluations,
        result,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::common::{
        Made, fit_from, fitted, gauss, measured, on_rubber, random, read, rubber, rubber_of, truth,
    };
    use crate::curve::numerics::dot;
    use crate::read::options::Drift;
    use asperity_contact::Move;

    /// Asserts that the values differ from the truth by at most a few standard errors, and that the
    /// residuals are as large as the noise.
    fn assert_found(made: &Made, fit: &FitResult) {
        assert!(fit.describes() && fit.misfit < 1.1, "{}", fit.misfit);
        for one in &fit.parameters {
            let truth = truth(made, one.parameter);
            assert!(
                (one.value - truth).abs() < 4.0 * one.noise_error,
                "{one:?}: {truth:e}"
            );
            assert!(one.noise_error < 0.02 * truth, "{one:?}");
        }
    }

    /// The fit to the curve of a rough sphere, whose force jumps at many displacements, finds the
    /// parameters within their errors.
    #[test]
    fn a_rough_sphere_is_found_within_its_errors() {
        let made = random(13, 1024);
        let curve = measured(&made, 13);
        assert_found(&made, &fitted(&curve, &made, "work,offset"));
    }

    #[test]
    fn a_sphere_is_found_within_its_errors_and_written_into_its_scene() {
        let made = random(4, 512);
        let curve = measured(&made, 4);
        let fit = fitted(&curve, &made, "work,modulus,offset");
        assert_found(&made, &fit);
        // The difference between the forces of the curve and of the model, which include zero and
        // drift, is the residual.
        let in_contact = curve.in_contact();
        let squares = curve
            .force
            .iter()
            .zip(&fit.model)
            .zip(&in_contact)
            .filter(|(_, touches)| **touches)
            .map(|((force, model), _)| (force - model).powi(2));
        let residual = (squares.sum::<f64>() / fit.agreement.points as f64).sqrt();
        assert!(
            (residual / fit.residual - 1.0).abs() < 1e-9,
            "{residual} {}",
            fit.residual
        );
        assert!((fit.residual / curve.noise / fit.residual_over_noise - 1.0).abs() < 1e-9);
        let work = fit.parameters[0].value;
        assert_eq!(serde_json::json!(fit)["parameters"]["work"]["value"], work);
        let scene = fit.document.scene();
        assert_eq!(scene.adhesion.unwrap().work(), Some(work));
        assert!(
            matches!(scene.loading[..], [Move::ToDisplacement(at), Move::ToSeparation] if at > 0.0)
        );
    }

    /// The contact point lies between two points. If the offset is not fitted, its error shifts the
    /// modulus beyond its interval, and a sentence says so.
    #[test]
    fn an_offset_that_is_not_fitted_is_named() {
        let made = random(4, 512);
        let curve = measured(&made, 4);
        let [fixed, free] =
            ["work,modulus", "work,modulus,offset"].map(|free| fitted(&curve, &made, free));
        let truth = truth(&made, Parameter::Modulus);
        let holds = |fit: &FitResult| {
            let (low, high) = fit.parameters[1].interval;
            (low..=high).contains(&truth)
        };
        assert!(holds(&free), "{truth:e} {:?}", free.parameters);
        let width = |fit: &FitResult| {
            let (low, high) = fit.parameters[1].interval;
            (high - low) / truth
        };
        assert!(width(&fixed) < 0.9 * width(&free));
        let value = fixed.parameters[1].value;
        assert!((value / truth - 1.0).abs() < width(&free), "{value:e}");
        let of_offset = |fit: &FitResult| {
            let mut remedies = fit.assumptions.iter().flat_map(Note::remedies);
            remedies.any(|remedy| *remedy == Remedy::Free("offset".to_owned()))
        };
        assert!(
            of_offset(&fixed) && !of_offset(&free),
            "{:?}",
            fixed.assumptions
        );
    }

    /// A point in the middle of the jump at pull-off changes neither the fit nor the number of
    /// computed curves. Points elsewhere that are as far from the model increase the misfit.
    #[test]
    fn a_point_inside_a_jump_counts_as_described() {
        let made = random(4, 512);
        let curve = measured(&made, 4);
        let clean = fitted(&curve, &made, "work,modulus,offset");
        let rise = |index: &usize| curve.force[*index] - curve.force[index - 1];
        let retraction = curve.segment.partition_point(|segment| *segment == 0) + 1;
        let jump = (retraction..1000)
            .max_by(|one, other| rise(one).total_cmp(&rise(other)))
            .unwrap();
        let half = 0.5 * rise(&jump);
        assert!(half > 10.0 * curve.noise, "{half:e} {:e}", curve.noise);
        let with = |points: &[usize]| {
            let mut curve = curve.clone();
            points.iter().for_each(|index| curve.force[*index] -= half);
            fitted(&curve, &made, "work,modulus,offset")
        };
        let inside = with(&[jump]);
        assert!(
            inside.describes() && inside.misfit < 1.02 * clean.misfit,
            "{} {}",
            inside.misfit,
            clean.misfit
        );
        assert!(
            inside.evaluations < clean.evaluations * 5 / 4,
            "{} {}",
            inside.evaluations,
            clean.evaluations
        );
        let mut before = curve.clone();
        before.force[jump - 1] += half;
        let before = fitted(&before, &made, "work,modulus,offset").agreement;
        let residual = clean.agreement.residual;
        assert!(
            before.at_jumps > 0.0 && before.residual < 1.05 * residual,
            "{before:?} {residual:e}"
        );
        let apart: Vec<usize> = (1..11).map(|step| jump - 10 * step).collect();
        assert!(with(&apart).misfit > 1.2 * clean.misfit);
    }

    /// The rough sphere has a pull-off force 50 times smaller than that of a smooth sphere.
    #[test]
    fn a_range_that_ends_below_the_work_of_adhesion_is_extended() {
        let made = random(67, 4096);
        let curve = measured(&made, 67);
        let fit = fitted(&curve, &made, "work,offset");
        let (work, truth) = (fit.parameters[0], truth(&made, Parameter::Work));
        assert!(
            truth > 31.0 * work.start && work.range.1 > 800.0 * work.start,
            "{work:?}"
        );
        let width = work.interval.1 - work.interval.0;
        assert!(
            fit.describes() && (work.value - truth).abs() < width,
            "{work:?} {truth:e}"
        );
        assert!(
            (work.value / truth - 1.0).abs() < 0.02,
            "{work:?} {truth:e}"
        );
        let Free { parameter, .. } = "work".parse().unwrap();
        let given = [
            Free {
                parameter,
                range: Some((0.0, 30.0 * work.start)),
            },
            "offset".parse().unwrap(),
        ];
        let document = Document::from_scene(&made.scene, "made").unwrap();
        let bounded = find(
            &curve,
            &document,
            &given,
            &mut Simulation::default(),
            &|| false,
            &mut |_| (),
        )
        .unwrap();
        assert_eq!(bounded.parameters[0].range, given[0].range.unwrap());
    }

    /// The profile of the specimen is not the random profile of the scene. Then no interval
    /// excludes the true value, and the reason of the misfit names the profile.
    #[test]
    fn another_random_profile_has_the_whole_range_as_interval() {
        let mut made = random(13, 1024);
        let curve = measured(&made, 13);
        made.scene.set_seed(99);
        let fit = fitted(&curve, &made, "work,modulus,offset");
        assert!(
            fit.has_other_profile() && fit.reason == Some(Reason::OtherProfile),
            "{:?}",
            fit.reason
        );
        for one in &fit.parameters[..2] {
            assert_eq!(one.interval, one.range);
            let truth = truth(&made, one.parameter);
            assert!(one.interval.0 < truth && truth < one.interval.1, "{one:?}");
        }
    }

    /// For any initial work of adhesion, the upper bound is at most a few times the work of
    /// adhesion whose pull-off force equals the noise, γ = noise/(1.5 π R) = 1.1 mJ/m².
    #[test]
    fn a_curve_without_adhesion_has_an_upper_bound_of_it() {
        for (seed, work) in [(1, 0.05), (2, 1e-6)] {
            let curve = read(rubber(4e-8, seed, |_, _| 1.0).into_iter(), Drift::Keep);
            let fit = fit_from(&curve, &on_rubber(work, 2.7e6), "work,modulus,offset");
            let [work, modulus, _] = fit.parameters[..] else {
                panic!("{:?}", fit.parameters)
            };
            assert!(fit.describes() && work.interval.0 == 0.0, "{fit:?}");
            assert!((2e-4..5e-3).contains(&work.interval.1), "{work:?}");
            assert_eq!(fit.work_at_most, Some(work.interval.1));
            assert_eq!(
                fit.not_distinguished
                    .iter()
                    .filter(|pair| pair.0 == Parameter::Work)
                    .count(),
                1
            );
            assert!(
                modulus.interval.0 < 2e6 && 2e6 < modulus.interval.1,
                "{modulus:?}"
            );
        }
    }

    /// A tension in contact counts as adhesion if the negative log-likelihood (cost) of a model
    /// without adhesion is larger by 1.96²/2 = 1.9. The cost is larger by 2.4 for a tension of one
    /// standard deviation of the noise, and by 1.5 for half this tension.
    #[test]
    fn a_tension_beyond_the_noise_is_adhesion() {
        let bound = |times: f64| {
            let pulled = |(at, force): (f64, f64)| {
                (
                    at,
                    if at > 2.001e-6 {
                        force - times * 4e-8
                    } else {
                        force
                    },
                )
            };
            let mut curve = read(
                rubber(4e-8, 1, |_, _| 1.0).into_iter().map(pulled),
                Drift::Keep,
            );
            curve.touch = 2e-6;
            fit_from(&curve, &on_rubber(1e-3, 2e6), "work,offset").work_at_most
        };
        assert!(bound(0.5).is_some() && bound(1.0).is_none());
    }

    /// The contact stiffens and has a hysteresis, which the model does not describe. Parts of one
    /// curve nevertheless give overlapping intervals, and the residual is correct.
    #[test]
    fn parts_of_a_curve_that_is_not_described_have_intervals_that_overlap() {
        let points = rubber(1e-9, 3, |indentation, direction| {
            1.0 + 0.3 * indentation.max(0.0) / 1e-6 + 0.1 * direction
        });
        let fits = [0, 1].map(|part| {
            let curve = read(points.iter().copied().skip(part).step_by(2), Drift::Keep);
            fit_from(&curve, &on_rubber(1e-3, 2.7e6), "work,modulus,offset")
        });
        for fit in &fits {
            assert!(
                !fit.describes() && fit.misfit > 10.0 && fit.beyond_five_sigma > 0.2,
                "{fit:?}"
            );
            assert!(fit.reason.is_some(), "{fit:?}");
            assert!(
                (fit.residual_over_noise / fit.misfit - 0.8).abs() < 0.2,
                "{fit:?}"
            );
        }
        for (one, other) in fits[0].parameters.iter().zip(&fits[1].parameters) {
            let overlap =
                one.interval.1.min(other.interval.1) - one.interval.0.max(other.interval.0);
            assert!(
                overlap > 0.2 * (one.interval.1 - one.interval.0),
                "{one:?} {other:?}"
            );
        }
        let modulus = fits[0].parameters[1];
        assert!(
            modulus.interval.1 / modulus.interval.0 > 1.02,
            "{modulus:?}"
        );
    }

    /// Ranges and initial values follow from the curve, so the values of free parameters in the
    /// scene do not change a single bit of the result.
    #[test]
    fn a_start_a_thousand_times_off_changes_nothing() {
        let curve = read(rubber(1e-8, 2, |_, _| 1.0).into_iter(), Drift::Keep);
        let [one, other, stiff] = [(1e-6, 2e3), (50.0, 2e9), (1e-6, 2e3)]
            .map(|(work, modulus)| on_rubber(work, modulus))
            .map(|document| fit_from(&curve, &document, "work,modulus,offset"));
        assert_eq!(
            (&one.parameters, one.evaluations),
            (&other.parameters, other.evaluations)
        );
        assert_eq!(
            (one.document.text(), &one.parameters),
            (other.document.text(), &stiff.parameters)
        );
        let start = one.parameters[1].start;
        assert!((1e6..4e6).contains(&start), "{start:e}");
    }

    /// If the model does not describe a curve with many points, it is fitted to a part of the
    /// points, and the search stops a second population early.
    #[test]
    fn few_curves_are_computed_where_the_model_does_not_describe_the_curve() {
        let stiffens = |indentation: f64, direction: f64| {
            1.0 + 0.3 * indentation.max(0.0) / 1e-6 + 0.1 * direction
        };
        let curve = read(rubber_of(500, 1e-9, 3, stiffens).into_iter(), Drift::Keep);
        let fit = fit_from(&curve, &on_rubber(1e-3, 2.7e6), "work,modulus,offset");
        assert!(
            fit.reason.is_some() && fit.evaluations < 15_000,
            "{}",
            fit.evaluations
        );
        assert_eq!(fit.model.len(), 1000);
        let described = read(rubber(1e-8, 2, |_, _| 1.0).into_iter(), Drift::Keep);
        let fit = fit_from(&described, &on_rubber(1e-3, 2.7e6), "work,modulus,offset");
        assert!(
            fit.reason.is_none() && fit.evaluations < 7_000,
            "{}",
            fit.evaluations
        );
    }

    /// A parameter is undetermined if its interval is wider than a factor e on either side.
    #[test]
    fn a_parameter_is_determined_within_a_factor_e() {
        let plain = read(rubber(1e-9, 1, |_, _| 1.0).into_iter(), Drift::Keep);
        let found = |share: f64| {
            let mut curve = plain.clone();
            curve.noise = share * dot(&curve.force, &curve.force).sqrt();
            let noise = gauss(curve.noise, 4);
            curve
                .force
                .iter_mut()
                .zip(noise)
                .for_each(|(force, noise)| *force += noise);
            fit_from(&curve, &on_rubber(1e-6, 2e6), "modulus=1e5..1e7").not_distinguished
        };
        assert_eq!(found(0.05), []);
        assert_eq!(found(0.2), [(Parameter::Modulus, Parameter::Modulus)]);
    }
}
