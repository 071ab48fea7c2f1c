//! The parameters of a scene that describe a measured curve, their errors, and those that the curve does not separate.

use super::baseline::{dot, ends};
use super::model::Model;
use super::parameter::{Coordinate, Free, Parameter, Values};
use super::scene::{most_on_closing, radius_of, values_of, with_values, written_out, wrong};
use super::search::{Search, Space, WRONG_SIDE};
use super::statistics::{correlated, correlation, spread, widen};
use super::{ExperimentError, MeasuredCurve, refused};
use crate::parallel::on_threads;
use crate::scene::{Document, Solver};
use crate::simulation::Simulation;
use std::f64::consts::PI;

/// Factor from the start to the ends of a range that is not given.
const FACTOR: f64 = 30.0;
/// Residual in contact, in units of the noise, of a model that does not describe the curve.
const MISFIT: f64 = 1.5;
/// Correlation of parameters that are not separated, and half width of the 95 % interval of a logarithm that is flat.
const CORRELATED: f64 = 0.95;
const FLAT: f64 = 1.0;
/// Standard deviations of the 95 % interval of a normal distribution.
const NORMAL: f64 = 1.96;

/// Options of a fit.
#[derive(Clone, Debug, PartialEq)]
pub struct FitOptions {
    /// Parameters to be found.
    pub free: Vec<Free>,
    /// Random profiles on which the fit is repeated; 1: that of the scene alone.
    pub lines: u64,
    /// Threads that share the profiles.
    pub jobs: usize,
}

/// A parameter with its errors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FittedParameter {
    /// The parameter.
    pub parameter: Parameter,
    /// Value before the fit, in SI units as all values.
    pub start: f64,
    /// Range in which the value was looked for.
    pub range: (f64, f64),
    /// Value of the least residuals.
    pub value: f64,
    /// Ends of the 95 % interval.
    pub interval: (f64, f64),
    /// Standard error by the noise.
    pub noise_error: f64,
    /// Standard deviation over random profiles.
    pub profile_error: Option<f64>,
}

/// Result of a fit.
#[derive(Clone, Debug, PartialEq)]
pub struct Fit {
    /// The free parameters with their errors.
    pub parameters: Vec<FittedParameter>,
    /// Root mean square residual, N.
    pub residual: f64,
    /// Root mean square residual in contact over the noise; a point on the wrong side of a jump counts as 5 times the noise.
    pub misfit: f64,
    /// Correlation of each pair of parameters.
    pub correlations: Vec<(Parameter, Parameter, f64)>,
    /// Pairs that the curve does not separate; one parameter twice that the curve does not determine.
    pub not_distinguished: Vec<(Parameter, Parameter)>,
    /// Number of computed curves.
    pub evaluations: usize,
    /// Force of the model at each point with the zero and the drift of the curve, which are refined with the model, N.
    pub model: Vec<f64>,
    /// The scene with the values found, loaded as the curve was.
    pub document: Document,
}

impl Fit {
    /// Returns false for a model that does not describe the curve.
    pub fn describes(&self) -> bool {
        self.misfit <= MISFIT
    }
}

/// Fits parameters of a scene to a curve. `stop` is polled before each computed curve, and `report` receives their number.
///
/// # Errors
/// Parameters that the scene does not have, a failure of the computation, or a stop.
pub fn fit(
    curve: &MeasuredCurve,
    document: &Document,
    options: &FitOptions,
    stop: &(dyn Fn() -> bool + Sync),
    report: &mut dyn FnMut(usize),
) -> Result<Fit, ExperimentError> {
    let mut simulation = Simulation::new(document.resolve(""));
    let (document, space) = prepare(curve, document, &mut simulation, options, stop)?;
    let model = Model::new(curve, document.scene(), &mut simulation);
    let mut search = Search { space: &space, model, report, lines: space.lines() };
    let (best, mut samples) = search.find()?;
    let (rests, evaluations) = (search.refined(&best.rests, WRONG_SIDE), search.model.evaluations);
    let others = other_profiles(&document, options, &space)?;
    widen(&mut samples, correlated(&rests).sqrt());
    let values = space.values(&best.at);
    let sampled: Vec<Values> = samples.iter().map(|at| space.values(at)).collect();
    let fitted = |one: &Coordinate| {
        let of = |values: &Values| values[one.parameter as usize];
        let (noise_error, (low, high)) = spread(sampled.iter().map(of).collect());
        let over_profiles = || spread(others.iter().chain([&values]).map(of).collect()).0;
        let profile_error = (!others.is_empty()).then(over_profiles);
        // The profile of the specimen is one draw, and that of the scene another one.
        let error = (2.0 * profile_error.unwrap_or(0.0).powi(2) + noise_error.powi(2)).sqrt();
        let (value, half) = (of(&values), NORMAL * error);
        let least = if one.parameter.is_signed() { f64::NEG_INFINITY } else { 0.0 };
        let interval = (low.min(value - half).max(least), high.max(value + half));
        let Coordinate { parameter, start, range, .. } = *one;
        FittedParameter { parameter, start, range, value, interval, noise_error, profile_error }
    };
    let parameters: Vec<FittedParameter> = space.coordinates.iter().map(fitted).collect();
    let name = |index: usize| space.coordinates[index].parameter;
    let pairs = (0..best.at.len()).flat_map(|one| (one + 1..best.at.len()).map(move |other| [one, other]));
    let correlations: Vec<_> =
        pairs.map(|pair| (name(pair[0]), name(pair[1]), correlation(&samples, pair))).collect();
    let alike = correlations.iter().filter(|(.., value)| value.abs() > CORRELATED);
    let mut not_distinguished: Vec<_> = alike.map(|&(one, other, _)| (one, other)).collect();
    for (index, coordinate) in space.coordinates.iter().enumerate() {
        let (low, high) = coordinate.ends();
        let (_, (from, to)) = spread(samples.iter().map(|at| at[index]).collect());
        let is_wide = !coordinate.parameter.is_signed() && 0.5 * (to - from) > FLAT;
        let is_at_end = (from - low).min(high - to) < 0.01 * (to - from);
        let is_named = not_distinguished.iter().any(|&(one, other)| [one, other].contains(&name(index)));
        if !is_named && (is_wide || is_at_end) {
            not_distinguished.push((name(index), name(index)));
        }
    }
    let model =
        curve.force.iter().zip(&rests).map(|(measured, rest)| measured - rest * curve.noise).collect();
    let is_free = |parameter| space.coordinates.iter().any(|one| one.parameter == parameter);
    Ok(Fit {
        parameters,
        residual: curve.noise * (dot(&rests, &rests) / rests.len() as f64).sqrt(),
        misfit: space.misfit(&rests),
        correlations,
        not_distinguished,
        evaluations,
        model,
        document: with_values(&document, &values, is_free, curve)?,
    })
}

/// Checks parameters and scene; returns the document with a work of adhesion, and the coordinates of the fit.
fn prepare<'a>(
    curve: &'a MeasuredCurve,
    document: &Document,
    simulation: &mut Simulation,
    options: &FitOptions,
    stop: &'a (dyn Fn() -> bool + Sync),
) -> Result<(Document, Space<'a>), ExperimentError> {
    let scene = document.scene();
    if scene.numerics.solver != Solver::Exact {
        return refused(
            "numerics.solver = Stepwise: a fit needs the exact solver",
            "numerics.solver = Exact",
        );
    }
    if options.lines > 1 && scene.seed().is_none() {
        return refused("--lines: the scene has no random profile", "a scene with random roughness");
    }
    let is_free = |parameter| options.free.iter().any(|free| free.parameter == parameter);
    let radius = radius_of(scene);
    if is_free(Parameter::Radius) && radius.is_none() {
        return refused("radius: the form of the scene has none", "form = Paraboloid, WavySphere or Punch");
    }
    let (low, high) = ends(curve.force.iter().copied());
    // Of a smooth body with the same pull-off force.
    let start = |modulus: f64| {
        let of_sphere = radius.map(|radius| -low / (1.5 * PI * radius));
        let of_flat = low.powi(2) / (PI * modulus * scene.length.powi(3));
        of_sphere.into_iter().chain([of_flat]).find(|work| work.is_finite() && *work > 0.0).unwrap_or(0.05)
    };
    let (_, governing) = simulation.contact(scene)?;
    let work = is_free(Parameter::Work).then(|| start(governing.effective_modulus));
    let document = written_out(document, &governing, work).map_err(wrong)?;
    let (_, governing) = simulation.contact(document.scene())?;
    if is_free(Parameter::ClosingWork) && governing.adhesive_work().is_none() {
        return refused(
            format!("{}: the scene has no adhesion", Parameter::ClosingWork.name()),
            "adhesion.work above 0, or a free work of adhesion too",
        );
    }
    let mut base = values_of(document.scene(), &governing);
    let (touch, turn) = (curve.touch, curve.turns()[0]);
    base[Parameter::Offset as usize] = touch;
    let stiffness = &mut base[Parameter::Stiffness as usize];
    if is_free(Parameter::Stiffness) && stiffness.is_infinite() {
        *stiffness = 10.0 * (high - low) / (turn - touch).max(f64::MIN_POSITIVE);
    }
    let mut coordinates = Vec::new();
    for parameter in Parameter::ALL.into_iter().filter(|&parameter| is_free(parameter)) {
        let start = base[parameter as usize];
        let given =
            options.free.iter().filter(|free| free.parameter == parameter).find_map(|free| free.range);
        let range = given.unwrap_or_else(|| match parameter {
            Parameter::Offset => (ends(curve.displacement.iter().copied()).0, turn),
            Parameter::Zero => (low - high, high - low),
            Parameter::ClosingWork => (0.0, base[Parameter::Work as usize] * FACTOR),
            _ => (start / FACTOR, start * FACTOR),
        });
        let start = start.clamp(range.0, range.1);
        base[parameter as usize] = start;
        // A tenth of the change that the parameter makes at most.
        let unit = 0.1 * if parameter == Parameter::Zero { high - low } else { turn - touch };
        coordinates.push(Coordinate { parameter, start, range, unit });
    }
    let most_on_closing = most_on_closing(document.scene());
    Ok((document, Space { base, coordinates, most_on_closing, curve, stop }))
}

/// Values of fits of the same curve on the other random profiles of the scene.
fn other_profiles(
    document: &Document,
    options: &FitOptions,
    space: &Space<'_>,
) -> Result<Vec<Values>, ExperimentError> {
    let worker = || {
        let mut simulation = Simulation::new(document.resolve(""));
        move |number: u64| {
            let seed = document.scene().seed().unwrap_or_default().wrapping_add(number + 1);
            let model = Model::new(space.curve, &document.scene().with_seed(seed), &mut simulation);
            let mut search = Search { space, model, report: &mut |_| (), lines: space.lines() };
            Ok(space.values(&search.roughly()?))
        }
    };
    on_threads(options.lines.saturating_sub(1), options.jobs, worker)
}

#[cfg(test)]
mod tests {
    use super::super::options::{CurveOptions, Drift};
    use super::*;
    use crate::contact::CurvePoint;
    use crate::scene::{Adhesion, Material, Move, Scene, open};
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;
    use std::fmt::Write;

    /// Scene and disturbances from which a curve is made.
    struct Made {
        scene: Scene,
        offset: f64,
        noise: f64,
        drift: f64,
    }

    fn stiffness(scene: &Scene) -> f64 {
        scene.loading_stiffness.unwrap()
    }

    /// Displacements and forces at 500 almost evenly spaced displacements of approach and of retraction: points of a fine curve
    /// at which d + F/k first goes so far.
    fn force_curve(scene: &Scene) -> Vec<(f64, f64)> {
        let mut fine = scene.clone();
        fine.numerics.samples = 1 << 18;
        let fine = fine.checked().unwrap();
        let outcome = Simulation::default().run(&fine, &|| false, &mut |_, _, _| Ok(())).unwrap();
        let legs = &outcome.history.legs;
        let base = |point: &CurvePoint| point.indentation + point.force / stiffness(scene);
        let top = legs[0].curve.iter().map(base).fold(f64::MIN, f64::max);
        let low = -0.5 * top - legs[1].curve.iter().map(|point| base(point).abs()).fold(0.0, f64::max);
        let mut points = Vec::new();
        for (leg, sign) in legs.iter().zip([1.0, -1.0]) {
            let mut at = 0;
            for index in 0..500 {
                let share = index as f64 / 499.0;
                let wanted = if sign > 0.0 { low + share * (top - low) } else { top + share * (low - top) };
                while at < leg.curve.len() && sign * base(&leg.curve[at]) < sign * wanted {
                    at += 1;
                }
                let last = if sign > 0.0 { leg.curve.last() } else { None };
                points.push(match leg.curve.get(at).or(last).filter(|_| sign < 0.0 || wanted > 0.0) {
                    Some(point) => (base(point), point.force),
                    None => (wanted, 0.0),
                });
            }
        }
        points
    }

    /// Noise of the force at each point, N.
    fn noise(made: &Made, seed: u64) -> Vec<f64> {
        let mut generator = ChaCha8Rng::seed_from_u64(seed);
        let mut gauss = || {
            let [one, other]: [f64; 2] = [generator.random(), generator.random()];
            made.noise * (-2.0 * (1.0 - one).ln()).sqrt() * (std::f64::consts::TAU * other).cos()
        };
        (0..1000).map(|_| gauss()).collect()
    }

    /// The curve with noise, drift, an offset and a zero, in nm and µN.
    fn measured(made: &Made, seed: u64) -> MeasuredCurve {
        let (noise, mut text) = (noise(made, seed), "displacement [nm],force [uN]\n".to_owned());
        for (index, (displacement, force)) in force_curve(&made.scene).into_iter().enumerate() {
            let force = force + noise[index] + made.drift * index as f64 / 1000.0 + 3e-7;
            writeln!(text, "{},{}", (displacement + made.offset) * 1e9, force * 1e6).unwrap();
        }
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("curve.csv");
        std::fs::write(&path, &text).unwrap();
        MeasuredCurve::read(&path, &CurveOptions { drift: Drift::Remove, ..CurveOptions::default() }).unwrap()
    }

    /// A smooth or a rough sphere on a compliant instrument, with noise of 1 % of its pull-off force.
    fn random(seed: u64, points: u64) -> Made {
        let mut generator = ChaCha8Rng::seed_from_u64(seed);
        let mut between = |low: f64, high: f64| low * (high / low).powf(generator.random::<f64>());
        let name = if seed.is_multiple_of(2) { "jkr-sphere" } else { "rough-sphere" };
        let mut scene = Scene::clone(open(name).unwrap().scene());
        scene.numerics.points = points;
        scene.set_seed(seed);
        let (modulus, work) = (2.7e6 * between(0.5, 2.0), 0.05 * between(0.5, 2.0));
        (scene.material, scene.adhesion) = (Material::effective(modulus), Some(Adhesion::by_work(work)));
        let radius = radius_of(&scene).unwrap();
        scene.loading = vec![Move::ToForce(1.5 * PI * work * radius * between(1.0, 4.0)), Move::ToSeparation];
        // Contact radius at pull-off of a sphere.
        let contact = (radius * radius * 9.0 * PI * work / (8.0 * modulus)).cbrt();
        scene.loading_stiffness = Some(2.0 * modulus * contact * between(0.5, 10.0));
        let outcome = Simulation::default()
            .run(&scene.clone().checked().unwrap(), &|| false, &mut |_, _, _| Ok(()))
            .unwrap();
        let force = outcome.figures.adhesion_force.unwrap();
        Made { scene, offset: 1e-6 * between(0.1, 1.0), noise: 0.01 * force, drift: 0.1 * force }
    }

    fn truth(made: &Made, parameter: Parameter) -> f64 {
        match parameter {
            Parameter::Work => made.scene.adhesion.unwrap().work.unwrap(),
            Parameter::Modulus => made.scene.material.effective_modulus(),
            Parameter::Offset => made.offset,
            Parameter::Stiffness => stiffness(&made.scene),
            _ => 0.0,
        }
    }

    /// The fit of free parameters that begin far from the truth.
    fn fitted(curve: &MeasuredCurve, made: &Made, free: &str) -> Fit {
        let mut scene = made.scene.clone();
        scene.adhesion = Some(Adhesion::by_work(3.0 * truth(made, Parameter::Work)));
        if free.contains("modulus") {
            scene.material = Material::effective(0.5 * truth(made, Parameter::Modulus));
        }
        if free.contains("stiffness") {
            scene.loading_stiffness = Some(3.0 * stiffness(&made.scene));
        }
        let document = Document::from_scene(&scene, "made").unwrap();
        let free = free.split(',').map(|one| one.parse().unwrap()).collect();
        fit(curve, &document, &FitOptions { free, lines: 1, jobs: 1 }, &|| false, &mut |_| ()).unwrap()
    }

    /// Free parameters of the fit of a seed.
    fn free(seed: u64) -> &'static str {
        let free = [
            "work,modulus,offset",
            "work,offset",
            "work,modulus,offset,zero",
            "work,modulus,offset,stiffness",
        ];
        free[(seed / 2 % 4) as usize]
    }

    /// Smooth spheres have even seeds, rough ones odd seeds: of 12 curves, or 200 with `TEST_EFFORT=200`.
    #[test]
    #[ignore = "fits of many curves take ten seconds or more"]
    fn intervals_hold_the_truth_of_most_spheres() {
        let effort = std::env::var("TEST_EFFORT").ok().and_then(|effort| effort.parse().ok());
        let (mut intervals, mut seconds) = (Vec::new(), Vec::new());
        for seed in 0..effort.unwrap_or(12).clamp(12, 200) {
            let made = random(seed, 4096);
            let curve = measured(&made, seed);
            let clock = std::time::Instant::now();
            let fit = fitted(&curve, &made, free(seed));
            seconds.push(clock.elapsed().as_secs_f64());
            // The zero of the reading is off by the mean of the noise before contact.
            let zero = -noise(&made, seed)[..curve.free].iter().sum::<f64>() / curve.free as f64;
            for one in &fit.parameters {
                let is_zero = one.parameter == Parameter::Zero;
                let truth = if is_zero { zero } else { truth(&made, one.parameter) };
                let holds = one.interval.0 <= truth && truth <= one.interval.1;
                intervals.push((["smooth", "rough"][(seed % 2) as usize], one.parameter, holds));
                if !holds {
                    println!("{seed}: {one:?}, truth {truth:e}, misfit {:.3}", fit.misfit);
                }
            }
        }
        let counts = |parameter: Option<Parameter>| {
            ["smooth", "rough"].map(|kind| {
                let is_of =
                    |one: &&(&str, Parameter, bool)| one.0 == kind && parameter.is_none_or(|of| of == one.1);
                let of = || intervals.iter().filter(is_of);
                (of().filter(|one| one.2).count(), of().count())
            })
        };
        let row = |parameter: Parameter| {
            let [smooth, rough] = counts(Some(parameter)).map(|(held, all)| format!("{held} of {all}"));
            format!("| {} | {smooth} | {rough} |\n", parameter.row().1)
        };
        let tried = Parameter::ALL.into_iter().filter(|one| counts(Some(*one))[0].1 > 0);
        let share = |held: usize, all: usize| held as f64 / all as f64;
        let all = counts(None);
        let [smooth, rough] =
            all.map(|(held, all)| format!("{held} of {all}, {:.1} %", 100.0 * share(held, all)));
        let table = format!("{}| all | {smooth} | {rough} |\n", tried.map(row).collect::<String>());
        let (mean, longest) =
            (seconds.iter().sum::<f64>() / seconds.len() as f64, seconds.iter().copied().fold(0.0, f64::max));
        println!("{table}{mean:.2} s for a fit, {longest:.2} s at most");
        assert!(share(all[0].0 + all[1].0, all[0].1 + all[1].1) >= 0.93);
        assert!(seconds.len() < 200 || include_str!("../../docs/experiment.md").contains(&table));
    }

    /// Asserts that the values differ from the truth by a few standard errors at most, and that the residuals are those of the
    /// noise.
    fn assert_found(made: &Made, fit: &Fit) {
        assert!(fit.describes() && fit.misfit < 1.1, "{}", fit.misfit);
        for one in &fit.parameters {
            let truth = truth(made, one.parameter);
            assert!((one.value - truth).abs() < 4.0 * one.noise_error, "{one:?}: {truth:e}");
            assert!(one.noise_error < 0.02 * truth, "{one:?}");
        }
    }

    /// The force of a rough sphere jumps at many displacements.
    #[test]
    fn a_rough_sphere_is_found_within_its_errors() {
        let made = random(11, 1024);
        let curve = measured(&made, 11);
        assert_found(&made, &fitted(&curve, &made, "work,offset"));
    }

    #[test]
    fn a_sphere_is_found_within_its_errors_and_written_into_its_scene() {
        let made = random(4, 512);
        let curve = measured(&made, 4);
        let fit = fitted(&curve, &made, "work,modulus,offset");
        assert_found(&made, &fit);
        let scene = fit.document.scene();
        assert_eq!(scene.adhesion.unwrap().work, Some(fit.parameters[0].value));
        assert!(matches!(scene.loading[..], [Move::ToDisplacement(at), Move::ToSeparation] if at > 0.0));
        // A wrong stiffness does not describe the curve, and says so.
        let mut wrong = made;
        wrong.scene.loading_stiffness = Some(0.2 * stiffness(&wrong.scene));
        assert!(!fitted(&curve, &wrong, "work,offset").describes());
    }
}
