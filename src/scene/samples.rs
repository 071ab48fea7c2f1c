//! Scenes for the tests of this room.

pub(super) use super::grammar::sound_scenes;
use super::model::{Adhesion, Edges, Leg, Material, Numerics, Roughness, SCENE_VERSION, Scene, Solver};

/// A scene with nothing to complain about, rough and sticky.
pub(super) fn sound() -> Scene {
    Scene {
        version: SCENE_VERSION,
        title: "A line".into(),
        notice: String::new(),
        material: Material { youngs_modulus: Some(2e6), poisson_ratio: Some(0.5), effective_modulus: None },
        length: 1e-4,
        form: None,
        roughness: Some(Roughness::SelfAffine {
            hurst: 0.7,
            rms_height: Some(1e-7),
            rms_gradient: None,
            modes: (1, 512),
            seed: 1,
        }),
        adhesion: Some(Adhesion { work: Some(0.05), kappa: None }),
        loading: vec![Leg::ToForce(1e-5), Leg::ToSeparation],
        numerics: Numerics { points: 4096, solver: Solver::Exact, edges: Edges::Grid, samples: 512 },
        observe: vec![],
    }
}
