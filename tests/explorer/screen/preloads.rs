//! Adhesion against preload beside the force curve.

use super::*;
use asperity::explorer::commands::accuracy::studies;
use asperity::study::PreloadCurve;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

/// Computes the curve up to this number of profiles.
fn compute(driver: &mut Driver, profiles: usize) {
    let known = AtomicUsize::new(0);
    for study in studies(&mut driver.app)
        .into_iter()
        .filter(|study| study.is::<PreloadCurve>())
    {
        study.perform(
            &mut Simulation::default(),
            &|| known.load(Relaxed) == profiles,
            &mut |finding| {
                driver.act(Action::Found(finding));
                known.store(computed(driver) % PreloadCurve::PROFILES, Relaxed);
            },
        );
    }
}

/// Number of profiles computed so far.
fn computed(driver: &Driver) -> usize {
    driver
        .app
        .studies
        .value::<PreloadCurve>()
        .map_or(0, |curve| curve.profiles())
}

/// The explorer with the curve of few profiles computed, and shown.
pub fn computed_preloads(document: Document) -> Driver {
    shown(document, 3)
}

fn shown(document: Document, profiles: usize) -> Driver {
    let mut driver = Driver::start(document);
    driver.press("Space i");
    compute(&mut driver, profiles);
    driver
}

#[test]
fn adhesion_against_preload_is_shown_beside_the_curve() {
    for profiles in [PreloadCurve::PROFILES, 3] {
        let mut driver = shown(rough(), profiles);
        // A low pane has room for more rows of the chart, since its legend has fewer words.
        for (size, turned) in [
            ((120, 40), "F_a(d=0) 10.2 nN, turned at first touch"),
            ((80, 24), "F_a(d=0) 10.2 nN"),
        ] {
            driver.resize(size);
            driver.shows_all([
                "Pull-off force F_a (",
                "present preload",
                "Parameters",
                "this profile",
            ]);
            assert_eq!(driver.text().contains("3 of 16 profiles"), profiles == 3);
            driver.shows(format!("range of {profiles} profiles"));
            // The status line and the crosshair.
            driver.sees("*", turned);
            driver.shows_all(["F_n ", "this profile ", "median ", "quartiles ", "mean "]);
            driver.press("*");
        }
    }
}

#[test]
fn forces_are_shown_in_units_of_the_ideal_pull_off_force() {
    let mut driver = shown(rough(), 3);
    driver.shows_all(["Pull-off force F_a (", "F_n (", "nN, turned at first touch"]);
    driver.press("N");
    driver.shows_all([
        "Pull-off force F_a/F_a,max",
        "F_n/F_a,max",
        "Force F/F_a,max",
        "d/h",
    ]);
    driver.hides("nN, turned at first touch");
    // The crosshair reads the same place in the other unit.
    let read = |driver: &mut Driver, keys: &str| -> f64 {
        driver.press(keys);
        let text = driver.text();
        let mut after = text
            .split("this profile ")
            .skip(1)
            .filter_map(|rest| rest.split_whitespace().next());
        after
            .find_map(|number| number.parse().ok())
            .unwrap_or_else(|| panic!("{text}"))
    };
    let share = read(&mut driver, "* End");
    let force = read(&mut driver, "N");
    let ideal = driver.outcome().ideal_pull_off_force.unwrap() * 1e6;
    assert!(
        (force / ideal / share - 1.0).abs() < 0.01,
        "{force} µN of {ideal} µN, {share}"
    );
}

#[test]
fn a_key_changes_the_scale_of_the_preloads() {
    let mut driver = shown(rough(), 2);
    let mut range = |keys: &str| {
        driver.press(keys);
        compute(&mut driver, 1);
        let curve = driver.app.studies.value::<PreloadCurve>().unwrap();
        (
            curve.axis.values[0],
            curve.axis.values[curve.axis.values.len() - 1],
        )
    };
    let usual = range("");
    let (from, to) = range("X");
    assert!(
        usual.0 < 0.0 && from > 0.0 && (to / from / 1e6 - 1.0).abs() < 1e-9,
        "{usual:?} {from} {to}"
    );
    assert_eq!(range("X"), usual);
}

#[test]
fn an_edit_begins_a_new_curve_and_a_scene_without_one_says_why() {
    let mut driver = shown(rough(), 2);
    assert_eq!(computed(&driver), 2);
    // The computation continues from the present data.
    compute(&mut driver, 3);
    assert_eq!(computed(&driver), 3);
    driver.select("roughness.hurst");
    driver.press("l");
    assert!(driver.app.studies.value::<PreloadCurve>().is_none());
    compute(&mut driver, 1);
    assert_eq!(computed(&driver), 1);
    let driver = shown(without_adhesion(), 2);
    driver.shows("without adhesion nothing holds");
}
