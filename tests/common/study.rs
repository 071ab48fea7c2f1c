//! A small study over κ and H at three preloads, finished.

use asperity::data::Control;
use asperity::study::{Changes, Folder, Plan, Shard, merge, run_study};
use std::path::Path;

pub const PLAN: &str = r#"(
    version: 1,
    title: "Small study",
    scene: (
        version: 1,
        material: (youngs_modulus: 2.0e6, poisson_ratio: 0.5),
        length: 1.0e-4,
        roughness: SelfAffine(hurst: 0.5, rms_height: 2.0e-7, modes: (1, 32), seed: 1),
        adhesion: (kappa: 1.0),
        numerics: (points: 128, samples: 32, edges: SubCell),
    ),
    axes: [
        Linear(path: "roughness.hurst", from: 0.1, to: 0.9, count: 9),
        Logarithmic(path: "adhesion.kappa", from: 0.25, to: 16, count: 13),
    ],
    preloads: [0.01, 0.1, 1.0],
    profiles: 12,
    record: [first_touch_adhesion_share, adhesion_coefficient, pull_off_force, regime],
)"#;

/// Creates the study of a plan in a folder, computed and merged.
pub fn merged(folder: &Path, plan: &str) {
    let study = begun(folder, plan);
    run_study(&study, Shard::WHOLE, Control::default().on_threads(2)).unwrap();
    merge(&study).unwrap();
}

/// Creates the study of a plan in a folder, without results.
pub fn begun(folder: &Path, plan: &str) -> Folder {
    let plan = Plan::parse(plan, "plan", &Changes::default()).unwrap();
    Folder::create(folder, &plan).unwrap()
}
