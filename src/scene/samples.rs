//! Scenes for the tests of this room.

use proptest::prelude::*;

use super::model::{
    Adhesion, Edges, Form, Leg, Material, Numerics, Observer, Roughness, SCENE_VERSION, Scene, Solver,
};
use crate::text::is_control;

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

/// Numbers of all sizes, with all their digits.
fn number(exponents: std::ops::Range<i32>) -> impl Strategy<Value = f64> {
    (exponents, 1.0..10.0).prop_map(|(exponent, mantissa)| mantissa * 10_f64.powi(exponent))
}

fn material() -> impl Strategy<Value = Material> {
    let pair = (number(0..9), -0.9..=0.5).prop_map(|(modulus, ratio)| Material {
        youngs_modulus: Some(modulus),
        poisson_ratio: Some(ratio),
        effective_modulus: None,
    });
    let effective = number(0..12).prop_map(|modulus| Material {
        youngs_modulus: None,
        poisson_ratio: None,
        effective_modulus: Some(modulus),
    });
    prop_oneof![pair, effective]
}

fn form(length: f64) -> impl Strategy<Value = Form> {
    prop_oneof![
        number(0..4).prop_map(move |times| Form::Paraboloid { radius: times * length }),
        (0.01..1.5).prop_map(|angle| Form::Cone { angle }),
        (number(-5..1), 0.6..5.0).prop_map(|(coefficient, exponent)| Form::Power { coefficient, exponent }),
        (0.2..0.5).prop_map(move |times| Form::Punch { radius: times * length }),
    ]
}

/// Roughness and adhesion that determine each other, neither too little nor too much.
fn surface() -> impl Strategy<Value = (Option<Roughness>, Option<Adhesion>)> {
    let line = (0.01..0.99, number(-24..0), (1_u64..8, 8_u64..16), any::<u64>(), 0..7_u8);
    let adhesion = (number(-12..5), number(-5..5), ".{0,20}");
    (line, adhesion).prop_map(|((hurst, size, modes, seed, case), (work, kappa, file))| {
        let rough = |rms_height, rms_gradient| {
            Some(Roughness::SelfAffine { hurst, rms_height, rms_gradient, modes, seed })
        };
        let by = |work, kappa| Some(Adhesion { work, kappa });
        match case {
            0 => (None, None),
            1 => (None, by(Some(work), None)),
            2 => (rough(Some(size), None), None),
            3 => (rough(None, Some(size)), by(Some(work), None)),
            4 => (rough(Some(size), None), by(None, Some(kappa))),
            5 => (rough(None, None), by(Some(work), Some(kappa))),
            _ => {
                let file: String = file.chars().filter(|c| !is_control(*c)).collect();
                (Some(Roughness::Measured { file: file + ".csv" }), by(None, Some(kappa)))
            }
        }
    })
}

fn loading() -> impl Strategy<Value = Vec<Leg>> {
    let press = prop_oneof![
        number(-12..3).prop_map(Leg::ToForce),
        number(-12..0).prop_map(Leg::ToIndentation),
        Just(Leg::ToTouch),
        Just(Leg::ToZeroForce),
    ];
    let pull = prop_oneof![
        number(-12..3).prop_map(|force| Leg::ToForce(-force)),
        number(-12..0).prop_map(|indentation| Leg::ToIndentation(-indentation)),
        Just(Leg::ToSeparation),
    ];
    prop::collection::vec((press, pull), 1..4)
        .prop_map(|legs| legs.into_iter().flat_map(|(press, pull)| [press, pull]).collect())
}

fn numerics() -> impl Strategy<Value = Numerics> {
    let solver = prop_oneof![Just(Solver::Exact), number(-12..0).prop_map(|step| Solver::Stepwise { step })];
    (32_u64..=1 << 28, solver, 2_u64..100_000).prop_map(|(points, solver, samples)| Numerics {
        points,
        solver,
        edges: Edges::Grid,
        samples,
    })
}

/// Scenes that [`check`](super::check()) has nothing to say against.
pub(super) fn sound_scenes() -> impl Strategy<Value = Scene> {
    let text = (any::<String>(), any::<String>(), number(-9..1));
    let rest = (loading(), prop_oneof![Just(Numerics::default()), numerics()]);
    let observers = prop_oneof![
        Just(vec![]),
        Just(vec![Observer::Fragments]),
        Just(vec![Observer::HeightHistogram, Observer::Fragments])
    ];
    (text, material(), surface(), rest, observers)
        .prop_flat_map(|(text, material, surface, rest, observers)| {
            let form = prop::option::of(form(text.2));
            (Just(text), Just(material), form, Just(surface), Just(rest), Just(observers))
        })
        .prop_map(|(text, material, form, surface, rest, observe)| {
            let ((title, notice, length), (roughness, adhesion), (loading, numerics)) = (text, surface, rest);
            Scene {
                version: SCENE_VERSION,
                title: title.chars().filter(|c| !is_control(*c)).take(200).collect(),
                notice: notice.chars().filter(|c| !is_control(*c) || *c == '\n').take(4000).collect(),
                material,
                length,
                form,
                roughness,
                adhesion,
                loading,
                numerics,
                observe,
            }
        })
}
