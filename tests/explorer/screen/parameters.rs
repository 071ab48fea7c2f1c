//! The list of parameters: its order, its groups, its visible part, and the search.

use super::common::driver::Driver;
use super::common::scenes::{changed, punch, rough, smooth, without_adhesion};
use super::{SIZES, default_scene, mid_retraction, pressed};
use asperity::explorer::app::{App, Pane};
use asperity::explorer::keys::Context;
use asperity::explorer::layout::Layout;
use asperity::scene::Document;

/// Rows of the thumb of the scroll bar.
fn thumb(driver: &Driver) -> Vec<u16> {
    let area = Layout::of(&driver.app).pane(Pane::Parameters).expect("the pane is shown");
    let screen = driver.screen();
    (area.y..area.bottom()).filter(|y| screen[(area.right() - 1, *y)].symbol() == "█").collect()
}

fn selected(app: &App) -> &str {
    &app.edit.parameter().expect("a parameter is selected").path
}

fn scenes() -> [Document; 5] {
    [default_scene(), rough(), smooth(), punch(), without_adhesion()]
}

#[test]
fn a_group_folds_to_its_first_row_and_unfolds_for_what_is_selected() {
    let mut driver = pressed("");
    let all = driver.app.edit.listed().len();
    assert_eq!(all, driver.app.edit.parameters.len());
    // Rows of a group except the first.
    let rows = |group: &str| driver.app.edit.parameters.iter().filter(|one| one.group == group).count() - 1;
    let (roughness, title, adhesion) = (rows("roughness"), rows("title"), rows("adhesion"));
    driver.press("Z");
    assert_eq!(selected(&driver.app), "roughness", "the first row takes the selection");
    assert_eq!(driver.app.edit.listed().len(), all - roughness);
    assert!(driver.pane(Pane::Parameters).iter().any(|row| row.contains("▸●roughness")), "{}", driver.text());
    assert!(!driver.pane(Pane::Parameters).iter().any(|row| row.contains("Hurst")), "{}", driver.text());
    // Keys of motion skip folded rows.
    driver.press("j");
    assert_eq!(selected(&driver.app), "numerics");
    driver.press("k k");
    assert_eq!(selected(&driver.app), "loading.1");
    // An edit and its undoing leave the group folded.
    driver.press("l u");
    assert_eq!(driver.app.edit.listed().len(), all - roughness);
    driver.press("j Z");
    assert_eq!(driver.app.edit.listed().len(), all);
    driver.press("Z G Z g Z");
    assert_eq!(driver.app.edit.listed().len(), all - roughness - title - adhesion);
    driver.press("G");
    assert_eq!(selected(&driver.app), "title");
    // A search also finds folded rows.
    driver.press("/ h u r s t Enter");
    assert_eq!(
        (selected(&driver.app), driver.app.edit.listed().len()),
        ("roughness.hurst", all - title - adhesion)
    );
}

#[test]
fn a_heading_folds_by_its_own_keys() {
    let mut driver = pressed("");
    driver.select("numerics");
    let text = driver.app.edit.document.text().to_owned();
    let all = driver.app.edit.listed().len();
    for (key, folded) in
        [("Enter", true), ("Enter", false), ("h", true), ("h", true), ("l", false), ("t", false)]
    {
        driver.press(key);
        assert_eq!(driver.app.edit.listed().len() < all, folded, "{key}");
        assert_eq!(driver.app.edit.document.text(), text);
    }
}

#[test]
fn a_scroll_bar_says_that_rows_are_out_of_sight() {
    for size in [(120, 40), (80, 24), (60, 20), (40, 12)] {
        let mut driver = mid_retraction(rough());
        driver.resize(size);
        driver.app.view.pane = Pane::Parameters;
        driver.press("g");
        let top = thumb(&driver);
        assert!(!top.is_empty(), "{size:?}\n{}", driver.text());
        driver.press("G");
        let end = thumb(&driver);
        assert!(end.last() > top.last() && end.first() > top.first(), "{size:?}: {top:?} {end:?}");
    }
    // No scroll bar if all rows are visible.
    let mut driver = mid_retraction(rough());
    driver.resize((120, 60));
    driver.app.view.pane = Pane::Parameters;
    driver.press("z g");
    assert!(thumb(&driver).is_empty(), "{}", driver.text());
}

#[test]
fn values_are_whole_in_narrow_panes() {
    let long =
        changed(&rough(), &[("loading", "[ToForce(1.0e-5), ToZeroForce, ToForce(2.0e-5), ToSeparation]")]);
    for scene in scenes().into_iter().chain([long]) {
        for size in SIZES {
            let mut driver = mid_retraction(scene.clone());
            driver.resize(size);
            driver.app.view.pane = Pane::Parameters;
            driver.press("g");
            for _ in 0..driver.app.edit.parameters.len() {
                let parameter = driver.app.edit.parameter().unwrap();
                // A list of stages is in the rows below, the name of a group of choices in its text, and a pair of lengths
                // wider than the smallest panes.
                let is_pair = parameter.path == "roughness.wavelengths" && size.0 < 80;
                if parameter.field.unit.is_empty() || is_pair {
                    driver.press("j");
                    continue;
                }
                let rows = driver.rows();
                let row = rows.iter().find(|row| row.contains('›')).expect("the selected row");
                let derived =
                    row.contains("none") || row.split("= ").nth(1).is_some_and(|value| !value.contains('…'));
                let is_whole =
                    if parameter.shown.is_empty() { derived } else { row.contains(&parameter.shown) };
                assert!(is_whole, "{size:?} {}: {row}", parameter.shown);
                let named = row.contains(parameter.field.symbol) || row.contains(&parameter.name()[..3]);
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
        ("kappa", "adhesion.kappa"),
        ("gamma", "adhesion.work"),
        ("γ", "adhesion.work"),
        ("N", "numerics.points"),
        ("springs", "numerics.points"),
        ("seed", "roughness.seed"),
        ("nu", "material.poisson_ratio"),
        ("poisson", "material.poisson_ratio"),
        ("force stage", "loading.0.0"),
        ("samples", "numerics.samples"),
    ] {
        let mut driver = pressed("/");
        driver.type_text(typed);
        assert!(driver.status().contains(&format!("Find: {typed}")), "{}", driver.status());
        driver.press("Enter");
        assert_eq!(selected(&driver.app), path, "{typed}");
        assert_eq!(driver.app.keys(), Context::Parameters, "a value can be typed at once");
    }
}

#[test]
fn a_search_is_moved_through_and_left() {
    for size in SIZES {
        for before in ["", "Tab", "Tab Tab Tab"] {
            let mut driver = pressed(before);
            driver.resize(size);
            let (pane_before, document) = (driver.app.view.pane, driver.app.edit.document.clone());
            driver.press("/ m o d");
            let found = driver.app.keys();
            assert_eq!(found, Context::List);
            assert!(driver.text().contains('›'), "{size:?}\n{}", driver.text());
            driver.press("Down Esc");
            assert_eq!((driver.app.view.pane, selected(&driver.app)), (pane_before, "roughness.hurst"));
            assert_eq!(driver.app.edit.document, document);
        }
    }
    // A search without a match moves nothing.
    let mut driver = pressed("/ q q q Enter");
    assert_eq!(driver.app.keys(), Context::List);
    assert!(driver.text().contains("no parameter"), "{}", driver.text());
    driver.press("Backspace Ctrl+u Down Up Down Enter");
    assert_eq!(driver.app.edit.selected, 1);
}
