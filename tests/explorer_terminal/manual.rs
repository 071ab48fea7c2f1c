//! Manual loading of the body.

use crate::common::deadline::within;
use crate::common::terminal::Terminal;
use crate::driving::{CLEAR_LINE, ESCAPE, answer, explorer, paused, quantity, quit, select};

/// Indentation and force of manual loading, m and N.
fn body_at(rows: &[String]) -> Option<(f64, f64)> {
    let row: Vec<String> = rows.iter().filter(|row| row.contains("manual: d ")).cloned().collect();
    Some((quantity(&row, "d", "m")?, quantity(&row, "F", "N")?))
}

/// Numbers of springs changed by the last move, and of entries read for it.
#[track_caller]
fn changed(terminal: &mut Terminal) -> u64 {
    terminal.send("I");
    terminal.wait_for(" springs changed");
    let rows = terminal.rows();
    let row = rows.iter().find(|row| row.contains(" springs changed")).unwrap();
    let before = row.split(" springs changed").next().unwrap();
    let number = before.rsplit(' ').next().unwrap().parse();
    terminal.send("I");
    terminal.wait_for("manual: d ");
    number.unwrap_or_else(|_| panic!("{row}"))
}

/// Moves the body by a key, and returns its new position.
#[track_caller]
fn push(terminal: &mut Terminal, key: &str) -> (f64, f64) {
    let before = body_at(&terminal.rows());
    terminal.send(key);
    terminal.wait("moved body", |rows| body_at(rows).is_some_and(|now| Some(now) != before));
    body_at(&terminal.rows()).unwrap()
}

#[test]
fn the_body_is_pressed_and_pulled_by_keys() {
    within(60, || {
        let (program, _folder) = explorer();
        let mut terminal = paused(program);
        assert_eq!(body_at(&terminal.rows()), None);
        terminal.send("d");
        terminal.wait("manual loading", |rows| body_at(rows).is_some());
        let (start, _) = body_at(&terminal.rows()).unwrap();
        let (coarse, _) = push(&mut terminal, "}");
        let (fine, _) = push(&mut terminal, "]");
        let ratio = (coarse - start) / (fine - coarse);
        assert!(fine > coarse && (8.0..12.5).contains(&ratio), "{start} {coarse} {fine}: {ratio}");
        let (pulled, _) = push(&mut terminal, "[");
        assert!((pulled - coarse).abs() < 0.3 * (fine - coarse), "{pulled} {coarse}");
        assert!(push(&mut terminal, "{").0 < pulled);

        // In contact the line below shows the changes of a move.
        terminal.send("F");
        answer(&mut terminal, "Go to the force: ", "10 µN");
        let at_force =
            |rows: &[String]| body_at(rows).is_some_and(|(_, force)| (force / 1e-5 - 1.0).abs() < 1e-3);
        terminal.wait("force of 10 µN", at_force);
        let (pressed, force) = body_at(&terminal.rows()).unwrap();
        let changed = changed(&mut terminal);
        assert!(changed > 10, "{changed} springs changed");
        let (deeper, larger) = push(&mut terminal, "}");
        assert!(deeper > pressed && larger > force);

        terminal.send("S");
        terminal.wait("separated body", |rows| body_at(rows).is_some_and(|(d, f)| d < pressed && f == 0.0));
        terminal.send("d");
        terminal.wait("body given back", |rows| body_at(rows).is_none());
        quit(&mut terminal);
    });
}

#[test]
fn a_force_that_is_none_or_out_of_reach_is_stated() {
    within(40, || {
        let (program, _folder) = explorer();
        let mut terminal = paused(program);
        terminal.send("F");
        answer(&mut terminal, "Go to the force: ", "ten");
        terminal.wait_for("! \"ten\" is not a number, such as");
        terminal.send("F");
        answer(&mut terminal, "Go to the force: ", "5u");
        terminal
            .wait("force of 5 µN", |rows| body_at(rows).is_some_and(|(_, f)| (f / 5e-6 - 1.0).abs() < 1e-3));
        terminal.send("F");
        answer(&mut terminal, "Go to the force: ", "-1");
        terminal.wait_for("the contact detaches before");
        // A key removes the line, and manual loading continues at the same place.
        terminal.send("k");
        terminal.wait("manual loading", |rows| body_at(rows).is_some());
        let (_, force) = body_at(&terminal.rows()).unwrap();
        assert!((force / 5e-6 - 1.0).abs() < 1e-3, "{force} N");
        terminal.send("F");
        terminal.wait_for("Go to the force:");
        terminal.send(CLEAR_LINE);
        terminal.send(ESCAPE);
        terminal.wait_without("Go to the force:");
        assert_eq!(body_at(&terminal.rows()).unwrap().1, force, "nothing was asked for");
        quit(&mut terminal);
    });
}

#[test]
fn an_edit_puts_the_body_back_on_the_loading() {
    within(40, || {
        let (program, _folder) = explorer();
        let mut terminal = paused(program);
        select(&mut terminal, "κ");
        push(&mut terminal, "}");
        terminal.send("h");
        terminal.wait_for("the body is back on the scene's loading");
        terminal.send("u");
        terminal.wait_without("[changed]");
        terminal.settle();
        assert_eq!(body_at(&terminal.rows()), None, "{}", terminal.text());
        // The animation also takes the body back.
        push(&mut terminal, "}");
        terminal.send(".");
        terminal.wait("body given back", |rows| body_at(rows).is_none());
        terminal.send("F");
        terminal.wait_for("Go to the force:");
        terminal.send(ESCAPE);
        terminal.wait_without("Go to the force:");
        quit(&mut terminal);
    });
}
