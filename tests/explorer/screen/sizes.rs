//! The same statements in windows of five sizes: every cut has a sign, and requested parts are visible.

use super::accuracy::measured;
use super::common::driver::Driver;
use super::common::scenes::rough;
use super::map::mapped;
use super::preloads::computed_preloads;
use super::{SIZES, pressed};
use asperity::explorer::app::Pane;
use asperity::explorer::layout::{Layout, is_framed};

/// A window with room for every message.
const WIDE: (u16, u16) = (400, 40);

#[test]
fn messages_are_whole_or_end_in_an_ellipsis() {
    let scenes: [(&str, &str); 3] = [
        ("e Ctrl+u 1 2 k g Enter", "! "),
        ("e Ctrl+u - 1 Enter", "! roughness.hurst = -1.0: allowed: above 0 and below 1"),
        ("L q", "The scene has unsaved changes. Leave?"),
    ];
    for (keys, begins) in scenes {
        let mut driver = pressed(keys);
        driver.resize(WIDE);
        let whole = driver.status();
        assert!(whole.starts_with(begins) && !whole.ends_with('…'), "{keys}: {whole}");
        for size in SIZES {
            driver.resize(size);
            let status = driver.status();
            let start = status.strip_suffix('…').unwrap_or(&status);
            assert!(whole.starts_with(start), "{size:?} {keys}: {status}");
            // In small windows the reason continues in place of the keys.
            let footer = driver.rows().pop().unwrap_or_default();
            let rest = footer.trim_end().trim_end_matches('…');
            let is_whole = status == whole || !rest.is_empty() && whole.contains(rest);
            assert!(is_whole || status.ends_with('…') && status.chars().count() >= 8, "{size:?}: {status}");
            assert!(status != whole || whole.chars().count() <= usize::from(size.0), "{size:?}: {status}");
        }
    }
}

/// The pane alone in the window, with a whole profile behind it.
fn zoomed(pane: Pane, size: (u16, u16)) -> Driver {
    let mut driver = match pane {
        Pane::Map => mapped(rough()),
        Pane::Accuracy => measured(rough()),
        Pane::Preloads => computed_preloads(rough()),
        Pane::Everett | Pane::Density => super::reversals::reversed(rough()),
        Pane::Lengths => pressed("D"),
        Pane::Spectrum => pressed("Q"),
        Pane::Beside => pressed("c & Tab Tab"),
        _ => pressed(""),
    };
    driver.app.view.pane = pane;
    driver.app.view.zoomed = true;
    driver.resize(size);
    driver.press(".");
    driver
}

#[test]
fn axes_have_numbers_quantities_and_units_in_every_pane() {
    for size in SIZES {
        for (pane, across, up) in [
            (Pane::Force, "d (", "F ("),
            (Pane::Profile, "x (", "z ("),
            (Pane::CloseUp, "x (", "z ("),
            (Pane::Beside, "x (", "z ("),
            (Pane::Lengths, "δx (", "○ n"),
            (Pane::Spectrum, "q (", "C ("),
            (Pane::Preloads, "F_n (", "F_a ("),
            (Pane::Everett, "d (", "d_r ("),
            (Pane::Density, "d (", "d_r ("),
            (Pane::Accuracy, "t (", "error"),
            (Pane::Map, " H", "κ"),
        ] {
            let driver = zoomed(pane, size);
            let area = Layout::of(&driver.app).pane(pane).unwrap();
            if !is_framed(area) {
                continue;
            }
            let rows = driver.rows()[usize::from(area.y)..usize::from(area.bottom())].join("\n");
            assert!(rows.contains(across) && rows.contains(up), "{size:?} {pane:?}\n{rows}");
            let has_numbers = rows.lines().filter(|row| row.contains('┤')).count() >= 2;
            assert!(has_numbers || area.height < 12, "{size:?} {pane:?}\n{rows}");
        }
    }
}

#[test]
fn a_digit_on_a_choice_says_how_choices_are_changed() {
    for size in [SIZES[0], SIZES[4]] {
        let switch = |driver: &Driver| {
            let switches = driver.app.edit.parameters.iter().find(|one| one.path.starts_with("observe."));
            switches.map(|one| (one.path.clone(), format!("{} is a switch: t changes it", one.name())))
        };
        let (switch, says_of_switch) = switch(&pressed("")).unwrap();
        for (path, expected) in [
            ("adhesion", "adhesion is a choice: ← → change it"),
            ("numerics.edges", "edges is a choice: ← → change it"),
            ("material", "material is not a number: Enter types it"),
            ("loading", "loading is not a number: Enter types it"),
            ("numerics", "numerics is a group: its fields are in the rows below"),
            (&switch, &says_of_switch),
        ] {
            let mut driver = pressed("");
            driver.app.edit.selected =
                driver.app.edit.parameters.iter().position(|one| one.path == path).unwrap();
            driver.app.view.pane = Pane::Parameters;
            driver.resize(size);
            let before = driver.app.edit.document.text().to_owned();
            driver.press("2");
            let status = driver.status();
            let start = status.split("  ").next().unwrap_or_default();
            let start = start.strip_suffix('…').unwrap_or(start);
            assert!(expected.starts_with(start) && start.len() > 8, "{size:?} {path}: {status}");
            assert_eq!((driver.app.prompt.is_none(), driver.app.edit.document.text()), (true, &*before));
        }
    }
}

#[test]
fn a_key_of_a_pane_shows_the_pane() {
    for size in SIZES {
        for (keys, pane) in [
            ("D", Pane::Lengths),
            ("&", Pane::Beside),
            ("Q", Pane::Spectrum),
            ("i", Pane::Preloads),
            ("A", Pane::Accuracy),
            ("m", Pane::Map),
        ] {
            let mut driver = pressed("");
            driver.app.view.pane = Pane::Force;
            driver.resize(size);
            let is_shown = |driver: &Driver| Layout::of(&driver.app).pane(pane).is_some();
            assert!(!is_shown(&driver));
            driver.press(keys);
            assert!(is_shown(&driver), "{size:?} {keys}\n{}", driver.text());
            driver.press(keys);
            assert!(!is_shown(&driver), "{size:?} {keys}\n{}", driver.text());
        }
    }
}
