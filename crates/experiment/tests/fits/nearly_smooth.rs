//! Test: the intervals of ensembles hold the known values of bodies that are nearly smooth, whose
//! curves hardly differ from profile to profile.

use crate::common::bodies::{Sampled, curve_at};
use crate::common::specimens::document;
use crate::common::sphere::Sphere;
use crate::common::{cases, first_seed};
use asperity_contact::Move;
use asperity_data::Control;
use asperity_experiment::{EnsembleFit, EnsembleOptions, fit_ensemble};
use asperity_scene::{Adhesion, Material, Roughness, Scene, Simulation, open};
use asperity_surface::Form;
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};

/// Least share of the intervals that hold the truth.
const LEAST_HELD: f64 = 0.9;
/// First seed of the random numbers of a specimen.
const FIRST_SEED: u64 = 50_000_000;

/// A specimen that is nearly smooth.
struct Specimen {
    truth: Scene,
    curves: u64,
    /// Noise of the force in N.
    noise: f64,
    is_modulus_free: bool,
    sampled: Sampled,
    profiles: u64,
}

impl Specimen {
    fn new(seed: u64) -> Self {
        let mut generator = ChaCha8Rng::seed_from_u64(FIRST_SEED + seed);
        let mut between = |low: f64, high: f64| low * (high / low).powf(generator.random::<f64>());
        let radius = between(1e-5, 1e-4);
        let work = between(0.005, 0.1);
        let modulus = between(1e5, 3e7);
        let rigid = Sphere {
            radius,
            work,
            modulus,
            stiffness: f64::INFINITY,
        };
        let preload = rigid.pull_off() * between(0.5, 8.0);
        let [contact, _] = rigid.at_force(preload);
        let mut truth = Scene::clone(open("rough-sphere").unwrap().scene());
        truth.form = Some(Form::Paraboloid { radius });
        truth.length = contact * between(2.5, 7.0);
        // The stretch of the adhesion reaches farther than the roughness.
        let rms_height = rigid.stretch(contact) * between(1e-3, 0.3);
        truth.roughness = Some(Roughness::SelfAffine {
            hurst: 0.5 + 0.4 * generator.random::<f64>(),
            rms_height: Some(rms_height),
            rms_gradient: None,
            modes: Some((1, 32)),
            wavelengths: None,
            roll_off: None,
            seed: seed + 1,
        });
        let mut between = |low: f64, high: f64| low * (high / low).powf(generator.random::<f64>());
        truth.material = Material::effective(modulus);
        truth.adhesion = Some(Adhesion::by_work(work));
        let is_soft = between(0.1, 10.0) < 1.0;
        truth.loading_stiffness = is_soft.then(|| 2.0 * modulus * contact * between(0.3, 10.0));
        truth.loading = vec![Move::ToForce(preload), Move::ToSeparation];
        truth.numerics.points = 512;
        truth.observe = Vec::new();
        Specimen {
            truth,
            curves: [4, 8, 16, 32][seed as usize % 4],
            noise: rigid.pull_off() * between(0.0003, 0.02),
            is_modulus_free: !seed.is_multiple_of(3),
            sampled: if seed.is_multiple_of(2) {
                Sampled::Evenly
            } else {
                Sampled::ByEngine
            },
            profiles: if seed % 5 < 2 { 128 } else { 32 },
        }
    }

    fn work(&self) -> f64 {
        self.truth.adhesion.unwrap().work().unwrap()
    }

    fn modulus(&self) -> f64 {
        self.truth.material.modulus_in_pascals()
    }

    fn fit(&self, seed: u64) -> EnsembleFit {
        let mut simulation = Simulation::default();
        let mut curves = Vec::new();
        for place in 0..self.curves {
            let profile = FIRST_SEED + 97 * (1000 * seed + place);
            let curve = curve_at(
                &mut simulation,
                &self.truth,
                profile,
                self.noise,
                self.sampled,
            );
            curves.push((place.to_string(), curve));
        }
        let mut given = self.truth.clone();
        given.adhesion = Some(Adhesion::by_work(0.1 * self.work()));
        if self.is_modulus_free {
            given.material = Material::effective(2.5 * self.modulus());
        }
        let options = EnsembleOptions {
            profiles: self.profiles,
            is_modulus_free: self.is_modulus_free,
            height_error: None,
            hurst_error: None,
        };
        let control = Control::default().on_threads(2);
        fit_ensemble(&curves, &document(&given), &options, &simulation, control).unwrap()
    }
}

/// Fits specimens, and asserts that most intervals hold the truth.
fn assert_held(count: u64) {
    let mut held = [0; 2];
    let mut all = [0; 2];
    for seed in first_seed()..first_seed() + count {
        let specimen = Specimen::new(seed);
        let fit = specimen.fit(seed);
        let mut line = format!(
            "{seed}: {} curves, {} profiles, {:?}, E* free {}, noise {:.1e} N, described {}, end {}",
            specimen.curves,
            specimen.profiles,
            specimen.sampled,
            specimen.is_modulus_free,
            specimen.noise,
            fit.described,
            fit.at_end_of_table,
        );
        let found = [
            (fit.work, specimen.work()),
            (fit.modulus, specimen.modulus()),
        ];
        for (index, (found, truth)) in found.into_iter().enumerate() {
            if index == 1 && !specimen.is_modulus_free {
                continue;
            }
            let holds = found.low <= truth && truth <= found.high;
            held[index] += usize::from(holds);
            all[index] += 1;
            line += &format!(
                ", {} {:+.4} ± {:.4}{}",
                ["ln γ", "ln E*"][index],
                (found.value / truth).ln(),
                found.half_width(),
                if holds { "" } else { " not held" }
            );
        }
        println!("{line}");
    }
    println!("γ {} of {}, E* {} of {}", held[0], all[0], held[1], all[1]);
    let share = (held[0] + held[1]) as f64 / (all[0] + all[1]) as f64;
    assert!(share >= LEAST_HELD, "{share}");
}

/// Four specimens, times `TEST_EFFORT`.
#[test]
#[ignore = "comparisons of many specimens take minutes"]
fn intervals_hold_the_truth_of_nearly_smooth_bodies() {
    assert_held(cases(4, u64::MAX));
}
