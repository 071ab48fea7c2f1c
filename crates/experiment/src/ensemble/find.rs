//! The comparison of measured curves with random profiles, step by step.

use super::branches::Branches;
use super::computed::{Place, Protocol, Specimen};
use super::deviation::{Mean, Response, deviations};
use super::learn::{Described, Learned};
use super::posterior::{Estimate, Grid, Posterior};
use super::result::{CurveOfEnsemble, EnsembleFit, EnsembleOptions, Prospect, RoughnessShifts, Shares};
use super::scatter::{Scatter, distance};
use super::summary::{LOOP_AREA, PULL_OFF, SUMMARIES, Summaries, WAY_TO_HALF, summaries};
use super::table::{Table, Workers, nodes};
use crate::curve::MeasuredCurve;
use crate::error::{ExperimentError, refused};
use crate::scene::wrong;
use asperity_data::{format_quantity, mean, median, standard_deviation};
use asperity_scene::{Document, Governing, Roughness, Scene, Simulation, Solver};
use std::sync::atomic::{AtomicUsize, Ordering};

/// Fewest random profiles: the covariance of fewer is too uncertain.
pub(crate) const FEWEST_LINES: u64 = 16;
/// Grid that finds the place of the table: number of lines, steps and numbers of nodes.
const ROUGH_LINES: u64 = 8;
const ROUGH_STEPS: [f64; 2] = [0.8, 0.7];
const ROUGH_NODES: [usize; 2] = [13, 7];
const MOST_MOVES: usize = 4;
/// Number of places between two nodes of that grid.
const FINE_STEPS: usize = 6;
/// Largest κ = √(h⟨∇z⟩E*/γ) of the first of these grids, which extends to about 1.
const HIGHEST_KAPPA: f64 = 80.0;
/// Least scatter of a summary on that grid.
const LEAST_SCATTER: f64 = 0.1;
/// Grid of the table: steps and numbers of nodes over ln(γ/E*) and ln E*.
const STEPS: [f64; 2] = [0.2, 0.462];
const NODES: [usize; 2] = [16, 4];
/// Number of nodes by which a table that is too short grows, and number of times.
const MORE_NODES: [usize; 2] = [4, 1];
const MOST_GROWTH: usize = 6;
/// Scatter of the preloads, in units of that by noise, above which they differ.
const DIFFERENT: f64 = 2.0;
/// Factor within which estimates of the noise of all curves are estimates of one noise, their median.
const ONE_NOISE: f64 = 1.5;
/// Difference of the logarithms of two stiffnesses that count as one.
const SAME_STIFFNESS: f64 = 0.01;
/// Distance of a curve from the others beyond which lies one of a thousand: quantiles of χ² for one and for two values.
const FOREIGN: [f64; 2] = [10.8, 13.8];
/// Smallest pull-off force that is stated, in standard deviations of the noise.
const LEAST_PULL_OFF: f64 = 5.0;
const FEWEST_FOR_SCATTER: usize = 4;
/// Changes of the logarithm of the rms height and of the Hurst exponent for their derivatives.
const HEIGHT_STEP: f64 = 0.05;
const HURST_STEP: f64 = 0.05;
const NORMAL: f64 = 1.96;
/// Numbers of curves whose precision is stated.
const PROSPECTS: [u64; 3] = [16, 64, 256];

/// Finds the work of adhesion, and on request the effective modulus, of a rough body from curves of different places, each
/// with its name, by comparison with random profiles of the roughness of the scene. Its stiffness of the instrument, its form
/// and its ratio of the works of adhesion are taken as they are; each computed curve has the preload, the points and the
/// noise of one of the curves. `stop` is polled before each computed curve, and `report` receives their number so far.
///
/// # Errors
/// The profile of the scene is not random, a curve lacks an approach or a retraction to the loss of contact, a computation
/// fails, or `stop` returned true.
pub fn fit_ensemble(
    curves: &[(String, MeasuredCurve)],
    document: &Document,
    options: &EnsembleOptions,
    stop: &(dyn Fn() -> bool + Sync),
    report: &(dyn Fn(usize) + Sync),
) -> Result<EnsembleFit, ExperimentError> {
    check(curves, document.scene(), options)?;
    let (document, instrument) = &of_instrument(curves, document)?;
    let measured = Measured::of(curves)?;
    let (_, governing) = Simulation::new(document.resolve("")).contact(document.scene())?;
    let closing = governing.adhesive_works().map_or(1.0, |[closing, opening]| closing / opening);
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
        jobs: options.jobs,
        computed: &computed,
        report,
    };
    let known = (!options.is_modulus_free).then(|| governing.effective_modulus.ln());
    let centre = placed(&workers, &measured, &governing, known)?;
    let from = |centre: f64, index: usize| {
        nodes(centre - 0.5 * (NODES[index] - 1) as f64 * STEPS[index], STEPS[index], NODES[index])
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
    let shifted = |change: &dyn Fn(&mut Roughness, f64)| {
        let at = |sign: f64| {
            let mut scene = Scene::clone(document.scene());
            if let Some(roughness) = &mut scene.roughness {
                change(roughness, sign);
            }
            let others = Workers { specimen: Specimen { scene: &scene, ..workers.specimen }, ..workers };
            let curves = others.curves(options.lines, &[best.range], &[best.modulus])?;
            let of = |(line, curve): (usize, &Vec<Summaries>)| compared.of_line(line, &curve[0], &measured);
            let all: Vec<[f64; 2]> = curves.iter().enumerate().map(of).collect();
            Ok::<_, ExperimentError>(
                [0, 1].map(|index| mean(&all.iter().map(|of| of[index]).collect::<Vec<_>>())),
            )
        };
        let [low, high] = [at(-1.0)?, at(1.0)?];
        // A model whose values are larger needs parameters that make them smaller again.
        Ok::<_, ExperimentError>(response.explain([0, 1].map(|index| low[index] - high[index])))
    };
    let roughness = match document.scene().roughness {
        Some(Roughness::SelfAffine { hurst, .. }) => {
            let [work_by_height, modulus_by_height] =
                shifted(&|roughness, sign| scale_height(roughness, (sign * HEIGHT_STEP).exp()))?
                    .map(|shift| shift / (2.0 * HEIGHT_STEP));
            let step = HURST_STEP.min(0.5 * hurst).min(0.5 * (1.0 - hurst));
            let [work_by_hurst, modulus_by_hurst] = shifted(&|roughness, sign| {
                if let Roughness::SelfAffine { hurst, .. } = roughness {
                    *hurst += sign * step;
                }
            })?
            .map(|shift| shift / (2.0 * step));
            Some(RoughnessShifts { work_by_height, work_by_hurst, modulus_by_height, modulus_by_hurst })
        }
        _ => None,
    };
    let by_roughness = |by_height: f64, by_hurst: f64| {
        let [height, hurst] = [options.height_error, options.hurst_error].map(Option::unwrap_or_default);
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
        Some(modulus) => Estimate::known(modulus.exp()),
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
        work,
        modulus,
        modulus_is_given: known.is_some(),
        closing_over_opening: closing,
        correlation: posterior.correlation(),
        shares: Shares {
            places: square / count / variance / all,
            profiles: square / lines / variance / all,
            roughness: of_roughness[0].powi(2) / all,
        },
        prospects: PROSPECTS.into_iter().filter(|one| *one > curves.len() as u64).map(prospect).collect(),
        roughness,
        instrument: instrument.clone(),
        lines: options.lines,
        computed: computed.load(Ordering::Relaxed),
        preload: mean(&measured.preloads),
        preload_scatter: measured.preload_scatter,
        curves: compared.rows(curves, &measured, best),
        scatter_ratio: compared.scatter_ratio(&measured, best),
        described: deviations.iter().all(|one| !one.deviates),
        deviations,
        at_end_of_table: !posterior.beyond().is_empty(),
    })
}

/// The scene with the stiffness of the instrument that the files state, and what they change, in words.
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
                format!("{name}: a loading stiffness of {other}, and of {one} in {}", curves[0].0),
                "curves of one instrument",
            );
        }
    }
    Ok(first)
}

/// Returns an error for a scene or options with which curves cannot be compared.
fn check(
    curves: &[(String, MeasuredCurve)],
    scene: &Scene,
    options: &EnsembleOptions,
) -> Result<(), ExperimentError> {
    if curves.is_empty() {
        return refused("no curve", "one or more curves");
    }
    if scene.seed().is_none() {
        let allowed = "a scene with random roughness; without --lines a scene whose profile is known";
        return refused("--lines: the profile of the scene is not random", allowed);
    }
    if scene.numerics.solver != Solver::Exact {
        let found = "numerics.solver = Stepwise: a comparison with random profiles needs the exact solver";
        return refused(found, "numerics.solver = Exact");
    }
    if options.lines < FEWEST_LINES {
        return refused(format!("--lines {}", options.lines), format!("at least {FEWEST_LINES}"));
    }
    for (index, (name, curve)) in curves.iter().enumerate() {
        let same = |(_, other): &&(String, MeasuredCurve)| {
            other.force == curve.force && other.displacement == curve.displacement
        };
        if let Some((other, _)) = curves[..index].iter().find(same) {
            return refused(format!("{name}: the same curve as {other}"), "each curve once");
        }
    }
    Ok(())
}

fn scale_height(roughness: &mut Roughness, factor: f64) {
    if let Roughness::SelfAffine { rms_height, rms_gradient, .. } = roughness {
        rms_height.iter_mut().chain(rms_gradient).for_each(|of| *of *= factor);
    }
}

/// The measured curves as far as they are compared.
struct Measured {
    protocols: Vec<Protocol>,
    /// Largest force of each curve, N.
    preloads: Vec<f64>,
    /// Scatter of the preloads over their mean, if they differ.
    preload_scatter: Option<f64>,
    summaries: Vec<Summaries>,
}

impl Measured {
    fn of(curves: &[(String, MeasuredCurve)]) -> Result<Self, ExperimentError> {
        let mut branches = Vec::with_capacity(curves.len());
        for (name, curve) in curves {
            let of = Branches::of(curve).map_err(|error| match error {
                ExperimentError::Refused { found, allowed } => {
                    ExperimentError::Refused { found: format!("{name}: {found}"), allowed }
                }
                error => error,
            })?;
            if of.preload() <= of.noise {
                return refused(
                    format!("{name}: the force at the turning point is not above the noise"),
                    "a preload",
                );
            }
            branches.push(of);
        }
        let noise = median(&mut branches.iter().map(|of| of.noise).collect::<Vec<_>>()).unwrap_or_default();
        let is_alike = |of: &Branches| (of.noise / noise).ln().abs() < ONE_NOISE.ln();
        if branches.iter().all(is_alike) {
            branches.iter_mut().for_each(|of| of.noise = noise);
        }
        let preloads: Vec<f64> = branches.iter().map(Branches::preload).collect();
        let average = mean(&preloads);
        let by_noise = mean(&branches.iter().map(Branches::preload_error).collect::<Vec<_>>());
        let scatter = standard_deviation(&preloads, average);
        let differ = curves.len() > 1 && scatter > DIFFERENT * by_noise;
        let preload_of = |index: usize| if differ { preloads[index] } else { average };
        let of = |(index, branches): (usize, &Branches)| summaries(branches, preload_of(index));
        let summaries = branches.iter().enumerate().map(of).collect();
        let of = |(index, branches): (usize, &Branches)| Protocol::of(branches, preload_of(index));
        let protocols = branches.iter().enumerate().map(of).collect();
        Ok(Measured { protocols, preload_scatter: differ.then(|| scatter / average), preloads, summaries })
    }

    fn mean(&self) -> Mean {
        let of = |index: usize| mean(&self.summaries.iter().map(|of| of[index]).collect::<Vec<_>>());
        Mean { summaries: std::array::from_fn(of), curves: self.summaries.len() }
    }

    /// Summaries with the preload, if the preloads differ.
    fn described(&self, summaries: Summaries, curve: usize) -> Described {
        let preload = self.preload_scatter.map(|_| self.protocols[curve % self.protocols.len()].preload.ln());
        Described { summaries, preload }
    }
}

/// Finds the place whose computed curves have the mean summaries of the measured ones, to about a step of the grid.
fn placed(
    workers: &Workers<'_>,
    measured: &Measured,
    governing: &Governing,
    known: Option<f64>,
) -> Result<Place, ExperimentError> {
    let target = measured.mean().summaries;
    let of_roughness = governing.amplitude.map_or(0.0, |of| of.rms_height * of.rms_gradient);
    let largest = of_roughness.max(f64::MIN_POSITIVE).ln();
    let modulus = governing.effective_modulus.ln();
    let width = |index: usize| (ROUGH_NODES[index] - 1) as f64 * ROUGH_STEPS[index];
    let (mut low, mut soft) = (largest - HIGHEST_KAPPA.powi(2).ln(), modulus - 0.5 * width(1));
    let variance = 1.0 / measured.summaries.len() as f64 + 1.0 / ROUGH_LINES as f64;
    for last in (0..MOST_MOVES).rev() {
        let ranges = nodes(low, ROUGH_STEPS[0], ROUGH_NODES[0]);
        let moduli =
            known.map_or_else(|| nodes(soft, ROUGH_STEPS[1], ROUGH_NODES[1]), |modulus| vec![modulus]);
        let table = Table::new(workers, ROUGH_LINES, ranges, moduli)?;
        let of_summary =
            |index: usize| Scatter::of(&table, |line, node| [table.lines[line][node][index], 0.0]);
        let scatters: Vec<Scatter> = (0..SUMMARIES).map(of_summary).collect();
        let misfit = |place: Place| {
            let of = |(scatter, target): (&Scatter, f64)| {
                let moments = scatter.at(place);
                let square = moments.covariance[0] + LEAST_SCATTER.powi(2);
                (moments.mean[0] - target).powi(2) / square / variance + square.ln()
            };
            scatters.iter().zip(target).map(of).sum::<f64>()
        };
        let within = |axis: &[f64]| {
            let fine = FINE_STEPS * (axis.len() - 1);
            let (first, last) = (axis[0], axis[axis.len() - 1]);
            (0..=fine).map(move |index| first + (last - first) * index as f64 / fine.max(1) as f64).collect()
        };
        let (ranges, moduli): (Vec<f64>, Vec<f64>) = (within(&table.ranges), within(&table.moduli));
        let places =
            ranges.iter().flat_map(|&range| moduli.iter().map(move |&modulus| Place { range, modulus }));
        let misfits = places.map(|place| (misfit(place), place));
        let Some((_, best)) = misfits.min_by(|one, other| one.0.total_cmp(&other.0)) else { break };
        let is_at_end = |axis: &[f64], at: f64, step: f64| {
            axis.len() > 1 && (at - axis[0]).min(axis[axis.len() - 1] - at) < 0.5 * step
        };
        let moved = [
            is_at_end(&table.ranges, best.range, ROUGH_STEPS[0]),
            is_at_end(&table.moduli, best.modulus, ROUGH_STEPS[1]),
        ];
        if moved == [false; 2] || last == 0 {
            return Ok(best);
        }
        if moved[0] {
            low = best.range - 0.5 * width(0);
        }
        if moved[1] {
            soft = best.modulus - 0.5 * width(1);
        }
    }
    Ok(Place { range: low, modulus })
}

/// A table with what was learned from it.
struct Compared {
    polynomials: Learned,
    has_one_modulus: bool,
    /// Learned values of each line at each node.
    learned: Vec<Vec<[f64; 2]>>,
    scatter: Scatter,
    grid: Grid,
    /// Learned values of each measured curve.
    of_curves: Vec<[f64; 2]>,
}

impl Compared {
    fn new(table: &Table, measured: &Measured, known: Option<f64>) -> Self {
        let places: Vec<Place> = table.places().collect();
        let curves: Vec<_> = table
            .lines
            .iter()
            .enumerate()
            .flat_map(|(line, curves)| {
                let of = curves.iter().zip(&places);
                of.map(move |(curve, place)| {
                    (line as u64, measured.described(*curve, line), place.parameters())
                })
            })
            .collect();
        let polynomials = Learned::from(&curves);
        let has_one_modulus = table.moduli.len() == 1;
        let of_line = |(line, described, _): &(u64, Described, [f64; 2])| {
            alone(polynomials.of_line(*line, described), has_one_modulus)
        };
        let learned: Vec<Vec<[f64; 2]>> =
            curves.chunks(places.len()).map(|line| line.iter().map(of_line).collect()).collect();
        let scatter = Scatter::of(table, |line, node| learned[line][node]);
        let grid = Grid::new(table, &scatter, known);
        let of_curve = |(index, curve): (usize, &Summaries)| {
            alone(polynomials.of_curve(&measured.described(*curve, index)), has_one_modulus)
        };
        let of_curves = measured.summaries.iter().enumerate().map(of_curve).collect();
        Compared { polynomials, has_one_modulus, learned, scatter, grid, of_curves }
    }

    fn of_line(&self, line: usize, curve: &Summaries, measured: &Measured) -> [f64; 2] {
        let described = measured.described(*curve, line);
        alone(self.polynomials.of_line(line as u64, &described), self.has_one_modulus)
    }

    fn posterior(&self, measured: &Measured) -> Posterior<'_> {
        let of = |index: usize| mean(&self.of_curves.iter().map(|of| of[index]).collect::<Vec<_>>());
        self.grid.posterior([of(0), of(1)], measured.summaries.len() as f64)
    }

    /// Standard deviation of the curves over that of the lines.
    fn scatter_ratio(&self, measured: &Measured, best: Place) -> Option<f64> {
        let count = self.of_curves.len();
        let inverse = self.scatter.at(best).inverse().0;
        let centre = [0, 1].map(|index| mean(&self.of_curves.iter().map(|of| of[index]).collect::<Vec<_>>()));
        let sum: f64 = self.of_curves.iter().map(|of| distance(centre, inverse, *of)).sum();
        let values = if self.has_one_modulus { 1.0 } else { 2.0 };
        (measured.summaries.len() >= FEWEST_FOR_SCATTER).then(|| (sum / (count as f64 - 1.0) / values).sqrt())
    }

    fn rows(
        &self,
        curves: &[(String, MeasuredCurve)],
        measured: &Measured,
        best: Place,
    ) -> Vec<CurveOfEnsemble> {
        let moments = self.scatter.at(best);
        let inverse = moments.inverse().0;
        let row = |(index, (name, _)): (usize, &(String, MeasuredCurve))| {
            let (of, at) = (measured.summaries[index], self.of_curves[index]);
            let posterior = self.grid.posterior(at, 1.0);
            let away = distance(moments.mean, inverse, at) / (1.0 + 1.0 / self.learned.len() as f64);
            CurveOfEnsemble {
                name: name.clone(),
                preload: measured.preloads[index],
                pull_off_force: Some(of[PULL_OFF].exp())
                    .filter(|force| *force > LEAST_PULL_OFF * measured.protocols[index].noise),
                loop_area: of[LOOP_AREA].exp(),
                stiffness: 0.5 * measured.protocols[index].preload / of[WAY_TO_HALF].exp(),
                work: posterior.estimate(0),
                at_end_of_table: !posterior.beyond().is_empty(),
                foreign: away > FOREIGN[usize::from(!self.has_one_modulus)],
            }
        };
        curves.iter().enumerate().map(row).collect()
    }
}

/// Learned values, of which only the first one counts with one modulus.
fn alone(values: [f64; 2], has_one_modulus: bool) -> [f64; 2] {
    if has_one_modulus { [values[0], 0.0] } else { values }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ensemble::specimens::{curve, document, scene};
    use asperity_scene::Adhesion;

    const OPTIONS: EnsembleOptions =
        EnsembleOptions { lines: 16, is_modulus_free: false, height_error: None, hurst_error: None, jobs: 1 };

    fn found(
        curves: &[(String, MeasuredCurve)],
        scene: &Scene,
        options: EnsembleOptions,
    ) -> Result<EnsembleFit, ExperimentError> {
        fit_ensemble(curves, &document(scene), &options, &|| false, &|_| ())
    }

    /// Rough spheres of 1024 springs; the work of adhesion of the curve with number `foreign` is a fifth.
    fn curves(count: u64, foreign: Option<u64>) -> (Scene, Vec<(String, MeasuredCurve)>) {
        let mut scene = scene("rough-sphere");
        scene.numerics.points = 2048;
        let mut simulation = Simulation::default();
        let one = |seed: u64| {
            let share = if foreign == Some(seed) { 0.2 } else { 1.0 };
            let adhesion = Some(Adhesion::by_work(0.05 * share));
            let scene = Scene { adhesion, ..scene.clone() };
            (format!("place {seed}"), curve(&mut simulation, &scene, 40 + seed, 0.01))
        };
        let curves = (0..count).map(one).collect();
        (scene, curves)
    }

    /// The start of the scene does not matter, nor the number of threads; a place with another work of adhesion is named.
    #[test]
    fn the_work_of_adhesion_is_found_and_a_foreign_place_named() {
        let (scene, all) = curves(12, Some(5));
        let fit = found(&all, &scene, OPTIONS).unwrap();
        let foreign: Vec<&str> =
            fit.curves.iter().filter(|curve| curve.foreign).map(|curve| curve.name.as_str()).collect();
        assert_eq!(foreign, ["place 5"]);
        let others: Vec<_> = all.iter().filter(|(name, _)| name != "place 5").cloned().collect();
        let fit = found(&others, &scene, OPTIONS).unwrap();
        let Estimate { low, high, .. } = fit.work;
        assert!(low < 0.05 && 0.05 < high && high / low < 2.5, "{:?}", fit.work);
        assert!(fit.described && !fit.at_end_of_table && fit.preload_scatter.is_none(), "{fit:?}");
        assert!((fit.shares.places + fit.shares.profiles - 1.0).abs() < 1e-12 && fit.shares.roughness == 0.0);
        // More height needs more adhesion.
        let shifts = fit.roughness.unwrap();
        assert!((0.3..3.0).contains(&shifts.work_by_height), "{shifts:?}");
        let other = Scene { adhesion: Some(Adhesion::by_work(0.3)), ..scene.clone() };
        let same = found(&others, &other, EnsembleOptions { jobs: 3, ..OPTIONS }).unwrap();
        assert_eq!(same, fit);
        let stated = EnsembleOptions { height_error: Some(0.1), hurst_error: Some(0.0), ..OPTIONS };
        let wider = found(&others, &scene, stated).unwrap();
        let added = NORMAL * 0.1 * shifts.work_by_height;
        assert!((wider.work.half_width() - fit.work.half_width().hypot(added)).abs() < 0.02 * added);
    }

    #[test]
    fn curves_that_cannot_be_compared_are_refused() {
        let (scene, all) = curves(2, None);
        let smooth = Scene { roughness: None, ..scene.clone() };
        let turned = all[0].1.segment.partition_point(|segment| *segment == 0);
        let cut = |from: usize, to: usize| {
            let mut curve = all[0].1.clone();
            for values in [&mut curve.displacement, &mut curve.force] {
                *values = values[from..to].to_vec();
            }
            curve.segment = curve.segment[from..to].to_vec();
            vec![("cut".to_owned(), curve)]
        };
        let few = EnsembleOptions { lines: 8, ..OPTIONS };
        let twice = vec![all[0].clone(), ("again".to_owned(), all[0].1.clone())];
        for (result, said) in [
            (found(&all, &smooth, OPTIONS), "the profile of the scene is not random"),
            (found(&[], &scene, OPTIONS), "no curve"),
            (found(&all, &scene, few), "--lines 8"),
            (found(&twice, &scene, OPTIONS), "again: the same curve as place 0"),
            (
                found(&cut(0, turned + 120), &scene, OPTIONS),
                "cut: the retraction ends before contact is lost",
            ),
            (found(&cut(turned, 2 * turned), &scene, OPTIONS), "cut: no approach and retraction"),
        ] {
            let error = result.unwrap_err().to_string();
            assert!(error.contains(said) && error.contains("allowed: "), "{said}: {error}");
        }
        let stopped = fit_ensemble(&all, &document(&scene), &OPTIONS, &|| true, &|_| ());
        assert!(matches!(stopped, Err(ExperimentError::Run(_))));
    }
}
