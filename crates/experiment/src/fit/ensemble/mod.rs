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
mod instrument;
mod likelihood;
mod noise;
mod options;
mod place_search;
mod polynomials;
mod posterior;
mod precision;
pub(crate) mod predictions;
mod premises;
mod result;
mod scatter;
mod summary;
mod table;
#[cfg(test)]
mod tests;

pub use self::options::EnsembleOptions;
pub use self::result::{EnsembleFit, Prospect, Shares};

use self::computed::{Specimen, Workers};
use self::deviation::{Response, RoughnessShifts, Shifts, deviations};
use self::estimate::IntervalEstimate;
use self::instrument::with_instrument;
use self::options::check;
use self::place_search::placed;
use self::posterior::Posterior;
use self::precision::Precision;
use self::predictions::Predictions;
use self::premises::warnings_at;
use self::summary::Measurement;
use self::table::{Axis, End, MODULUS, Place, Table, WORK};
use crate::curve::MeasuredCurve;
use crate::error::{ExperimentError, refused};
use asperity_data::{Control, mean};
use asperity_scene::{Document, Simulation};
use std::panic::resume_unwind;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::channel;
use std::thread::{Builder, scope};

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
/// Returns an error if the profile of the scene is not random, if its solver is `Stepwise` or its
/// half-space relaxes, if there is no curve, if a curve occurs twice or lacks an approach, or if
/// its retraction ends before the contact is lost. It also returns an error if an option is out of
/// range, or if a computation fails or is stopped.
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
    let known = (!options.is_modulus_free).then(|| governing.modulus.ln());
    let centre = placed(&workers, &measured, &governing, known)?;
    let mut table = first_table(&workers, centre, known, options.profiles)?;
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
    /// ln E* if the scene gives E*, otherwise `None`.
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
            &self.predictions.of_profiles,
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
            profiles: self.options.profiles,
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
            profiles: self.options.profiles,
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
        let best = posterior.best();
        let variance = self.predictions.scatter.at(best).covariance[WORK];
        let variance = variance.max(f64::MIN_POSITIVE);
        Precision {
            half_width: posterior.estimate(WORK).half_width(),
            of_roughness,
            curves: self.curves.len() as f64,
            profiles: self.options.profiles as f64,
            of_steps: self.predictions.scatter.error_of_steps(best)[WORK] / variance,
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
    profiles: u64,
) -> Result<Table, ExperimentError> {
    let ranges = RANGES.nodes_around(centre.range);
    let moduli = match known {
        Some(modulus) => vec![modulus],
        None => MODULI.nodes_around(centre.modulus),
    };
    Table::new(workers, profiles, ranges, moduli)
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
