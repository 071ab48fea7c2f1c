//! Failures, late reports and panics.

use super::*;

#[test]
fn reports_of_another_scene_change_nothing() {
    let mut driver = pressed("");
    let (computed, snapshot) = (
        driver.app.solved.clone().unwrap(),
        driver.snapshot().clone(),
    );
    driver.select("roughness.hurst");
    driver.press("l");
    let screen = driver.screen();
    let generation = computed.generation;
    for action in [
        Action::Reply(Reply::Solved(computed, None)),
        Action::Reply(Reply::Shown(snapshot.into())),
        Action::Reply(Reply::Progress {
            generation,
            stages: 1,
        }),
        Action::Reply(Reply::Failed {
            generation,
            error: "old".to_owned(),
        }),
    ] {
        assert!(driver.act(action).is_empty());
        assert_eq!(driver.screen(), screen);
    }
}

/// Makes the scene one whose contact detaches before it reaches a force, by switching its adhesion
/// off.
pub fn detach(driver: &mut Driver) {
    driver.set("loading", "20 µN, -10 nN");
    driver.select("adhesion");
    driver.press("t");
}

#[test]
fn a_scene_that_fails_is_stated_and_the_next_edit_mends_it() {
    let mut driver = pressed("");
    detach(&mut driver);
    assert!(!driver.app.is_computing());
    let text = driver.text();
    assert!(
        text.contains("stage 2: the contact detaches before -10 nN"),
        "{text}"
    );
    // Figures of the former scene are no longer shown.
    assert!(!text.contains("F_a "), "{text}");
    for keys in ["j", "k", ". .", "Tab Tab", "n", "+"] {
        driver.press(keys);
    }
    driver.shows("stage 2: the contact detaches before -10 nN");
    driver.press("u");
    assert!(driver.status().starts_with("undo: "), "{}", driver.status());
    driver.press("j");
    let text = driver.text();
    assert!(
        text.contains("F_max 20 µN") && !text.contains("detaches"),
        "{text}"
    );
    assert!(is_up_to_date(&driver.app));
}

#[test]
fn a_key_that_cannot_do_anything_says_why() {
    let (dry, none) = (without_adhesion(), "");
    for (document, path, keys, why) in [
        (rough(), none, "u", "nothing to undo"),
        (rough(), none, "x", "no ghost to swap with"),
        (rough(), none, "P", "select a row of the loading"),
        (rough(), none, "d S S", "nothing is in contact"),
        (rough(), none, "d Space", "the path has no move yet"),
        (rough(), none, "Y * *", "no curves for the crosshair"),
        (
            rough(),
            none,
            "Ctrl+f",
            "! there is no measured curve; o opens one by its path",
        ),
        (rough(), none, "m W", "! no study is open"),
        (rough(), none, "m P", "! no study is open"),
        (dry.clone(), none, "!", "there is no pull-off"),
        (dry.clone(), none, "m Left Up", "has no adhesion"),
        (smooth(), none, "m Left Up", "a smooth body has"),
        (rough(), "length", "t", "no effect to switch"),
        (rough(), "material", "t", "no effect to switch"),
        (one_spring(), "roughness", "t", "! "),
        (rough(), "material.poisson_ratio", "l", "allowed"),
        (
            rough(),
            "adhesion",
            "2",
            "adhesion is a choice: ← → change it",
        ),
        (
            rough(),
            "material",
            "2",
            "material is several numbers: Enter types them",
        ),
        (rough(), "loading", "L", "loading is a list: Enter types it"),
        (
            rough(),
            "numerics",
            "3",
            "numerics is a group: its fields are in the rows below",
        ),
        (
            rough(),
            "roughness.modes",
            "Right",
            "follows from the wavelengths; Enter types a value",
        ),
        (
            rough(),
            "adhesion.work",
            "L",
            "follows from κ; Enter types a value of its own",
        ),
        (
            rough(),
            "adhesion.elastic_energy_ratio",
            "h",
            "follows from κ; Enter types a value of its own",
        ),
        (
            smooth(),
            "adhesion.kappa",
            "l",
            "κ is not defined without roughness",
        ),
        (rough(), "loading.1", "K", "cannot pull before contact"),
    ] {
        let document = if path == "roughness.modes" {
            changed(
                &document,
                &[
                    ("roughness.modes", "None"),
                    ("roughness.wavelengths", "50 µm, 1 µm"),
                ],
            )
        } else {
            document
        };
        let mut driver = mid_retraction(document.clone());
        if !path.is_empty() {
            driver.app.view.pane = Pane::Parameters;
            driver.select(path);
        }
        driver.press(keys);
        assert!(
            driver.text().contains(why),
            "{path} {keys}: {why}\n{}",
            driver.text()
        );
        assert_eq!(
            (driver.document(), driver.app.prompt.is_none()),
            (&document, true),
            "{path} {keys}"
        );
    }
}
