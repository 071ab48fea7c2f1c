//! Bodies, seeds and noise that are not those of a fit, and their curves.

use super::gauss;
use super::specimens::{document, scene};
use asperity_contact::Move;
use asperity_data::{Control, between};
use asperity_experiment::{
    CurveOptions, EnsembleFit, EnsembleOptions, MeasuredCurve, Negate, fit_ensemble,
};
use asperity_scene::instrument::DisplacementCurve;
use asperity_scene::{Adhesion, Material, Roughness, Scene, Simulation};
use asperity_surface::Form;
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};

/// Number of points of each branch of a curve, and of the computed branch between whose points they
/// are interpolated.
const POINTS: usize = 260;
const SAMPLES: u64 = 2000;
/// Numbers of curves of the specimens.
const CURVES: [u64; 4] = [8, 16, 32, 64];
/// First seed of the profiles of specimens.
const FIRST_SEED: u64 = 10_000_000;

#[derive(Clone, Copy, Debug)]
pub(crate) enum Body {
    Cone,
    Sphere,
    Flat,
}

impl Body {
    /// Returns the scene of the fit, with this Hurst exponent.
    fn scene(self, hurst: f64) -> Scene {
        let mut scene = scene("rough-sphere");
        let (length, height, modes, work) = match self {
            Body::Cone => (6e-5, 1e-7, (2, 64), 0.02),
            Body::Sphere => (6e-5, 1e-7, (3, 64), 0.04),
            Body::Flat => (1e-4, 2e-7, (4, 64), 0.005),
        };
        scene.length = length;
        scene.form = match self {
            Body::Cone => Some(Form::Cone { angle: 0.2 }),
            Body::Sphere => Some(Form::Paraboloid { radius: 5e-5 }),
            Body::Flat => None,
        };
        scene.roughness = Some(Roughness::SelfAffine {
            hurst,
            rms_height: Some(height),
            rms_gradient: None,
            modes: Some(modes),
            wavelengths: None,
            roll_off: None,
            seed: 1,
        });
        scene.material = Material::effective(1e6);
        scene.adhesion = Some(Adhesion::by_work(work));
        scene.loading_stiffness = if matches!(self, Body::Flat) {
            None
        } else {
            Some(30.0)
        };
        scene.loading = vec![Move::ToForce(1e-5), Move::ToSeparation];
        scene.numerics.points = 512;
        scene
    }
}

/// A specimen: the scene of the fit, the true scene and the noise of its curves as a share of the
/// preload.
pub(crate) struct Specimen {
    pub given: Scene,
    pub truth: Scene,
    pub noise: f64,
    pub curves: u64,
}

impl Specimen {
    /// Draws a specimen: γ within a factor of 4, E* within a factor of 2, the noise from 0.5 to 2 %
    /// of the preload.
    pub(crate) fn new(body: Body, number: u64) -> Self {
        let mut generator = ChaCha8Rng::seed_from_u64(FIRST_SEED + number);
        let mut random = || generator.random::<f64>();
        let mut given = body.scene(0.6 + 0.3 * random());
        // The error of the table is common to all fits with the same profiles: each fit has its
        // own.
        given.set_seed(number);
        let work = given.adhesion.unwrap().work().unwrap();
        let truth = Scene {
            adhesion: Some(Adhesion::by_work(work * 4.0_f64.powf(random() - 0.5))),
            material: Material::effective(1e6 * 2.0_f64.powf(random() - 0.5)),
            ..given.clone()
        };
        let noise = 0.005 * 4.0_f64.powf(random());
        Specimen {
            given,
            truth,
            noise,
            curves: CURVES[number as usize % CURVES.len()],
        }
    }

    pub(crate) fn work(&self) -> f64 {
        self.truth.adhesion.unwrap().work().unwrap()
    }

    pub(crate) fn modulus(&self) -> f64 {
        self.truth.material.modulus_in_pascals()
    }

    /// The curve of one place, with points at evenly spaced displacements.
    pub(crate) fn curve(&self, simulation: &mut Simulation, seed: u64) -> MeasuredCurve {
        let noise = self.noise * 1e-5;
        curve_at(simulation, &self.truth, seed, noise, Sampled::Evenly)
    }

    /// Fits γ and E* to the curves of this specimen.
    pub(crate) fn fit(&self, number: u64, lines: u64) -> EnsembleFit {
        let mut simulation = Simulation::default();
        let seeds = (0..self.curves).map(|index| FIRST_SEED + 97 * (1000 * number + index));
        let curves: Vec<_> = seeds
            .map(|seed| (seed.to_string(), self.curve(&mut simulation, seed)))
            .collect();
        let options = EnsembleOptions {
            profiles: lines,
            is_modulus_free: true,
            height_error: None,
            hurst_error: None,
        };
        fit_ensemble(
            &curves,
            &document(&self.given),
            &options,
            &simulation,
            Control::default().on_threads(2),
        )
        .unwrap()
    }
}

/// The displacements at which a curve has points.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Sampled {
    /// At evenly spaced displacements.
    Evenly,
    /// At those that the engine has computed, which are dense near jumps and turns, and at evenly
    /// spaced displacements without contact.
    ByEngine,
}

/// The curve of a profile of a scene, with `noise` in N.
pub(crate) fn curve_at(
    simulation: &mut Simulation,
    scene: &Scene,
    seed: u64,
    noise: f64,
    sampled: Sampled,
) -> MeasuredCurve {
    let mut scene = scene.clone();
    scene.numerics.samples = match sampled {
        Sampled::Evenly => SAMPLES,
        Sampled::ByEngine => POINTS as u64,
    };
    scene.set_seed(seed);
    let stiffness = scene.loading_stiffness.unwrap_or(f64::INFINITY);
    let outcome = simulation
        .run(&scene.checked().unwrap(), &|| false, &mut |_, _, _| Ok(()))
        .unwrap();
    let branch = |number: usize| -> Vec<(f64, f64)> {
        let points = outcome.history.stages[number].curve.iter();
        points
            .map(|point| (point.indentation + point.force / stiffness, point.force))
            .collect()
    };
    let pressed = ascending(branch(0));
    let mirrored = |(displacement, force): &(f64, f64)| (-displacement, *force);
    let pulled = ascending(branch(1).iter().map(mirrored).collect());
    let (top, end) = (pressed[pressed.len() - 1].0, -pulled[pulled.len() - 1].0);
    let low = end.min(0.0) - 0.5 * (top - end);
    let mut points: Vec<(f64, f64)> = Vec::new();
    match sampled {
        Sampled::Evenly => {
            let displacement = |index: usize| between(low, top, index as f64 / (POINTS - 1) as f64);
            for index in 0..POINTS {
                let at = displacement(index);
                let outside = [0.0, pressed[pressed.len() - 1].1];
                points.push((at, interpolated(&pressed, at, outside)));
            }
            for index in (0..POINTS).rev() {
                let at = displacement(index);
                points.push((at, interpolated(&pulled, -at, [pulled[0].1, 0.0])));
            }
        }
        Sampled::ByEngine => {
            let free = |from: f64, to: f64| {
                let place = move |index: u8| between(from, to, f64::from(index) / 100.0);
                (0..100).map(move |index| (place(index), 0.0))
            };
            points.extend(free(low, pressed[0].0));
            for stage in &outcome.history.stages {
                let curve = DisplacementCurve::new(stage.direction, &stage.curve, stiffness);
                let computed = curve.points().iter();
                points.extend(computed.map(|point| (point.displacement, point.force)));
            }
            let mut behind: Vec<(f64, f64)> = free(low, end).collect();
            behind.reverse();
            points.extend(behind);
        }
    }
    let disturbances = gauss(noise, seed).into_iter().cycle();
    let (displacements, mut forces): (Vec<f64>, Vec<f64>) = points.into_iter().unzip();
    for (force, disturbance) in forces.iter_mut().zip(disturbances) {
        *force += disturbance;
    }
    let options = CurveOptions {
        negate: Some(Negate::None),
        ..CurveOptions::default()
    };
    MeasuredCurve::from_columns(&displacements, &forces, &options).unwrap()
}

/// The points at which the displacement is larger than at all points before: those that an
/// instrument passes which moves in one direction.
fn ascending(points: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
    let mut passed: Vec<(f64, f64)> = Vec::with_capacity(points.len());
    for point in points {
        if passed.last().is_none_or(|last| point.0 > last.0) {
            passed.push(point);
        }
    }
    passed
}

/// The force at a displacement. `outside` has the forces before the first and after the last point.
fn interpolated(points: &[(f64, f64)], at: f64, outside: [f64; 2]) -> f64 {
    let next = points.partition_point(|point| point.0 < at);
    if next == 0 || next == points.len() {
        return outside[usize::from(next > 0)];
    }
    let [(from, force), (to, other)] = [points[next - 1], points[next]];
    between(force, other, (at - from) / (to - from))
}
