//! The mouse: keys do everything that the mouse does.

use super::*;
use asperity::explorer::panel::Under;
use asperity::explorer::panes::force::indentation_at;
use asperity::explorer::panes::under;
use ratatui::layout::Position;

/// Number on the horizontal axis of the chart in a cell.
fn axis_number(driver: &Driver, column: u16, row: u16) -> f64 {
    match under(&driver.app, Position::new(column, row)) {
        Some((_, Under::Data(x, _))) => x,
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_press_chooses_the_pane_and_the_row() {
    let mut driver = pressed("");
    for pane in [Pane::Profile, Pane::CloseUp, Pane::Parameters, Pane::Force] {
        let area = driver.area(pane);
        driver.mouse(area.x + 1, area.y, Gesture::Press);
        assert_eq!(driver.app.view.pane, pane);
    }
    // Each visible row, also in a scrolled list.
    for keys in ["g", "G"] {
        let area = driver.area(Pane::Parameters);
        let mut chosen = 0;
        for row in area.y..area.bottom() {
            driver.press(keys);
            let rows = driver.rows();
            let text: String = rows[usize::from(row)]
                .chars()
                .skip(usize::from(area.x))
                .collect();
            let before = driver.app.edit.selected;
            driver.mouse(area.x + 3, row, Gesture::Press);
            if driver.app.edit.selected != before || text.contains('›') {
                let name = driver.app.edit.parameter().unwrap().name();
                assert!(text.contains(&name), "{name}: {text}");
                chosen += 1;
            }
        }
        assert!(chosen > 5, "{chosen}");
    }
    assert!(
        driver.mouse(500, 500, Gesture::Press).is_empty(),
        "nothing is there"
    );
}

#[test]
fn a_drag_takes_the_body_to_where_the_mouse_is() {
    for (document, size, keys) in [
        (default_scene(), (120, 40), ""),
        (default_scene(), (80, 24), "N"),
        (default_scene(), (120, 40), "v v z"),
    ] {
        let mut driver = mid_retraction(document);
        driver.press(keys);
        driver.resize(size);
        let area = driver.area(Pane::Force);
        driver.mouse(area.x + 21, area.y + 5, Gesture::Press);
        assert!(
            driver.app.edit.path.is_none(),
            "a click alone moves nothing"
        );
        for (number, column) in [21, 25, 18, 23].into_iter().enumerate() {
            let (column, row) = (area.x + column, area.y + 5);
            driver.mouse(
                column,
                row,
                if number == 2 {
                    Gesture::Press
                } else {
                    Gesture::Drag
                },
            );
            let [wanted, next] = [column, column + 1].map(|column| {
                indentation_at(&driver.app, axis_number(&driver, column, row)).unwrap()
            });
            let found = driver.point().indentation;
            assert!(driver.app.edit.path.is_some());
            // The view may change a little as the path of manual loading grows.
            assert!(
                (found - wanted).abs() <= next - wanted,
                "{found}, not {wanted}"
            );
        }
    }
    // Over the axis of forces there is no indentation.
    let mut driver = pressed("v");
    let area = driver.area(Pane::Force);
    driver.mouse(area.x + 20, area.y + 5, Gesture::Press);
    driver.mouse(area.x + 21, area.y + 5, Gesture::Drag);
    assert!(driver.app.edit.path.is_none() && driver.app.view.pane == Pane::Force);
}

#[test]
fn the_wheel_looks_closer_and_scrolls() {
    let mut driver = pressed("");
    let area = driver.area(Pane::Profile);
    driver.mouse(area.x, area.y, Gesture::Wheel(1));
    assert_eq!(driver.app.view.profile.share, 0.5);
    driver.mouse(area.x, area.y, Gesture::Wheel(-1));
    assert_eq!(driver.app.view.profile.share, 1.0);
    // The place under the pointer remains there.
    let (column, row) = (area.x + 3 * area.width / 4, area.y + 2);
    let length = driver.document().scene().length;
    let at = |driver: &Driver| axis_number(driver, column, row) / length;
    let before = at(&driver);
    for turns in [1, 1, 1, -1] {
        driver.mouse(column, row, Gesture::Wheel(turns));
        assert!(
            (at(&driver) - before).abs() < 0.02 * driver.app.view.profile.share + 1e-3,
            "{} {before}",
            at(&driver)
        );
    }
    assert_eq!(driver.app.view.profile.share, 0.25);
    let (area, springs) = (
        driver.area(Pane::CloseUp),
        driver.snapshot().close_up.section.springs,
    );
    driver.mouse(area.x, area.y, Gesture::Wheel(1));
    assert_eq!(
        (driver.app.view.close_up.springs, driver.app.view.pane),
        (Some(springs / 2), Pane::CloseUp)
    );
    driver.press("g");
    let area = driver.area(Pane::Parameters);
    driver.mouse(area.x, area.y, Gesture::Wheel(-1));
    assert_eq!(driver.app.edit.selected, 1);
    driver.mouse(area.x, area.y, Gesture::Wheel(1));
    assert_eq!(driver.app.edit.selected, 0);
    driver.resize((80, 24));
    driver.press("?");
    driver.mouse(3, 3, Gesture::Wheel(-1));
    assert_eq!(
        driver.app.prompt.as_ref().map(|help| help.selected),
        Some(1)
    );
    driver.mouse(3, 3, Gesture::Press);
    assert_eq!(
        driver.app.prompt.as_ref().map(|help| help.selected),
        Some(1),
        "a press does nothing there"
    );
    driver.press("Esc o");
    driver.mouse(3, 3, Gesture::Wheel(-1));
    assert!(
        driver
            .app
            .prompt
            .as_ref()
            .is_some_and(|prompt| prompt.selected == 1)
    );
}
