//! Failures, late reports and panics.

use super::common::deadline::within;
use super::common::driver::Driver;
use super::common::scenes::rough;
use super::{generation, is_up_to_date, pressed};
use asperity::contact::ContactError;
use asperity::explorer::action::Action;
use asperity::explorer::snapshot::Report;
use asperity::explorer::update::Effect;
use asperity::simulation::RunError;

#[test]
fn reports_of_another_scene_change_nothing() {
    within(30, || {
        let mut driver = pressed("");
        let (computed, snapshot) = (driver.app.solved.clone().unwrap(), driver.app.snapshot.clone().unwrap());
        driver.select("roughness.hurst");
        driver.press("l");
        let screen = driver.screen();
        let generation = computed.generation;
        for action in [
            Action::Report(Report::Solved(computed, None)),
            Action::Report(Report::Shown(snapshot)),
            Action::Report(Report::Progress { generation, legs: 1 }),
            Action::Report(Report::Failed { generation, error: "old".to_owned() }),
        ] {
            assert!(driver.act(action).is_empty());
            assert_eq!(driver.screen(), screen);
        }
    });
}

#[test]
fn a_scene_that_fails_is_stated_and_the_next_edit_mends_it() {
    within(30, || {
        let mut driver = pressed("");
        driver.select("loading");
        driver.enter("[ToForce(2.0e-5), ToForce(-1.0)]");
        assert!(!driver.app.is_computing());
        let text = driver.text();
        assert!(text.contains("the contact detaches above that force"), "{text}");
        // Figures of the former scene are no longer shown.
        assert!(!text.contains("F_a "), "{text}");
        for keys in ["j", "k", ". .", "Tab", "n", "+"] {
            driver.press(keys);
        }
        assert!(driver.text().contains("the contact detaches above that force"), "{}", driver.text());
        driver.press("u");
        assert!(driver.status().starts_with("undo: "), "{}", driver.status());
        driver.press("j");
        let text = driver.text();
        assert!(text.contains("F_a ") && !text.contains("detaches above"), "{text}");
        assert!(is_up_to_date(&driver.app));
    });
}

#[test]
fn a_panic_of_the_worker_is_a_line_and_the_explorer_goes_on() {
    within(30, || {
        let mut driver = Driver::open_with(
            rough(),
            |simulation, scene, stop, after| {
                assert!(scene.seed() != Some(13), "thirteen");
                simulation.run(scene, stop, after)
            },
            |_| false,
        );
        driver.perform(vec![Effect::Ask]);
        driver.select("roughness.seed");
        driver.enter("13");
        assert!(
            driver.text().contains("internal error") && driver.text().contains("thirteen"),
            "{}",
            driver.text()
        );
        for keys in [". ,", "n p f", "z z", "Tab", "Space", "r"] {
            driver.press(keys);
            driver.elapse(0.1);
            driver.screen();
        }
        driver.enter("14");
        assert!(is_up_to_date(&driver.app));
        assert!(driver.text().contains("F_a "), "{}", driver.text());
    });
}

#[test]
fn an_interrupted_run_is_no_failure() {
    assert!(RunError::from(ContactError::Interrupted).is_interruption());
    within(30, || {
        let mut driver = pressed("");
        let of_before = generation(&driver);
        driver.press("l l l");
        assert_eq!(generation(&driver), of_before + 3);
        assert!(driver.app.message.is_none());
    });
}
