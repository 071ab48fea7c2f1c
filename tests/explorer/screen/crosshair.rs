//! The crosshair: its readings, and their agreement with the panes.

use super::common::driver::Driver;
use super::common::scenes::{punch, rough};
use super::{default_scene, mid_retraction, pressed};
use asperity::explorer::action::Gesture;
use asperity::explorer::app::Pane;
use asperity::explorer::keys::Context;
use asperity::explorer::snapshot::Probe;
use asperity::scene::format_quantity;

fn probe(driver: &Driver) -> Probe {
    driver.snapshot().probe.unwrap()
}

/// The lower edge of the frame of a pane.
fn edge(driver: &Driver, pane: Pane) -> String {
    driver.pane(pane).pop().unwrap()
}

/// A force with three digits, a length with four, as in the panes.
pub fn read(value: f64, digits: usize, unit: &str) -> String {
    format_quantity(format!("{value:.digits$e}").parse().unwrap(), unit)
}

#[test]
fn the_crosshair_reads_the_state_that_all_panes_show() {
    for size in [(120, 40), (80, 24)] {
        let mut driver = mid_retraction(default_scene());
        driver.resize(size);
        assert!(!edge(&driver, Pane::Force).contains(" d "));
        driver.press("*");
        assert_eq!(driver.app.keys(), Context::Crosshair);
        assert!(driver.rows().last().unwrap().contains("hide"), "{}", driver.text());
        for keys in ["", "Right", "Shift+Left", "Up", "Left Left", "Down", "Home", "End"] {
            driver.press(keys);
            let point = driver.point();
            let text = edge(&driver, Pane::Force);
            let [d, force] = [read(point.indentation, 2, "m"), read(point.force, 2, "N")];
            assert!(text.contains(&format!("d {d}")), "{keys}: {d}\n{text}");
            assert!(text.contains(&format!("F {force}")), "{keys}: {force}\n{text}");
            // The body of profile and close-up is at the same indentation.
            let level = driver.outcome().line.summit - point.indentation;
            let shown = driver.snapshot();
            assert!((shown.profile.level - level).abs() < 1e-18);
            assert!((shown.close_up.section.level - level).abs() < 1e-18);
            assert!(!driver.app.play.playing);
        }
        driver.press("Esc");
        assert_eq!(driver.app.keys(), Context::Explore);
        assert!(!edge(&driver, Pane::Force).contains(" d "));
    }
}

#[test]
fn the_crosshair_moves_along_a_stage_and_to_the_other_one_at_the_same_indentation() {
    let mut driver = mid_retraction(rough());
    driver.press("*");
    let at = |driver: &Driver| (driver.app.play.leg, driver.snapshot().point);
    let (leg, before) = at(&driver);
    driver.press("Right");
    let (_, right) = at(&driver);
    assert!(leg == 1 && right.indentation > before.indentation);
    driver.press("Shift+Left");
    assert!(at(&driver).1.indentation < before.indentation);
    driver.press("Shift+Right Left");
    assert!((at(&driver).1.indentation - before.indentation).abs() < 1e-15);
    driver.press("Up");
    let (leg, loading) = at(&driver);
    assert_eq!(leg, 0);
    assert!((loading.indentation - before.indentation).abs() < 1e-15);
    assert!(loading.force > before.force, "adhesion holds on the way back");
    driver.press("Down");
    assert_eq!(at(&driver).0, 1);
    // Up to the ends of the stage.
    let ends = |driver: &Driver| {
        let leg = &driver.app.legs()[1];
        (leg.end().min(leg.start()), leg.end().max(leg.start()))
    };
    driver.press("End");
    assert_eq!(at(&driver).1.indentation, ends(&driver).1);
    driver.press("Right Right");
    assert_eq!((at(&driver).0, at(&driver).1.indentation), (1, ends(&driver).1));
    driver.press("Home");
    assert!(at(&driver).1.indentation <= ends(&driver).0);
    // In manual loading the crosshair moves the body.
    driver.press("End d Left");
    assert!(driver.app.manual.is_some() && driver.point().indentation < ends(&driver).1);
    assert!(!edge(&driver, Pane::Force).contains("stage"));
}

#[test]
fn on_the_profile_the_crosshair_reads_position_height_and_state() {
    for document in [rough(), punch()] {
        let mut driver = mid_retraction(document);
        driver.press("* Tab");
        assert_eq!(driver.app.view.pane, Pane::Profile);
        let mut states = Vec::new();
        driver.press("Home");
        let first = probe(&driver).spring;
        assert_eq!(first, 0);
        for _ in 0..40 {
            let shown = driver.snapshot();
            let Probe { spring, height, level, patch } = probe(&driver);
            // One column for each dot: the height is within its column.
            let columns = shown.profile.columns.len();
            let column =
                shown.profile.columns[(spring * columns).div_ceil(shown.profile.springs).min(columns - 1)];
            let near = |low: f64, high: f64| low - 1e-15 <= height && height <= high + 1e-15;
            let before = shown.profile.columns[(spring * columns / shown.profile.springs).min(columns - 1)];
            assert!(near(column.line.0.min(before.line.0), column.line.1.max(before.line.1)));
            let x = (shown.line.first + spring) as f64 + 0.5;
            let text = edge(&driver, Pane::Profile);
            for expected in [read(x * shown.line.spacing, 3, "m"), read(height, 3, "m")] {
                assert!(text.contains(&expected), "{expected}\n{text}");
            }
            let expected = match patch {
                None => format!("gap {}", read(level - height, 3, "m")),
                Some(_) if level > height => format!("stretched {}", read(level - height, 3, "m")),
                Some(_) => format!("compressed {}", read(height - level, 3, "m")),
            };
            assert!(text.contains(&expected), "{expected}\n{text}");
            if patch.is_none() {
                assert!(level >= height, "a free spring does not lie under the body");
            }
            states.push(patch.is_some());
            driver.press("Shift+Right");
        }
        assert!(states.contains(&true), "{states:?}");
        driver.press("End");
        assert_eq!(probe(&driver).spring, driver.snapshot().profile.springs - 1);
        driver.press("Right");
        assert_eq!(probe(&driver).spring, driver.snapshot().profile.springs - 1);
    }
}

#[test]
fn the_mouse_moves_the_crosshair_of_the_pane_it_is_in() {
    for size in [(120, 40), (80, 24)] {
        let mut driver = mid_retraction(default_scene());
        driver.resize(size);
        driver.press("*");
        for pane in [Pane::Profile, Pane::CloseUp] {
            let area = driver.area(pane);
            let mut springs = Vec::new();
            for column in [area.x + 8, area.x + 14, area.x + 20] {
                driver.mouse(column, area.y + 2, Gesture::Press);
                springs.push(probe(&driver).spring);
            }
            assert!(springs.windows(2).all(|pair| pair[0] < pair[1]), "{springs:?}");
            assert_eq!(driver.app.view.pane, pane);
            driver.mouse(area.x + 9, area.y + 2, Gesture::Drag);
            assert!(probe(&driver).spring < springs[1]);
        }
        // The nearest branch of the force curve is taken, and manual loading does not begin.
        let area = driver.area(Pane::Force);
        let sign = |driver: &Driver, glyph: &str| {
            let screen = driver.screen();
            let cells =
                (area.y..area.bottom()).rev().flat_map(|y| (area.x..area.right()).map(move |x| (x, y)));
            cells.into_iter().find(|cell| screen[*cell].symbol() == glyph).unwrap()
        };
        let pull_off = sign(&driver, "▼");
        driver.mouse(pull_off.0, pull_off.1, Gesture::Press);
        assert!(driver.app.manual.is_none() && driver.app.play.leg == 1);
        let force = driver.app.legs()[1].smallest.force;
        assert!(driver.point().force < 0.8 * force, "{} {force}", driver.point().force);
        let preload = sign(&driver, "▲");
        driver.mouse(preload.0, preload.1, Gesture::Press);
        assert!(driver.point().force > 0.8 * driver.app.legs()[0].largest.force);
    }
}

#[test]
fn crosshairs_of_profile_and_close_up_are_at_one_position() {
    let mut driver = pressed("b *");
    let patch = driver.snapshot().close_up.fragment.unwrap();
    assert_eq!(probe(&driver).spring, patch.patch.middle(), "it begins in the middle of the patch");
    assert_eq!(probe(&driver).patch, Some(patch.number));
    let [profile, close_up] = [Pane::Profile, Pane::CloseUp].map(|pane| edge(&driver, pane));
    let reading = |text: &str| text.split("  z (").next().unwrap().trim_start_matches(['└', ' ']).to_owned();
    assert_eq!(reading(&profile), reading(&close_up));
    assert!(reading(&profile).contains(&format!("patch {} of", patch.number + 1)), "{profile}");
    // With the parameters selected the arrows act on these.
    let before = driver.app.edit.selected;
    while driver.app.view.pane != Pane::Parameters {
        driver.press("Tab");
    }
    driver.press("Down");
    assert_ne!(driver.app.edit.selected, before);
}
