//! A finished study in place of the computed map.

use super::common::study::{PLAN, merged};
use super::*;
use asperity::contact::Move;
use asperity::explorer::commands::accuracy::studies;
use asperity::explorer::map_state::Live;
use asperity::scene::Roughness;
use asperity::study::Quantity;
use tempfile::TempDir;

/// The explorer on a study of this plan, in a folder of its own.
fn opened_with(plan: &str) -> (TempDir, Driver) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("small");
    merged(&path, plan);
    let mut driver = Driver::start(Opening::of(path.to_str().unwrap()).unwrap());
    driver.press("Space");
    (folder, driver)
}

/// The explorer on the small study.
pub fn opened() -> (TempDir, Driver) {
    opened_with(PLAN)
}

/// κ and H of the mark, on a map with H across.
fn place(driver: &Driver) -> (f64, f64) {
    let (hurst, kappa) = driver.app.place().unwrap();
    (kappa.unwrap(), hurst)
}

fn preload(driver: &Driver) -> f64 {
    match driver.document().scene().loading[..] {
        [Move::ToForce(force), Move::ToSeparation] => force,
        ref other => panic!("{other:?}"),
    }
}

#[test]
fn glyphs_show_all_that_was_recorded() {
    let (_folder, mut driver) = opened();
    assert_eq!(driver.app.keys(), Context::Map);
    assert_eq!(driver.app.mapped(), Quantity::Regime);
    for (quantity, text) in [
        (
            Quantity::FirstTouchAdhesionShare,
            "F_a(d=0)/F_a,max over H, κ",
        ),
        (Quantity::AdhesionCoefficient, "F_a/F_n over H, κ"),
        (Quantity::PullOffForce, "F_a (µN) "),
    ] {
        driver.press("V");
        assert_eq!(driver.app.mapped(), quantity);
        assert!(driver.text().contains(text), "{text}\n{}", driver.text());
    }
    // The map computed here does not have this quantity, and shows its own.
    driver.press("W");
    driver.hides("F_a (µN) ");
    driver.sees("W", "F_a (µN) ");
    driver.press("V");
    assert_eq!(driver.app.mapped(), Quantity::Regime);
    driver.shows_all([
        "█ pressure-insensitive",
        "· non-adhesive",
        "▓ ░ profiles disagree",
        "(12 of 12",
    ]);
}

#[test]
fn the_mark_goes_from_cell_to_cell_and_beyond_the_map_stays_at_its_edge() {
    let (_folder, mut driver) = opened();
    let before = driver.document().clone();
    assert_eq!(place(&driver), (1.0, 0.5));
    driver.press("Up Right k L");
    // Values of the study: 12 digits, other than those of the map computed here.
    assert_eq!(place(&driver), (2.0, 0.9));
    driver.shows("◆ H 0.9, κ 2");
    assert!(is_up_to_date(&driver.app));
    driver.press(&"K ".repeat(4));
    assert_eq!(place(&driver), (16.0, 0.9));
    driver.answers("k", "edge of the map");
    driver.press("u u");
    assert_eq!(*driver.document(), before);
    for (kappa, hurst, back) in [("100", "0.5", (16.0, 0.5)), ("0.01", "0.97", (0.25, 0.9))] {
        driver.press("Tab Tab");
        driver.set("adhesion.kappa", kappa);
        driver.set("roughness.hurst", hurst);
        driver.shows("outside the map");
        assert!(
            driver
                .rows()
                .iter()
                .any(|row| row.chars().take(68).any(|cell| cell == '◆'))
        );
        driver.hides("no longer");
        driver.press("m");
        driver.press(if back.0 > 1.0 { "j" } else { "k" });
        if back.1 != place(&driver).1 {
            driver.press("h");
        }
        assert_eq!(place(&driver), back);
    }
}

#[test]
fn the_scene_follows_to_the_next_preload() {
    let (_folder, mut driver) = opened();
    let first = preload(&driver);
    driver.shows("F_n/(E* h L) = 0.01  1 of 3, P: the next");
    let mut regimes = vec![driver.app.grid().cloned()];
    for (times, share) in [
        (10.0, "0.1  2 of 3"),
        (100.0, "1  3 of 3"),
        (1.0, "0.01  1 of 3"),
    ] {
        driver.press("P");
        assert!((preload(&driver) / first / times - 1.0).abs() < 1e-9);
        driver.shows(format!("F_n/(E* h L) = {share}"));
        assert!(is_up_to_date(&driver.app));
        regimes.push(driver.app.grid().cloned());
    }
    assert!(regimes[0] != regimes[1] && regimes[0] == regimes[3]);
    driver.press("PageUp");
    assert!((preload(&driver) / first / 100.0 - 1.0).abs() < 1e-9);
    // A different scene is left unchanged.
    driver.press("Tab Tab");
    driver.select("material.youngs_modulus");
    driver.sees("L", "no longer belongs to the study");
    let other = driver.document().clone();
    driver.press("m P P");
    assert_eq!(*driver.document(), other);
    driver.shows("0.1  2 of 3");
}

#[test]
fn the_computed_map_can_be_had_instead() {
    let (_folder, mut driver) = opened();
    let charts = |driver: &mut Driver| {
        studies(&mut driver.app)
            .iter()
            .any(|study| study.is::<Live>())
    };
    assert!(
        !charts(&mut driver),
        "nothing is computed that is not shown"
    );
    assert_eq!(driver.press("W"), [Task::Study]);
    assert!(charts(&mut driver));
    driver.shows("over H, κ, 4 profiles");
    driver.press("Up");
    assert_eq!(
        place(&driver).0,
        1.19,
        "from cell to cell of the map that is shown"
    );
    driver.answers("P", "W shows the study's");
    driver.sees("W", "Study small");
    // The study is hidden and shown again with the pane.
    driver.sees("m m", "Study small");
    // Another scene has a map of its own, and the study stays loaded.
    driver.sees("o 1 Enter W", "no longer belongs to the study");
    driver.sees("W", "over H, κ, 4 profiles");
}

#[test]
fn studies_of_other_quantities_open_as_maps_and_curves() {
    let kappa = "Logarithmic(path: \"adhesion.kappa\", from: 0.25, to: 16, count: 13)";
    let length = "List(path: \"length\", values: [5.0e-5, 1.0e-4, 2.0e-4])";
    // The length in place of κ: the mark moves along the length, in its unit.
    let (_folder, mut driver) = opened_with(&PLAN.replace(kappa, length));
    driver.shows_all(["over H, L, 12 profiles", "L (µm)"]);
    driver.shows("◆ H 0.5, L 100 µm");
    driver.press("Up");
    assert_eq!(driver.document().scene().length, 2.0e-4);
    driver.hides("no longer");
    // H alone: curves with the confidence of the mean.
    let alone = PLAN.replace(&format!("{kappa},"), "");
    let (_folder, mut driver) =
        opened_with(&alone.replace("preloads: [0.01, 0.1, 1.0]", "preloads: [0.1]"));
    driver.shows_all(["over H, 12 profiles", "95 % confidence of the mean"]);
    driver.press("Right");
    assert_eq!(driver.app.place(), Some((0.6, None)));
    driver.answers("Up", "this map has one axis, H");
}

#[test]
fn a_study_is_opened_by_its_path() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    merged(&folder.path().join("small"), PLAN);
    let mut driver = pressed("");
    driver.press("o");
    driver.act(Action::Paste(path("small")));
    driver.sees("Enter", "Study small: regime (d=0) over H, κ, 12 profiles");
    assert!(is_up_to_date(&driver.app) && !driver.app.edit.is_unsaved());
    let Some(Roughness::SelfAffine { modes, .. }) = driver.document().scene().roughness else {
        panic!()
    };
    assert_eq!(modes, Some((1, 32)));
    driver.press("u");
    assert_eq!(driver.document().scene(), rough().scene());
    // A scene file opens in the same way.
    fs::write(folder.path().join("mine.ron"), rough().text()).unwrap();
    driver.press("o");
    driver.act(Action::Paste(path("mine.ron")));
    driver.press("Enter");
    assert_eq!(driver.document().name(), path("mine.ron"));
    assert!(driver.app.map.shown_study().is_none());
}
