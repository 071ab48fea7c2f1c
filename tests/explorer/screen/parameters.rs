//! The list of parameters: its order, its groups, its visible part, and the search.

use super::*;

fn selected(app: &App) -> &str {
    &app.edit.parameter().expect("a parameter is selected").path
}

fn scenes() -> [Document; 5] {
    [
        default_scene(),
        rough(),
        smooth(),
        punch(),
        without_adhesion(),
    ]
}

#[test]
fn values_are_whole_in_narrow_panes() {
    let long = changed(
        &rough(),
        &[(
            "loading",
            "[ToForce(1.0e-5), ToZeroForce, ToForce(2.0e-5), ToSeparation]",
        )],
    );
    for scene in scenes().into_iter().chain([long]) {
        for size in SIZES {
            let mut driver = mid_retraction(scene.clone());
            driver.resize(size);
            driver.app.view.pane = Pane::Parameters;
            driver.press("g");
            for _ in 0..driver.app.edit.parameters.len() {
                let parameter = driver.app.edit.parameter().unwrap();
                // A list of stages is in the rows below, the name of a group of choices in its
                // text, and a pair of lengths wider than the smallest panes.
                let is_pair = parameter.path == "roughness.wavelengths" && size.0 < 80;
                if parameter.field.unit.is_empty() || is_pair {
                    driver.press("j");
                    continue;
                }
                let rows = driver.rows();
                let row = rows
                    .iter()
                    .find(|row| row.contains('›'))
                    .expect("the selected row");
                let derived = row.contains("none")
                    || row
                        .split("= ")
                        .nth(1)
                        .is_some_and(|value| !value.contains('…'));
                let is_whole = if parameter.shown.is_empty() {
                    derived
                } else {
                    row.contains(&parameter.shown)
                };
                assert!(is_whole, "{size:?} {}: {row}", parameter.shown);
                let named =
                    row.contains(parameter.field.symbol) || row.contains(&parameter.name()[..3]);
                assert!(named, "{size:?}: {row}");
                driver.press("j");
            }
        }
    }
}

#[test]
fn a_parameter_is_found_by_words_of_its_name_or_symbol() {
    for (typed, path) in [
        ("hurst", "roughness.hurst"),
        ("H", "roughness.hurst"),
        ("h", "roughness.rms_height"),
        ("κ", "adhesion.kappa"),
        ("gamma", "adhesion.work"),
        ("N", "numerics.points"),
        ("springs", "numerics.points"),
        ("nu", "material.poisson_ratio"),
        ("force stage", "loading.0.0"),
        ("length", "length"),
        ("gradient", "roughness.rms_gradient"),
    ] {
        let mut driver = pressed("/");
        driver.type_text(typed);
        driver.states(format!("Find: {typed}"));
        driver.press("Enter");
        assert_eq!(selected(&driver.app), path, "{typed}");
        assert_eq!(
            driver.app.keys(),
            Context::Parameters,
            "a value can be typed at once"
        );
    }
}

#[test]
fn a_search_is_moved_through_and_left() {
    for size in SIZES {
        for before in ["", "Tab", "Tab Tab Tab"] {
            let mut driver = pressed(before);
            driver.resize(size);
            let (pane_before, document) = (driver.app.view.pane, driver.document().clone());
            driver.press("/ m o d");
            let found = driver.app.keys();
            assert_eq!(found, Context::List);
            assert!(driver.text().contains('›'), "{size:?}\n{}", driver.text());
            driver.press("Down Esc");
            assert_eq!(
                (driver.app.view.pane, selected(&driver.app)),
                (pane_before, "roughness.hurst")
            );
            assert_eq!(*driver.document(), document);
        }
    }
    // A search without a match moves nothing.
    let mut driver = pressed("/ q q q Enter");
    assert_eq!(driver.app.keys(), Context::List);
    driver.shows("no row and no command");
    // A field without a row is found as well.
    driver.sees("Ctrl+u `samples`", "points of the force curve");
    driver.press("Backspace Ctrl+u Down Up Down Enter");
    assert_eq!(driver.app.edit.selected, 1);
}
