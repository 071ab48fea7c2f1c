//! Test: the relaxation of a half-space is found from the curve of a sphere.

use crate::common::fit_from;
use crate::common::sphere::{add_noise, path};
use asperity_contact::Direction;
use asperity_experiment::{CurveOptions, FitResult, Free, MeasuredCurve, Parameter};
use asperity_scene::instrument::DisplacementCurve;
use asperity_scene::{Document, open, run};

/// Stiffness of the instrument in N/m.
const STIFFNESS: f64 = 3.0;
/// Displacement in m at which the instrument turns.
const TOP: f64 = 2e-6;

/// A sphere on rubber that relaxes, whose instrument turns after a rest of `rest` seconds.
fn document(work: f64, modulus: f64, share: f64, time: f64, rest: f64) -> Document {
    let changes = [
        ("form.radius", "7.5e-6".to_owned()),
        ("length", "2.4e-5".to_owned()),
        (
            "material",
            format!("(modulus: {modulus:e}, relaxation: (share: {share}, time: {time}))"),
        ),
        ("adhesion.work", work.to_string()),
        ("loading_stiffness", STIFFNESS.to_string()),
        ("loading_speed", "1e-6".to_owned()),
        (
            "loading",
            format!("[ToDisplacement({TOP:e}), Hold({rest}), ToSeparation]"),
        ),
        ("numerics.points", "1024".to_owned()),
        ("numerics.samples", "1024".to_owned()),
    ];
    let changes = changes.map(|(path, value)| (path.to_owned(), value));
    open("jkr-sphere").unwrap().set_all(&changes).unwrap()
}

/// The curve of a scene with noise of 1 nN, and its parts without contact.
fn curve_of(document: &Document, seed: u64) -> MeasuredCurve {
    let outcome = run(document).unwrap();
    let stages = &outcome.history.stages;
    let approach = DisplacementCurve::new(Direction::Loading, &stages[0].curve, STIFFNESS);
    let last = stages.last().unwrap();
    let retraction = DisplacementCurve::new(Direction::Unloading, &last.curve, STIFFNESS);
    let way = path(&[-1e-6, TOP, -3e-6], 1e-8);
    let turn = way.iter().position(|at| *at >= TOP - 1e-12).unwrap();
    let mut forces = Vec::new();
    for (index, at) in way.iter().enumerate() {
        let part = if index <= turn {
            &approach
        } else {
            &retraction
        };
        forces.push(part.at(*at).map_or(0.0, |point| point.force));
    }
    add_noise(&mut forces, 1e-9, seed);
    MeasuredCurve::from_columns(&way, &forces, &CurveOptions::default()).unwrap()
}

/// Returns the number of intervals that hold the truth.
fn held(fit: &FitResult, truth: &[(Parameter, f64)]) -> usize {
    let mut held = 0;
    for (parameter, value) in truth {
        let found = fit
            .parameters
            .iter()
            .find(|found| found.parameter == *parameter)
            .unwrap();
        let (low, high) = found.interval;
        held += usize::from((low..=high).contains(value));
        println!("{parameter:?}: {value:e}, found {found:?}");
    }
    held
}

#[test]
#[ignore = "a fit of relaxation takes a minute or more"]
fn the_relaxation_of_rubber_is_found() {
    let document = document(0.05, 1.5e6, 0.3, 2.0, 1.0);
    let curve = curve_of(&document, 1);
    let start = document.set("material", "(modulus: 1.0e6)").unwrap();
    let free = "work,modulus,offset,relaxation_share,relaxation_time";
    let fit = fit_from(&curve, &start, free);
    let truth = [
        (Parameter::Work, 0.05),
        (Parameter::Modulus, 1.5e6),
        (Parameter::RelaxationShare, 0.3),
        (Parameter::RelaxationTime, 2.0),
    ];
    assert!(held(&fit, &truth) >= 3, "{:?}", fit.misfit);
    for (parameter, value) in truth {
        let found = fit.parameters.iter().find(|one| one.parameter == parameter);
        let found = found.unwrap().value;
        assert!(
            (found / value - 1.0).abs() < 0.2,
            "{parameter:?}: {found:e}"
        );
    }
    assert!(fit.describes(), "{}", fit.misfit);
    // The document of the fit has the relaxation and the rest, and can be computed.
    let relaxation = fit.document.scene().material.relaxation.unwrap();
    assert!((relaxation.share / 0.3 - 1.0).abs() < 0.2);
    assert!(run(&fit.document).unwrap().figures.pull_off_force.is_some());
}

#[test]
fn a_relaxation_needs_a_speed() {
    let document = document(0.05, 1.5e6, 0.3, 2.0, 1.0);
    let curve = curve_of(&document, 1);
    let start = document.set_all(&[
        ("material".to_owned(), "(modulus: 1.0e6)".to_owned()),
        ("loading_speed".to_owned(), "None".to_owned()),
    ]);
    let free: [Free; 2] = ["work", "relaxation_share"].map(|one| one.parse().unwrap());
    let refused = asperity_experiment::Fit::of(&start.unwrap())
        .free(free[0])
        .free(free[1])
        .run(&curve, asperity_data::Control::default())
        .unwrap_err();
    assert!(refused.to_string().contains("loading_speed"), "{refused}");
}
