//! The mouse selects, drags and scrolls, and is released on request.

use crate::common::deadline::within;
use crate::common::terminal::Terminal;
use crate::driving::{count, explorer, paused, quantity, quit, row_with};
use vt100::{MouseProtocolEncoding, MouseProtocolMode};

const LEFT: u8 = 0;
const DRAGGED: u8 = 32;
const WHEEL_UP: u8 = 64;
const WHEEL_DOWN: u8 = 65;

/// Bytes of a terminal for the mouse at a cell, counted from 1.
fn report(what: u8, column: usize, row: usize) -> String {
    format!("\x1b[<{what};{column};{row}M")
}

/// Presses and releases the left button.
fn click(terminal: &mut Terminal, column: usize, row: usize) {
    terminal.send(&(report(LEFT, column, row) + &format!("\x1b[<{LEFT};{column};{row}m")));
}

/// Column and row, counted from 1, at which a text begins.
#[track_caller]
fn place_of(terminal: &Terminal, text: &str) -> (usize, usize) {
    let rows = terminal.rows();
    let found = rows
        .iter()
        .enumerate()
        .find_map(|(row, line)| line.find(text).map(|byte| (line[..byte].chars().count() + 1, row + 1)));
    found.unwrap_or_else(|| panic!("no {text}:\n{}", terminal.text()))
}

/// Indentation of manual loading, m.
fn manual_indentation(rows: &[String]) -> Option<f64> {
    let row: Vec<String> = rows.iter().filter(|row| row.contains("manual: d ")).cloned().collect();
    quantity(&row, "d", "m")
}

/// The column, counted from 1, of the mark of the body on the curve. The legend has the mark, too.
#[track_caller]
fn cursor(terminal: &Terminal) -> usize {
    let rows = terminal.rows();
    let place = |row: &String| row.chars().position(|character| character == '◆');
    let found = rows.iter().filter(|row| !row.contains("◆ manual")).find_map(place);
    found.unwrap_or_else(|| panic!("no ◆:\n{}", terminal.text())) + 1
}

#[test]
fn the_terminal_is_asked_for_presses_and_drags_but_not_for_every_motion() {
    within(40, || {
        let (program, _folder) = explorer();
        let mut terminal = paused(program);
        assert_eq!(terminal.screen().mouse_protocol_mode(), MouseProtocolMode::ButtonMotion);
        assert_eq!(terminal.screen().mouse_protocol_encoding(), MouseProtocolEncoding::Sgr);
        quit(&mut terminal);
        for mode in ["1000", "1002", "1006"] {
            for end in ["h", "l"] {
                let sequence = format!("\x1b[?{mode}{end}");
                assert!(count(terminal.written(), sequence.as_bytes()) > 0, "{sequence:?}");
            }
        }
        assert_eq!(count(terminal.written(), b"1003h"), 0);
        assert_eq!(terminal.screen().mouse_protocol_mode(), MouseProtocolMode::None);
    });
}

#[test]
fn the_mouse_is_left_to_the_terminal_where_that_is_wanted() {
    within(40, || {
        let (program, _folder) = explorer();
        let mut terminal = paused(program.argument("--no-mouse"));
        assert_eq!(terminal.screen().mouse_protocol_mode(), MouseProtocolMode::None);
        quit(&mut terminal);
        for mode in ["1000", "1002", "1003", "1006", "1015"] {
            let sequence = format!("\x1b[?{mode}");
            assert_eq!(count(terminal.written(), sequence.as_bytes()), 0, "{sequence:?}");
        }
    });
}

#[test]
fn a_click_chooses_a_pane_and_a_parameter() {
    within(40, || {
        let (program, _folder) = explorer();
        let mut terminal = paused(program);
        terminal.wait_for("▸ Force");
        let (column, row) = place_of(&terminal, "Profile z(x)");
        click(&mut terminal, column, row + 3);
        terminal.wait_for("▸ Profile");
        let (column, row) = place_of(&terminal, "Hurst exponent");
        click(&mut terminal, column, row);
        terminal.wait("row selected", |rows| {
            rows.iter().any(|row| row.contains('›') && row.contains("Hurst exponent"))
        });
        assert!(terminal.text().contains("▸ Parameters"), "{}", terminal.text());
        // The wheel continues from there.
        let selected = row_with(&terminal, "›");
        terminal.send(&report(WHEEL_DOWN, column, row));
        terminal.wait("next row", |rows| rows.iter().any(|row| row.contains('›') && *row != selected));
        terminal.send(&report(WHEEL_UP, column, row));
        terminal.wait("row before", |rows| rows.contains(&selected));
        // A release, another button and a place outside have no effect.
        let before = terminal.text();
        terminal.send("\x1b[<2;20;10M\x1b[<2;20;10m\x1b[<0;900;900M\x1b[<35;20;10M");
        terminal.settle();
        assert_eq!(terminal.text(), before);
        quit(&mut terminal);
    });
}

#[test]
fn the_body_is_dragged_along_the_curve() {
    within(40, || {
        let (program, _folder) = explorer();
        let mut terminal = paused(program);
        let (column, row) = place_of(&terminal, "Force F(d)");
        let (left, row) = (column + 20, row + 8);
        terminal.send(&report(LEFT, left, row));
        terminal.wait("manual loading", |rows| manual_indentation(rows).is_some());
        assert!(cursor(&terminal).abs_diff(left) <= 1, "{left}:\n{}", terminal.text());
        let mut last = manual_indentation(&terminal.rows()).unwrap();
        let start = last;
        for column in (left + 4..left + 20).step_by(4) {
            terminal.send(&report(DRAGGED, column, row));
            terminal.wait("deeper body", |rows| manual_indentation(rows).is_some_and(|now| now > last));
            last = manual_indentation(&terminal.rows()).unwrap();
            assert!(cursor(&terminal).abs_diff(column) <= 1, "{column}:\n{}", terminal.text());
        }
        // Back to the beginning; all cells have the same width.
        terminal.send(&report(DRAGGED, left, row));
        terminal.wait("body back", |rows| manual_indentation(rows).is_some_and(|now| now < last));
        let back = manual_indentation(&terminal.rows()).unwrap();
        assert!((back - start).abs() < 0.02 * (last - start), "{start} {last} {back}");
        quit(&mut terminal);
    });
}

#[test]
fn the_wheel_zooms_into_the_profile_and_scrolls_the_help() {
    within(40, || {
        let (program, _folder) = explorer();
        let mut terminal = paused(program);
        let (column, row) = place_of(&terminal, "Profile z(x)");
        let title = row_with(&terminal, "Profile z(x)");
        terminal.send(&report(WHEEL_UP, column, row + 5));
        terminal.wait("closer profile", |rows| rows.iter().all(|row| *row != title));
        let closer = row_with(&terminal, "Profile z(x)");
        assert_ne!(closer.replace('▸', ""), title.replace('▸', ""), "{}", terminal.text());
        terminal.send(&report(WHEEL_DOWN, column, row + 5));
        terminal.wait("whole profile", |rows| rows.iter().all(|row| *row != closer));
        terminal.send("?");
        terminal.wait_for("rigid profile below");
        terminal.send(&report(WHEEL_DOWN, 20, 20).repeat(30));
        terminal.wait_without("rigid profile below");
        terminal.send(&report(WHEEL_UP, 20, 20).repeat(30));
        terminal.wait_for("rigid profile below");
        terminal.send("?");
        terminal.wait_without("rigid profile below");
        quit(&mut terminal);
    });
}
