//! Effects switched on and off, and the two forms of adhesion.

use super::*;
use asperity::scene::Adhesion;
use asperity::scene::fields::Effect;

/// The text of the selected row.
fn row(driver: &Driver) -> String {
    driver
        .rows()
        .iter()
        .find(|row| row.contains('›'))
        .cloned()
        .unwrap_or_default()
}

fn is_on(driver: &Driver, effect: Effect) -> bool {
    effect.is_on(driver.document().scene())
}

/// The scene with every effect, each in another form than its switch makes.
fn full() -> Driver {
    let fields = [
        ("form", "Cone(angle: 0.01)"),
        ("adhesion", "(kappa: 3.0)"),
        (
            "loading",
            "[ToForce(1.0e-5), ToZeroForce, ToForce(2.0e-5), ToSeparation]",
        ),
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
        let before = driver.document().clone();
        driver.select(path);
        assert!(
            is_on(&driver, effect) && row(&driver).contains('●'),
            "{path}: {}",
            row(&driver)
        );
        driver.press("t");
        assert!(
            !is_on(&driver, effect) && is_up_to_date(&driver.app),
            "{path}"
        );
        assert!(row(&driver).contains('○'), "{path}: {}", row(&driver));
        assert_eq!(
            driver.app.edit.parameter().unwrap().path,
            path,
            "its row stays selected"
        );
        driver.press("t");
        assert!(
            is_on(&driver, effect) && is_up_to_date(&driver.app),
            "{path}"
        );
        assert_eq!(driver.document().scene(), before.scene(), "{path}");
        driver.press("u u");
        assert_eq!(*driver.document(), before, "{path}");
    }
}

/// A scene may be given γ or κ, and either may be typed: κ² = h⟨∇z⟩E*/γ (eq. 11), and the typed one
/// is given thereafter.
#[test]
fn the_work_or_kappa_is_solved_for_from_the_other() {
    let by_work = changed(&rough(), &[("adhesion", "(work: 0.05)")]);
    for (document, path, typed) in [
        (by_work, "adhesion.kappa", "2.8"),
        (rough(), "adhesion.work", "20 mJ/m²"),
    ] {
        let mut driver = Driver::start(document.clone());
        driver.select(path);
        assert!(
            row(&driver).contains("= "),
            "it follows from the other: {}",
            row(&driver)
        );
        driver.enter(typed);
        assert!(is_up_to_date(&driver.app), "{:?}", driver.app.message);
        let governing = driver.outcome().governing;
        let (amplitude, kappa) = (governing.amplitude.unwrap(), governing.kappa.unwrap());
        let work = governing.work_of_adhesion.unwrap();
        let stiffness = amplitude.rms_height * amplitude.rms_gradient * governing.modulus;
        assert!(
            (work * kappa.powi(2) / stiffness - 1.0).abs() < 1e-12,
            "{kappa} {work}"
        );
        let expected = if path == "adhesion.kappa" {
            (2.8, kappa)
        } else {
            (0.02, work)
        };
        assert!(
            (expected.0 / expected.1 - 1.0_f64).abs() < 1e-12,
            "{typed}: {expected:?}"
        );
        assert_eq!(
            driver.document().scene().adhesion,
            Some(Adhesion::by_work(work)),
            "the scene gives γ"
        );
        driver.press("u");
        assert_eq!(*driver.document(), document);
        for wrong in ["0", "much"] {
            driver.set("adhesion.kappa", wrong);
            assert!(driver.refusal().is_some(), "{wrong}");
            driver.press("Esc");
            assert_eq!(*driver.document(), document);
        }
    }
}
