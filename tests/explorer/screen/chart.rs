//! The map over H and κ: its content, its mark at the scene, and the order of its computations.

use super::common::deadline::within;
use super::common::driver::Driver;
use super::common::scenes::{changed, rough, smooth, without_adhesion};
use super::is_up_to_date;
use asperity::explorer::action::{Action, Gesture, Mouse};
use asperity::explorer::app::Pane;
use asperity::explorer::chart::Live;
use asperity::explorer::keys::Context;
use asperity::explorer::layout::{Layout, inside};
use asperity::explorer::theme::Marker;
use asperity::explorer::update::{Effect, studies};
use asperity::scene::{Document, RoughnessParameter};
use asperity::study::{Level, LiveMap, MAP_LINES, Quantity, live_plan};

/// Values of κ or e_el/γ on the live map.
fn values(parameter: RoughnessParameter) -> Vec<f64> {
    live_plan(rough().scene(), parameter).unwrap().axes.swap_remove(0).values
}

/// A map of a cell on each of four profiles: adhesion falls with κ, and with it the regime.
fn set(map: &mut LiveMap, cell: u64) {
    let (parameter, hurst) = match map.plan().values(cell)[..] {
        [parameter, hurst] => (parameter, hurst),
        _ => panic!("the map has no H"),
    };
    let kappa = if map.plan().axes[0].path == "kappa" { parameter } else { parameter.sqrt() };
    let regime = match kappa * (0.5 + hurst) {
        ..2.0 => 0,
        2.0..12.0 => 1,
        _ => 2,
    };
    for line in 0..MAP_LINES {
        // Of four profiles one is in another regime.
        let regime = if line == 3 { (regime + 1) % 3 } else { regime };
        map.set(cell, line, &[(-kappa).exp(), 2.0 * (-kappa / 2.0).exp(), f64::from(regime)]);
    }
}

/// Fills levels of the map of the scene, if it has one.
fn fill(driver: &mut Driver, levels: &[Level]) {
    let (scene, chart) = (driver.app.edit.document.scene(), &driver.app.chart);
    let Ok(plan) = live_plan(scene, chart.parameter) else { return };
    let key = chart.key(scene).unwrap();
    let mut map = LiveMap::new(plan).unwrap();
    for cell in levels.iter().flat_map(|level| map.cells(*level).concat()).collect::<Vec<_>>() {
        set(&mut map, cell);
    }
    driver.app.studies.set(key, Live::of(&map), map.is_whole());
}

fn driver_with(document: Document, levels: &[Level]) -> Driver {
    let mut driver = Driver::start(document);
    driver.press("Space");
    fill(&mut driver, levels);
    driver.press("m");
    driver
}

/// The explorer with a complete map on display.
pub fn charted(document: Document) -> Driver {
    driver_with(document, &Level::ALL)
}

/// κ and H of the mark, on a map with H across.
fn place(driver: &Driver) -> (f64, f64) {
    let (hurst, kappa) = driver.app.place().unwrap();
    (kappa.unwrap(), hurst)
}

#[test]
fn e_maps_over_the_elastic_energy() {
    within(60, || {
        let mut driver = charted(rough());
        let over_kappa = place(&driver);
        driver.press("e");
        fill(&mut driver, &Level::ALL);
        for size in [(120, 40), (80, 24)] {
            driver.resize(size);
            assert!(driver.text().contains("over H, e_el/γ, 4 profiles"), "{}", driver.text());
            assert!(driver.text().contains("◆ H 0.7, e_el/γ "), "{}", driver.text());
        }
        let ratio = driver.app.governing().unwrap().elastic_energy_ratio.unwrap();
        assert_eq!(place(&driver), (ratio, over_kappa.1));
        // The mark moves to values of the map, and the scene with it.
        driver.press("k");
        let (moved, _) = place(&driver);
        let values = values(RoughnessParameter::ElasticEnergyRatio);
        assert!(moved > ratio && values.iter().any(|value| (moved / value - 1.0).abs() < 1e-9), "{moved}");
        let kappa = driver.app.governing().unwrap().kappa.unwrap();
        assert!((kappa / over_kappa.0 - (moved / ratio).sqrt()).abs() < 1e-9, "{kappa}");
        driver.press("e");
        fill(&mut driver, &Level::ALL);
        assert!(driver.text().contains("over H, κ, 4 profiles"), "{}", driver.text());
        assert!((place(&driver).0 / kappa - 1.0).abs() < 1e-12);
    });
}

#[test]
fn the_map_is_shown_beside_what_can_be_changed() {
    within(60, || {
        for (keys, levels) in [("", &Level::ALL[..]), ("", &[Level::Coarse]), ("V", &Level::ALL)] {
            let mut driver = driver_with(rough(), levels);
            driver.press(keys);
            for size in [(120, 40), (80, 24)] {
                driver.resize(size);
                assert!(driver.text().contains("over H, κ, 4 profiles") || keys == "V", "{}", driver.text());
                assert!(driver.text().contains("◆ H 0.7, κ 8"), "{}", driver.text());
                assert_eq!(
                    driver.text().contains("5 × 5 cells so far"),
                    levels.len() == 1,
                    "{}",
                    driver.text()
                );
                assert!(driver.text().contains("Parameters") && driver.text().contains("Force F(d)"));
            }
        }
    });
}

#[test]
fn the_map_says_without_colours_what_it_says_with_them() {
    within(60, || {
        let mut driver = charted(rough());
        for legend in ["█ pressure-insensitive", "▒ pressure-sensitive", "· non-adhesive"] {
            assert!(driver.text().contains(legend), "{legend}\n{}", driver.text());
        }
        // The same three in every column, from below.
        let [insensitive, sensitive, adhesive] = ["████", "▒▒▒▒", "····"].map(|shades| {
            let rows = driver.rows();
            let all: Vec<usize> = (0..rows.len()).filter(|row| rows[*row].contains(shades)).collect();
            (all[0], all[all.len() - 1])
        });
        assert!(adhesive.0 < sensitive.0 && sensitive.1 < insensitive.1, "{}", driver.text());
        driver.app.view.appearance.marker = Marker::Ascii;
        assert!(driver.text().is_ascii() && driver.text().contains("##"), "{}", driver.text());
        driver.app.view.appearance.marker = Marker::Braille;
        // Each quantity has a legend of its own, with the scale of the shades, and the regimes as letters.
        for (quantity, expected) in [
            (Quantity::ZeroLoadAdhesionShare, "F_a(0)/F_a,max "),
            (Quantity::AdhesionCoefficient, "F_a/F_n "),
        ] {
            driver.press("V");
            assert_eq!(driver.app.chart.quantity, quantity);
            for expected in [expected, "···", "███", "i pressure-insensitive", "▁▕ F_a(0) = 0.05 F_a,max"]
            {
                assert!(driver.text().contains(expected), "{expected}\n{}", driver.text());
            }
        }
        driver.press("V");
        assert_eq!(driver.app.chart.quantity, Quantity::Regime);
        assert!(driver.text().contains("█ pressure-insensitive"), "{}", driver.text());
    });
}

#[test]
fn the_map_is_exported_as_it_is_seen() {
    within(60, || {
        let folder = tempfile::tempdir().unwrap();
        let mut driver = charted(rough());
        let mut export = |keys: &str, name: &str| {
            driver.press(keys);
            driver.press("E Ctrl+u");
            assert!(driver.status().contains("Export to"), "{}", driver.status());
            let path = folder.path().join(name);
            driver.act(Action::Paste(path.to_str().unwrap().to_owned()));
            driver.press("Enter");
            (std::fs::read_to_string(path).unwrap_or_default(), driver.status())
        };
        let (cells, _) = export("", "map.csv");
        let rows: Vec<&str> = cells.lines().filter(|line| !line.starts_with('#')).collect();
        assert_eq!(rows.len(), 1 + 33 * 19);
        assert_eq!(
            rows[0],
            "roughness.hurst,kappa,lines,regime,zero_load_adhesion_share_mean,zero_load_adhesion_share_low,\
             zero_load_adhesion_share_high,adhesion_coefficient_mean,adhesion_coefficient_low,adhesion_coefficient_high"
        );
        assert_eq!(
            rows[1],
            format!(
                "0.05,0.125,4,pressure-insensitive,{:?},,,{:?},,",
                (-0.125_f64).exp(),
                2.0 * (-0.0625_f64).exp()
            )
        );
        let (figure, _) = export("", "map.svg");
        for expected in ["Hurst exponent", "pressure-sensitive", "adhesion coefficient"] {
            assert!(figure.starts_with("<svg") && figure.contains(expected), "{expected}");
        }
        let (_, message) = export("", "map.png");
        assert!(message.starts_with("exported to"), "{message}");
        assert!(std::fs::read(folder.path().join("map.png")).unwrap().starts_with(b"\x89PNG\r\n\x1a\n"));
        let (nothing, message) = export("", "map.json");
        assert!(nothing.is_empty() && message.contains("this result has no json form"), "{message}");
        // The curve, with another pane selected.
        driver.press("Esc Tab Tab E");
        assert!(driver.status().contains("Export to"), "{}", driver.status());
    });
}

#[test]
fn moves_in_a_row_are_one_edit() {
    within(60, || {
        let mut driver = charted(rough());
        assert_eq!(driver.app.keys(), Context::Map);
        let before = driver.app.edit.document.clone();
        let (edits, map) = (driver.app.edit.past.len(), driver.app.grid().cloned());
        assert_eq!(driver.press("Down"), [Effect::Ask]);
        assert_eq!(place(&driver), (6.73, 0.7));
        driver.press("Down Left h k Shift+Down Right");
        assert_eq!(place(&driver), (3.36, 0.65));
        assert_eq!(driver.app.edit.past.len(), edits + 1);
        assert!(is_up_to_date(&driver.app));
        // The map is that of all of them.
        assert_eq!(driver.app.grid(), map.as_ref());
        assert!(driver.text().contains("◆ H 0.65, κ 3.36"), "{}", driver.text());
        // Any other key ends the row.
        driver.press("V Up");
        assert_eq!((place(&driver).0, driver.app.edit.past.len()), (4.0, edits + 2));
        driver.press("u");
        assert_eq!(place(&driver), (3.36, 0.65));
        driver.press("Down u u");
        assert_eq!(driver.app.edit.document, before);
        driver.press("U");
        assert_eq!(place(&driver), (3.36, 0.65));
        assert_eq!(driver.app.grid(), map.as_ref());
    });
}

#[test]
fn the_mark_stays_on_the_map() {
    within(60, || {
        let mut driver = charted(rough());
        driver.press(&"Shift+Right Shift+Up ".repeat(9));
        assert_eq!(place(&driver), (32.0, 0.95));
        let generation = driver.app.edit.generation;
        driver.press("Up");
        assert!(driver.status().contains("edge of the map"), "{}", driver.status());
        assert_eq!(driver.app.edit.generation, generation);
        // A scene beyond it comes back with the first step.
        driver.press("Tab Tab");
        assert_eq!(driver.app.keys(), Context::Explore);
        driver.select("adhesion.kappa");
        driver.enter("100");
        assert!(driver.text().contains("H 0.95, κ 100, outside the map"), "{}", driver.text());
        driver.press("m j");
        assert_eq!(place(&driver).0, 32.0);
    });
}

#[test]
fn adhesion_given_by_its_work_stays_so() {
    within(60, || {
        let mut driver = charted(changed(&rough(), &[("adhesion", "(work: 0.02)")]));
        driver.press("Right Up");
        let adhesion = driver.app.edit.document.scene().adhesion.unwrap();
        assert!(adhesion.parameter().is_none() && adhesion.work.is_some_and(|work| work != 0.02));
        let (at, hurst) = place(&driver);
        assert!(
            values(RoughnessParameter::Kappa).iter().any(|kappa| (kappa / at - 1.0).abs() < 1e-9),
            "{at}"
        );
        assert_eq!(hurst, 0.75);
        // The computed value agrees.
        let computed = driver.app.solved.as_ref().unwrap().outcome.governing.kappa.unwrap();
        assert!((computed / at - 1.0).abs() < 1e-9);
    });
}

#[test]
fn the_mouse_moves_the_mark() {
    within(60, || {
        let mut driver = charted(rough());
        let edits = driver.app.edit.past.len();
        let area = inside(Layout::of(&driver.app).pane(Pane::Chart).unwrap());
        let mut mouse = |column, row, gesture| driver.act(Action::Mouse(Mouse { column, row, gesture }));
        mouse(area.x + 20, area.y + 10, Gesture::Press);
        for column in 20..30 {
            mouse(area.x + column, area.y + 12, Gesture::Drag);
        }
        assert_eq!(driver.app.edit.past.len(), edits + 1);
        // A cell of the map has two of the screen.
        let screen = driver.screen();
        let near = |x: u16, y: u16| screen[(area.x + x, area.y + y)].symbol() == "◆";
        let seen = (27..=31).any(|x| (11..=13).any(|y| near(x, y)));
        assert!(seen, "{}", driver.text());
    });
}

#[test]
fn other_edits_begin_the_map_anew() {
    within(60, || {
        let mut driver = charted(rough());
        let begins = |driver: &mut Driver| studies(&mut driver.app).iter().any(|study| study.is::<Live>());
        assert!(!begins(&mut driver), "it is whole");
        driver.press("Tab Tab R");
        assert!(begins(&mut driver));
        assert!(driver.text().contains("computing the map"), "{}", driver.text());
        // The map is hidden.
        driver.press("m m");
        assert!(!driver.app.is_shown(Pane::Chart));
        assert!(!begins(&mut driver));
        assert_eq!(driver.press("m"), [Effect::Study, Effect::Ask]);
        assert!(begins(&mut driver));
        // Accuracy takes the place of the map, and vice versa.
        driver.press("A");
        assert_eq!(driver.app.view.large, Some(Pane::Accuracy));
        driver.press("m");
        assert_eq!(driver.app.view.large, Some(Pane::Chart));
    });
}

#[test]
fn a_scene_without_a_map_says_why() {
    within(60, || {
        for (document, why) in [(smooth(), "a smooth body has"), (without_adhesion(), "has no adhesion")] {
            let mut driver = charted(document);
            assert!(driver.text().contains(why), "{}", driver.text());
            let generation = driver.app.edit.generation;
            driver.press("Left Up");
            assert_eq!(driver.app.edit.generation, generation);
        }
    });
}
