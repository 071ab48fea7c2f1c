//! The number of random profiles: its row, its undo, its command.

use super::*;
use asperity::study::Ensemble;

/// The explorer on a scene, with its random profiles.
fn with_profiles(document: Document) -> Driver {
    let mut driver = Driver::open_with(document, Simulation::run, |study| study.is::<Ensemble>());
    driver.perform(vec![Task::Ask]);
    driver.press("Space");
    driver
}

fn computed(driver: &Driver) -> u64 {
    driver
        .app
        .studies
        .value::<Ensemble>()
        .map_or(0, Ensemble::computed)
}

#[test]
fn the_number_of_profiles_is_a_row_and_an_edit() {
    let mut driver = with_profiles(rough());
    let text = driver.document().text().to_owned();
    assert_eq!(computed(&driver), Ensemble::PROFILES);
    driver.select("numerics.profiles");
    driver.shows("profiles");
    for (keys, count) in [
        ("Right", 32),
        ("Left Left", 8),
        ("Enter Ctrl+u `1` Enter", 1),
        ("Left", 1),
        ("Enter Ctrl+u `256` Enter", 256),
        ("Right", 256),
        ("5 Enter", 5),
        ("u", 256),
        ("U", 5),
    ] {
        driver.press(keys);
        assert_eq!(
            (driver.app.edit.profiles, computed(&driver)),
            (count, count),
            "{keys}"
        );
    }
    driver.states("5 profiles");
    driver.answers("u", "profiles 5 → 256");
    for refused in ["0", "257", "2.5", "many", ""] {
        driver.press(&format!("Enter Ctrl+u `{refused}` Enter"));
        assert!(
            driver
                .refusal()
                .is_some_and(|why| why.contains("from 1 to 256")),
            "{refused}"
        );
        driver.press("Esc");
    }
    // It is no part of the scene.
    assert_eq!(driver.document().text(), text);
    assert!(!driver.app.edit.is_unsaved());
    // The command that opens the scene has it.
    driver.press("y");
    assert!(
        driver.copied[0].contains("asperity --profiles=256 "),
        "{:?}",
        driver.copied
    );
    // Another scene keeps the number, and a smooth body has one profile and no row.
    driver.press("Enter `3` Enter : `jkr-sphere` Enter");
    assert_eq!(driver.document().name(), "jkr-sphere");
    driver.hides("profiles");
    driver.press("y");
    assert!(
        !driver.copied[1].contains("--profiles"),
        "{:?}",
        driver.copied
    );
}

#[test]
fn the_row_is_found_by_everyday_words() {
    for words in ["number of profiles", "realisations", "ensemble"] {
        let mut driver = pressed("/");
        driver.type_text(words);
        driver.press("Enter");
        assert_eq!(
            driver.app.edit.parameter().unwrap().path,
            "numerics.profiles",
            "{words}"
        );
    }
}
