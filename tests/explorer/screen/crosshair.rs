//! The crosshair: its readings, and their agreement with the panes.

use super::*;
use asperity::data::parse_quantity;
use asperity::explorer::snapshot::Probe;

fn probe(driver: &Driver) -> Probe {
    driver.snapshot().probe.unwrap()
}

/// The title of a pane with the readings beside it, and the rows of readings below the chart.
fn edge(driver: &Driver, pane: Pane) -> String {
    let rows = driver.pane(pane);
    let title = rows[0].replace('▸', "");
    let below = rows
        .iter()
        .rev()
        .take_while(|row| !row.contains(['┤', '│', '└']));
    [title]
        .into_iter()
        .chain(below.cloned())
        .collect::<Vec<_>>()
        .join(" ")
}

/// A value with this number of digits behind the first, as in the panes.
fn read(value: f64, digits: usize, unit: &str) -> String {
    format_quantity(format!("{value:.digits$e}").parse().unwrap(), unit)
}

/// A punch without adhesion has one straight line for both branches.
#[test]
fn on_the_force_curve_the_crosshair_reads_both_branches() {
    let mut driver = mid_retraction(changed(&punch(), &[("adhesion", "None")]));
    assert!(!edge(&driver, Pane::Force).contains(" loading "));
    driver.press("* End Shift+Left");
    assert_eq!(driver.app.keys(), Context::Crosshair);
    assert!(driver.footer().contains("hide"), "{}", driver.text());
    let (shown, end) = (driver.point(), driver.app.stages()[0].largest);
    for keys in ["", "Left", "Shift+Left"] {
        driver.press(keys);
        let edge = edge(&driver, Pane::Force);
        let number = |name: &str, unit: &str| {
            let words: Vec<&str> = edge
                .split(&format!(" {name} "))
                .nth(1)
                .unwrap()
                .split(' ')
                .collect();
            parse_quantity(&words[..2].join(" "), unit).unwrap()
        };
        let expected = end.force / end.indentation * number("d", "m");
        for branch in ["loading", "unloading"] {
            assert!(
                (number(branch, "N") / expected - 1.0).abs() < 0.01,
                "{expected}: {edge}"
            );
        }
    }
    assert_eq!(driver.point(), shown, "the body stays");
    driver.press("Esc");
    assert_eq!(driver.app.keys(), Context::Explore);
}

#[test]
fn on_the_profile_the_crosshair_reads_position_height_and_state() {
    for document in [rough(), punch()] {
        let mut driver = mid_retraction(document);
        driver.press("* Tab Tab Home");
        assert_eq!(
            (driver.app.view.pane, probe(&driver).spring),
            (Pane::Profile, 0)
        );
        let mut states = Vec::new();
        for _ in 0..10 {
            let shown = driver.snapshot();
            let Probe {
                spring,
                height,
                level,
                patch,
            } = probe(&driver);
            let x = (shown.line.first + spring) as f64 + 0.5;
            let state = match patch {
                None => format!("gap {}", read(level - height, 3, "m")),
                Some(_) if level > height => format!("stretched {}", read(level - height, 3, "m")),
                Some(_) => format!("compressed {}", read(height - level, 3, "m")),
            };
            let text = edge(&driver, Pane::Profile);
            for expected in [
                read(x * shown.line.spacing, 3, "m"),
                read(height, 3, "m"),
                state,
            ] {
                assert!(text.contains(&expected), "{expected}\n{text}");
            }
            states.push(patch.is_some());
            driver.press("Shift+Right");
        }
        assert!(states.contains(&true), "{states:?}");
        driver.press("End Right");
        assert_eq!(probe(&driver).spring, driver.snapshot().profile.springs - 1);
    }
}

#[test]
fn the_mouse_moves_the_crosshair_of_the_pane_it_is_in() {
    let mut driver = mid_retraction(default_scene());
    driver.press("*");
    for pane in [Pane::Profile, Pane::CloseUp, Pane::Force] {
        let area = driver.area(pane);
        let mut places = Vec::new();
        for (column, gesture) in [
            (8, Gesture::Press),
            (14, Gesture::Drag),
            (20, Gesture::Press),
        ] {
            driver.mouse(area.x + column, area.y + 4, gesture);
            places.push(driver.app.view.crosshair.unwrap());
        }
        assert!(
            places.windows(2).all(|pair| pair[0] < pair[1]),
            "{pane:?} {places:?}"
        );
        assert_eq!(
            (driver.app.view.pane, driver.app.edit.path.is_none()),
            (pane, true)
        );
    }
    // With the parameters selected the arrows act on these.
    let before = driver.app.edit.selected;
    while driver.app.view.pane != Pane::Parameters {
        driver.press("Tab Tab");
    }
    driver.press("Down");
    assert_ne!(driver.app.edit.selected, before);
}
