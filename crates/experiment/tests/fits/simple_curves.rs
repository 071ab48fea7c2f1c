//! Test: the simplest fits, of a smooth sphere with one or two free parameters, find the truth
//! whatever the noise, the number of points and the parts of the curve are.

use crate::common::sphere::{Sphere, path};
use crate::common::{cases, fit_from, gauss};
use asperity_experiment::{CurveOptions, FitResult, MeasuredCurve, Parameter};
use asperity_scene::{Document, open};
use std::f64::consts::PI;

/// Noise of a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Noise {
    None,
    /// Every second point deviates upwards, the others downwards.
    Alternating,
    White,
    /// Noise with a correlation of 0.9 between neighbouring points.
    Coloured,
    /// Forces rounded to a digit.
    Rounded,
}

const NOISES: [Noise; 5] = [
    Noise::None,
    Noise::Alternating,
    Noise::White,
    Noise::Coloured,
    Noise::Rounded,
];

impl Noise {
    fn add(self, forces: &mut [f64], size: f64, seed: u64) {
        let parts = (0..forces.len().div_ceil(1000) as u64).map(|part| 1000 * seed + part);
        let white: Vec<f64> = parts.flat_map(|seed| gauss(size, seed)).collect();
        let mut last = 0.0;
        for (index, force) in forces.iter_mut().enumerate() {
            last = 0.9 * last + 0.19_f64.sqrt() * white[index];
            match self {
                Noise::None => {}
                Noise::Alternating => *force += if index % 2 == 0 { size } else { -size },
                Noise::White => *force += white[index],
                Noise::Coloured => *force += last,
                Noise::Rounded => *force = (*force / size).round() * size,
            }
        }
    }
}

/// Parts that a curve has, or that are used of it.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Parts {
    Both,
    /// The retraction ends in contact, where the tension is largest.
    WithoutEnd,
    /// Both are in the file, and the approach is used.
    Approach,
    ApproachAlone,
    /// Both are in the file, and the retraction is used.
    Retraction,
    RetractionAlone,
    /// The approach begins in contact.
    WithoutBegin,
}

const PARTS: [Parts; 7] = [
    Parts::Both,
    Parts::WithoutEnd,
    Parts::Approach,
    Parts::ApproachAlone,
    Parts::Retraction,
    Parts::RetractionAlone,
    Parts::WithoutBegin,
];

/// The sphere of the first example of this crate on an instrument of this stiffness in N/m.
fn sphere(stiffness: f64) -> Sphere {
    Sphere {
        radius: 1e-4,
        work: 0.05,
        modulus: 2e6 / 0.75,
        stiffness,
    }
}

/// A curve of a sphere.
#[derive(Clone, Copy, Debug)]
struct Case {
    sphere: Sphere,
    /// Number of points of approach and of retraction.
    half: usize,
    parts: Parts,
    noise: Noise,
}

impl Case {
    fn curve(self) -> MeasuredCurve {
        let sphere = self.sphere;
        let [_, top] = sphere.at_force(5.0 * sphere.pull_off());
        let end = sphere.separation();
        let way = top - end;
        let far = end - 0.6 * way;
        let turns = match self.parts {
            Parts::WithoutEnd => vec![far, top, end + 0.02 * way],
            Parts::ApproachAlone => vec![far, top],
            Parts::RetractionAlone => vec![top, far],
            Parts::WithoutBegin => vec![0.0, top, far],
            _ => vec![far, top, far],
        };
        let step = (top - far) / self.half as f64;
        // The path begins without contact, also where the curve begins later.
        let whole = path(&[&[far], &turns[..]].concat(), step);
        let mut forces = sphere.forces(&whole);
        let ahead = whole.len() - path(&turns, step).len();
        let displacements = &whole[ahead..];
        forces.drain(..ahead);
        self.noise
            .add(&mut forces, 0.007 * sphere.pull_off(), self.half as u64);
        let options = CurveOptions {
            segments: match self.parts {
                Parts::Approach | Parts::ApproachAlone => vec![1],
                Parts::Retraction | Parts::WithoutBegin => vec![2],
                _ => Vec::new(),
            },
            ..CurveOptions::default()
        };
        MeasuredCurve::from_columns(displacements, &forces, &options).unwrap()
    }

    /// The scene with the true values times these factors.
    fn document(self, work: f64, modulus: f64) -> Document {
        let sphere = self.sphere;
        let changes = [
            ("form.radius", sphere.radius),
            ("length", 1e-4),
            ("loading_stiffness", sphere.stiffness),
            ("adhesion.work", work * sphere.work),
        ];
        let changes = changes.map(|(path, value)| (path.to_owned(), format!("{value:e}")));
        let modulus = format!("(modulus: {:e})", modulus * sphere.modulus);
        open("jkr-sphere")
            .and_then(|scene| scene.set("numerics.points", "512"))
            .and_then(|scene| scene.set("material", &modulus))
            .and_then(|scene| scene.set_all(&changes))
            .unwrap()
    }

    /// Asserts that a fit has found work and modulus to this share, or within twice its interval.
    fn assert_found(self, fit: &FitResult, share: f64) {
        for found in &fit.parameters {
            let truth = match found.parameter {
                Parameter::Work => self.sphere.work,
                Parameter::Modulus => self.sphere.modulus,
                _ => continue,
            };
            let (low, high) = found.interval;
            let allowed = (share * truth).max(high - low);
            assert!(
                (found.value - truth).abs() < allowed,
                "{self:?}: {found:?}, misfit {:.2}",
                fit.misfit
            );
            assert!(
                high - low < 0.6 * truth,
                "{self:?}: the interval is wide: {found:?}"
            );
        }
    }
}

/// With white noise the fit describes the curve. Coloured noise and rounding may look like more.
fn assert_is_found(case: Case, free: &str) {
    let curve = case.curve();
    let fit = fit_from(&curve, &case.document(1.0, 1.0), free);
    case.assert_found(&fit, 0.03);
    if matches!(case.noise, Noise::Alternating | Noise::White) {
        assert!(fit.describes(), "{case:?} {free}: {:?}", fit.reason);
    }
}

/// Stiffnesses of the instrument in N/m, parts of the curve, and free parameters.
type Kind = (f64, &'static [Parts], &'static str);

/// A fit that does not search the first touch takes the best one, and not a work of adhesion of 0:
/// the touch that the curve shows may be off by more than the distance of two points.
const KINDS: [Kind; 5] = [
    (20.0, &PARTS, "work"),
    (2000.0, &[Parts::Approach, Parts::RetractionAlone], "work"),
    (20.0, &PARTS, "work,offset"),
    (2000.0, &[Parts::Both, Parts::Retraction], "modulus,offset"),
    (
        20.0,
        &[Parts::Both, Parts::WithoutEnd, Parts::RetractionAlone],
        "work,modulus,offset",
    ),
];

/// Fits curves of all kinds and parts with some of the noises. `noises` returns these noises for
/// the number of a curve.
fn assert_all_are_found(noises: impl Fn(usize) -> Vec<Noise>) {
    let mut number = 0;
    for (stiffness, parts, free) in KINDS {
        for &parts in parts {
            for noise in noises(number) {
                let sphere = sphere(stiffness);
                let case = Case {
                    sphere,
                    half: 100,
                    parts,
                    noise,
                };
                assert_is_found(case, free);
            }
            number += 1;
        }
    }
}

/// Each kind and part with one noise, in turn.
#[test]
fn one_to_three_free_parameters_are_found() {
    assert_all_are_found(|number| vec![NOISES[number % NOISES.len()]]);
}

/// Each kind and part with other noises than in the test above: one by default, and all four of
/// them with `TEST_EFFORT=4`.
#[test]
#[ignore = "a hundred fits take a minute or more"]
fn one_to_three_free_parameters_are_found_with_other_noises() {
    let count = cases(1, NOISES.len() as u64 - 1) as usize;
    let others = |number: usize| {
        let places = number + 1..=number + count;
        places.map(|place| NOISES[place % NOISES.len()]).collect()
    };
    assert_all_are_found(others);
}

/// Works and moduli of the scene that are 10 or 1000 times too large or too small change nothing.
#[test]
fn no_start_changes_the_result() {
    let case = Case {
        sphere: sphere(20.0),
        half: 100,
        parts: Parts::Both,
        noise: Noise::Alternating,
    };
    let curve = case.curve();
    for factor in [1e-3, 0.1, 10.0, 1e3] {
        let fit = fit_from(&curve, &case.document(factor, 1.0), "work,offset");
        case.assert_found(&fit, 0.01);
        let fit = fit_from(&curve, &case.document(factor, 1.0 / factor), "work,modulus");
        case.assert_found(&fit, 0.01);
    }
}

/// 30 points in each direction, and so many that neighbours are averaged, by which an alternating
/// noise vanishes. By default half of the curves are fitted, and all of them with `TEST_EFFORT=2`.
#[test]
#[ignore = "fits of many points take a minute or more"]
fn few_and_many_points_are_enough() {
    let noises = [Noise::Alternating, Noise::White];
    for half in [30, 2500] {
        for (number, (parts, free)) in [
            (Parts::Both, "work"),
            (Parts::Both, "work,modulus,offset"),
            (Parts::Approach, "work,offset"),
            (Parts::Retraction, "work,offset"),
        ]
        .into_iter()
        .enumerate()
        {
            for place in number..number + cases(1, noises.len() as u64) as usize {
                let case = Case {
                    sphere: sphere(20.0),
                    half,
                    parts,
                    noise: noises[place % noises.len()],
                };
                let fit = fit_from(&case.curve(), &case.document(1.0, 1.0), free);
                case.assert_found(&fit, 0.05);
            }
        }
    }
}

/// A retraction alone that ends in contact has no zero of the force, though its end, where the
/// tension is largest, may be flat. It is refused. With an approach it shows no pull-off.
#[test]
fn an_end_in_contact_is_no_zero() {
    for stiffness in [20.0, 300.0, 2000.0, 1e5] {
        for half in [70, 100, 150, 400] {
            for noise in [Noise::Alternating, Noise::White] {
                let case = Case {
                    sphere: sphere(stiffness),
                    half,
                    parts: Parts::WithoutEnd,
                    noise,
                };
                let curve = case.curve();
                assert!(!curve.detaches, "{case:?}");
                assert!(curve.drag.is_none(), "{case:?}: {:?}", curve.drag);
                let turn = curve.segment.partition_point(|segment| *segment == 0);
                let retraction = MeasuredCurve::from_columns(
                    &curve.displacement[turn..],
                    &curve.force[turn..],
                    &CurveOptions::default(),
                );
                assert!(retraction.is_err(), "{case:?}");
            }
        }
    }
}

/// A drag of a fluid is no tension of a contact: a curve without adhesion, whose retraction is
/// lower by half of the largest force, has a part without contact at its end.
#[test]
fn a_drag_is_no_end_in_contact() {
    let force = |at: f64| 4.0 / 3.0 * 2e6 * (7.5e-6 * at.max(0.0).powi(3)).sqrt();
    let way = path(&[-2e-6, 1e-6, -2e-6], 1e-8);
    let half = way.len() / 2;
    let drag = 0.25 * force(1e-6);
    let mut forces = Vec::with_capacity(way.len());
    for (index, at) in way.iter().enumerate() {
        forces.push(force(*at) + if index <= half { drag } else { -drag });
    }
    Noise::White.add(&mut forces, 1e-3 * drag, 5);
    let curve = MeasuredCurve::from_columns(&way, &forces, &CurveOptions::default()).unwrap();
    let pulled = curve.drag.unwrap().pulled;
    assert!((pulled / (-2.0 * drag) - 1.0).abs() < 0.01, "{pulled:e}");
    let changes = [("form.radius", "7.5e-6"), ("length", "1e-5")];
    let changes = changes.map(|(path, value)| (path.to_owned(), value.to_owned()));
    let document = open("jkr-sphere").unwrap().set_all(&changes).unwrap();
    let fit = fit_from(&curve, &document, "work,modulus,offset");
    let most = 5e-3 * drag / (1.5 * PI * 7.5e-6);
    assert!(fit.parameters[0].value < most, "{:?}", fit.parameters[0]);
    assert!((fit.parameters[1].value / 2e6 - 1.0).abs() < 0.01);
}
