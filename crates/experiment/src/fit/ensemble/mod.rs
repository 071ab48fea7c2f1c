//! One work of adhesion from many curves of a rough body whose profile is unknown. The curves are
//! compared with curves computed for random profiles of the spectrum of the scene.
//!
//! Each measured curve becomes a few numbers, its summaries ([`summary`]). Curves of random profiles
//! have summaries at all nodes of a table ([`table`]). From the table polynomials are learned that
//! predict the parameters, and the mean prediction over the measured curves is compared with the
//! predictions over all profiles ([`posterior`]). The result also has the effect of errors of the
//! roughness, and whether the profiles describe the curves ([`deviation`]).

pub(crate) mod deviation;
pub(crate) mod posterior;
pub(crate) mod summary;
pub(crate) mod table;

use self::deviation::{Response, RoughnessShifts, Shifts, SummaryDeviation, deviations};
use self::posterior::{Compared, CurveOfEnsemble, IntervalEstimate};
use self::summary::Measured;
use self::table::{End, Place, Specimen, Table, Workers, nodes, placed, seed_of};
use crate::curve::MeasuredCurve;
use crate::error::{ExperimentError, refused};
use crate::fit::reason::{Reason, of_profile};
use crate::fit::scene::wrong;
use asperity_contact::Move;
use asperity_data::{Control, format_quantity, mean};
use asperity_scene::{
    Adhesion, Document, Material, Roughness, Scene, Simulation, Solver, Strength,
};
use std::panic::resume_unwind;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::channel;
use std::thread::{Builder, scope};

/// Smallest number of random profiles. With fewer the covariance is too uncertain.
const FEWEST_LINES: u64 = 16;
/// Steps of the table in ln(γ/E*) and ln E*, and numbers of nodes.
const STEPS: [f64; 2] = [0.2, 0.462];
const NODES: [usize; 2] = [16, 4];
/// Numbers of nodes by which a table that is too short grows in ln(γ/E*) and ln E*, and largest
/// number of times.
const MORE_NODES: [usize; 2] = [4, 1];
const MOST_GROWTH: usize = 6;
/// Relative difference up to which two stiffnesses count as equal.
const SAME_STIFFNESS: f64 = 0.01;
const NORMAL: f64 = 1.96;
/// Largest standard error of the roughness for which the results change in proportion to the error.
const MOST_ERROR: f64 = 0.5;
/// Number of random profiles whose contact is examined.
const EXAMINED: u64 = 5;
/// Numbers of curves whose precision is stated.
const PROSPECTS: [u64; 3] = [16, 64, 256];

/// Options of [`fit_ensemble`](crate::fit_ensemble), which compares measured curves with random
/// profiles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EnsembleOptions {
    /// Number of random profiles whose computed curves are compared with the measured curves, at
    /// least 16.
    pub lines: u64,
    /// True if the effective modulus is to be found too; false if its value in the scene is used.
    pub is_modulus_free: bool,
    /// Standard error of the rms height of the scene divided by this height; `None` if it is not
    /// stated.
    pub height_error: Option<f64>,
    /// Standard error of the Hurst exponent of the scene; `None` if it is not stated.
    pub hurst_error: Option<f64>,
}

/// Result of [`fit_ensemble`](crate::fit_ensemble): the work of adhesion and the effective modulus
/// of one rough body, from curves measured at several places of it.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct EnsembleFit {
    /// Work of adhesion γ, J/m². Its interval begins at 0 if [`Self::work_at_most`] has a value.
    pub work: IntervalEstimate,
    /// Upper bound of γ in J/m² if curves without adhesion would have the same summaries; otherwise
    /// `None`.
    pub work_at_most: Option<f64>,
    /// Effective modulus E*, Pa. A given modulus has an interval of zero width.
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
    /// Precision that the work of adhesion would have with 16, 64 and 256 measured curves. Only
    /// those of these numbers are listed that exceed the present number of curves.
    pub prospects: Vec<Prospect>,
    /// Effect of a wrong roughness of the scene on γ and E*; `None` if the scene has a measured
    /// roughness, or if γ has an upper bound only.
    pub roughness: Option<RoughnessShifts>,
    /// Sentence on the stiffness of the instrument if the scene and the files of the curves do not
    /// agree on it; otherwise `None`.
    #[serde(skip)]
    pub instrument: Option<String>,
    /// Why the profiles of the scene are not suitable with the fitted values: the contact fills
    /// most of the examined profiles, or few springs are in contact. `None` if they are suitable.
    pub unsuitable_profile: Option<Reason>,
    /// Number of random profiles with which the curves were compared.
    pub lines: u64,
    /// Number of force curves computed on these profiles.
    pub computed: usize,
    /// Mean preload (largest force) of the measured curves, N.
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

/// Finds the work of adhesion of a rough body from curves measured at different places of it.
/// `curves` has pairs of a name and a curve. If [`EnsembleOptions::is_modulus_free`] is true, the
/// effective modulus is found too.
///
/// The curves are compared with curves computed for random profiles that have the roughness of the
/// scene. `control` reports the number of curves computed so far, and can stop the search.
///
/// # Errors
/// Returns an error if the profile of the scene is not random, if a curve occurs twice or lacks an
/// approach, or if its retraction ends before the contact is lost. It also returns an error if an
/// option is out of range, or if a computation fails or is stopped.
pub fn fit_ensemble(
    curves: &[(String, MeasuredCurve)],
    document: &Document,
    options: &EnsembleOptions,
    mut control: Control<'_>,
) -> Result<EnsembleFit, ExperimentError> {
    check(curves, document.scene(), options)?;
    let (jobs, stop) = (control.threads(), control.stop());
    if jobs == 0 {
        return refused("0 threads", "at least one");
    }
    let (sender, receiver) = channel();
    let compare = move || {
        // The receiver lives until all is computed.
        let report = move |computed: usize| {
            let _ = sender.send(computed);
        };
        compare(curves, document, options, (jobs, stop), &report)
    };
    scope(|scope| match Builder::new().spawn_scoped(scope, compare) {
        Ok(thread) => {
            receiver
                .iter()
                .for_each(|computed| control.report(computed as u64));
            thread.join().unwrap_or_else(|panic| resume_unwind(panic))
        }
        Err(error) => refused(
            format!("the system starts no thread: {error}"),
            "one more thread",
        ),
    })
}

fn compare(
    curves: &[(String, MeasuredCurve)],
    document: &Document,
    options: &EnsembleOptions,
    (jobs, stop): (usize, &(dyn Fn() -> bool + Sync)),
    report: &(dyn Fn(usize) + Sync),
) -> Result<EnsembleFit, ExperimentError> {
    let (document, instrument) = &of_instrument(curves, document)?;
    let measured = Measured::of(curves)?;
    let (_, governing) = Simulation::new(document.resolve("")).contact(document.scene())?;
    let closing = governing
        .adhesive_works()
        .map_or(1.0, |[closing, opening]| closing / opening);
    let folder = document.resolve("");
    let computed = AtomicUsize::new(0);
    let workers = Workers {
        specimen: Specimen {
            scene: document.scene(),
            stiffness: document.scene().loading_stiffness.unwrap_or(f64::INFINITY),
            closing,
            protocols: &measured.protocols,
            stop,
        },
        folder: &folder,
        jobs,
        computed: &computed,
        report,
    };
    let known = (!options.is_modulus_free).then(|| governing.effective_modulus.ln());
    let centre = placed(&workers, &measured, &governing, known)?;
    let from = |centre: f64, index: usize| {
        nodes(
            centre - 0.5 * (NODES[index] - 1) as f64 * STEPS[index],
            STEPS[index],
            NODES[index],
        )
    };
    let moduli = known.map_or_else(|| from(centre.modulus, 1), |modulus| vec![modulus]);
    let mut table = Table::new(&workers, options.lines, from(centre.range, 0), moduli)?;
    let mut grown = 0;
    let compared = loop {
        let compared = Compared::new(&table, &measured, known);
        let beyond = compared.posterior(&measured).beyond();
        if beyond.is_empty() || grown == MOST_GROWTH {
            break compared;
        }
        grown += 1;
        for end in beyond {
            table.extend(&workers, end, MORE_NODES[usize::from(end.is_of_modulus())])?;
        }
    };
    let posterior = compared.posterior(&measured);
    let best = posterior.best();
    let response = Response::at(&compared.scatter, best, known.is_none());
    let shifts = Shifts {
        workers: &workers,
        compared: &compared,
        measured: &measured,
        response: &response,
    };
    // Curves without adhesion do not change with γ, and no change of γ makes up for a change of the
    // roughness.
    let beyond = posterior.beyond();
    let work_at_most = beyond
        .contains(&End::LowRange)
        .then(|| posterior.most_work());
    let roughness = if work_at_most.is_some() {
        None
    } else {
        shifts.at(best, options.lines)?
    };
    let by_roughness = |by_height: f64, by_hurst: f64| {
        let [height, hurst] =
            [options.height_error, options.hurst_error].map(Option::unwrap_or_default);
        NORMAL * (by_height * height).hypot(by_hurst * hurst)
    };
    let of_roughness = roughness.map_or([0.0; 2], |of| {
        [
            by_roughness(of.work_by_height, of.work_by_hurst),
            by_roughness(of.modulus_by_height, of.modulus_by_hurst),
        ]
    });
    let alone = posterior.estimate(0);
    let work = alone.widened(of_roughness[0]);
    let modulus = match known {
        Some(modulus) => IntervalEstimate::known(modulus.exp()),
        None => posterior.estimate(1).widened(of_roughness[1]),
    };
    let (count, lines) = (curves.len() as f64, options.lines as f64);
    let variance = 1.0 / count + 1.0 / lines;
    let (square, all) = (alone.half_width().powi(2), work.half_width().powi(2));
    let prospect = |curves: u64| {
        let other = 1.0 / curves as f64 + 1.0 / lines;
        let half_width = (square * other / variance + of_roughness[0].powi(2)).sqrt();
        Prospect { curves, half_width }
    };
    let learned = |line: usize, node: usize| compared.learned[line][node];
    let deviations = deviations(&table, &learned, &response, best, &measured.mean());
    Ok(EnsembleFit {
        work: work_at_most.map_or(work, |most| work.at_most(most)),
        work_at_most,
        modulus,
        modulus_is_given: known.is_some(),
        closing_over_opening: closing,
        correlation: posterior.correlation(),
        shares: Shares {
            places: square / count / variance / all,
            profiles: square / lines / variance / all,
            roughness: of_roughness[0].powi(2) / all,
        },
        prospects: PROSPECTS
            .into_iter()
            .filter(|one| *one > curves.len() as u64 && work_at_most.is_none())
            .map(prospect)
            .collect(),
        roughness,
        instrument: instrument.clone(),
        unsuitable_profile: unsuitable_profile(&workers, best, mean(&measured.preloads)),
        lines: options.lines,
        computed: computed.load(Ordering::Relaxed),
        preload: mean(&measured.preloads),
        preload_scatter: measured.preload_scatter,
        curves: compared.rows(curves, &measured, best),
        scatter_ratio: compared.scatter_ratio(&measured, best),
        described: deviations.iter().all(|one| !one.deviates),
        deviations,
        at_end_of_table: !beyond.is_empty(),
    })
}

/// Returns why most of a few random profiles are not suitable for a contact with the parameters of
/// a place.
fn unsuitable_profile(workers: &Workers<'_>, place: Place, preload: f64) -> Option<Reason> {
    let Specimen { scene, closing, .. } = workers.specimen;
    let [work, modulus] = place.parameters().map(f64::exp);
    let mut simulation = Simulation::new(workers.folder.to_path_buf());
    let mut found = Vec::new();
    for line in 0..EXAMINED {
        let profile = scene.with(|scene| {
            scene.material = Material::effective(modulus);
            let closing = (closing != 1.0).then_some(closing * work);
            let strength = Strength::Work {
                opening: work,
                closing,
            };
            scene.adhesion = scene.adhesion.map(|adhesion| Adhesion {
                strength,
                ..adhesion
            });
            scene.loading = vec![Move::ToForce(preload), Move::ToSeparation];
            scene.set_seed(seed_of(workers.specimen.scene, line));
        });
        found.extend(of_profile(&profile.ok()?, &mut simulation));
    }
    if 2 * found.len() <= EXAMINED as usize {
        return None;
    }
    found.first().copied()
}

/// Returns the scene with the stiffness of the instrument that the files state, and this change in
/// words.
fn of_instrument(
    curves: &[(String, MeasuredCurve)],
    document: &Document,
) -> Result<(Document, Option<String>), ExperimentError> {
    let of = |curve: &MeasuredCurve| curve.with_instrument(document).map_err(wrong);
    let first = of(&curves[0].1)?;
    for (name, curve) in curves {
        let [one, other] = [&first.0, &of(curve)?.0]
            .map(|document| document.scene().loading_stiffness.unwrap_or(f64::INFINITY));
        if one != other && (one / other).ln().abs() > SAME_STIFFNESS {
            let [one, other] = [one, other].map(|stiffness| format_quantity(stiffness, "N/m"));
            return refused(
                format!(
                    "{name}: a loading stiffness of {other}, and of {one} in {}",
                    curves[0].0
                ),
                "curves of one instrument",
            );
        }
    }
    Ok(first)
}

/// Returns an error for a scene or options that allow no comparison.
fn check(
    curves: &[(String, MeasuredCurve)],
    scene: &Scene,
    options: &EnsembleOptions,
) -> Result<(), ExperimentError> {
    if curves.is_empty() {
        return refused("no curve", "one or more curves");
    }
    if scene.seed().is_none() {
        let allowed =
            "a scene with random roughness; without --profiles a scene whose profile is known";
        return refused(
            "--profiles: the profile of the scene is not random",
            allowed,
        );
    }
    if scene.numerics.solver != Solver::Exact {
        let found =
            "numerics.solver = Stepwise: a comparison with random profiles needs the exact solver";
        return refused(found, "numerics.solver = Exact");
    }
    for (name, error) in [
        ("--height-error", options.height_error),
        ("--hurst-error", options.hurst_error),
    ] {
        if let Some(error) = error.filter(|error| !(0.0..=MOST_ERROR).contains(error)) {
            return refused(format!("{name} {error}"), format!("from 0 to {MOST_ERROR}"));
        }
    }
    let states_errors = options.height_error.or(options.hurst_error).is_some();
    if states_errors && !matches!(scene.roughness, Some(Roughness::SelfAffine { .. })) {
        let found = "errors of the roughness, which is measured";
        return refused(
            found,
            "roughness: SelfAffine(…), or no --height-error and --hurst-error",
        );
    }
    if options.lines < FEWEST_LINES {
        return refused(
            format!("--profiles {}", options.lines),
            format!("at least {FEWEST_LINES}"),
        );
    }
    for (index, (name, curve)) in curves.iter().enumerate() {
        let same = |(_, other): &&(String, MeasuredCurve)| {
            other.force == curve.force && other.displacement == curve.displacement
        };
        if let Some((other, _)) = curves[..index].iter().find(same) {
            return refused(
                format!("{name}: the same curve as {other}"),
                "each curve once",
            );
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::common::specimens::{curve, document, scene};

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
            Control::default().on_threads(1),
        )
    }

    /// Rough spheres of 1024 springs; the work of adhesion of the curve with number `foreign` is a
    /// fifth.
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

    /// The start of the scene does not matter, nor the number of threads; a place with another work
    /// of adhesion is named.
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
        // More height needs more adhesion.
        let shifts = fit.roughness.unwrap();
        assert!((0.3..3.0).contains(&shifts.work_by_height), "{shifts:?}");
        let other = Scene {
            adhesion: Some(Adhesion::by_work(0.3)),
            ..scene.clone()
        };
        let three = Control::default().on_threads(3);
        let same = fit_ensemble(&others, &document(&other), &OPTIONS, three).unwrap();
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

    /// Curves without adhesion give an upper bound of γ and no other number that depends on it.
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

    /// A profile that is shorter than the contact is named.
    #[test]
    fn a_contact_that_fills_its_profile_is_named() {
        let (scene, all) = curves(2, None);
        assert_eq!(
            found(&all, &scene, OPTIONS).unwrap().unsuitable_profile,
            None
        );
        let mut short = scene.clone();
        short.length = 2e-5;
        let fit = found(&all, &short, OPTIONS).unwrap();
        assert_eq!(fit.unsuitable_profile, Some(Reason::ShortProfile(2e-5)));
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
            (found(&all, &scene, few), "--profiles 8"),
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
            Control::default().stopped_by(&|| true),
        );
        assert!(matches!(stopped, Err(ExperimentError::Run(_))));
    }
}
