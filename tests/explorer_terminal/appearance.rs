//! Colours, and the background for which they are chosen.

use crate::common::terminal::Terminal;
use crate::driving::{ESCAPE, explorer, paused, place, quit};
use std::time::Duration;
use vt100::{Cell, Color};

/// The cells of the screen.
fn cells(terminal: &Terminal) -> Vec<Cell> {
    let (rows, columns) = terminal.screen().size();
    let places =
        (0..rows.get()).flat_map(|row| (0..columns.get()).map(move |column| (row, column)));
    places
        .filter_map(|(row, column)| terminal.screen().cell(row, column).cloned())
        .collect()
}

#[test]
fn without_colours_there_is_emphasis_and_no_colour() {
    let shown = |name: &str, value: &str| {
        let (program, _folder) = explorer();
        let mut terminal = paused(program.env(name, value));
        let mut all = cells(&terminal);
        for (keys, words) in [("s", "Save as: "), ("?", "What you see")] {
            terminal.send(keys);
            terminal.wait_for(words);
            all.extend(cells(&terminal));
            terminal.send(ESCAPE);
            terminal.wait_without(words);
        }
        quit(&mut terminal);
        all
    };
    let is_coloured =
        |cell: &Cell| cell.fgcolor() != Color::Default || cell.bgcolor() != Color::Default;
    let plain = shown("NO_COLOR", "1");
    assert!(!plain.iter().any(is_coloured), "{plain:?}");
    assert!(plain.iter().any(Cell::bold), "titles are bold");
    assert!(
        plain.iter().any(Cell::inverse),
        "the selected row is reversed"
    );
    // An empty variable counts as unset.
    for (name, value) in [("NO_COLOR", ""), ("COLUMNS", "1")] {
        assert!(shown(name, value).iter().any(is_coloured), "{name}={value}");
    }
}

/// Question about the colour of the background.
const QUESTION: &[u8] = b"\x1b]11;?\x1b\\";

/// Colours for the curve of loading on a dark and on a light background.
const ON_DARK: Color = Color::Rgb(245, 166, 60);
const ON_LIGHT: Color = Color::Rgb(166, 84, 0);

fn has_colour(terminal: &Terminal, colour: Color) -> bool {
    cells(terminal).iter().any(|cell| cell.fgcolor() == colour)
}

#[test]
fn the_colours_suit_the_background_that_the_terminal_states() {
    for (answer, colour) in [
        ("\x1b]11;rgb:0000/0000/0000\x1b\\", ON_DARK),
        ("\x1b]11;rgb:fdfd/f6f6/e3e3\x07", ON_LIGHT),
    ] {
        let (program, _folder) = explorer();
        let mut terminal = program.env("COLORTERM", "truecolor").start();
        while place(terminal.written(), QUESTION).is_none() {
            terminal.is_silent_for(Duration::from_millis(5));
        }
        // The answer is late, and comes together with a key.
        terminal.wait_for("F_a ");
        terminal.send(&format!("{answer}?"));
        terminal.wait_for("What you see");
        terminal.send("?");
        terminal.wait_without("What you see");
        assert!(has_colour(&terminal, colour), "{answer:?}");
        quit(&mut terminal);
    }
}

#[test]
fn a_terminal_with_a_known_background_is_not_asked() {
    for (name, value) in [("COLORFGBG", "0;15"), ("TERM", "linux"), ("NO_COLOR", "1")] {
        let (program, _folder) = explorer();
        let mut terminal = paused(program.env(name, value));
        assert_eq!(place(terminal.written(), QUESTION), None, "{name}");
        quit(&mut terminal);
    }
}
