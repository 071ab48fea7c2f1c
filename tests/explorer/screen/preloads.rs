//! Adhesion against preload beside the force curve.

use super::common::driver::Driver;
use super::common::scenes::{rough, without_adhesion};
use asperity::explorer::action::Action;
use asperity::explorer::app::Pane;
use asperity::explorer::panes::{PROFILES, PreloadCurve};
use asperity::explorer::update::studies;
use asperity::scene::Document;
use asperity::simulation::Simulation;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

/// Computes the curve up to this number of profiles.
fn compute(driver: &mut Driver, profiles: usize) {
    let known = AtomicUsize::new(0);
    for study in studies(&mut driver.app).into_iter().filter(|study| study.is::<PreloadCurve>()) {
        study.perform(&mut Simulation::default(), &|| known.load(Relaxed) == profiles, &mut |finding| {
            driver.act(Action::Found(finding));
            known.store(computed(driver) % PROFILES, Relaxed);
        });
    }
}

/// Number of profiles computed so far.
fn computed(driver: &Driver) -> usize {
    driver.app.studies.value::<PreloadCurve>().map_or(0, |curve| curve.profiles())
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
    for profiles in [PROFILES, 3] {
        let mut driver = shown(rough(), profiles);
        for size in [(120, 40), (80, 24)] {
            driver.resize(size);
            let text = driver.text();
            for words in ["Adhesion against preload", "present preload", "Parameters", "this profile"] {
                assert!(text.contains(words), "{words}\n{text}");
            }
            assert_eq!(text.contains("3 of 16 profiles"), profiles == 3, "{text}");
            assert!(text.contains(&format!("range of {profiles} profiles")), "{text}");
            // The status line and the crosshair.
            assert!(text.contains("from first touch"), "{text}");
            driver.press("*");
            let text = driver.text();
            for curve in ["F_n ", "this profile ", "median ", "quartiles ", "mean "] {
                assert!(text.contains(curve), "{curve}: {text}");
            }
            driver.press("*");
        }
        driver.resize((200, 40));
        let spread = format!(" · {profiles} profiles: median ");
        assert!(
            driver.text().contains(&spread) && driver.text().contains(" this profile ± …"),
            "{}",
            driver.text()
        );
    }
}

#[test]
fn keys_change_the_range_and_the_scale_of_the_preloads() {
    let mut driver = shown(rough(), 2);
    let range = |driver: &Driver| {
        let curve = driver.app.studies.value::<PreloadCurve>().unwrap();
        (curve.axis.values[0], curve.axis.values[curve.axis.values.len() - 1])
    };
    let usual = range(&driver);
    let preload = driver.app.solved.as_ref().unwrap().outcome.figures.preload.unwrap();
    assert!(usual.0 < 0.0 && usual.1 > 1.9 * preload, "{usual:?}");
    let most = driver.app.solved.as_ref().unwrap().reach.force;
    let mut after = |keys: &str| {
        driver.press(keys);
        compute(&mut driver, 1);
        range(&driver)
    };
    let near = |found: (f64, f64), expected: (f64, f64)| {
        let apart = [found.0 - expected.0, found.1 - expected.1];
        assert!(apart.iter().all(|apart| apart.abs() < 1e-9 * preload), "{found:?} for {expected:?}");
    };
    // The preload of the scene keeps its place.
    let closer = after("+");
    near(closer, (preload - 0.5 * (preload - usual.0), preload + 0.5 * (usual.1 - preload)));
    let quarter = 0.25 * (closer.1 - closer.0);
    near(after(")"), (closer.0 + quarter, closer.1 + quarter));
    near(after("( ("), (closer.0 - quarter, closer.1 - quarter));
    near(after("Z"), usual);
    // No preload is below the force at first touch.
    let far = after("( ( (");
    near((far.0, 0.0), (usual.0, 0.0));
    let (from, to) = after("X");
    assert!(from > 0.0 && (to / from / 1e6 - 1.0).abs() < 1e-9);
    // The axis ends far beyond full contact.
    let (wider, end) = after("- -");
    assert!(wider < from && (end / most.max(to) - 1.0).abs() < 1e-9, "{wider} {end} {most}");
    near(after("X"), usual);
    let (_, end) = after("- - - - - - - - - - -");
    assert!((end / most - 1.0).abs() < 1e-9, "{end} {most}");
    near(after("Z"), usual);
    // In another pane the keys have their other meaning.
    driver.app.view.pane = Pane::Force;
    driver.press("+ ( Z");
    assert_eq!(range(&driver), usual);
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
    assert!(driver.text().contains("without adhesion nothing holds"), "{}", driver.text());
}
