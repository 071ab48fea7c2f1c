//! Estimate of one work of adhesion from many curves of a rough body whose profile is unknown. The
//! measured curves are compared with curves computed for random profiles that have the spectrum of
//! the scene.
//!
//! Each measured curve is reduced to a few numbers, its summaries ([`summary`]). A table holds the
//! summaries of curves that are computed for random profiles, at several values of the parameters,
//! the nodes ([`table`]). Polynomials that predict the parameters from the summaries are learned
//! from this table. The mean prediction over the measured curves is compared with the predictions
//! over all profiles ([`posterior`]). The result also states the effect of errors of the roughness,
//! and whether the profiles describe the curves ([`deviation`]).

mod computed;
pub(crate) mod deviation;
pub(crate) mod estimate;
mod likelihood;
mod noise;
mod place_search;
mod polynomials;
mod posterior;
pub(crate) mod predictions;
mod scatter;
mod summary;
mod table;

use self::computed::{Specimen, Workers, seed_of};
use self::deviation::{Response, RoughnessShifts, Shifts, SummaryDeviation, deviations};
use self::estimate::IntervalEstimate;
use self::place_search::placed;
use self::posterior::Posterior;
use self::predictions::{CurveOfEnsemble, Predictions};
use self::summary::Measurement;
use self::table::{Axis, End, MODULUS, Place, Table, WORK};
use crate::curve::MeasuredCurve;
use crate::error::{ExperimentError, refused, refused_with};
use crate::fit::scene::wrong;
use asperity_contact::Move;
use asperity_data::{Control, CountedWarning, Remedy, format_quantity, mean};
use asperity_scene::{
    Adhesion, CheckedScene, Document, Material, Roughness, Scene, Simulation, Solver, Strength,
};
use std::panic::resume_unwind;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::channel;
use std::thread::{Builder, scope};

/// Smallest allowed number of random profiles. With fewer profiles, the covariance of the
/// predictions is too uncertain.
const FEWEST_LINES: u64 = 16;
/// Nodes in ln(γ/E*) of the first table, before it grows.
const RANGES: Axis = Axis {
    step: 0.2,
    nodes: 16,
};
/// Nodes in ln E* of the first table, before it grows.
const MODULI: Axis = Axis {
    step: 0.462,
    nodes: 4,
};
/// Number of nodes in ln(γ/E*) that are added to a table that is too short.
const MORE_RANGES: usize = 4;
/// Number of nodes in ln E* that are added to a table that is too short.
const MORE_MODULI: usize = 1;
/// Largest number of times that nodes are added to a table.
const MOST_GROWTH: usize = 6;
/// Relative difference up to which two stiffnesses count as equal.
const SAME_STIFFNESS: f64 = 0.01;
/// Half-width of the 95 % interval of a normal distribution, in standard deviations.
const NORMAL: f64 = 1.96;
/// Largest allowed standard error of the roughness. For larger errors the results would not change
/// in proportion to the error.
const MOST_ERROR: f64 = 0.5;
/// Numbers of measured curves for which the expected precision is stated.
const PROSPECTS: [u64; 3] = [16, 64, 256];

/// Options of [`fit_ensemble`], which compares measured curves with random
/// profiles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EnsembleOptions {
    /// Number of random profiles whose computed curves are compared with the measured curves, at
    /// least 16.
    pub lines: u64,
    /// True if the effective modulus is a free parameter too; false if its value in the scene is
    /// used.
    pub is_modulus_free: bool,
    /// Standard error of the rms height of the scene divided by this height; `None` if it is not
    /// stated.
    pub height_error: Option<f64>,
    /// Standard error of the Hurst exponent of the scene; `None` if it is not stated.
    pub hurst_error: Option<f64>,
}

/// Result of [`fit_ensemble`]: the work of adhesion and the effective modulus of one rough body,
/// from curves measured at several places on it.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct EnsembleFit {
    /// Work of adhesion γ in J/m². Its interval begins at 0 if [`Self::work_at_most`] has a value.
    pub work: IntervalEstimate,
    /// Upper bound of γ in J/m² if curves without adhesion would have the same summaries; otherwise
    /// `None`.
    pub work_at_most: Option<f64>,
    /// Effective modulus E* in Pa. A given modulus has an interval of zero width.
    pub modulus: IntervalEstimate,
    /// True if the scene gives the effective modulus.
    pub modulus_is_given: bool,
    /// Work of adhesion on closing divided by the work of adhesion on opening, as the scene states
    /// it.
    pub closing_over_opening: f64,
    /// Correlation of the errors of ln γ and ln E*, from −1 to 1; 0 for a given E*.
    pub correlation: f64,
    /// Sources of the uncertainty of the work of adhesion.
    pub shares: Shares,
    /// Precision that the work of adhesion would have with 16, 64 and 256 measured curves. Numbers
    /// that do not exceed the present number of curves are left out.
    pub prospects: Vec<Prospect>,
    /// Effect of a wrong roughness of the scene on γ and E*; `None` if the scene has a measured
    /// roughness, or if γ has an upper bound only.
    pub roughness: Option<RoughnessShifts>,
    /// Sentence on the stiffness of the instrument, if the scene and the files of the curves state
    /// different values; otherwise `None`.
    #[serde(skip)]
    pub instrument: Option<String>,
    /// Premises of the model that the scene with the found values does not meet, each with the
    /// number of the [`Self::EXAMINED`] random profiles that do not meet it.
    #[serde(skip)]
    pub warnings: Vec<CountedWarning>,
    /// Number of random profiles with which the curves were compared.
    pub lines: u64,
    /// Number of force curves computed on these profiles.
    pub computed: usize,
    /// Mean preload (largest force) in N of the measured curves.
    pub preload: f64,
    /// Standard deviation of the preloads divided by their mean; `None` if the preloads differ only
    /// by noise.
    pub preload_scatter: Option<f64>,
    /// Results of each measured curve when it is used without the others.
    pub curves: Vec<CurveOfEnsemble>,
    /// Standard deviation of ln γ between measured curves, divided by the standard deviation of ln
    /// γ between random profiles; usually 0.8 to 1.2. If E* is free, the ratio is the root mean
    /// square Mahalanobis distance of (ln γ, ln E*), divided by √2. `None` for fewer than 4 curves.
    pub scatter_ratio: Option<f64>,
    /// True if random profiles describe the measured curves: none of [`Self::deviations`] is
    /// significant.
    pub described: bool,
    /// Difference between the measured curves and the random profiles for each summary, a number
    /// computed from a curve such as its pull-off force.
    pub deviations: Vec<SummaryDeviation>,
    /// True if the interval of γ or E* ends where the values end for which curves were computed.
    /// The true interval is then wider.
    pub at_end_of_table: bool,
}

impl EnsembleFit {
    /// Number of random profiles on which the scene with the found values is computed for
    /// [`Self::warnings`].
    pub const EXAMINED: u64 = 5;
}

/// Sources of the uncertainty of the work of adhesion, as shares of the squared half-width of the
/// interval of ln γ. Their sum is 1.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct Shares {
    /// Share of the uncertainty that comes from the limited number of measured curves.
    pub places: f64,
    /// Share of the uncertainty that comes from the limited number of random profiles.
    pub profiles: f64,
    /// Share of the uncertainty that comes from the stated errors of the roughness.
    pub roughness: f64,
}

/// Precision of the work of adhesion that a larger number of measured curves would give.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct Prospect {
    /// Assumed number of measured curves: 16, 64 or 256.
    pub curves: u64,
    /// Half the width of the 95 % interval of ln γ with this number of curves.
    pub half_width: f64,
}

/// Finds the work of adhesion of a rough body from curves measured at different places on it.
/// `curves` has pairs of a name and a curve. If [`EnsembleOptions::is_modulus_free`] is true, the
/// effective modulus is found too.
///
/// The measured curves are compared with curves computed for random profiles that have the
/// roughness of the scene. `simulation` has the folder of the measured files that the scene names,
/// or the measured roughness in their place ([`Simulation::with_measured`]). `control` reports the
/// number of curves computed so far, and can stop the search.
///
/// # Errors
/// Returns an error if the profile of the scene is not random, if a curve occurs twice or lacks an
/// approach, or if its retraction ends before the contact is lost. It also returns an error if an
/// option is out of range, or if a computation fails or is stopped.
pub fn fit_ensemble(
    curves: &[(String, MeasuredCurve)],
    document: &Document,
    options: &EnsembleOptions,
    simulation: &Simulation,
    mut control: Control<'_>,
) -> Result<EnsembleFit, ExperimentError> {
    check(curves, document.scene(), options)?;
    let jobs = control.threads();
    let stop = control.stop();
    if jobs == 0 {
        return refused("0 threads", "at least one");
    }
    let (sender, receiver) = channel();
    let compare = move || {
        // Sending cannot fail, because the receiver exists until all curves are computed.
        let report = move |computed: usize| {
            let _ = sender.send(computed);
        };
        compare(curves, document, options, simulation, jobs, stop, &report)
    };
    scope(|scope| match Builder::new().spawn_scoped(scope, compare) {
        Ok(thread) => {
            for computed in receiver {
                control.report(computed as u64);
            }
            thread.join().unwrap_or_else(|panic| resume_unwind(panic))
        }
        Err(error) => {
            let found = format!("the system starts no thread: {error}");
            refused(found, "one more thread")
        }
    })
}

/// Finds the parameters as [`fit_ensemble`] describes, on this thread and `jobs` other threads.
fn compare(
    curves: &[(String, MeasuredCurve)],
    document: &Document,
    options: &EnsembleOptions,
    simulation: &Simulation,
    jobs: usize,
    stop: &(dyn Fn() -> bool + Sync),
    report: &(dyn Fn(usize) + Sync),
) -> Result<EnsembleFit, ExperimentError> {
    let (document, instrument) = &with_instrument(curves, document)?;
    let measured = Measurement::of(curves)?;
    let (_, governing) = simulation.another().contact(document.scene())?;
    let closing = match governing.adhesive_works() {
        Some([closing, opening]) => closing / opening,
        None => 1.0,
    };
    let computed = AtomicUsize::new(0);
    let workers = Workers {
        specimen: Specimen {
            scene: document.scene(),
            stiffness: document.scene().loading_stiffness.unwrap_or(f64::INFINITY),
            closing,
            protocols: &measured.protocols,
            stop,
        },
        simulation,
        jobs,
        computed: &computed,
        report,
    };
    let known = (!options.is_modulus_free).then(|| governing.effective_modulus.ln());
    let centre = placed(&workers, &measured, &governing, known)?;
    let mut table = first_table(&workers, centre, known, options.lines)?;
    let predictions = grown_predictions(&mut table, &workers, &measured, known)?;
    let comparison = Comparison {
        curves,
        options,
        measured: &measured,
        workers: &workers,
        known,
        table: &table,
        predictions: &predictions,
    };
    let fit = comparison.fit()?;
    Ok(EnsembleFit {
        instrument: instrument.clone(),
        ..fit
    })
}

/// Measured curves, and the table of computed curves with which they are compared.
struct Comparison<'a> {
    curves: &'a [(String, MeasuredCurve)],
    options: &'a EnsembleOptions,
    measured: &'a Measurement,
    workers: &'a Workers<'a>,
    /// ln E* if it is given.
    known: Option<f64>,
    table: &'a Table,
    predictions: &'a Predictions,
}

impl Comparison<'_> {
    /// Estimates the parameters with their intervals, and tests whether random profiles describe
    /// the measured curves.
    fn fit(&self) -> Result<EnsembleFit, ExperimentError> {
        let posterior = self.predictions.posterior();
        let best = posterior.best();
        let response = Response::at(&self.predictions.scatter, best, self.known.is_none());
        let beyond = posterior.beyond();
        let mut work_at_most = None;
        let mut roughness = None;
        if beyond.contains(&End::LowRange) {
            // If curves without adhesion describe the data too, the computed curves hardly change
            // with γ. No change of γ can then balance a change of the roughness.
            work_at_most = Some(posterior.most_work());
        } else {
            roughness = self.roughness_shifts(best, &response)?;
        }

        let precision = self.precision(&posterior, roughness);
        let mut work = posterior.estimate(WORK).widened(precision.of_roughness);
        let shares = precision.shares(work);
        let mut prospects = precision.prospects();
        if let Some(most) = work_at_most {
            work = work.at_most(most);
            prospects.clear();
        }
        let deviations = deviations(
            self.table,
            &self.predictions.of_lines,
            &response,
            best,
            &self.measured.mean(),
        );
        let preload = mean(&self.measured.preloads);
        Ok(EnsembleFit {
            work,
            work_at_most,
            modulus: self.modulus(&posterior, roughness),
            modulus_is_given: self.known.is_some(),
            closing_over_opening: self.workers.specimen.closing,
            correlation: posterior.correlation(),
            shares,
            prospects,
            roughness,
            instrument: None,
            warnings: warnings_at(self.workers, best, preload),
            lines: self.options.lines,
            computed: self.workers.computed.load(Ordering::Relaxed),
            preload,
            preload_scatter: self.measured.preload_scatter,
            curves: self.predictions.rows(self.curves, self.measured, best),
            scatter_ratio: self.predictions.scatter_ratio(best),
            described: deviations.iter().all(|deviation| !deviation.deviates),
            deviations,
            at_end_of_table: !beyond.is_empty(),
        })
    }

    fn roughness_shifts(
        &self,
        best: Place,
        response: &Response,
    ) -> Result<Option<RoughnessShifts>, ExperimentError> {
        let shifts = Shifts {
            workers: self.workers,
            predictions: self.predictions,
            measured: self.measured,
            response,
            lines: self.options.lines,
        };
        shifts.at(best)
    }

    fn precision(&self, posterior: &Posterior, roughness: Option<RoughnessShifts>) -> Precision {
        let of_roughness = match roughness {
            Some(shifts) => self
                .options
                .half_width_by(shifts.work_by_height, shifts.work_by_hurst),
            None => 0.0,
        };
        Precision {
            half_width: posterior.estimate(WORK).half_width(),
            of_roughness,
            curves: self.curves.len() as f64,
            lines: self.options.lines as f64,
        }
    }

    /// Returns the effective modulus with the interval of all its errors, including those of the
    /// roughness.
    fn modulus(
        &self,
        posterior: &Posterior,
        roughness: Option<RoughnessShifts>,
    ) -> IntervalEstimate {
        if let Some(modulus) = self.known {
            return IntervalEstimate::known(modulus.exp());
        }
        let of_roughness = match roughness {
            Some(shifts) => self
                .options
                .half_width_by(shifts.modulus_by_height, shifts.modulus_by_hurst),
            None => 0.0,
        };
        posterior.estimate(MODULUS).widened(of_roughness)
    }
}

/// Computes the first table, around a pair of parameters.
fn first_table(
    workers: &Workers<'_>,
    centre: Place,
    known: Option<f64>,
    lines: u64,
) -> Result<Table, ExperimentError> {
    let ranges = RANGES.nodes_around(centre.range);
    let moduli = match known {
        Some(modulus) => vec![modulus],
        None => MODULI.nodes_around(centre.modulus),
    };
    Table::new(workers, lines, ranges, moduli)
}

/// Extends a table until the parameters lie within it, and returns the predictions that are learned
/// from this table.
fn grown_predictions(
    table: &mut Table,
    workers: &Workers<'_>,
    measured: &Measurement,
    known: Option<f64>,
) -> Result<Predictions, ExperimentError> {
    for _ in 0..MOST_GROWTH {
        let predictions = Predictions::new(table, measured, known);
        let beyond = predictions.posterior().beyond();
        if beyond.is_empty() {
            return Ok(predictions);
        }
        for end in beyond {
            let count = if end.is_of_modulus() {
                MORE_MODULI
            } else {
                MORE_RANGES
            };
            table.extend(workers, end, count)?;
        }
    }
    Ok(Predictions::new(table, measured, known))
}

impl EnsembleOptions {
    /// Returns half the width of the 95 % interval of a quantity that results from the stated
    /// errors of the roughness. `by_height` and `by_hurst` are the derivatives of the quantity with
    /// respect to ln h and H.
    fn half_width_by(&self, by_height: f64, by_hurst: f64) -> f64 {
        let height_error = self.height_error.unwrap_or_default();
        let hurst_error = self.hurst_error.unwrap_or_default();
        NORMAL * (by_height * height_error).hypot(by_hurst * hurst_error)
    }
}

/// Precision of the work of adhesion.
struct Precision {
    /// Half the width of the 95 % interval of ln γ for a roughness without error.
    half_width: f64,
    /// Half the width of the 95 % interval of ln γ that results from the stated errors of the
    /// roughness alone.
    of_roughness: f64,
    /// Number of measured curves.
    curves: f64,
    /// Number of random profiles.
    lines: f64,
}

impl Precision {
    /// Returns the variance of the mean prediction over `curves` curves, in units of the variance
    /// over the random profiles.
    fn variance(&self, curves: f64) -> f64 {
        1.0 / curves + 1.0 / self.lines
    }

    /// Returns the sources of the uncertainty of the work of adhesion. The interval of `work`
    /// includes all errors.
    fn shares(&self, work: IntervalEstimate) -> Shares {
        let square = self.half_width.powi(2);
        let variance = self.variance(self.curves);
        let all = work.half_width().powi(2);
        Shares {
            places: square / self.curves / variance / all,
            profiles: square / self.lines / variance / all,
            roughness: self.of_roughness.powi(2) / all,
        }
    }

    /// Returns the expected precision for larger numbers of curves.
    fn prospects(&self) -> Vec<Prospect> {
        let square = self.half_width.powi(2);
        let variance = self.variance(self.curves);
        let mut prospects = Vec::new();
        for curves in PROSPECTS {
            if curves as f64 > self.curves {
                let of_curves = square * self.variance(curves as f64) / variance;
                prospects.push(Prospect {
                    curves,
                    half_width: (of_curves + self.of_roughness.powi(2)).sqrt(),
                });
            }
        }
        prospects
    }
}

/// Returns the premises of the model that some random profiles do not meet. A few profiles are
/// computed with the parameters of a place and a preload in N. If no profile can be computed, the
/// result has only the premises that can be checked with the fields of the scene.
fn warnings_at(workers: &Workers<'_>, place: Place, preload: f64) -> Vec<CountedWarning> {
    let mut simulation = workers.simulation.another();
    let mut warnings = Vec::new();
    let mut computed = 0;
    for line in 0..EnsembleFit::EXAMINED {
        let profile = profile_at(&workers.specimen, place, preload, line);
        let outcome = profile.and_then(|profile| simulation.compute(&profile).ok());
        let Some(outcome) = outcome else {
            continue;
        };
        computed += 1;
        for warning in &outcome.warnings {
            CountedWarning::count(&mut warnings, warning);
        }
    }
    if computed == 0 {
        for warning in workers.specimen.scene.warnings() {
            let profiles = EnsembleFit::EXAMINED;
            warnings.push(CountedWarning { warning, profiles });
        }
    }
    warnings
}

/// Returns the scene of a random profile with the parameters of a place, loaded to a preload in N;
/// `None` if the scene does not allow these values.
fn profile_at(
    specimen: &Specimen<'_>,
    place: Place,
    preload: f64,
    line: u64,
) -> Option<CheckedScene> {
    let [work, modulus] = place.parameters().map(f64::exp);
    let has_closing_work = specimen.closing != 1.0;
    let strength = Strength::Work {
        opening: work,
        closing: has_closing_work.then_some(specimen.closing * work),
    };
    let scene = specimen.scene.with(|scene| {
        scene.material = Material::effective(modulus);
        scene.adhesion = scene.adhesion.map(|adhesion| Adhesion {
            strength,
            ..adhesion
        });
        scene.loading = vec![Move::ToForce(preload), Move::ToSeparation];
        scene.set_seed(seed_of(specimen.scene, line));
    });
    scene.ok()
}

/// Returns the scene with the stiffness of the instrument that the files state, and a sentence on
/// this change.
fn with_instrument(
    curves: &[(String, MeasuredCurve)],
    document: &Document,
) -> Result<(Document, Option<String>), ExperimentError> {
    let (first_name, first_curve) = &curves[0];
    let first = first_curve.with_instrument(document).map_err(wrong)?;
    let stiffness = stiffness_of(&first.0);
    for (name, curve) in curves {
        let (other, _) = curve.with_instrument(document).map_err(wrong)?;
        let other = stiffness_of(&other);
        if stiffness != other && (stiffness / other).ln().abs() > SAME_STIFFNESS {
            let stiffness = format_quantity(stiffness, "N/m");
            let other = format_quantity(other, "N/m");
            let found = format!(
                "{name}: a loading stiffness of {other}, and of {stiffness} in {first_name}"
            );
            return refused(found, "curves of one instrument");
        }
    }
    Ok(first)
}

fn stiffness_of(document: &Document) -> f64 {
    document.scene().loading_stiffness.unwrap_or(f64::INFINITY)
}

/// Returns an error if the curves, the scene or the options allow no comparison.
fn check(
    curves: &[(String, MeasuredCurve)],
    scene: &Scene,
    options: &EnsembleOptions,
) -> Result<(), ExperimentError> {
    if curves.is_empty() {
        return refused("no curve", "one or more curves");
    }
    if scene.seed().is_none() {
        let found = "a comparison with random profiles, and the profile of the scene is not random";
        let allowed = "a scene with random roughness, or a fit of the profile of the scene";
        return refused_with(found, allowed, [Remedy::NoProfiles]);
    }
    if scene.numerics.solver != Solver::Exact {
        let found =
            "numerics.solver = Stepwise: a comparison with random profiles needs the exact solver";
        return refused(found, "numerics.solver = Exact");
    }
    check_error("error of the rms height", options.height_error)?;
    check_error("error of the Hurst exponent", options.hurst_error)?;
    let states_errors = options.height_error.or(options.hurst_error).is_some();
    if states_errors && !matches!(scene.roughness, Some(Roughness::SelfAffine { .. })) {
        let found = "errors of the roughness, which is measured";
        let allowed = "roughness: SelfAffine(…), or no errors";
        return refused_with(found, allowed, [Remedy::NoRoughnessErrors]);
    }
    if options.lines < FEWEST_LINES {
        let found = format!("{} profiles", options.lines);
        let allowed = format!("at least {FEWEST_LINES}");
        return refused_with(found, allowed, [Remedy::Profiles(FEWEST_LINES)]);
    }
    for (index, (name, curve)) in curves.iter().enumerate() {
        for (other_name, other) in &curves[..index] {
            if other.force == curve.force && other.displacement == curve.displacement {
                let found = format!("{name}: the same curve as {other_name}");
                return refused(found, "each curve once");
            }
        }
    }
    Ok(())
}

/// Returns an error for a standard error of the roughness that is out of range.
fn check_error(name: &str, error: Option<f64>) -> Result<(), ExperimentError> {
    if let Some(error) = error
        && !(0.0..=MOST_ERROR).contains(&error)
    {
        return refused(format!("{name} {error}"), format!("from 0 to {MOST_ERROR}"));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::common::specimens::{curve, document, scene};
    use asperity_data::Warning;

    const OPTIONS: EnsembleOptions = EnsembleOptions {
        lines: 16,
        is_modulus_free: false,
        height_error: None,
        hurst_error: None,
    };

    fn found(
        curves: &[(String, MeasuredCurve)],
        scene: &Scene,
        options: EnsembleOptions,
    ) -> Result<EnsembleFit, ExperimentError> {
        fit_ensemble(
            curves,
            &document(scene),
            &options,
            &Simulation::default(),
            Control::default().on_threads(1),
        )
    }

    /// Returns curves of rough spheres on 1024 springs. The curve with the number `foreign` has a
    /// fifth of the work of adhesion of the others.
    fn curves(count: u64, foreign: Option<u64>) -> (Scene, Vec<(String, MeasuredCurve)>) {
        let mut scene = scene("rough-sphere");
        scene.numerics.points = 2048;
        let mut simulation = Simulation::default();
        let one = |seed: u64| {
            let share = if foreign == Some(seed) { 0.2 } else { 1.0 };
            let adhesion = Some(Adhesion::by_work(0.05 * share));
            let scene = Scene {
                adhesion,
                ..scene.clone()
            };
            (
                format!("place {seed}"),
                curve(&mut simulation, &scene, 40 + seed, 0.01),
            )
        };
        let curves = (0..count).map(one).collect();
        (scene, curves)
    }

    /// The result depends neither on the values in the scene nor on the number of threads. A place
    /// with another work of adhesion is named.
    #[test]
    fn the_work_of_adhesion_is_found_and_a_foreign_place_named() {
        let (scene, all) = curves(12, Some(5));
        let fit = found(
            &all,
            &scene,
            EnsembleOptions {
                lines: 64,
                ..OPTIONS
            },
        )
        .unwrap();
        let foreign: Vec<&str> = fit
            .curves
            .iter()
            .filter(|curve| curve.foreign)
            .map(|curve| curve.name.as_str())
            .collect();
        assert_eq!(foreign, ["place 5"]);
        let others: Vec<_> = all
            .iter()
            .filter(|(name, _)| name != "place 5")
            .cloned()
            .collect();
        let fit = found(&others, &scene, OPTIONS).unwrap();
        let IntervalEstimate { low, high, .. } = fit.work;
        assert!(
            low < 0.05 && 0.05 < high && high / low < 2.5,
            "{:?}",
            fit.work
        );
        assert!(
            fit.described && !fit.at_end_of_table && fit.preload_scatter.is_none(),
            "{fit:?}"
        );
        assert!(
            (fit.shares.places + fit.shares.profiles - 1.0).abs() < 1e-12
                && fit.shares.roughness == 0.0
        );
        // A larger rms height needs a larger work of adhesion.
        let shifts = fit.roughness.unwrap();
        assert!((0.3..3.0).contains(&shifts.work_by_height), "{shifts:?}");
        let other = Scene {
            adhesion: Some(Adhesion::by_work(0.3)),
            ..scene.clone()
        };
        let three = Control::default().on_threads(3);
        let simulation = Simulation::default();
        let same = fit_ensemble(&others, &document(&other), &OPTIONS, &simulation, three).unwrap();
        assert_eq!(same, fit);
        let stated = EnsembleOptions {
            height_error: Some(0.1),
            hurst_error: Some(0.0),
            ..OPTIONS
        };
        let wider = found(&others, &scene, stated).unwrap();
        let added = NORMAL * 0.1 * shifts.work_by_height;
        assert!(
            (wider.work.half_width() - fit.work.half_width().hypot(added)).abs() < 0.02 * added
        );
    }

    /// Curves without adhesion give an upper bound of γ, and no other number that depends on γ.
    #[test]
    fn curves_without_adhesion_have_an_upper_bound_of_it() {
        let (scene, _) = curves(0, None);
        let bare = Scene {
            adhesion: Some(Adhesion::by_work(1e-8)),
            ..scene.clone()
        };
        let mut simulation = Simulation::default();
        let all: Vec<_> = (0..4)
            .map(|seed| {
                (
                    seed.to_string(),
                    curve(&mut simulation, &bare, 70 + seed, 0.01),
                )
            })
            .collect();
        let fit = found(
            &all,
            &scene,
            EnsembleOptions {
                lines: 64,
                ..OPTIONS
            },
        )
        .unwrap();
        let most = fit.work_at_most.unwrap();
        assert!((1e-5..0.03).contains(&most), "{most:e}");
        assert_eq!(
            (fit.work.low, fit.work.high, fit.roughness),
            (0.0, most, None)
        );
        assert!(fit.work.value <= most && fit.prospects.is_empty() && fit.at_end_of_table);
        assert!(
            (fit.shares.places + fit.shares.profiles - 1.0).abs() < 1e-12,
            "{:?}",
            fit.shares
        );
    }

    /// A warning names a profile that is shorter than the contact.
    #[test]
    fn a_contact_that_fills_its_profile_is_named() {
        let (scene, all) = curves(2, None);
        let ends = |warning: &&CountedWarning| warning.warning.name() == "contact_at_ends";
        let fit = found(&all, &scene, OPTIONS).unwrap();
        assert_eq!(fit.warnings.iter().find(ends), None);
        let mut short = scene.clone();
        short.length = 2e-5;
        let fit = found(&all, &short, OPTIONS).unwrap();
        let expected = CountedWarning {
            warning: Warning::ContactAtEnds { length: 2e-5 },
            profiles: EnsembleFit::EXAMINED,
        };
        assert_eq!(fit.warnings.iter().find(ends), Some(&expected));
    }

    /// The warnings are those of the profiles that are computed with the found values.
    #[test]
    fn the_premises_are_those_of_single_profiles() {
        let (mut scene, all) = curves(2, None);
        scene.numerics.points = 1024;
        let fit = found(&all, &scene, OPTIONS).unwrap();
        let mut names = Vec::new();
        let checked = scene.checked().unwrap();
        for seed in 0..EnsembleFit::EXAMINED {
            let single = checked.with(|scene| {
                scene.adhesion = Some(Adhesion::by_work(fit.work.value));
                scene.loading = vec![Move::ToForce(fit.preload), Move::ToSeparation];
                scene.set_seed(seed_of(&checked, seed));
            });
            let outcome = Simulation::default().compute(&single.unwrap()).unwrap();
            names.extend(outcome.warnings.iter().map(Warning::name));
        }
        assert!(!names.is_empty());
        for counted in &fit.warnings {
            let name = counted.warning.name();
            let profiles = names.iter().filter(|other| **other == name).count();
            assert_eq!(counted.profiles, profiles as u64, "{name}");
            names.retain(|other| *other != name);
        }
        assert_eq!(names, [""; 0]);
    }

    #[test]
    fn curves_that_cannot_be_compared_are_refused() {
        let (scene, all) = curves(2, None);
        let smooth = Scene {
            roughness: None,
            ..scene.clone()
        };
        let turned = all[0].1.segment.partition_point(|segment| *segment == 0);
        let cut = |from: usize, to: usize| {
            let mut curve = all[0].1.clone();
            for values in [&mut curve.displacement, &mut curve.force] {
                *values = values[from..to].to_vec();
            }
            curve.segment = curve.segment[from..to].to_vec();
            vec![("cut".to_owned(), curve)]
        };
        let few = EnsembleOptions {
            lines: 8,
            ..OPTIONS
        };
        let twice = vec![all[0].clone(), ("again".to_owned(), all[0].1.clone())];
        for (result, said) in [
            (
                found(&all, &smooth, OPTIONS),
                "the profile of the scene is not random",
            ),
            (found(&[], &scene, OPTIONS), "no curve"),
            (found(&all, &scene, few), "8 profiles"),
            (
                found(&twice, &scene, OPTIONS),
                "again: the same curve as place 0",
            ),
            (
                found(&cut(0, turned + 120), &scene, OPTIONS),
                "cut: the retraction ends before contact is lost",
            ),
            (
                found(&cut(turned, 2 * turned), &scene, OPTIONS),
                "cut: no approach and retraction",
            ),
        ] {
            let error = result.unwrap_err().to_string();
            assert!(
                error.contains(said) && error.contains("allowed: "),
                "{said}: {error}"
            );
        }
        let wrong = |error| EnsembleOptions {
            height_error: Some(error),
            ..OPTIONS
        };
        for error in [-0.1, 0.6, f64::NAN, f64::INFINITY] {
            let refused = found(&all, &scene, wrong(error)).unwrap_err().to_string();
            assert!(refused.contains("allowed: from 0 to 0.5"), "{refused}");
        }
        let none = fit_ensemble(
            &all,
            &document(&scene),
            &OPTIONS,
            &Simulation::default(),
            Control::default().on_threads(0),
        );
        assert_eq!(
            none.unwrap_err().to_string(),
            "0 threads; allowed: at least one"
        );
        let stopped = fit_ensemble(
            &all,
            &document(&scene),
            &OPTIONS,
            &Simulation::default(),
            Control::default().stopped_by(&|| true),
        );
        assert!(matches!(stopped, Err(ExperimentError::Run(_))));
    }
}
