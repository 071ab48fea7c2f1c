//! Effects switched on and off, and the two forms of adhesion.

use super::common::driver::Driver;
use super::common::scenes::{changed, one_spring, rough};
use super::{generation, is_up_to_date, pressed};
use asperity::explorer::app::Message;
use asperity::scene::{Adhesion, Effect};

/// Selects a row by its path.
fn select(driver: &mut Driver, path: &str) {
    driver.press("g");
    while driver.app.edit.parameter().is_some_and(|parameter| parameter.path != path) {
        let before = driver.app.edit.selected;
        driver.press("j");
        assert_ne!(driver.app.edit.selected, before, "no row {path}");
    }
}

/// The text of the selected row.
fn row(driver: &Driver) -> String {
    driver.rows().iter().find(|row| row.contains('›')).cloned().unwrap_or_default()
}

fn is_on(driver: &Driver, effect: Effect) -> bool {
    effect.is_on(driver.app.edit.document.scene())
}

/// The scene with every effect, each in another form than its switch makes.
fn full() -> Driver {
    let fields = [
        ("form", "Cone(angle: 0.01)"),
        ("adhesion", "(kappa: 3.0)"),
        ("loading", "[ToForce(1.0e-5), ToZeroForce, ToForce(2.0e-5), ToSeparation]"),
    ];
    Driver::start(changed(&rough(), &fields))
}

const ROWS: [(&str, Effect); 4] = [
    ("form", Effect::Form),
    ("roughness", Effect::Roughness),
    ("adhesion", Effect::Adhesion),
    ("loading", Effect::Unloading),
];

#[test]
fn an_effect_goes_and_comes_back_as_it_was() {
    for (path, effect) in ROWS {
        let mut driver = full();
        let before = driver.app.edit.document.clone();
        select(&mut driver, path);
        assert!(is_on(&driver, effect) && row(&driver).contains('●'), "{path}: {}", row(&driver));
        driver.press("t");
        assert!(!is_on(&driver, effect) && is_up_to_date(&driver.app), "{path}");
        assert!(row(&driver).contains('○'), "{path}: {}", row(&driver));
        assert_eq!(driver.app.edit.parameter().unwrap().path, path, "its row stays selected");
        driver.press("t");
        assert!(is_on(&driver, effect) && is_up_to_date(&driver.app), "{path}");
        assert_eq!(driver.app.edit.document.scene(), before.scene(), "{path}");
        driver.press("u u");
        assert_eq!(driver.app.edit.document, before, "{path}");
    }
}

#[test]
fn a_switch_that_cannot_be_made_says_why() {
    let mut driver = Driver::start(one_spring());
    let before = driver.app.edit.document.clone();
    select(&mut driver, "roughness");
    driver.press("t");
    assert_eq!(driver.app.edit.document, before);
    let Some(Message::Refused(why)) = driver.app.message.clone() else { panic!("it is refused") };
    assert!(!why.is_empty() && driver.status().starts_with("! "), "{why}: {}", driver.status());
    // Rows without an effect have no switch.
    let mut driver = pressed("");
    for path in ["length", "numerics.points", "material"] {
        let of_before = generation(&driver);
        select(&mut driver, path);
        driver.press("t");
        assert_eq!(generation(&driver), of_before);
        assert!(driver.text().contains("no effect to switch"), "{path}: {}", driver.text());
    }
    // Rows of an effect switch that effect.
    select(&mut driver, "roughness.hurst");
    driver.press("t");
    assert!(!is_on(&driver, Effect::Roughness));
}

/// κ and γ of the computed scene, and γ by eq. (11): h⟨∇z⟩E*/κ².
fn governing(driver: &Driver) -> (f64, f64, f64) {
    assert!(is_up_to_date(&driver.app), "{:?}", driver.app.message);
    let governing = driver.outcome().governing;
    let amplitude = governing.amplitude.unwrap();
    let (kappa, work) = (governing.kappa.unwrap(), governing.work_of_adhesion.unwrap());
    let stiffness = amplitude.rms_height * amplitude.rms_gradient * governing.effective_modulus;
    (kappa, work, stiffness / kappa.powi(2))
}

fn near(one: f64, other: f64) -> bool {
    (one / other - 1.0).abs() < 1e-12
}

#[test]
fn kappa_is_solved_for_where_the_scene_gives_the_work() {
    let mut driver = Driver::start(changed(&rough(), &[("adhesion", "(work: 0.05)")]));
    let (kappa, work, expected) = governing(&driver);
    assert!(work == 0.05 && near(work, expected));
    select(&mut driver, "adhesion.kappa");
    assert!(row(&driver).contains("= "), "it follows from the work: {}", row(&driver));
    driver.enter("2.8");
    let (kappa_now, work_now, expected) = governing(&driver);
    assert!(near(kappa_now, 2.8) && near(work_now, expected), "{kappa_now} {work_now}");
    assert!(near(work_now, work * (kappa / 2.8).powi(2)));
    let adhesion = driver.app.edit.document.scene().adhesion.unwrap();
    assert_eq!(adhesion, Adhesion::by_work(work_now), "the scene still gives γ");
    // A step would change what is given.
    driver.press("l");
    assert!(driver.text().contains("is computed; Enter fixes it in place of γ"), "{}", driver.text());
    assert_eq!(driver.app.edit.document.scene().adhesion.unwrap(), adhesion);
}

#[test]
fn a_scene_that_gives_kappa_may_be_given_the_work() {
    let mut driver = pressed("");
    let (kappa, work, expected) = governing(&driver);
    assert!(kappa == 8.0 && near(work, expected));
    select(&mut driver, "adhesion.work");
    assert!(row(&driver).contains("= "), "it follows from κ: {}", row(&driver));
    driver.enter("20 mJ/m²");
    let (kappa, work, expected) = governing(&driver);
    assert!(work == 0.02 && near(work, expected), "{kappa} {work} {expected}");
    let adhesion = driver.app.edit.document.scene().adhesion.unwrap();
    assert_eq!(adhesion, Adhesion::by_work(0.02), "now the scene gives γ");
    driver.press("u");
    assert_eq!(governing(&driver).0, 8.0);
    for (path, typed) in [("adhesion.work", "-1"), ("adhesion.kappa", "0"), ("adhesion.kappa", "much")] {
        select(&mut driver, path);
        driver.enter(typed);
        assert!(driver.refusal().is_some(), "{path} {typed}");
        driver.press("Esc");
        assert_eq!(governing(&driver).0, 8.0);
    }
}
