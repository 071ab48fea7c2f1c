//! Parameters are edited by keys.

use crate::common::deadline::within;
use crate::driving::{
    CLEAR_LINE, ENTER, ESCAPE, explorer, headline, paused, quit, row_with, select, wait_for_another,
};

#[test]
fn an_edit_changes_the_adhesion_force_and_undo_brings_it_back() {
    within(40, || {
        let (program, _folder) = explorer();
        let mut terminal = paused(program);
        let before = headline(&terminal.rows()).unwrap();
        select(&mut terminal, "κ");
        terminal.send("h");
        let after = wait_for_another(&mut terminal, &before);
        terminal.wait_for("[changed]");
        terminal.send("u");
        assert_eq!(wait_for_another(&mut terminal, &after), before);
        terminal.wait_without("[changed]");
        quit(&mut terminal);
    });
}

#[test]
fn a_value_is_typed_with_its_unit() {
    within(40, || {
        let (program, _folder) = explorer();
        let mut terminal = paused(program);
        let before = headline(&terminal.rows()).unwrap();
        select(&mut terminal, "effective modulus");
        terminal.send("e");
        terminal.wait_for("Esc cancel");
        terminal.send(CLEAR_LINE);
        // In a value, letters are typed, even those that are keys elsewhere.
        terminal.send("3 q");
        terminal.wait_for("3 q");
        terminal.send("\x7f");
        terminal.send("MPa");
        terminal.wait_for("3 MPa");
        terminal.send(ENTER);
        wait_for_another(&mut terminal, &before);
        assert!(row_with(&terminal, "effective modulus").contains("3 MPa"), "{}", terminal.text());
        terminal.send("u");
        terminal.wait_without("[changed]");
        quit(&mut terminal);
    });
}

#[test]
fn a_value_is_pasted_and_a_wrong_one_refused() {
    within(40, || {
        let (program, _folder) = explorer();
        let mut terminal = paused(program);
        let before = headline(&terminal.rows()).unwrap();
        select(&mut terminal, "Hurst exponent");
        terminal.send("e");
        terminal.wait_for("Esc cancel");
        terminal.send(CLEAR_LINE);
        terminal.send("\x1b[200~1.5\r\nq\x1b[201~");
        terminal.wait_for("1.5q");
        terminal.send("\x7f");
        terminal.send(ENTER);
        // The refused value remains for correction; Escape discards it.
        terminal.wait_for("allowed: above 0 and below 1");
        terminal.wait_for("Esc cancel");
        terminal.send(ESCAPE);
        terminal.wait_without("Esc cancel");
        assert!(row_with(&terminal, "Hurst exponent").contains("0.7"), "the last good value is kept");
        assert!(!terminal.text().contains("[changed]"));
        terminal.send("j");
        terminal.wait_without("allowed: above 0 and below 1");
        assert_eq!(headline(&terminal.rows()), Some(before));
        quit(&mut terminal);
    });
}

#[test]
fn help_opens_scrolls_and_closes() {
    within(40, || {
        let (program, _folder) = explorer();
        let mut terminal = paused(program);
        let before = terminal.text();
        for (open, close) in [("?", "?"), ("?", ESCAPE), ("\x1bOP", "q")] {
            terminal.send(open);
            terminal.wait_for("rigid profile below");
            terminal.send(&"j".repeat(30));
            terminal.wait_without("rigid profile below");
            terminal.send(close);
            terminal.wait("screen as before", |rows| rows.join("\n") == before);
        }
        quit(&mut terminal);
    });
}
