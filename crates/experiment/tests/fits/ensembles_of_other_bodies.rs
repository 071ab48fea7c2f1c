//! Test: the intervals of γ and E* hold the known values of bodies, seeds and noise that are not
//! those of the fit.

use crate::common::bodies::{Body, Specimen};
use crate::common::specimens::document;
use crate::common::{cases, first_seed, gauss};
use asperity_contact::Move;
use asperity_data::Control;
use asperity_experiment::{
    CurveOptions, EnsembleOptions, IntervalEstimate, MeasuredCurve, fit_ensemble,
};
use asperity_scene::{Adhesion, Material, Roughness, Scene, Simulation};
use asperity_surface::Form;

/// Number of specimens of each body, and least number of their intervals that hold the truth.
const SPECIMENS: u64 = 60;
const LEAST_HELD: usize = 55;

/// Numbers of intervals that hold the truth, and sums of the errors and half-widths of logarithms.
#[derive(Default)]
struct Tally {
    held: usize,
    errors: Vec<f64>,
    half_widths: f64,
}

impl Tally {
    fn add(&mut self, found: IntervalEstimate, truth: f64) {
        self.held += usize::from(found.low <= truth && truth <= found.high);
        self.errors.push((found.value / truth).ln());
        self.half_widths += found.half_width();
    }

    fn text(&self) -> String {
        let count = self.errors.len() as f64;
        let mean = self.errors.iter().sum::<f64>() / count;
        let square = self
            .errors
            .iter()
            .map(|error| (error - mean).powi(2))
            .sum::<f64>();
        let error = (square / (count - 1.0) / count).sqrt();
        let half_width = self.half_widths / count;
        let held = self.held;
        format!("{held} of {count}, half-width {half_width:.4}, mean error {mean:+.4} ± {error:.4}")
    }
}

/// Fits specimens of a body, each with its number of curves, and asserts that nearly all intervals
/// hold the truth.
fn check(body: Body) {
    let count = cases(4, SPECIMENS);
    let mut tallies = [Tally::default(), Tally::default()];
    for index in 0..count {
        let number = first_seed() + index;
        let specimen = Specimen::new(body, number);
        let fit = specimen.fit(number, 64);
        assert!(
            fit.work.low < fit.work.value && fit.work.value < fit.work.high,
            "{:?}",
            fit.work
        );
        assert!(fit.modulus.low < fit.modulus.value && fit.modulus.value < fit.modulus.high);
        tallies[0].add(fit.work, specimen.work());
        tallies[1].add(fit.modulus, specimen.modulus());
        println!(
            "{body:?} {number}, {} curves, γ {:.4}, E* {:.0}, noise {:.4}: ln γ {:+.4} ± {:.4}, ln E* {:+.4} ± {:.4}, \
             described {}",
            specimen.curves,
            specimen.work(),
            specimen.modulus(),
            specimen.noise,
            tallies[0].errors[index as usize],
            fit.work.half_width(),
            tallies[1].errors[index as usize],
            fit.modulus.half_width(),
            fit.described,
        );
    }
    for (tally, name) in tallies.iter().zip(["γ", "E*"]) {
        println!("{body:?}, {name}: {}", tally.text());
        assert!(
            count < SPECIMENS || tally.held >= LEAST_HELD,
            "{name}: {}",
            tally.text()
        );
    }
}

#[test]
#[ignore = "comparisons of 60 specimens take minutes"]
fn both_intervals_hold_the_truth_of_other_cones() {
    check(Body::Cone);
}

#[test]
#[ignore = "comparisons of 60 specimens take minutes"]
fn both_intervals_hold_the_truth_of_other_spheres() {
    check(Body::Sphere);
}

#[test]
#[ignore = "comparisons of 60 specimens take minutes"]
fn both_intervals_hold_the_truth_of_other_flat_bodies() {
    check(Body::Flat);
}

/// One specimen of each body: intervals of some width hold the truth, by few profiles.
#[test]
fn both_intervals_hold_the_truth_of_three_bodies() {
    for body in [Body::Cone, Body::Sphere, Body::Flat] {
        let specimen = Specimen::new(body, 0);
        let fit = specimen.fit(0, 32);
        for (found, truth) in [
            (fit.work, specimen.work()),
            (fit.modulus, specimen.modulus()),
        ] {
            let IntervalEstimate { value, low, high } = found;
            assert!(low < truth && truth < high, "{body:?}: {found:?} {truth:e}");
            assert!(
                low < value && value < high && high / low > 1.004,
                "{body:?}: {found:?}"
            );
        }
    }
}

/// Four curves of a sphere of 30 µm with roughness of 20 nm, which is almost smooth, at the
/// indentations at which they were computed: most points are in contact, and few before it.
#[test]
fn curves_with_most_points_in_contact_are_described() {
    for (modulus, preload, is_modulus_free) in [(2.4e7, 1.1e-6, false), (1.3e5, 7.7e-6, true)] {
        let mut given = Specimen::new(Body::Sphere, 0).given;
        given.form = Some(Form::Paraboloid { radius: 3e-5 });
        given.length = 2.5e-5;
        given.roughness = Some(Roughness::SelfAffine {
            hurst: 0.8,
            rms_height: Some(2e-8),
            rms_gradient: None,
            modes: Some((1, 32)),
            wavelengths: None,
            roll_off: None,
            seed: 1,
        });
        given.material = Material::effective(modulus);
        given.adhesion = Some(Adhesion::by_work(0.02));
        given.loading_stiffness = None;
        given.loading = vec![Move::ToForce(preload), Move::ToSeparation];
        given.numerics.points = 1024;
        given.numerics.samples = 512;
        let mut simulation = Simulation::default();
        let mut curves = Vec::new();
        for seed in 0..4 {
            let curve = with_points_of_engine(&mut simulation, &given, 100 + seed);
            curves.push((seed.to_string(), curve));
        }
        let options = EnsembleOptions {
            profiles: 32,
            is_modulus_free,
            height_error: None,
            hurst_error: None,
        };
        given.adhesion = Some(Adhesion::by_work(0.002));
        let control = Control::default().on_threads(2);
        let fit = fit_ensemble(&curves, &document(&given), &options, &simulation, control).unwrap();
        let work = fit.work.value / 0.02;
        assert!((work - 1.0).abs() < 0.05, "{:?}", fit.work);
        let found = fit.modulus.value / modulus;
        assert!((found - 1.0).abs() < 0.05, "{:?}", fit.modulus);
    }
}

/// The curve of a profile with the points of the engine, and 100 points before and after them
/// without contact. The noise is 2 nN.
fn with_points_of_engine(simulation: &mut Simulation, scene: &Scene, seed: u64) -> MeasuredCurve {
    let mut scene = scene.clone();
    scene.set_seed(seed);
    let outcome = simulation
        .run(&scene.checked().unwrap(), &|| false, &mut |_, _, _| Ok(()))
        .unwrap();
    let mut points: Vec<(f64, f64)> = (0..100)
        .map(|index| (1e-8 * f64::from(index) - 1e-6, 0.0))
        .collect();
    let stages = outcome.history.stages.iter();
    points.extend(stages.flat_map(|stage| {
        let curve = stage.curve.iter();
        curve.map(|point| (point.indentation, point.force))
    }));
    let separated = points[points.len() - 1].0;
    points.extend((0..100).map(|index| (separated - 1e-8 * f64::from(index), 0.0)));
    let (displacements, mut forces): (Vec<f64>, Vec<f64>) = points.into_iter().unzip();
    let noise = gauss(2e-9, seed).into_iter().cycle();
    for (force, noise) in forces.iter_mut().zip(noise) {
        *force += noise;
    }
    MeasuredCurve::from_columns(&displacements, &forces, &CurveOptions::default()).unwrap()
}
