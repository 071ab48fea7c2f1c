//! Colours.

use crate::common::terminal::Terminal;
use crate::driving::{ESCAPE, explorer, paused, quit};
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
