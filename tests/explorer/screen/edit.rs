//! Edits of the scene by keys, undone and redone.

use super::common::driver::Driver;
use super::common::scenes::rough;
use super::{is_up_to_date, pressed};
use asperity::explorer::app::Message;
use asperity::scene::open;

#[test]
fn keys_step_a_value_finely_and_coarsely() {
    let mut driver = pressed("");
    driver.select("roughness.hurst");
    let mut hurst = |keys: &str| {
        driver.press(keys);
        assert!(is_up_to_date(&driver.app));
        driver.app.edit.document.value("roughness.hurst").unwrap().to_owned()
    };
    for (keys, value) in [
        ("l", "0.71"),
        ("Right", "0.72"),
        ("h", "0.71"),
        ("Left", "0.7"),
        ("L", "0.8"),
        ("Shift+Right", "0.9"),
        ("H", "0.8"),
        ("Shift+Left", "0.7"),
        ("l l l h", "0.72"),
    ] {
        assert_eq!(hurst(keys), value, "{keys}");
    }
}

#[test]
fn a_step_beyond_the_range_says_what_is_allowed() {
    let mut driver = pressed("");
    driver.select("material.poisson_ratio");
    let before = driver.app.edit.document.clone();
    assert!(driver.press("l").is_empty());
    assert_eq!(driver.app.edit.document, before);
    assert!(driver.text().contains("0.5"), "{}", driver.text());
    let Some(Message::Refused(error)) = &driver.app.message else { panic!("it is refused") };
    assert!(error.contains("allowed"), "{error}");
}

#[test]
fn edits_are_taken_back_and_done_again() {
    let mut driver = pressed("");
    let mut texts = vec![driver.app.edit.document.text().to_owned()];
    let first = driver.outcome().figures;
    driver.select("roughness.hurst");
    for keys in ["l", "L", "h"] {
        driver.press(keys);
        texts.push(driver.app.edit.document.text().to_owned());
    }
    let last = driver.outcome().figures;
    assert_ne!(first, last);
    for text in texts.iter().rev().skip(1) {
        driver.press("u");
        assert_eq!(driver.app.edit.document.text(), text);
        assert!(is_up_to_date(&driver.app));
    }
    assert!(!driver.app.edit.is_unsaved());
    assert_eq!(driver.outcome().figures, first);
    driver.press("u");
    assert_eq!(driver.app.edit.document.text(), texts[0], "there is no more to take back");
    for (text, key) in texts.iter().skip(1).zip(["U", "Ctrl+r", "U"]) {
        driver.press(key);
        assert_eq!(driver.app.edit.document.text(), text);
    }
    assert_eq!(driver.outcome().figures, last);
    // A new edit clears the redo list.
    driver.press("u l");
    let text = driver.app.edit.document.text().to_owned();
    driver.press("U");
    assert_eq!(driver.app.edit.document.text(), text);
    // A refused value is no edit.
    driver.enter("7");
    driver.press("Esc u");
    assert_eq!(driver.app.edit.document.text(), texts[2]);
}

#[test]
fn a_built_in_scene_can_be_taken_back_like_any_edit() {
    let mut driver = Driver::start(rough());
    driver.select("roughness.hurst");
    driver.press("l");
    let text = driver.app.edit.document.text().to_owned();
    driver.press("o 4 Enter");
    assert!(
        matches!(driver.app.message, Some(Message::Done(_))),
        "the notice states that the change is kept"
    );
    driver.press("u");
    assert_eq!(driver.app.edit.document.text(), text);
    assert!(driver.app.edit.is_unsaved());
    driver.press("u");
    assert_eq!(driver.app.edit.document.text(), rough().text());
    assert!(!driver.app.edit.is_unsaved(), "the scene is as it was opened");
    driver.press("q");
    assert!(driver.app.finished);
}

#[test]
fn waves_are_typed_and_stepped_in_metres_or_as_modes() {
    let mut driver = pressed("");
    let scene = |driver: &Driver| driver.app.edit.document.scene().clone();
    let waves = |driver: &Driver| driver.app.edit.document.scene().spectrum().unwrap();
    let before = scene(&driver);
    driver.select("roughness.wavelengths");
    driver.press("Enter Ctrl+u");
    driver.type_text("50 µm, 1 µm");
    driver.press("Enter");
    assert_eq!((waves(&driver).first, waves(&driver).last), (2, 100));
    assert!(driver.text().contains("50 µm, 1 µm"), "{}", driver.text());
    driver.press("Right");
    assert!(driver.text().contains("50 µm, 1.12 µm"), "{}", driver.text());
    driver.select("roughness.roll_off");
    driver.press("Left");
    assert_eq!(waves(&driver).roll_off_mode, 1e-4 / 4.5e-5);
    // What follows from another value is typed, never stepped.
    let text = driver.app.edit.document.text().to_owned();
    for (path, given) in [
        ("roughness.modes", "the wavelengths"),
        ("adhesion.work", "κ"),
        ("adhesion.elastic_energy_ratio", "κ"),
    ] {
        driver.select(path);
        for key in ["Right", "h", "L"] {
            driver.press(key);
            let why = format!("is computed; Enter fixes it in place of {given}");
            assert!(driver.text().contains(&why), "{path} {key}: {}", driver.text());
            assert_eq!(driver.app.edit.document.text(), text, "{path} {key}");
        }
    }
    driver.select("roughness.modes");
    driver.enter("2, 128");
    assert_eq!((waves(&driver).first, waves(&driver).last), (2, 128));
    driver.press("Right");
    assert_eq!((waves(&driver).first, waves(&driver).last), (2, 256));
    driver.press("u u u u u");
    assert_eq!(scene(&driver), before);
}

#[test]
fn the_selection_stays_on_its_field_when_rows_come_and_go() {
    let mut driver = pressed("");
    driver.select("numerics.points");
    let path = |driver: &Driver| driver.app.edit.parameter().unwrap().field.path;
    let rows = |driver: &Driver| driver.app.edit.parameters.len();
    let before = rows(&driver);
    for (field, value) in [("form", "Cone(angle: 0.1)"), ("adhesion", "None"), ("roughness", "None")] {
        let count = rows(&driver);
        driver.select(field);
        driver.enter(value);
        assert_ne!(rows(&driver), count, "{field}");
        assert_eq!(path(&driver), field);
    }
    driver.select("numerics.points");
    driver.press("u");
    assert_eq!(path(&driver), "numerics.points");
    driver.press("u u");
    assert_eq!((path(&driver), rows(&driver)), ("numerics.points", before));
    driver.press("o 1 Enter");
    assert_eq!(path(&driver), "numerics.points");
}

#[test]
fn a_scene_that_is_opened_again_unchanged_leaves_nothing_to_undo() {
    let mut driver = Driver::start(open("pressure-sensitive").unwrap());
    driver.press("o 2 Enter");
    assert!(driver.app.edit.past.is_empty());
    driver.press("u");
    assert!(driver.status().starts_with("nothing to undo"), "{}", driver.status());
}
