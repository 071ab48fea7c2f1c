//! Profiles of a form and a roughness: the same as in a scene file, to the bit, and the sum of both
//! by its definition.

use asperity_contact::{Modulus, Move};
use asperity_data::on_this_thread;
use asperity_scene::{Adhesion, Document, Error, ProfileBuilder, Simulation};
use asperity_surface::lines::{MeasuredRoughness, phases};
use asperity_surface::{AnalysisOptions, EquivalentLine, Form, Topography, analyse};
use proptest::prelude::*;
use std::f64::consts::TAU;
use std::sync::Arc;

const LENGTH: f64 = 1.0e-4;

/// Each form, as in a scene file and as a value; `None` for a flat face.
fn forms() -> Vec<(&'static str, Option<Form>)> {
    vec![
        ("", None),
        (
            "form: Paraboloid(radius: 2.0e-4), ",
            Some(Form::Paraboloid { radius: 2.0e-4 }),
        ),
        (
            "form: Cone(angle: 0.05), ",
            Some(Form::Cone { angle: 0.05 }),
        ),
        (
            "form: Power(coefficient: 3.0e2, exponent: 1.5), ",
            Some(Form::Power {
                coefficient: 3.0e2,
                exponent: 1.5,
            }),
        ),
        (
            "form: WavySphere(radius: 2.0e-4, amplitude: 1.0e-8, wavelength: 2.0e-5), ",
            Some(Form::WavySphere {
                radius: 2.0e-4,
                amplitude: 1.0e-8,
                wavelength: 2.0e-5,
            }),
        ),
        (
            "form: Punch(radius: 3.0e-5), ",
            Some(Form::Punch { radius: 3.0e-5 }),
        ),
    ]
}

/// A way to give waves or an amplitude: as in a scene file, and by the builder.
type Given = (&'static str, fn(ProfileBuilder) -> ProfileBuilder);

const AMPLITUDES: [Given; 2] = [
    ("rms_height: 1.0e-7", |it| it.rms_height(1.0e-7)),
    ("rms_gradient: 0.02", |it| it.rms_gradient(0.02)),
];
const WAVES: [Given; 3] = [
    ("modes: (2, 16)", |it| it.modes(2, 16)),
    ("wavelengths: (7.0e-5, 9.0e-6)", |it| {
        it.wavelengths(7.0e-5, 9.0e-6)
    }),
    ("modes: (1, 16), roll_off: 2.0e-5", |it| {
        it.modes(1, 16).roll_off(2.0e-5)
    }),
];

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_built_profile_is_that_of_a_scene_file_to_the_bit(
        points in 64_usize..400, hurst in 0.1..0.9_f64, seed in any::<u64>(), form in 0..6_usize,
        amplitude in 0..2_usize, waves in 0..3_usize, is_rough in prop::bool::weighted(0.9),
    ) {
        let (form, amplitude, waves) = (&forms()[form], AMPLITUDES[amplitude], WAVES[waves]);
        let roughness = format!("roughness: SelfAffine(hurst: {hurst:?}, {}, {}, seed: {seed}), ", amplitude.0, waves.0);
        let roughness = if is_rough { roughness } else { String::new() };
        let text = format!(
            "(version: 1, material: (modulus: 1.0e6), length: {LENGTH:e}, {}{roughness}adhesion: (work: 1.0e-3), \
             loading: [ToForce(1.0e-6), ToSeparation], numerics: (points: {points}))",
            form.0,
        );
        let document = Document::parse(&text, "scene").unwrap_or_else(|errors| panic!("{errors}"));
        let mut builder = ProfileBuilder::new(LENGTH, points);
        if let Some(form) = &form.1 {
            builder = builder.form(form.clone());
        }
        if is_rough {
            builder = waves.1(amplitude.1(builder.self_affine(hurst))).seed(seed);
        }
        let profile = builder.build().unwrap();
        let mut simulation = Simulation::default();
        let (line, ..) = simulation.make_line(document.scene()).unwrap();
        let bits = |values: &[f64]| values.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
        prop_assert_eq!(bits(profile.gaps()), bits(&line.gaps));
        prop_assert_eq!((profile.spacing(), profile.length()), (line.spacing, line.length));
        prop_assert_eq!(profile.position(0), line.position(0));
        let stages = [Move::ToForce(1.0e-6), Move::ToSeparation];
        let run = builder.run(Modulus::effective(1.0e6).unwrap(), Some(Adhesion::by_work(1.0e-3)), &stages).unwrap();
        let outcome = simulation.compute(document.scene()).unwrap();
        prop_assert!(run.history.stages == outcome.history.stages && run.figures == outcome.figures);
        prop_assert_eq!((run.governing, run.regime), (outcome.governing, outcome.regime));
    }

    /// Heights are the waves less the form about an axis on the point N/2; both are shifted
    /// together.
    #[test]
    fn a_built_profile_is_the_sum_of_its_waves_and_its_form(
        points in 64_usize..200, hurst in 0.1..0.9_f64, seed in any::<u64>(), radius in 1e-4..1e-2_f64,
    ) {
        let builder = ProfileBuilder::new(LENGTH, points).sphere(radius).self_affine(hurst).rms_height(1e-7);
        let builder = builder.modes(2, 16).seed(seed);
        let amplitudes: Vec<f64> = (2..=16).map(|k| f64::from(k).powf(-hurst - 0.5)).collect();
        let rms = (amplitudes.iter().map(|one| 0.5 * one * one).sum::<f64>()).sqrt();
        let (spacing, axis) = (LENGTH / points as f64, points / 2);
        let wave = |position: f64| -> f64 {
            let modes = (2..=16_u32).zip(phases(seed, 2)).zip(&amplitudes);
            modes.map(|((k, phase), one)| one * (TAU * f64::from(k) * position / LENGTH + phase).cos()).sum()
        };
        // The waves have their places about L/2, which is the axis.
        let roughness = |point: usize| {
            1e-7 / rms * wave(0.5 * LENGTH + (point as f64 - axis as f64) * spacing)
        };
        let height = |point: usize| roughness(point) - ((point as f64 - axis as f64) * spacing).powi(2) / radius;
        let summit = (0..points).map(height).fold(f64::NEG_INFINITY, f64::max);
        let profile = on_this_thread(|| builder.build()).unwrap();
        for (point, gap) in profile.gaps().iter().enumerate() {
            prop_assert!((gap - (summit - height(point))).abs() < 1e-18 + 1e-12 * summit.abs(), "{}", point);
        }
        // The same with the heights of the waves.
        let built = builder.build_with((0..points).map(roughness).collect()).unwrap();
        for (one, other) in built.gaps().iter().zip(profile.gaps()) {
            prop_assert!((one - other).abs() < 1e-18 + 1e-12 * summit.abs());
        }
    }
}

#[test]
fn a_profile_with_a_measured_spectrum_is_that_of_a_scene() {
    let heights: Vec<f64> = phases(3, 1).take(256).map(|phase| 1e-8 * phase).collect();
    let surface = Topography::from_profile(&heights, 1e-6).unwrap();
    let line = EquivalentLine::from(&analyse(&[surface], &AnalysisOptions::default()).unwrap());
    let length = 2e-4;
    for points in [1024, 1025] {
        let built = |form: Option<Form>| {
            let builder = ProfileBuilder::new(length, points)
                .spectrum(line.clone())
                .seed(7);
            form.map_or(builder.clone(), |form| builder.form(form))
                .build()
                .unwrap()
        };
        // A flat face has the heights of the line themselves.
        let rough = line.heights(length, points, 7).unwrap();
        let summit = rough.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        assert!(
            built(None)
                .gaps()
                .iter()
                .zip(&rough)
                .all(|(gap, height)| *gap == summit - height)
        );
        let text = format!(
            "(version: 1, material: (modulus: 1.0), length: {length}, form: Paraboloid(radius: 1.0e-3), \
             roughness: Measured(file: \"any.txt\", seed: 7), numerics: (points: {points}))"
        );
        let document = Document::parse(&text, "scene").unwrap();
        let simulation = Simulation::default();
        let measured = Arc::new(MeasuredRoughness::Equivalent(line.clone()));
        let profile = simulation
            .with_measured(measured)
            .profile(document.scene())
            .unwrap();
        assert!(
            built(Some(Form::Paraboloid { radius: 1e-3 })) == profile,
            "{points}"
        );
    }
}

#[test]
fn the_order_of_the_calls_of_a_builder_does_not_matter() {
    type Call = fn(ProfileBuilder) -> ProfileBuilder;
    let calls: [Call; 5] = [
        |builder| builder.seed(9),
        |builder| builder.self_affine(0.6),
        |builder| builder.rms_height(5e-8),
        |builder| builder.modes(2, 40),
        |builder| builder.sphere(1e-3),
    ];
    let built = |order: [usize; 5]| {
        let begun = ProfileBuilder::new(LENGTH, 512);
        order
            .into_iter()
            .fold(begun, |builder, index| calls[index](builder))
            .build()
            .unwrap()
    };
    let expected = built([4, 1, 2, 3, 0]);
    assert!(built([4, 1, 2, 3, 1]) != expected, "the seed counts");
    let mut orders = 0;
    for code in 0..5_usize.pow(5) {
        let order: [usize; 5] = std::array::from_fn(|place| code / 5_usize.pow(place as u32) % 5);
        if (0..5).all(|call| order.contains(&call)) {
            assert!(built(order) == expected, "{order:?}");
            orders += 1;
        }
    }
    assert_eq!(orders, 120);
    let heights: Vec<f64> = phases(3, 1).take(256).map(|phase| 1e-8 * phase).collect();
    let surface = Topography::from_profile(&heights, 1e-6).unwrap();
    let line = EquivalentLine::from(&analyse(&[surface], &AnalysisOptions::default()).unwrap());
    let begun = ProfileBuilder::new(LENGTH, 512);
    let late = begun
        .clone()
        .spectrum(line.clone())
        .seed(9)
        .build()
        .unwrap();
    assert!(
        begun
            .clone()
            .seed(9)
            .spectrum(line.clone())
            .build()
            .unwrap()
            == late
    );
    assert!(begun.clone().spectrum(line.clone()).build().unwrap() != late);
    for both in [
        begun.clone().rms_height(1e-7).spectrum(line.clone()),
        begun.spectrum(line).rms_height(1e-7),
    ] {
        let refused = both.build().unwrap_err().to_string();
        assert!(
            refused
                .contains("a measured spectrum and a self-affine roughness: allowed: one of them"),
            "{refused}"
        );
    }
}

#[test]
fn wrong_values_of_a_profile_are_named_with_what_is_allowed() {
    let rough = |points: usize| {
        ProfileBuilder::new(LENGTH, points)
            .self_affine(0.7)
            .rms_height(1e-7)
    };
    let of = |refused: Result<_, Error>| refused.unwrap_err().to_string();
    for (refused, expected) in [
        (
            of(rough(1024).modes(1, 512).build()),
            "last mode = 512; allowed: from the first mode to a quarter of the number of points, for four springs to a wave",
        ),
        (
            of(rough(1024).modes(10, 1).build()),
            "roughness.modes = (10, 1): ",
        ),
        (of(rough(1024).build()), "roughness: "),
        (
            of(rough(1024).modes(1, 64).rms_gradient(0.1).build()),
            "roughness: ",
        ),
        (
            of(ProfileBuilder::new(LENGTH, 64)
                .rms_height(1e-7)
                .modes(1, 8)
                .build()),
            "roughness.hurst = NaN: ",
        ),
        (of(rough(0).modes(1, 64).build()), "numerics.points = 0: "),
        (
            of(ProfileBuilder::new(f64::NAN, 64).build()),
            "length = NaN: ",
        ),
        (
            of(ProfileBuilder::new(LENGTH, 64).sphere(-1.0).build()),
            "form.radius = -1.0: ",
        ),
        (
            of(rough(64).build_with(vec![0.0; 63])),
            "number of heights = 63; allowed: the number of points of the profile",
        ),
        (
            of(rough(64).build_with([0.0, f64::NAN].repeat(32))),
            "height with index 1 = NaN; allowed: from -1e50 to 1e50 m",
        ),
    ] {
        assert!(
            refused.starts_with(expected),
            "{refused} instead of {expected}"
        );
    }
}
