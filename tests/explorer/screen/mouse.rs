//! The mouse: keys do everything that the mouse does.

use super::common::deadline::within;
use super::common::driver::Driver;
use super::{default_scene, mid_retraction, pressed};
use asperity::explorer::action::{Action, Gesture, Mouse};
use asperity::explorer::app::Pane;
use asperity::explorer::layout::{Layout, inside};
use asperity::explorer::panel::Under;
use asperity::explorer::panes::{indentation_at, under};
use asperity::explorer::update::Effect;
use ratatui::layout::{Position, Rect};

fn mouse(driver: &mut Driver, column: u16, row: u16, gesture: Gesture) -> Vec<Effect> {
    driver.act(Action::Mouse(Mouse { column, row, gesture }))
}

/// Number on the horizontal axis of the chart in a cell.
fn axis_number(driver: &Driver, column: u16, row: u16) -> f64 {
    match under(&driver.app, Position::new(column, row)) {
        Some((_, Under::Data(x, _))) => x,
        other => panic!("{other:?}"),
    }
}

fn place(driver: &Driver, pane: Pane) -> Rect {
    inside(Layout::of(&driver.app).pane(pane).expect("the pane is shown"))
}

#[test]
fn a_press_chooses_the_pane_and_the_row() {
    within(30, || {
        let mut driver = pressed("");
        for pane in [Pane::Profile, Pane::CloseUp, Pane::Parameters, Pane::Force] {
            let area = place(&driver, pane);
            mouse(&mut driver, area.x + 1, area.y, Gesture::Press);
            assert_eq!(driver.app.view.pane, pane);
        }
        // Each visible row, also in a scrolled list.
        for keys in ["g", "G"] {
            let area = place(&driver, Pane::Parameters);
            let mut chosen = 0;
            for row in area.y..area.bottom() {
                driver.press(keys);
                let rows = driver.rows();
                let text: String = rows[usize::from(row)].chars().skip(usize::from(area.x)).collect();
                let before = driver.app.edit.selected;
                mouse(&mut driver, area.x + 3, row, Gesture::Press);
                if driver.app.edit.selected != before || text.contains('›') {
                    let name = driver.app.edit.parameter().unwrap().name();
                    assert!(text.contains(&name), "{name}: {text}");
                    chosen += 1;
                }
            }
            assert!(chosen > 5, "{chosen}");
        }
        // A second press on the first row of a group, still in its place, folds the group.
        driver.press("g");
        let area = place(&driver, Pane::Parameters);
        let loading = driver.rows().iter().position(|row| row.contains("▾●loading")).unwrap() as u16;
        let all = driver.app.edit.listed().len();
        mouse(&mut driver, area.x + 5, loading, Gesture::Press);
        assert_eq!(driver.app.edit.listed().len(), all);
        mouse(&mut driver, area.x + 5, loading, Gesture::Press);
        assert_eq!(
            (driver.app.edit.listed().len(), driver.app.edit.parameter().unwrap().group),
            (all - 1, "loading")
        );
        mouse(&mut driver, area.x + 5, loading, Gesture::Press);
        assert_eq!(driver.app.edit.listed().len(), all);
        assert!(mouse(&mut driver, 500, 500, Gesture::Press).is_empty(), "nothing is there");
    });
}

#[test]
fn a_drag_takes_the_body_to_where_the_mouse_is() {
    within(60, || {
        for (document, size, keys) in [
            (default_scene(), (120, 40), ""),
            (default_scene(), (80, 24), "N"),
            (default_scene(), (120, 40), "v v z"),
        ] {
            let mut driver = mid_retraction(document);
            driver.press(keys);
            driver.resize(size);
            let area = place(&driver, Pane::Force);
            // The legend has the mark as well.
            let above = if area.height < 12 { 1 } else { 3 };
            let gutter = 9;
            let columns =
                [area.x + gutter + 12, area.x + gutter + 16, area.x + gutter + 9, area.x + gutter + 14];
            for (number, column) in columns.into_iter().enumerate() {
                let gesture = if number == 0 { Gesture::Press } else { Gesture::Drag };
                mouse(&mut driver, column, area.y + 5, gesture);
                let wanted = indentation_at(&driver.app, axis_number(&driver, column, area.y + 5)).unwrap();
                let next = indentation_at(&driver.app, axis_number(&driver, column + 1, area.y + 5)).unwrap();
                let found = driver.app.snapshot.as_ref().unwrap().point.indentation;
                assert!(driver.app.manual.is_some());
                // The view may change a little as the path of manual loading grows.
                assert!((found - wanted).abs() <= next - wanted, "{found}, not {wanted}");
                let screen = driver.screen();
                let seen: Vec<u16> = (0..driver.app.view.size.1)
                    .filter(|row| *row >= area.y + above && *row < area.bottom())
                    .flat_map(|row| (area.x..area.right()).map(move |column| (column, row)))
                    .filter(|&(column, row)| screen[(column, row)].symbol() == "◆")
                    .map(|(column, _)| column)
                    .collect();
                assert!(
                    seen.iter().any(|seen| seen.abs_diff(column) <= 1),
                    "{seen:?}, not {column}\n{}",
                    driver.text()
                );
            }
        }
        // Over the axis of forces there is no indentation.
        let mut driver = pressed("v");
        let area = place(&driver, Pane::Force);
        mouse(&mut driver, area.x + 20, area.y + 5, Gesture::Press);
        assert!(driver.app.manual.is_none() && driver.app.view.pane == Pane::Force);
    });
}

#[test]
fn the_wheel_looks_closer_and_scrolls() {
    within(30, || {
        let mut driver = pressed("");
        let area = place(&driver, Pane::Profile);
        mouse(&mut driver, area.x, area.y, Gesture::Wheel(1));
        assert_eq!(driver.app.view.profile.share, 0.5);
        mouse(&mut driver, area.x, area.y, Gesture::Wheel(-1));
        assert_eq!(driver.app.view.profile.share, 1.0);
        // The place under the pointer remains there.
        let (column, row) = (area.x + 3 * area.width / 4, area.y + 2);
        let length = driver.app.edit.document.scene().length;
        let at = |driver: &Driver| axis_number(driver, column, row) / length;
        let before = at(&driver);
        for turns in [1, 1, 1, -1] {
            mouse(&mut driver, column, row, Gesture::Wheel(turns));
            assert!(
                (at(&driver) - before).abs() < 0.02 * driver.app.view.profile.share + 1e-3,
                "{} {before}",
                at(&driver)
            );
        }
        assert_eq!(driver.app.view.profile.share, 0.25);
        driver.press("0");
        let (area, springs) = (place(&driver, Pane::CloseUp), driver.app.view.look.springs);
        mouse(&mut driver, area.x, area.y, Gesture::Wheel(1));
        assert_eq!((driver.app.view.look.springs, driver.app.view.pane), (springs / 2, Pane::CloseUp));
        driver.press("g");
        let area = place(&driver, Pane::Parameters);
        mouse(&mut driver, area.x, area.y, Gesture::Wheel(-1));
        assert_eq!(driver.app.edit.selected, 1);
        mouse(&mut driver, area.x, area.y, Gesture::Wheel(1));
        assert_eq!(driver.app.edit.selected, 0);
        driver.resize((80, 24));
        driver.press("?");
        mouse(&mut driver, 3, 3, Gesture::Wheel(-1));
        assert_eq!(driver.app.prompt.as_ref().map(|help| help.selected), Some(1));
        mouse(&mut driver, 3, 3, Gesture::Press);
        assert_eq!(
            driver.app.prompt.as_ref().map(|help| help.selected),
            Some(1),
            "a press does nothing there"
        );
        driver.press("Esc o");
        mouse(&mut driver, 3, 3, Gesture::Wheel(-1));
        assert!(driver.app.prompt.as_ref().is_some_and(|prompt| prompt.selected == 1));
    });
}
