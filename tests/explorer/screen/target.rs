//! The headline of random profiles, and the value of a row for a target.

use super::*;
use asperity::explorer::commands::target::Sought;
use asperity::scene::open;
use asperity::study::{Ensemble, Quantity};
use std::f64::consts::PI;

/// The explorer on a scene, with the answers to targets and the random profiles.
fn asked(document: Document) -> Driver {
    let performs = |study: &Study| study.is::<Sought>() || study.is::<Ensemble>();
    let mut driver = Driver::open_with(document, Simulation::run, performs);
    driver.perform(vec![Task::Ask]);
    driver.press("Space");
    driver
}

/// Adhesion forces of the scene on the profiles of this number of seeds, ascending, N.
fn forces(driver: &Driver, profiles: u64) -> Vec<f64> {
    let scene = driver.document().scene();
    let force = |line: u64| {
        let scene = scene.with_seed(scene.seed().unwrap() + line);
        let outcome = Simulation::default()
            .run(&scene, &|| false, &mut |_, _, _| Ok(()))
            .unwrap();
        outcome.figures.adhesion_force.unwrap()
    };
    let mut forces: Vec<f64> = (0..profiles).map(force).collect();
    forces.sort_by(f64::total_cmp);
    forces
}

#[test]
fn the_headline_is_the_median_of_random_profiles() {
    let mut driver = asked(rough());
    let forces = forces(&driver, Ensemble::PROFILES);
    let median = f64::midpoint(forces[7], forces[8]);
    let rounded = asperity::data::format_rounded(median, 3, "N");
    let status = driver.status();
    assert!(
        status.starts_with(&format!("F_a median {rounded} (")),
        "{rounded}: {status}"
    );
    assert!(
        status.contains(", 16 profiles) · this profile 46.1 nN"),
        "{status}"
    );
    driver.shows("F_a/F_a,max ");
    // In units of F_a,max.
    driver.press("N");
    let ideal = driver.outcome().ideal_adhesion_force.unwrap();
    let share = asperity::data::format_rounded(median / ideal, 3, "1");
    driver.states(format!("F_a/F_a,max median {share}"));
    // A title changes no profile, another number does.
    let computed = |driver: &Driver| driver.app.studies.value::<Ensemble>().cloned();
    let before = computed(&driver);
    driver.set("title", "Another");
    assert_eq!(computed(&driver), before);
    driver.set("adhesion.kappa", "7");
    assert_ne!(computed(&driver), before);
    // A smooth body has one profile.
    let driver = asked(smooth());
    assert!(
        driver.status().contains(", fixed profile") && computed(&driver).is_none(),
        "{}",
        driver.status()
    );
}

#[test]
fn a_value_is_found_for_a_target_and_taken() {
    // F_a = (3/2)πγR.
    let document = changed(&open("jkr-sphere").unwrap(), &[("numerics.points", "2048")]);
    let mut driver = asked(document);
    driver.select("adhesion.work");
    driver.press("f Ctrl+u `F_a = 5 µN`");
    let exact = 5e-6 / (1.5 * PI * 1e-4);
    driver.shows("γ = 10.6");
    driver.shows("Enter takes");
    driver.press("Enter");
    let work = driver.document().scene().adhesion.unwrap().work().unwrap();
    assert!((work / exact - 1.0).abs() < 1e-3, "{work} {exact}");
    assert!((driver.outcome().figures.adhesion_force.unwrap() / 5e-6 - 1.0).abs() < 1e-6);
    driver.press("u");
    assert_ne!(
        driver.document().scene().adhesion.unwrap().work(),
        Some(work)
    );
}

#[test]
fn a_preload_is_found_on_the_profiles_and_goes_to_the_stage_that_presses() {
    let mut driver = asked(rough());
    driver.select("loading");
    driver.press("f Ctrl+u `F_a/F_a,max = 0.2 %`");
    driver.shows("F_n = ");
    driver.press("Enter");
    assert!(driver.app.prompt.is_none(), "{}", driver.text());
    let ensemble = driver.app.studies.value::<Ensemble>().unwrap();
    let reached = ensemble
        .values(Quantity::AdhesionShare)
        .into_iter()
        .flatten();
    // The median preload suffices for half of the profiles.
    let reached = reached
        .filter(|share| *share >= 0.002 * (1.0 - 1e-6))
        .count();
    assert!((7..=9).contains(&reached), "{reached}");
    // What is out of reach is said, and the question stays.
    driver.press("f Ctrl+u `F_a/F_a,max = 99 %`");
    driver.shows("never reached");
    driver.press("Enter");
    assert!(
        driver
            .refusal()
            .is_some_and(|why| why.contains("never reached")),
        "{}",
        driver.text()
    );
}

#[test]
fn a_target_that_cannot_be_read_and_a_row_without_a_number_are_refused() {
    let mut driver = asked(rough());
    driver.select("roughness.hurst");
    for (typed, why) in [
        ("nothing", "allowed"),
        ("F_a/F_a,max = 120 %", "allowed: from 0"),
        ("κ = 2", "κ"),
    ] {
        driver.press(&format!("f Ctrl+u `{typed}`"));
        driver.shows(why);
        driver.press("Enter");
        assert!(driver.refusal().is_some(), "{typed}: {}", driver.text());
        driver.press("Esc");
    }
    driver.select("title");
    driver.answers("f", "title has no number to find");
}
