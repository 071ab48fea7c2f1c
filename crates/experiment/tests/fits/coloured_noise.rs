//! Test: the intervals of fits hold the truth for few points with coloured noise, in which
//! neighbouring points deviate alike.

use crate::common::sphere::{Sphere, path};
use crate::common::{cases, fit_from, gauss};
use asperity_data::on_threads;
use asperity_experiment::{CurveOptions, ExperimentError, MeasuredCurve, Parameter};
use asperity_scene::{Document, open};
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use std::f64::consts::PI;

/// Correlations of neighbouring points.
const CORRELATIONS: [f64; 4] = [0.0, 0.5, 0.7, 0.85];
/// Share of the intervals that have to hold the truth.
const LEAST_HELD: f64 = 0.9;

/// Returns the sphere, its curve with 40 to 60 points in contact, and the scene at which a fit
/// begins.
fn case(seed: u64) -> (Sphere, MeasuredCurve, Document) {
    let mut generator = ChaCha8Rng::seed_from_u64(9000 + seed);
    let mut between = |low: f64, high: f64| low * (high / low).powf(generator.random::<f64>());
    let radius = between(1e-6, 2e-5);
    let modulus = between(1e4, 5e6);
    let scale = between(0.03, 0.3);
    let work = modulus * radius * scale.powi(3) / (4.5 * PI);
    let sphere = Sphere {
        radius,
        work,
        modulus,
        stiffness: 2.0 * modulus * scale * radius * between(0.3, 10.0),
    };
    let pull_off = sphere.pull_off();
    let [contact, top] = sphere.at_force(pull_off * between(1.0, 10.0));
    let way = top - sphere.separation();
    let step = way / between(24.0, 34.0);
    let free = sphere.separation() - 1.5 * way;
    let way = path(&[free, top, free], step);
    let mut forces = sphere.forces(&way);
    let correlation = CORRELATIONS[seed as usize % CORRELATIONS.len()];
    let deviation = pull_off * between(0.003, 0.03);
    let fresh = gauss(
        deviation * (1.0 - correlation * correlation).sqrt(),
        7000 + seed,
    );
    let mut noise = gauss(deviation, seed + 1_000_000)[0];
    for (force, fresh) in forces.iter_mut().zip(fresh) {
        *force += noise;
        noise = correlation * noise + fresh;
    }
    let curve = MeasuredCurve::from_columns(&way, &forces, &CurveOptions::default()).unwrap();
    let changes = [
        ("form.radius", format!("{radius:e}")),
        ("length", format!("{:e}", 5.0 * contact)),
        ("loading_stiffness", format!("{:e}", sphere.stiffness)),
        ("numerics.points", "1024".to_owned()),
        ("adhesion.work", format!("{:e}", 10.0 * work)),
        ("material", format!("(modulus: {:e})", 0.1 * modulus)),
    ];
    let changes = changes.map(|(path, value)| (path.to_owned(), value));
    let document = open("jkr-sphere").unwrap().set_all(&changes).unwrap();
    (sphere, curve, document)
}

/// Twenty curves, times `TEST_EFFORT`, and at most 200.
#[test]
#[ignore = "fits of many curves take a minute or more"]
fn most_curves_with_coloured_noise_are_held() {
    let count = cases(20, 200);
    let worker = || {
        move |seed: u64| {
            let (sphere, curve, document) = case(seed);
            let fit = fit_from(&curve, &document, "work,modulus,offset");
            let mut held = [0; 2];
            for found in &fit.parameters {
                let (place, truth) = match found.parameter {
                    Parameter::Work => (0, sphere.work),
                    Parameter::Modulus => (1, sphere.modulus),
                    _ => continue,
                };
                let (low, high) = found.interval;
                held[place] = usize::from((low..=high).contains(&truth));
            }
            Ok::<_, ExperimentError>(held)
        }
    };
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let held = on_threads(count, threads, worker).unwrap();
    let mut all = 0;
    for (place, correlation) in CORRELATIONS.iter().enumerate() {
        let of_correlation = held.iter().skip(place).step_by(CORRELATIONS.len());
        let count = of_correlation.clone().count();
        let [works, moduli] =
            of_correlation.fold([0, 0], |sums, held| [sums[0] + held[0], sums[1] + held[1]]);
        println!("correlation {correlation}: work {works}, modulus {moduli} of {count}");
        all += works + moduli;
    }
    println!("{all} of {} intervals hold the truth", 2 * count);
    assert!(all as f64 >= LEAST_HELD * 2.0 * count as f64, "{all}");
}
