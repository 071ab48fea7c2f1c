//! Loops are kept and compared.

use crate::common::deadline::within;
use crate::driving::{explorer, headline, paused, quit, row_with, select, wait_for_another};

#[test]
fn a_loop_is_kept_compared_and_exchanged() {
    within(60, || {
        let (program, _folder) = explorer();
        let mut terminal = paused(program);
        terminal.send("x");
        terminal.wait_for("there is no ghost to swap with");
        terminal.send("c");
        terminal.wait_for("kept as ghost A");
        terminal.send("c");
        terminal.wait_for("this loop is kept already");
        select(&mut terminal, "κ");
        let before = headline(&terminal.rows()).unwrap();
        terminal.send("h");
        let after = wait_for_another(&mut terminal, &before);
        // The legend names the ghost by its differences from the scene.
        terminal.wait_for("· κ 8 ");
        let value = |rows: &[String]| {
            let row = rows.iter().find(|row| row.contains("›") && row.contains('κ'))?;
            Some(row.rsplit(['│', '█', ' ']).find(|word| !word.is_empty())?.to_owned())
        };
        let changed = value(&terminal.rows()).expect("κ has a value");
        assert_ne!(changed, "8");

        terminal.send("x");
        terminal.wait("first loop", |rows| headline(rows).as_ref() == Some(&before));
        terminal.wait_for(&format!("· κ {changed} "));
        assert_eq!(value(&terminal.rows()).as_deref(), Some("8"));
        terminal.send("x");
        terminal.wait("second loop", |rows| headline(rows).as_ref() == Some(&after));
        terminal.wait_for("· κ 8 ");

        terminal.send("C");
        terminal.wait_without("· κ 8 ");
        // Exchanges are edits and can be undone.
        terminal.send("u");
        terminal.wait("first loop", |rows| headline(rows).as_ref() == Some(&before));
        terminal.send("uu");
        terminal.wait_without("[changed]");
        assert!(row_with(&terminal, "roughness-adhesion parameter κ").contains(" 8"), "{}", terminal.text());
        quit(&mut terminal);
    });
}

#[test]
fn edits_are_taken_back_and_done_again() {
    within(60, || {
        let (program, _folder) = explorer();
        let mut terminal = paused(program);
        select(&mut terminal, "κ");
        let mut forces = vec![headline(&terminal.rows()).unwrap()];
        for _ in 0..3 {
            terminal.send("h");
            let last = forces.last().unwrap();
            let next = wait_for_another(&mut terminal, &last.clone());
            forces.push(next);
        }
        let reached = |terminal: &mut crate::common::terminal::Terminal, force: &String| {
            terminal.wait(force, |rows| headline(rows).as_ref() == Some(force));
        };
        for force in forces.iter().rev().skip(1) {
            terminal.send("u");
            reached(&mut terminal, force);
        }
        terminal.wait_without("[changed]");
        for (key, force) in ["U", "\x12", "U"].iter().zip(&forces[1..]) {
            terminal.send(key);
            reached(&mut terminal, force);
        }
        // Nothing more to redo.
        terminal.send("U");
        terminal.send("uuu");
        terminal.wait_without("[changed]");
        reached(&mut terminal, &forces[0]);
        quit(&mut terminal);
    });
}
