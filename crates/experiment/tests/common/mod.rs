//! Test curves of scenes with known values.

#![allow(dead_code, reason = "each executable of tests uses a part")]

pub(crate) mod bodies;
#[path = "../../../../tests/common/effort.rs"]
mod effort;
pub(crate) mod specimens;
pub(crate) mod sphere;

use asperity_contact::{CurvePoint, Move, StageRecord};
use asperity_data::Control;
use asperity_experiment::{CurveOptions, Drift, Fit, FitResult, Free, MeasuredCurve, Parameter};
use asperity_scene::{Adhesion, Document, Material, Scene, Simulation, open};
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use std::f64::consts::PI;
use std::path::Path;

/// Scene and disturbances from which a test curve is made.
pub(crate) struct Made {
    pub scene: Scene,
    pub offset: f64,
    pub noise: f64,
    pub drift: f64,
}

/// Number of cases of a slow test: `quick`, times `TEST_EFFORT` of the environment, and at most
/// `most`.
pub(crate) fn cases(quick: u32, most: u64) -> u64 {
    u64::from(effort::cases(quick)).min(most)
}

/// Seed of the first case of a slow test: `TEST_SEED` of the environment, or 0. Another seed draws
/// cases that no result has been judged by.
pub(crate) fn first_seed() -> u64 {
    let seed = std::env::var("TEST_SEED").ok();
    seed.and_then(|seed| seed.parse().ok()).unwrap_or(0)
}

pub(crate) fn stiffness(scene: &Scene) -> f64 {
    scene.loading_stiffness.unwrap()
}

/// Returns displacements in m and forces in N at 500 almost evenly spaced displacements of approach
/// and retraction. They are the points of a fine curve at which d + F/k first reaches these
/// displacements.
pub(crate) fn force_curve(scene: &Scene) -> Vec<(f64, f64)> {
    let mut fine = scene.clone();
    fine.numerics.samples = 1 << 18;
    let fine = fine.checked().unwrap();
    let outcome = Simulation::default()
        .run(&fine, &|| false, &mut |_, _, _| Ok(()))
        .unwrap();
    let stages = &outcome.history.stages;
    let base = |point: &CurvePoint| displacement(point, stiffness(scene));
    let top = stages[0].curve.iter().map(base).fold(f64::MIN, f64::max);
    let low = -0.5 * top
        - stages[1]
            .curve
            .iter()
            .map(|point| base(point).abs())
            .fold(0.0, f64::max);
    sampled(stages, stiffness(scene), low, top, 500)
}

/// Displacement d + F/k in m of a point, for a stiffness k in N/m.
pub(crate) fn displacement(point: &CurvePoint, stiffness: f64) -> f64 {
    point.indentation + point.force / stiffness
}

/// Returns `count` points of the approach from `low` to `top` (m) and as many of the retraction
/// back, as displacements in m and forces in N. They are the first points of fine curves at or
/// beyond evenly spaced displacements; the force is 0 where the body is free.
pub(crate) fn sampled(
    stages: &[StageRecord],
    stiffness: f64,
    low: f64,
    top: f64,
    count: usize,
) -> Vec<(f64, f64)> {
    let mut points = Vec::new();
    for (stage, sign) in stages.iter().zip([1.0, -1.0]) {
        let presses = sign > 0.0;
        let mut place = 0;
        for index in 0..count {
            let share = index as f64 / (count - 1) as f64;
            let wanted = if presses {
                low + share * (top - low)
            } else {
                top + share * (low - top)
            };
            while place < stage.curve.len()
                && sign * displacement(&stage.curve[place], stiffness) < sign * wanted
            {
                place += 1;
            }
            let mut reached = stage.curve.get(place);
            if presses {
                // The approach ends at its last point, and is free before displacement 0.
                reached = reached.or(stage.curve.last()).filter(|_| wanted > 0.0);
            }
            points.push(match reached {
                Some(point) => (displacement(point, stiffness), point.force),
                None => (wanted, 0.0),
            });
        }
    }
    points
}

/// Normally distributed noise of 1000 points, N.
pub(crate) fn gauss(deviation: f64, seed: u64) -> Vec<f64> {
    let mut generator = ChaCha8Rng::seed_from_u64(seed);
    let mut one = || {
        let [one, other]: [f64; 2] = [generator.random(), generator.random()];
        deviation * (-2.0 * (1.0 - one).ln()).sqrt() * (std::f64::consts::TAU * other).cos()
    };
    (0..1000).map(|_| one()).collect()
}

pub(crate) fn noise(made: &Made, seed: u64) -> Vec<f64> {
    gauss(made.noise, seed)
}

/// Returns the curve with noise, drift, an offset and a zero, read from a text in nm and µN.
pub(crate) fn measured(made: &Made, seed: u64) -> MeasuredCurve {
    let points = force_curve(&made.scene)
        .into_iter()
        .zip(noise(made, seed))
        .enumerate();
    let disturbed = points.map(|(index, ((displacement, force), noise))| {
        (
            displacement + made.offset,
            force + noise + made.drift * index as f64 / 1000.0 + 3e-7,
        )
    });
    read(disturbed, Drift::Remove)
}

/// The curve read from these displacements, m, and forces, N.
pub(crate) fn read(points: impl Iterator<Item = (f64, f64)>, drift: Drift) -> MeasuredCurve {
    let line = |text: String, (displacement, force): (f64, f64)| {
        text + &format!("{},{}\n", displacement * 1e9, force * 1e6)
    };
    let text = points.fold("displacement [nm],force [uN]\n".to_owned(), line);
    from_text(
        &text,
        &CurveOptions {
            drift,
            ..CurveOptions::default()
        },
    )
    .unwrap()
}

pub(crate) fn from_bytes(content: &[u8], options: &CurveOptions) -> Result<MeasuredCurve, String> {
    MeasuredCurve::parse(Path::new("curve"), content, options).map_err(|error| error.to_string())
}

pub(crate) fn from_text(text: &str, options: &CurveOptions) -> Result<MeasuredCurve, String> {
    from_bytes(text.as_bytes(), options)
}

/// Returns displacements in nm and forces in nN of a spring of 2 N/m that touches at 0 nm. The
/// noise alternates by 0.1 nN and the zero is 1 nN. The spring is pressed from −100 to 50 nm and
/// back in `count` points.
pub(crate) fn of_spring(count: usize) -> Vec<(f64, f64)> {
    let point = |index: usize| {
        let way = 300.0 * index as f64 / (count - 1) as f64;
        let displacement = if way < 150.0 {
            way - 100.0
        } else {
            200.0 - way
        };
        let noise = if index.is_multiple_of(2) { 0.1 } else { -0.1 };
        (displacement, 1.0 + noise + 2.0 * displacement.max(0.0))
    };
    (0..count).map(point).collect()
}

/// A file of points of the spring, each written by `form`, after a header.
pub(crate) fn text_of_spring(
    header: &str,
    count: usize,
    form: impl Fn(f64, f64) -> String,
) -> String {
    of_spring(count)
        .into_iter()
        .fold(header.to_owned(), |text, (d, f)| text + &form(d, f) + "\n")
}

/// Text of points with displacements in nm and forces in nN.
pub(crate) fn lines(points: impl IntoIterator<Item = (f64, f64)>) -> String {
    let line = |text: String, (d, f): (f64, f64)| text + &format!("{d},{f}\n");
    points
        .into_iter()
        .fold("displacement [nm],force [nN]\n".to_owned(), line)
}

/// Returns the curve of a sphere without adhesion on rubber (Hertz), with R = 7.5 µm, E* = 2 MPa, k
/// = 3 N/m, D₀ = 2 µm, and 100 points in each direction. The force is `times` the force of Hertz.
/// `times` is a function of the indentation in m and of the direction, 1 or −1.
pub(crate) fn rubber(
    deviation: f64,
    seed: u64,
    times: impl Fn(f64, f64) -> f64,
) -> Vec<(f64, f64)> {
    rubber_of(100, deviation, seed, times)
}

/// As [`rubber`], with `half` points there and back, at most 500.
pub(crate) fn rubber_of(
    half: usize,
    deviation: f64,
    seed: u64,
    times: impl Fn(f64, f64) -> f64,
) -> Vec<(f64, f64)> {
    let force = |indentation: f64| 4.0 / 3.0 * 2e6 * (7.5e-6 * indentation.max(0.0).powi(3)).sqrt();
    let point = |(index, noise): (usize, f64)| {
        let (way, direction) = if index < half {
            (index, 1.0)
        } else {
            (2 * half - 1 - index, -1.0)
        };
        let indentation = (way as f64 / (half - 1) as f64 - 0.5) * 2e-6;
        let force = force(indentation) * times(indentation, direction);
        (2e-6 + indentation + force / 3.0, force + noise)
    };
    gauss(deviation, seed)
        .into_iter()
        .take(2 * half)
        .enumerate()
        .map(point)
        .collect()
}

/// The scene of [`rubber`] with this work of adhesion, J/m², and modulus, Pa.
pub(crate) fn on_rubber(work: f64, modulus: f64) -> Document {
    let changes = [
        ("form.radius", "7.5e-6"),
        ("length", "2.4e-5"),
        ("loading_stiffness", "3"),
        ("numerics.points", "256"),
        ("adhesion.work", &format!("{work:e}")),
        ("material", &format!("(modulus: {modulus:e})")),
    ];
    open("jkr-sphere")
        .unwrap()
        .set_all(&changes.map(|(path, value)| (path.to_owned(), value.to_owned())))
        .unwrap()
}

/// A random smooth or rough sphere on a compliant instrument, with noise of 1 % of its pull-off
/// force.
pub(crate) fn random(seed: u64, points: u64) -> Made {
    let mut generator = ChaCha8Rng::seed_from_u64(seed);
    let mut between = |low: f64, high: f64| low * (high / low).powf(generator.random::<f64>());
    let name = if seed.is_multiple_of(2) {
        "jkr-sphere"
    } else {
        "rough-sphere"
    };
    let mut scene = Scene::clone(open(name).unwrap().scene());
    scene.numerics.points = points;
    scene.set_seed(seed);
    let (modulus, work) = (2.7e6 * between(0.5, 2.0), 0.05 * between(0.5, 2.0));
    (scene.material, scene.adhesion) =
        (Material::effective(modulus), Some(Adhesion::by_work(work)));
    let radius = *scene.form.clone().unwrap().radius_mut().unwrap();
    scene.loading = vec![
        Move::ToForce(1.5 * PI * work * radius * between(1.0, 4.0)),
        Move::ToSeparation,
    ];
    // Contact radius at pull-off of a sphere.
    let contact = (radius * radius * 9.0 * PI * work / (8.0 * modulus)).cbrt();
    scene.loading_stiffness = Some(2.0 * modulus * contact * between(0.5, 10.0));
    let checked = scene.clone().checked().unwrap();
    let outcome = Simulation::default()
        .run(&checked, &|| false, &mut |_, _, _| Ok(()))
        .unwrap();
    let force = outcome.figures.pull_off_force.unwrap();
    Made {
        scene,
        offset: 1e-6 * between(0.1, 1.0),
        noise: 0.01 * force,
        drift: 0.1 * force,
    }
}

pub(crate) fn truth(made: &Made, parameter: Parameter) -> f64 {
    match parameter {
        Parameter::Work => made.scene.adhesion.unwrap().work().unwrap(),
        Parameter::Modulus => made.scene.material.modulus_in_pascals(),
        Parameter::Offset => made.offset,
        Parameter::Stiffness => stiffness(&made.scene),
        _ => 0.0,
    }
}

pub(crate) fn fit_from(curve: &MeasuredCurve, document: &Document, free: &str) -> FitResult {
    let free: Vec<Free> = free.split(',').map(|one| one.parse().unwrap()).collect();
    let fit = free.into_iter().fold(Fit::of(document), Fit::free);
    fit.run(curve, Control::default()).unwrap()
}

/// The fit of free parameters whose search begins far from the truth.
pub(crate) fn fitted(curve: &MeasuredCurve, made: &Made, free: &str) -> FitResult {
    let mut scene = made.scene.clone();
    scene.adhesion = Some(Adhesion::by_work(3.0 * truth(made, Parameter::Work)));
    if free.contains("modulus") {
        scene.material = Material::effective(0.5 * truth(made, Parameter::Modulus));
    }
    if free.contains("stiffness") {
        scene.loading_stiffness = Some(3.0 * stiffness(&made.scene));
    }
    fit_from(curve, &Document::from_scene(&scene, "made").unwrap(), free)
}

pub(crate) fn free(seed: u64) -> &'static str {
    let free = [
        "work,modulus,offset",
        "work,offset",
        "work,modulus,offset,zero",
        "work,modulus,offset,stiffness",
    ];
    free[(seed / 2 % 4) as usize]
}
