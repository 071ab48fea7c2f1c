//! Curves of specimens with known values, for tests.

use super::{displacement, from_text, gauss, lines, sampled};
use asperity_contact::{CurvePoint, Move};
use asperity_experiment::{CurveOptions, MeasuredCurve, Negate};
use asperity_scene::{Adhesion, Document, Material, Scene, Simulation, open};

/// Number of points of each branch, and of the fine curve from which they are taken.
const POINTS: usize = 400;
const FINE: u64 = 1 << 14;

/// Returns the scene of specimens by its name, with preload and stiffness of the instrument.
pub(crate) fn scene(name: &str) -> Scene {
    let mut scene = Scene::clone(open(name).unwrap().scene());
    let (stiffness, preload) = if name == "rough-sphere" {
        (Some(200.0), 2e-4)
    } else {
        (None, 1e-5)
    };
    let (_, governing) = Simulation::default()
        .contact(&scene.clone().checked().unwrap())
        .unwrap();
    scene.adhesion = Some(Adhesion::by_work(governing.work_of_adhesion.unwrap()));
    scene.material = Material::effective(governing.modulus);
    scene.loading_stiffness = stiffness;
    scene.loading = vec![Move::ToForce(preload), Move::ToSeparation];
    scene.numerics.points = 4096;
    scene.observe = Vec::new();
    scene
}

pub(crate) fn document(scene: &Scene) -> Document {
    Document::from_scene(scene, "specimen").unwrap()
}

/// Makes the curve of one place of a specimen: with a profile of its own, noise as a share of the
/// preload, an offset and a zero.
pub(crate) fn curve(
    simulation: &mut Simulation,
    scene: &Scene,
    seed: u64,
    share: f64,
) -> MeasuredCurve {
    let Some(Move::ToForce(preload)) = scene.loading.first().copied() else {
        panic!("no preload")
    };
    let mut fine = scene.clone();
    fine.numerics.samples = FINE;
    fine.set_seed(seed);
    let outcome = simulation
        .run(&fine.checked().unwrap(), &|| false, &mut |_, _, _| Ok(()))
        .unwrap();
    let stages = &outcome.history.stages;
    let stiffness = scene.loading_stiffness.unwrap_or(f64::INFINITY);
    let base = |point: &CurvePoint| displacement(point, stiffness);
    let top = stages[0].curve.iter().map(base).fold(f64::MIN, f64::max);
    let low = -0.3 * top
        - stages[1]
            .curve
            .iter()
            .map(|point| base(point).abs())
            .fold(0.0, f64::max);
    let noise = gauss(share * preload, seed).into_iter().cycle();
    let points = sampled(stages, stiffness, low, top, POINTS);
    let disturbed = points.into_iter().zip(noise);
    let moved = disturbed.map(|((place, force), noise)| (place + 1e-6, force + noise + 3e-7));
    let scaled = moved.map(|(place, force)| (1e9 * place, 1e9 * force));
    let options = CurveOptions {
        negate: Some(Negate::None),
        ..CurveOptions::default()
    };
    from_text(&lines(scaled), &options).unwrap()
}
