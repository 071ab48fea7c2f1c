//! The map over H and κ: its content, its mark at the scene, and the order of its computations.

use super::*;
use asperity::explorer::commands::accuracy::studies;
use asperity::explorer::map_state::Live;
use asperity::study::Plan;
use asperity::study::maps::LiveMap;

/// A map of a cell on each of four profiles: adhesion falls with κ, and with it the regime.
fn set(map: &mut LiveMap, cell: u64) {
    let (kappa, hurst) = match map.plan().values(cell)[..] {
        [kappa, hurst] => (kappa, hurst),
        _ => panic!("the map has no H"),
    };
    let regime = match kappa * (0.5 + hurst) {
        ..2.0 => 0,
        2.0..12.0 => 1,
        _ => 2,
    };
    for line in 0..Plan::PROFILES_OF_MAP {
        // Of four profiles one is in another regime.
        let regime = if line == 3 { (regime + 1) % 3 } else { regime };
        let after_zero_force = if regime == 1 { 0 } else { regime };
        let (regime, after_zero_force) = (f64::from(regime), f64::from(after_zero_force));
        let [touch, zero_force] = [1.0, 0.5].map(|slope: f64| (-slope * kappa).exp());
        map.set(
            cell,
            line,
            &[
                touch,
                2.0 * zero_force,
                regime,
                zero_force,
                after_zero_force,
                1.5 * touch,
            ],
        );
    }
}

/// The explorer with a complete map on display, if the scene has one.
pub fn mapped(document: Document) -> Driver {
    let mut driver = Driver::start(document);
    driver.press("Space");
    let scene = driver.document().scene();
    if let Ok(plan) = Plan::of_map(scene) {
        let key = driver.app.map.key(scene).unwrap();
        let mut map = LiveMap::new(plan).unwrap();
        (0..map.plan().cells()).for_each(|cell| set(&mut map, cell));
        driver.app.studies.set(key, Live::of(&map), map.is_whole());
    }
    driver.press("m");
    driver
}

/// κ and H of the mark, on a map with H across.
fn place(driver: &Driver) -> (f64, f64) {
    let (hurst, kappa) = driver.app.place().unwrap();
    (kappa.unwrap(), hurst)
}

#[test]
fn moves_in_a_row_are_one_edit() {
    let mut driver = mapped(rough());
    assert_eq!(driver.app.keys(), Context::Map);
    let before = driver.document().clone();
    let (edits, map) = (driver.app.edit.past.len(), driver.app.grid().cloned());
    assert_eq!(driver.press("Down"), [Task::Ask]);
    assert_eq!(place(&driver), (6.73, 0.7));
    driver.press("Down Left h k Shift+Down Right");
    assert_eq!(place(&driver), (3.36, 0.65));
    assert_eq!(driver.app.edit.past.len(), edits + 1);
    assert!(is_up_to_date(&driver.app));
    // The map is that of all of them.
    assert_eq!(driver.app.grid(), map.as_ref());
    driver.shows("◆ H 0.65, κ 3.36");
    // Any other key ends the row.
    driver.press("V Up");
    assert_eq!(
        (place(&driver).0, driver.app.edit.past.len()),
        (4.0, edits + 2)
    );
    driver.press("u");
    assert_eq!(place(&driver), (3.36, 0.65));
    driver.press("Down u u");
    assert_eq!(*driver.document(), before);
    driver.press("U");
    assert_eq!(place(&driver), (3.36, 0.65));
    assert_eq!(driver.app.grid(), map.as_ref());
}

/// In a low pane the text on the mark has less detail, and its end is shown.
#[test]
fn the_text_on_the_mark_is_not_cut() {
    let mut driver = mapped(rough());
    driver.resize((160, 45));
    driver.shows("(3 of 4 profiles)");
    for size in [(120, 36), (100, 30), (80, 24)] {
        driver.resize(size);
        let rows = driver.rows();
        let first = rows.iter().position(|row| row.starts_with("◆ ")).unwrap();
        let below = rows
            .iter()
            .position(|row| row.contains("─ Force F"))
            .unwrap();
        let text = rows[first..below].concat();
        assert!(text.contains("F_a/F_n"), "{text}");
    }
}

#[test]
fn the_mouse_moves_the_mark() {
    let mut driver = mapped(rough());
    let edits = driver.app.edit.past.len();
    let area = driver.area(Pane::Map);
    driver.mouse(area.x + 20, area.y + 10, Gesture::Press);
    for column in 20..30 {
        driver.mouse(area.x + column, area.y + 12, Gesture::Drag);
    }
    assert_eq!(driver.app.edit.past.len(), edits + 1);
    // A cell of the map has two of the screen.
    let screen = driver.screen();
    let near = |x: u16, y: u16| screen[(area.x + x, area.y + y)].symbol() == "◆";
    let seen = (27..=31).any(|x| (11..=13).any(|y| near(x, y)));
    assert!(seen, "{}", driver.text());
}

#[test]
fn other_edits_begin_the_map_anew() {
    let mut driver = mapped(rough());
    let begins = |driver: &mut Driver| {
        studies(&mut driver.app)
            .iter()
            .any(|study| study.is::<Live>())
    };
    assert!(!begins(&mut driver), "it is whole");
    driver.press("Tab Tab R");
    assert!(begins(&mut driver));
    driver.shows("computing the map");
    // The map is hidden.
    driver.press("m m");
    assert!(!driver.app.is_shown(Pane::Map));
    assert!(!begins(&mut driver));
    assert_eq!(driver.press("m"), [Task::Study, Task::Ask]);
    assert!(begins(&mut driver));
}

/// The map has both regimes, each with its protocol and the quantities that decide it.
#[test]
fn the_regime_has_two_protocols() {
    let mut driver = mapped(rough());
    driver.shows("Map of regime (d=0) over H, κ");
    driver.press("V V V V V");
    driver.shows_all([
        "Map of regime (F=0)",
        "pressure-insensitive turned at zero force (3 of 4",
        "F_a(F=0)/F_a,max",
    ]);
}
