//! Stated errors against true ones, on random scenes with known finest solutions.

use asperity::accuracy::estimate;
use asperity::scene::Document;
use asperity::simulation::{Outcome, Simulation};
use proptest::prelude::Rng;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
use std::path::Path;

const SCENES: usize = 200;
/// Springs of the finest solution for each spring of the scene.
const FINER: u64 = 64;

fn run(document: &Document) -> Outcome {
    Simulation::default().run(document.scene(), &|| false, &mut |_, _, _| Ok(())).unwrap()
}

/// A random scene: springs of every resolution of its waves, both edge models, flat and on a sphere.
fn scene(mut uniform: impl FnMut() -> f64) -> Document {
    let points = 1_u64 << (9 + (4.0 * uniform()) as u32);
    let last = points / (2_u64 << (4.0 * uniform()) as u32);
    let form = if uniform() < 0.3 { "form: Paraboloid(radius: 1.0e-3), " } else { "" };
    let edges = if uniform() < 0.25 { "Grid" } else { "SubCell" };
    let text = format!(
        "(version: 1, material: (effective_modulus: 2.0e6), length: 1.0e-4, {form}\
         roughness: SelfAffine(hurst: {:?}, rms_height: 1.0e-7, modes: (1, {last}), seed: {}), \
         adhesion: (kappa: {:?}), loading: [ToForce({:?}), ToSeparation], \
         numerics: (points: {points}, edges: {edges}, samples: 2))",
        0.1 + 0.8 * uniform(),
        (1.0e6 * uniform()) as u64,
        0.5 * 60_f64.powf(uniform()),
        4.0e-7 * 100_f64.powf(uniform()),
    );
    Document::parse(&text, "random").unwrap_or_else(|errors| panic!("{errors}"))
}

#[test]
fn stated_errors_hold_and_are_not_far_above_the_true_ones() {
    let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &[12; 32]);
    let mut runner = TestRunner::new_with_rng(Config::default(), rng);
    let mut uniform = || f64::from(runner.rng().next_u32()) / (f64::from(u32::MAX) + 1.0);
    let mut ratios = Vec::new();
    while ratios.len() < SCENES {
        let document = scene(&mut uniform);
        let outcome = run(&document);
        let points = (FINER * document.scene().numerics.points).to_string();
        let finest = document
            .set("numerics.points", &points)
            .and_then(|finest| finest.set("numerics.edges", "SubCell"));
        let truth = run(&finest.unwrap()).figures.adhesion_force.filter(|force| *force > 0.0);
        let (Some(truth), Some(force)) = (truth, outcome.figures.adhesion_force) else { continue };
        let stated = estimate(document.scene(), Path::new(""), &outcome, &|| false).unwrap().unwrap().error;
        // The finest solution itself is known only to rounding.
        ratios.push(stated / ((force - truth).abs() / truth).max(1.0e-13));
    }
    ratios.sort_by(f64::total_cmp);
    let held = ratios.iter().filter(|ratio| **ratio >= 1.0).count();
    println!("{held} of {SCENES} hold; median ratio {:.2}", ratios[SCENES / 2]);
    assert!(100 * held >= 95 * SCENES, "{held} of {SCENES} stated errors hold");
    assert!(
        ratios[SCENES / 2] <= 10.0,
        "the median stated error is {} times the true one",
        ratios[SCENES / 2]
    );
}
