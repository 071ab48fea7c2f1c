//! The parameters of a scene that describe a measured curve, their errors, and those that the curve does not separate.

use super::baseline::{dot, ends};
use super::model::Model;
use super::parameter::{Coordinate, Free, Parameter, Values};
use super::population::WRONG_SIDE;
use super::scene::{most_on_closing, radius_of, values_of, with_values, written_out, wrong};
use super::search::{MISFIT, Search, Space};
use super::statistics::{block_error, correlated, correlation, spread, widen};
use super::{ExperimentError, MeasuredCurve, refused};
use crate::parallel::on_threads;
use crate::scene::{Document, Solver, format_quantity, format_range, format_within};
use crate::simulation::Simulation;
use std::f64::consts::PI;

/// Factor from the start to the ends of a range that is not given.
const FACTOR: f64 = 30.0;
/// Pull-off force of a smooth body over that of the curve up to which the coordinate of the work of adhesion is linear, if the
/// noise does not hide more.
const LINEAR: f64 = 0.01;
/// Forces, N, and displacements, m, beyond those of any instrument.
const MOST: [f64; 2] = [1e9, 1e6];
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

impl FittedParameter {
    /// A value of the parameter with the digits that its interval determines.
    pub fn text(&self, value: f64) -> String {
        format_within(value, 0.5 * (self.interval.1 - self.interval.0), self.parameter.row().3)
    }
}

/// Result of a fit.
#[derive(Clone, Debug, PartialEq)]
pub struct Fit {
    /// The free parameters with their errors.
    pub parameters: Vec<FittedParameter>,
    /// Root mean square residual, N.
    pub residual: f64,
    /// Residual over the noise.
    pub residual_over_noise: f64,
    /// Share of the points where the residual exceeds 5 times the noise.
    pub beyond_five_sigma: f64,
    /// Root mean square residual in contact over the noise, where single points on the wrong side of a jump count as 5 times
    /// that root mean square.
    pub misfit: f64,
    /// Upper end of the interval of the work of adhesion, J/m², if a curve without adhesion describes the measured one as well.
    pub work_at_most: Option<f64>,
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
/// Options and values of the curve beyond what is allowed, parameters that the scene does not have, a failure of the
/// computation, or a stop.
pub fn fit(
    curve: &MeasuredCurve,
    document: &Document,
    options: &FitOptions,
    stop: &(dyn Fn() -> bool + Sync),
    report: &mut dyn FnMut(usize),
) -> Result<Fit, ExperimentError> {
    check_curve(curve)?;
    check_options(options)?;
    let mut simulation = Simulation::new(document.resolve(""));
    let (document, space) = prepare(curve, document, &mut simulation, options, stop)?;
    let model = Model::new(curve, document.scene(), &mut simulation);
    let mut search = Search { space: &space, model, report, lines: space.lines() };
    let found = search.find()?;
    let (rests, evaluations) =
        (search.refined(&found.best.rests, WRONG_SIDE * found.noise), search.model.evaluations);
    let others = other_profiles(&document, options, &space)?;
    let values = space.values(&found.best.at);
    let of_samples = |samples: &[Vec<f64>], one: &Coordinate| -> Vec<f64> {
        samples.iter().map(|at| space.values(at)[one.parameter as usize]).collect()
    };
    let by_blocks = |one: &Coordinate| block_error(&of_samples(&found.samples, one), &found.blocks);
    let correlation_factor = correlated(&rests);
    let mut samples = found.samples.clone();
    widen(&mut samples, correlation_factor.sqrt());
    let is_without_adhesion = found.without_adhesion < 0.5 * NORMAL * NORMAL * correlation_factor;
    let fitted = |one: &Coordinate| {
        let of = |values: &Values| values[one.parameter as usize];
        let (noise_error, (low, high)) = spread(of_samples(&samples, one));
        let noise_error = noise_error.max(by_blocks(one));
        let over_profiles = || spread(others.iter().chain([&values]).map(of).collect()).0;
        let profile_error = (!others.is_empty()).then(over_profiles);
        // The profile of the specimen is one draw, and that of the scene another one.
        let error = (2.0 * profile_error.unwrap_or(0.0).powi(2) + noise_error.powi(2)).sqrt();
        let (value, half) = (of(&values), NORMAL * error);
        let least = if one.parameter.is_signed() { f64::NEG_INFINITY } else { 0.0 };
        let is_bound = one.parameter == Parameter::Work && is_without_adhesion;
        let low = if is_bound { 0.0 } else { low.min(value - half).max(least) };
        let Coordinate { parameter, start, range, .. } = *one;
        let interval = (low, high.max(value + half));
        FittedParameter { parameter, start, range, value, interval, noise_error, profile_error }
    };
    let parameters: Vec<FittedParameter> = space.coordinates.iter().map(fitted).collect();
    let name = |index: usize| space.coordinates[index].parameter;
    let count = parameters.len();
    let pairs = (0..count).flat_map(|one| (one + 1..count).map(move |other| [one, other]));
    let correlations: Vec<_> =
        pairs.map(|pair| (name(pair[0]), name(pair[1]), correlation(&samples, pair))).collect();
    let alike = correlations.iter().filter(|(.., value)| value.abs() > CORRELATED);
    let mut not_distinguished: Vec<_> = alike.map(|&(one, other, _)| (one, other)).collect();
    for (index, coordinate) in space.coordinates.iter().enumerate() {
        let (low, high) = coordinate.ends();
        let (_, (from, to)) = spread(samples.iter().map(|at| at[index]).collect());
        let is_wide = !coordinate.parameter.is_signed() && 0.5 * (to - from) > FLAT;
        let is_at_end = (from - low).min(high - to) < 0.01 * (to - from)
            || is_without_adhesion && coordinate.parameter == Parameter::Work;
        let is_named = not_distinguished.iter().any(|&(one, other)| [one, other].contains(&name(index)));
        if !is_named && (is_wide || is_at_end) {
            not_distinguished.push((name(index), name(index)));
        }
    }
    let work = parameters.iter().find(|one| one.parameter == Parameter::Work);
    let work_at_most = work.filter(|_| is_without_adhesion).map(|work| work.interval.1);
    let model =
        curve.force.iter().zip(&rests).map(|(measured, rest)| measured - rest * curve.noise).collect();
    let is_free = |parameter| space.coordinates.iter().any(|one| one.parameter == parameter);
    let residual_over_noise = (dot(&rests, &rests) / rests.len() as f64).sqrt();
    let beyond = rests.iter().filter(|rest| rest.abs() > 5.0).count();
    Ok(Fit {
        parameters,
        residual: curve.noise * residual_over_noise,
        residual_over_noise,
        beyond_five_sigma: beyond as f64 / rests.len() as f64,
        misfit: space.misfit(&rests),
        work_at_most,
        correlations,
        not_distinguished,
        evaluations,
        model,
        document: with_values(&document, &values, is_free, curve)?,
    })
}

/// Checks the values of a curve, which a caller may have changed.
fn check_curve(curve: &MeasuredCurve) -> Result<(), ExperimentError> {
    let quantities = [(&curve.force, "force", "N"), (&curve.displacement, "displacement", "m")];
    for ((values, name, unit), most) in quantities.into_iter().zip(MOST) {
        if let Some((index, value)) = values.iter().enumerate().find(|(_, value)| !(value.abs() <= most)) {
            let fault = format!("{name} of point {} = {}", index + 1, format_quantity(*value, unit));
            return refused(fault, format_range((-most, most), 1, unit));
        }
    }
    if !(curve.noise > 0.0 && curve.noise.is_finite()) {
        return refused(format!("noise = {}", format_quantity(curve.noise, "N")), "a force above 0");
    }
    Ok(())
}

fn check_options(options: &FitOptions) -> Result<(), ExperimentError> {
    let FitOptions { free, lines, jobs } = options;
    if free.is_empty() {
        let names = Parameter::ALL.map(Parameter::name).join(", ");
        return refused("no free parameter", format!("one or more of {names}"));
    }
    for (index, Free { parameter, range }) in free.iter().enumerate() {
        let name = parameter.name();
        if free[..index].iter().any(|other| other.parameter == *parameter) {
            return refused(format!("{name} is free twice"), "each parameter once");
        }
        if let Some((low, high)) = range.filter(|range| !parameter.allows(*range)) {
            return refused(format!("range of {name} = {low:e}..{high:e}"), parameter.ranges());
        }
    }
    for (name, count) in [("lines", *lines), ("jobs", *jobs as u64)] {
        if count == 0 {
            return refused(format!("{name} = 0"), "1 or more");
        }
    }
    Ok(())
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
    // Work of adhesion of a smooth body with this pull-off force.
    let smooth = |force: f64, modulus: f64| {
        let of_sphere = radius.map(|radius| force / (1.5 * PI * radius));
        let of_flat = force.powi(2) / (PI * modulus * scene.length.powi(3));
        of_sphere.into_iter().chain([of_flat]).find(|work| work.is_finite() && *work > 0.0).unwrap_or(0.05)
    };
    let pull_off = curve.noise.max(-low);
    let (_, governing) = simulation.contact(scene)?;
    let of_curve = smooth(pull_off, governing.effective_modulus);
    let least_work = smooth(curve.noise.max(LINEAR * pull_off), governing.effective_modulus);
    let work = is_free(Parameter::Work).then_some(of_curve);
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
            Parameter::Work => (0.0, start.max(of_curve) * FACTOR),
            Parameter::ClosingWork if is_free(Parameter::Work) => {
                (0.0, base[Parameter::Work as usize].max(of_curve) * FACTOR)
            }
            Parameter::ClosingWork => (0.0, base[Parameter::Work as usize]),
            _ => (start / FACTOR, start * FACTOR),
        });
        let start = start.clamp(range.0, range.1);
        base[parameter as usize] = start;
        let unit = match parameter {
            Parameter::Work => least_work,
            // A tenth of the change that the parameter makes at most.
            Parameter::Zero => 0.1 * (high - low),
            _ => 0.1 * (turn - touch),
        };
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
