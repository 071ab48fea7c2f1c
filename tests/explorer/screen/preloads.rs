//! Adhesion against preload beside the force curve.

use super::common::deadline::within;
use super::common::driver::Driver;
use super::common::scenes::{rough, without_adhesion};
use super::stand_in::StandIn;
use asperity::explorer::app::Pane;
use asperity::explorer::panes::PROFILES;
use asperity::explorer::runtime::Studies;
use asperity::explorer::study::{PaneData, Task};
use asperity::explorer::update::{Effect, study_tasks};
use asperity::scene::Document;
use std::cell::RefCell;

/// Computes the curve up to this number of profiles.
fn computing(profiles: usize) -> StandIn {
    StandIn::new(move |data, _, report| {
        let last = RefCell::new(data.clone());
        let is_enough =
            || matches!(&*last.borrow(), PaneData::Preloads(curve) if curve.profiles() >= profiles);
        let done = data.extended(&is_enough, &mut |data| {
            last.replace(data.clone());
            report(data);
        });
        match done {
            // The data suffice.
            Err(_) if is_enough() => Ok(last.into_inner()),
            done => done,
        }
    })
}

/// The explorer with the curve of few profiles computed, and shown.
pub fn computed_preloads(document: Document) -> Driver {
    shown(document, 3)
}

fn shown(document: Document, profiles: usize) -> Driver {
    let mut driver = Driver::open(document);
    driver.studies = Studies::Inline(Box::new(computing(profiles)));
    driver.perform(vec![Effect::Ask]);
    driver.press("Space i");
    driver
}

#[test]
fn adhesion_against_preload_is_shown_beside_the_curve() {
    within(120, || {
        for profiles in [PROFILES, 3] {
            let mut driver = shown(rough(), profiles);
            for size in [(120, 40), (80, 24)] {
                driver.resize(size);
                let text = driver.text();
                for words in ["Adhesion against preload", "present preload", "Parameters", "this profile"] {
                    assert!(text.contains(words), "{words}\n{text}");
                }
                assert_eq!(text.contains("3 of 16 profiles"), profiles == 3, "{text}");
                assert!(text.contains(&format!("mean of {profiles} profiles")), "{text}");
            }
        }
    });
}

#[test]
fn the_pane_takes_the_place_of_map_and_accuracy_and_gives_it_back() {
    within(60, || {
        let mut driver = shown(rough(), 1);
        assert_eq!(driver.app.panes(), [Pane::Force, Pane::Preloads, Pane::Parameters]);
        // No map and no table is computed.
        driver.studies = Studies::None;
        for (keys, pane) in
            [("m", Some(Pane::Chart)), ("i", Some(Pane::Preloads)), ("A", Some(Pane::Accuracy))]
        {
            driver.press(keys);
            assert_eq!(driver.app.view.large, pane, "{keys}");
        }
        driver.press("i i");
        assert_eq!((driver.app.view.large, driver.app.view.pane), (None, Pane::Force));
    });
}

#[test]
fn an_edit_begins_a_new_curve_and_a_scene_without_one_says_why() {
    within(60, || {
        let mut driver = shown(rough(), 2);
        let before = driver.app.studies.preloads.clone().unwrap();
        assert_eq!(before.profiles(), 2);
        // The computation continues from the present data.
        let goes_on = |driver: &Driver| {
            study_tasks(&driver.app).into_iter().find_map(|task| match task {
                Task::Extend { data: PaneData::Preloads(curve), waits } => Some((curve.profiles(), waits)),
                _ => None,
            })
        };
        assert_eq!(goes_on(&driver), Some((2, false)));
        driver.studies = Studies::None;
        driver.select("roughness.hurst");
        driver.press("l");
        assert_eq!(driver.app.studies.preloads, None);
        assert_eq!(goes_on(&driver), Some((0, true)));
        let driver = shown(without_adhesion(), 2);
        assert_eq!(goes_on(&driver), None);
        assert!(driver.text().contains("without adhesion nothing holds"), "{}", driver.text());
    });
}
