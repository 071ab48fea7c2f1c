//! The mouse selects, drags and scrolls, and is released on request.

use crate::common::terminal::Terminal;
use crate::driving::{count, explorer, paused, quantity, quit};
use vt100::{MouseProtocolEncoding, MouseProtocolMode};

const LEFT: u8 = 0;
const DRAGGED: u8 = 32;

/// Bytes of a terminal for the mouse at a cell, counted from 1.
fn report(what: u8, column: usize, row: usize) -> String {
    format!("\x1b[<{what};{column};{row}M")
}

/// Column and row, counted from 1, at which a text begins.
#[track_caller]
fn place_of(terminal: &Terminal, text: &str) -> (usize, usize) {
    let rows = terminal.rows();
    let found = rows.iter().enumerate().find_map(|(row, line)| {
        line.find(text)
            .map(|byte| (line[..byte].chars().count() + 1, row + 1))
    });
    found.unwrap_or_else(|| panic!("no {text}:\n{}", terminal.text()))
}

#[test]
fn the_terminal_is_asked_for_presses_and_drags_but_not_for_every_motion() {
    let (program, _folder) = explorer();
    let mut terminal = paused(program);
    assert_eq!(
        terminal.screen().mouse_protocol_mode(),
        MouseProtocolMode::ButtonMotion
    );
    assert_eq!(
        terminal.screen().mouse_protocol_encoding(),
        MouseProtocolEncoding::Sgr
    );
    quit(&mut terminal);
    assert_eq!(count(terminal.written(), b"1003h"), 0);
    assert_eq!(
        terminal.screen().mouse_protocol_mode(),
        MouseProtocolMode::None
    );
    // On request the mouse is left to the terminal.
    let (program, folder) = explorer();
    std::fs::write(
        folder.path().join("still.ron"),
        "(version: 1, mouse: false)",
    )
    .unwrap();
    let mut terminal = paused(program.argument("--config=still.ron"));
    quit(&mut terminal);
    assert_eq!(count(terminal.written(), b"\x1b[?100"), 0);
}

#[test]
fn presses_and_drags_have_their_effects() {
    let (program, _folder) = explorer();
    let mut terminal = paused(program);
    // A release, another button and a place outside have no effect.
    let before = terminal.text();
    terminal.send("\x1b[<2;20;10M\x1b[<2;20;10m\x1b[<0;900;900M\x1b[<35;20;10M");
    terminal.settle();
    assert_eq!(terminal.text(), before);
    let indentation = |rows: &[String]| {
        let row: Vec<String> = rows
            .iter()
            .filter(|row| row.contains("manual loading"))
            .cloned()
            .collect();
        quantity(&row, "d", "m")
    };
    let (column, row) = place_of(&terminal, "Force F (");
    terminal.send(&(report(LEFT, column + 20, row + 8) + &report(DRAGGED, column + 20, row + 8)));
    terminal.wait("manual loading", |rows| indentation(rows).is_some());
    let start = indentation(&terminal.rows());
    terminal.send(&report(DRAGGED, column + 30, row + 8));
    terminal.wait("deeper body", |rows| indentation(rows) > start);
    quit(&mut terminal);
}
