//! Test: the stiffness of the instrument from a curve on a hard specimen, and the comparison of a
//! fitted stiffness with the stated one.

use crate::common::fit_from;
use crate::common::sphere::{Sphere, add_noise, path};
use asperity_experiment::{CurveOptions, FitResult, MeasuredCurve, Parameter, Reason};
use asperity_scene::open;

/// Fits the curve of a sphere with this modulus in Pa, whose force is multiplied by `times`. The
/// true stiffness is 3 N/m; the scene states `stated`.
fn fitted(modulus: f64, length: &str, times: f64, stated: &str, free: &str) -> FitResult {
    let sphere = Sphere {
        radius: 7.5e-6,
        work: 0.05,
        modulus,
        stiffness: 3.0,
    };
    let [_, top] = sphere.at_force(2e-6);
    let way = path(&[-1e-6, top, -2e-6], 4e-9);
    let mut forces = sphere.forces(&way);
    add_noise(&mut forces, 2e-9, 1);
    for force in &mut forces {
        *force *= times;
    }
    let curve = MeasuredCurve::from_columns(&way, &forces, &CurveOptions::default()).unwrap();
    let mut document = open("jkr-sphere").unwrap();
    let material = format!("(modulus: {:e})", modulus * times);
    for (path, value) in [
        ("form.radius", "7.5e-6"),
        ("length", length),
        ("material", &material),
        ("loading_stiffness", stated),
        ("numerics.points", "512"),
    ] {
        document = document.set(path, value).unwrap();
    }
    fit_from(&curve, &document, free)
}

fn stiffness_of(fit: &FitResult) -> f64 {
    let found = fit
        .parameters
        .iter()
        .find(|found| found.parameter == Parameter::Stiffness);
    found.unwrap().value
}

fn sentences_of(fit: &FitResult) -> String {
    let sentences: Vec<String> = fit.assumptions.iter().map(ToString::to_string).collect();
    sentences.join(" ")
}

/// On a hard specimen the slope of the curve is the stiffness. It is the value at which the search
/// begins, and the fit finds it whatever the scene states.
#[test]
fn a_hard_specimen_gives_the_stiffness_and_the_sensitivity() {
    let fit = fitted(1e11, "1e-6", 1.0, "2.5", "work,offset,stiffness");
    let found = stiffness_of(&fit);
    assert!((found / 3.0 - 1.0).abs() < 0.003, "{found}");
    let start = fit.parameters.last().unwrap().start;
    assert!((start / 3.0 - 1.0).abs() < 0.05, "{start}");
    assert!(fit.describes(), "{} {:?}", fit.misfit, fit.reason);
    let said = sentences_of(&fit);
    assert!(
        said.contains("The specimen is hard") && said.contains("k is 1.2 times the stated 2.5 N/m"),
        "{said}"
    );
    // A stiffness that agrees needs no sentence on the sensitivity.
    let fit = fitted(1e11, "1e-6", 1.0, "3", "work,offset,stiffness");
    let said = sentences_of(&fit);
    assert!(
        said.contains("The specimen is hard") && !said.contains("sensitivity"),
        "{said}"
    );
}

/// If the contact is about as compliant as the instrument, the stiffness depends on the modulus,
/// and a sentence says so.
#[test]
fn a_soft_specimen_is_named() {
    let fit = fitted(2e6, "2.4e-5", 1.0, "3", "work,offset,stiffness");
    let said = sentences_of(&fit);
    assert!(
        said.contains("not hard enough to find k without E*"),
        "{said}"
    );
    assert!((stiffness_of(&fit) / 3.0 - 1.0).abs() < 0.05);
    // With a free modulus the correlation of both says this.
    let fit = fitted(2e6, "2.4e-5", 1.0, "3", "work,modulus,offset,stiffness");
    assert!(!sentences_of(&fit).contains("hard"));
    assert_eq!(fit.reason, None);
}

/// A force in a wrong unit makes the fitted stiffness 1000 times too large or too small. The model
/// agrees with such a curve, but the fit is not called a description.
#[test]
fn a_stiffness_far_from_the_stated_one_names_the_units() {
    for (times, said) in [
        (1e3, "is 1000 times the stated 3 N/m"),
        (1e-3, "is 1000 times smaller than the stated 3 N/m"),
    ] {
        let fit = fitted(2e6, "2.4e-5", times, "3", "work,modulus,offset,stiffness");
        assert!(
            matches!(fit.reason, Some(Reason::StiffnessFarFromStated { stated, .. }) if stated == 3.0),
            "{times}: {:?}",
            fit.reason
        );
        assert!(!fit.describes() && fit.misfit < 1.5, "{}", fit.misfit);
        let reason = fit.reason.unwrap().to_string();
        assert!(
            reason.contains(said) && reason.contains("Check the units of the force."),
            "{reason}"
        );
    }
}
