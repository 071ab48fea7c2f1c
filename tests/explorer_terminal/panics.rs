//! Panics of the engine and of the view, and an endless engine.

use crate::common::terminal::{Program, Terminal};
use crate::driving::{
    ASPERITY, CLEAR_LINE, ENTER, assert_given_back, headline, paused, quit, row_with, select,
};
use crate::idle::assert_idle;
use std::path::{Path, PathBuf};

/// The explorer with an engine that panics on the seed 13 and computes endlessly on the seed 14.
fn panicking() -> Program {
    let folder = Path::new(ASPERITY)
        .parent()
        .expect("the program is in a folder");
    let path: PathBuf = folder.join("examples").join("panicking_engine");
    assert!(
        path.exists(),
        "{} is not built: cargo build --examples",
        path.display()
    );
    Program::new(path)
}

/// Types another seed.
fn seed(terminal: &mut Terminal, seed: &str) {
    terminal.send("\r");
    terminal.wait_for("Esc cancel");
    terminal.send(CLEAR_LINE);
    terminal.send(seed);
    terminal.send(ENTER);
}

#[test]
fn a_panic_of_the_engine_is_a_line_and_the_explorer_goes_on() {
    let mut terminal = paused(panicking());
    let before = headline(&terminal.rows()).unwrap();
    select(&mut terminal, "seed");
    seed(&mut terminal, "13");
    terminal.wait_for("thirteen is unlucky");
    assert!(
        row_with(&terminal, "thirteen").contains("internal error"),
        "{}",
        terminal.text()
    );
    assert!(
        terminal.screen().alternate_screen(),
        "the explorer is still there"
    );
    assert!(
        !terminal.text().contains("panicked at"),
        "{}",
        terminal.text()
    );
    terminal.send("..");
    assert_idle(&mut terminal);
    // The seed of the default scene.
    seed(&mut terminal, "5");
    terminal.wait_without("thirteen is unlucky");
    terminal.wait("force as before", |rows| {
        headline(rows).as_ref() == Some(&before)
    });
    quit(&mut terminal);
}

#[test]
fn a_panic_while_drawing_gives_the_terminal_back_and_shows_why() {
    let mut terminal = paused(panicking().argument("draw"));
    select(&mut terminal, "seed");
    seed(&mut terminal, "13");
    assert_eq!(terminal.wait_end().exit_code(), 101);
    assert_given_back(&terminal);
    // One line below the other: each line starts at the left again.
    let rows = terminal.rows();
    assert!(
        rows.iter()
            .any(|row| row.starts_with("thirteen is unlucky")),
        "{}",
        terminal.text()
    );
}

#[test]
fn a_typed_key_is_in_the_next_frame_whatever_the_engine_does() {
    let mut terminal = paused(panicking());
    select(&mut terminal, "seed");
    seed(&mut terminal, "14");
    terminal.wait_for("computing");
    terminal.settle();
    terminal.send("\r");
    terminal.settle();
    let mut typed = String::new();
    // No text with a letter is a seed, so that no curve of a typed seed arrives between two keys.
    for key in ["x", "2", "7", "1", "8", "2", "8"] {
        let before = terminal.frames().len();
        terminal.send(key);
        typed.push_str(key);
        terminal.wait("typed keys", |rows| {
            rows.iter().any(|row| row.contains(&format!(": {typed}")))
        });
        assert_eq!(
            terminal.frames().len() - before,
            1,
            "frames from the key to its echo"
        );
    }
    // The engine stops for the newer scene.
    terminal.send(CLEAR_LINE);
    terminal.send("5");
    terminal.send(ENTER);
    terminal.wait_without("computing");
    quit(&mut terminal);
}
