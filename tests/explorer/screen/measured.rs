//! A measured force curve beside the scene.

use super::*;
use asperity::experiment::{CurveOptions, Drift, Fit, MeasuredCurve};
use asperity::explorer::measured::Fitting;
use asperity::explorer::measured::Measured;
use std::fmt::Write;
use std::sync::Arc;

/// A sphere that is pressed by 50 µN and pulled off.
fn sphere(work: &str) -> Document {
    let fields = [("numerics.points", "256"), ("numerics.samples", "200"), ("adhesion.work", work)];
    open("jkr-sphere").unwrap().set_all(&fields.map(|(path, value)| (path.into(), value.into()))).unwrap()
}

/// The curve of a sphere of 50 mJ/m² with a ripple of 0.3 µN, 400 nm from its first touch.
fn curve() -> MeasuredCurve {
    let scene = sphere("0.05").scene().clone();
    let outcome = Simulation::default().run(&scene, &|| false, &mut |_, _, _| Ok(())).unwrap();
    let free = |from: f64| (0..100).map(move |index| (from - 1e-8 * f64::from(index), 0.0));
    let legs = &outcome.history.legs;
    let touching = |leg: usize| legs[leg].curve.iter().filter(|point| point.springs > 0);
    let points = |leg: usize| touching(leg).map(|point| (point.indentation, point.force));
    let last = legs[1].curve.last().unwrap().indentation;
    let approach = free(-1e-8).collect::<Vec<_>>().into_iter().rev().chain(points(0));
    let mut text = "displacement [nm],force [uN]\n".to_owned();
    for (index, (at, force)) in approach.chain(points(1)).chain(free(last - 1e-8)).enumerate() {
        let ripple = 0.3 * (1.7 * index as f64).sin();
        writeln!(text, "{},{}", 1e9 * at + 400.0, 1e6 * force + ripple).unwrap();
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("curve.csv");
    fs::write(&path, text).unwrap();
    MeasuredCurve::read(&path, &options()).unwrap()
}

fn options() -> CurveOptions {
    CurveOptions { drift: Drift::Remove, noise: Some(2e-7), ..CurveOptions::default() }
}

/// The explorer on a sphere of another work of adhesion, with the curve.
fn shown() -> Driver {
    let measured = Some(Measured::new("curve.csv".to_owned(), curve(), &options()));
    let opening = Opening { measured, ..Opening::from(sphere("0.03")) };
    let is_of_curve =
        |study: &asperity::explorer::studies::Study| study.is::<Arc<Fit>>() || study.is::<Fitting>();
    let mut driver = Driver::open_with(opening, Simulation::run, is_of_curve);
    driver.perform(vec![Task::Ask]);
    driver
}

/// Number before `× noise` in the status line.
fn residual(driver: &Driver) -> f64 {
    let text = driver.text();
    let before = text.split(" × noise").next().unwrap();
    before.rsplit(' ').next().unwrap().parse().unwrap_or_else(|_| panic!("{text}"))
}

#[test]
fn the_residual_of_a_measured_curve_follows_the_scene_and_a_fit_can_be_undone() {
    let mut driver = shown();
    assert!(driver.pane(Pane::Force).concat().contains("● measured"), "{}", driver.text());
    driver.shows("the loading of the measured curve");
    driver.press("Space");
    let far = residual(&driver);
    driver.set("adhesion.work", "0.049 J/m²");
    let near = residual(&driver);
    assert!(far > 2.0 * near && near < 3.0, "{far} {near}");
    let measured = driver.app.measured.clone().unwrap();
    assert!((measured.offset - 4e-7).abs() < 2e-8, "{}", measured.offset);
    // The measured points lie on the curve of the scene.
    let points = measured.points(f64::INFINITY).into_iter();
    let least = points.min_by(|one, other| one.force.total_cmp(&other.force)).unwrap().indentation;
    let pull_off = driver.outcome().figures.pull_off_indentation.unwrap();
    assert!((least - pull_off).abs() < 5e-8, "{least} {pull_off}");

    driver.press("Ctrl+f Ctrl+u `work,ofset` Enter");
    assert!(
        driver.refusal().is_some_and(|why| why.contains("did you mean offset?")),
        "{:?}",
        driver.refusal()
    );
    driver.press("Ctrl+u `work, offset` Enter");
    let work = driver.document().scene().adhesion.unwrap().work().unwrap();
    assert!((work - 0.05).abs() < 5e-4, "{work}");
    driver.shows_all(["fit: γ ", "u undoes"]);
    driver.press(".");
    assert!(is_up_to_date(&driver.app) && residual(&driver) < near, "{}", driver.text());

    for (name, expected) in
        [("fit.csv", "displacement,force,model,residual"), ("fit.svg", "residual over noise")]
    {
        driver.press("E Ctrl+u");
        driver.type_text(name);
        driver.press("Enter");
        assert!(driver.file(name).contains(expected), "{name}");
    }
    assert!(driver.file("fit.csv").contains(
        "# command: asperity fit curve.csv --drift=remove --noise=2e-7N --free=work,offset jkr-sphere"
    ));
    driver.press("u");
    assert_eq!(driver.document().scene().adhesion.unwrap().work(), Some(0.049));
}
