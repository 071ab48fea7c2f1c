//! The window changes its size.

use crate::driving::{explorer, paused, quit};

#[test]
fn a_window_that_shrinks_and_grows_back_at_once_is_drawn_anew() {
    let (program, _folder) = explorer();
    let mut terminal = paused(program);
    let before = terminal.text();
    for _ in 0..30 {
        terminal.resize(40, 12);
        terminal.resize(120, 40);
        terminal.wait("screen as before", |rows| rows.join("\n") == before);
    }
    quit(&mut terminal);
}

#[test]
fn a_window_of_millions_of_cells_is_refused() {
    let (program, _folder) = explorer();
    let mut terminal = program.size(4001, 1000).start();
    assert_eq!(terminal.wait_end().exit_code(), 1);
    let message = "a window of 4001 × 1000 cells; allowed: at most 4000000 cells";
    assert!(
        terminal.text().contains(message),
        "{}",
        terminal.text().trim()
    );
}

#[test]
fn keys_and_changes_of_the_window_that_come_together_all_count() {
    let (program, _folder) = explorer();
    let mut terminal = paused(program);
    let marked = |rows: &[String]| rows.iter().find(|row| row.contains('›')).cloned();
    for round in 0..60 {
        let before = marked(&terminal.rows()).expect("a parameter is selected");
        let name: String = before
            .split('›')
            .nth(1)
            .expect("it has a name")
            .chars()
            .take(16)
            .collect();
        // The width of this window shows that the new size is known.
        terminal.resize(100 + round % 2, 40);
        terminal.send(if round / 10 % 2 == 0 { "j" } else { "k" });
        terminal.wait("other row selected", |rows| {
            marked(rows).is_some_and(|row| !row.contains(&name))
        });
        let right = 99 + usize::from(round % 2);
        terminal.wait("title at the edge", |rows| {
            rows.iter().any(|row| row.chars().nth(right) == Some('─'))
        });
    }
    quit(&mut terminal);
}
