//! Failures, late reports and panics.

use super::common::driver::Driver;
use super::{is_up_to_date, pressed};
use asperity::explorer::action::Action;
use asperity::explorer::snapshot::Reply;

#[test]
fn reports_of_another_scene_change_nothing() {
    let mut driver = pressed("");
    let (computed, snapshot) = (driver.app.solved.clone().unwrap(), driver.snapshot().clone());
    driver.select("roughness.hurst");
    driver.press("l");
    let screen = driver.screen();
    let generation = computed.generation;
    for action in [
        Action::Reply(Reply::Solved(computed, None)),
        Action::Reply(Reply::Shown(snapshot.into())),
        Action::Reply(Reply::Progress { generation, legs: 1 }),
        Action::Reply(Reply::Failed { generation, error: "old".to_owned() }),
    ] {
        assert!(driver.act(action).is_empty());
        assert_eq!(driver.screen(), screen);
    }
}

/// Makes the scene one whose contact detaches before it reaches a force, by switching its adhesion off.
pub fn detach(driver: &mut Driver) {
    driver.select("loading");
    driver.enter("20 µN, -10 nN");
    driver.select("adhesion");
    driver.press("t");
}

#[test]
fn a_scene_that_fails_is_stated_and_the_next_edit_mends_it() {
    let mut driver = pressed("");
    detach(&mut driver);
    assert!(!driver.app.is_computing());
    let text = driver.text();
    assert!(text.contains("stage 2: the contact detaches before -10 nN"), "{text}");
    // Figures of the former scene are no longer shown.
    assert!(!text.contains("F_a "), "{text}");
    for keys in ["j", "k", ". .", "Tab", "n", "+"] {
        driver.press(keys);
    }
    assert!(driver.text().contains("stage 2: the contact detaches before -10 nN"), "{}", driver.text());
    driver.press("u");
    assert!(driver.status().starts_with("undo: "), "{}", driver.status());
    driver.press("j");
    let text = driver.text();
    assert!(text.contains("F_max 20 µN") && !text.contains("detaches"), "{text}");
    assert!(is_up_to_date(&driver.app));
}
