//! Edits of the scene by keys, undone and redone.

use super::*;

#[test]
fn edits_are_taken_back_and_done_again() {
    let mut driver = pressed("");
    let mut texts = vec![driver.document().text().to_owned()];
    let first = driver.outcome().figures;
    driver.select("roughness.hurst");
    for keys in ["l", "L", "h"] {
        driver.press(keys);
        texts.push(driver.document().text().to_owned());
    }
    let last = driver.outcome().figures;
    assert_ne!(first, last);
    for text in texts.iter().rev().skip(1) {
        driver.press("u");
        assert_eq!(driver.document().text(), text);
        assert!(is_up_to_date(&driver.app));
    }
    assert!(!driver.app.edit.is_unsaved());
    assert_eq!(driver.outcome().figures, first);
    driver.press("u");
    assert_eq!(
        driver.document().text(),
        texts[0],
        "there is no more to take back"
    );
    for (text, key) in texts.iter().skip(1).zip(["U", "Ctrl+r", "U"]) {
        driver.press(key);
        assert_eq!(driver.document().text(), text);
    }
    assert_eq!(driver.outcome().figures, last);
    // A new edit clears the redo list.
    driver.press("u l");
    let text = driver.document().text().to_owned();
    driver.press("U");
    assert_eq!(driver.document().text(), text);
    // A refused value is no edit.
    driver.enter("7");
    driver.press("Esc u");
    assert_eq!(driver.document().text(), texts[2]);
}

#[test]
fn waves_are_typed_and_stepped_in_metres_or_as_modes() {
    let mut driver = pressed("");
    let scene = |driver: &Driver| driver.document().scene().clone();
    let waves = |driver: &Driver| driver.document().scene().spectrum().unwrap();
    let before = scene(&driver);
    driver.select("roughness.wavelengths");
    driver.press("Enter Ctrl+u `50 µm, 1 µm` Enter");
    assert_eq!((waves(&driver).first, waves(&driver).last), (2, 100));
    driver.shows("50 µm, 1 µm");
    // 89 waves: the nearest whole number to 1.12 µm.
    driver.sees("Right", "50 µm, 1.124 µm");
    driver.select("roughness.roll_off");
    driver.press("Left");
    assert_eq!(waves(&driver).roll_off_mode, 1e-4 / 4.5e-5);
    driver.set("roughness.modes", "2, 128");
    assert_eq!((waves(&driver).first, waves(&driver).last), (2, 128));
    driver.press("Right");
    assert_eq!((waves(&driver).first, waves(&driver).last), (2, 256));
    driver.press("u u u u u");
    assert_eq!(scene(&driver), before);
}

#[test]
fn an_amplitude_is_typed_as_a_height_or_as_a_gradient() {
    let mut driver = pressed("");
    let before = driver.document().scene().clone();
    driver.set("roughness.rms_gradient", "0.25");
    let amplitude = driver.outcome().governing.amplitude.unwrap();
    assert_eq!(amplitude.rms_gradient, 0.25);
    driver.shows(format!("= {}", format_quantity(amplitude.rms_height, "m")));
    driver.set(
        "roughness.rms_height",
        &format!("{:e} m", amplitude.rms_height),
    );
    let again = driver.outcome().governing.amplitude.unwrap();
    assert!((again.rms_gradient / 0.25 - 1.0).abs() < 1e-12, "{again:?}");
    driver.press("u u");
    assert_eq!(*driver.document().scene(), before);
}

/// Whatever changes the works of adhesion: γ, a parameter of the roughness from which γ follows, or
/// keys.
#[test]
fn the_work_on_closing_never_exceeds_that_on_opening() {
    let works = "(work: 4.0e-3, closing_work: 3.0e-3)";
    for (path, typed, why) in [
        (
            "adhesion.work",
            "2",
            "adhesion.closing_work = 0.003: allowed: 0 to 0.002 J/m²",
        ),
        (
            "adhesion.closing_work",
            "5",
            "adhesion.closing_work = 0.005: allowed: 0 to 0.004 J/m²",
        ),
        (
            "adhesion.kappa",
            "1e5",
            "adhesion.closing_work = 0.003: allowed: 0 to ",
        ),
        (
            "adhesion.kappa",
            "-1",
            "adhesion.kappa = -1.0: allowed: from 1e-6 to 1e6",
        ),
        (
            "adhesion.elastic_energy_ratio",
            "-1",
            "adhesion.elastic_energy_ratio = -1.0: allowed: ",
        ),
    ] {
        let mut driver = mid_retraction(changed(&rough(), &[("adhesion", works)]));
        driver.set(path, typed);
        let refusal = driver.refusal().unwrap_or_default().to_owned();
        assert!(refusal.starts_with(why), "{path}: {refusal}");
        driver.press("Esc");
        for key in ["H", "L"] {
            driver.press(&format!("{key} ").repeat(9));
            let adhesion = driver.document().scene().adhesion.unwrap();
            assert!(
                adhesion.closing_work() <= adhesion.work(),
                "{path}: {adhesion:?}"
            );
        }
    }
}

#[test]
fn the_selection_stays_on_its_field_when_rows_come_and_go() {
    let mut driver = pressed("");
    driver.select("numerics.points");
    let path = |driver: &Driver| driver.app.edit.parameter().unwrap().field.path;
    let rows = |driver: &Driver| driver.app.edit.parameters.len();
    let before = rows(&driver);
    for (field, value) in [
        ("form", "Cone(angle: 0.1)"),
        ("adhesion", "None"),
        ("roughness", "None"),
    ] {
        let count = rows(&driver);
        driver.set(field, value);
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
